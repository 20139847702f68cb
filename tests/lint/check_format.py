#!/usr/bin/env python3
"""Fails if clang-format would lay out a file differently. Ends with 77, 'skipped', where it is not installed."""
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("include", "src", "apps", "bench", "examples", "tests")
VERSION = "14"  # others differ in details


def main():
    program = shutil.which(f"clang-format-{VERSION}") or shutil.which("clang-format")
    if program is None:
        print("format: skipped, clang-format is not installed")
        return 77
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    if f"version {VERSION}." not in version:
        print(f"format: skipped, this needs clang-format {VERSION}, not {version.strip()}")
        return 77
    files = sorted(str(path) for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cpp"))
    done = subprocess.run([program, "--dry-run", "-Werror", *files], check=False)
    print(f"format: {len(files)} files {'ok' if done.returncode == 0 else 'checked, ./dev format lays them out'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
