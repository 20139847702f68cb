"""Scenes of what is cut and bursts; make_scenes.py writes them."""
from scene_kit import at_point, body, box, ground, promise, scene
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


BREAKING_SCENES = [cake_and_blade, balloon_burst]
