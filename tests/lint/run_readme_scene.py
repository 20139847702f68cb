#!/usr/bin/env python3
"""Runs the scene that README.md shows with the program given; fails as that fails."""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    scenes = re.findall(r"^```json\n(.*?)^```", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    if not scenes:
        sys.exit("README.md shows no scene")
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "readme.json"
            path.write_text(scene)
            done = subprocess.run([sys.argv[1], "run", str(path)], check=False)
            if done.returncode != 0:
                return done.returncode
    return 0


if __name__ == "__main__":
    sys.exit(main())
