#!/usr/bin/env python3
"""Runs scenes with builds of `hooke`; fails unless each ends in the bits that tests/scene_hashes.txt lists.

Every build, on every machine, must give these bits. A change that is meant to change motion lists them anew with
--write, so that its diff names the scenes that move otherwise.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests" / "scene_hashes.txt"
HEAD = """# The state of each scene after {seconds} s, as `hooke run SCENE --seconds {seconds} --hash` prints it.
# tests/lint/compare_hashes.py compares every build with this list, and lists it anew with --write.
"""
HASH = re.compile(r"\b(?:0x)?([0-9a-f]{16})\b")
SECONDS = "1"
LIMIT_S = 600  # a hang must not last for ever; the runs themselves take seconds


def state_hash(program, scene):
    """The hash that a program prints for a scene, or what went wrong, in words."""
    command = [program, "run", str(ROOT / scene), "--seconds", SECONDS, "--hash"]
    # Parts that another version has kept would hide that they are made otherwise now.
    environment = {**os.environ, "HOOKE_CACHE": ""}
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False, env=environment)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if done.returncode != 0:
        return f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()}"
    found = HASH.findall(done.stdout)
    return found[-1] if found else f"{' '.join(command)} printed no hash"


def listed():
    """Hash of each scene of the list."""
    rows = [line.split() for line in LIST.read_text().splitlines() if line and not line.startswith("#")]
    return {scene: value for value, scene in rows}


def scenes_of_project():
    found = sorted((ROOT / "scenes").rglob("*.json"))
    return [str(path.relative_to(ROOT)) for path in found if path.name != "schema.json"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", nargs="+", required=True, help="builds of hooke")
    parser.add_argument("--write", action="store_true", help="list what the first program gives")
    arguments = parser.parse_args()

    scenes = scenes_of_project()
    # Threads, as they only wait for programs.
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = {program: dict(zip(scenes, pool.map(lambda scene, p=program: state_hash(p, scene), scenes)))
                   for program in arguments.programs}
    if arguments.write:
        first = results[arguments.programs[0]]
        wrong = [value for value in first.values() if not HASH.fullmatch(value)]
        if wrong:
            print("\n".join(wrong))
            return 1
        LIST.write_text(HEAD.format(seconds=SECONDS) + "".join(f"{first[scene]} {scene}\n" for scene in scenes))
        return 0

    expected = listed()
    failures = [f"{scene}: in the list, but no scene" for scene in expected if scene not in scenes]
    for program, values in results.items():
        failures += [f"{scene}: {value}, not {expected.get(scene, 'in the list')} ({program})"
                     for scene, value in values.items() if value != expected.get(scene)]
    print("\n".join(failures) if failures else f"{len(scenes)} scenes: the same bits")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
