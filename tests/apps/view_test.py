#!/usr/bin/env python3
"""`hooke view` in a real window, by mouse and keys: view_test.py PROGRAM. It needs Xvfb and xdotool.

It waits for states that the program writes with --log, and never for a time, so that it passes on a busy machine.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = None
SWITCHES = int(os.environ.get("HOOKE_SWITCHES", 20))  # Of scenes, to see whether memory stays behind.
LIMIT = 120  # Seconds after which a state is taken not to come.
SILENCE = 0.4  # [s], after which a window is taken to draw no more pictures by itself
SCENE = """{
  "version": 1, "seconds": 600,
  "camera": {"eye": [1.5, 1.6, 7], "target": [1.5, 1.2, 0]},
  "bodies": [
    {"name": "ground", "shape": {"half_space": {}}},
    {"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.3}}, "position": [-0.7, 0.3, 0], "mass": 2}],
  "cloths": [{"name": "flag", "corner": [0.2, 2.2, 0], "width": 1, "height": 1, "columns": 11, "rows": 11,
              "pins": [{"row": 0}]}],
  "ropes": [{"name": "rope", "hook_point": [2, 2.4, 0], "direction": [0, -1, 0], "length_at_rest": 1,
             "radius": 0.03}],
  "solids": [{"name": "jelly", "cells": [3, 3, 3], "size": [0.6, 0.6, 0.6], "position": [3.2, 0.3, 0],
              "total_mass": 3}]
}"""


def start_display():
    """Starts an X server on a display of its own choice, and returns it with the display's name."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    return server, f":{number}"


class Window:
    """A running `hooke view`, its log, and the mouse and keys of its display."""

    def __init__(self, folder, display, *words, scene="scene.json", first="ball"):
        self.log = pathlib.Path(folder) / "log.jsonl"
        self.log.unlink(missing_ok=True)
        self.environment = {**os.environ, "DISPLAY": display, "ASAN_OPTIONS": "detect_leaks=0"}
        self.program = subprocess.Popen([PROGRAM, "view", scene, "--log", str(self.log), *words], cwd=folder,
                                        env=self.environment, stderr=subprocess.PIPE, text=True)
        self.read = 0
        self.last = {}
        self.gl_errors = set()
        self.wait("a first picture", lambda s: s["stage"] == "ready" and first in s["objects"])

    def lines(self):
        if not self.log.exists():
            return
        with self.log.open() as file:
            file.seek(self.read)
            for line in iter(file.readline, ""):
                if not line.endswith("\n"):
                    return
                self.read += len(line)
                yield json.loads(line)

    def wait(self, what, condition, nudges=False):
        """Waits for a picture that fulfills a condition, and returns what was logged with it. A window in which
        nothing changes draws none: `nudges` moves the mouse to and fro for another."""
        end = time.monotonic() + LIMIT
        silent_until = time.monotonic() + SILENCE
        while time.monotonic() < end:
            for state in self.lines():
                silent_until = time.monotonic() + SILENCE
                self.last = state
                self.gl_errors.add(state["gl_error"])
                if condition(state):
                    return state
            if self.program.poll() is not None:
                raise AssertionError(f"{what}: the program ended: {self.program.stderr.read()}")
            if nudges and time.monotonic() > silent_until:
                self.do("mousemove_relative", "--", 1, 0)
                self.do("mousemove_relative", "--", -1, 0)
                silent_until = time.monotonic() + SILENCE
            time.sleep(0.01)
        raise AssertionError(f"{what} did not come; the last state was {self.last}")

    def fresh(self):
        """Waits until everything that was asked for is done and shown, and returns the state then."""
        number = self.last["picture"] + 2
        for state in self.lines():
            self.last = state
            number = state["picture"] + 2
        return self.wait("a picture", lambda s: s["picture"] >= number and s["commands"] >= s["posted"],
                         nudges=True)

    def do(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=LIMIT)

    def point(self, pixel):
        self.do("mousemove", round(pixel[0]), round(pixel[1]))
        self.fresh()

    def key(self, name):
        self.do("key", name)
        return self.fresh()

    def middle(self, name):
        """The middle of a part of the panels, which are rolled until it is shown."""
        for _ in range(40):
            state = self.fresh()
            if name in state["boxes"]:
                left, top, right, bottom = state["boxes"][name]
                return (left + right) / 2, (top + bottom) / 2
            self.point((1080, 600))
            self.do("click", 5)
        raise AssertionError(f"'{name}' is not shown; the last state was {self.last}")

    def click(self, name):
        self.point(self.middle(name))
        self.do("mousedown", 1)
        self.fresh()
        self.do("mouseup", 1)
        return self.fresh()

    def enter(self, name, text):
        """Types a text into a field of the panels, in place of what it holds."""
        self.click(name)
        self.key("ctrl+a")
        self.do("type", "--delay", 60, "--", text)
        self.fresh()
        return self.key("Return")

    def save_file(self, text):
        """Saves the scene's file at once, as editors do."""
        file = self.log.parent / "scene.json"
        file.with_suffix(".new").write_text(text)
        file.with_suffix(".new").replace(file)

    def drag(self, start, way, steps=6):
        """Presses the left button, waits for the hand, moves by a way, and returns the state before release."""
        self.point(start)
        self.do("mousedown", 1)
        held = self.wait("a grip", lambda s: s["held"] or s["commands"] > self.last["commands"])
        for i in range(1, steps + 1):
            self.do("mousemove", round(start[0] + way[0] * i / steps), round(start[1] + way[1] * i / steps))
            self.fresh()
        return held

    def close(self):
        """Closes the window as a user does, who is asked once more if edits are not saved."""
        edited = self.fresh()["edited"]
        self.do("key", "Escape")
        if edited:
            self.wait("a question", lambda s: s["hint"].startswith("Edits are not saved"))
            self.do("key", "Escape")
        code = self.program.wait(LIMIT)
        self.program.stderr.close()
        return code


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool in ("Xvfb", "xdotool"):
            if shutil.which(tool) is None:
                print(f"{tool} is not installed")
                sys.exit(77)
        cls.server, cls.display = start_display()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        (pathlib.Path(self.folder.name) / "scene.json").write_text(SCENE)
        self.window = None

    def tearDown(self):
        if self.window and self.window.program.poll() is None:
            self.window.program.kill()
            self.window.program.wait()
            self.window.program.stderr.close()

    def open(self, *words, **more):
        self.window = Window(self.folder.name, self.display, *words, **more)
        return self.window

    def end(self):
        self.assertEqual(self.window.gl_errors, {0})
        self.assertEqual(self.window.close(), 0)

    def test_each_kind_is_grabbed_moved_and_thrown(self):
        window = self.open()
        for name in ("ball", "flag", "rope", "jelly"):
            with self.subTest(name):
                start = window.fresh()["objects"][name]
                window.drag(start["pixel"], (0, -120))
                self.assertEqual(window.last["held"], name)
                up = window.wait("the object follows", lambda s: s["hand"][1] > start["place"][1] + 0.3)
                self.assertGreater(up["objects"][name]["place"][1], start["place"][1] + 0.1)
                window.do("mouseup", 1)
                window.wait("it is let go", lambda s: not s["held"] and s["said"] == f"let go of '{name}'")
        state = window.fresh()
        self.assertEqual(state["undo"], 4)
        self.end()

    def test_a_thrown_ball_flies_on(self):
        # Step by step, because on a busy machine the hand would be at rest before the button is let go.
        window = self.open("--paused")
        start = window.fresh()["objects"]["ball"]
        window.drag(start["pixel"], (260, -120))
        self.assertEqual(window.last["held"], "ball")
        for _ in range(8):
            window.key("s")
        before = window.last["objects"]["ball"]["place"]
        self.assertGreater(before[0], start["place"][0] + 0.2)
        window.do("mouseup", 1)
        window.wait("it is let go", lambda s: not s["held"])
        window.key("s")
        after = window.key("s")["objects"]["ball"]["place"]
        # It was pulled over 2 m at 4 Hz: it is faster than 5 m/s.
        self.assertGreater(after[0], before[0] + 2 * 5 / 60)
        window.key("space")
        window.wait("it flies on", lambda s: s["objects"]["ball"]["place"][0] > before[0] + 0.5)
        self.end()

    def test_pause_step_rewind_shoot_and_undo(self):
        window = self.open()
        window.wait("some steps", lambda s: s["step"] > 30)
        window.point((640, 100))
        state = window.key("space")
        self.assertFalse(state["playing"])
        step = state["step"]
        self.assertEqual(window.key("s")["step"], step + 1)
        self.assertEqual(window.key("Left")["step"], step)
        ball = state["objects"]["ball"]["pixel"]
        window.point(ball)
        shot = window.key("b")
        self.assertTrue(shot["said"].startswith("shot 'ball_"), shot["said"])
        self.assertEqual(shot["undo"], 1)
        window.key("space")
        hit = window.wait("the ball was hit", lambda s: s["objects"]["ball"]["place"][2] < -0.3)
        paused = window.key("space")
        # A drag of the timeline to its start, and back to its end.
        left, top, right, bottom = paused["boxes"]["timeline"]
        middle = (top + bottom) / 2
        window.point((right - 8, middle))
        window.do("mousedown", 1)
        window.fresh()
        window.do("mousemove", round(left + 2), round(middle))
        early = window.wait("it is rewound", lambda s: s["step"] == 0)
        self.assertEqual(early["last_step"], paused["last_step"])
        self.assertAlmostEqual(early["objects"]["ball"]["place"][2], 0, places=6)
        window.do("mousemove", round(right - 2), round(middle))
        late = window.wait("it is back", lambda s: s["step"] == paused["last_step"])
        window.do("mouseup", 1)
        self.assertEqual(late["objects"]["ball"]["place"], paused["objects"]["ball"]["place"])
        self.assertGreater(hit["step"], step)
        undone = window.key("u")
        self.assertEqual(undone["said"], "undone: shot")
        self.assertEqual(undone["step"], step)
        self.assertEqual(set(undone["objects"]), {"ground", "ball", "flag", "rope", "jelly"})
        self.end()

    def test_a_drag_on_nothing_turns_the_camera_and_keys_are_listed(self):
        window = self.open("--paused")
        before = window.fresh()["objects"]
        window.point((640, 60))
        window.do("mousedown", 1)
        window.fresh()
        window.do("mousemove_relative", "--", 100, 0)
        turned = window.wait("the camera turns",
                             lambda s: abs(s["objects"]["jelly"]["pixel"][0] - before["jelly"]["pixel"][0]) > 20)
        window.do("mouseup", 1)
        self.assertEqual(turned["objects"]["ball"]["place"], before["ball"]["place"])
        self.assertTrue(window.key("question")["help"])
        self.assertFalse(window.key("Escape")["help"])
        far = window.fresh()["objects"]
        window.do("click", 4)
        near = window.wait("the wheel zooms", lambda s: s["objects"] != far)
        self.assertNotEqual(near["objects"]["ball"]["pixel"], far["ball"]["pixel"])
        self.end()

    def test_a_model_becomes_rigid_jelly_and_cloth_by_keys_and_boxes(self):
        model = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "models" / "crate.3ds"
        shutil.copy(model, self.folder.name)
        window = self.open("--paused", "--up", "z", scene="crate.3ds", first="model")
        still = window.last["objects"]["model"]["place"]
        self.assertIn("form jelly", window.fresh()["boxes"])
        for key, name in (("g", "a rigid body"), ("j", "jelly"), ("k", "cloth"), ("k", "still")):
            with self.subTest(key):
                window.do("key", key)
                window.wait(name, lambda s, name=name: s["said"] == f"the model is {name} now")
        self.assertEqual(window.fresh()["objects"]["model"]["place"], still)
        window.click("form rigid")
        window.wait("a rigid body", lambda s: s["said"] == "the model is a rigid body now")
        before = window.last["objects"]["model"]["place"]
        for _ in range(6):
            window.key("s")
        self.assertLess(window.last["objects"]["model"]["place"][1], before[1] - 0.03)
        self.end()

    def test_in_a_small_window_the_plot_stays_above_the_timeline(self):
        window = self.open("--paused", "--ui-scale", "1")
        window.do("search", "--onlyvisible", "--name", "Hooke", "windowsize", 640, 360)
        state = window.wait("a small window", lambda s: s["boxes"].get("timeline", [0, 999])[1] < 360)
        self.assertLess(state["boxes"]["plot"][3], state["boxes"]["timeline"][1])
        self.assertIn("save CSV", state["boxes"])
        self.end()

    def test_a_value_is_edited_undone_done_again_and_saved(self):
        window = self.open("--paused")
        for _ in range(4):
            window.key("s")
        window.click("object rope")
        state = window.wait("it is selected", lambda s: s["selected"] == "rope")
        self.assertAlmostEqual(state["measured"]["mass"], 1, places=5)
        state = window.enter("key ropes[0].total_mass", "2.5")
        self.assertEqual(state["said"], "ropes[0].total_mass is 2.5 now; the scene starts anew with it")
        self.assertAlmostEqual(state["measured"]["mass"], 2.5, places=5)
        self.assertEqual((state["step"], state["built"], state["edited"]), (0, 2, True))
        state = window.enter("key ropes[0].total_mass", "-2")
        self.assertIn("must be", state["said"])
        self.assertAlmostEqual(state["measured"]["mass"], 2.5, places=5)
        state = window.key("u")
        self.assertAlmostEqual(state["measured"]["mass"], 1, places=5)
        self.assertEqual((state["step"], state["edited"]), (4, False))
        window.key("ctrl+y")
        # Gravity changes at once.
        window.click("object ")
        window.wait("the world is selected", lambda s: not s["selected"])
        window.key("s")
        state = window.enter("key world.gravity", "0, -1.62, 0")
        self.assertEqual(state["said"], "world.gravity is [0, -1.62, 0] now")
        self.assertEqual((state["step"], state["built"]), (1, 4))
        window.enter("save name", "moon.json")
        self.assertTrue(window.click("save")["said"].startswith("saved '"), window.last["said"])
        saved = (window.log.parent / "moon.json").read_text()
        expected = SCENE.replace('"radius": 0.03}', '"radius": 0.03,\n             "total_mass": 2.5}')
        expected = expected.replace("\n}", ',\n  "world": {"gravity": [0, -1.62, 0]}\n}')
        self.assertEqual(saved, expected)
        self.end()

    def test_the_panel_stays_while_the_scene_of_what_is_selected_is_built(self):
        scene = pathlib.Path(self.folder.name) / "scene.json"
        scene.write_text(SCENE.replace('"cells": [3, 3, 3]', '"cells": [14, 14, 14]'))
        window = self.open("--paused")
        window.click("object ball")
        window.wait("it is selected", lambda s: s["selected"] == "ball")
        state = window.enter("key bodies[1].mass", "5")
        state = window.wait("it is built", lambda s: s["built"] == 2 and s["measured"])
        self.assertAlmostEqual(state["measured"]["mass"], 5, places=5)
        self.end()

    def test_a_saved_file_is_read_again_and_a_mistake_is_told(self):
        window = self.open("--paused")
        window.point((640, 60))
        window.do("mousedown", 3)
        window.do("mousemove_relative", "--", 60, 0)
        window.fresh()
        window.do("mouseup", 3)
        before = window.fresh()
        window.save_file(SCENE.replace('"position": [-0.7, 0.3, 0], "mass"', '"position": [-0.7, 1.3, 0], "mass"'))
        state = window.wait("it is read again", lambda s: s["built"] == 2)
        self.assertAlmostEqual(state["objects"]["ball"]["place"][1], 1.3, places=5)
        # The camera stays where it was turned to.
        self.assertEqual(window.fresh()["objects"]["jelly"]["pixel"], before["objects"]["jelly"]["pixel"])
        window.save_file(SCENE.replace('"seconds": 600,', '"seconds": 600'))
        state = window.wait("the mistake is told", lambda s: s["mistakes"])
        self.assertRegex(state["mistakes"][0], r"scene\.json:[23]:\d+: ")
        self.assertAlmostEqual(window.key("s")["objects"]["ball"]["place"][1], 1.3, places=2)
        window.save_file(SCENE)
        state = window.wait("it is read again", lambda s: s["built"] == 3)
        self.assertEqual(state["mistakes"], [])
        self.assertEqual(window.key("F5")["said"], "the file says what is shown")
        self.end()

    def test_another_scene_opens_in_the_window(self):
        (pathlib.Path(self.folder.name) / "other.json").write_text(
            '{"version": 1, "title": "Other", "bodies": [{"name": "ball", "shape": {"sphere": {"radius": 1}}}]}')
        window = self.open("--paused")
        window.click("tab Scenes")
        state = window.click("scene other.json")
        state = window.wait("it is open", lambda s: s["opened"] == 2)
        self.assertTrue(state["file"].endswith("other.json"))
        self.assertEqual(set(window.fresh()["objects"]), {"ball"})
        # The ball of 2 m fills a good part of the picture in any case: its middle is in sight.
        x, y = window.last["objects"]["ball"]["pixel"]
        self.assertTrue(0 < x < 1280 and 0 < y < 720)
        window.click("scene scene.json")
        window.wait("the first is open again", lambda s: s["opened"] == 3 and "jelly" in s["objects"])
        self.end()

    def test_insight_is_switched_by_keys_and_boxes(self):
        window = self.open("--paused")
        for _ in range(8):
            window.key("s")
        self.assertEqual(window.last["insight"], {})

        def shows(what, condition):
            return window.wait(what, lambda s: s["insight"] and condition(s["insight"]))["insight"]

        window.do("key", "1")
        # The ball of 2 kg and the jelly of 3 kg lie on the ground.
        shows("contacts", lambda i: i["contacts"] > 5 and i["force"] > 10)
        window.do("key", "1")
        window.wait("nothing is shown", lambda s: s["insight"] == {})
        window.do("key", "4")
        # Half a kilogram hangs below the middle of the rope; the flag and the jelly have triangles.
        loads = shows("loads", lambda i: i["triangles"] > 200)
        self.assertGreater(loads["tension"], 5)
        self.assertGreater(loads["strain"], 0)
        window.click("show numbers")
        shows("numbers", lambda i: i["texts"] == 3)
        for name in ("2", "3", "5", "6", "7"):
            lines = window.last["insight"]["lines"]
            window.do("key", name)
            if name in "23":
                shows(f"lines of {name}", lambda i: i["lines"] > lines)
        window.fresh()
        self.end()

    def test_figures_are_plotted_and_saved(self):
        window = self.open("--paused")
        window.click("object rope")
        for _ in range(5):
            window.key("s")
        window.click("plot")
        window.click("plot momentum")
        window.wait("it is plotted", lambda s: s["plot"] == "momentum")
        self.assertEqual(window.last["rows"], 6)
        self.assertRegex(window.click("save CSV")["said"], r"^saved '.*scene-figures\.csv', 6 rows$")
        head, *rows = (window.log.parent / "scene-figures.csv").read_text().splitlines()
        column = head.split(",").index("rope: largest tension [N]")
        tensions = [float(row.split(",")[column]) for row in rows]
        self.assertEqual(len(tensions), 6)
        # A rope of 1 kg hangs from its hook.
        self.assertAlmostEqual(tensions[-1], 9.81, delta=0.6)
        self.end()

    def test_a_line_cuts_what_it_crosses(self):
        window = self.open("--paused")
        x, y = window.fresh()["objects"]["rope"]["pixel"]
        window.key("c")
        window.point((x - 80, y - 60))
        window.do("mousedown", 1)
        window.fresh()
        window.do("mousemove", round(x + 80), round(y - 60))
        window.fresh()
        window.do("mouseup", 1)
        window.wait("it is cut", lambda s: s["said"] == "cut 'rope'")
        for _ in range(6):
            window.key("s")
        self.assertLess(window.last["objects"]["rope"]["place"][1], 1.37)
        self.assertEqual(window.key("u")["said"], "undone: cut")
        for _ in range(6):
            window.key("s")
        self.assertAlmostEqual(window.last["objects"]["rope"]["place"][1], 1.4, delta=0.01)
        # The knife is laid down by Escape, and the window stays.
        window.key("c")
        window.key("Escape")
        self.assertIsNone(window.program.poll())
        self.end()

    def test_switches_between_scenes_leave_no_memory_behind(self):
        (pathlib.Path(self.folder.name) / "other.json").write_text(SCENE.replace("scene", "other"))
        window = self.open("--paused")
        window.click("tab Scenes")

        def switch(count):
            for _ in range(count):
                opened = window.last["opened"]
                name = "scene.json" if window.last["file"].endswith("other.json") else "other.json"
                window.point(window.middle(f"scene {name}"))
                window.do("mousedown", 1)
                window.fresh()
                window.do("mouseup", 1)
                window.wait("another scene", lambda s: s["opened"] == opened + 1)
            return int(pathlib.Path(f"/proc/{window.program.pid}/statm").read_text().split()[1]) * 4096

        before = switch(10)
        growth = switch(SWITCHES) - before
        # One of these worlds with its figures takes 2 MB.
        self.assertLess(growth, 8e6)
        print(f"{SWITCHES} switches: {growth / 1e6:.1f} MB more")
        self.end()

    def test_panels_grow_and_shrink(self):
        window = self.open("--paused", "--ui-scale", "1.5")
        font = window.fresh()["font"]
        self.assertAlmostEqual(font, 20, delta=1)
        for name, factor in (("ctrl+equal", 1.25), ("ctrl+minus", 1), ("ctrl+minus", 0.8)):
            window.do("key", name)
            window.wait(f"letters of {factor} times the size", lambda s: abs(s["font"] - factor * font) <= 1)
        window.do("key", "i")
        window.wait("the inspector is hidden", lambda s: "save" not in s["boxes"])
        self.end()

    def test_edits_outlive_the_display(self):
        server, display = start_display()
        window = self.window = Window(self.folder.name, display, "--paused")
        window.enter("key world.gravity", "0, -3, 0")
        server.kill()
        server.wait()
        _, err = window.program.communicate(timeout=60)
        self.assertIn("they are kept in 'scene-unsaved.json'", err)
        kept = (pathlib.Path(self.folder.name) / "scene-unsaved.json").read_text()
        self.assertIn("[0, -3, 0]", kept)
        self.assertEqual((pathlib.Path(self.folder.name) / "scene.json").read_text(), SCENE)

    def test_panels_do_not_grow_over_each_other(self):
        boxes = self.open("--paused", "--ui-scale", "8").fresh()["boxes"]
        self.assertLess(boxes["save CSV"][2], boxes["tab Objects"][0])
        self.end()

    def test_pins_strings_drops_and_removal(self):
        window = self.open("--paused")
        objects = window.fresh()["objects"]
        window.point(objects["ball"]["pixel"])
        self.assertEqual(window.key("p")["said"], "pinned 'ball'")
        self.assertEqual(window.key("p")["said"], "unpinned 'ball'")
        window.key("h")
        window.point(objects["jelly"]["pixel"])
        self.assertTrue(window.key("h")["said"].startswith("tied 'ball' to 'jelly'"))
        self.assertEqual(window.key("Delete")["said"], "removed 'jelly'")
        self.assertNotIn("jelly", window.fresh()["objects"])
        window.point((640, 500))
        self.assertTrue(window.key("d")["said"].startswith("dropped 'ball_"), window.last["said"])
        self.assertEqual(window.fresh()["undo"], 5)
        self.end()


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
