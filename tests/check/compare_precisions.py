#!/usr/bin/env python3
"""Fails if float and double disagree on a figure of stretch or energy by more than the row's tolerance.

Both files come from `hooke_check --json`. Every row must exist in both.
"""
import json
import re
import sys

FIGURES = re.compile(r"stretch|energy|extension|gain|sag|\bpull\b|tension", re.IGNORECASE)


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["cases"]
    return {(row["id"], row["title"], row["dt"]): row for row in rows}


def main():
    single, double = (rows_of(path) for path in sys.argv[1:3])
    errors = [f"{key}: only in one file" for key in single.keys() ^ double.keys()]
    compared = 0
    for key in single.keys() & double.keys():
        row, other = single[key], double[key]
        if not FIGURES.search(row["title"]):
            continue
        compared += 1
        scale = abs(row["expected"]) if row["relative"] else 1.0
        if row["achieved"] is None or other["achieved"] is None:
            errors.append(f"{key}: not a number")
        elif not abs(row["achieved"] - other["achieved"]) <= row["tolerance"] * scale:
            errors.append(f"{key}: float {row['achieved']}, double {other['achieved']}")
    if compared == 0:
        errors.append("nothing to compare")
    print("\n".join(errors) or f"precisions: {compared} figures agree")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
