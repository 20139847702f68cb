#!/usr/bin/env python3
"""Fails if a public symbol is undocumented, or a comment of a public header is not what Doxygen reads.

`doxygen docs/Doxyfile` writes the reference to out/reference; here it is written to a folder that goes again.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def main():
    doxygen = shutil.which("doxygen")
    if doxygen is None:
        print("api_reference: skipped, doxygen is not installed")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        setting = (ROOT / "docs/Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {folder}\n"
        run = subprocess.run([doxygen, "-"], input=setting, cwd=ROOT, capture_output=True, text=True, check=False)
        pages = list(pathlib.Path(folder).rglob("*.html"))
    warnings = [line.replace(f"{ROOT}/", "") for line in run.stderr.splitlines() if line.strip()]
    if run.returncode != 0 or len(pages) < 10:
        warnings.append(f"doxygen ended with {run.returncode} and wrote {len(pages)} pages")
    print("\n".join(warnings) or f"api_reference: ok, {len(pages)} pages")
    return 1 if warnings else 0


if __name__ == "__main__":
    sys.exit(main())
