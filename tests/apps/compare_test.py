"""Runs `hooke compare` and what else drives the laboratory, as a user does: compare_test.py PROGRAM PROJECT_FOLDER."""

import copy
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import cli_test
from cli_test import Program
from png import read_png

# A mass of 1 kg below a spring of 400 N/m, let go 0.1 m below its rest: omega = 20/s, zeta = 0.1.
OSCILLATOR = {
    "version": 1,
    "seconds": 2,
    "dt": 0.001,
    "particles": [{
        "name": "mass",
        "particles": [{"position": [0, 2, 0]}, {"position": [0, 0.875, 0]}],
        "springs": [{"a": 0, "b": 1, "stiffness": 400, "damping": 4, "rest_length": 1}],
        "pins": [0],
    }],
}


def stiff():
    """The paper's pendulum: 1 kg on 10 000 N/m at 60 Hz, without damping."""
    scene = copy.deepcopy(OSCILLATOR)
    scene["dt"] = 1 / 60
    scene["particles"][0]["particles"][1]["position"] = [0.7, 1.3, 0]
    scene["particles"][0]["springs"][0] = {"a": 0, "b": 1, "stiffness": 10000}
    return scene


def two_towers(preselection):
    """Two plates that stand 10 m apart, with two boxes above each that fall on it."""
    box = {"shape": {"box": {"half_extents": [0.25, 0.25, 0.25]}}}
    bodies = [box | {"position": [x, -0.25, 0]} for x in (0, 10)]
    bodies += [box | {"name": f"box_{x}_{i}", "kind": "dynamic", "position": [x, y, 0]}
               for x in (0, 10) for i, y in enumerate((0.375, 1.125))]
    return {
        "version": 1,
        "seconds": 0.5,
        "bodies": bodies,
        "laboratory": {"stepper": "rk4", "preselection": preselection, "regional": False},
    }


class Compare(Program):
    def compare(self, *words, code=0):
        """Runs it into `out` and returns the rows of the summary by stepper."""
        if code == 0 and shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        self.hooke("compare", *words, "--out", "out", code=code)
        return self.summary()

    def summary(self):
        with open(self.folder / "out" / "summary.csv", encoding="utf-8", newline="") as file:
            return {row["stepper"]: row for row in csv.DictReader(file)}

    def series(self, stepper):
        with open(self.folder / "out" / f"series_{stepper}.csv", encoding="utf-8", newline="") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_errors_are_against_the_exact_oscillator(self):
        rows = self.compare(self.scene(OSCILLATOR), "--steppers", "euler,verlet,rk4,solver")
        # y(t) = rest + e^(-2 t) (0.1 cos(wd t) + 0.2 / wd sin(wd t)) downward, rest = 1 + g / 400.
        damped = math.sqrt(396)
        for row in self.series("reference")[::97]:
            t = row["time_s"]
            swing = 0.125 - 9.81 / 400
            y = math.exp(-2 * t) * swing * (math.cos(damped * t) + 2 / damped * math.sin(damped * t))
            self.assertAlmostEqual(row["y_m"], 2 - (1 + 9.81 / 400 + y), delta=1e-6)
        self.assertLess(float(rows["rk4"]["largest_error_m"]), 1e-7)
        self.assertGreater(float(rows["euler"]["largest_error_m"]), 1e-4)
        self.assertLess(float(rows["solver"]["largest_error_m"]), 1e-3)
        for stepper, order in (("euler", 1), ("verlet", 2), ("rk4", 4)):
            self.assertAlmostEqual(float(rows[stepper]["order"]), order, delta=0.1)
            self.assertEqual(float(rows[stepper]["order_theory"]), order)
        self.assertEqual([round(float(rows[s]["evaluations_per_s"]), -1) for s in ("euler", "rk4")], [1000, 4000])

    def test_a_scene_of_more_than_a_spring_has_no_closed_form(self):
        solid = {"name": "jelly", "cells": [1, 1, 1], "size": [0.1, 0.1, 0.1], "position": [9, 9, 9]}
        hook = {"name": "string", "kind": "distance", "b": "mass", "b_point": 1, "anchor": [0.1, 0.875, 0],
                "anchor_b": [0, 0.875, 0], "limits": {"upper": 0.2}}
        for more, is_exact in (({}, True), ({"solids": [solid]}, False), ({"hooks": [hook]}, False)):
            self.compare(self.scene(OSCILLATOR | more), "--steppers", "rk4", "--seconds", 0.2)
            page = (self.folder / "out" / "index.html").read_text()
            self.assertEqual("the exact damped oscillator" in page, is_exact, more)

    def test_the_paper_diverges_where_theory_says(self):
        rows = self.compare(self.scene(stiff()), "--steppers", "euler,taylor2_paper,paper,verlet,rk4,solver")
        gone = {stepper for stepper, row in rows.items() if row["diverged_at_s"]}
        self.assertEqual(gone, {"euler", "taylor2_paper", "paper"})
        for stepper, limit in (("paper", 7200), ("verlet", 14400), ("rk4", 28800)):
            self.assertAlmostEqual(float(rows[stepper]["largest_stiffness_N_per_m"]) / limit, 1, delta=0.01)
        self.assertEqual(float(rows["euler"]["largest_stiffness_N_per_m"]), 0)
        self.assertLess(len(self.series("euler")), len(self.series("rk4")))

    def test_the_page_needs_nothing_else(self):
        self.compare(self.scene(OSCILLATOR | {"title": "A <mass> & a spring"}), "--steppers", "rk4,solver", "--seconds", 0.5)
        page = (self.folder / "out" / "index.html").read_text()
        names = ["trajectory", "position", "error", "energy", "order", "cost"]
        self.assertEqual(page.count("<svg "), 2)  # order and cost; the script draws the others
        self.assertLess(len(page), 2e6)
        self.assertEqual(re.findall(r"(?:src|href)\s*=\s*[\"'](?!#)", page.replace("xlink:", "")), [])
        self.assertNotIn("url(http", page)
        self.assertIn("A &lt;mass&gt; &amp; a spring", page)
        ids = re.findall(r"\sid\s*=\s*[\"']([^\"']+)", page)
        self.assertEqual(len(ids), len(set(ids)), "each picture keeps its own names")
        files = sorted(path.name for path in (self.folder / "out").iterdir())
        self.assertEqual(files, sorted([f"{n}.{e}" for n in names for e in ("png", "svg")] + [
            "index.html", "order.csv", "series_reference.csv", "series_rk4.csv", "series_solver.csv", "summary.csv"]))
        self.assertEqual(read_png(self.folder / "out" / "error.png")[:2], (1290, 705))

    def test_without_gnuplot_the_tables_are_written_all_the_same(self):
        _, err = self.hooke("compare", self.scene(OSCILLATOR), "--steppers", "rk4", "--seconds", 0.1, "--no-limits",
                            "--out", "out", code=3, environment={"PATH": "/nowhere"})
        self.assert_one_line(err, "^gnuplot: cannot start the program: .*gnuplot-nox")
        self.assertEqual(list(self.summary()), ["rk4"])
        page = (self.folder / "out" / "index.html").read_text()
        self.assertIn("Pictures are missing", page)
        self.assertNotIn("<svg ", page)

    def data(self):
        """What the script of the page draws."""
        page = (self.folder / "out" / "index.html").read_text()
        return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])

    def test_a_stepper_that_diverges_is_drawn_up_to_where_it_leaves_with_when_and_why(self):
        name = self.scene(stiff())
        if shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        out, err = self.hooke("compare", name, "--steppers", "euler,rk4,heun,solver", "--no-limits", "--out", "out")
        self.assertNotIn("skipped", out + err)
        rows = self.summary()
        self.assertEqual(list(rows), ["euler", "rk4", "heun", "solver"])
        # |g| = sqrt(1 + y^2) and sqrt(1 + y^4 / 4), y = 100/s / 60 Hz.
        for stepper, factor in (("euler", math.sqrt(1 + (5 / 3) ** 2)), ("heun", math.sqrt(1 + (5 / 3) ** 4 / 4))):
            gone = float(rows[stepper]["diverged_at_s"])
            steps = math.log(10) / math.log(factor)
            said = f"{stepper} diverges; at {gone:.3g} s it is gone: an oscillation of omega = 100/s .*" \
                   f"grows by the factor {factor:.6g} a step: 10 times after {steps:.3g} steps"
            self.assertRegex(out, said)
            run = next(run for run in self.data()["runs"] if run["name"] == stepper)
            self.assertAlmostEqual(run["gone"], gone, delta=1e-5)
            self.assertGreater(len(run["frames"]), 3)
            self.assertLess(len(run["frames"]), self.data()["motion"]["count"])
        self.assertIsNone(next(run for run in self.data()["runs"] if run["name"] == "rk4")["gone"])

    def test_growth_on_the_page_is_that_of_the_textbooks(self):
        steppers = ["euler", "symplectic_euler", "verlet", "rk4", "implicit_euler", "am2", "midpoint"]
        self.compare(self.scene(stiff()), "--steppers", ",".join(steppers), "--no-limits")
        stability = self.data()["stability"]
        self.assertAlmostEqual(stability["omega_dt"], 5 / 3, delta=1e-5)
        self.assertEqual([round(abs(complex(*z)), 4) for z in stability["z"]][0], 1.6667)
        known = {
            "euler": lambda y: math.sqrt(1 + y * y), "implicit_euler": lambda y: 1 / math.sqrt(1 + y * y),
            "midpoint": lambda y: math.sqrt(1 + y ** 4 / 4), "am2": lambda y: 1,
            "rk4": lambda y: math.sqrt(1 - y ** 6 / 72 + y ** 8 / 576),
            "verlet": lambda y: 1 if y <= 2 else y * y / 2 - 1 + math.sqrt((y * y / 2 - 1) ** 2 - 1),
        }
        known["symplectic_euler"] = known["verlet"]
        limits = {"symplectic_euler": 2, "verlet": 2, "rk4": math.sqrt(8), "euler": 0, "midpoint": 0}
        self.assertEqual([method["name"] for method in stability["methods"]], steppers)
        for method in stability["methods"]:
            self.assertEqual(len(method["curve"]), 80)
            for y, growth in method["curve"]:
                # At y = 2 two roots meet, and split by the square root of rounding.
                self.assertAlmostEqual(growth, known[method["name"]](y), delta=1e-6 if y != 2 else 1e-3)
            if method["name"] in limits:
                self.assertAlmostEqual(method["limit"], limits[method["name"]], delta=1e-4)
            self.assertAlmostEqual(method["undamped"], known[method["name"]](5 / 3), delta=1e-5)
        # The region of explicit Euler is the disk about -1.
        for imaginary, low, high in stability["methods"][0]["spans"]:
            half = math.sqrt(1 - imaginary ** 2)
            self.assertAlmostEqual(low, -1 - half, delta=1e-4)
            self.assertAlmostEqual(high, -1 + half, delta=1e-4)

    def test_the_script_of_the_page_moves_plots_and_zooms(self):
        if shutil.which("node") is None:
            self.skipTest("node is not installed")
        self.compare(self.scene(stiff()), "--steppers", "euler,rk4,solver", "--no-limits")
        script = cli_test.PROJECT / "tests/apps/compare_page_test.js"
        done = subprocess.run(["node", str(script), str(self.folder / "out" / "index.html")], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.stdout, "page: ok\n", done.stdout + done.stderr)

    def test_rigid_ropes_and_solids_are_replaced_or_left_out_and_that_is_said(self):
        scene = {"version": 1, "seconds": 0.2, "dt": 0.001,
                 "ropes": [{"name": "rope", "hook_point": [0, 2, 0], "direction": [1, 0, 0], "masses": 4, "pins": [0]}],
                 "solids": [{"name": "jelly", "position": [5, 2, 0], "cells": [1, 1, 1]}]}
        if shutil.which("gnuplot") is None:
            self.skipTest("gnuplot is not installed")
        out, _ = self.hooke("compare", self.scene(scene), "--steppers", "rk4,solver", "--no-limits", "--out", "out")
        self.assertEqual(list(self.summary()), ["rk4", "solver"])
        page = (self.folder / "out" / "index.html").read_text()
        for text in (out, page):
            self.assertRegex(text, "rope: 3 rigid segments: springs stand for them, of up to .* N/m")
            self.assertRegex(text, "jelly: the whole solid, which stands still")

    def test_the_default_steppers_run_a_scene_that_some_of_them_cannot(self):
        self.assertEqual(set(self.compare(self.scene(stiff()), "--no-limits")), {"euler", "heun", "rk4", "solver"})

    def test_a_declared_accuracy_is_chosen_for_and_judged(self):
        scene = stiff() | {"accuracy": {"max_error": 1e-6}, "seconds": 0.5}
        rows = self.compare(self.scene(scene), "--steppers", "rk4", "--no-limits")
        self.assertEqual(list(rows), ["rk4", "declared"])
        self.assertLess(float(rows["declared"]["largest_error_m"]), 1e-6)
        self.assertRegex((self.folder / "out" / "index.html").read_text(), "declared</b> .*, within the declared 1e-06 m")

    def test_bodies_are_compared_by_their_centers_and_their_pairs_are_counted(self):
        counts = {}
        for preselection in ("all_pairs", "oriented_box"):
            rows = self.compare(self.scene(two_towers(preselection)), "--steppers", "rk4,solver", "--no-limits")
            counts[preselection] = [int(rows["rk4"][key]) for key in ("pairs_asked", "pairs_touching")]
            self.assertEqual(rows["solver"]["pairs_asked"], "0")
            # It falls 0.125 m in 0.16 s, and stays.
            self.assertAlmostEqual(self.series("rk4")[-1]["y_m"], 0.25, delta=1e-5)
        steps, pairs = 30, 14  # of six boxes, without the two that stand
        self.assertGreaterEqual(counts["all_pairs"][0], steps * pairs)
        self.assertLess(counts["oriented_box"][0], counts["all_pairs"][0] / 2)
        self.assertGreater(counts["oriented_box"][1], 0)
        self.assertEqual(counts["oriented_box"][1], counts["all_pairs"][1])
        out, _ = self.hooke("compare", "scene.json", "--steppers", "rk4", "--no-limits", "--out", "out")
        self.assertRegex(out, "pairs asked +pairs touching")

    def test_bad_input_is_one_line_and_leaves_nothing(self):
        name = self.scene(stiff())
        cases = [
            (("none.json",), r"^none\.json: "),
            ((name, "--steppers", "rk5"), "^stepper: there is no 'rk5'; there are solver, euler, "),
            ((name, "--dt", 0), "--dt: 0 is not a number from"),
            ((name, "--dt", "nan"), "--dt: nan is not a number from"),
            ((name, "--seconds", -1), "--seconds: -1 is not a number"),
            ((name, "--point", "mass:2"), "^--point: '2' is no point of 'mass', which has points 0 to 1"),
            ((name, "--point", "mass:"), "^--point: '' is no point"),
            ((name, "--point", "rope"), "^--point: there is no object 'rope'"),
        ]
        for words, pattern in cases:
            _, err = self.hooke("compare", *words, "--out", "out", code=2)
            self.assert_one_line(err, pattern)
        self.assertEqual(self.files(), ["scene.json"])
        (self.folder / "taken").write_text("mine")
        _, err = self.hooke("compare", name, "--steppers", "rk4", "--out", "taken", code=3)
        self.assert_one_line(err, "^taken: ")
        self.assertEqual((self.folder / "taken").read_text(), "mine")


class Laboratory(Program):
    def test_a_run_reports_what_was_chosen_and_reached(self):
        scene = stiff() | {"accuracy": {"max_error": 1e-5}}
        report = json.loads(self.hooke("run", self.scene(scene), "--stepper", "declared", "--seconds", 0.5, "--json", "-")[0])
        (mass,) = report["objects"]
        self.assertEqual((mass["name"], report["stepper"]), ("mass", "declared"))
        self.assertLess(mass["dt"], 1 / 60)
        self.assertLess(mass["error"], 1e-5)
        out, _ = self.hooke("run", "scene.json", "--stepper", "rk4", "--seconds", 0.5, "--csv", "steps.csv")
        self.assertRegex(out, r"\nmass: rk4, 30 steps of 0\.01667 s")
        self.assertEqual((self.folder / "steps.csv").read_text().count("\n"), 31)

    def test_an_object_keeps_the_stepper_it_names(self):
        scene = stiff()
        scene["particles"][0]["stepper"] = "verlet"
        out, _ = self.hooke("run", self.scene(scene), "--stepper", "rk4", "--seconds", 0.5)
        self.assertRegex(out, "\nmass: verlet, ")

    def test_bad_steppers_are_refused(self):
        name = self.scene(stiff())
        for stepper, pattern in (("rk5", "rk5"), ("euler", "diverges"), ("declared", "needs 'accuracy'")):
            self.assert_one_line(self.hooke("run", name, "--stepper", stepper, code=2)[1], pattern)
        self.hooke("run", name, "--force", code=2)

    def test_a_trail_leaves_the_pendulum_in_the_picture(self):
        words = ("scenes/paper/fig2.json", "--stepper", "euler", "--force", "--at", 1, "--size", "240x180")
        self.draw(*words, "-o", "now.png")
        self.draw(*words, "-o", "trail.png", "--trail", 0.05)

        def orange(name):
            pixels = b"".join(read_png(self.folder / name)[2])
            return sum(1 for i in range(0, len(pixels) - 2, 3) if pixels[i] > pixels[i + 2] + 40)
        self.assertGreater(orange("trail.png"), 3 * orange("now.png"))


if __name__ == "__main__":
    cli_test.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    cli_test.PROJECT = pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
