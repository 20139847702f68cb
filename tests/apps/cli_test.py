"""Runs the program `hooke` as a user does: cli_test.py PROGRAM PROJECT_FOLDER."""

import copy
import csv
import json
import math
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from png import read_png

PROGRAM = ""
PROJECT = pathlib.Path()
LIMIT = 300  # [s], for a program that hangs

# A mass falls for one second: x = 1 m/s t, y = 10 m - 9.81 m/s^2 t^2 / 2, but for the integrator's error.
FALLING = {
    "version": 1,
    "seconds": 1,
    "particles": [{"name": "ball", "particles": [{"position": [0, 10, 0], "velocity": [1, 0, 0], "radius": 0.1}]}],
    "expect": [{"quantity": "x", "of": "ball", "point": 0, "op": "==", "value": 1, "tolerance": 1e-4}],
}


def project_version():
    return re.search(r"project\(hooke VERSION ([0-9.]+)", (PROJECT / "CMakeLists.txt").read_text())[1]


class Program(unittest.TestCase):
    """A temporary folder with the project's scenes, and the program."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hooke_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "scenes").symlink_to(PROJECT / "scenes")

    def hooke(self, *words, code=0, environment=None):
        """Runs it and returns (stdout, stderr); the exit code must be `code`."""
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              env=environment, check=False, timeout=LIMIT)
        self.assertEqual(done.returncode, code, f"hooke {words}:\n{done.stdout}{done.stderr}")
        return done.stdout, done.stderr

    def scene(self, content, name="scene.json"):
        text = content if isinstance(content, str) else json.dumps(content)
        (self.folder / name).write_text(text)
        return name

    def files(self):
        return sorted(path.name for path in self.folder.iterdir() if path.name != "scenes")

    def draw(self, *words):
        """As hooke render; skips the test on a machine without OpenGL."""
        self.draw_by("render", *words)

    def draw_by(self, *words):
        """Runs a command that draws; skips the test on a machine without OpenGL."""
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              check=False, timeout=LIMIT)
        if done.returncode == 3 and "headless OpenGL" in done.stderr:
            self.skipTest("no OpenGL without a display: " + done.stderr.strip())
        self.assertEqual(done.returncode, 0, done.stderr)

    def assert_one_line(self, text, pattern):
        self.assertEqual(text.count("\n"), 1, text)
        self.assertRegex(text, pattern)


class Version(Program):
    def test_the_program_says_the_version_of_the_project(self):
        self.assertEqual(self.hooke("--version"), (f"hooke {project_version()}\n", ""))

    def test_reports_begin_with_the_version(self):
        scene = {"version": 1, "seconds": 0.1, "particles": FALLING["particles"]}
        for words in ([], ["--stepper", "rk4"]):
            out, _ = self.hooke("run", self.scene(scene), *words, "--json", "-")
            self.assertEqual(next(iter(json.loads(out).items())), ("version", project_version()))


class Run(Program):
    def test_the_page_on_reports_names_every_key(self):
        page = (PROJECT / "docs" / "report.md").read_text()
        out, _ = self.hooke("run", self.scene(FALLING), "--json", "-")
        report = json.loads(out)
        for key in [*report, *report["routes"], *report["refused"]]:
            self.assertIn(f"`{key}`", page)

    def test_a_page_tells_of_a_run_without_any_other_file(self):
        scene = copy.deepcopy(FALLING)
        scene["title"] = "A <ball> & a bar"
        scene["bodies"] = [{"name": "bar", "kind": "dynamic", "mass": 10, "position": [0, 4.5, 0],
                            "shape": {"box": {"half_extents": [0.1, 0.5, 0.1]}}}]
        scene["hooks"] = [{"name": "pin", "kind": "ball", "b": "bar", "anchor": [0, 5, 0]},
                          {"name": "weak", "kind": "ball", "b": "bar", "anchor": [0.1, 5, 0], "break_force": 1e-9}]
        self.hooke("run", self.scene(scene), "--report", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertIn("<h1>A &lt;ball&gt; &amp; a bar</h1>", page)
        self.assertRegex(page, r'<li class="pass">pass .*expect\[0\]')
        self.assertRegex(page, r"<tr><td>weak \(first\)</td>")
        force = re.search(r"<tr><td>pin</td><td>(\S+) (\S+) (\S+)</td>", page)
        self.assertAlmostEqual(float(force[2]), 98.1, delta=0.1)
        self.assertEqual(page.count("<svg"), 4)
        self.assertEqual(page.count("<polyline"), 7)
        self.assertNotRegex(page, r"(?:src|href)=|nan|inf\b")
        self.hooke("run", "scene.json", "--report", "none/page.html", code=3)

    def test_a_report_that_cannot_be_written_is_refused_before_the_run(self):
        scene = self.scene(FALLING | {"seconds": 1e6})  # minutes
        start = time.monotonic()
        _, errors = self.hooke("run", scene, "--json", "nowhere/x.json", code=3)
        self.assertIn("nowhere/x.json", errors)
        self.assertLess(time.monotonic() - start, 10)

    def test_the_report_has_the_figures_of_the_motion(self):
        name = self.scene(FALLING)
        out, err = self.hooke("run", name, "--json", "/dev/stdout")
        report = json.loads(out)
        self.assertEqual(err, "")
        self.assertEqual((report["scene"], report["steps"], report["contacts"]), (name, 60, 0))
        self.assertAlmostEqual(report["seconds"], 1, places=5)
        # One kilogram: m g h at the start; what is lost in height is gained in speed.
        self.assertAlmostEqual(report["energy"]["start"]["potential"], 98.1, places=3)
        self.assertAlmostEqual(report["energy"]["start"]["kinetic"], 0.5, places=5)
        self.assertAlmostEqual(sum(report["energy"]["end"].values()), 98.6, delta=0.2)
        self.assertAlmostEqual(report["momentum"][0], 1, places=4)
        self.assertAlmostEqual(report["momentum"][1], -9.81, places=2)
        times = report["ms_per_step"]
        self.assertLessEqual(0, times["min"])
        self.assertLessEqual(times["min"], times["median"])
        self.assertLessEqual(times["median"], times["p99"])
        self.assertRegex(report["state_hash"], "^[0-9a-f]{16}$")
        self.assertEqual(report["warnings"], [])
        (expectation,) = report["expect"]
        self.assertTrue(expectation["passed"])
        self.assertEqual(expectation["value"], 1)
        self.assertAlmostEqual(expectation["achieved"], 1, delta=1e-4)
        self.assertIn("x of 'ball'", expectation["text"])

    def test_the_hook_that_broke_first_is_named_with_what_it_needed(self):
        names = ("weak", "strong")
        scene = {"version": 1, "seconds": 0.5, "world": {"gravity": [0, -9.81, 0]},
                 "bodies": [{"name": name + "_load", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}},
                             "position": [i, 0, 0], "mass": 2}
                            for i, name in enumerate(names)],
                 # Both need 2 kg x 9.81 m/s2 = 19.6 N; one bears it.
                 "hooks": [{"name": name, "b": name + "_load", "anchor": [i, 1, 0], "break_force": 15 + 10 * i}
                           for i, name in enumerate(names)]}
        out, _ = self.hooke("run", self.scene(scene), "--json", "report.json")
        self.assertRegex(out, r"broke     'weak' first, at 0\.00208333 s, as it needed 19\.62 N\n")
        (broke,) = json.loads((self.folder / "report.json").read_text())["broke"]
        self.assertEqual(broke["hook"], "weak")
        self.assertAlmostEqual(broke["force"], 19.62, places=2)
        self.assertEqual(broke["torque"], 0)
        self.assertAlmostEqual(broke["time"], 1 / 480, places=6)

    def test_ropes_that_snap_and_cloths_that_tear_are_named_with_hooks(self):
        pull = {"velocity": [1, 0, 0]}
        scene = {"version": 1, "seconds": 0.5,
                 "ropes": [{"name": "cord", "direction": [0, -1, 0], "masses": 3, "strength": 50,
                            "loads": [{"point": "last", "mass": 10}]}],
                 "cloths": [{"name": "rag", "columns": 4, "rows": 4, "corner": [3, 0, 0], "stretch_stiffness": 100,
                             "tear_strain": 0.2, "pins": [{"point": 0}, {"point": 3, "motion": pull}]}],
                 "expect": [{"quantity": "broken", "of": "cord", "op": "==", "value": 1},
                            {"quantity": "broken", "of": "rag", "op": ">", "value": 0}]}
        out, _ = self.hooke("run", self.scene(scene), "--json", "report.json")
        self.assertRegex(out, r"broke     'cord' first, at .* s, as it needed 10\d\.?\d* N; 1 rope and 1 cloth in all\n")
        cord, rag = json.loads((self.folder / "report.json").read_text())["broke"]
        self.assertEqual((cord["rope"], cord["segments"]), ("cord", [0]))
        self.assertEqual(rag["cloth"], "rag")
        self.assertGreater(rag["strain"], 0.2)
        self.assertGreater(rag["points"], 0)

    def test_a_promise_that_is_broken_is_exit_code_1(self):
        content = copy.deepcopy(FALLING)
        content["expect"][0]["value"] = 2
        out, _ = self.hooke("run", self.scene(content), code=1)
        self.assertRegex(out, r"FAIL scene.json:1:\d+: expect\[0\]: x of 'ball'")

    def test_an_expectation_after_the_end_does_not_count(self):
        content = copy.deepcopy(FALLING)
        content["expect"][0]["value"] = 2
        out, _ = self.hooke("run", self.scene(content), "--seconds", 0.5)
        self.assertIn("1 of 1 expectations are due later", out)

    def test_the_object_that_stretches_most_is_named(self):
        rope = {"hook_point": [0, 3, 0], "direction": [0, -1, 0], "length_at_rest": 1, "total_mass": 0.1,
                "stiffness": 100}
        content = {"version": 1, "ropes": [
            {"name": "light", **rope},
            {"name": "heavy", **rope, "hook_point": [1, 3, 0], "loads": [{"point": "last", "mass": 1}]}]}
        out, _ = self.hooke("run", self.scene(content), "--seconds", 0.5, "--json", "report.json")
        self.assertRegex(out, r"stretch   [0-9.]+ % at most \('heavy'\), [0-9.]+ % on average")
        self.assertEqual(json.loads((self.folder / "report.json").read_text())["most_stretched"], "heavy")
        out, _ = self.hooke("run", self.scene({"version": 1, "bodies": []}), "--seconds", 0.1)
        self.assertIn("stretch   0 % at most, 0 % on average", out)

    def test_the_table_has_a_line_for_each_step(self):
        self.hooke("run", self.scene(FALLING), "--csv", "steps.csv", "--json", "report.json")
        with open(self.folder / "steps.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual([int(row["step"]) for row in rows], list(range(1, 61)))
        self.assertEqual(list(rows[0]), [
            "step", "time", "kinetic", "potential", "elastic", "momentum_x", "momentum_y", "momentum_z",
            "largest_stretch", "largest_penetration", "largest_gap", "contacts", "state_hash"])
        self.assertEqual(rows[-1]["state_hash"], report["state_hash"])
        self.assertEqual(float(rows[-1]["potential"]), report["energy"]["end"]["potential"])
        self.assertAlmostEqual(float(rows[29]["momentum_y"]), -9.81 / 2, places=2)
        self.assertEqual(self.files(), ["report.json", "scene.json", "steps.csv"])

    def test_the_number_of_workers_does_not_change_a_bit(self):
        hashes = {self.hooke("run", "scenes/flag.json", "--seconds", 0.25, "--workers", n, "--hash")[0]
                  for n in (1, 2, 3, 8)}
        self.assertEqual(len(hashes), 1, hashes)
        self.assertRegex(hashes.pop(), "^[0-9a-f]{16}\n$")

    def test_instructions_do_not_change_a_bit(self):
        scene = "scenes/flag.json"
        expected, _ = self.hooke("run", scene, "--seconds", 0.2, "--hash")
        scalar, _ = self.hooke("--instruction-set", "scalar", "run", scene, "--seconds", 0.2, "--hash")
        self.assertEqual(scalar, expected)
        by_environment, _ = self.hooke("run", scene, "--seconds", 0.2, "--hash",
                                       environment={**os.environ, "HOOKE_INSTRUCTION_SET": "scalar"})
        self.assertEqual(by_environment, expected)

    def test_instructions_that_there_are_not(self):
        scene = self.scene(FALLING)
        _, errors = self.hooke("run", scene, "--instruction-set", "abacus", code=2)
        self.assertIn("'abacus'", errors)
        self.assertIn("scalar", errors)
        _, errors = self.hooke("run", scene, code=2, environment={**os.environ, "HOOKE_INSTRUCTION_SET": "abacus"})
        self.assertIn("HOOKE_INSTRUCTION_SET", errors)
        self.hooke("run", scene, "--instruction-set", code=2)

    def test_substeps_change_the_motion(self):
        def hash_of(*words):
            return self.hooke("run", "scenes/flag.json", "--seconds", 0.05, "--hash", *words)[0]
        self.assertEqual(len({hash_of(), hash_of("--substeps", 3), hash_of("--particle-substeps", 2)}), 3)

    def test_hashes_on_the_way_lead_to_the_last_one(self):
        lines = self.hooke("run", self.scene(FALLING), "--hash-every", 20)[0].split("\n")
        self.assertEqual([line.split(" ")[0] for line in lines[:3]], ["20", "40", "60"])
        self.assertEqual(lines[2].split(" ")[1], self.hooke("run", "scene.json", "--hash")[0].strip())
        self.assertIn("needs a name", self.hooke("run", "scene.json", "--stepper", "", code=2)[1])
        for number in (0, -1, "99999999999999999999"):
            _, errors = self.hooke("run", "scene.json", "--hash-every", number, code=2)
            self.assertIn("1 to 4294967295", errors)

    def test_the_summary_names_title_energy_and_verdicts(self):
        out, err = self.hooke("run", "scenes/rope.json")
        self.assertEqual(err, "")
        self.assertEqual(out.count("\npass scenes/rope.json:"), 5)
        self.assertIn("scenes/rope.json: Rope\n", out)

    def test_an_event_that_cannot_happen_fails_the_run(self):
        content = dict(FALLING, timeline=[
            {"at_step": 2, "remove": "ball"},
            {"at_step": 3, "impulse": {"object": "ball", "point": 0, "impulse": [0, 1, 0]}}])
        content.pop("expect")
        self.assertIn("timeline[1]", self.hooke("run", self.scene(content), code=1)[1])


class Settle(Program):
    """Scenes that come to rest, and one that does not."""

    PENDULUM = {
        "version": 1,
        "seconds": 1,
        "bodies": [{"name": "bob", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}},
                    "position": [1, 0, 0]}],
        "hooks": [{"name": "pivot", "kind": "ball", "b": "bob", "anchor": [0, 0, 0]}],
    }

    def test_a_pendulum_rests_below_its_pivot_and_a_run_may_start_there(self):
        scene = self.scene(self.PENDULUM)
        report = json.loads(self.hooke("settle", scene, "--json", "-")[0])
        self.assertTrue(report["converged"])
        self.assertLessEqual(report["sum"], 1e-5)
        for found, asked in zip(report["objects"][0]["position"], (0, -1, 0)):
            self.assertAlmostEqual(found, asked, delta=1e-3)
        out, errors = self.hooke("run", scene, "--settle", "--json", "-")
        self.assertIn("--settle: at rest after", errors)
        self.assertLess(json.loads(out)["energy"]["end"]["kinetic"], 1e-6)
        one = self.hooke("settle", scene, "--hash")[0]
        self.assertEqual(self.hooke("settle", scene, "--hash", "--workers", 2)[0], one)

    def test_what_falls_or_breaks_is_named(self):
        falling = {**self.PENDULUM, "hooks": []}
        out, _ = self.hooke("settle", self.scene(falling), "--seconds", 1, code=1)
        self.assert_one_line(out.split("\n")[0] + "\n", "no rest in 60 steps: .* and 'bob' moves at ")
        weak = copy.deepcopy(self.PENDULUM)
        weak["hooks"][0]["break_force"] = 1
        out, _ = self.hooke("settle", self.scene(weak), code=1)
        self.assertIn("no rest: 'pivot' (hook) broke after", out)


class BadInput(Program):
    def test_errors_name_line_and_path(self):
        name = self.scene('{"version": 1,\n "ropes": [{"masses": 1}]}')
        for command in (["run"], ["validate"], ["render", "-o", "x.png"], ["view"]):
            _, err = self.hooke(*command, name, code=2)
            self.assert_one_line(err, r"^scene.json:2:\d+: ropes\[0\].masses: 1 .*must be 2 to 65536")
        self.assertEqual(self.files(), ["scene.json"])

    def test_every_error_of_a_file_is_printed(self):
        name = self.scene('{"version": 1, "ropes": [{"masses": 1, "radius": -1}], "unknown": 3}')
        _, err = self.hooke("validate", name, code=2)
        self.assertEqual(err.count("\n"), 3, err)

    def test_files_that_are_missing_or_no_scene(self):
        self.assert_one_line(self.hooke("run", "none.json", code=2)[1], r"^none.json: ")
        self.assertRegex(self.hooke("run", ".", code=2)[1], r"^\.: ")
        self.assertRegex(self.hooke("run", self.scene("{"), code=2)[1], r"^scene.json:1:\d+: ")

    def test_a_model_that_is_missing_is_found_by_validate(self):
        content = {"version": 1, "meshes": {"m": {"file": "none.3ds"}}}
        self.assertIn("none.3ds", self.hooke("validate", self.scene(content), code=2)[1])

    def test_a_limit_that_a_hostile_model_hits_is_bad_input(self):
        (self.folder / "deep.gltf").write_text("[" * 100000)
        self.assert_one_line(self.hooke("convert", "deep.gltf", "x.obj", code=2)[1], r"^deep\.gltf: .*64 deep")
        with open(self.folder / "large.stl", "wb") as large:
            large.truncate((256 << 20) + 1)  # sparse
        self.assert_one_line(self.hooke("convert", "large.stl", "x.obj", code=2)[1], r"^large\.stl: .*256 MiB")

    def test_what_a_scene_says_in_vain_fails_validation_and_warns_a_run(self):
        content = copy.deepcopy(FALLING)
        content["bodies"] = [{"name": "wall", "shape": {"box": {}}, "position": [9, 0, 0], "mass": 3}]
        name = self.scene(content)
        self.assert_one_line(self.hooke("validate", name, code=2)[1], r"bodies\[0\]\.mass: has no effect: ")
        self.assert_one_line(self.hooke("run", name, "--hash")[1], r"^warning: .*has no effect: ")

    def test_arguments_that_make_no_sense(self):
        name = self.scene(FALLING)
        for words in ([], ["fly"], ["run"], ["run", name, "--workers", "0"], ["run", name, "--seconds", "-1"],
                      ["run", name, "--seconds", "nan"], ["run", name, "--nonsense"], ["run", name, "more"],
                      ["run", name, "--csv", "-", "--json", "-"], ["new", "castle"],
                      ["convert", "a.obj", "b.obj", "--scale", "2", "--fit", "1"],
                      ["convert", "scenes/models/crate.3ds", "b.obj", "--up", "w"],
                      ["view", name, "--screenshot", "x.png"]):
            self.assert_one_line(self.hooke(*words, code=2)[1], "^hooke")
        for words in (["-o", "x.png", "--size", "big"], ["-o", "x.png", "--size", "0x5"], ["-o", "x.mp3"],
                      ["-o", "x.mp4", "--at", "1"], ["-o", "x.mp4", "--size", "33x33"], ["-o", "x_%s.png"]):
            done = subprocess.run([PROGRAM, "render", name, *words], cwd=self.folder, capture_output=True,
                                  text=True, check=False, timeout=LIMIT)
            if not (done.returncode == 3 and "headless OpenGL" in done.stderr):
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), (words, done.stderr))
        self.assertEqual(self.files(), ["scene.json"])


class Warnings(Program):
    """What `hooke run` says of a scene that runs and is not what it seems."""

    def problems(self, content, *words):
        out, err = self.hooke("run", self.scene({"version": 1, "seconds": 0.5} | content), "--json", "-", *words)
        report = json.loads(out)
        lines = [f"warning: {line}" for line in report["warnings"]]
        self.assertEqual([line for line in err.splitlines() if not line.startswith("note: ")], lines)
        self.assertEqual(len(report["warnings"]), len(report["problems"]))
        for one, line in zip(report["problems"], lines):
            self.assertIn(one["what"], line)
            self.assertTrue(line.endswith(one["cure"]) and one["cure"], line)
        return {one["object"]: one for one in report["problems"]}

    def net_under_box(self, n):
        """Returns n x n balls on hooks, held at their rim, under a box of 200 kg."""
        mesh = 0.2
        at = lambda i: [mesh * (i % n), 2, mesh * (i // n)]
        bodies = [{"name": f"ball_{i}", "kind": "dynamic", "mass": 0.1, "shape": {"sphere": {"radius": 0.05}},
                   "position": at(i)} for i in range(n * n)]
        middle = mesh * (n - 1) / 2
        bodies.append({"name": "box", "kind": "dynamic", "mass": 200, "position": [middle, 2.2, middle],
                       "shape": {"box": {"half_extents": [0.3, 0.1, 0.3]}}})
        hooks = []
        for i in range(n * n):
            x, y, z = at(i)
            if i % n:
                hooks.append({"a": f"ball_{i - 1}", "b": f"ball_{i}", "anchor": [x - mesh / 2, y, z]})
            if i >= n:
                hooks.append({"a": f"ball_{i - n}", "b": f"ball_{i}", "anchor": [x, y, z - mesh / 2]})
            if i % n in (0, n - 1) or i // n in (0, n - 1):
                hooks.append({"b": f"ball_{i}", "anchor": at(i)})
        return {"bodies": bodies, "hooks": hooks}

    def test_a_net_beyond_the_budget_of_direct_solutions(self):
        told = self.problems(self.net_under_box(30))[""]
        self.assertRegex(told["what"], r"too many to be solved as a whole: .*nets may gape \(5\d\d\d rows in one step")
        self.assertIn("smaller nets", told["cure"])
        self.assertGreater(told["worst"], 0.04)
        self.assertEqual((told["unit"], told["limit"]), ("m", 1e-3))
        within = self.problems(self.net_under_box(6)).get("", {"what": ""})
        self.assertNotIn("too many", within["what"])

    def test_jelly_as_stiff_as_the_substeps_carry_and_stiffer(self):
        jelly = {"name": "jelly", "cells": [4, 4, 4], "size": [1, 1, 1], "density": 1000, "poisson_ratio": 0.25,
                 "position": [0, 5, 0]}
        for young_modulus in (1e5, 1e7, 1e9):
            self.assertEqual(self.problems({"solids": [jelly | {"young_modulus": young_modulus}]}), {})

    def test_cloth_that_loses_its_bending(self):
        # A strip of 10 cells held at one edge.
        strip = {"name": "strip", "columns": 12, "rows": 3, "width": 0.55, "height": 0.1, "areal_density": 0.2,
                 "row_direction": [0, 0, 1], "bend_stiffness": 0.3, "pins": [{"column": 0}, {"column": 1}]}
        self.assertEqual(self.problems({"cloths": [strip]}), {})
        strip["bend"] = "angle"
        told = self.problems({"cloths": [strip]})["strip"]
        self.assertRegex(told["what"], "has hardly any of its bend_stiffness of 0.3 N m: a substep of 0.00208 s")
        self.assertEqual(self.problems({"cloths": [strip | {"bend_stiffness": 1e-4}]}), {})
        del strip["bend_stiffness"]
        self.assertEqual(self.problems({"cloths": [strip | {"bend": "none"}]}), {})

    @staticmethod
    def mesh_of_sheet(n):
        """Returns a square of n x n points, which has no yarns as a grid has."""
        quads = [r * n + c for r in range(n - 1) for c in range(n - 1)]
        return {"vertices": [[c / (n - 1), 1 - r / (n - 1), 0] for r in range(n) for c in range(n)],
                "triangles": [t for q in quads for t in ([q, q + n, q + 1], [q + 1, q + n, q + n + 1])]}

    def test_cloth_that_stretches_more_than_declared(self):
        loads = {"total_mass": 0.2, "tethers": False, "loads": [{"point": 110 + i, "mass": 0.07} for i in range(11)]}
        grid = {"name": "sheet", "columns": 11, "rows": 11, "width": 1, "height": 1, "pins": [{"row": 0}]} | loads
        self.assertEqual(self.problems({"cloths": [grid]}), {})
        sheet = {"name": "sheet", "mesh": "square", "pins": list(range(11))} | loads
        square = {"meshes": {"square": self.mesh_of_sheet(11)}}
        told = self.problems(square | {"cloths": [sheet]})["sheet"]
        # 1.4 m / h^2 with 0.2 kg on 121 points and substeps of 1/480 s.
        self.assertRegex(told["what"], "carries no more than about 533 N/m of its stretch_stiffness")
        # The upper cells bear 1.3 kg on 11 strands, 1.2 N each: 0.1 % of 0.1 m by 1e4 N/m, and twice that as they fall.
        self.assertGreater(told["worst"], 0.02)
        self.assertEqual(self.problems(square | {"cloths": [sheet | {"stretch_stiffness": 500}]}), {})
        self.assertEqual(self.problems(square | {"cloths": [sheet]}, "--particle-substeps", 10), {})
        # Of copies one speaks for all.
        told = self.problems(square | {"cloths": [sheet | {"array": {"grid": [3, 1, 1], "spacing": [2, 1, 1]}}]})
        self.assertEqual(len(told), 1)
        self.assertRegex(*[(one["what"], r"\(the worst of 3\)") for one in told.values()][0])

    def test_cells_that_do_not_fit(self):
        cloth = {"name": "felt", "columns": 21, "rows": 21, "thickness": 0.06, "pins": [0]}
        self.assertRegex(self.problems({"cloths": [cloth]})["felt"]["what"], "thickness of 0.06 m.*cells of 0.05 m")
        corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        # A table: a top of 0.2 m, and a leg of 0.05 m that cells of 0.2 m lose.
        faces = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                 [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
        boxes = [((0, 1, 0), (1, 0.2, 1)), ((0.4, 0, 0.4), (0.3, 0.9, 0.3)), ((2, 0, 0), (2, 0.02, 2))]
        vertices = [[o + s * c for o, s, c in zip(origin, size, corner)] for origin, size in boxes for corner in corners]
        triangles = [[i + 8 * k for i in face] for k in range(len(boxes)) for face in faces]
        scene = {"meshes": {"parts": {"vertices": vertices, "triangles": triangles}},
                 "solids": [{"name": "parts", "mesh": "parts", "cell": 0.15}], "world": {"gravity": [0, 0, 0]}}
        # Cells are added along thin parts, and said; nothing is lost then.
        self.assertEqual(self.problems(scene), {})
        path = self.scene({"version": 1, "seconds": 0.1} | scene)
        self.assertRegex(self.hooke("run", path)[1], r"thinner than its cells in places: \d+ cells were added")

    def test_limits_that_do_not_hold(self):
        rope = {"name": "rope", "masses": 8, "stiffness": 100, "extension_max": 0.05, "hook_point": [0, 3, 0],
                "direction": [0, -1, 0], "loads": [{"point": "last", "mass": 5}]}
        self.assertEqual(self.problems({"ropes": [rope]}), {})
        net = {"name": "net", "extension_max": 0.05, "areal_density": 0.1, "stretch_stiffness": 100,
               "loads": [{"point": 76, "mass": 5}]}
        grid = net | {"columns": 9, "rows": 9, "pins": [{"row": 0}]}
        self.assertEqual(self.problems({"cloths": [grid]}), {})
        square = {"square": self.mesh_of_sheet(9)}
        mesh = net | {"mesh": "square", "pins": list(range(9))}
        self.assertEqual(self.problems({"meshes": square, "cloths": [mesh]}), {})
        # Many small loads, none of them so heavy that the cloth is solved as a whole.
        small = {"loads": [{"point": i, "mass": 0.04} for i in range(54, 81)], "tethers": False}
        told = self.problems({"meshes": square, "cloths": [mesh | small]})["net"]
        self.assertRegex(told["what"], "stretched by .* %, its extension_max is 5 %")
        self.assertGreater(told["worst"], 0.055)
        self.assertAlmostEqual(told["limit"], 0.05, delta=1e-6)
        self.assertGreater(told["time"], 0)

    def test_hooks_that_are_open(self):
        box = {"kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.1, 0.1]}}}
        scene = {"world": {"gravity": [0, 0, 0]},
                 "bodies": [box | {"name": "a"}, box | {"name": "b", "position": [0.7, 0, 0]}],
                 "hooks": [{"name": "far", "a": "a.right", "b": "b.left"}]}
        told = self.problems(scene)["far"]
        self.assertRegex(told["what"], "began with its ends 0.5 m apart")
        self.assertAlmostEqual(told["worst"], 0.5, delta=1e-6)
        scene["bodies"][1]["position"] = [0.2, 0, 0]
        self.assertEqual(self.problems(scene), {})

    def test_many_objects_with_the_same_trouble_give_one_warning(self):
        box = {"kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.1, 0.1]}}}
        for count in (8, 9):
            scene = {"world": {"gravity": [0, 0, 0]}, "bodies": [], "hooks": []}
            for i in range(count):
                scene["bodies"] += [box | {"name": f"a{i}", "position": [0, i, 0]},
                                    box | {"name": f"b{i}", "position": [0.5 + 0.05 * i, i, 0]}]
                scene["hooks"].append({"name": f"k{i}", "a": f"a{i}.right", "b": f"b{i}.left"})
            told = self.problems(scene)
            self.assertEqual(len(told), 8 if count == 8 else 1)
            self.assertEqual("(the worst of 9)" in told[f"k{count - 1}"]["what"], count == 9)


class Output(Program):
    def test_a_folder_that_refuses_is_exit_code_3_and_leaves_nothing(self):
        name = self.scene(FALLING)
        for option in ("--json", "--csv"):
            _, err = self.hooke("run", name, option, "none/out", code=3)
            self.assert_one_line(err, "^none/out: cannot be written: ")
            self.assert_one_line(self.hooke("run", name, option, "scenes", code=3)[1], "it is a folder")
        self.assertEqual(self.files(), ["scene.json"])

    def test_a_full_device_is_noticed(self):
        if not pathlib.Path("/dev/full").exists():
            self.skipTest("no /dev/full")
        name = self.scene(FALLING)
        for option in ("--json", "--csv"):
            self.assertIn("/dev/full", self.hooke("run", name, option, "/dev/full", code=3)[1])
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([PROGRAM, "run", name], cwd=self.folder, stdout=full, check=False,
                                  stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 3)

    def test_a_run_that_is_killed_leaves_the_old_table(self):
        (self.folder / "steps.csv").write_text("old")
        with subprocess.Popen([PROGRAM, "run", "scenes/flag.json", "--seconds", "100000", "--csv", "steps.csv",
                               "--hash-every", "1"], cwd=self.folder, stdout=subprocess.PIPE) as run:
            # Output is buffered: what arrives tells that steps were done.
            self.assertTrue(run.stdout.read(1000))
            run.kill()
        self.assertEqual((self.folder / "steps.csv").read_text(), "old")
        self.assertEqual(self.files(), ["steps.csv"])

    def test_a_film_that_is_interrupted_leaves_nothing(self):
        self.draw("scenes/rope.json", "-o", "now.png", "--at", 0.1, "--size", "64x64")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with subprocess.Popen([PROGRAM, "render", "scenes/rope.json", "-o", "film.mp4", "--seconds", "100000",
                                   "--size", "64x64"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as film:
                time.sleep(1)
                self.assertIsNone(film.poll())
                film.send_signal(number)
                self.assertEqual(film.wait(LIMIT), -number)
            self.assertEqual(self.files(), ["now.png"])

    def test_a_link_is_written_through(self):
        (self.folder / "real.json").write_text("old")
        (self.folder / "link.json").symlink_to("real.json")
        self.hooke("run", self.scene(FALLING), "--json", "link.json")
        self.assertTrue((self.folder / "link.json").is_symlink())
        self.assertEqual(json.loads((self.folder / "real.json").read_text())["steps"], 60)


class NewAndValidate(Program):
    def test_starters_are_good_scenes_and_are_not_replaced(self):
        for kind in ("rope", "flag", "empty"):
            self.hooke("new", kind, "-o", kind + ".json")
            self.assertEqual(self.hooke("validate", kind + ".json")[0], kind + ".json: good\n")
            self.assertEqual(self.hooke("new", kind)[0], (self.folder / (kind + ".json")).read_text())
        (self.folder / "rope.json").write_text("mine")
        self.assert_one_line(self.hooke("new", "rope", "-o", "rope.json", code=2)[1], "^rope.json: exists")
        self.assertEqual((self.folder / "rope.json").read_text(), "mine")
        self.hooke("new", "rope", "-o", "rope.json", "--force")
        self.hooke("run", "rope.json", "--seconds", 0.1)

    def test_all_scenes_of_the_project_are_good(self):
        scenes = sorted(path for path in (PROJECT / "scenes").rglob("*.json") if path.name != "schema.json")
        self.assertGreater(len(scenes), 5)
        out, err = self.hooke("validate", *scenes)
        self.assertEqual((out.count(": good\n"), err), (len(scenes), ""))


class Convert(Program):
    def test_a_model_keeps_its_size_through_another_format(self):
        out, _ = self.hooke("convert", "scenes/models/crate.3ds", "crate.obj", "--fit", 2)
        triangles = int(re.search(r"(\d+) triangles", out).group(1))
        lines = (self.folder / "crate.obj").read_text().split("\n")
        points = [[float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")]
        sides = [max(p[axis] for p in points) - min(p[axis] for p in points) for axis in range(3)]
        self.assertAlmostEqual(max(sides), 2, places=5)
        out, _ = self.hooke("convert", "crate.obj", "crate.stl", "--scale", 3)
        count = struct.unpack("<I", (self.folder / "crate.stl").read_bytes()[80:84])[0]
        self.assertEqual((count, f"{triangles} triangles" in out), (triangles, True))

    def write_boxes(self, name, *boxes, without=0):
        """Boxes as OBJ, quads counter-clockwise from outside, the first of them left out."""
        quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
        lines = []
        for number, box in enumerate(boxes):
            lines += ["v {} {} {}".format(*(box[i >> axis & 1][axis] for axis in range(3))) for i in range(8)]
            lines += ["f " + " ".join(str(8 * number + i + 1) for i in quad) for quad in quads[without:]]
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def read_solid(self, name):
        """The volume of an OBJ; fails unless each edge has one triangle each way."""
        lines = [line.split() for line in (self.folder / name).read_text().split("\n")]
        points = [[float(word) for word in line[1:4]] for line in lines if line[:1] == ["v"]]
        faces = [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line[:1] == ["f"]]
        edges = [(face[k], face[k - 2]) for face in faces for k in range(3)]
        self.assertEqual(len(edges), len(set(edges)))
        self.assertEqual(set(edges), {edge[::-1] for edge in edges})
        volume = 0
        for a, b, c in ([points[i] for i in face] for face in faces):
            volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + \
                a[2] * (b[0] * c[1] - b[1] * c[0])
        return volume / 6

    def test_solids_are_joined_cut_and_taken_from_each_other(self):
        self.write_boxes("a.obj", ((0, 0, 0), (2, 2, 2)))
        self.write_boxes("b.obj", ((1, 1, 0), (3, 3, 1)))
        for option, volume in (("--union", 11), ("--intersect", 1), ("--subtract", 7)):
            self.hooke("convert", "a.obj", option, "b.obj", "out.obj")
            self.assertAlmostEqual(self.read_solid("out.obj"), volume, places=5)

    def test_the_building_of_a_scene_is_a_block_without_rooms_and_doors(self):
        self.write_boxes("block.obj", ((0, 0, 0), (12.8, 2.4, 4.4)))
        self.write_boxes("rooms.obj", *(((x, 0.2, 0.2), (x + 4, 3, 4.2)) for x in (0.2, 4.4, 8.6)))
        self.write_boxes("doors.obj", ((1, 0.2, 1.7), (11.8, 2, 2.7)))
        self.hooke("convert", "block.obj", "--subtract", "rooms.obj", "open.obj")
        # Three rooms of 4 x 2.2 x 4 m above the floor, then two doors of 0.2 x 1.8 x 1 m.
        self.assertAlmostEqual(self.read_solid("open.obj"), 12.8 * 2.4 * 4.4 - 3 * 4 * 2.2 * 4, places=4)
        self.hooke("convert", "open.obj", "--subtract", "doors.obj", "rooms.glb")
        kept = PROJECT / "scenes/paper/models/rooms.glb"
        self.assertEqual((self.folder / "rooms.glb").read_bytes(), kept.read_bytes())

    def test_the_cells_of_a_solid_are_named_objects_that_fill_it(self):
        self.write_boxes("a.obj", ((0, 0, 0), (2, 1, 3)))
        out, _ = self.hooke("convert", "a.obj", "cells.obj", "--fracture", 25, "--fracture-seed", 4)
        cells = int(re.match(r"cells\.obj: (\d+) cells, \d+ glued faces, \d+ seeds merged\n", out).group(1))
        self.assertGreater(cells, 20)
        text = (self.folder / "cells.obj").read_text()
        names = re.findall(r"^o (.*)$", text, re.M)
        self.assertEqual(names, [f"cell_{i}" for i in range(cells)])
        self.assertAlmostEqual(self.read_solid("cells.obj"), 6, places=4)
        self.assertEqual((text.count("usemtl inside"), "newmtl inside" in (self.folder / "cells.mtl").read_text()),
                         (cells, True))
        self.hooke("convert", "a.obj", "again.obj", "--fracture", 25, "--fracture-seed", 4)
        self.assertEqual((self.folder / "again.obj").read_text().replace("again", "cells"), text)
        for arguments, complaint in ((["x.glb", "--fracture", 5], r"^x\.glb: cells are written as \.obj"),
                                     (["x.obj", "--fracture", 0], "^cells: 0 is out of range"),
                                     (["x.obj", "--fracture-seed", 5], "^hooke convert: ")):
            self.assert_one_line(self.hooke("convert", "a.obj", *arguments, code=2)[1], complaint)

    def test_solids_that_cannot_be_joined(self):
        self.write_boxes("a.obj", ((0, 0, 0), (2, 2, 2)))
        self.write_boxes("open.obj", ((1, 1, 1), (3, 3, 3)), without=1)
        self.write_boxes("far.obj", ((5, 5, 5), (6, 6, 6)))
        self.assert_one_line(self.hooke("convert", "a.obj", "--union", "open.obj", "x.obj", code=2)[1],
                             r"^b\.mesh\.triangles\[\d+\]: has an edge without a neighbor, one of 4 such edges")
        self.assert_one_line(self.hooke("convert", "a.obj", "--intersect", "far.obj", "x.obj", code=2)[1],
                             "^--intersect: nothing is left")
        self.assert_one_line(self.hooke("convert", "a.obj", "x.obj", "--union", "far.obj", "--subtract", "far.obj",
                                        code=2)[1], "^hooke convert: ")
        self.assertNotIn("x.obj", self.files())

    def test_a_brick_lies_on_six_sides(self):
        self.write_boxes("brick.obj", ((0, 0, 0), (1, 2, 3)))
        out, _ = self.hooke("settle", "brick.obj", "--json", "-", "--csv", "poses.csv")
        report = json.loads(out)
        self.assertEqual(report["center"], [0.5, 1, 1.5])
        self.assertEqual(len(report["poses"]), 6)
        self.assertAlmostEqual(sum(pose["probability"] for pose in report["poses"]), 1, places=12)
        # 4 atan(p q / (r diagonal)) is the solid angle of a side p x q at the distance r / 2.
        first = report["poses"][0]
        self.assertAlmostEqual(first["probability"], math.atan(6 / math.sqrt(14)) / math.pi, places=12)
        self.assertAlmostEqual(first["tip_angle"], math.atan(2), places=6)
        lines = (self.folder / "poses.csv").read_text().splitlines()
        self.assertEqual((len(lines), len(lines[0].split(","))), (7, 9))
        self.assertEqual(float(lines[1].split(",")[1]), first["probability"])

    def test_drops_repeat_to_the_bit_and_sum_to_one(self):
        self.write_boxes("brick.obj", ((0, 0, 0), (1, 2, 3)))
        words = ("settle", "brick.obj", "--drops", 60, "--json", "-")
        out, _ = self.hooke(*words)
        self.assertEqual(self.hooke(*words)[0], out)
        self.assertNotEqual(self.hooke(*words, "--seed", 2)[0], out)
        report = json.loads(out)
        frequencies = [pose["frequency"] for pose in report["poses"]]
        self.assertAlmostEqual(sum(frequencies) + report["elsewhere"] + report["moving"], 1, places=12)
        # Slow rolling gives 0.645 for the two largest sides; 60 drops scatter by 0.06 about that.
        self.assertAlmostEqual(frequencies[0] + frequencies[1], 0.645, delta=0.18)

    def test_a_model_is_written_as_it_lies(self):
        self.write_boxes("brick.obj", ((0, 0, 0), (1, 2, 3)))
        self.hooke("settle", "brick.obj", "--out", "lying.obj", "--pose", 1)
        lines = (self.folder / "lying.obj").read_text().split("\n")
        heights = [float(line.split()[2]) for line in lines if line.startswith("v ")]
        self.assertAlmostEqual(min(heights), 0, places=6)
        self.assertAlmostEqual(max(heights), 1, places=6)
        self.assert_one_line(self.hooke("settle", "brick.obj", "--out", "x.obj", "--pose", 7, code=2)[1],
                             "^--pose: 7: the model has 6 stable poses")

    def test_a_brick_hangs_turns_and_lies_on_a_slope(self):
        self.write_boxes("brick.obj", ((0, 0, 0), (1, 2, 3)))
        words = ("settle", "brick.obj", "--json", "-", "--mass", 10)
        # Hung by two upright cables 2 m apart, 0.5 m and 1.5 m from the center: 3/4 and 1/4 of the weight.
        out, _ = self.hooke(*words, "--cable", "0.5,2,1,0.5,9,1,3", "--cable", "0.5,2,3,0.5,9,3,3", "--out", "h.obj")
        pose = json.loads(out)["poses"][0]
        self.assertAlmostEqual(pose["tensions"][0], 0.75 * 98.1, places=6)
        self.assertAlmostEqual(pose["tensions"][1], 0.25 * 98.1, places=6)
        lines = (self.folder / "h.obj").read_text().split("\n")
        heights = [float(line.split()[2]) for line in lines if line.startswith("v ")]
        self.assertAlmostEqual(max(heights), 6, places=5)
        # About the z axis through its corner the center hangs below, at atan(1 / 2) from the side.
        turn = json.loads(self.hooke(*words, "--axis", "0,0,1", "--friction-torque", 5)[0])
        self.assertAlmostEqual(turn["stable_angle"], -math.pi / 2 - math.atan(2), places=6)
        self.assertAlmostEqual(turn["torque"], -98.1 * 0.5, places=6)
        self.assertFalse(turn["stays"])
        slope = json.loads(self.hooke(*words, "--slope", 30, "--friction", 0.4)[0])
        self.assertTrue(slope["slides"])
        self.assertAlmostEqual(slope["slide_angle"], math.atan(0.4), places=12)
        for arguments, complaint in ((["--cable", "1,2,3"], "^--cable: '1,2,3' is not seven numbers"),
                                     (["--cable", "0,0,0,0,1,0,-1"], r"^cables\[0\]\.length: "),
                                     (["--axis", "0,0,0"], "^axis: must have a length"),
                                     (["--friction", 1], "^--friction: needs --drops, --disturb or --slope")):
            self.assert_one_line(self.hooke("settle", "brick.obj", *arguments, code=2)[1], complaint)

    def test_an_open_model_takes_its_center_from_voxels_or_from_the_user(self):
        self.write_boxes("open.obj", ((0, 0, 0), (1, 2, 3)), without=1)
        out, errors = self.hooke("settle", "open.obj", "--json", "-")
        self.assertIn("closed by voxels", errors)
        self.assertAlmostEqual(json.loads(out)["center"][2], 1.5, delta=0.05)
        out, errors = self.hooke("settle", "open.obj", "--center", "0.5,1,0.2", "--json", "-")
        self.assertEqual((json.loads(out)["center"], errors), ([0.5, 1, 0.2], ""))
        self.assert_one_line(self.hooke("settle", "open.obj", "--center", "9,1,1", code=2)[1], "^center: ")
        self.assertIn("closed", self.hooke("settle", "open.obj", "--drops", 1, code=2)[1].splitlines()[-1])

    def test_bad_models_and_names(self):
        (self.folder / "bad.3ds").write_bytes(b"MM\x00")
        self.assert_one_line(self.hooke("convert", "bad.3ds", "x.obj", code=2)[1], r"^bad\.3ds: ")
        self.assert_one_line(self.hooke("convert", "none.obj", "x.obj", code=2)[1], r"^none\.obj: ")
        done = self.hooke("convert", "scenes/models/crate.3ds", "none/x.obj", code=3)
        self.assertRegex(done[1], r"^none/\S+: cannot be written")
        self.assertEqual(self.files(), ["bad.3ds"])

    def test_a_kind_of_model_that_is_not_known_is_bad_input(self):
        (self.folder / "x.xyz").write_text("0 0 0\n")
        self.assert_one_line(self.hooke("convert", "x.xyz", "out.obj", code=2)[1], r"^x\.xyz: not one of")
        self.assert_one_line(self.hooke("convert", "scenes/models/crate.3ds", "out.xyz", code=2)[1],
                             "not one of")
        content = {"version": 1, "meshes": {"m": {"file": "x.xyz"}}}
        self.assertIn("not one of", self.hooke("run", self.scene(content), code=2)[1])


class Render(Program):
    def test_scenes_give_pictures_with_something_on_them(self):
        for scene in ("rope", "flag", "hanging_model"):
            self.draw(f"scenes/{scene}.json", "-o", "x.png", "--at", 0.2, "--size", "160x90")
            width, height, rows = read_png(self.folder / "x.png")
            self.assertEqual((width, height), (160, 90))
            # Sky and ground change from row to row only; things also change along a row.
            edges = sum(abs(row[i] - row[i - 3]) > 40 for row in rows for i in range(3, len(row)))
            self.assertGreater(edges, 20, scene)

    def test_tiles_mark_the_ground_or_not(self):
        def colors(tiles):
            """Number of changes along the rows of the lower half, which shows ground alone."""
            ground = {"name": "ground", "material": "stone", "shape": {"half_space": {}}}
            self.draw(self.scene({"version": 1, "materials": {"stone": {"tiles": tiles}}, "bodies": [ground],
                                  "camera": {"eye": [0, 0.6, 1.2], "target": [0, 0, 0]}}),
                      "-o", "x.png", "--size", "160x90")
            rows = read_png(self.folder / "x.png")[2][50:]
            return sum(abs(row[i] - row[i - 3]) > 1 for row in rows for i in range(3, len(row)))
        self.assertLess(colors(0), 20)
        self.assertGreater(colors(0.5), 300)

    def test_what_is_drawn_in_place_of_a_body_has_its_color_where_the_file_has_none(self):
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
        cube = "".join(f"v {x - 0.5} {y - 0.5} {z - 0.5}\n" for x, y, z in corners)
        cube += "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)
        (self.folder / "plain.obj").write_text(cube)
        (self.folder / "green.obj").write_text("mtllib green.mtl\nusemtl green\n" + cube)
        (self.folder / "green.mtl").write_text("newmtl green\nKd 0 1 0\n")
        for file, strongest in (("plain.obj", 0), ("green.obj", 1)):
            content = {"version": 1, "materials": {"red": {"color": [1, 0, 0]}}, "meshes": {"m": {"file": file}},
                       "bodies": [{"material": "red", "visual": "m", "shape": {"sphere": {"radius": 0.5}}}],
                       "camera": {"eye": [0, 0, 2], "target": [0, 0, 0]}}
            self.draw(self.scene(content), "-o", "x.png", "--size", "64x64")
            pixel = read_png(self.folder / "x.png")[2][32][96:99]
            self.assertEqual(max(range(3), key=lambda i: pixel[i]), strongest, (file, list(pixel)))

    def test_pictures_between_two_steps_differ_from_both(self):
        content = dict(copy.deepcopy(FALLING), camera={"eye": [0, 10, 3], "target": [0, 10, 0]})
        content["particles"][0]["particles"][0]["velocity"] = [20, 0, 0]
        self.draw(self.scene(content), "-o", "x_%02d.png", "--fps", 240, "--seconds", 0.02, "--size", "160x90")
        pictures = [(self.folder / f"x_{i:02}.png").read_bytes() for i in range(5)]
        self.assertEqual(len(set(pictures)), 5)
        self.draw("scene.json", "-o", "y.png", "--at", 1 / 60, "--size", "160x90")
        self.assertEqual(read_png(self.folder / "y.png"), read_png(self.folder / "x_04.png"))

    def test_a_film_has_as_many_pictures_as_its_length_says(self):
        probe = shutil.which("ffprobe")
        if probe is None:
            self.skipTest("no ffprobe")
        self.draw("scenes/rope.json", "-o", "x.mp4", "--fps", 25, "--seconds", 0.4, "--size", "160x90")
        count = subprocess.run([probe, "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames",
                                "-of", "csv=p=0", "x.mp4"], cwd=self.folder, capture_output=True, text=True,
                               check=True)
        self.assertEqual(count.stdout.strip().rstrip(","), "10")

    def test_bounding_volumes_are_drawn_around_bodies(self):
        words = ("scenes/paper/fig7.json", "--at", 0.1, "--size", "160x90")
        self.draw(*words, "-o", "plain.png")
        self.draw(*words, "-o", "bounds.png", "--bounds", "sphere,oriented_box")
        self.assertNotEqual((self.folder / "plain.png").read_bytes(), (self.folder / "bounds.png").read_bytes())
        self.hooke("view", words[0], "--bounds", "cube", code=2)
        _, err = self.hooke("render", *words, "-o", "x.png", "--bounds", "cube", code=2)
        self.assert_one_line(err, "no bounding volume is called 'cube'")

    def test_what_the_engine_knows_is_shown_in_pictures(self):
        words = ("scenes/rope.json", "--at", 0.5, "--size", "320x180")
        self.draw(*words, "-o", "plain.png")
        pictures = {(self.folder / "plain.png").read_bytes()}
        for shown in ("loads", "loads,numbers", "velocities", "boxes"):
            self.draw(*words, "-o", "x.png", "--show", shown)
            pictures.add((self.folder / "x.png").read_bytes())
        self.assertEqual(len(pictures), 5)
        _, err = self.hooke("render", *words, "-o", "x.png", "--show", "forces", code=2)
        self.assert_one_line(err, "'forces' is none of contacts, velocities, boxes, loads")
        _, err = self.hooke("render", *words, "-o", "x.png", "--show", "numbers", code=2)
        self.assert_one_line(err, "add that, too")

    def test_without_ffmpeg_a_film_is_refused_and_leaves_nothing(self):
        self.draw("scenes/rope.json", "-o", "x.png", "--at", 0, "--size", "16x16")
        (self.folder / "x.png").unlink()
        _, err = self.hooke("render", "scenes/rope.json", "-o", "x.mp4", "--seconds", 0.1, "--size", "16x16",
                            code=3, environment={**os.environ, "PATH": "/nowhere"})
        self.assert_one_line(err, "ffmpeg")
        self.assertEqual(self.files(), [])


class Bench(Program):
    def test_without_a_scene_it_says_what_it_wants(self):
        _, err = self.hooke("bench", code=2)
        self.assert_one_line(err, "name a scene, or say --peers")

    def test_peers_run_the_same_scene_or_it_says_how_to_get_them(self):
        words = ("bench", "scenes/stack_10.json", "--peers", "--steps", "40", "--csv", "peers.csv")
        if not (pathlib.Path(PROGRAM).parent / "hooke-peers").exists():
            _, err = self.hooke(*words, code=3)
            self.assert_one_line(err, "-DHOOKE_BENCH=ON")
            return
        self.hooke(*words)
        rows = list(csv.DictReader((self.folder / "peers.csv").read_text().splitlines()))
        self.assertEqual([row["engine"] for row in rows], ["hooke", "bullet", "ode"])
        for row in rows:
            self.assertGreaterEqual(float(row["ms_step_median"]), float(row["ms_step_min"]))
            # Ten boxes that touch at the start sink a little and stay: an overlap that another engine hands over
            # wrongly would be a whole box, or none at all.
            self.assertGreater(float(row["max_penetration"]), 1e-5)
            self.assertLess(float(row["max_penetration"]), 0.02)

    def test_opposing_faces_are_measured_or_it_says_how_to_get_them(self):
        if not (pathlib.Path(PROGRAM).parent / "hooke-ofg").exists():
            _, err = self.hooke("bench", "ofg", code=3)
            self.assert_one_line(err, "-DHOOKE_BENCH=ON")

    def test_peers_are_not_given_cloth(self):
        if not (pathlib.Path(PROGRAM).parent / "hooke-peers").exists():
            self.skipTest("hooke-peers was not built")
        out, err = self.hooke("bench", "scenes/flag.json", "--peers")
        self.assertEqual(out.count("\n"), 1)
        self.assertIn("has cloths", err)


class View(Program):
    def test_without_a_display_it_says_so(self):
        environment = {key: value for key, value in os.environ.items()
                       if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        _, err = self.hooke("view", "scenes/rope.json", code=3, environment=environment)
        self.assert_one_line(err, "there is no display")

    def test_scenes_and_models_are_shown(self):
        server = os.environ.get("XVFB_RUN")
        if not server:
            self.skipTest("no xvfb-run")
        for what, *style in (["scenes/rope.json"], ["scenes/models/lantern.3ds", "--painter"],
                             ["scenes/paper/fig7.json", "--bounds", "sphere"]):
            words = [server, "-a", "-s", "-screen 0 640x480x24", PROGRAM, "view", what, "--seconds", "0.02",
                     "--screenshot", "x.png", *style]
            # The display's libraries leave a few bytes behind; leaks of ours show without a display too.
            environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
            done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, check=False,
                                  env=environment, timeout=LIMIT)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = read_png(self.folder / "x.png")[2]
            edges = sum(abs(row[i] - row[i - 3]) > 40 for row in rows for i in range(3, len(row)))
            self.assertGreater(edges, 100, what)
            (self.folder / "x.png").unlink()


class Help(Program):
    def test_every_example_works(self):
        commands = re.findall(r"^  (\w+) ", self.hooke("--help")[0].split("Commands:")[1].split("Exit")[0], re.M)
        self.assertGreaterEqual(set(commands), {"run", "view", "render", "convert", "validate", "new"})
        texts = [self.hooke("--help")[0]] + [self.hooke(command, "--help")[0] for command in commands]
        for text in texts:
            examples = re.findall(r"^  hooke (.*)$", text.split("Examples:")[1], re.M)
            self.assertTrue(examples, text)
            for words in map(str.split, examples):
                if words[0] == "render":
                    self.draw(*words[1:])
                elif words[0] == "compare" and shutil.which("gnuplot") is None:
                    continue
                elif words == ["bench", "ofg"]:
                    continue  # a program of its own, built with the benchmarks alone
                elif words[0] == "check" and not re.search(r"V\d|--list", " ".join(words)):
                    self.hooke(*words, "V1")  # all cases are tests of their own, of minutes with a sanitizer
                elif words[0] != "view":
                    self.hooke(*words)

    def test_exit_codes_are_documented(self):
        out, _ = self.hooke("--help")
        for code in ("0  good", "1  an expectation", "2  bad input", "3  the machine"):
            self.assertIn(code, out)


if __name__ == "__main__":
    PROGRAM, PROJECT = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
