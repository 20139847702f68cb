"""The scenes of the paper, by the solver and by the laboratory: each keeps what it promises, and promises what it
cannot keep with half the gravity, nor without friction where some acts: paper_test.py PROGRAM PROJECT_FOLDER."""

import copy
import json
import pathlib
import re
import shutil
import sys
import unittest

import cli_test
from cli_test import Program

# Which of the two act. Gears turn about their middles.
ACTS = {
    "fig5": {"gravity"},
    "fig6": {"gravity"},
    "fig7": {"gravity"},
    "wall": {"gravity"},
    "rollback_room": {"gravity", "friction"},
    "gears": set(),
    "torus_on_peg": {"gravity", "friction"},
    "chain_of_links": {"gravity", "friction"},
    "bsp_walk": {"gravity", "friction"},
}
CONCAVE = {"gears": 0.04, "torus_on_peg": 0.75, "chain_of_links": 0.09}  # [s], until some have touched
LONG = {"gears", "chain_of_links"}  # some seconds each in the laboratory


def half_the_gravity(scene):
    scene.setdefault("world", {})["gravity"] = [0, -9.81 / 2, 0]


def no_friction(scene):
    for surface in [*scene["materials"].values(), *scene.get("material_pairs", [])]:
        surface.pop("static_friction", None)
        surface["friction"] = 0


class Paper(Program):
    def setUp(self):
        super().setUp()
        shutil.copytree(cli_test.PROJECT / "scenes/paper/models", self.folder / "models")

    def read(self, name):
        text = (cli_test.PROJECT / f"scenes/paper/{name}.json").read_text()
        scene = json.loads(re.sub(r"^\s*//.*$", "", text, flags=re.M))
        scene.pop("$schema")
        return scene

    def changed(self, name, change):
        scene = copy.deepcopy(self.read(name))
        change(scene)
        return self.scene(scene, f"{name}.json")

    def judge(self, names, *words, also_changed=True):
        for name in names:
            with self.subTest(name):
                self.hooke("run", f"scenes/paper/{name}.json", *words)
                if not also_changed:
                    continue
                if "gravity" in ACTS[name]:
                    self.hooke("run", self.changed(name, half_the_gravity), *words, code=1)
                if "friction" in ACTS[name]:
                    self.hooke("run", self.changed(name, no_friction), *words, code=1)

    def played(self):
        return [name for name in ACTS if "laboratory" in self.read(name)]

    def test_by_the_solver(self):
        self.judge(ACTS)

    def test_in_the_laboratory(self):
        self.judge([name for name in self.played() if name not in LONG], "--stepper", "declared")

    def test_both_searches_of_solids_give_the_same_bits(self):
        self.compare_searches([name for name in CONCAVE if name != "gears"])

    def compare_searches(self, names):
        for name in names:
            seconds = CONCAVE[name]
            reports = []
            for search in ("tree", "all"):
                path = self.changed(name, lambda scene, way=search: scene["laboratory"].update(mesh_search=way))
                report = json.loads(self.hooke("run", path, "--stepper", "declared", "--seconds", seconds, "--json",
                                               "-")[0])
                reports.append((report["energy"], report["collisions"], report["evaluations"]))
            with self.subTest(name):
                self.assertGreater(reports[0][1]["hits"], 0)
                self.assertEqual(reports[0], reports[1])

    def test_other_methods_are_experiments(self):
        _, err = self.hooke("run", "scenes/paper/fig5.json", "--stepper", "euler", "--force", "--seconds", 0.1)
        self.assert_one_line(err, "expectations .* left out")


class LongPaper(Paper):
    def test_in_the_laboratory(self):
        self.judge([name for name in self.played() if name in LONG], "--stepper", "declared", also_changed=False)

    def test_both_searches_of_solids_give_the_same_bits(self):
        self.compare_searches(["gears"])

    test_by_the_solver = test_other_methods_are_experiments = None


if __name__ == "__main__":
    cli_test.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    cli_test.PROJECT = pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
