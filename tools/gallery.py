#!/usr/bin/env python3
"""Renders the scenes of the gallery and writes docs/gallery.md: gallery.py PROGRAM.

Pictures in full size and clips come to out/gallery; what docs/gallery.md shows are small copies in docs/gallery, made
by ffmpeg. Without ffmpeg only the pictures in full size are made. --only NAME... renders some of them, --no-clips leaves
out the clips; the page lists all.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FULL, SMALL = (1280, 720), (480, 270)
CLIP = {"size": "640x360", "fps": 30, "longest": 4}  # Clips begin with the scene and last at most so long [s].
SHOWN = {"flag": 2, "jelly_on_net": 2}  # Clips of which the page has a small copy, and its length [s].
GALLERY = {  # group: scene, without its ending, and the time of the picture [s]
    "The paper": {"fig1": 1, "paper/fig2": 1, "paper/fig3": 1, "paper/fig4": 1, "paper/fig5": 1, "paper/fig6": 1,
                  "paper/fig7": 0.3},
    "Everything together": {"showcase": 6},
    "Cloth": {"cloth_over_sphere": 2, "curtain": 4, "flag": 3, "laundry_pile": 3, "tablecloth": 0.6, "washing_line": 6},
    "Ropes and hair": {"hair_on_shoulders": 3, "hair_wind": 2, "suspension_bridge": 2, "mobile": 2},
    "What breaks": {"castle_wall": 1.5, "glass_pane": 1, "chandelier": 1.72, "wrecking_ball": 2.2},
    "Bodies": {"domino_spiral": 12, "card_house": 1, "pool_break": 0.7, "ragdoll_stairs": 1.2},
    "Jelly": {"cushions": 4, "jelly_on_net": 2},
}


def text_of(scene):
    """The title and the description of a scene, which is JSON with comments."""
    text = (ROOT / "scenes" / f"{scene}.json").read_text()
    found = [re.search(rf'"{key}":\s*("(?:[^"\\]|\\.)*")', text) for key in ("title", "description")]
    return [json.loads(one.group(1)) if one else "" for one in found]


def run(*commands):
    """Runs commands one after the other; returns what went wrong, or nothing."""
    for command in commands:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return f"{' '.join(command)}: {done.stderr.strip() or done.stdout.strip()}"
    return ""


def paths_of(scene, *endings):
    """Files of a scene in out/gallery and docs/gallery, whose folders are made."""
    folders = [ROOT / "out" / "gallery", ROOT / "docs" / "gallery"]
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    return [str(folder / (scene.replace("/", "_") + ending)) for folder, ending in zip(folders, endings)]


def render(program, scene, seconds, has_ffmpeg):
    """Renders one picture; returns what went wrong, or nothing."""
    full, small = paths_of(scene, ".png", ".jpg")
    commands = [[program, "render", f"scenes/{scene}.json", "--at", str(seconds), "--size", f"{FULL[0]}x{FULL[1]}",
                 "-o", full]]
    if has_ffmpeg:
        commands.append(["ffmpeg", "-y", "-loglevel", "error", "-i", full, "-vf",
                         f"scale={SMALL[0]}:{SMALL[1]}:flags=lanczos", "-q:v", "4", small])
    return run(*commands)


def film(program, scene, seconds):
    """Makes the clip of a scene, and the small copy that the page shows of some; returns what went wrong."""
    clip, small = paths_of(scene, ".mp4", ".webp")
    length = min(max(seconds, 2), CLIP["longest"])
    commands = [[program, "render", f"scenes/{scene}.json", "--seconds", str(length), "--size", CLIP["size"],
                 "--fps", str(CLIP["fps"]), "-o", clip]]
    if scene in SHOWN:
        commands.append(["ffmpeg", "-y", "-loglevel", "error", "-t", str(SHOWN[scene]), "-i", clip, "-vf",
                         "fps=15,scale=320:-2:flags=lanczos", "-loop", "0", "-q:v", "45", small])
    return run(*commands)


def page():
    """The text of docs/gallery.md."""
    lines = ["# Gallery", "",
             "`./dev gallery` renders these pictures in full size, and a clip of each scene, into `out/gallery`, and "
             "writes this page. `hooke view` shows each scene in a window.", ""]
    for group, scenes in GALLERY.items():
        lines += [f"## {group}", ""]
        for scene, seconds in scenes.items():
            title, description = text_of(scene)
            lines += [f"### {title}", "",
                      f"![{title}](gallery/{scene.replace('/', '_')}.jpg)", "",
                      f"{description} [scenes/{scene}.json](../scenes/{scene}.json) after {seconds:g} s"
                      + (f"; [its first {SHOWN[scene]} s move](gallery/{scene}.webp)." if scene in SHOWN else "."), ""]
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="a build of hooke")
    parser.add_argument("--only", nargs="*", default=None, help="scenes to render")
    parser.add_argument("--no-clips", action="store_true", help="make pictures only")
    arguments = parser.parse_args()
    wrong = []
    has_ffmpeg = shutil.which("ffmpeg") is not None
    if not has_ffmpeg:
        print("ffmpeg is not installed: pictures in full size are made, but no small ones and no clips. "
              "On Debian, 'apt install ffmpeg' brings it.", file=sys.stderr)
    for scenes in GALLERY.values():
        for scene, seconds in scenes.items():
            if arguments.only is not None and scene not in arguments.only:
                continue
            print(f"{scene} at {seconds} s", flush=True)
            program = str(pathlib.Path(arguments.program).resolve())
            problems = [render(program, scene, seconds, has_ffmpeg)]
            if has_ffmpeg and not arguments.no_clips:
                problems.append(film(program, scene, seconds))
            wrong += filter(None, problems)
    (ROOT / "docs" / "gallery.md").write_text(page())
    for problem in wrong:
        print(problem, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
