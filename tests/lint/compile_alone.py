#!/usr/bin/env python3
"""Compiles each file of the engine alone, as users' builds do, but makes no code. The debug build compiles folders as
wholes, where a file sees what the one before it includes.

usage: compile_alone.py BUILD_FOLDER
"""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def command_of(entry):
    """The compiler's command without its output, and without what only optimization can warn of."""
    words = shlex.split(entry["command"])
    return words[: words.index("-o")] + ["-O0", "-fsyntax-only", entry["file"]]


def errors_of(entry):
    done = subprocess.run(command_of(entry), cwd=entry["directory"], capture_output=True, text=True)
    return done.stderr if done.returncode != 0 else ""


def main():
    commands = json.loads((pathlib.Path(sys.argv[1]) / "compile_commands.json").read_text())
    entries = [entry for entry in commands if pathlib.Path(entry["file"]).is_relative_to(ROOT / "src")]
    if len(entries) < 100:
        sys.exit(f"only {len(entries)} files of the engine are compiled alone: is it configured by folder?")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = [errors for errors in pool.map(errors_of, entries) if errors]
    if failed:
        sys.exit("\n".join(failed) + f"{len(failed)} of {len(entries)} files do not compile alone")
    print(f"{len(entries)} files of the engine compile alone")


if __name__ == "__main__":
    main()
