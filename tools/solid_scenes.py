"""Scenes of soft solids and of balls with gas in them; make_scenes.py writes them."""
import math

from scene_kit import DT, G, X, Z, at_point, body, box, fall, ground, promise, scene, turn


def icosphere(radius, levels):
    """An octahedron, each triangle cut in four `levels` times, its points on the sphere."""
    points = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                p = [x + y for x, y in zip(points[a], points[b])]
                size = math.sqrt(sum(x * x for x in p))
                middles[key] = len(points)
                points.append([x / size for x in p])
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        triangles = finer
    return {"vertices": [[radius * x for x in p] for p in points], "triangles": triangles}


def torus(ring, tube, around, across):
    """About the y axis."""
    vertices, triangles = [], []
    for i in range(around):
        a = 2 * math.pi * i / around
        for k in range(across):
            b = 2 * math.pi * k / across
            r = ring + tube * math.cos(b)
            vertices.append([r * math.cos(a), tube * math.sin(b), r * math.sin(a)])
            p, q = i * across + k, i * across + (k + 1) % across
            s, t = (p + across) % (around * across), (q + across) % (around * across)
            triangles += [[p, q, t], [p, t, s]]
    return {"vertices": vertices, "triangles": triangles}


def falling_point(height, step, of, point):
    """As scene_kit.fall, of one point."""
    drop = G * (step * DT)**2 / 2
    return at_point("height", "==", height - drop, of, point, 0.01 * drop, step)


CENTER = 6**3 + 62  # the middle cell of 5 x 5 x 5


def jelly_cube():
    edge, stiffness, step = 0.4, 5e4, 20
    slope = math.atan(0.3)
    cube = {"material": "rose", "cells": [5, 5, 5], "size": [edge] * 3, "young_modulus": stiffness, "damping": 0.01}
    # A column of height H shortens by rho g H^2 / 2 E under its own weight.
    sag = 1000 * G * edge**2 / (2 * stiffness)
    on_slope = [1.1 + 0.25 * math.sin(slope), 0.3 + 0.25 * math.cos(slope), 0]
    return scene(
        "Jelly cubes",
        "A cube of jelly, E = 50 kPa and almost incompressible, falls 1 m, squashes, jumps and comes to rest "
        "shortened by nearly rho g H^2 / 2 E = 16 mm. Another one stays on a slope of tan = 0.3 by friction.", 4,
        [1.9, 1.3, 2.6], [0.4, 0.35, 0], {"ground": {"friction": 0.6}, "slate": {"friction": 0.6}, "rose": {"friction": 0.6}}, [
            ground(),
            body("slope", "slate", box(0.7, 0.05, 0.5), [1.1, 0.25, 0], "static", rotation=turn(Z, slope))
        ], [
            falling_point(1.2, step, "falling", CENTER),
            # Points rest 2 mm above the ground. The foot, held by friction, gives way less than the rest.
            promise("highest", ">", edge + 0.002 - sag, "falling"),
            promise("highest", "<", edge + 0.002 - 0.55 * sag, "falling"),
            promise("lowest", ">", -0.001, "falling"),
            at_point("height", ">", 0.4, "leaning", CENTER),
            at_point("x", "==", on_slope[0], "leaning", CENTER, 0.1),
            promise("kinetic_energy", "<", 0.02),
            promise("penetration", "<", 0.002),
            promise("contacts", ">", 40)
        ], world={"particle_substeps": 2}, solids=[
            {"name": "falling"} | cube | {"position": [0, 1.2, 0]},
            {"name": "leaning"} | cube | {"position": on_slope, "rotation": turn(Z, slope)}
        ])


def jelly_model():
    """Two rings of jelly: one falls and lies, one hangs by its top."""
    ring, tube, lean, step = 0.3, 0.12, 1.2, 15
    jelly = {"mesh": "ring", "cell": 0.08, "young_modulus": 1e5, "poisson_ratio": 0.4, "damping": 0.01}
    return scene(
        "Rings of jelly",
        "A closed mesh filled with a lattice of tetrahedra that carries the mesh along. One ring falls on its edge, "
        "squashes, tips over and lies; one hangs by its top and is drawn out by its weight.", 5, [1.9, 1.2, 2.3],
        [0.35, 0.45, 0], {
            "ground": {"friction": 0.6},
            "rose": {},
            "moss": {}
        }, [ground()], [
            promise("lowest", "==", 1 - ring * math.sin(lean) - tube - G * (step * DT)**2 / 2, "falling", 0.004, step),
            promise("highest", "==", 2 * tube, "falling", 0.02),
            promise("lowest", ">", -0.001, "falling"),
            # At rest 0.58; half the gravity would draw it out half as far.
            promise("lowest", "==", 0.492, "hanging", 0.015),
            promise("kinetic_energy", "<", 0.02),
            promise("penetration", "<", 0.002)
        ], meshes={"ring": torus(ring, tube, 32, 16)}, solids=[
            {"name": "falling", "material": "rose"} | jelly | {
                "position": [0, 1.0, 0], "rotation": turn(X, lean)},
            {"name": "hanging", "material": "moss"} | jelly | {
                "position": [1.0, 1.0, 0], "rotation": turn(X, math.pi / 2), "pins": [{"topmost": 0.03}]}
        ])


def dropped_ball(title, description, ball, look, rebound, tolerance, apex, passes):
    """A ball with gas in it dropped from 100 inches, as the rules of its game have it."""
    start, radius = 2.54, ball.pop("radius")
    ball |= {"name": "ball", "material": look, "mesh": "ball", "position": [0, start + radius, 0]}
    return scene(
        title, description, apex * DT, [0.4, 0.8, 1.9], [0, 0.6, 0], {"ground": {"friction": 0.6}, look: {}},
        [ground()], [
            promise("lowest", "==", start - G * (0.5)**2 / 2, "ball", 0.03, 30),
            promise("lowest", "==", rebound, "ball", tolerance, apex),
            promise("penetration", "<", 0.001),
        ], world={"substeps": 16, "particle_substeps": passes}, meshes={"ball": icosphere(radius, 3)}, cloths=[ball])


def tennis_ball():
    ball = {"radius": 0.033, "total_mass": 0.0577, "pressure": 82700, "thickness": 0.001, "stretch_stiffness": 30000,
            "shear_stiffness": 0, "bend_stiffness": 0.12, "bend_damping": 0.0006, "damping": 3, "drag_coefficient": 0, "lift_coefficient": 0}
    return dropped_ball("Tennis ball", "Rubber and felt with gas at 12 psi. From 100 inches on concrete the rules "
                        "ask for a rebound of 1.35 to 1.47 m.", ball, "felt", 1.41, 0.06, 76, 32)


def squash_ball():
    ball = {"radius": 0.02, "total_mass": 0.024, "pressure": 0, "thickness": 0.001, "stretch_stiffness": 7000,
            "shear_stiffness": 0, "bend_stiffness": 0.12, "damping": 7, "drag_coefficient": 0, "lift_coefficient": 0}
    return dropped_ball("Squash ball", "Rubber of 4 mm, warm. From 100 inches the rules ask for a rebound of 26 to "
                        "33 %, 0.66 to 0.84 m.", ball, "rubber", 0.75, 0.09, 66, 8)


def matched_shapes():
    """Solids without tetrahedra: a ring hangs, a cube and a ball fall; a rigid one beside the soft."""
    edge, mass, step, hz = 0.4, 2.0, 20, 12
    matched = {"elasticity": "shape_matching"}
    shape = torus(0.25, 0.1, 20, 10)
    cube = matched | {"cells": [4, 4, 4], "size": [edge] * 3}
    ball = matched | {"mesh": "ball", "total_mass": mass, "match_damping_ratio": 0.3}
    return scene(
        "Matched shapes",
        "Solids that cost a few percent of tetrahedra: every point is drawn to its place in the form at rest. A ring "
        "hangs by its eye, from m g; cubes and balls fall, soft ones at 6 and 12 Hz, and one that is rigid.", 5,
        [1.5, 1.3, 3.1], [0.1, 0.6, 0], {
            "ground": {"friction": 0.6},
            "rose": {},
            "moss": {},
            "slate": {}
        }, [ground()], [
            falling_point(1.0, step, "cube", 62),
            promise("force", "within", mass * G, "hook", 0.01),
            promise("gap", "<", 0.0005, "hook"),
            promise("highest", "==", edge + 0.002, "rigid", 0.001),
            promise("lowest", ">", -0.001, "cube"),
            promise("highest", "<", edge, "cube"),
            promise("lowest", ">", -0.001, "ball"),
            promise("kinetic_energy", "<", 0.02),
            promise("penetration", "<", 0.002),
        ], meshes={
            "ring": shape | {"connection_points": {"eye": [0.35, 0, 0]}},
            "ball": icosphere(0.25, 3)
        }, solids=[
            {"name": "cube", "material": "rose"} | cube | {"match_hz": hz, "position": [0.7, 1.0, 0]},
            {"name": "rigid", "material": "slate"} | cube | {"match_hz": "rigid", "position": [1.4, 0.6, 0]},
            {"name": "ball", "material": "moss"} | ball | {"match_hz": hz / 2, "position": [0, 0.7, 0.2]},
            {"name": "ring", "material": "rose", "mesh": "ring", "total_mass": mass} | matched |
            {"match_hz": 40, "match_damping_ratio": 0.5, "position": [-0.7, 1.0, 0], "rotation": turn(Z, math.pi / 2)}
        ], hooks=[{"name": "hook", "b": "ring.eye"}])


def dents():
    """Two balls as stiff as each other, of which one flows; two sheets over an edge, of which one takes the fold."""
    radius, start, step, apex = 0.15, 1.0, 20, 50
    ball = {"mesh": "ball", "cell": 0.06, "young_modulus": 1e5, "poisson_ratio": 0.4}
    balls = (("clay_ball", "clay", 0.1, {"yield_stress": 5000}), ("rubber_ball", "rose", 0.6, {}))
    top, edge, thickness, cell, out = 0.5, -0.5, 0.004, 0.05, 4  # the sheets stand out by so many cells
    rigidity, density = 0.02, 0.2
    sheet = {
        "columns": 2 * out + 1, "rows": 6, "column_direction": X, "row_direction": Z, "width": 2 * out * cell,
        "height": 5 * cell, "areal_density": density, "thickness": thickness, "stretch_stiffness": 5e3,
        "shear_stiffness": 1e3, "bend_stiffness": rigidity, "bend_damping": 0.02, "damping": 0.1, "drag_coefficient": 0,
        "lift_coefficient": 0, "pins": [{"column": k} for k in range(out + 1)]
    }
    sheets = (("paper", "ivory", -0.2, {"yield_angle": 0.3}), ("spring_sheet", "steel", 0.2, {}))
    plank = [{"time": t, "offset": [0, y, 0]} for t, y in ((0.5, 0), (1.5, -0.2), (2, -0.2), (3.5, 0.15))]
    # Each edge across the sheet bends by M cell / rigidity under the weight of what is beyond it.
    sag = sum(density * G * (k * cell)**2 / 2 * cell / rigidity * k * cell for k in range(1, out + 1))
    tip = 2 * out
    return scene(
        "Dents and folds",
        "A ball of clay and one of rubber, as stiff as each other, fall 1 m: one jumps, one stays where it fell, flat. A "
        "plank bends two sheets over the edge of a table and goes up again: one springs back, one keeps the fold.", 5,
        [1.1, 0.95, 1.5], [0, 0.3, 0], {"ground": {"friction": 0.6}, "oak": {}, "steel": {}, "ivory": {}, "clay": {}, "rose": {}}, [
            ground(),
            body("table", "oak", box(0.2, top / 2, 0.4), [edge - 0.2, top / 2, 0], "static"),
            body("plank", "oak", box(0.05, 0.02, 0.4), [edge + 0.14, top + 0.04, 0], "kinematic", motion={"keyframes": plank}),
        ], [
            *(promise("lowest", "==", start - G * (step * DT)**2 / 2, name, 0.012, step) for name, *_ in balls),
            promise("lowest", ">", 0.3 * start, "rubber_ball", at_step=apex),
            promise("lowest", "<", 0.01, "clay_ball", at_step=apex),
            promise("highest", ">", 0.9 * 2 * radius, "rubber_ball"),
            promise("highest", "<", 0.6 * 2 * radius, "clay_ball"),
            at_point("height", "==", top - sag, "spring_sheet", tip, 0.02),
            at_point("height", "<", top - sag - 0.06, "paper", tip),
        ], world={"particle_substeps": 4}, meshes={"ball": icosphere(radius, 2)},
        solids=[{"name": name, "material": look, "position": [x, start + radius, 0]} | ball | more for name, look, x, more in balls],
        cloths=[{"name": name, "material": look, "corner": [edge - out * cell, top + thickness / 2, z - 2.5 * cell]} | sheet | more
                for name, look, z, more in sheets])


SOLID_SCENES = [jelly_cube, jelly_model, matched_shapes, dents, tennis_ball, squash_ball]
