#!/usr/bin/env python3
"""Fails on what should not be in a file of the project: paths of one machine, broken links, stale programs.

- no absolute path of a developer's machine in any text file;
- every relative link of a Markdown file leads to a file that exists;
- every suite and every file that docs/paper.md names exists;
- docs/step.md names every stage that src/world/step.cpp calls;
- every C++ block of README.md and of docs/manual stands, line by line, in a program that the tests build; a block may
  be indented less than there.
"""
import pathlib
import re
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
MACHINE_PATH = re.compile(r"(?<![\w.-])/(?:work|home|root|Users)/\w")
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
CPP_BLOCK = re.compile(r"^```cpp\n(.*?)^```", re.MULTILINE | re.DOTALL)
QUOTED = re.compile(r"`([a-z_0-9./]+)`")
STAGE = re.compile(r"world::([a-z_]+)\(w\b")
SUITE = re.compile(r'TEST_SUITE\("([^"]+)"\)')
TESTED_PROGRAMS = ("tests/consumer", "examples")
INDENTATIONS = (0, 2, 4, 6)


def project_files():
    listing = subprocess.run(["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard"],
                             capture_output=True, text=True, check=False)
    if listing.returncode != 0:
        return None  # an unpacked archive
    return [path for name in listing.stdout.splitlines() if (path := ROOT / name).is_file()]


def text_of(path):
    try:
        return path.read_text()
    except UnicodeDecodeError:
        return None


def machine_paths(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if MACHINE_PATH.search(line):
            yield f"{path.relative_to(ROOT)}:{number}: a path of one machine"


def broken_links(path, text):
    for target in LINK.findall(text):
        if "://" not in target and not (path.parent / target).exists():
            yield f"{path.relative_to(ROOT)}: link to '{target}', which does not exist"


def missing_names(paper):
    """A quoted `a/b` is a file, a folder or a test suite; `x.json` is a scene."""
    suites = {suite for path in (ROOT / "tests").rglob("*.cpp") for suite in SUITE.findall(path.read_text())}
    for name in set(QUOTED.findall(paper)):
        path = ROOT / ("scenes/" + name if name.endswith(".json") else name)
        header = ROOT / "include" / name
        if ("/" in name or name.endswith(".json")) and not (name in suites or path.exists() or header.exists()):
            yield f"docs/paper.md: no file or test suite is called '{name}'"


def missing_stages(step, page):
    for stage in sorted(set(STAGE.findall(step))):
        if f"`world::{stage}`" not in page:
            yield f"docs/step.md: stage 'world::{stage}' of src/world/step.cpp is missing"


def untested_programs(page):
    programs = [path.read_text() for folder in TESTED_PROGRAMS for path in (ROOT / folder).glob("*.cpp")]
    for block in CPP_BLOCK.findall(page.read_text()):
        indented = ["\n" + textwrap.indent(block, " " * count) for count in INDENTATIONS]
        if not any(lines in "\n" + program for program in programs for lines in indented):
            yield f"{page.relative_to(ROOT)}: no tested program contains this block:\n{block}"


def main():
    files = project_files()
    if files is None:
        print("files: skipped, this is not a git work tree")
        return 0
    errors = []
    for path in files:
        text = text_of(path)
        if text is None or path == pathlib.Path(__file__).resolve():
            continue
        errors += machine_paths(path, text)
        if path.suffix == ".md":
            errors += broken_links(path, text)
    errors += missing_stages((ROOT / "src/world/step.cpp").read_text(), (ROOT / "docs/step.md").read_text())
    for page in (ROOT / "README.md", *sorted((ROOT / "docs/manual").glob("*.md"))):
        errors += untested_programs(page)
    errors += missing_names((ROOT / "docs/paper.md").read_text())
    print("\n".join(errors) or "files: ok")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
