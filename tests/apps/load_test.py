"""Runs `hooke load` as a user does, against statics: load_test.py PROGRAM PROJECT_FOLDER."""

import csv
import json
import math
import pathlib
import sys
import unittest

import cli_test
import trusses
from cli_test import Program
from png import read_png

G = 9.81


def block(half, friction, mass=100):
    """A block on the ground."""
    return {"version": 1, "bodies": [
        {"name": "ground", "shape": {"half_space": {}}, "friction": friction},
        {"name": "block", "kind": "dynamic", "mass": mass, "friction": friction, "position": [0, half[1], 0],
         "shape": {"box": {"half_extents": half}}}]}


def hanging_bar(**hook):
    """A bar of 10 kg that hangs straight down from a hinge."""
    return {"version": 1,
            "bodies": [{"name": "bar", "kind": "dynamic", "mass": 10, "position": [0, -0.5, 0],
                        "shape": {"box": {"half_extents": [0.02, 0.5, 0.02]}}}],
            "hooks": [{"name": "pin", "kind": "hinge", "axis": [0, 0, 1], "b": "bar", "anchor": [0, 0, 0]} | hook]}


def stretchy_rope(**more):
    """A rope of 1 kg with 20 kg at its end: its uppermost segment carries 20.95 kg."""
    return {"version": 1, "ropes": [{"name": "rope", "hook_point": [0, 3, 0], "direction": [0, -1, 0],
                                     "length_at_rest": 2, "masses": 11, "total_mass": 1, "stiffness": 5000,
                                     "loads": [{"point": "last", "mass": 20}]} | more]}


class Load(Program):
    def load(self, content, *words, code=0):
        """Returns the report and what was said on stderr."""
        out, errors = self.hooke("load", self.scene(content), *words, "--json", "-", code=code)
        return json.loads(out), errors

    def assert_between(self, found, exact, tolerance=1e-3):
        """The interval is narrow, and its middle is right."""
        self.assertLessEqual(found["load"] - found["held"], 1.001 * tolerance * found["load"])
        self.assertAlmostEqual(0.5 * (found["held"] + found["load"]) / exact, 1, delta=tolerance)


class Limits(Load):
    def test_a_block_tips_where_the_moment_of_the_force_is_that_of_its_weight(self):
        report, _ = self.load(block([0.5, 1, 0.5], 1), "--on", "block", "--at", "0,2,0", "--direction", "1,0,0")
        self.assert_between(report["collapse"], 100 * G * 0.5 / 2)
        self.assertEqual(report["collapse"]["kind"], "collapse")
        self.assertEqual(report["collapse"]["moves"][0]["object"], "block")
        self.assertGreater(report["collapse"]["moves"][0]["way"][0], 0.01)

    def test_a_block_slides_where_the_force_is_that_of_friction(self):
        report, _ = self.load(block([0.5, 0.5, 0.5], 0.3), "--on", "block", "--direction", "1,0,0")
        self.assert_between(report["collapse"], 0.3 * 100 * G)

    def test_a_hinge_breaks_where_load_and_weight_are_its_strength(self):
        report, _ = self.load(hanging_bar(break_force=500), "--on", "bar", "--at", "0,-1,0")
        (broken,) = report["breaks"]
        self.assertEqual(broken["object"], "pin")
        self.assert_between(broken, 500 - 10 * G)
        self.assertAlmostEqual(broken["force"], 500, delta=1)
        self.assertEqual(report["collapse"]["held"], broken["held"])

    def test_a_finer_tolerance_narrows_the_interval(self):
        report, _ = self.load(hanging_bar(break_force=500), "--on", "bar", "--tolerance", "1e-4", "--until", "break")
        self.assert_between(report["breaks"][0], 500 - 10 * G, 1e-4)
        self.assertIsNone(report["collapse"])

    def test_a_stretchy_rope_is_not_broken_by_a_step_of_the_load(self):
        # Loaded at once, it would swing to twice the extension and break at half the load.
        report, _ = self.load(stretchy_rope(strength=800), "--on", "rope:last")
        self.assert_between(report["breaks"][0], 800 - (20 + 0.95) * G)
        self.assertTrue(report["breaks"][0]["what"].startswith("rope, segment 0"))
        at_rest = [one for one in report["equilibria"] if one["load"] <= report["breaks"][0]["held"]]
        for one in at_rest:
            self.assertAlmostEqual(-one["way"][1] * 5000, one["load"], delta=1e-3 * (one["load"] + 210))
            self.assertLess(one["residual"], 1e-4 * (210 + one["load"]) * 1.01)

    def test_weight_that_would_snap_a_rope_if_it_came_at_once_is_raised_slowly(self):
        report, _ = self.load(stretchy_rope(strength=300), "--on", "rope:last")
        self.assert_between(report["breaks"][0], 300 - 20.95 * G)
        self.assertFalse(report["mechanism"])

    def test_weight_that_is_too_much_is_told_by_its_share(self):
        report, _ = self.load(stretchy_rope(strength=100), "--on", "rope:last", code=1)
        self.assertEqual((report["breaks"][0]["load"], report["equilibria"]), (0, []))
        self.assertAlmostEqual(report["breaks"][0]["weight"], 100 / (20.95 * G), delta=1e-3)


class Trusses(Load):
    """Bar forces by the method of joints, and the load of limit analysis."""

    def assert_forces(self, truss, report, loads, at=-1):
        exact = truss.forces(loads)
        largest = max(map(abs, exact.values()))
        found = {member["name"]: member["force"] for member in report["equilibria"][at]["members"]}
        for bar, force in exact.items():
            self.assertAlmostEqual(found["_".join(bar)], force, delta=1e-5 * largest, msg=str(bar))

    def check_rods(self, truss, on, load):
        report, errors = self.load(truss.of_rods() | {"world": {"gravity": [0, 0, 0]}}, "--on", ",".join(on),
                                   "--first", 10, "--until", load)
        self.assertEqual(errors, "")
        self.assert_forces(truss, report, {name: (0, -load / len(on)) for name in on})
        self.assertLess(report["largest_residual"], 1e-4 * load)

    def test_a_pratt_truss_of_rods(self):
        self.check_rods(trusses.pratt(), ["b1", "b2", "b3"], 60000)

    def test_a_cantilever_of_rods(self):
        self.check_rods(trusses.bracket(), ["t3"], 5000)

    def test_a_fink_roof_of_rods(self):
        self.check_rods(trusses.fink(), ["m", "top", "n"], 9000)

    def test_a_warren_truss_of_hinged_bars_with_weight(self):
        truss = trusses.warren()
        report, _ = self.load(truss.of_bars(), "--on", "b2", "--until", 1000 * G)
        weights = truss.weights(G, 1, 0.1)
        self.assert_forces(truss, report, weights, at=0)
        loads = weights | {"b2": (0, weights["b2"][1] - 1000 * G)}
        self.assert_forces(truss, report, loads)

    def test_sections_yield_and_buckle_where_bar_forces_say(self):
        truss = trusses.warren()
        # Tubes of steel, 20 mm by 2 mm: A = pi (R^2 - r^2), I = pi / 4 (R^4 - r^4).
        section = {"radius": 0.02, "thickness": 0.002, "young_modulus": 2.1e11, "yield_stress": 2.35e8}
        area = math.pi * (0.02**2 - 0.018**2)
        moment = math.pi / 4 * (0.02**4 - 0.018**4)
        each = truss.forces({"b2": (0, -1)})
        for factor, rods in ((1, True), (0.7, False)):
            section["length_factor"] = factor
            scene = truss.of_rods() if rods else truss.of_bars()
            for one in scene["hooks"] if rods else scene["bodies"]:
                if one.get("kind") == "distance" or "_" in one["name"] and not rods:
                    one["section"] = section
            scene["world"] = {"gravity": [0, 0, 0]}
            report, errors = self.load(scene, "--on", "b2", "--first", 100, "--until", 300000, "--nominal", 50000)
            self.assertEqual(errors, "")
            to_yield = {bar: area * 2.35e8 / abs(force) for bar, force in each.items() if abs(force) > 1e-6}
            weakest = min(to_yield, key=to_yield.get)
            first = report["first_yield"]
            self.assertAlmostEqual(first["at"] / to_yield[weakest], 1, delta=1e-4)
            self.assertAlmostEqual(to_yield[tuple(first["member"].split("_"))] / to_yield[weakest], 1, delta=1e-6)
            self.assertTrue(first["held"] < first["at"] <= first["load"])
            to_buckle = {bar: math.pi**2 * 2.1e11 * moment / (factor * truss.length(bar))**2 / -force
                         for bar, force in each.items() if force < -1e-6}
            self.assertAlmostEqual(report["first_buckling"]["at"] / min(to_buckle.values()), 1, delta=1e-4)
            least = min(min(to_yield.values()), min(to_buckle.values()))
            self.assertAlmostEqual(report["reserve"], least / 50000, delta=1e-3)
            last = {one["name"]: one for one in report["equilibria"][-1]["members"]}
            name = "_".join(weakest)
            self.assertAlmostEqual(last[name]["yield_force"], area * 2.35e8, delta=1)
            self.assertGreater(last[name]["utilization"], 1)

    def test_the_search_may_end_where_the_first_member_yields(self):
        truss = trusses.warren()
        scene = truss.of_rods(section={"area": 1e-4, "yield_stress": 2e8}) | {"world": {"gravity": [0, 0, 0]}}
        report, _ = self.load(scene, "--on", "b2", "--first", 100, "--until", "yield")
        self.assertEqual(report["equilibria"][-1]["load"], report["first_yield"]["load"])
        self.assert_between(report["first_yield"], 2e8 * 1e-4 / max(map(abs, truss.forces({"b2": (0, -1)}).values())))
        self.assertIsNone(report["first_buckling"])
        scene["hooks"][-1]["section"] = {"area": 1e-4}
        _, errors = self.load(scene, "--on", "b2", "--first", 100, "--until", 200)
        self.assert_one_line(errors, "warning: .*the section of '.*' has no effect: it needs a yield_stress")
        self.assert_one_line(self.hooke("load", self.scene(truss.of_rods()), "--on", "b2", "--until", "yield", code=2)[1],
                             "^--until yield: no body and no distance hook")

    def test_members_are_drawn_in_the_color_of_their_utilization(self):
        truss = trusses.warren()
        scene = truss.of_rods(section={"area": 1e-4, "yield_stress": 2e8}) | {"world": {"gravity": [0, 0, 0]}}
        words = ("load", self.scene(scene), "--on", "b2", "--first", 100, "--until", "yield", "--picture", "used.png")
        self.draw_by(*words)
        _, _, rows = read_png(self.folder / "used.png")
        pixels = [row[i:i + 3] for row in rows for i in range(0, len(row), 3)]
        # The weakest bar is violet, those at the supports are used by a quarter: between blue and green.
        self.assertTrue(any(min(r, b) > 2 * g and min(r, b) > 60 for r, g, b in pixels))
        self.assertTrue(any(g > 2 * r and g > b > r for r, g, b in pixels))

    def test_the_truss_of_15_bars_fails_at_the_load_of_limit_analysis(self):
        # It is statically determinate: it lasts as long as its bars do. Hinges of 20 kN carry half the weight
        # of a bar across it, too.
        truss = trusses.warren()
        own = truss.forces(truss.weights(G, 1, 0.1))
        each = truss.forces({"b2": (0, -1)})
        limit = min((20000 - abs(own[bar])) / abs(each[bar]) for bar in truss.bars)
        scene = truss.of_bars(break_force=20000)
        for more in ({}, {"dt": 1 / 120}, {"world": {"substeps": 16}}):
            report, _ = self.load(scene | more, "--on", "b2")
            self.assert_between(report["collapse"], limit)
            self.assertTrue(report["breaks"][0]["object"].startswith("t1_t2@"))
            self.assertEqual(report["collapse"]["kind"], "collapse")

    def test_a_truss_without_diagonals_is_a_mechanism(self):
        scene = trusses.pratt(panels=4).of_rods()
        report, _ = self.load(scene, "--on", "b2", "--until", 1)
        self.assertFalse(report["mechanism"])
        scene["hooks"] = [hook for hook in scene["hooks"] if hook["name"] not in ("t1_b2", "t3_b2")]
        report, _ = self.load(scene, "--on", "b2", "--until", 1)
        self.assertTrue(report["mechanism"])
        self.assertRegex(report["settling"][0]["object"], "t[123]")


class Ropes(Load):
    def test_a_plate_on_three_ropes(self):
        # Vertical ropes at three corners: moments about the lines through two of them.
        mass, at = 60, (0.2, -0.1)
        corners = [(-1, -1), (1, -1), (0, 1)]
        bodies = [{"name": "plate", "kind": "dynamic", "mass": mass, "position": [0, 0, 0],
                   "shape": {"box": {"half_extents": [1.2, 0.02, 1.2]}}}]
        ropes, hooks = [], []
        for i, (x, z) in enumerate(corners):
            ropes.append({"name": f"rope{i}", "points": [[x, 2 - 0.1 * k, z] for k in range(21)],
                          "total_mass": 0.001, "strength": 2000})
            hooks.append({"name": f"hook{i}", "a": "plate", "b": f"rope{i}", "b_point": "last",
                          "anchor": [x, 0, z]})
        scene = {"version": 1, "bodies": bodies, "ropes": ropes, "hooks": hooks}
        # Shares of a force at (x, z): those of the corners sum to 1 and have their mean there.
        def shares(x, z):
            return trusses.solve([[1, 1, 1], [c[0] for c in corners], [c[1] for c in corners]], [1, x, z])
        own = [mass * G * share for share in shares(0, 0)]
        parts = shares(*at)
        exact = min((2000 - weight) / part for weight, part in zip(own, parts))
        report, _ = self.load(scene, "--on", "plate", "--at", f"{at[0]},0.02,{at[1]}")
        self.assert_between(report["breaks"][0], exact)
        for equilibrium in report["equilibria"][:-1]:
            tensions = [one["force"] for one in equilibrium["members"] if one["kind"] == "rope"]
            for tension, weight, part in zip(tensions, own, parts):
                wanted = weight + part * equilibrium["load"]
                self.assertAlmostEqual(tension / wanted, 1, delta=1e-3)


class Stacks(Load):
    def overhang(self, share):
        """Four blocks, each beyond the one below by `share` of what statics allows: L / 2n for the n-th from top."""
        bodies = [{"name": "table", "position": [-1, -0.5, 0], "shape": {"box": {"half_extents": [1, 0.5, 1]}}}]
        x = -0.5  # center of a block of 1 m whose right side is at the table's edge
        for level in range(4):
            x += share / (2 * (4 - level))
            bodies.append({"name": f"block{level}", "kind": "dynamic", "mass": 2, "position": [x, 0.05 + 0.1 * level, 0],
                           "shape": {"box": {"half_extents": [0.5, 0.05, 0.2]}}})
        return {"version": 1, "bodies": bodies}

    def test_four_blocks_hang_over_as_far_as_their_centers_allow(self):
        report, _ = self.load(self.overhang(0.995), "--on", "block3", "--until", 0.001)
        self.assertLess(max(abs(one["way"][1]) for one in report["settling"]), 1e-4)
        # The uppermost falls past the table, and finds no rest.
        report, _ = self.load(self.overhang(1.005), "--on", "block3", "--until", 0.001, code=1)
        self.assertTrue(report["mechanism"])
        self.assertEqual(report["settling"][0]["object"], "block3")

    def test_a_load_on_the_top_block_tips_them(self):
        # Centers of blocks are share / 2n apart, n from the top. So that of the upper n is share / 2 beyond the
        # center of the block below, and (1 - share) / 2 behind its edge. The load is beyond that edge by:
        share = 0.9
        limits = []
        for count in range(1, 5):
            beyond = share * sum(1 / (2 * i) for i in range(1, count + 1)) - 0.5
            if beyond > 0:
                limits.append(2 * count * G * 0.5 * (1 - share) / beyond)
        report, _ = self.load(self.overhang(share), "--on", "block3")
        self.assert_between(report["collapse"], min(limits))


    def test_damping_of_bodies_takes_nothing_from_their_weight(self):
        scene = hanging_bar()
        scene["bodies"][0] |= {"linear_damping": 5, "angular_damping": 5}
        report, _ = self.load(scene, "--on", "bar", "--until", 1)
        self.assertAlmostEqual(report["equilibria"][0]["members"][0]["force"], 10 * G, delta=1e-3)


class Reports(Load):
    def test_the_reserve_is_told_and_counts(self):
        words = ("--on", "bar", "--nominal")
        report, _ = self.load(hanging_bar(break_force=500), *words, 200)
        self.assertAlmostEqual(report["reserve"], (500 - 10 * G) / 200, delta=2e-3)
        report, _ = self.load(hanging_bar(break_force=500), *words, 450, code=1)
        self.assertLess(report["reserve"], 1)
        report, _ = self.load(hanging_bar(), *words, 450, "--until", 900)
        self.assertEqual((report["reserve"], report["breaks"], report["collapse"]), (2, [], None))

    def test_members_have_their_force_with_its_sign(self):
        report, _ = self.load(hanging_bar(break_force=5000, break_torque=100), "--on", "bar", "--until", 300)
        joint = report["equilibria"][-1]["members"][0]
        self.assertEqual((joint["name"], joint["kind"], joint["strength"]), ("pin", "joint", 5000))
        self.assertAlmostEqual(joint["force"], 300 + 10 * G, delta=0.05)
        self.assertAlmostEqual(joint["utilization"], joint["force"] / 5000, places=6)
        report, _ = self.load(strut(), "--on", "top", "--until", 1000)
        self.assertAlmostEqual(report["equilibria"][-1]["members"][0]["force"], -1000 - G, delta=0.5)
        report, _ = self.load(strut(), "--on", "top", "--until", 1000, "--direction", "0,1,0")
        self.assertAlmostEqual(report["equilibria"][-1]["members"][0]["force"], 1000 - G, delta=0.5)

    def test_the_table_has_a_line_for_each_equilibrium(self):
        name = self.scene(hanging_bar(break_force=500))
        out, _ = self.hooke("load", name, "--on", "bar", "--csv", "table.csv", "--json", "report.json")
        report = json.loads((self.folder / "report.json").read_text())
        rows = list(csv.DictReader((self.folder / "table.csv").read_text().splitlines()))
        self.assertEqual([float(row["load"]) for row in rows], [one["load"] for one in report["equilibria"]])
        self.assertEqual([float(row["pin"]) for row in rows],
                         [one["members"][0]["force"] for one in report["equilibria"]])
        for word in ("without load at rest", "first break  'pin' (hook) at 40", "collapse", "found by"):
            self.assertIn(word, out)

    def test_the_same_words_give_the_same_report(self):
        words = ("--on", "bar", "--direction", "1,-1,0")
        report, _ = self.load(hanging_bar(break_force=500), *words)
        self.assertEqual(self.load(hanging_bar(break_force=500), *words, "--workers", 2)[0], report)

    def test_a_plot_is_drawn(self):
        name = self.scene(hanging_bar(break_force=500))
        self.hooke("load", name, "--on", "bar", "--plot", "plot.svg")
        self.assertIn("pin", (self.folder / "plot.svg").read_text())
        self.assertIn("--plot: 'x.gif' ends neither", self.hooke("load", name, "--on", "bar", "--plot", "x.gif",
                                                                 code=2)[1])


class Mechanisms(Load):
    def test_what_nothing_holds_is_named_with_its_motion(self):
        falling = block([0.5, 0.5, 0.5], 1)
        del falling["bodies"][0]
        out, _ = self.hooke("load", self.scene(falling), "--on", "block", "--patience", 2, code=1)
        self.assertRegex(out, r"mechanism .*no equilibrium without load")
        self.assertRegex(out, r"'block' by 1\d\.\d m along \(0.00, -1.00, 0.00\)")
        report, _ = self.load(falling, "--on", "block", "--patience", 2, code=1)
        self.assertEqual((report["equilibria"], report["collapse"]["load"]), ([], 0))

    def test_what_swings_comes_to_rest_without_friction(self):
        swinging = hanging_bar()
        swinging["bodies"][0] |= {"position": [0.5, 0, 0], "shape": {"box": {"half_extents": [0.5, 0.02, 0.02]}}}
        report, _ = self.load(swinging, "--on", "bar", "--until", 10)
        self.assertAlmostEqual(report["settling"][0]["way"][1], -0.5, delta=1e-3)
        self.assertAlmostEqual(report["equilibria"][0]["members"][0]["force"], 10 * G, delta=0.01)

    def test_what_falls_off_does_not_end_the_search(self):
        scene = hanging_bar(break_force=500)
        scene["bodies"].append({"name": "lamp", "kind": "dynamic", "mass": 1, "position": [0, -1.2, 0],
                                "collides": False, "shape": {"sphere": {"radius": 0.1}}})
        scene["hooks"].append({"name": "thread", "kind": "ball", "a": "bar", "b": "lamp", "anchor": [0, -1, 0],
                               "break_force": 50})
        # Half of the load on each: the lamp goes at 2 (50 - 9.81) N, the bar when it has lost the lamp.
        report, _ = self.load(scene, "--on", "bar,lamp")
        self.assertEqual(report["breaks"][0]["object"], "thread")
        self.assert_between(report["breaks"][0], 2 * (50 - G))


class BadWords(Load):
    def assert_refused(self, content, words, pattern):
        self.assert_one_line(self.hooke("load", self.scene(content), *words, code=2)[1], pattern)

    def test_names_that_cannot_be_loaded(self):
        scene = block([0.5, 0.5, 0.5], 1)
        self.assert_refused(scene, ("--on", "box"), "^--on box: there is no object.*can be loaded: 'block'")
        self.assert_refused(scene, ("--on", "ground"), "^--on ground: it cannot move.*'block'")
        self.assert_refused(scene, ("--on", "block:3"), "--at says a place")
        rope = {"version": 1, "ropes": [{"name": "rope", "masses": 4}]}
        self.assert_refused(rope, ("--on", "rope:9"), "its points are 0 to 3")
        self.assert_refused(rope, ("--on", "rope:0"), "pinned")

    def test_words_that_mean_no_load(self):
        scene = block([0.5, 0.5, 0.5], 1)
        on = ("--on", "block")
        self.assert_refused(scene, (*on, "--direction", "0,0,0"), "^--direction: has no length")
        self.assert_refused(scene, (*on, "--until", "noon"), "^--until: 'noon' is neither")
        self.assert_refused(scene, (*on, "--until", "-5"), "^--until: ")
        self.assert_refused(scene, ("--on", "block,block", "--at", "0,0,0"), "^--at: ")
        self.assert_refused(scene, (*on, "--nominal", 0), "--nominal")
        weightless = scene | {"world": {"gravity": [0, 0, 0]}}
        self.assert_refused(weightless, on, "^--first: is needed")

    def test_a_search_for_a_break_where_nothing_can_break(self):
        self.assert_refused(block([0.5, 0.5, 0.5], 1), ("--on", "block", "--until", "break"),
                            "nothing in the scene can break.*break_force")

    def test_a_timeline_is_left_out_and_that_is_said(self):
        scene = hanging_bar(break_force=500)
        scene["timeline"] = [{"at_step": 6, "remove": "bar"}]
        report, errors = self.load(scene, "--on", "bar", "--until", 100)
        self.assertIn("timeline is left out", errors)
        self.assertEqual(report["equilibria"][-1]["load"], 100)


def strut():
    """A rod that stands on the ground and keeps a mass of 1 kg up, which can only move up and down."""
    return {"version": 1,
            "bodies": [{"name": "top", "kind": "dynamic", "mass": 1, "position": [0, 1, 0],
                        "shape": {"sphere": {"radius": 0.05}}}],
            "hooks": [{"name": "rod", "kind": "distance", "b": "top", "anchor": [0, 0, 0], "anchor_b": [0, 1, 0]},
                      {"name": "guide", "kind": "slider", "axis": [0, 1, 0], "b": "top", "anchor": [0, 1, 0]}]}


if __name__ == "__main__":
    cli_test.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    cli_test.PROJECT = pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
