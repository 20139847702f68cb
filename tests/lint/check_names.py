#!/usr/bin/env python3
"""Fails if code uses a name that the vocabulary retired; tests/lint/old_names.txt lists them with the names of now.

Only names in code count: comments and strings may tell of a bundle of sticks or of a chain of links.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("include", "src", "apps", "bench", "examples", "tests", "validation")
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|^[ \t]*#[ \t]*include[^\n]*', re.DOTALL | re.MULTILINE)
NAME = re.compile(r"\b[A-Za-z_]\w*\b")


def old_names():
    lines = (ROOT / "tests/lint/old_names.txt").read_text().splitlines()
    return dict(line.split() for line in lines if line and not line.startswith("#"))


def main():
    old = old_names()
    errors = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.[hc]*")):
            if not path.is_file() or path.suffix not in (".h", ".cpp"):
                continue
            code = NO_CODE.sub(lambda match: "\n" * match[0].count("\n"), path.read_text())
            for number, line in enumerate(code.splitlines(), 1):
                errors += [f"{path.relative_to(ROOT)}:{number}: '{name}' is now '{old[name]}'"
                           for name in NAME.findall(line) if name in old]
    print("\n".join(errors) or "names: ok")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
