"""Scenes in which ropes, hair and cloths touch each other."""
import math

import rope_scenes
from scene_kit import HAIR, add, at_point, body, box, ground, promise, scaled, scene
from solid_scenes import icosphere


def rope(*arguments, **more):
    """A rope that touches what is not a body, too."""
    return rope_scenes.rope(*arguments, touches_surfaces=True, **more)


def sheet(name, material, corner, side, points, **more):
    """A level square of cloth that touches itself."""
    return {
        "name": name, "material": material, "columns": points, "rows": points, "corner": corner,
        "column_direction": [1, 0, 0], "row_direction": [0, 0, 1], "width": side, "height": side,
        "areal_density": 0.2, "thickness": 0.008, "bend_stiffness": 1e-5, "self_contact": True
    } | more


def line(start, end, segments):
    return [[a + (b - a) * i / segments for a, b in zip(start, end)] for i in range(segments + 1)]


def rope_on_net():
    """Three ropes fall on a sheet that is held at its rim."""
    radius, thickness, top, rim = 0.01, 0.01, 0.8, [{"column": 0}, {"column": "last"}, {"row": 0}, {"row": "last"}]
    net = sheet("net", "sand", [-0.5, top, -0.5], 1.0, 26, pins=rim, areal_density=1.0, thickness=thickness,
                self_contact=False, damping=5)
    ropes = [
        rope("long", "hemp", line([-0.4, 0.9, -0.2], [0.4, 0.95, 0.15], 24), 0.3, radius, pins=[], air_friction=0.1),
        rope("across", "rose", line([0.1, 1.0, -0.35], [-0.05, 1.05, 0.35], 20), 0.25, radius, pins=[], air_friction=0.1),
        rope("upright", "slate", line([-0.1, 0.9, 0.05], [-0.1, 1.5, 0.06], 18), 0.2, radius, pins=[], air_friction=0.1)
    ]
    return scene(
        "Ropes on a net",
        "Three ropes fall on a sheet that is held at its rim, one of them on its end. They lie in its hollow and over "
        "each other, and none passes through it.",
        6, [0.55, 1.25, 0.8], [0, 0.75, 0], {"sand": {"friction": 0.6}, "hemp": {"friction": 0.6}, "rose": {"friction": 0.6}, "slate": {"friction": 0.6}},
        [], [
            promise("lowest", ">", top - 0.15, "long"),
            promise("lowest", ">", top - 0.15, "across"),
            promise("lowest", ">", top - 0.15, "upright"),
            promise("highest", "<", top + 0.1, "upright"),
            promise("kinetic_energy", "<", 0.01)
        ], world={"particle_substeps": 2}, cloths=[net], ropes=ropes)


def noodles():
    """Forty ropes fall in a bowl."""
    sides, rim, height = 12, 0.17, 0.035
    walls = []
    for k in range(sides):
        turn = 2 * math.pi * k / sides
        out = [math.cos(turn), 0, math.sin(turn)]
        walls.append({"name": f"wall_{k}", "material": "ivory", "shape": box(0.01, height, rim * math.tan(math.pi / sides) + 0.01),
                      "position": add(scaled(rim, out), [0, height, 0]),
                      "rotation": [0, -math.sin(turn / 2), 0, math.cos(turn / 2)]})
    ropes = []
    for k in range(40):
        turn, layer = 2.4 * k, k // 4
        along = scaled(0.13, [math.cos(turn), 0, math.sin(turn)])
        middle = [0.03 * math.cos(2.1 * k), 0.1 + 0.04 * layer + 0.01 * (k % 4), 0.03 * math.sin(2.1 * k)]
        ropes.append(rope(f"noodle_{k}", "sand", line(add(middle, scaled(-1, along)), add(middle, along), 12), 0.01, 0.004,
                          pins=[], air_friction=0.01, bend_stiffness=2e-5, bend_damping=0.05))
    return scene(
        "Noodles",
        "Forty noodles of 26 cm fall in a bowl, one layer after the other, and lie over each other.",
        5, [0.22, 0.42, 0.3], [0, 0.03, 0], {"ground": {"friction": 0.4}, "ivory": {"friction": 0.4}, "sand": {"friction": 0.4}},
        [ground(), *walls], [
            promise("lowest", ">", 0.002, "noodle_0"),
            promise("lowest", ">", 0.002, "noodle_39"),
            promise("highest", "<", 0.15, "noodle_39"),
            promise("highest", ">", 0.02, "noodle_39"),
            promise("largest_stretch", "<", 0.05),
            promise("kinetic_energy", "<", 0.001)
        ], world={"particle_substeps": 2}, ropes=ropes)


def hair_on_shoulders():
    """Hair falls on a cape that lies on shoulders."""
    head, top, golden = 0.1, 1.62, math.pi * (3 - math.sqrt(5))
    ropes = []
    for k in range(60):
        y, angle = 0.2 + 0.75 * (k + 0.5) / 60, golden * k
        r = math.sqrt(1 - y * y)
        n = [r * math.cos(angle), y, r * math.sin(angle)]
        root = add([0, top, 0], scaled(head, n))
        points = [add(root, scaled((i - 1) * 0.025, n)) for i in range(18)]
        ropes.append(rope(f"hair_{k}", "brown_hair" if k % 3 else "dark_hair", points, 0.0006, 0.001, pins=[0, 1], bend_stiffness=1e-6,
                          bend_damping=0.02, air_friction=0.0005, repulsion_strength=1e-7, repulsion_range=0.015))
    cape = sheet("cape", "rose", [-0.42, 1.47, -0.42], 0.84, 29, areal_density=0.25, damping=1)
    return scene(
        "Hair on shoulders",
        "Sixty hairs of 42 cm fall on a cape that lies on shoulders, and rest on it. Hair pushes hair away, but touches "
        "the cape strand by strand.",
        4, [0.56, 1.95, 0.95], [0, 1.33, 0], {
            "ground": {"color": [0.10, 0.09, 0.085]}, "skin": HAIR["skin"], "slate": {}, "brown_hair": HAIR["brown_hair"], "dark_hair": HAIR["dark_hair"],
            "rose": {"color": [0.35, 0.03, 0.06], "roughness": 0.9, "sheen": 0.6, "friction": 0.6}
        }, [
            ground(),
            body("head", "skin", {"sphere": {"radius": head}}, [0, top, 0], "static"),
            body("shoulders", "slate", {"capsule": {"radius": 0.09, "half_height": 0.16}}, [0, 1.34, 0], "static",
                 rotation=[0, 0, math.sin(math.pi / 4), math.cos(math.pi / 4)]),
            body("trunk", "slate", {"cylinder": {"radius": 0.13, "half_height": 0.65}}, [0, 0.65, 0], "static"),
        ], [
            promise("highest", ">", 1.4, "cape"),
            promise("lowest", ">", 0.6, "cape"),
            promise("lowest", ">", 1.0, "hair_10"),
            promise("kinetic_energy", "<", 0.001)
        ], world={"particle_substeps": 2}, cloths=[cape], ropes=ropes)


def curtain_and_ball():
    """A ball swings into a sheet that hangs over a line."""
    height, thickness = 1.5, 0.008
    curtain = sheet("curtain", "rose", [-0.5, height + 0.012, -0.7], 1.0, 36, thickness=thickness, height=1.4, rows=50,
                    damping=1)
    return scene(
        "Curtain and ball",
        "A sheet falls over a line, without hooks, and hangs there. Then a ball rolls through its lower end, which "
        "gives way, and the sheet stays on the line.",
        6, [1.9, 1.4, 2.2], [0, 0.9, 0], {"ground": {"friction": 0.5}, "rose": {"friction": 0.8}, "hemp": {"friction": 0.8}, "slate": {}}, [
            ground(),
            body("ball", "slate", {"sphere": {"radius": 0.15}}, [0.1, 0.75, -1.4], mass=1.0,
                 velocity=[0, 1.5, 0]),
        ], [
            promise("highest", "==", height, "curtain", 0.05),
            promise("lowest", ">", height - 0.9, "curtain"),
            promise("lowest", "==", height, "line", 0.05),
            promise("mean_stretch", "<", 0.02)
        ], world={"particle_substeps": 2}, cloths=[curtain],
        ropes=[rope("line", "hemp", line([-0.8, height, 0], [0.8, height, 0], 40), 0.5, 0.008, pins=[0, "last"])])


def laundry_pile():
    """Three cloths and a rope fall in a heap."""
    cloths = [
        sheet("towel", "rose", [-0.3, 0.25, -0.3], 0.6, 26),
        sheet("shirt", "ivory", [-0.2, 0.4, -0.28], 0.5, 22),
        sheet("scarf", "moss", [-0.28, 0.55, -0.15], 0.5, 22),
    ]
    coil = [[0.12 * math.cos(0.45 * i), 0.75 + 0.003 * i, 0.12 * math.sin(0.45 * i)] for i in range(40)]
    return scene(
        "Pile of laundry",
        "A towel, a shirt, a scarf and a coil of rope fall on a stool one after the other, and lie in a heap.",
        6, [0.5, 0.66, 0.6], [0, 0.17, 0], {"ground": {"color": [0.20, 0.12, 0.065], "friction": 0.6}, "oak": {"friction": 0.6}, "rose": {"friction": 0.6}, "ivory": {"friction": 0.6},
                                       "moss": {"friction": 0.6}, "hemp": {"friction": 0.6}}, [
            ground(),
            body("stool", "oak", {"cylinder": {"radius": 0.12, "half_height": 0.1}}, [0, 0.1, 0], "static"),
        ], [
            promise("highest", "==", 0.206, "towel", 0.01),
            promise("lowest", ">", 0.003, "towel"),
            promise("lowest", ">", 0.003, "rope"),
            promise("highest", "<", 0.3, "scarf"),
            promise("mean_stretch", "<", 0.03)
        ], world={"particle_substeps": 2}, cloths=cloths, ropes=[rope("rope", "hemp", coil, 0.15, 0.006, pins=[], air_friction=0.05)])


RIM = [{"column": 0}, {"column": "last"}, {"row": 0}, {"row": "last"}]


def jelly_on_posts():
    """A coarse jelly on posts that are thinner than its cells."""
    side, top, half = 0.3, 0.25, 0.012
    posts = [body(f"post_{k}", "oak", box(half, top / 2, half), [x, top / 2, z], kind="static")
             for k, (x, z) in enumerate([(-0.08, -0.07), (0.09, -0.06), (0.01, 0.09)])]
    return scene(
        "Jelly on posts",
        "A jelly of eight cells falls on three posts that are a sixth as thick as a cell, none of them under a corner. They dent it "
        "and do not go in.", 4, [0.75, 0.6, 0.9], [0, 0.3, 0], {"ground": {}, "oak": {"friction": 0.8}, "rose": {"friction": 0.8}},
        [ground(), *posts], [
            promise("lowest", ">", top - 0.06, "jelly"),
            promise("highest", ">", top + 0.7 * side, "jelly"),
            promise("kinetic_energy", "<", 0.01),
        ], world={"particle_substeps": 2}, solids=[{
            "name": "jelly", "material": "rose", "cells": [2, 2, 2], "size": [side] * 3, "density": 300,
            "young_modulus": 30000, "damping": 0.02, "position": [0, top + side / 2 + 0.05, 0]
        }])


def trampoline_and_jelly():
    """A jelly falls on a cloth that is held at its rim, and bounces."""
    top, side, drop = 0.8, 0.2, 0.5
    mat = sheet("mat", "slate", [-0.6, top, -0.6], 1.2, 25, pins=RIM, areal_density=0.5, thickness=0.006, self_contact=False,
                stretch_stiffness=3000, damping=5)
    return scene(
        "A jelly on a trampoline",
        "A jelly of 2.4 kg falls by half a meter on a mat that is held at its rim. Both give way and throw it up again; at last it "
        "lies in the hollow.", 10, [1.3, 1.5, 1.5], [0, 0.85, 0], {"slate": {"friction": 0.8}, "rose": {"friction": 0.8}}, [], [
            promise("lowest", "<", top - 0.05, "jelly", at_step=26),
            promise("lowest", ">", top - 0.3, "jelly"),
            promise("highest", "<", top + 0.15, "jelly"),
            promise("kinetic_energy", "<", 0.05),
        ], world={"particle_substeps": 2}, cloths=[mat], solids=[{
            "name": "jelly", "material": "rose", "cells": [4, 4, 4], "size": [side] * 3, "density": 300,
            "young_modulus": 20000, "damping": 0.01, "thickness": 0.006, "position": [0, top + side / 2 + drop, 0]
        }])


def balls_in_net():
    """Balls fall in a cloth that hangs from its corners, and carry each other there."""
    top, radius = 1.2, 0.08
    net = sheet("net", "sand", [-0.5, top, -0.5], 1.0, 31, pins=[0, 30, 930, "last"], areal_density=0.3, thickness=0.008,
                damping=1)
    places = [[0.17 * (k % 3 - 1) + 0.01 * k, top + 0.1 + 0.2 * (k // 3), 0.13 * (k % 2) - 0.06] for k in range(6)]
    balls = [body(f"ball_{k}", "clay", {"sphere": {"radius": radius}}, place, mass=1) for k, place in enumerate(places)]
    return scene(
        "Balls in a net",
        "Six balls of 1 kg fall in a cloth of 0.3 kg that hangs from its corners. It takes all of them.",
        6, [1.3, 1.6, 1.7], [0, 0.95, 0], {"ground": {}, "sand": {"friction": 0.6}, "clay": {"friction": 0.4}}, [ground(), *balls], [
            *(promise("height", ">", 0.5, f"ball_{k}") for k in range(6)),
            promise("mean_stretch", "<", 0.05),
            promise("kinetic_energy", "<", 0.5),
        ], world={"particle_substeps": 2}, cloths=[net])


def cape_and_runner():
    """A runner carries a cape, which lies on his back and flies behind him."""
    speed, seconds = 4, 4
    motion = {"velocity": [speed, 0, 0]}
    shoulders = [{"point": k, "motion": motion} for k in range(0, 21, 2)]
    cape = {
        "name": "cape", "material": "rose", "columns": 21, "rows": 36, "corner": [-0.13, 1.5, -0.25], "column_direction": [0, 0, 1],
        "row_direction": [-0.5, -0.866, 0], "width": 0.5, "height": 1.0, "areal_density": 0.25, "thickness": 0.006,
        "self_contact": True, "pins": shoulders
    }
    return scene(
        "A cape and a runner",
        f"A runner at {speed} m/s carries a cape by its upper edge. The air lifts it behind him; it stretches by less than 5 %, touches "
        "his back and does not go through.", seconds, [speed * seconds - 2.6, 1.9, 3.2], [speed * seconds - 0.6, 1.1, 0],
        {"ground": {}, "rose": {}, "slate": {}}, [
            ground(),
            body("runner", "slate", {"capsule": {"radius": 0.12, "half_height": 0.4}}, [0, 0.95, 0], "kinematic", motion=motion),
            body("head", "ivory", {"sphere": {"radius": 0.1}}, [0, 1.65, 0], "kinematic", motion=motion),
        ], [
            promise("largest_stretch", "<", 0.05),
            at_point("x", ">", speed * seconds - 1.4, "cape", 745),
            at_point("x", "<", speed * seconds - 0.3, "cape", 745),
            promise("lowest", ">", 0.5, "cape"),
        ], cloths=[cape])


def beanbag():
    """A closed cloth with balls in it."""
    radius, inner = 0.3, 0.05
    places = [[0.115 * (k % 3 - 1), 0.14 + 0.11 * (k // 9), 0.115 * (k // 3 % 3 - 1)] for k in range(27)]
    balls = [body(f"bean_{k}", "ivory", {"sphere": {"radius": inner}}, place, mass=0.05) for k, place in enumerate(places)]
    return scene(
        "Beanbag",
        "Twenty-seven balls of 50 g lie in a bag of cloth. It sinks down and spreads, and none comes out.",
        5, [1.0, 0.8, 1.2], [0, 0.2, 0], {"ground": {"friction": 0.6}, "moss": {"friction": 0.6}, "ivory": {"friction": 0.3}},
        [ground(), *balls], [
            *(promise("height", "<", 0.5, f"bean_{k}") for k in (0, 13, 26)),
            *(promise("speed", "<", 0.1, f"bean_{k}") for k in (0, 13, 26)),
            promise("highest", ">", 0.15, "bag"),
            promise("lowest", ">", 0, "bag"),
        ], world={"particle_substeps": 2}, meshes={"bag": icosphere(radius, 3)}, cloths=[{
            "name": "bag", "material": "moss", "mesh": "bag", "position": [0, radius + 0.004, 0], "areal_density": 0.3,
            "thickness": 0.006, "stretch_stiffness": 400, "bend_stiffness": 1e-5, "damping": 0.5
        }])


def dumplings():
    """Closed cloths with gas among each other."""
    radius = 0.12
    places = [[0.13 * (k % 3 - 1) + 0.02 * (k // 3), radius + 0.01 + 0.27 * (k // 3), 0.09 * (k % 2) - 0.04] for k in range(5)]
    places[0][0], places[2][0], places[3][0], places[4][0] = -0.27, 0.27, -0.14, 0.15
    half, wall = 0.42, 0.01
    walls = [body(f"wall_{k}", "oak", box(*size), at, kind="static") for k, (size, at) in enumerate([
        ([wall, 0.1, half], [-half - wall, 0.1, 0]), ([wall, 0.1, half], [half + wall, 0.1, 0]),
        ([half, 0.1, wall], [0, 0.1, -half - wall]), ([half, 0.1, wall], [0, 0.1, half + wall])])]
    return scene(
        "Dumplings",
        "Five closed cloths full of air fall in a tray, among each other. They dent where they touch, and keep their air.",
        5, [0.9, 0.9, 1.1], [0, 0.1, 0], {"ground": {"friction": 0.6}, "oak": {}, "ivory": {"friction": 0.5}}, [ground(), *walls], [
            *(promise("lowest", ">", 0, f"dumpling_{k}") for k in range(5)),
            promise("highest", "<", 0.6, "dumpling_4"),
            promise("kinetic_energy", "<", 0.02),
        ], world={"particle_substeps": 4}, meshes={"dough": icosphere(radius, 2)}, cloths=[{
            "name": f"dumpling_{k}", "material": "ivory", "mesh": "dough", "position": place, "areal_density": 1, "thickness": 0.006,
            "pressure": 600, "stretch_stiffness": 4000, "shear_stiffness": 0, "damping": 0.5
        } for k, place in enumerate(places)])


SOFT_CONTACT_SCENES = [
    rope_on_net, noodles, hair_on_shoulders, curtain_and_ball, laundry_pile, jelly_on_posts, trampoline_and_jelly, balls_in_net,
    cape_and_runner, beanbag, dumplings
]
