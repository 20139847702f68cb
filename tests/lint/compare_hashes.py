#!/usr/bin/env python3
"""Runs the same scenes with several builds of `hooke`; fails unless all end in the same bits."""
import argparse
import re
import subprocess
import sys

HASH = re.compile(r"\b(?:0x)?([0-9a-f]{16})\b")
LIMIT_S = 600  # a hang must not last for ever; the runs themselves take seconds


def state_hash(program, scene, seconds):
    """The hash a program prints for a scene, or a word that says why there is none."""
    command = [program, "run", scene, "--seconds", seconds, "--hash"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return None, str(error)
    if done.returncode != 0:
        return None, f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()}"
    found = HASH.findall(done.stdout)
    return (found[-1], "") if found else (None, f"{' '.join(command)} printed no hash")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", nargs="+", required=True, help="builds of hooke, the first is the reference")
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--seconds", default="2", help="of simulated time")
    arguments = parser.parse_args()

    failures = 0
    for scene in arguments.scenes:
        reference = None
        for program in arguments.programs:
            value, problem = state_hash(program, scene, arguments.seconds)
            reference = reference or value
            equal = value is not None and value == reference
            failures += not equal
            print(f"{'same' if equal else 'DIFFERS'}  {value or problem}  {scene}  {program}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
