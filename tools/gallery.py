#!/usr/bin/env python3
"""Renders the scenes of the gallery and writes docs/gallery.md: gallery.py PROGRAM.

The pictures come to out/gallery, in full size; what docs/gallery.md shows are small copies in docs/gallery, made by
ffmpeg. --only NAME... renders some of them; the page lists all.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FULL, SMALL = (1280, 720), (480, 270)
GALLERY = {  # group: scene, without its ending, and the time of the picture [s]
    "The paper": {"fig1": 1, "paper/fig2": 1, "paper/fig3": 1, "paper/fig4": 1, "paper/fig5": 1, "paper/fig6": 1,
                  "paper/fig7": 0.3},
    "Everything together": {"showcase": 3},
    "Cloth": {"cloth_over_sphere": 2, "curtain": 2, "flag": 3, "laundry_pile": 3},
    "Ropes and hair": {"hair_on_shoulders": 3, "hair_wind": 2},
    "What breaks": {"castle_wall": 1.5, "glass_pane": 1, "chandelier": 1.6},
    "Bodies": {"domino_spiral": 12, "card_house": 1, "pool_break": 0.7},
    "Jelly": {"cushions": 4, "jelly_on_net": 2},
}


def text_of(scene):
    """The title and the description of a scene, which is JSON with comments."""
    text = (ROOT / "scenes" / f"{scene}.json").read_text()
    found = [re.search(rf'"{key}":\s*("(?:[^"\\]|\\.)*")', text) for key in ("title", "description")]
    return [json.loads(one.group(1)) if one else "" for one in found]


def render(program, scene, seconds):
    """Renders one picture; returns what went wrong, or nothing."""
    full = ROOT / "out" / "gallery" / f"{scene.replace('/', '_')}.png"
    small = ROOT / "docs" / "gallery" / f"{scene.replace('/', '_')}.jpg"
    for folder in (full.parent, small.parent):
        folder.mkdir(parents=True, exist_ok=True)
    commands = [[program, "render", f"scenes/{scene}.json", "--at", str(seconds), "--size", f"{FULL[0]}x{FULL[1]}",
                 "-o", str(full)],
                ["ffmpeg", "-y", "-loglevel", "error", "-i", str(full), "-vf",
                 f"scale={SMALL[0]}:{SMALL[1]}:flags=lanczos", "-q:v", "4", str(small)]]
    for command in commands:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return f"{' '.join(command)}: {done.stderr.strip() or done.stdout.strip()}"
    return ""


def page():
    """The text of docs/gallery.md."""
    lines = ["# Gallery", "",
             "`./dev gallery` renders these pictures in full size into `out/gallery` and writes this page. "
             "`hooke view` shows each scene in a window.", ""]
    for group, scenes in GALLERY.items():
        lines += [f"## {group}", ""]
        for scene, seconds in scenes.items():
            title, description = text_of(scene)
            lines += [f"### {title}", "",
                      f"![{title}](gallery/{scene.replace('/', '_')}.jpg)", "",
                      f"{description} [scenes/{scene}.json](../scenes/{scene}.json) after {seconds:g} s.", ""]
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="a build of hooke")
    parser.add_argument("--only", nargs="*", default=None, help="scenes to render")
    arguments = parser.parse_args()
    wrong = []
    for scenes in GALLERY.values():
        for scene, seconds in scenes.items():
            if arguments.only is not None and scene not in arguments.only:
                continue
            print(f"{scene} at {seconds} s", flush=True)
            if problem := render(str(pathlib.Path(arguments.program).resolve()), scene, seconds):
                wrong.append(problem)
    (ROOT / "docs" / "gallery.md").write_text(page())
    for problem in wrong:
        print(problem, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
