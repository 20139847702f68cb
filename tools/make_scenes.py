#!/usr/bin/env python3
"""Writes the scenes that are too regular or too long to be written by hand, scenes/*.json.

usage: make_scenes.py [--check] [NAME ...]

Without names all are written. With --check it writes nothing and fails if a file there differs. The same bytes
each time: no clock, own random numbers, coordinates rounded before they are written.
"""
import json
import math
import pathlib
import struct
import sys

from breaking_scenes import BREAKING_SCENES
from cloth_scenes import CLOTH_SCENES
from concave_scenes import chain_of_links, gears, torus_on_peg
from field_scenes import FIELD_SCENES
from hook_scenes import HOOK_SCENES
from paper_scenes import fig5, fig6, rollback_room, wall
from scene_kit import (DT, G, TONES, Random, X, Y, Z, add, at_point, body, box, cross, dot, fall,
                       fibonacci_points, ground, hull_of, prism, product, low_sun, promise, rotated, scaled,
                       scene, sector, slab, solid_mass, solid_moments, spot, text_of, turn, weight_energy)
from rope_scenes import ROPE_SCENES
from soft_contact_scenes import SOFT_CONTACT_SCENES
from solid_scenes import SOLID_SCENES
from structure_scenes import STRUCTURE_SCENES

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "scenes"

# ---- Slopes -----------------------------------------------------------------------------------------------


def slope_crate():
    theta = math.atan(0.5)
    s, c = math.sin(theta), math.cos(theta)
    down, normal = [c, -s, 0], [s, c, 0]
    lean = turn(Z, -theta)

    def on_slope(distance, half_height, z):
        """`distance` up from the foot of the slope, which is at the origin."""
        return add(add(scaled(-distance, down), scaled(half_height, normal)), [0, 0, z])

    slide = G * (s - 0.2 * c) / 2  # of the way in the first second
    start = on_slope(5, 0.3, 0)
    after = add(start, scaled(slide, down))
    return scene(
        "Crates on a slope",
        "tan(theta) = 0.5. Left, friction 0.6 > tan(theta): it stays. Middle, friction 0.2: it slides with a "
        "= g (sin(theta) - 0.2 cos(theta)) = 2.632 m/s^2, 1.316 m in the first second, and hits another "
        "crate at the foot. Right, a tall one with friction 0.6 and b/h = 0.3 < tan(theta): it tips over.", 4,
        [5.5, 3.2, 7.5], [-1.6, 0.9, 0], {
            "ground": {"friction": 0.5}, "sand": {"friction": 0.6}, "crate": {"friction": 0.6},
            "oak": {"friction": 0.2}, "clay": {"friction": 0.6}
        }, [
            ground(),
            body("slope", "sand", box(4, 0.5, 2), on_slope(4, -0.5, 0), "static", rotation=lean),
            body("stays", "crate", box(0.3, 0.3, 0.3), on_slope(5, 0.3, -1.2), rotation=lean, density=500),
            body("slides", "oak", box(0.3, 0.3, 0.3), start, rotation=lean, density=500),
            body("hit", "oak", box(0.3, 0.3, 0.3), [0.8, 0.3, 0], density=500),
            body("tips", "clay", box(0.15, 0.5, 0.15), on_slope(5, 0.5, 1.2), rotation=lean, density=500)
        ], [
            promise("x", "==", after[0], "slides", 0.012, 60),
            promise("height", "==", after[1], "slides", 0.006, 60),
            promise("x", "==",
                    on_slope(5, 0.3, -1.2)[0], "stays", 0.005),
            promise("tilt", ">", 60, "tips", at_step=120),
            promise("x", ">", 0.805, "hit")
        ], material_pairs=[{"a": "oak", "b": "sand",
                            "friction": 0.2}, {"a": "clay", "b": "sand", "friction": 0.6},
                           {"a": "crate", "b": "sand", "friction": 0.6}])


def fig1():
    theta = math.radians(30)
    s, c = math.sin(theta), math.cos(theta)
    top = 2.5  # m, where the flat begins
    length = top / s
    middle = [length / 2 * c - 0.5 * s, top / 2 - 0.5 * c, 0]
    mass = 0.6**3 * 400
    return scene(
        "Figure 1 of the paper",
        "A crate stands half on the flat and half over the slope: its center is beyond the edge, so it "
        "follows the slope of 30 degrees, slides down (friction 0.1 < tan 30) and hits another. At the end "
        "both stand on the ground: m g h / 2 each.", 8, [4.2, 3.6, 9], [1.8, 1, 0],
        {"ground": {"friction": 0.1}, "sand": {"friction": 0.1}, "crate": {"friction": 0.1}}, [
            ground(),
            body("flat", "sand", box(1.5, top / 2, 1), [-1.5, top / 2, 0], "static"),
            body("slope", "sand", box(length / 2, 0.5, 1), middle, "static", rotation=turn(Z, -theta)),
            body("crate", "crate", box(0.3, 0.3, 0.3), [0.08, top + 0.3, 0], density=400),
            body("hit", "crate", box(0.3, 0.3, 0.3), [length * c + 0.9, 0.3, 0], density=400)
        ], [
            promise("tilt", "==", 30, "crate", 2, 90),
            promise("x", ">", length * c + 0.95, "hit"),
            promise("kinetic_energy", "<", 0.01),  # friction has stopped both
            weight_energy([(mass, 0.3)] * 2, 0.01)
        ])


def fig7():
    wedge = prism([[-0.8, -0.15], [0.7, -0.25], [0.8, 0.05], [0.2, 0.2], [-0.8, 0.05]], 0.2)
    center = solid_moments(wedge)[1]  # becomes the origin, whose height a promise is about
    wedge["vertices"] = [add(one, scaled(-1, center)) for one in wedge["vertices"]]
    names = ["vertex_sphere", "sphere", "box", "oriented_box", "oriented_box_tree"]
    tilts = [turn(Z, math.radians(20 + 15 * i)) for i in range(5)]
    return scene(
        "Figure 7 of the paper: bounding shapes",
        "Five like wedges turn as they fall from 3 m, without touching. Drawn with the shape that each is named "
        "after: hooke render scenes/paper/fig7.json -o fig7.png --at 0.3 --bounds " + ",".join(names), 0.5,
        [0, 3.2, 9.5], [0, 2.5, 0], {"ground": {}, "steel": {}}, [
            ground(), *(body(name, "steel", {"hull": "wedge"}, [2 * i - 4, 3, 0], density=500, rotation=tilts[i],
                             angular_velocity=[0.5, 1.5, 0.4 * i])
                        for i, name in enumerate(names))
        ], [fall(name, 3, 30) for name in names], meshes={"wedge": wedge})


# ---- Chains of impacts ------------------------------------------------------------------------------------


def leaning(degrees, half_thickness, half_height):
    """Turn and shift of a domino that leans over its lower front edge."""
    lean = turn(Z, -math.radians(degrees))
    return lean, add([half_thickness, 0, 0], rotated(lean, [-half_thickness, half_height, 0]))


def dominoes_100():
    lean, first = leaning(8, 0.05, 0.5)
    places = [first] + [[0.5 * i, 0.5, 0] for i in range(1, 100)]
    return scene(
        "A hundred dominoes",
        "1 m high, 0.1 m thick, 0.5 m apart. The wave runs at about 0.9 sqrt(g H) = 2.8 m/s, whatever the "
        "size (dimensional analysis): the 91st, 45 m on, still stands after 45 m / (1.1 sqrt(g H)) and lies "
        "after 45 m / (0.75 sqrt(g H)).", 22, [6, 4, 10], [12, 0.3, 0],
        {"ground": {"friction": 0.6}, "ivory": {"friction": 0.6}}, [
            ground(),
            body("domino", "ivory", box(0.05, 0.5, 0.25),
                 array={"list": places, "rotations": [lean] + [[0, 0, 0, 1]] * 99})
        ], [
            promise("tilt", "<", 2, "domino[90]", at_step=round(45 / (1.1 * math.sqrt(G)) / DT)),
            promise("tilt", ">", 30, "domino[90]", at_step=round(45 / (0.75 * math.sqrt(G)) / DT)),
            promise("tilt", ">", 50, "domino[99]")
        ])


def domino_spiral():
    half, gap, count = [0.03, 0.25, 0.12], 0.2, 300
    lean, shift = leaning(10, half[0], half[1])
    angle, places, rotations = 3 * math.pi, [], []
    for i in range(count):
        radius = 0.13 * angle  # 0.82 m from turn to turn
        heading = [math.cos(angle) - angle * math.sin(angle), 0, math.sin(angle) + angle * math.cos(angle)]
        yaw = turn(Y, math.atan2(-heading[2], heading[0]))
        center = [radius * math.cos(angle), 0, radius * math.sin(angle)]
        places.append(add(center, rotated(yaw, shift) if i == 0 else [0, half[1], 0]))
        rotations.append(product(yaw, lean) if i == 0 else yaw)
        angle += gap / (0.13 * math.hypot(1, angle))
    way = gap * (count - 1)
    return scene(
        "Spiral of dominoes",
        f"{count} dominoes, 0.5 m high, along a spiral. The wave takes between way / (1.6 sqrt(g H)) and "
        "way / (0.6 sqrt(g H)) for the way of 59.8 m.", round(way / (0.6 * math.sqrt(G * 0.5))),
        [3.6, 4.9, 5.6], [0, 0, 0.25], {"ground": {"friction": 0.6}, "ivory": {"friction": 0.5}},
        [ground(),
         body("domino", "ivory", box(*half), array={"list": places, "rotations": rotations})], [
             promise("tilt", "<", 2, f"domino[{count - 1}]", at_step=round(way /
                                                                           (1.6 * math.sqrt(G / 2)) / DT)),
             # Half of them lie after 14 s; at half gravity, sqrt(2) times as long, not before 19 s.
             promise("tilt", ">", 60, f"domino[{count // 2}]", at_step=950),
             promise("tilt", ">", 30, f"domino[{count - 2}]"),
             promise("tilt", ">", 30, f"domino[{count - 1}]")
         ], fov_deg=42, **low_sun([-0.8, -0.5, -0.2]))


def pool_break():
    r, mass = 0.028575, 0.17
    rack = [[0.635 + row * math.sqrt(3) * 1.002 * r, r, 1.002 * r * (2 * k - row)]
            for row in range(5)
            for k in range(row + 1)]
    tones = {"sand": rack[1::4], "clay": rack[2::4], "moss": rack[3::4], "steel": rack[0::4]}
    balls = [
        body(f"balls_{tone}", tone, {"sphere": {"radius": r}}, mass=mass, array={"list": places})
        for tone, places in tones.items()
    ]
    cushion = 0.02
    return scene(
        "Pool break",
        "The cue ball breaks the rack at 8 m/s. Beside the table a ball starts to slide at 2 m/s: friction "
        "0.2 makes it roll after t = 2 v / (7 mu g) = 0.291 s, then at 5/7 v = 1.4286 m/s (Coriolis 1835).",
        5,
        [-0.1, 0.6, 0.72], [0.5, 0, -0.02], {
            "ground": {"color": [0.05, 0.15, 0.10], "friction": 0.2}, "oak": {"friction": 0.2},
            "ivory": {"roughness": 0.12}, "sand": {"color": [0.75, 0.5, 0.06], "roughness": 0.12},
            "clay": {"color": [0.5, 0.04, 0.03], "roughness": 0.12},
            "moss": {"color": [0.02, 0.14, 0.35], "roughness": 0.12}, "steel": {"roughness": 0.15}
        }, [
            ground(),
            body("long_cushion", "oak", box(1.27 + 2 * cushion, cushion,
                                            cushion), [0, cushion, -0.635 - cushion], "static",
                 array={"grid": [1, 1, 2], "spacing": [1, 1, 1.27 + 2 * cushion]}),
            body("short_cushion", "oak", box(cushion, cushion, 0.635), [-1.27 - cushion, cushion, 0],
                 "static", array={"grid": [2, 1, 1], "spacing": [2.54 + 2 * cushion, 1, 1]}),
            body("cue", "ivory", {"sphere": {"radius": r}}, [-0.635, r, 0.004], mass=mass, velocity=[8, 0, 0],
                 bullet=True),
            body("slider", "ivory", {"sphere": {"radius": r}}, [-1.2, r, 0.85], mass=mass, velocity=[2, 0, 0
                                                                                                    ]), *balls
        ], [
            promise("speed", "==", 10 / 7, "slider", 0.01, 24),
            promise("speed", "==", 10 / 7, "slider", 0.01, 60),
            promise("angular_speed", "==", 10 / 7 / r, "slider", 0.5, 60),
            promise("x", "==", -0.635 + 8 * 6 * DT - 0.2 * G * (6 * DT)**2 / 2, "cue", 0.005, 6),
            promise("kinetic_energy", "<",
                    mass * (64 + 4) / 2, at_step=60)
        ], material_pairs=[{"a": one, "b": other, "friction": 0.06, "restitution": 0.95}
                           for i, one in enumerate(["ivory", *tones])
                           for other in ["ivory", *tones][i:]] +
        [{"a": one, "b": "ground", "friction": 0.2} for one in ["ivory", *tones]] +
        [{"a": one, "b": "oak", "friction": 0.2, "restitution": 0.7} for one in ["ivory", *tones]],
        sky={"brightness": 0.5, "sun": 0.25},
        lights=[spot([0.4, 2.4, 0.3], [0.4, 0, 0.06], [1, 0.9, 0.72], 8, 18, 34)])


def newtons_cradle():
    r = 0.05
    mass = 4 / 3 * math.pi * r**3 * 7800
    gap = 0.02
    places = [[x * (2 * r + gap), r, 0] for x in (-4, -3, 0, 1, 2)]
    return scene(
        "Newton's cradle",
        "Five steel balls on ice, 2 cm apart, restitution 1. Two come with 0.5 m/s and stop; the two at the other end "
        "leave with 0.5 m/s, the one in the middle stays: momentum and energy allow nothing else of equal "
        "balls one by one. Potential energy 5 m g r.", 3, [0.4, 0.7, 1.9], [0.1, 0.02, 0],
        {"ground": {"friction": 0}, "steel": {"friction": 0}}, [
            ground(), *(body(f"ball_{i}", "steel", {"sphere": {"radius": r}}, place, density=7800,
                             **({"velocity": [0.5, 0, 0]} if i < 2 else {}))
                        for i, place in enumerate(places))
        ], [
            *(promise("speed", "==", 0.5 if i > 2 else 0, f"ball_{i}", 0.005) for i in range(5)),
            weight_energy([(mass, r)] * 5, 0.002)
        ], world={"sleeping": False}, material_pairs=[{
            "a": "steel", "b": "steel", "friction": 0, "restitution": 1
        }, {"a": "steel", "b": "ground", "friction": 0}])


def wall_hit():
    brick, rows, columns = [0.15, 0.125, 0.3], 12, 12
    half_rows = rows // 2
    position = [0, brick[1], -brick[2] * (columns - 1)]
    mass = 4 / 3 * math.pi * 0.4**3 * 3000
    return scene(
        "A ball hits a wall",
        "An iron-hearted ball of 804 kg is thrown at 12 m/s. On the way y = y0 + v t - g t^2 / 2; a wall "
        "cannot give it energy: afterwards it is slower.",
        6,
        [-6.5, 3.6, 7.5],
        [0.5, 1.1, 0],
        {
            "ground": {"friction": 0.6}, "clay": {"friction": 0.6}, "sand": {"friction": 0.6},
            "steel": {"friction": 0.4}
        },
        [
            ground(),
            body("even", "clay", box(*brick), position, density=2000,
                 array={"grid": [1, half_rows, columns], "spacing": [1, 4 * brick[1], 2 * brick[2]]}),
            body("odd", "sand", box(*brick), add(position, [0, 2 * brick[1], brick[2]]), density=2000,
                 array={"grid": [1, half_rows, columns - 1], "spacing": [1, 4 * brick[1], 2 * brick[2]]}),
            body("ball", "steel", {"sphere": {"radius": 0.4}}, [-6.5, 1.2, 0], velocity=[12, 2.5, 0],
                 mass=mass)
        ],
        [
            fall("ball", 1.2, 24, speed=2.5),
            promise("x", "==", -6.5 + 12 * 0.4, "ball", 0.01, 24),
            promise("speed", "<", 12, "ball", at_step=60),
            # Far from the hole the wall stands.
            promise("height", "==", brick[1], "even[0]", 0.01)
        ])


# ---- Things that stand ------------------------------------------------------------------------------------


def card_house():
    storeys, lean, friction = 4, math.radians(20), 0.6
    a, b, depth = 0.05, 0.002, 0.035  # half length, half thickness, half depth
    s, c = math.sin(lean), math.cos(lean)
    # A flat card reaches over the upper edges of the leaning ones, 2 b c beside the middle of each pair, and
    # leaves 2 mm to the next flat one.
    apart, high = 2 * a + 0.002, 2 * (a * c + b * s)
    left, right, flat = [], [], []
    for row in range(storeys):
        floor = row * (high + 2 * b)
        for k in range(storeys - row):
            x = (k - (storeys - row - 1) / 2) * apart
            right.append([x + a * s + b * c, floor + high / 2, 0])
            left.append([x - a * s - b * c, floor + high / 2, 0])
            if k > 0:
                flat.append([x - apart / 2, floor + high + b, 0])
    named = {"left": left, "right": right, "flat": flat}
    mass = 8 * a * b * depth * 700
    shape = box(b, a, depth)
    cards = [(f"{name}[{i}]", place) for name, places in named.items() for i, place in enumerate(places)]
    still = [
        promise(quantity, "==", place[axis], of, 0.05 * 2 * a / math.sqrt(3)) for of, place in cards
        for quantity, axis in (("x", 0), ("height", 1), ("z", 2))
    ]
    return scene(
        "House of cards",
        "Four storeys of cards that lean 20 degrees. A pair stands when friction is at least tan(20) / 2 = "
        "0.18, with a load on top up to tan(20) = 0.36; it is 0.6. Every card stays within 5 % of its length "
        "of where it was; the potential energy is the sum of m g y.", 60, [0.24, 0.46, 0.55], [0, 0.16, 0],
        {"ground": {"color": [0.20, 0.12, 0.065], "friction": friction}, "ivory": {"friction": friction}}, [
            ground(),
            body("left", "ivory", shape, density=700, rotation=turn(Z, -lean), array={"list": left}),
            body("right", "ivory", shape, density=700, rotation=turn(Z, lean), array={"list": right}),
            body("flat", "ivory", box(a, b, depth), density=700, array={"list": flat})
        ], [*still, weight_energy([(mass, place[1]) for _, place in cards], 0.01)], world={"sleeping": False})


def arch_25():
    stones, inner, outer, half = 25, 2.0, 2.5, 0.3
    step = 180 / stones
    # The stone's frame is at the middle of the ring, so that the list holds the places of the stones.
    stone = sector(inner, outer, step, half)
    middle = (inner + outer) / 2
    stone["vertices"] = [[x - middle, y, z] for x, y, z in stone["vertices"]]
    turns = [turn(Z, math.radians((i + 0.5) * step)) for i in range(stones)]
    places = [rotated(one, [middle, 0, 0]) for one in turns]
    top = places[stones // 2][1]
    return scene(
        "Arch of 25 stones",
        "A half circle without mortar, thickness / middle radius = 0.22. It stands from 0.1075 on (Heyman "
        "1969), by thrust and friction alone: the keystone stays at 2.25 m.",
        20,
        [2.2, 2.2, 6.5],
        [0, 1.1, 0],
        {"ground": {"friction": 0.7}, "sand": {"friction": 0.7}},
        [
            ground(),
            body("stone", "sand", {"hull": "stone"}, density=2200, array={"list": places, "rotations": turns})
        ],
        [
            promise("height", "==", top, f"stone[{stones // 2}]", 0.05),
            promise("x", "==", 0, f"stone[{stones // 2}]", 0.02),
            weight_energy([(solid_mass(stone, 2200), y) for y in stone_heights(turns, stone, middle)], 0.02)
        ],
        meshes={"stone": stone})


def stone_heights(turns, stone, middle):
    center = add(solid_moments(stone)[1], [middle, 0, 0])
    return [rotated(one, center)[1] for one in turns]


def stack(count, heavy, title, description, seconds, tolerance):
    top_density = 1000 * heavy
    bodies = [
        ground(),
        body("box", "crate", box(0.5, 0.5, 0.5), [0, 0.5, 0],
             array={"grid": [1, count, 1], "spacing": [1, 1, 1]})
    ]
    masses = [(1000, 0.5 + i) for i in range(count)]
    last, high = f"box[{count - 1}]", count - 0.5
    if heavy > 1:
        bodies.append(body("top", "steel", box(0.5, 0.5, 0.5), [0, count + 0.5, 0], density=top_density))
        masses.append((top_density, count + 0.5))
        last, high = "top", count + 0.5
    materials = {"ground": {"friction": 0.6}, "crate": {"friction": 0.6}
                } | ({"steel": {"friction": 0.6}} if heavy > 1 else {})
    far = max(9, 1.5 * count)
    return scene(title, description, seconds, [0.5 * far, 0.5 * count + 1.5, far], [0, 0.48 * count, 0],
                 materials, bodies, [
                     promise("height", "==", high, last, tolerance),
                     promise("x", "==", 0, last, 0.001),
                     promise("z", "==", 0, last, 0.001),
                     promise("tilt", "<", 0.1, last),
                     weight_energy(masses, tolerance / count)
                 ], world={"sleeping": False})


def stack_10():
    return stack(
        10, 1, "Ten boxes", "A stack of ten boxes of 1 t. It stands: the top stays at 9.5 m; its "
        "potential energy is m g (0.5 + 1.5 + ... + 9.5).", 20, 0.02)


def stack_heavy_top():
    return stack(
        10, 100, "Heavy top",
        "Ten boxes of 1 t carry one of 100 t. Overlaps stay below 0.1 mm: the top stays at "
        "10.5 m within 1 mm.", 60, 0.001)


def stack_100():
    return stack(
        100, 1, "A hundred boxes", "A stack of a hundred boxes of 1 t; soft contacts would buckle under it. The "
        "top stays at 99.5 m within 1 cm.", 60, 0.01)


def pyramid_30():
    places = [[1.05 * (k - (29 - i) / 2), 0.5 + i, 0] for i in range(30) for k in range(30 - i)]
    return scene(
        "Pyramid of 465 boxes",
        "30 rows, 5 cm between the boxes of a row. It stands on friction alone: the top stays at 29.5 m; its "
        "potential energy is the sum of m g y.", 5, [14, 13, 38], [0, 11, 0],
        {"ground": {"friction": 0.6}, "crate": {"friction": 0.6}},
        [slab(200, 200), body("box", "crate", box(0.5, 0.5, 0.5), array={"list": places})], [
            promise("height", "==", 29.5, "box[464]", 0.05),
            promise("x", "==", 0, "box[464]", 0.05),
            promise("penetration", "<", 0.02),
            weight_energy([(1000, y) for _, y, _ in places], 0.003)
        ], world={"sleeping": False})


def large_pyramid():
    energy = [(100, i + 0.5) for i in range(100) for _ in range(100 - i)]
    return scene("Large pyramid", "5050 boxes in 100 rows. The top stays at 99.5 m within 0.5 %.", 200 / 60,
                 [60, 55, 165], [0, 46, 0], {"ground": {"friction": 0.6}, "crate": {"friction": 0.6}}, [
                     slab(400, 400),
                     body("box", "crate", box(0.5, 0.5, 0.5), [-49.5, 0.5, 0], density=100,
                          array={"pyramid": 100, "spacing": [1, 1, 1]})
                 ], [promise("height", "==", 99.5, "box[5049]", 0.5),
                     weight_energy(energy, 0.005, 10)], world={"gravity": [0, -10, 0], "sleeping": False})


def many_pyramids():
    pyramids = [
        body(f"pyramid_{i}_{k}", TONES[(i + k) % 4], box(
            0.5, 0.5, 0.5), [-76.5 + 11 * i, 0.5, -76 + 152 / 13 * k], density=100,
             array={"pyramid": 10, "spacing": [1, 1, 1]}) for k in range(14) for i in range(14)
    ]
    energy = [(100, i + 0.5) for i in range(10) for _ in range(10 - i)] * 196
    return scene("Many pyramids", "196 pyramids of 55 boxes each. Each top stays at 9.5 m.", 100 / 60,
                 [60, 45, 120], [0, 0, 10],
                 {"ground": {"friction": 0.6}} | {tone: {"friction": 0.6} for tone in TONES},
                 [slab(77, 77), *pyramids], [
                     promise("height", "==", 9.5, "pyramid_0_0[54]", 0.02),
                     promise("height", "==", 9.5, "pyramid_13_13[54]", 0.02),
                     weight_energy(energy, 0.003, 10)
                 ], world={"gravity": [0, -10, 0], "sleeping": False})


# ---- Piles ------------------------------------------------------------------------------------------------


def by_tone(name, shape, places, **more):
    """Four bodies that share the places, so that neighbors can be told apart."""
    return [
        body(f"{name}_{tone}", tone, shape, array={"list": places[i::4]}, **more)
        for i, tone in enumerate(TONES)
    ]


def tones(friction, *others):
    return {name: {"friction": friction} for name in ("ground", *TONES, *others)}


def bin_walls(inner, half_height):
    """Four walls of glass about a square."""
    return [
        body("wall_x", "glass", box(0.5, half_height, inner + 1), [-inner - 0.5, half_height, 0], "static",
             array={"grid": [2, 1, 1], "spacing": [2 * inner + 1, 1, 1]}),
        body("wall_z", "glass", box(inner, half_height, 0.5), [0, half_height, -inner - 0.5], "static",
             array={"grid": [1, 1, 2], "spacing": [1, 1, 2 * inner + 1]})
    ]


def pile():
    random = Random()
    places = [[
        1.25 * (i - 9.5) + random.jitter(0.1), 1 + 1.25 * k + random.jitter(0.1),
        1.25 * (j - 9.5) + random.jitter(0.1)
    ] for k in range(20) for j in range(20) for i in range(20)]
    return scene(
        "Pile of 8000 boxes",
        "20 x 20 columns of 20 boxes, a little awry, fall. A box of the highest layer falls freely until "
        "those below have come to rest: y0 - g t^2 / 2 after 0.7 s.", 5, [24, 20, 34], [0, 8, 0], tones(0.6),
        [slab(200, 200), *by_tone("box", box(0.5, 0.5, 0.5), places)], [
            fall("box_slate[1999]", places[-1][1], 42),
            promise("height", "<", places[-1][1] - 4, "box_slate[1999]")
        ], world={"sleeping": False})


def mixpile():
    random = Random()
    bodies = []
    for k in range(16):
        for j in range(16):
            for i in range(16):
                half = [round(0.4 + random.jitter(0.1), 3) for _ in range(3)]
                turned = [round(part, 3) for part in random.rotation()]
                bodies.append(
                    body(f"box_{len(bodies)}", TONES[len(bodies) % 4], box(*half),
                         [1.5 * (i - 7.5), 1 + 1.5 * k, 1.5 * (j - 7.5)], rotation=turned))
    return scene(
        "Pile of 4096 different boxes",
        "Boxes of all sizes and attitudes fall into a bin. One of the highest layer falls freely at first: "
        "y0 - g t^2 / 2 after 0.5 s.", 5, [22, 17, 30], [0, 6, 0], tones(
            0.6, "glass"), [slab(200, 200), *bin_walls(12, 13), *bodies], [fall("box_4000", 23.5, 30)],
        world={"sleeping": False})


def spheres():
    random = Random()
    places = []
    for n in range(5000):
        k, j, i = n // 400, n // 20 % 20, n % 20
        places.append(
            [1.1 * (i - 9.5) + random.jitter(0.05), 1 + 1.1 * k, 1.1 * (j - 9.5) + random.jitter(0.05)])
    return scene(
        "5000 balls",
        "Balls fall into a bin. One of the highest layer falls freely at first: y0 - g t^2 / 2 after 0.4 s.",
        5, [22, 14, 28], [0, 5, 0], tones(0.6, "glass"),
        [slab(200, 200), *bin_walls(12, 10), *by_tone("ball", {"sphere": {"radius": 0.5}}, places)], [
            fall("ball_slate[1249]", places[-1][1], 24),
            promise("height", "<", places[-1][1] - 1, "ball_slate[1249]")
        ], world={"sleeping": False})


def convex_pile():
    random = Random()
    points = []
    while len(points) < 32:
        p = [random.jitter(1) for _ in range(3)]
        if 0.01 < dot(p, p) < 1:
            points.append(scaled(2 / math.sqrt(dot(p, p)), p))
    rock, volume = hull_of(points)
    energy = [(1000 * volume, 2 + 4 * k + solid_moments(rock)[1][1]) for k in range(80) for _ in range(64)]
    return scene(
        "Convex pile",
        "64 columns of 80 stones each collapse: 5120 hulls of 32 points, 4 m across. They stay out of each other by all "
        "but a fifth of that, at 45 m/s too. At the start the potential energy is the sum of m g y.", 500 / 60, [120, 90, 230], [0, 110, 0], tones(0.6), [
            slab(250, 250), *(body(f"stone_{tone}", tone, {"hull": "stone"}, [-14 + 4 * i, 2, -14],
                                   array={"grid": [2, 80, 8], "spacing": [16, 4, 4]})
                              for i, tone in enumerate(TONES))
        ], [weight_energy(energy, 0.001, 10) | {"at_step": 0},
            *(promise("penetration", "<", limit, at_step=step) for step, limit in ((240, 0.5), (320, 0.8), (500, 0.8)))
        ], world={"gravity": [0, -10, 0]}, meshes={"stone": rock})


def junkyard():
    rock, _ = hull_of(fibonacci_points(10, 1.5))
    path = [{
        "time": t / 4,
        "offset": [35 * math.cos(math.radians(1.5 * t)) - 35, 0, 35 * math.sin(math.radians(1.5 * t))]
    } for t in range(0, 41)]
    return scene(
        "Junkyard",
        "A pusher goes in circles through 10584 rocks. They start at 25 m and more, and fall freely for 1 s: "
        "g t^2 / 2 = 5 m.", 500 / 60, [75, 70, 95], [0, 12, 0], tones(0.6, "steel", "glass"), [
            slab(120, 120),
            body("wall_x", "glass", box(1, 8, 50), [-50, 7, 0], "static",
                 array={"grid": [2, 1, 1], "spacing": [100, 1, 1]}),
            body("wall_z", "glass", box(50, 8, 1), [0, 7, -50], "static",
                 array={"grid": [1, 1, 2], "spacing": [1, 1, 100]}),
            body("pusher", "steel", {"cylinder": {"radius": 4, "half_height": 12}}, [35, 12, 0], "kinematic",
                 motion={"keyframes": path}),
            *(body(f"rock_{tone}", tone, {"hull": "rock"}, [-40, 25 + 4 * i, -40],
                   array={"grid": [21, 6, 21], "spacing": [4, 16, 4]}) for i, tone in enumerate(TONES))
        ], [
            fall("rock_sand[0]", 25, 60, 10),
            fall("rock_slate[2645]", 117, 60, 10),
            promise("x", "==", 35 * math.cos(math.radians(30)), "pusher", 0.05, 300)
        ], world={"gravity": [0, -10, 0]}, meshes={"rock": rock})


def washer():
    parts = [{"shape": {"hull": "wall"}, "rotation": turn(Z, math.radians(10 * i))} for i in range(36)]
    parts += [{"shape": {"hull": "fin"}, "rotation": turn(Z, math.radians(90 * i))} for i in range(4)]
    return scene(
        "Washer",
        "8000 cubes in a drum with four fins that turns at 25 degrees a second. The cubes fall freely at "
        "first: y0 - g t^2 / 2 after 0.75 s; the drum has turned by 60 degrees after 2.4 s.",
        1000 / 60, [0, 26, 62],
        [0, 20, 0], tones(0.6, "steel"), [
            slab(60, 60),
            body("drum", "steel", {"parts": parts}, [0, 21, 0], "kinematic",
                 angular_velocity=[0, 0, math.radians(25)], motion={"velocity": [0.001, -0.002, 0]}),
            *(body(f"cube_{tone}", tone, box(0.2, 0.2, 0.2), [-7.6, 13.4 + 0.8 * i, -7.6],
                   array={"grid": [20, 5, 20], "spacing": [0.8, 3.2, 0.8]}) for i, tone in enumerate(TONES))
        ], [fall("cube_sand[0]", 13.4, 45, 10),
            promise("tilt", "==", 60, "drum", 0.1, 144),
            *(promise("penetration", "<", 0.4, at_step=step) for step in (350, 1000))], world={"gravity": [0, -10, 0]}, meshes={
                "wall": sector(16, 18, 12, 10), "fin": sector(14, 16.2, 12, 10)
            })


def tumbler():
    walls = [{"shape": box(0.1, 1.7, 1.5), "position": [side * 1.6, 0, 0]} for side in (-1, 1)]
    walls += [{"shape": box(1.5, 0.1, 1.5), "position": [0, side * 1.6, 0]} for side in (-1, 1)]
    walls += [
        {"shape": box(1.7, 1.7, 0.1), "position": [0, 0, side * 1.6], "material": "glass"} for side in (-1, 1)
    ]
    return scene(
        "Tumbler",
        "512 cubes in a closed box that turns by 0.5 rad a second: after 2 s it leans by 57.3 degrees. The "
        "cubes fall freely at first: y0 - g t^2 / 2 after 0.3 s. None gets out.",
        12, [1.6, 3.2, 6.5], [0, 2.3, 0],
        tones(0.5, "steel", "glass"), [
            ground(),
            body("box", "steel", {"parts": walls}, [0, 2.5, 0], "kinematic", angular_velocity=[0, 0, 0.5]),
            *(body(f"cube_{tone}", tone, box(0.1, 0.1, 0.1), [-0.875, 1.625 + 0.25 * i, -0.875],
                   array={"grid": [8, 2, 8], "spacing": [0.25, 1, 0.25]}) for i, tone in enumerate(TONES))
        ], [
            fall("cube_slate[127]", 3.375, 18),
            promise("tilt", "==", math.degrees(1), "box", 0.1, 120),
            *(promise("height", ">", 2.5 - 1.5 * math.sqrt(2), f"cube_{tone}[0]") for tone in TONES)
        ])


def hulls_on_mesh():
    kinds = [("box", "sand", box(0.4, 0.3, 0.5)), ("prism", "clay", {"hull": "prism"}),
             ("twelve", "moss", {"hull": "twelve"}), ("many", "slate", {"hull": "many"})]
    places = [[] for _ in kinds]
    for k in range(10):
        for j in range(10):
            for i in range(10):
                places[(i + j + k) % 4].append([1.5 * (i - 4.5), 3 + 1.3 * k, 1.5 * (j - 4.5)])
    hexagon = [[0.4 * math.cos(math.pi / 3 * k), 0.4 * math.sin(math.pi / 3 * k)] for k in range(6)]
    last = len(places[3]) - 1
    return scene(
        "Hulls on hills",
        "1000 hulls of four kinds fall on a mesh of 20000 triangles. One of the highest layer falls "
        "freely at first: y0 - g t^2 / 2 after 0.4 s. In the end none falls: one alone would have tens of "
        "kilojoules.", 5, [15, 12, 20], [0, 3, 0], tones(0.6), [
            body("hills", "ground", {"mesh": "hills"}, kind="static"),
            *(body(name, tone, shape, array={"list": where})
              for (name, tone, shape), where in zip(kinds, places))
        ], [fall(f"many[{last}]", places[3][last][1], 24),
            promise("height", ">", -1, f"many[{last}]"),
            promise("kinetic_energy", "<", 2e4),
            promise("penetration", "<", 0.05)], world={"sleeping": False}, meshes={
                "hills": {"file": "models/hills.glb"}, "prism": prism(hexagon, 0.45), "twelve": hull_of(
                    fibonacci_points(12, 0.5))[0], "many": hull_of(fibonacci_points(24, 0.5))[0]
            })


def hills():
    """A height field as .glb: 100 x 100 cells of 0.5 m, with a rim that rises beyond 20 m."""
    positions, indices = [], []
    for j in range(101):
        for i in range(101):
            x, z = 0.5 * (i - 50), 0.5 * (j - 50)
            rim = max(0, max(abs(x), abs(z)) - 20)
            y = 0.6 * math.sin(0.7 * x) * math.cos(0.6 * z) + 0.15 * math.sin(2.3 * x + 1.1 * z) + rim
            positions.append([x, round(y, 5), z])
    for j in range(100):
        for i in range(100):
            a, b, c, d = 101 * j + i, 101 * j + i + 1, 101 * (j + 1) + i, 101 * (j + 1) + i + 1
            indices += [a, c, b, b, c, d]
    data = b"".join(struct.pack("<3f", *p) for p in positions)
    split = len(data)
    data += struct.pack(f"<{len(indices)}H", *indices)
    heights = [p[1] for p in positions]
    header = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
            "min": [-25, min(heights), -25], "max": [25, max(heights), 25]
        }, {"bufferView": 1, "componentType": 5123, "count": len(indices),
            "type": "SCALAR"}], "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": split}, {
                "buffer": 0, "byteOffset": split, "byteLength": len(data) - split
            }], "buffers": [{"byteLength": len(data)}]
    }).encode()
    header += b" " * (-len(header) % 4)
    data += b"\0" * (-len(data) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(header) + len(data)) +
            struct.pack("<I4s", len(header), b"JSON") + header + struct.pack("<I4s", len(data), b"BIN\0") +
            data)


def bsp_walk():
    # models/rooms.glb: three rooms of 4 m with walls of 0.2 m and doors in line, z from 1.7 to 2.7.
    ball, speed, first = {"sphere": {"radius": 0.3}}, 4, 1
    inner, far = 0.2 + 0.3, 12.6 - 0.3
    lap, way = 4 - 0.6, 5 * 100 * DT + 2 - inner  # of the bouncer, from the wall
    return scene(
        "A walk through a building",
        "Three rooms in a row, cut out of a block by hooke convert --subtract, which merges BSP trees. A ball goes "
        "straight through both doors, x = x0 + v t, and stays at the far wall; one bounces between the walls of the "
        "first room; a bullet of 200 m/s stops at a wall of 0.2 m; a box slides v^2 / (2 mu g). Points meet the BSP "
        "tree itself: one falls on the floor, one begins in a wall and comes out of it.", 4,
        [6.4, 13, 7.5], [6.4, 0, 2], {
            "sand": {"friction": 0.3}, "ivory": {"friction": 0}, "clay": {"friction": 0},
            "moss": {"friction": 0.3}, "steel": {"friction": 0}
        }, [
            body("rooms", "sand", {"mesh": "rooms"}, kind="static"),
            body("walker", "ivory", ball, [first, 0.5, 2.2], velocity=[speed, 0, 0], bullet=True),
            body("bouncer", "clay", ball, [2, 0.5, 1], velocity=[5, 0, 0], bullet=True),
            body("bullet", "steel", {"sphere": {"radius": 0.05}}, [9, 1.2, 1], velocity=[200, 0, 0],
                 bullet=True),
            body("slider", "moss", box(0.2, 0.1, 0.2), [9.2, 0.3, 3.5], velocity=[3, 0, 0]),
            body("stone", "moss", box(0.2, 0.2, 0.2), [6.4, 2.2, 3.5])
        ], [
            *(promise("x", "==", first + speed * t, "walker", 0.01, round(t / DT)) for t in (0.5, 1, 2)),
            promise("x", "==", far, "walker", 0.01),
            # It loses up to a step's way where it turns.
            promise("x", "==", inner + abs((way + lap) % (2 * lap) - lap), "bouncer", 5 * DT, 100),
            promise("x", "==", 12.55, "bullet", 0.02, 10),
            promise("x", "==", 9.2 + 9 / (2 * 0.3 * G), "slider", 0.03),
            fall("stone", 2.2, 24),
            at_point("height", "==", 2 - G * (24 * DT)**2 / 2, "seeds", 0, 0.008, 24),
            at_point("height", "==", 0.25, "seeds", 0, 0.001),
            # 0.06 m deep in a wall of 0.2 m: out the near side, and down.
            at_point("x", "==", 8.4 - 0.05, "seeds", 1, 0.001, 24),
            at_point("height", "==", 0.25, "seeds", 1, 0.001),
            promise("penetration", "<", 0.02)
        ], world={"sleeping": False}, meshes={"rooms": {"file": "models/rooms.glb", "tree": "planes"}}, particles=[{
            "name": "seeds", "material": "moss",
            "particles": [{"position": [2, 2, 3.2], "radius": 0.05}, {"position": [8.46, 1.5, 3.2], "radius": 0.05}]
        }], material_pairs=[
            {"a": "clay", "b": "sand", "friction": 0, "restitution": 1},
            *({"a": one, "b": "sand", "friction": 0} for one in ("ivory", "steel"))
        ])


# ---- Spin -------------------------------------------------------------------------------------------------


def gyroscope():
    r, height, density, theta, spin = 0.2, 0.15, 2000, math.radians(15), 50.0
    mass = density * math.pi * r * r * height / 3
    axial = 0.3 * mass * r * r
    across = 0.6 * mass * (height**2 + r * r / 4)  # about the tip
    center = 0.75 * height
    # Regular precession: across W^2 cos(theta) - axial spin W + m g l = 0, the slow root.
    a, b, c = across * math.cos(theta), -axial * spin, mass * G * center
    rate = 2 * c / (-b + math.sqrt(b * b - 4 * a * c))
    axis = [math.sin(theta), math.cos(theta), 0]
    omega = add([0, rate, 0], scaled(spin - rate * math.cos(theta), axis))
    step = 60

    def middle(angle):  # of the axis: the origin of the cone's frame
        return scaled(height / 2, [axis[0] * math.cos(angle), axis[1], -axis[0] * math.sin(angle)])

    after = middle(rate * step * DT)
    return scene(
        "Gyroscope",
        "A cone spins on its tip at 50 rad/s, 15 degrees aslant, and does not fall: it precesses at W with "
        "I1 W^2 cos(theta) - I3 spin W + m g l = 0 (Goldstein, section 5.7), I1 about the tip.", 6,
        [0.35, 0.3, 0.55], [0, 0.08, 0], {"ground": {"friction": 2}, "clay": {"friction": 2}}, [
            ground(),
            body("top", "clay", {"cone": {"radius": r, "half_height": height / 2}}, middle(0), rotation=turn(
                Z, math.pi - theta), velocity=cross(omega, scaled(center, axis)), angular_velocity=omega,
                 density=density, can_sleep=False)
        ], [
            promise("x", "==", after[0], "top", 0.001, step),
            promise("z", "==", after[2], "top", 0.001, step),
            promise("height", "==", after[1], "top", 2e-4, 5 * step)
        ], world={"substeps": 32})


def tippy_handle():
    # A bar along z and a stem along y, which is the axis of the middle moment.
    bar, stem, r, density = 0.2, 0.12, 0.03, 2000  # half lengths, radius
    mass_bar, mass_stem = (density * math.pi * r * r * 2 * h for h in (bar, stem))
    offset = stem + r  # of the stem's middle from the bar's
    center = mass_stem * offset / (mass_bar + mass_stem)
    apart = mass_bar * center**2 + mass_stem * (offset - center)**2

    def across(m, h):
        return m * (r * r / 4 + h * h / 3)

    moments = [
        across(mass_bar, bar) + across(mass_stem, stem) + apart,
        across(mass_bar, bar) + mass_stem * r * r / 2,
        mass_bar * r * r / 2 + across(mass_stem, stem) + apart
    ]
    height, omega = 1.0, [0.02, 8.0, 0.0]
    tilts = tilts_of([0, 0, 0, 1], moments, omega)
    half = next(step for step, tilt in enumerate(tilts) if tilt > 90)
    over = max(range(2 * half), key=lambda step: tilts[step])
    return scene(
        "Tippy handle",
        "A T that floats and spins about the axis of its middle moment of inertia turns over again and again "
        "(Dzhanibekov; Poinsot 1851): Euler's equations, integrated to 1e-9, give the angle. A ball beside "
        "it falls: y0 - g t^2 / 2.",
        12, [0.9, 1.5, 1.9], [0.1, 1, 0], {"ground": {}, "steel": {}, "clay": {}}, [
            ground(),
            body(
                "handle", "steel", {
                    "parts": [{
                        "shape": {"cylinder": {"radius": r, "half_height": bar}}, "position": [0, -center, 0],
                        "rotation": turn(X, math.pi / 2), "density": density
                    }, {
                        "shape": {"cylinder": {"radius": r, "half_height": stem}}, "position":
                            [0, offset - center, 0], "density": density
                    }]
                }, [0, height, 0], angular_velocity=omega, gravity_scale=0, can_sleep=False),
            body("ball", "clay", {"sphere": {"radius": 0.05}}, [0.5, height, 0])
        ], [
            fall("ball", height, 24),
            promise("angular_speed", "==", 8, "handle", 0.05, 10),
            *(promise("tilt", "==", tilts[step], "handle", 8, step) for step in (10, half, over))
        ])


def tilts_of(rotation, moments, omega):
    """Angle of the frame's y axis to the vertical after each step [deg], by Euler's equations and RK4."""

    def rates(state):
        q, w = state[:4], state[4:]
        spin = [(moments[(k + 1) % 3] - moments[(k + 2) % 3]) / moments[k] * w[(k + 1) % 3] * w[(k + 2) % 3]
                for k in range(3)]
        return scaled(0.5, product(q, [*w, 0])) + spin

    state, parts, tilts = [*rotation, *omega], 64, []
    h = DT / parts
    for step in range(721):
        up = rotated(state[:4], Y)
        tilts.append(math.degrees(math.atan2(math.hypot(up[0], up[2]), up[1])))
        for _ in range(parts):
            a = rates(state)
            b = rates(add(state, scaled(h / 2, a)))
            c = rates(add(state, scaled(h / 2, b)))
            d = rates(add(state, scaled(h, c)))
            state = [s + h / 6 * (p + 2 * q + 2 * r + t) for s, p, q, r, t in zip(state, a, b, c, d)]
    return tilts


SCENES = [
    slope_crate, fig1, dominoes_100, domino_spiral, pool_break, newtons_cradle, wall_hit, card_house, arch_25,
    stack_10, stack_heavy_top, stack_100, pyramid_30, large_pyramid, many_pyramids, pile, mixpile, spheres,
    convex_pile, junkyard, washer, tumbler, hulls_on_mesh, gyroscope, tippy_handle, *HOOK_SCENES,
    *ROPE_SCENES, *SOLID_SCENES, *FIELD_SCENES, *CLOTH_SCENES, *SOFT_CONTACT_SCENES, *STRUCTURE_SCENES,
    *BREAKING_SCENES
]
PAPER = [fig5, fig6, fig7, wall, rollback_room, gears, torus_on_peg, chain_of_links,
         bsp_walk]  # in the folder paper


def main():
    check = "--check" in sys.argv[1:]
    names = [name for name in sys.argv[1:] if name != "--check"]
    wanted = [one for one in SCENES if not names or one.__name__ in names]
    files = {FOLDER / f"{one.__name__}.json": text_of(one()).encode() for one in wanted}
    for one in PAPER:
        if not names or one.__name__ in names:
            made = one() | {"$schema": "../schema.json"}
            files[FOLDER / "paper" / f"{one.__name__}.json"] = text_of(made).encode()
    if not names or "hulls_on_mesh" in names:
        files[FOLDER / "models" / "hills.glb"] = hills()
    for path, content in files.items():
        if not check:
            path.write_bytes(content)
        elif not path.exists() or path.read_bytes() != content:
            sys.exit(f"{path}: not what make_scenes.py writes; run it without --check")


if __name__ == "__main__":
    main()
