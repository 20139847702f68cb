"""Scenes of what is cut and bursts; make_scenes.py writes them."""
import math

from scene_kit import X, Y, Z, at_point, body, box, ground, hook, promise, scene, turn
from solid_scenes import icosphere


def path(*keys):
    """A motion through offsets from the start, each at its time."""
    return {"keyframes": [{"time": time, "offset": offset} for time, offset in keys]}


def cake_and_blade():
    cells, size, top, gap, apart = [10, 3, 8], [0.3, 0.09, 0.24], 0.1, 0.002, 0.08
    blade_half, blade_start, blade_at = 0.06, 0.4, 0.004
    board = [0.1, 0.01, 0.16]
    down = top - 0.005 + blade_half - blade_start  # Its edge goes between the boards.
    cut_at, parted = 1.0, 2.6
    boards = [("left", -1), ("right", 1)]

    def corner(x, y, z):
        return x + (cells[0] + 1) * (y + (cells[1] + 1) * z)

    middle = cells[2] // 2
    return scene(
        "A cake and a blade",
        "A cake lies across two boards. A blade comes down between them and cuts it, along the faces of its tetrahedra; then "
        "the boards go apart, and each takes its half along.", 3, [0.55, 0.5, 0.75], [0, 0.14, 0], {
            "ground": {},
            "oak": {"friction": 0.8},
            "steel": {},
            "ivory": {"friction": 0.8}
        }, [
            ground(),
            *(body(name, "oak", box(*board), [way * (board[0] + gap), top - board[1], 0], "kinematic",
                   motion=path((1.8, [0, 0, 0]), (parted, [way * apart, 0, 0]))) for name, way in boards),
            body("knife", "steel", box(0.001, blade_half, 0.17), [blade_at, blade_start, 0], "kinematic", collides=False,
                 blade={"edge": [[0, -blade_half, -0.17], [0, -blade_half, 0.17]], "cuts": ["cake"]},
                 motion=path((0.4, [0, 0, 0]), (cut_at, [0, down, 0]), (1.6, [0, 0, 0]))),
        ], [
            promise("broken", "==", 0, "cake", at_step=30),
            promise("broken", ">", (cells[1] + 1) * (cells[2] + 1), "cake"),
            at_point("x", "==", -size[0] / 2 - apart, "cake", corner(0, 1, middle), 0.01),
            at_point("x", "==", size[0] / 2 + apart, "cake", corner(cells[0], 1, middle), 0.01),
            promise("lowest", ">", top - 0.004, "cake"),
            promise("highest", "<", top + size[1] + 0.005, "cake"),
        ], world={"particle_substeps": 2}, solids=[{
            "name": "cake", "material": "ivory", "cells": cells, "size": size, "position": [0, top + size[1] / 2 + 0.003, 0],
            "density": 400, "young_modulus": 10000, "poisson_ratio": 0.3, "damping": 0.01
        }])


def balloon_burst():
    radius, low, press_at, holds = 0.2, 0.16, 1.6, 0.15
    start = 2 * radius + 0.05
    return scene(
        "A balloon bursts",
        f"A board comes down on a balloon whose skin takes a strain of {100 * holds:.0f} %. Its gas has nowhere to go, and the "
        "skin is stretched until it tears. The gas is gone at the first tear, and the board falls on what is left.", 2.5,
        [0.9, 0.6, 1.1], [0, 0.2, 0], {"ground": {}, "silk": {}, "oak": {}}, [
            ground(),
            body("board", "oak", box(0.3, 0.015, 0.3), [0, start + 0.015, 0], "kinematic",
                 motion=path((0.2, [0, 0, 0]), (press_at, [0, low - start, 0]))),
        ], [
            promise("highest", ">", 1.9 * radius, "balloon", at_step=12),
            promise("broken", "==", 0, "balloon", at_step=36),
            promise("broken", ">", 0, "balloon"),
            promise("highest", "<", low + 0.005, "balloon"),
        ], world={"particle_substeps": 4}, meshes={"ball": icosphere(radius, 3)}, cloths=[{
            "name": "balloon", "material": "silk", "mesh": "ball", "position": [0, radius + 0.002, 0], "areal_density": 0.3,
            "thickness": 0.002, "pressure": 1000, "stretch_stiffness": 2000, "shear_stiffness": 0, "bend_stiffness": 0.0001,
            "damping": 0.2, "tear_strain": holds
        }])


def door_and_car():
    half_width, half_height, half_depth = 1.0, 1.0, 0.03
    gap, hinge_x, speed, radius, aside = 0.22, -1.02, 2.6, 0.28, 0.25
    start = -2.6
    wheels = [(side, end) for side in (-1, 1) for end in (-1, 1)]
    lie = turn(Z, math.pi / 2)
    spin = [speed / radius, 0, 0]
    car = {
        "parts": [{"shape": box(0.5, 0.16, 1.15), "material": "paint"},
                  {"shape": box(0.42, 0.2, 0.5), "position": [0, 0.36, -0.15], "material": "glass"},
                  {"shape": {"cylinder": {"radius": 0.16, "half_height": 0.2}}, "position": [0, 0, 1.15], "rotation": lie,
                   "material": "steel"}]
    }
    made = scene(
        "A door and a car",
        "The paper's door (3.6.1): a car drives against a door of tin on two hinges. The blow is more than the door takes as "
        "a rigid body. It turns soft, is bent by fifteen centimeters, swings open, and is a rigid body again, with its dent and on its "
        "hinges, within two seconds.", 3, [3.6, 2.1, 4.6], [0, 0.95, 0.3], {"ground": {}}, [
            ground(),
            body("posts", "concrete", box(0.15, 1.2, 0.15), [hinge_x - 0.17, 1.2, 0], "static",
                 array={"list": [[0, 0, 0], [2.4, 0, 0]]}),
            body("lintel", "concrete", box(1.35, 0.15, 0.15), [0, 2.55, 0], "static"),
            body("wall", "concrete", box(0.15, 1.2, 1.15), [hinge_x - 0.55, 1.2, 1.3], "static"),
            body("door", "tin", box(half_width, half_height, half_depth), [0, half_height + gap, 0], mass=300,
                 angular_damping=6),
            body("car", "paint", car, [aside, 0.5, start], mass=420, velocity=[0, 0, speed]),
            *(body(f"wheel_{i}", "rubber", {"cylinder": {"radius": radius, "half_height": 0.07}},
                   [aside + 0.6 * side, radius, start + 0.75 * end], rotation=lie, mass=14, velocity=[0, 0, speed],
                   angular_velocity=spin) for i, (side, end) in enumerate(wheels)),
        ], [
            promise("soft", "==", 0, "door", at_step=30),
            promise("soft", "==", 1, "door", at_step=35),
            promise("yielded", "==", 1, "door"),
            promise("soft", "==", 0, "door", at_step=150),
            # What there was at the start, 1704 J of motion and 5986 J of height: the blow makes none.
            promise("total_energy", "<", 7690),
            promise("gap", "<", 0.002, "upper_hinge"),
            promise("gap", "<", 0.002, "lower_hinge"),
        ], world={"particle_substeps": 3}, hooks=[
            hook("upper_hinge", "hinge", "door", [hinge_x, 1.75, 0], "posts[0]", axis=Y),
            hook("lower_hinge", "hinge", "door", [hinge_x, 0.3, 0], "posts[0]", axis=Y),
            *(hook(f"axle_{i}", "hinge", f"wheel_{i}", [aside + 0.6 * side, radius, start + 0.75 * end], "car", axis=X,
                   motor={"max_force": 25}) for i, (side, end) in enumerate(wheels)),
        ])
    made["materials"] |= {
        "paint": {"like": "steel", "color": [0.5, 0.03, 0.03], "metalness": 0.3, "roughness": 0.25},
        "tin": {
            "like": "steel", "roughness": 0.45, "yields": {
                "impulse": 200, "cell": 0.2, "young_modulus": 10000000, "damping": 0.02, "yield_stress": 60000,
                "freeze_below": 2, "freeze_after": 0.05
            }
        }
    }
    return made


BREAKING_SCENES = [cake_and_blade, balloon_burst, door_and_car]
