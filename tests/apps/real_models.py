"""Lets real models fall onto the ground as themselves, hang from a rope, and become jelly.

python3 tests/apps/real_models.py --hooke PROGRAM [--refusals N] MODEL_OR_FOLDER...

Each model becomes three scenes of two seconds. A line a model says what came of them, with the seconds of one
core that it took, or why it was refused. The exit code is 1 if more than N models were refused, or one did not do
what it should; 77 (skipped) if there are no models.
"""

import argparse
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

ENDINGS = {".3ds", ".obj", ".stl", ".ply", ".gltf", ".glb"}
SKIPPED = 77
LARGEST = 1 << 26  # bytes of a file that is copied
LONGEST = 300  # seconds of a core that a trial may take
TRIALS = ("fall", "hang", "jelly")
GROUND = {"name": "ground", "shape": {"half_space": {}}}


def scene_of(trial, model):
    """The scene of a trial: the model's longest side is 1 m, and its frame's origin in its middle."""
    mesh = {"file": model.name, "fit": 1, "origin": "center"}
    scene = {"version": 1, "seconds": 2, "meshes": {"model": mesh}}
    body = {"name": "model", "kind": "dynamic", "shape": {"mesh": "model"}, "position": [0, 1, 0]}
    if trial == "fall":
        scene["bodies"] = [GROUND, body]
        scene["expect"] = [{"quantity": "height", "of": "model", "op": ">", "value": -0.3},
                           {"quantity": "height", "of": "model", "op": "<", "value": 0.8},
                           {"quantity": "penetration", "op": "<", "value": 0.01}]
    elif trial == "hang":
        body["position"] = [0, 1.4, 0]  # The hook is a little above it, whatever its form.
        scene["bodies"] = [body]
        scene["ropes"] = [{"name": "rope", "hook_point": [0, 3, 0], "length_at_rest": 1, "direction": [0, -1, 0], "total_mass": 0.5,
                           "masses": 10}]
        scene["hooks"] = [{"name": "hook", "a": "rope", "a_point": "last", "b": "model",
                           "anchor": [0, 2, 0]}]
        scene["expect"] = [{"quantity": "gap", "of": "hook", "op": "<", "value": 0.02},
                           {"quantity": "height", "of": "model", "op": ">", "value": 1.1},
                           {"quantity": "extension", "of": "rope", "op": "<", "value": 0.02}]
    else:
        scene["bodies"] = [GROUND]
        scene["solids"] = [{"name": "model", "mesh": "model", "cell": 0.08, "young_modulus": 1e5,
                            "position": [0, 0.8, 0]}]
        scene["expect"] = [{"quantity": "lowest", "of": "model", "op": ">", "value": -0.05},
                           {"quantity": "lowest", "of": "model", "op": "<", "value": 0.15},
                           {"quantity": "highest", "of": "model", "op": "<", "value": 1.5}]
    return scene


def run(hooke, trial, model, folder):
    """Returns ("ok", "failed" or "refused"), one line of what was said, the notes, and the seconds it took."""
    path = folder / f"{trial}.json"
    path.write_text(json.dumps(scene_of(trial, model)))
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([hooke, "run", str(path), "--workers", "1", "--json", str(report)], capture_output=True,
                          text=True, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST)))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if done.returncode < 0 and seconds >= LONGEST:
        return "failed", f"took more than {LONGEST} s", [], seconds
    if not report.exists() or report.stat().st_size == 0:
        lines = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
        return ("refused" if done.returncode == 2 else "failed"), lines[0], [], seconds
    result = json.loads(report.read_text())
    wrong = [one["text"] for one in result["expect"] if not one["passed"]]
    notes = result["notes"] + [w for w in result["warnings"] if "physics" in w]
    return ("failed" if wrong or done.returncode != 0 else "ok"), "; ".join(wrong), notes, seconds


def moved_by(notes):
    """The figures of a closed surface, in short: mean and most, in units of the longest side."""
    for note in notes:
        found = re.search(r"moved by (\S+) m on average and (\S+) m at most", note)
        if found:
            return f"closed, moved {float(found[1]):.4f} / {float(found[2]):.4f}"
        found = re.search(r"mended for physics", note)
        if found:
            return "mended"
    return "as it is"


def try_model(hooke, model):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # The scene stands beside copies, so that nothing is written beside the models.
        for file in model.parent.iterdir():
            is_companion = file == model or file.suffix.lower() not in ENDINGS
            if file.is_file() and is_companion and file.stat().st_size < LARGEST:
                (folder / file.name).write_bytes(file.read_bytes())
        results = {trial: run(hooke, trial, model, folder) for trial in TRIALS}
    kinds = [results[trial][0] for trial in TRIALS]
    cells = "  ".join(f"{trial} {results[trial][0]} {results[trial][3]:.1f} s" for trial in TRIALS)
    print(f"{model.name:36} {cells}  {moved_by(results['fall'][2])}")
    for trial in TRIALS:
        if results[trial][0] != "ok":
            print(f"    {trial}: {results[trial][1]}")
    jelly = [note for note in results["jelly"][2] if "cells" in note]
    if jelly:
        print(f"    jelly: {jelly[0].split('.cell: ')[-1]}")
    sys.stdout.flush()
    return "failed" if "failed" in kinds else "refused" if "refused" in kinds else "ok"


def find_models(paths):
    found = []
    for path in map(pathlib.Path, paths):
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        found += [file for file in files if file.suffix.lower() in ENDINGS and file.is_file()]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hooke", required=True)
    parser.add_argument("--refusals", type=int, default=3)
    parser.add_argument("models", nargs="+")
    arguments = parser.parse_args()
    models = find_models(arguments.models)
    if not models:
        print("skipped: no models in " + " ".join(arguments.models))
        return SKIPPED
    verdicts = [try_model(arguments.hooke, model) for model in models]
    counts = {kind: verdicts.count(kind) for kind in ("ok", "refused", "failed")}
    print(f"{len(models)} models: {counts['ok']} ok, {counts['refused']} refused, {counts['failed']} failed")
    return 1 if counts["failed"] or counts["refused"] > arguments.refusals else 0


if __name__ == "__main__":
    sys.exit(main())
