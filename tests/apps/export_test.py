"""Exports scenes and reads the files by the rules of their formats:
export_test.py PROGRAM PROJECT_FOLDER [SUITE]. A suite that needs a program which is missing ends with 77."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import zlib

import cli_test
from cli_test import Program
from motion_files import Glb, Usda, obj, point_cache, rotate, table

SKIPPED = 77
TOLERANCE = 1e-4  # [m], of .glb and .usda by default
ROUNDING = 3e-6   # [m], of floats at some meters
FALL = {"version": 1, "seconds": 1, "world": {"gravity": [0, -9.81, 0]}}

# One object of each kind, odd names, one that comes and one that goes.
MIXED = {
    "version": 1, "seconds": 1,
    "materials": {"cloth": {"color": [0.9, 0.8, 0.7], "texture": "flag.png", "shininess": 4},
                  "glass": {"color": [0.5, 0.7, 0.9], "opacity": 0.4, "shininess": 200, "friction": 0.2,
                            "restitution": 0.3}},
    "bodies": [
        {"name": "ground", "shape": {"half_space": {}}},
        {"name": "ball, \"of\" glass/ä", "kind": "dynamic", "material": "glass", "shape": {"sphere": {"radius": 0.2}},
         "position": [0, 2, 1], "velocity": [1, 2, 0], "angular_velocity": [0, 20, 3]},
        {"name": "a b", "kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.2, 0.3]}}, "position": [2, 1, 0],
         "angular_velocity": [5, 1, 0]},
        {"name": "a_b", "kind": "dynamic", "position": [2, 3, 0], "angular_velocity": [0, 0, 7], "shape": {"parts": [
            {"shape": {"cylinder": {"radius": 0.05, "half_height": 0.3}}, "density": 700},
            {"shape": {"box": {"half_extents": [0.2, 0.06, 0.06]}}, "position": [0, 0.3, 0.05],
             "rotation": {"axis": [0, 1, 0], "angle_deg": 30}, "density": 7800}]}},
        {"name": "post", "shape": {"cone": {"radius": 0.1, "half_height": 0.3}}, "position": [-1.5, 1.2, 0]},
        {"name": "door", "kind": "dynamic", "shape": {"box": {"half_extents": [0.4, 0.5, 0.02]}},
         "position": [-1, 1.5, 0], "angular_velocity": [0, 3, 0]},
        {"name": "drum", "kind": "kinematic", "shape": {"capsule": {"radius": 0.1, "half_height": 0.2}},
         "position": [-3, 1, 0], "angular_velocity": [0, 0, 4], "motion": {"velocity": [0, 0.3, 0]}},
        {"name": "goes", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}}, "position": [4, 3, 0]}],
    "hooks": [{"name": "hinge", "kind": "hinge", "a": "post", "b": "door", "anchor": [-1.4, 1.5, 0],
               "axis": [0, 1, 0], "limits": {"lower": -1, "upper": 1.5}},
              {"name": "lead", "kind": "distance", "a": "door", "b": "a b", "anchor": [-0.6, 1.5, 0],
               "anchor_b": [2, 1, 0], "limits": {"upper": 9}}],
    "ropes": [{"name": "rope", "hook_point": [0, 3, -1], "length_at_rest": 1, "masses": 12, "total_mass": 0.3,
               "loads": [{"point": "last", "mass": 0.5}]}],
    "cloths": [{"name": "flag", "material": "cloth", "corner": [1, 3, -2], "width": 1, "height": 0.7, "columns": 9,
                "rows": 7, "pins": [{"column": 0}]}],
    "solids": [{"name": "jelly", "position": [-1, 1, -2], "size": [0.4, 0.4, 0.4], "cells": [2, 2, 2],
                "young_modulus": 20000}],
    "particles": [{"name": "swing", "particles": [{"position": [3, 3, -2], "radius": 0.05},
                                                  {"position": [3.5, 3, -2], "radius": 0.05}],
                   "springs": [{"a": 0, "b": 1, "stiffness": 200}], "pins": [0]}],
    "timeline": [{"at_step": 20, "add": {"bodies": [{"name": "comes", "kind": "dynamic", "position": [5, 2, 0],
                                                     "shape": {"sphere": {"radius": 0.1}}}]}},
                 {"at_step": 40, "remove": "goes"}],
}
# What a picture shows beside color.
LOOKS = {
    "version": 1, "seconds": 0.2,
    "sky": {"sun": 0.5, "sun_direction": [0.6, -0.8, 0]},
    "lights": [{"kind": "spot", "position": [1, 3, 2], "direction": [1, -1, 2], "intensity": 4, "inner_deg": 10,
                "outer_deg": 30}, {"kind": "point", "position": [0, 2, 0], "color": [1, 0.5, 0.25], "intensity": 2,
                                   "shadows": False}, {"kind": "directional", "direction": [0, 0, 1]}],
    "materials": {"brass": {"color": [0.9, 0.7, 0.3], "metalness": 1, "roughness": 0.25, "normal_map": "bumps.png",
                            "normal_scale": -0.5, "roughness_map": "worn.png"},
                  "pane": {"transmission": 0.75, "roughness": 0}},
    "bodies": [{"name": "ball", "material": "brass", "shape": {"sphere": {"radius": 0.2}}, "position": [0, 1, 0]},
               {"name": "window", "material": "pane", "shape": {"box": {}}, "position": [2, 1, 0]}],
    "cloths": [{"name": "mail", "material": "brass", "corner": [-1, 3, 0], "width": 1, "height": 1, "columns": 5,
                "rows": 5, "pins": [{"point": 0}, {"point": 4}]}],
}
FRAMES = 31  # of one second at 30 a second
FRAME_OF_COMING, FRAME_OF_GOING = 11, 21  # the first with the one, the first without the other


def distance(a, b):
    return math.dist(a, b)


class Export(Program):
    def setUp(self):
        super().setUp()
        (self.folder / "flag.png").write_bytes((cli_test.PROJECT / "scenes/models/flag.png").read_bytes())

    def picture(self, name, gray):
        """Writes an image of 4 x 4 pixels."""
        rows = b"".join(b"\0" + bytes(30 * (x + y) + (0 if gray else 20 * c) for x in range(4) for c in range(3))
                        for y in range(4))

        def chunk(kind, data):
            return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")
        header = (4).to_bytes(4, "big") * 2 + bytes((8, 2, 0, 0, 0))
        (self.folder / name).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                                         + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))

    def export(self, output, *words, scene=None, code=0):
        """`scene` is a scene, or the path of one, of which a second is exported."""
        if isinstance(scene, pathlib.Path):
            return self.hooke("export", scene, "-o", output, "--seconds", 1, *words, code=code)
        name = self.scene(MIXED if scene is None else scene)
        return self.hooke("export", name, "-o", output, *words, code=code)

    def frame(self, number):
        return obj(self.folder / "seq" / f"frame_{number:04d}.obj")

    def assert_near(self, points, wanted, tolerance, what):
        self.assertEqual(len(points), len(wanted), what)
        worst = max(map(distance, points, wanted), default=0)
        self.assertLessEqual(worst, tolerance, what)


def file_name(name):
    """Of an object of MIXED, in which 'a b' and 'a_b' would have one name."""
    return "a_b.2" if name == "a_b" else re.sub(r"[^A-Za-z0-9._\[\]-]", "_", name.encode().decode("latin-1"))


class Files(Export):
    """What the program alone shows."""

    def test_a_glb_moves_as_the_obj_files_do(self):
        self.export("seq/frame_%04d.obj")
        self.export("x.glb")
        glb = Glb(self.folder / "x.glb")
        roots = {file_name(name): node for name, node in glb.roots().items()}
        for frame in range(0, FRAMES, 3):
            wanted = self.frame(frame)
            self.assertEqual("comes" in wanted, frame >= FRAME_OF_COMING)
            self.assertEqual("goes" in wanted, frame < FRAME_OF_GOING)
            self.assertLessEqual(set(wanted), set(roots))
            for name, node in roots.items():
                self.assert_near(glb.vertices(node, frame / 30), wanted.get(name, []), TOLERANCE + ROUNDING,
                                 f"{name} in frame {frame}")

    def test_quaternions_of_neighboring_keys_have_one_sign(self):
        self.export("x.glb", "--tolerance", 0)
        glb = Glb(self.folder / "x.glb")
        turns = [glb.accessor(sampler["output"]) for node in glb.roots().values()
                 for path, sampler in glb.channels(node) if path == "rotation"]
        self.assertGreater(len(turns), 4)
        for keys in turns:
            for a, b in zip(keys, keys[1:]):
                self.assertGreater(sum(x * y for x, y in zip(a, b)), 0)

    def test_more_tolerance_keeps_fewer_shapes_and_its_promise(self):
        self.export("seq/frame_%04d.obj")
        sizes = []
        for tolerance in (0, 1e-3, 1e-2):
            out, _ = self.export("x.glb", "--tolerance", tolerance)
            glb = Glb(self.folder / "x.glb")
            sizes.append(sum(len(mesh.get("weights", [])) for mesh in glb.json["meshes"]))
            self.assertEqual("left out" in out, tolerance > 0, out)
            for frame in range(FRAMES):
                wanted = self.frame(frame)
                for name in ("rope", "flag", "jelly", "a_b", "door"):
                    self.assert_near(glb.vertices(glb.roots()[name], frame / 30), wanted[file_name(name)], tolerance + ROUNDING,
                                     f"{name} in frame {frame}, tolerance {tolerance}")
        self.assertGreater(sizes[0], sizes[1])
        self.assertGreater(sizes[1], sizes[2])

    def test_morph_targets_are_bounded_and_what_that_costs_is_said(self):
        self.export("seq/frame_%04d.obj")
        out, _ = self.export("x.glb", "--morph-targets", 6)
        glb = Glb(self.folder / "x.glb")
        for mesh in glb.json["meshes"]:
            self.assertLessEqual(len(mesh.get("weights", [])), 6)
        said = re.search(r"'flag' would need more than 6 morph targets; it keeps (\d), and is off by up to ([\d.]+) (m?m)",
                         out)
        limit = float(said[2]) / (1000 if said[3] == "mm" else 1)
        node = glb.roots()["flag"]
        worst = max(max(map(distance, glb.vertices(node, frame / 30), self.frame(frame)["flag"]))
                    for frame in range(FRAMES))
        self.assertLessEqual(worst, limit + ROUNDING)
        self.assertGreater(worst, TOLERANCE)

    def test_materials_of_a_glb_say_what_the_scene_says(self):
        self.export("x.glb")
        glb = Glb(self.folder / "x.glb")
        materials = {material["name"]: material for material in glb.json["materials"]}
        glass = materials["glass"]
        self.assertEqual(glass["alphaMode"], "BLEND")
        for got, wanted in zip(glass["pbrMetallicRoughness"]["baseColorFactor"], [0.5, 0.7, 0.9, 0.4]):
            self.assertAlmostEqual(got, wanted, places=5)
        self.assertAlmostEqual(glass["pbrMetallicRoughness"]["roughnessFactor"], (2 / 202) ** 0.25, places=5)
        self.assertTrue(materials["cloth"]["doubleSided"])
        self.assertEqual(materials["iron"]["pbrMetallicRoughness"]["metallicFactor"], 1)
        image = glb.json["images"][0]
        view = glb.json["bufferViews"][image["bufferView"]]
        begin = view["byteOffset"]
        self.assertEqual(glb.binary[begin:begin + view["byteLength"]], (self.folder / "flag.png").read_bytes())

    def test_the_camera_goes_along_its_path_and_looks_at_its_target(self):
        path = [{"time": 0, "eye": [4, 2, 0], "target": [0, 1, 0]}, {"time": 1, "eye": [0, 2, 4], "target": [0, 0, 0]}]
        scene = MIXED | {"camera": {"fov_deg": 40, "path": path}}
        self.export("x.glb", "--tolerance", 0, scene=scene)
        glb = Glb(self.folder / "x.glb")
        camera, = glb.json["cameras"]
        self.assertAlmostEqual(camera["perspective"]["yfov"], math.radians(40), places=6)
        number, = (i for i, node in enumerate(glb.json["nodes"]) if "camera" in node)
        self.export("x.usda", "--tolerance", 0, scene=scene)
        usda = Usda(self.folder / "x.usda")
        tall, focal = (float(usda.prims["/World/camera"][key]) for key in ("verticalAperture", "focalLength"))
        self.assertAlmostEqual(2 * math.atan(tall / 2 / focal), math.radians(40), places=5)
        samplers = dict(glb.channels(number))
        for frame, ends in ((0, path[0]), (30, path[1])):
            eye = usda.value("/World/camera", "xformOp:translate", frame)
            w, *xyz = usda.value("/World/camera", "xformOp:orient", frame)
            way = [glb.value(samplers[path], frame / 30, path) for path in ("translation", "rotation")]
            for place, turn in (way, (eye, [*xyz, w])):
                self.assertLess(distance(place, ends["eye"]), 1e-5)
                forward = rotate(turn, [0, 0, -distance(ends["eye"], ends["target"])])
                self.assertLess(distance([a + b for a, b in zip(place, forward)], ends["target"]), 1e-5)
                # The horizon is level, and up is up.
                self.assertAlmostEqual(rotate(turn, [1, 0, 0])[1], 0, places=6)
                self.assertGreater(rotate(turn, [0, 1, 0])[1], 0.5)

    def test_a_camera_that_passes_its_target_keeps_its_direction_there(self):
        path = [{"time": 0, "eye": [0, 1, 2], "target": [0, 1, 0]}, {"time": 1, "eye": [0, 1, -2], "target": [0, 1, 0]}]
        self.export("x.glb", "--fps", 60, "--tolerance", 0, scene=MIXED | {"camera": {"path": path}})
        glb = Glb(self.folder / "x.glb")
        number, = (i for i, node in enumerate(glb.json["nodes"]) if "camera" in node)
        rotation = dict(glb.channels(number))["rotation"]
        for time, forward in ((0, -1), (0.5, -1), (1, 1)):
            self.assertAlmostEqual(rotate(glb.value(rotation, time, "rotation"), [0, 0, -1])[2], forward, places=5)

    def test_point_caches_hold_the_vertices_of_the_obj_files_with_z_up(self):
        self.export("seq/frame_%04d.obj")
        self.export("caches/")
        for name in ("rope", "flag", "jelly", "swing"):
            frames = point_cache(self.folder / "caches" / f"{name}.pc2")
            self.assertEqual(len(frames), FRAMES)
            for frame in (0, 13, FRAMES - 1):
                turned = [[x, -z, y] for x, y, z in self.frame(frame)[name]]
                self.assert_near(frames[frame], turned, ROUNDING, f"{name} in frame {frame}")
        glb = Glb(self.folder / "caches" / "bodies.glb")
        cached = {node["extras"]["point_cache"] for node in glb.json["nodes"] if "extras" in node}
        self.assertEqual(cached, {path.name for path in (self.folder / "caches").glob("*.pc2")})

    def test_a_usda_moves_as_the_obj_files_do(self):
        self.export("seq/frame_%04d.obj")
        self.export("x.usda")
        usda = Usda(self.folder / "x.usda")
        bodies = {"/World/a_b": "a_b", "/World/a_b_2": "a_b.2", "/World/ball___of__glass___": "ball___of__glass___",
                  "/World/door": "door", "/World/drum": "drum"}
        for frame in range(0, FRAMES, 5):
            wanted = self.frame(frame)
            for name in ("rope", "flag", "jelly", "swing"):
                self.assert_near(usda.vectors(f"/World/{name}", "points", frame), wanted[name], TOLERANCE + ROUNDING,
                                 f"{name} in frame {frame}")
            for path, name in bodies.items():
                place = usda.value(path, "xformOp:translate", frame)
                w, *xyz = usda.value(path, "xformOp:orient", frame)
                size = math.sqrt(w * w + sum(x * x for x in xyz))
                turn = [x / size for x in (*xyz, w)]
                points = []
                for piece in sorted(p for p in usda.prims if re.fullmatch(re.escape(path) + r"/piece_\d", p)):
                    for p in usda.vectors(piece, "points", 0):
                        if "xformOp:orient" in usda.prims[piece]:
                            w, *xyz = usda.value(piece, "xformOp:orient", 0)
                            p = rotate([*xyz, w], p)
                        if "xformOp:translate" in usda.prims[piece]:
                            p = [a + b for a, b in zip(p, usda.value(piece, "xformOp:translate", 0))]
                        points.append([a + b for a, b in zip(rotate(turn, p), place)])
                self.assert_near(points, wanted[name], TOLERANCE + ROUNDING, f"{path} in frame {frame}")

    def test_a_usda_tells_masses_colliders_and_joints(self):
        out, _ = self.export("x.usda")
        usda = Usda(self.folder / "x.usda")
        ball = usda.prims["/World/ball___of__glass___"]
        self.assertIn("PhysicsRigidBodyAPI", ball["apiSchemas"])
        # 1000 kg/m^3 times 4/3 pi r^3
        self.assertAlmostEqual(float(ball["physics:mass"]), 1000 * 4 / 3 * math.pi * 0.2 ** 3, places=3)
        self.assertEqual(Usda.numbers(ball["physics:velocity"]), [1, 2, 0])
        self.assertAlmostEqual(Usda.numbers(ball["physics:angularVelocity"])[1], math.degrees(20), places=3)
        self.assertEqual(ball["customData"], '{ string name = "ball, \\"of\\" glass/ä" }')
        self.assertEqual(usda.types["/World/ball___of__glass___/collider_0"], "Sphere")
        self.assertEqual(usda.types["/World/ground/collider_0"], "Plane")
        self.assertNotIn("PhysicsRigidBodyAPI", usda.prims["/World/ground"]["apiSchemas"])
        self.assertEqual(usda.prims["/World/drum"]["physics:kinematicEnabled"], "1")
        # The center of the hammer lies in its head: (0.3 m 7800 V2) / (700 V1 + 7800 V2) along its handle.
        handle, head = 700 * math.pi * 0.05 ** 2 * 0.6, 7800 * 0.4 * 0.12 * 0.12
        center = Usda.numbers(usda.prims["/World/a_b_2"]["physics:centerOfMass"])
        self.assertAlmostEqual(center[1], 0.3 * head / (handle + head), places=4)
        hinge = usda.prims["/World/Joints/hinge"]
        self.assertEqual(usda.types["/World/Joints/hinge"], "PhysicsRevoluteJoint")
        self.assertAlmostEqual(float(hinge["physics:upperLimit"]), math.degrees(1.5), places=3)
        for got, wanted in zip(Usda.numbers(hinge["physics:localPos1"]), [-0.4, 0, 0]):
            self.assertAlmostEqual(got, wanted, places=5)
        # The joint's x axis is the hinge's: (1, 0, 0) turned by localRot0 is (0, 1, 0).
        w, *xyz = Usda.numbers(hinge["physics:localRot0"])
        for got, wanted in zip(rotate([*xyz, w], [1, 0, 0]), [0, 1, 0]):
            self.assertAlmostEqual(got, wanted, places=5)
        self.assertEqual(usda.types["/World/Joints/lead"], "PhysicsDistanceJoint")
        self.assertEqual(float(usda.prims["/World/Joints/lead"]["physics:maxDistance"]), 9)
        self.assertEqual(usda.prims["/World/comes"]["visibility"],
                         {0: '"invisible"', FRAME_OF_COMING: '"inherited"'})
        self.assertEqual(usda.prims["/World/goes"]["visibility"], {0: '"inherited"', FRAME_OF_GOING: '"invisible"'})
        self.assertIn("x.usda", out)

    def test_a_hook_without_a_joint_of_its_kind_is_counted(self):
        cube = {"kind": "dynamic", "shape": {"box": {}}}
        scene = FALL | {"bodies": [cube | {"name": "car", "position": [0, 2, 0]}, cube | {"name": "rim"}],
                        "hooks": [{"name": "axle", "kind": "wheel", "a": "car", "b": "rim", "anchor": [0, 0, 0],
                                   "axis": [0, 1, 0], "second_axis": [0, 0, 1]},
                                  {"name": "weld", "kind": "fixed", "b": "car", "anchor": [0, 2, 0]}]}
        out, _ = self.export("x.usda", scene=scene)
        self.assertIn("1 hook is left out, as UsdPhysics has no joint of that kind", out)
        usda = Usda(self.folder / "x.usda")
        self.assertNotIn("/World/Joints/axle", usda.prims)
        weld = usda.prims["/World/Joints/weld"]
        self.assertEqual(usda.types["/World/Joints/weld"], "PhysicsFixedJoint")
        self.assertEqual((weld["physics:body1"], weld.get("physics:body0")), ("</World/car>", None))
        self.assertEqual(Usda.numbers(weld["physics:localPos0"]), [0, 2, 0])

    def test_meshes_of_many_bodies_stand_once_in_a_usda(self):
        cube = {"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}},
                "array": {"grid": [10, 10, 10], "spacing": [1, 1, 1]}}
        self.export("x.usda", "--seconds", 0.1, scene=FALL | {"bodies": [cube]})
        usda = Usda(self.folder / "x.usda")
        mesh, = (path for path in usda.prims if path.startswith("/World/Meshes/"))
        self.assertEqual(usda.prims["/World/ball_7_/piece_0"]["references"], f"<{mesh}>")
        self.assertLess((self.folder / "x.usda").stat().st_size, 3e6)

    def test_a_table_has_the_figures_of_free_fall(self):
        scene = FALL | {"bodies": [{"name": "cube", "kind": "dynamic", "position": [0, 20, 0], "velocity": [2, 0, 0],
                                    "angular_velocity": [0, 3, 0], "shape": {"box": {}}}],
                        "ropes": [{"name": "rope", "masses": 5, "pins": [], "hook_point": [0, 10, 0], "drag_coefficient": 0}]}
        self.export("x.csv", "--points", "--fps", 60, scene=scene)
        rows = table(self.folder / "x.csv")
        self.assertEqual(len(rows), 61 * (1 + 1 + 5))
        for frame in (0, 17, 60):
            time = frame / 60
            cube = {key: float(value) for key, value in rows["cube", "", frame].items() if key not in ("object", "point")}
            self.assertAlmostEqual(cube["time_s"], time, places=6)
            self.assertAlmostEqual(cube["x_m"], 2 * time, places=4)
            self.assertAlmostEqual(cube["y_m"], 20 - 9.81 * time ** 2 / 2, delta=0.015 * time + 1e-6)
            self.assertAlmostEqual(cube["vy_m_per_s"], -9.81 * time, places=3)
            self.assertAlmostEqual(cube["wy_rad_per_s"], 3, places=4)
            # A turn by 3 rad/s about y, in a quaternion of any sign.
            self.assertAlmostEqual(abs(cube["qw"]), abs(math.cos(1.5 * time)), places=3)
            # m v^2 / 2 + m a^2 / 6 w^2 / 2, of 1000 kg
            self.assertAlmostEqual(cube["kinetic_J"], 500 * (4 + (9.81 * time) ** 2) + 1000 / 6 * 4.5, delta=1)
            self.assertAlmostEqual(cube["kinetic_J"] + cube["potential_J"], 500 * 4 + 750 + 9810 * 20, delta=5)
            mean = float(rows["rope", "", frame]["y_m"])
            points = [float(rows["rope", str(i), frame]["y_m"]) for i in range(5)]
            self.assertAlmostEqual(mean, sum(points) / 5, places=5)
            self.assertAlmostEqual(float(rows["rope", "", frame]["vy_m_per_s"]), -9.81 * time, places=3)

    def test_frames_between_steps_are_at_their_own_time(self):
        # Two of three frames lie between steps of 1/60 s.
        scene = FALL | {"bodies": [{"name": "cube", "kind": "dynamic", "position": [0, 20, 0], "velocity": [2, 0, 0],
                                    "angular_velocity": [0, 3, 0], "shape": {"box": {}}}]}
        self.export("x.csv", "--fps", 45, scene=scene)
        rows = table(self.folder / "x.csv")
        for frame in range(46):
            cube, time = rows["cube", "", frame], frame / 45
            self.assertAlmostEqual(float(cube["x_m"]), 2 * time, places=5)
            self.assertAlmostEqual(float(cube["vy_m_per_s"]), -9.81 * time, places=3)
            self.assertAlmostEqual(abs(float(cube["qw"])), abs(math.cos(1.5 * time)), places=4)

    def test_the_first_row_of_a_cloth_has_the_top_of_its_image(self):
        self.export("x.glb", "--seconds", 0.1)
        self.export("x.usda", "--seconds", 0.1)
        self.export("x_%04d.obj", "--seconds", 0.1)
        glb = Glb(self.folder / "x.glb")
        flag = glb.json["meshes"][glb.json["nodes"][glb.roots()["flag"]]["mesh"]]["primitives"][0]
        # glTF counts from the top, USD and OBJ from the bottom; the cloth has nine columns and seven rows.
        self.assertEqual(glb.accessor(flag["attributes"]["TEXCOORD_0"])[::62], [(0, 0), (1, 1)])
        numbers = Usda(self.folder / "x.usda").value("/World/flag", "primvars:st", 0)
        self.assertEqual((numbers[:2], numbers[-2:]), ([0, 1], [1, 0]))
        flag = (self.folder / "x_0000.obj").read_text().split("o flag\n")[1]
        self.assertEqual(flag[flag.index("vt "):].split("\n")[0], "vt 0 1")

    def test_files_carry_metals_relief_glass_and_lights(self):
        self.picture("bumps.png", gray=True)
        self.picture("worn.png", gray=False)
        self.export("x.glb", scene=LOOKS)
        glb = Glb(self.folder / "x.glb")
        made = {material["name"]: material for material in glb.json["materials"]}
        brass = made["brass"]["pbrMetallicRoughness"]
        self.assertEqual((brass["metallicFactor"], round(brass["roughnessFactor"], 5)), (1, 0.25))
        self.assertEqual(made["brass"]["normalTexture"]["scale"], -0.5)
        self.assertIn("index", brass["metallicRoughnessTexture"])
        self.assertEqual(set(self.tangents(glb, "mail")), {(1, 0, 0, 1)})  # Its columns go along x.
        self.assertEqual(made["pane"]["extensions"]["KHR_materials_transmission"]["transmissionFactor"], 0.75)
        self.assertEqual(set(glb.json["extensionsUsed"]), {"KHR_lights_punctual", "KHR_materials_transmission"})
        lights = glb.json["extensions"]["KHR_lights_punctual"]["lights"]
        self.assertEqual([light["type"] for light in lights], ["directional", "spot", "point", "directional"])
        # A light of intensity 1 makes white as bright as the sun of 1 does; candela at 1 m are lux.
        self.assertAlmostEqual(lights[0]["intensity"], 1.5 * math.pi * 0.5, places=4)
        self.assertAlmostEqual(lights[1]["intensity"], 1.5 * math.pi * 4, places=4)
        self.assertAlmostEqual(lights[1]["spot"]["outerConeAngle"], math.radians(30), places=6)
        self.assertAlmostEqual(lights[1]["spot"]["innerConeAngle"], math.radians(10), places=6)
        nodes = [node for node in glb.json["nodes"] if "KHR_lights_punctual" in node.get("extensions", {})]
        self.assertEqual([node["extensions"]["KHR_lights_punctual"]["light"] for node in nodes], [0, 1, 2, 3])
        for node, wanted in zip(nodes, [(0.6, -0.8, 0), (1, -1, 2), None, (0, 0, 1)]):
            if wanted is not None:
                unit = [x / math.hypot(*wanted) for x in wanted]
                self.assertLess(distance(rotate(node["rotation"], (0, 0, -1)), unit), 1e-6, node)
        self.assertEqual(nodes[1]["translation"], [1, 3, 2])

    def tangents(self, glb, name):
        primitive = glb.json["meshes"][glb.json["nodes"][glb.roots()[name]]["mesh"]]["primitives"][0]
        self.assertIn("TANGENT", primitive["targets"][0])
        return glb.accessor(primitive["attributes"]["TANGENT"])

    def test_relief_of_heights_becomes_normals(self):
        self.picture("bumps.png", gray=True)
        self.picture("worn.png", gray=False)
        self.export("seq/x.obj", "--seconds", 0.1, scene=LOOKS)
        library = (self.folder / "seq/x.mtl").read_text()
        self.assertIn("norm x_bumps.png", library)
        self.assertRegex(library, r"Pr 0.25\nPm 1\n")
        self.assertNotEqual((self.folder / "seq/x_bumps.png").read_bytes(), (self.folder / "bumps.png").read_bytes())

    def test_a_usda_has_the_same_look(self):
        self.picture("bumps.png", gray=True)
        self.picture("worn.png", gray=False)
        self.export("x.usda", scene=LOOKS)
        usda = Usda(self.folder / "x.usda")
        brass, lights = "/World/Looks/brass/", "/World/Lights/"
        self.assertEqual(usda.value(brass + "normals", "inputs:scale", 0), [-1, -1, 2, 1])
        self.assertEqual(usda.value(brass + "normals", "inputs:bias", 0), [0.5, 0.5, -1, 0])
        self.assertEqual(usda.value(brass + "finish", "inputs:scale", 0), [1, 0.25, 1, 1])
        self.assertEqual(usda.value("/World/Looks/pane/surface", "inputs:opacity", 0), [0.25])
        for name, intensity in (("sun", 0.5), ("light", 4 * 4), ("light_2", 2 * 4), ("light_3", 1)):
            got = usda.value(lights + name, "inputs:intensity", 0)[0]
            self.assertAlmostEqual(got, 1.5 * math.pi * intensity, places=3)
        self.assertAlmostEqual(usda.value(lights + "light", "inputs:shaping:cone:angle", 0)[0], 30, places=4)
        self.assertAlmostEqual(usda.value(lights + "light", "inputs:shaping:cone:softness", 0)[0], 2 / 3, places=5)
        w, *xyz = usda.value(lights + "light", "xformOp:orient", 0)
        aim = [x / math.sqrt(6) for x in (1, -1, 2)]
        self.assertLess(distance(rotate((*xyz, w), (0, 0, -1)), aim), 1e-5)
        self.assertIn("DomeLight", (self.folder / "x.usda").read_text())

    def test_names_with_commas_and_quotes_stay_in_their_column(self):
        self.export("x.csv")
        rows = table(self.folder / "x.csv")
        self.assertIn(('ball, "of" glass/ä', "", 0), rows)
        self.assertIn(("comes", "", FRAME_OF_COMING), rows)
        self.assertNotIn(("comes", "", FRAME_OF_COMING - 1), rows)
        self.assertNotIn(("goes", "", FRAME_OF_GOING), rows)

    def test_a_seam_that_parts_changes_no_triangle(self):
        cloth = {"columns": 6, "rows": 6, "width": 1, "height": 1}
        scene = FALL | {"cloths": [cloth | {"name": "left", "corner": [0, 2, 0], "pins": [{"column": 0}]},
                                   cloth | {"name": "right", "corner": [1, 2, 0], "total_mass": 5}],
                        "seams": [{"name": "seam", "a": "left.right", "b": "right.left", "strength": 1}]}
        out, _ = self.hooke("run", self.scene(scene), code=0)
        self.assertIn("broke", out)
        self.export("seq/frame_%04d.obj", scene=scene)
        self.export("x.glb", scene=scene)
        glb = Glb(self.folder / "x.glb")
        for frame in (0, 15, 30):
            for name, node in glb.roots().items():
                self.assert_near(glb.vertices(node, frame / 30), self.frame(frame)[name], TOLERANCE + ROUNDING, name)

    def test_a_body_that_yields_shows_its_dent(self):
        tin = {"impulse": 100, "cell": 0.1, "young_modulus": 1e7, "damping": 0.02, "yield_stress": 30000,
               "freeze_below": 2, "freeze_after": 0.05}
        scene = FALL | {"seconds": 1, "bodies": [
            {"name": "ground", "shape": {"half_space": {}}},
            {"name": "tin", "kind": "dynamic", "shape": {"box": {"half_extents": [0.3, 0.1, 0.3]}}, "density": 1000,
             "position": [0, 0.1, 0], "yields": tin},
            {"name": "lid", "kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.1, 0.1]}}, "density": 100,
             "position": [0.41, 0.1, 0]},
            {"name": "weight", "kind": "dynamic", "shape": {"sphere": {"radius": 0.15}}, "density": 7800,
             "position": [0, 0.6, 0], "velocity": [0, -8, 0]}],
            "hooks": [{"name": "hinge", "kind": "hinge", "a": "tin", "b": "lid", "anchor": [0.3, 0.1, 0],
                       "axis": [0, 0, 1]}]}
        self.export("seq/frame_%04d.obj", scene=scene)
        _, err = self.export("x.glb", scene=scene)
        self.assertIn("1 hooks of bodies with 'yields' are no joints", err)
        first, last = self.frame(0)["tin"], self.frame(30)["tin"]
        turned = [distance(a, b) - distance(c, d) for a, b, c, d in zip(first, first[1:], last, last[1:])]
        self.assertGreater(max(map(abs, turned)), 0.01)  # A rigid motion keeps distances.
        glb = Glb(self.folder / "x.glb")
        for frame in (0, 10, 30):
            self.assert_near(glb.vertices(glb.roots()["tin"], frame / 30), self.frame(frame)["tin"],
                             TOLERANCE + ROUNDING, f"frame {frame}")
        self.export("x.csv", scene=scene)
        self.assertAlmostEqual(float(table(self.folder / "x.csv")["tin", "", 0]["y_m"]), 0.1, places=6)

    def test_an_obj_sequence_names_its_materials_and_frames(self):
        self.export("seq/frame_%04d.obj", "--seconds", 0.1)
        names = sorted(path.name for path in (self.folder / "seq").iterdir())
        self.assertEqual(names, ["frame.mtl", *[f"frame_000{i}.obj" for i in range(4)], "frame_flag.png"])
        library = (self.folder / "seq/frame.mtl").read_text()
        self.assertIn("map_Kd frame_flag.png", library)
        for path in (self.folder / "seq").glob("*.obj"):
            text = path.read_text()
            self.assertIn("mtllib frame.mtl\n", text)
            used, made = set(re.findall(r"^usemtl (.*)$", text, re.M)), set(re.findall(r"^newmtl (.*)$", library, re.M))
            self.assertTrue(used and used <= made, used - made)
            count = len(re.findall(r"^v ", text, re.M))
            corners = [int(x) for x in re.findall(r"[ ](\d+)/", text)]
            self.assertEqual((min(corners), max(corners)), (1, count))

    def test_an_obj_without_a_place_for_the_number_gets_one(self):
        self.export("x.obj", "--seconds", 0.1)
        self.assertIn("x_0000.obj", self.files())
        self.assertIn("x.mtl", self.files())


class Refusals(Export):
    """Bad input: a message that helps, and no file."""

    def refuse(self, output, *words, scene=None, code=2, pattern=""):
        before = self.files()
        _, errors = self.export(output, *words, scene=scene, code=code)
        self.assertRegex(errors, pattern)
        self.assertEqual(set(self.files()) - set(before) - {"scene.json"}, set())

    def test_endings_that_are_no_format(self):
        for output in ("x.fbx", "x", "x.mp4"):
            self.refuse(output, pattern=r"not one of X\.glb")
        self.refuse("x_%s.obj", pattern="like %04d")
        self.refuse("x.glb", "--points", pattern="--points: is for X.csv")

    def test_outputs_that_cannot_be_written(self):
        self.refuse("nowhere/x.glb", code=3, pattern="nowhere/x.glb: cannot be written")
        (self.folder / "file").write_text("")
        self.refuse("file/caches/", code=3, pattern="file/caches/: cannot be written")
        (self.folder / "x.glb").mkdir()
        self.export("x.glb")  # A folder takes point caches, whatever it is called.
        self.assertTrue((self.folder / "x.glb" / "bodies.glb").exists())

    def test_numbers_that_make_no_frames(self):
        for words in (["--fps", 0], ["--fps", "nan"], ["--fps", -30], ["--seconds", "nan"], ["--seconds", -1],
                      ["--tolerance", "nan"], ["--morph-targets", 0]):
            self.refuse("x.glb", *words, pattern=words[0])
        self.refuse("x.glb", "--seconds", 0, pattern="shorter than a frame.*--fps")
        self.refuse("x.glb", scene=FALL | {"seconds": 0, "bodies": MIXED["bodies"][:1]}, pattern="shorter than a frame")
        self.refuse("x.glb", "--seconds", 1e6, "--fps", 1000, pattern="a million frames")

    def test_scenes_without_anything_to_see(self):
        self.refuse("x.glb", scene=FALL, pattern="add bodies, ropes, cloths")
        self.refuse("x.glb", scene=FALL | {"fields": [{"uniform": {"acceleration": [0, 1, 0]}}]}, pattern="add bodies, ropes, cloths")

    def test_a_scene_that_only_stands_is_written_and_said_to_stand(self):
        scene = FALL | {"bodies": [{"name": "wall", "shape": {"box": {}}}]}
        out, _ = self.export("x.glb", scene=scene)
        self.assertIn("all bodies are static", out)
        self.assertNotIn("animations", Glb(self.folder / "x.glb").json)

    def test_a_body_that_turns_too_fast_for_the_frames_is_said_to(self):
        body = {"name": "top", "kind": "dynamic", "shape": {"box": {}}, "angular_velocity": [0, 50, 0]}
        scene = FALL | {"bodies": [body]}
        out, _ = self.export("x.glb", "--fps", 10, scene=scene)  # 5 rad a frame
        self.assertIn("more than half a turn", out)
        out, _ = self.export("x.glb", "--fps", 30, scene=scene)
        self.assertNotIn("more than half a turn", out)

    def test_an_image_that_is_missing_leaves_the_color(self):
        scene = FALL | {"materials": {"silk": {"texture": "gone.png"}},
                        "bodies": [{"name": "wall", "material": "silk", "shape": {"box": {}}}]}
        self.refuse("x.glb", scene=scene, pattern="gone.png")

    def test_other_images_become_png(self):
        # A bitmap of one pixel: 24 bits, red.
        header = b"BM" + (58).to_bytes(4, "little") + bytes(4) + (54).to_bytes(4, "little")
        info = b"".join(x.to_bytes(n, "little") for x, n in
                        ((40, 4), (1, 4), (1, 4), (1, 2), (24, 2), (0, 4), (4, 4), (0, 4), (0, 4), (0, 4), (0, 4)))
        (self.folder / "red.bmp").write_bytes(header + info + bytes((0, 0, 255, 0)))
        scene = FALL | {"materials": {"paint": {"texture": "red.bmp"}},
                        "bodies": [{"name": "wall", "material": "paint", "shape": {"box": {}}}]}
        self.export("x.glb", scene=scene)
        glb = Glb(self.folder / "x.glb")
        image = glb.json["images"][0]
        self.assertEqual((image["name"], image["mimeType"]), ("red.png", "image/png"))
        begin = glb.json["bufferViews"][image["bufferView"]]["byteOffset"]
        self.assertEqual(glb.binary[begin:begin + 4], b"\x89PNG")


def node_modules():
    """The folder that `./dev setup formats` fills, or nothing."""
    folder = pathlib.Path(os.environ.get("HOOKE_NODE_MODULES", cli_test.PROJECT / "tests/formats/node_modules"))
    return folder if folder.is_dir() and shutil.which("node") else None


class NodeReader(Export):
    """Readers that are packages of npm; tests/formats says which."""

    def setUp(self):
        super().setUp()
        if node_modules() is None:
            self.skipTest("no node or no packages for it: ./dev setup formats installs them")

    def node(self, script, *files):
        done = subprocess.run(["node", cli_test.PROJECT / "tests/formats" / script, node_modules().resolve(), *files],
                              cwd=self.folder, capture_output=True, text=True, check=False, timeout=cli_test.LIMIT)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


class Validator(NodeReader):
    def test_the_khronos_validator_finds_no_error_and_no_warning(self):
        self.export("mixed.glb")
        self.export("caches/")
        self.picture("bumps.png", gray=True)
        self.picture("worn.png", gray=False)
        self.export("looks.glb", scene=LOOKS)
        self.export("few.glb", "--morph-targets", 5, "--tolerance", 0.01)
        names = ["showcase", "ragdolls", "jelly_model", "hair_wind", "trampoline_particles"]
        for name in names:
            self.hooke("export", f"scenes/{name}.json", "-o", f"{name}.glb", "--seconds", 0.3)
        files = ["mixed.glb", "looks.glb", "caches/bodies.glb", "few.glb", *[f"{name}.glb" for name in names]]
        reports = self.node("validate_glb.js", *files)
        self.assertEqual([report["file"] for report in reports], files)
        for report in reports:
            self.assertEqual((report["errors"], report["warnings"]), (0, 0), report)

    def test_the_validator_finds_what_is_wrong(self):
        self.export("x.glb")
        content = (self.folder / "x.glb").read_bytes()
        (self.folder / "bad.glb").write_bytes(content.replace(b'"VEC4"', b'"VEC2"', 1))
        self.assertGreater(self.node("validate_glb.js", "bad.glb")[0]["errors"], 0)


class UsdReader(NodeReader):
    def test_tinyusdz_reads_every_mesh(self):
        self.export("mixed.usda")
        self.hooke("export", "scenes/showcase.json", "-o", "showcase.usda", "--seconds", 0.2)
        mixed, showcase = self.node("read_usda.mjs", "mixed.usda", "showcase.usda")
        # Nine bodies, one of them with two pieces, a rope, a cloth, a solid, particles and a distance.
        self.assertEqual((mixed["ok"], mixed["error"], mixed["meshes"]), (True, "", 10 + 5), mixed)
        self.assertEqual((showcase["ok"], showcase["error"], showcase["meshes"]), (True, "", 194), showcase)

    def test_tinyusdz_refuses_what_is_wrong(self):
        self.export("x.usda")
        text = (self.folder / "x.usda").read_text()
        (self.folder / "bad.usda").write_text(text.replace("timeSamples = {", "timeSamples = { oops", 1))
        self.assertFalse(self.node("read_usda.mjs", "bad.usda")[0]["ok"])


class Blender(Export):
    """Debian's blender, if it is installed."""

    def compare(self, *scripts, scene=None):
        """Runs scripts that load a motion, and compares five frames with the .obj files."""
        blender = shutil.which("blender")
        if blender is None:
            self.skipTest("no blender: ./dev setup formats installs it")
        shutil.rmtree(self.folder / "seq", ignore_errors=True)
        self.export("seq/frame_%04d.obj", scene=scene)
        # Blender takes the libraries of the first python3 in PATH, and needs those of the system.
        plain = {**os.environ, "PATH": "/usr/local/bin:/usr/bin:/bin"}
        done = subprocess.run([blender, "--background", "--factory-startup", "--python-exit-code", "1", *scripts,
                               "--python", cli_test.PROJECT / "tests/formats/list_vertices.py", "--",
                               self.folder / "x.blend"],
                              cwd=self.folder, env=plain, capture_output=True, text=True, check=False,
                              timeout=cli_test.LIMIT)
        if "No module named 'numpy'" in done.stderr + done.stdout:
            self.skipTest("blender without python3-numpy: ./dev setup formats installs it")
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-3000:])
        frames = json.loads((self.folder / "x.blend.json").read_text())
        self.assertEqual(len(frames), 5)
        for frame, objects in frames.items():
            got = {file_name(name): points for name, points in objects.items()}
            for name, wanted in self.frame(int(frame)).items():
                points = [[x, z, -y] for x, y, z in got[name]]
                if scene is not None and len(points) < 500:  # A body of several materials has them in another order.
                    points = [min(points, key=lambda p, w=w: distance(p, w)) for w in wanted]
                self.assert_near(points, wanted, TOLERANCE + ROUNDING, f"{name} in frame {frame}")

    def test_blender_plays_point_caches(self):
        self.export("caches/")
        self.compare("--python", self.folder / "caches/import_in_blender.py")
        self.assertTrue((self.folder / "x.blend").exists())

    def compare_glb(self, scene=None):
        self.export("x.glb", scene=scene)
        self.compare("--python-expr",
                     "import bpy, numpy; numpy.bool = bool; scene = bpy.context.scene; scene.render.fps = 30; "
                     f"bpy.ops.import_scene.gltf(filepath={str(self.folder / 'x.glb')!r}); scene.frame_end = {FRAMES - 1}",
                     scene=scene)

    def test_blender_plays_tracks_and_morph_targets(self):
        self.compare_glb()

    def test_blender_plays_five_scenes(self):
        for name in ("showcase", "cape_and_runner", "jelly_on_posts", "rope_bridge", "dents"):
            scene = cli_test.PROJECT / f"scenes/{name}.json"
            with self.subTest(scene=name, form="glb"):
                self.compare_glb(scene)
            with self.subTest(scene=name, form="caches"):
                shutil.rmtree(self.folder / "caches", ignore_errors=True)
                self.export("caches/", scene=scene)
                self.compare("--python", self.folder / "caches/import_in_blender.py", scene=scene)


if __name__ == "__main__":
    cli_test.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    cli_test.PROJECT = pathlib.Path(sys.argv[2]).resolve()
    program = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False)
    for _, reason in program.result.skipped:
        print(f"skipped: {reason}")
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if len(program.result.skipped) == program.result.testsRun else 0)
