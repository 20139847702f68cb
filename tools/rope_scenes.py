"""Scenes of ropes with what they are tied to; make_scenes.py writes them."""
import math

from scene_kit import DT, G, HAIR, X, Z, add, at_point, body, box, fall, ground, low_sun, promise, scaled, scene, turn


def line(a, b, segments):
    return [add(a, scaled(i / segments, add(b, scaled(-1, a)))) for i in range(segments + 1)]


def rope(name, material, points, mass, radius=0.01, **more):
    return {"name": name, "material": material, "points": points, "total_mass": mass, "radius": radius} | more


def tie(name, a, b, a_point=None, b_point=None, kind="ball", **more):
    """Holds a point of b to a, a body or a point of another object, or to the world."""
    made = {"name": name, "kind": kind} | ({"a": a} if a else {})
    made |= {"a_point": a_point} if a_point is not None else {}
    made |= {"b": b} | ({"b_point": b_point} if b_point is not None else {})
    return made | more


def tension(value, of, segment, tolerance):
    return at_point("tension", "within", value, of, segment, tolerance)



def crane():
    length, segments, load, own = 5.0, 50, 1000.0, 1.0
    top = [2.0, 8.0, 0.0]
    end = add(top, [0, -length, 0])
    half = 0.5
    return scene(
        "Crane",
        "A ton hangs on a kilogram of rope that does not stretch, of 50 segments. Statics: the rope carries "
        "(M + m) g at its top and M g at its hook.",
        20, [7, 5.5, 9], [0.8, 4.2, 0], {"ground": {}, "steel": {}, "clay": {}, "slate": {}}, [
            ground(),
            body("mast", "slate", box(0.2, 4.4, 0.2), [-1.5, 4.4, 0], "static"),
            body("jib", "slate", box(2.2, 0.15, 0.15), [0.3, 8.3, 0], "static"),
            body("back", "slate", box(0.5, 0.5, 0.4), [-2.4, 8.3, 0], "static"),
            body("load", "clay", box(half, half, half), add(end, [0, -half, 0]), mass=load),
        ], [
            tension((load + own * (1 - 0.5 / segments)) * G, "rope", 0, 0.001),
            promise("force", "within", load * G, "hook", 0.001),
            promise("largest_stretch", "<", 0.001),
            promise("height", "==", end[1] - half, "load", 0.002),
            promise("gap", "<", 0.0005)
        ],
        ropes=[rope("rope", "steel", line(top, end, segments), own, 0.02)],
        hooks=[tie("hook", "load.top", "rope.end")])


def hanging_table():
    board, bowl, own, segments = 40.0, 10.0, 1.0, 20
    top, half = 3.0, [0.7, 0.03, 0.5]
    height = 1.2
    ropes, hooks, eyes = [], [], {}
    drop = top - height - half[1]
    splay = 0.15
    for sx in (-1, 1):
        for sz in (-1, 1):
            name = f"rope_{'l' if sx < 0 else 'r'}{'b' if sz < 0 else 'f'}"
            corner = [sx * half[0] * 0.9, height + half[1], sz * half[2] * 0.9]
            ropes.append(
                rope(name, "hemp", line(add(corner, [sx * splay, drop, 0]), corner, segments), own, 0.012,
                     axial_stiffness=1e6))
            eye = name[5:]
            eyes[eye] = [corner[0], half[1], corner[2]]
            hooks.append(tie("hook_" + eye, "board." + eye, name + ".end"))
    share = (board + bowl) * G / 4 * math.hypot(1, splay / drop)
    return scene(
        "Hanging table",
        "A board on four ropes with a bowl's weight in its middle. Each hook carries a quarter of both, and "
        "what the slope of its rope adds.",
        10, [2.6, 2.3, 3.2], [0, 1.5, 0], {"ground": {}, "oak": {}, "hemp": {}, "rose": {}, "slate": {}}, [
            ground(),
            body("beam_back", "slate", box(1.1, 0.06, 0.06), [0, top + 0.06, -half[2] * 0.9], "static"),
            body("beam_front", "slate", box(1.1, 0.06, 0.06), [0, top + 0.06, half[2] * 0.9], "static"),
            body("board", "oak", box(*half), [0, height, 0], mass=board, connection_points=eyes),
            body("weight", "rose", {"cylinder": {"radius": 0.18, "half_height": 0.08}},
                 [0, height + half[1] + 0.08, 0], mass=bowl),
        ], [
            *(promise("force", "within", share, one["name"], 0.005) for one in hooks),
            promise("height", "==", height, "board", 0.003),
            promise("tilt", "<", 0.1, "board"),
            promise("largest_stretch", "<", 0.001)
        ],
        ropes=ropes,
        hooks=hooks)


def suspension_bridge():
    """Hangers at equal distances with equal loads: the main cable is a funicular polygon, y = 4 f x^2 / L^2."""
    planks, gap, sag, deck, shortest = 17, 0.6, 1.6, 1.0, 0.35
    plank = 30.0
    span = (planks + 1) * gap
    half = [0.27, 0.04, 0.8]

    def cable_height(x):
        return deck + shortest + sag * (2 * x / span)**2

    xs = [(k - (planks - 1) / 2) * gap for k in range(planks)]
    bodies = [ground()]
    ropes, hooks = [], []
    for side, z in (("l", -half[2]), ("r", half[2])):
        points = [[x, cable_height(x), z] for x in (-span / 2, *xs, span / 2)]
        ropes.append(rope(f"cable_{side}", "cable", points, 4.0, 0.03, pins=[0, "last"]))
        bodies += [
            body(f"tower_{side}{n}", "slate", box(0.12, cable_height(span / 2) / 2, 0.12),
                 [s * (span / 2 + 0.12), cable_height(span / 2) / 2, z], "static")
            for n, s in enumerate((-1, 1))
        ]
        for k, x in enumerate(xs):
            low = [x, deck + half[1], z]
            ropes.append(rope(f"hanger_{side}{k}", "cable", [[x, cable_height(x), z], low], 0.2, 0.015, pins=[]))
            hooks.append(tie(f"top_{side}{k}", f"cable_{side}", f"hanger_{side}{k}", k + 1, 0))
            hooks.append(tie(f"foot_{side}{k}", f"plank_{k}", f"hanger_{side}{k}", b_point=1))
    bodies += [body(f"plank_{k}", "oak", box(*half), [x, deck, 0], mass=plank) for k, x in enumerate(xs)]
    bodies += [
        body(f"shore_{n}", "moss", box(1.0, deck / 2, 1.2), [s * (span / 2 - gap / 2 - 0.03 + 1.0), deck / 2, 0],
             "static", collides=False) for n, s in enumerate((-1, 1))
    ]
    # Of each side a node carries half a plank, its hanger and its share of the cable.
    node = plank / 2 + 0.2 + 4.0 / (planks + 1)
    rise = cable_height(gap) - cable_height(0)
    pull = node * G * 0.5 * gap / rise  # half the load of the middle node at the slope beside it
    return scene(
        "Suspension bridge",
        "Seventeen planks on hangers, the hangers on two cables: bodies, ropes on ropes, everything tied. The "
        "cables hang in the polygon of their loads, so that statics gives the pull in the middle: half of what "
        "the middle hanger carries, over the slope beside it.",
        10, [4.4, 5.2, 8.4], [0, 0.95, 0],
        {"ground": {}, "oak": {}, "cable": {}, "slate": {}, "moss": {}}, bodies, [
            tension(pull * math.hypot(1, rise / gap), "cable_l", planks // 2 + 1, 0.02),
            tension(pull * math.hypot(1, rise / gap), "cable_r", planks // 2 + 1, 0.02),
            promise("force", "within", plank / 2 * G, f"foot_l{planks // 2}", 0.02),
            promise("height", "==", deck, f"plank_{planks // 2}", 0.03),
            promise("largest_stretch", "<", 0.001),
            promise("tilt", "<", 1, f"plank_{planks // 2}")
        ],
        ropes=ropes,
        hooks=hooks)


def necklace():
    """Beads on a string slide to its middle."""
    span, length, segments, beads, r, mass = 1.0, 1.6, 80, 9, 0.03, 0.05
    top = 1.6
    # Two straight halves at first.
    low = [0, top - math.sqrt(length**2 - span**2) / 2, 0]
    left, right = [-span / 2, top, 0], [span / 2, top, 0]
    points = line(left, low, segments // 2) + line(low, right, segments // 2)[1:]
    bodies, hooks = [ground()], []
    for k in range(beads):
        share = (k + 1) / (beads + 1)
        at = points[round(share * segments)]
        bodies.append(body(f"bead_{k}", "rose" if k % 2 else "ivory", {"sphere": {"radius": r}}, at, mass=mass))
        hooks.append({"name": f"thread_{k}", "kind": "rope_slide", "a": "string", "b": f"bead_{k}", "anchor": at})
    bodies += [
        body(f"post_{n}", "slate", {"cylinder": {"radius": 0.02, "half_height": top / 2}},
             [s * (span / 2 + 0.02), top / 2, 0], "static") for n, s in enumerate((-1, 1))
    ]
    bodies.append(body("ball", "clay", {"sphere": {"radius": 0.04}}, [0.9, 1.5, 0]))
    return scene(
        "Necklace",
        "Nine beads on a string, spread along it, slide to its lowest place and lie there side by side. Nothing "
        "holds them but the string. The ball beside them falls: y0 - g t^2 / 2.",
        12, [0.9, 1.5, 2.2], [0.1, 0.95, 0], {"ground": {}, "rose": {}, "ivory": {}, "slate": {}, "hemp": {}, "clay": {}},
        bodies, [
            fall("ball", 1.5, 20),
            promise("x", "==", 0, "bead_4", 0.08),
            promise("height", "<", low[1] + 2.5 * r, "bead_4"),
            promise("height", ">", low[1] - 2.0 * r, "bead_4"),
            promise("gap", "<", 0.002),
            promise("largest_stretch", "<", 0.001)
        ],
        ropes=[rope("string", "hemp", points, 0.02, 0.004, pins=[0, "last"])],
        hooks=hooks)


def pulley():
    """Atwood's machine: a = (m2 - m1) g / (m1 + m2 + I / r^2), I = M R^2 / 2."""
    m1, m2, wheel, radius, strand = 2.0, 3.0, 4.0, 0.25, 0.005
    r, axle = radius + strand, 2.6
    straight = 1.5
    points = [[-r, axle - straight * (1 - i / 50), 0] for i in range(50)]
    points += [[-r * math.cos(math.pi * i / 26), axle + r * math.sin(math.pi * i / 26), 0] for i in range(27)]
    points += [[r, axle - straight * (i + 1) / 50, 0] for i in range(50)]
    a = (m2 - m1) * G / (m1 + m2 + wheel * (radius / r)**2 / 2)
    step = 40
    way = a * (step * DT)**2 / 2
    half = 0.1
    start = axle - straight - half
    # Nodes that run on to the wheel begin without a force and give way: both weights hang 4 mm lower (0.4 mm at 32
    # substeps), besides 0.2 % of the way.
    error = 0.004 + 0.01 * way
    return scene(
        "Pulley",
        "Atwood's machine with a wheel that has mass: the rope does not slip on it. The heavier weight goes "
        "down with a = (m2 - m1) g / (m1 + m2 + I / r^2), r to the middle of the rope.",
        0.9, [1.6, 2.2, 3.2], [0, 1.6, 0], {"ground": {}, "steel": {}, "rose": {}, "slate": {}, "hemp": {}, "oak": {"friction": 3}}, [
            ground(),
            body("bracket", "slate", box(0.05, 0.5, 0.05), [0, axle + 0.35, -0.2], "static", collides=False),
            body("wheel", "oak", {"cylinder": {"radius": radius, "half_height": 0.06}}, [0, axle, 0],
                 rotation=turn(X, math.pi / 2), mass=wheel),
            body("light", "steel", box(half, half, half), [-r, start, 0], mass=m1),
            body("heavy", "rose", box(half * 1.15, half * 1.15, half * 1.15), [r, start - 0.15 * half, 0], mass=m2),
        ], [
            promise("height", "==", start - 0.15 * half - way, "heavy", error, step),
            promise("height", "==", start + way, "light", error, step),
            promise("angular_speed", "within", a * step * DT / r, "wheel", 0.03, step),
            promise("largest_stretch", "<", 0.005)
        ],
        ropes=[rope("rope", "hemp", points, 0.002, strand, pins=[]) | {"material": "oak"}],
        hooks=[
            {"name": "axle", "kind": "hinge", "b": "wheel", "anchor": [0, axle, 0], "axis": Z},
            tie("left", "light.top", "rope.start"),
            tie("right", "heavy.top", "rope.end")
        ])


def tug_of_war():
    """Both slide: (m1 + m2) a = F2 - F1 - mu (m1 + m2) g; the rope takes F1 + mu m1 g + m1 a."""
    m1, m2, f1, f2, friction = 60.0, 80.0, 150.0, 950.0, 0.4
    half, reach, height = 0.3, 2.0, 0.3
    a = (f2 - f1) / (m1 + m2) - friction * G
    pull = f1 + friction * m1 * G + m1 * a
    step = 60
    return scene(
        "Tug of war",
        "Two crates on a rope are pulled apart, the right one harder: after the jerk both slide to the right "
        "with a = (F2 - F1) / (m1 + m2) - mu g, and the rope carries F1 + mu m1 g + m1 a.",
        1.2, [1.5, 2.2, 5.5], [0.8, 0.2, 0], {"ground": {"friction": friction}, "clay": {"friction": friction}, "slate": {"friction": friction}, "hemp": {}}, [
            ground(),
            body("left", "clay", box(half, half, half), [-reach, half, 0], mass=m1),
            body("right", "slate", box(half, half, half), [reach, half, 0], mass=m2),
        ], [
            tension(pull, "rope", 10, 0.02),
            promise("speed", "within", a * 70 * DT, "right", 0.03, 70),
            promise("x", "==", reach + a * (step * DT)**2 / 2, "right", 0.03, step),
            promise("largest_stretch", "<", 0.001)
        ],
        ropes=[rope("rope", "hemp", line([half - reach, height, 0], [reach - half, height, 0], 20), 0.5, 0.02, pins=[])],
        hooks=[tie("hook_left", "left.right", "rope.start"), tie("hook_right", "right.left", "rope.end")],
        timeline=[{"at_step": 0, "force": {"object": "left", "force": [-f1, 0, 0], "steps": 72}},
                  {"at_step": 0, "force": {"object": "right", "force": [f2, 0, 0], "steps": 72}}])


def rope_bridge():
    """Each plank is tied to both ropes at both of its edges."""
    planks, pitch, width, plank = 14, 0.3, 0.9, 8.0
    half = [0.11, 0.02, width / 2]
    span = planks * pitch
    low, top = 1.2, 1.75
    start = -span / 2

    def height(x):
        return low + (top - low) * (2 * x / span)**2

    hooks, ropes, bodies = [], [], [ground()]
    xs = [start + i * pitch / 2 for i in range(2 * planks + 1)]
    for side, z in (("l", -width / 2), ("r", width / 2)):
        ropes.append(rope(f"rope_{side}", "hemp", [[x, height(x), z] for x in xs], 3.0, 0.02, pins=[0, "last"]))
    for k in range(planks):
        x = start + (k + 0.5) * pitch
        slope = math.atan2(height(x + 0.1) - height(x - 0.1), 0.2)
        bodies.append(body(f"plank_{k}", "oak", box(*half), [x, height(x), 0], rotation=turn(Z, slope), mass=plank))
        for side, z in (("l", -width / 2), ("r", width / 2)):
            for end, s in (("a", -1), ("b", 1)):
                at = [x + s * half[0] * math.cos(slope), height(x) + s * half[0] * math.sin(slope), z]
                hooks.append(tie(f"tie_{side}{k}{end}", f"plank_{k}", f"rope_{side}", anchor=at))
    bodies += [
        body(f"cliff_{n}", "slate", box(0.6, top / 2, 0.8), [s * (span / 2 + 0.6), top / 2, 0], "static")
        for n, s in enumerate((-1, 1))
    ]
    crate = 60.0
    bodies.append(body("crate", "clay", box(0.2, 0.2, 0.2), [0, low + 0.6, 0], mass=crate))
    return scene(
        "Rope bridge",
        "Planks tied to two ropes at both edges, and a crate that drops on them. The ropes carry it at the "
        "banks: each bank half of all the weight.",
        12, [2.2, 3.2, 6.2], [0, 1.1, 0], {"ground": {}, "oak": {}, "hemp": {}, "slate": {}, "clay": {}}, bodies, [
            promise("height", ">", low - 0.25, "crate"),
            promise("largest_stretch", "<", 0.002),
            promise("gap", "<", 0.005),
            promise("speed", "<", 0.2, "crate"),
            promise("height", "==", low + 0.6 - G * (15 * DT)**2 / 2, "crate", 0.01 * G * (15 * DT)**2 / 2, 15)
        ],
        ropes=ropes,
        hooks=hooks)


def posts(places, height, radius=0.03, material="slate"):
    return [
        body(f"post_{n}", material, {"cylinder": {"radius": radius, "half_height": height / 2}},
             [x, height / 2, z], "static", collides=False) for n, (x, z) in enumerate(places)
    ]


def trampoline():
    """A crate comes to rest on cloth that is held at its rim."""
    columns, width, height, mass = 25, 3.0, 0.9, 100.0
    rim = [k for k in range(columns)] + [(columns - 1) * columns + k for k in range(columns)]
    rim += [r * columns + k for r in range(1, columns - 1) for k in (0, columns - 1)]
    half = 0.3
    start = height + half + 0.3
    depth = 0.663  # at 8 x 32 substeps; 0.672 at the 8 x 8 of the scene
    return scene(
        "Trampoline",
        "A crate of 100 kg falls on cloth of half a kilogram per square meter that is held at its rim, bounces and "
        "comes to rest. How deep it lies was found with four times the substeps.",
        20, [2.6, 2.3, 3.6], [0, 0.7, 0], {"ground": {}, "steel": {}, "clay": {}, "slate": {}, "trampoline": {}}, [
            ground(),
            *(body(f"beam_{n}", "steel", box(width / 2 + 0.06 if n < 2 else 0.03, 0.03, 0.03 if n < 2 else width / 2),
                   [(n - 2.5) * 2 * (width / 2 + 0.03) if n > 1 else 0, height, (n - 0.5) * 2 * (width / 2 + 0.03) if n < 2 else 0],
                   "static", collides=False) for n in range(4)),
            *posts([(x, z) for x in (-width / 2 - 0.03, width / 2 + 0.03) for z in (-width / 2 - 0.03, width / 2 + 0.03)], height),
            body("crate", "clay", box(half, half, half), [0, start, 0], mass=mass),
        ], [
            promise("height", "==", height + half - depth, "crate", 0.07 * depth),  # the bed folds in one of two ways
            promise("speed", "<", 0.3, "crate"),
            fall("crate", start, 14),
        ],
        world={"particle_substeps": 8},
        cloths=[{
            "name": "bed", "material": "trampoline", "columns": columns, "rows": columns, "width": width, "height": width,
            "corner": [-width / 2, height, -width / 2], "column_direction": X, "row_direction": Z,
            "areal_density": 0.5, "stretch_stiffness": 4000, "shear_stiffness": 800, "damping": 20,
            "thickness": 0.01, "pins": rim
        }])


def curtain_rings():
    """The rings of a curtain slide on a rod: those at its ends are drawn apart."""
    columns, rows, width, height, top = 33, 25, 2.4, 2.0, 2.4
    spread = 3.4
    every = 4
    return scene(
        "Curtain on rings",
        "Nine rings hold a curtain to a rod and slide along it without friction. The last ring is pushed to the "
        "left, then pulled to the right by 6 N: the curtain closes and opens until its cloth is straight along the rod. A ball falls beside it.",
        8, [0.4, 1.9, 4.6], [0.2, 1.35, 0], {"ground": {}, "steel": {}, "rose": {}, "slate": {}, "clay": {}}, [
            ground(),
            *posts([(-spread / 2, 0), (spread / 2, 0)], top + 0.02, 0.025),
            body("ball", "clay", {"sphere": {"radius": 0.06}}, [1.95, 2, 0]),
        ], [
            fall("ball", 2, 20),
            promise("gap", "<", 0.003),
            at_point("height", "==", top, "curtain", 16, 0.03),
            at_point("x", "==", -spread / 2 + 0.1 + width, "curtain", columns - 1, 0.1),
            promise("lowest", "==", top - height, "curtain", 0.06),
        ],
        world={"particle_substeps": 2},
        ropes=[rope("rod", "steel", line([-spread / 2, top, 0], [spread / 2, top, 0], 68), 1.0, 0.015,
                    pins=list(range(69)))],
        cloths=[{
            "name": "curtain", "material": "rose", "columns": columns, "rows": rows, "width": width, "height": height,
            "corner": [-spread / 2 + 0.1, top, 0], "areal_density": 0.25, "stretch_stiffness": 2e3,
            "shear_stiffness": 300, "bend_stiffness": 2e-4, "air_friction": 0.3, "thickness": 0.006,
            "pins": [0]
        }],
        hooks=[{
            "name": f"ring_{k}", "kind": "rope_slide", "a": "rod", "b": "curtain", "b_point": k * every,
            "anchor": [-spread / 2 + 0.1 + k * every * width / (columns - 1), top, 0]
        } for k in range(1, (columns - 1) // every + 1)],
        timeline=[{"at_step": 0, "force": {"object": "curtain", "point": columns - 1, "force": [-6, 0, 0], "steps": 90}},
                  {"at_step": 150, "force": {"object": "curtain", "point": columns - 1, "force": [6, 0, 0], "steps": 330}}])


def catch_net():
    """A ball is thrown into a net that hangs on four corners, and stays in it."""
    columns, width, mass, radius = 31, 3.0, 5.0, 0.25
    top = 3.0
    speed = 8.0
    start = [0, 1.6, 4.0]
    return scene(
        "Catching net",
        "A ball of 5 kg flies at 8 m/s into a net held at its four corners. The net gives way, takes its speed and "
        "throws it back slower; it never passes through.",
        1.6, [4.5, 2.2, 3.4], [0, 1.5, 0.8], {"ground": {}, "slate": {}, "clay": {}, "felt": {}}, [
            ground(),
            *posts([(-width / 2, 0), (width / 2, 0)], top + 0.05, 0.05),
            body("ball", "clay", {"sphere": {"radius": radius}}, start, mass=mass, velocity=[0, 1.6, -speed]),
        ], [
            promise("z", ">", -1.4, "ball"),
            promise("z", "==", start[2] - speed * 20 * DT, "ball", 0.02, 20),
            promise("height", "==", start[1] + 1.6 * 20 * DT - G * (20 * DT)**2 / 2, "ball", 0.01, 20),
            promise("momentum", "<", mass * speed),
            promise("speed", "<", 0.9 * speed, "ball"),
        ],
        world={"particle_substeps": 4},
        cloths=[{
            "name": "net", "material": "felt", "columns": columns, "rows": columns, "width": width, "height": top - 0.3,
            "corner": [-width / 2, top, 0], "areal_density": 0.3, "stretch_stiffness": 6e3, "shear_stiffness": 1e3,
            "damping": 1, "thickness": 0.02, "pins": [0, columns - 1, columns * (columns - 1), "last"]
        }])


def washing_line():
    """Three towels on a line in the wind, each held by two pegs."""
    span, top, sag = 5.0, 2.0, 0.12
    segments = 60
    wide, high = 0.9, 1.1
    points = [[-span / 2 + span * i / segments, top - sag * (1 - (2 * i / segments - 1)**2), 0] for i in range(segments + 1)]

    def height(x):
        return top - sag * (1 - (2 * x / span)**2)

    cloths, hooks = [], []
    for n, (x, tone) in enumerate(((-1.9, "rose"), (-0.45, "ivory"), (1.0, "felt"))):
        name = f"towel_{n}"
        low = min(height(x), height(x + wide)) - 0.005
        cloths.append({
            "name": name, "material": tone, "columns": 16, "rows": 19, "width": wide, "height": high,
            "corner": [x, low, 0.012], "areal_density": 0.3, "stretch_stiffness": 2e3, "shear_stiffness": 400,
            "bend_stiffness": 1e-3, "damping": 0.2
        })
        hooks += [tie(f"peg_{n}{k}", "line", name, b_point=point, anchor=[x + k * wide, height(x + k * wide), 0])
                  for k, point in ((0, 0), (1, 15))]
    weight = 3 * 0.3 * wide * high
    return scene(
        "Washing line",
        "Towels hang on a line by pegs: points of cloths tied to places along a rope. In the first seconds the air "
        "is still, and the line carries the weight of all three; then the wind comes.",
        10, [1.4, 3.2, 4.2], [0.2, 1.2, 0], {
            "ground": {"color": [0.16, 0.15, 0.10]}, "slate": {}, "hemp": {}, "rose": {"color": [0.45, 0.04, 0.06]}, "ivory": {},
            "felt": {"color": [0.05, 0.16, 0.22]}}, [
            ground(),
            *posts([(-span / 2 - 0.03, 0), (span / 2 + 0.03, 0)], top + 0.05, 0.035),
        ], [
            promise("gap", "<", 0.01),
            promise("largest_stretch", "<", 0.3),
            promise("lowest", "==", height(0.25) - high, "towel_1", 0.15, 180),
            promise("potential_energy", "within", G * (weight * (height(0.3) - high / 2) + 0.3 * (top - sag)), None, 0.06, 180),
        ],
        world={"particle_substeps": 2, "wind": {"velocity": [0, 0, 0]}},
        ropes=[rope("line", "hemp", points, 0.3, 0.006, pins=[0, "last"])],
        cloths=cloths,
        hooks=hooks,
        timeline=[{"at_step": 240, "wind": {"velocity": [1, 0, 2.6], "gust": 0.5}}],
        **low_sun([-0.6, -0.7, -0.5], 0.8), fov_deg=40)


def cantilever_end(load, stiffness, length):
    """Way of the end of a clamped rod down and back under a load, by integrating the elastica."""
    alpha = load * length**2 / stiffness
    low, high = 0.0, math.pi / 2
    for _ in range(60):  # the slope at the end, so that the arc is as long as the rod
        end = (low + high) / 2
        steps = 4000
        # theta'' = -alpha cos(theta), theta(0) = 0, theta'(1) = 0: shoot from the free end.
        theta, rate = end, 0.0
        for _ in range(steps):
            h = 1 / steps
            k1t, k1r = rate, alpha * -math.cos(theta)
            k2t, k2r = rate + h / 2 * k1r, alpha * -math.cos(theta + h / 2 * k1t)
            theta, rate = theta + h * k2t, rate + h * k2r
        low, high = (low, end) if theta > 0 else (end, high)
    down = back = 0.0
    theta, rate = end, 0.0
    for _ in range(steps):
        h = 1 / steps
        middle = theta + h / 2 * rate
        down += h * math.sin(middle)
        back += h * (1 - math.cos(middle))
        k2r = alpha * -math.cos(middle)
        theta, rate = theta + h * (rate + h / 2 * alpha * -math.cos(theta)), rate + h * k2r
    return length * down, length * back


def cable_and_hair():
    """The same strand twice: one resists bending, one does not."""
    length, segments, height, load = 1.2, 32, 1.5, 0.5
    stiffness = 2.0
    pitch = length / segments
    down, _ = cantilever_end(load * G, stiffness, length)
    ropes = []
    for name, z, ei in (("cable", -0.3, stiffness), ("hair", 0.3, 0)):
        points = [[-pitch + i * pitch, height, z] for i in range(segments + 2)]
        more = {"bend_stiffness": ei, "bend_damping": 0.1} if ei else {"air_friction": 0.6}
        ropes.append(
            rope(name, "cable" if ei else "hemp", points, 0.002, 0.012, pins=[0, 1],
                 loads=[{"point": segments + 1, "mass": load}], **more))
    return scene(
        "Cable and hair",
        "Two strands of the same length are clamped at the left and carry half a kilogram at their right ends. The "
        "cable has EI = 2 N m^2 and bends as the elastica says, the hair has none and hangs straight down.",
        12, [0.9, 1.5, 3.0], [0.45, 0.95, 0], {"ground": {}, "slate": {}, "cable": {}, "hemp": {}}, [
            ground(),
            body("wall", "slate", box(0.1, 0.9, 0.6), [-pitch - 0.1, 0.9, 0], "static", collides=False),
        ], [
            at_point("height", "==", height - down, "cable", "last", 0.003),
            at_point("height", "==", height - length, "hair", "last", 0.015),
            at_point("x", "==", 0, "hair", "last", 0.15),
            promise("largest_stretch", "<", 0.001)
        ],
        ropes=ropes)


def hair_wind():
    """Strands that resist bending, clamped on a head that nods; then the wind comes."""
    head, radius, top = 0.12, 0.001, 1.2
    strands, segments, length = 60, 12, 0.30
    pitch = length / segments
    ropes, hooks = [], []
    golden = math.pi * (3 - math.sqrt(5))
    for k in range(strands):
        # Over the upper part of the head, without the face.
        y = 0.25 + 0.72 * (k + 0.5) / strands
        angle = golden * k
        r = math.sqrt(1 - y * y)
        n = [r * math.cos(angle), y, r * math.sin(angle)]
        root = add([0, top, 0], scaled(head, n))
        ropes.append(
            rope(f"hair_{k}", "brown_hair" if k % 3 else "dark_hair", [add(root, scaled((i - 1) * pitch, n)) for i in range(segments + 2)],
                 0.0004, radius, pins=[], bend_stiffness=2e-6, bend_damping=0.02, repulsion_strength=1.5e-7,
                 repulsion_range=0.02))
        hooks += [tie(f"root_{k}{i}", "head", f"hair_{k}", b_point=i) for i in (0, 1)]
    return scene(
        "Hair in the wind",
        "Sixty hairs of 30 cm, rods with EI = 2e-6 N m^2, stand clamped on a head that moves to and fro. They fall, "
        "swing after it and, after four seconds, blow to one side. Nearer than 2 cm they push each other away. A ball "
        "falls beside them.",
        8, [0.3, 1.46, 0.72], [-0.02, 1.1, 0], {"ground": {"color": [0.10, 0.09, 0.085]}, **HAIR, "clay": {}, "slate": {}}, [
            ground(),
            body("head", "skin", {"sphere": {"radius": head}}, [0, top, 0], "kinematic",
                 motion={"sine": {"amplitude": [0.06, 0, 0], "frequency_hz": 0.8}}),
            body("ball", "clay", {"sphere": {"radius": 0.04}}, [0.5, 1.2, 0.3]),
        ], [
            fall("ball", 1.2, 20),
            promise("largest_stretch", "<", 0.01),
            promise("gap", "<", 0.002),
            promise("penetration", "<", 0.002),
            at_point("height", "<", top + 0.02, "hair_10", "last", None, 200),
        ],
        ropes=ropes,
        hooks=hooks,
        timeline=[{"at_step": 240, "wind": {"velocity": [-4, 0, 1.5], "gust": 0.4}}],
        sky={"sun_direction": [-0.75, -0.6, -0.25]}, fov_deg=38)


def twisted_cable():
    """A cable that is turned at one end until it throws a loop, and a disk on a wire."""
    ei, gj, turns_per_second, steps = 0.05, 0.04, 0.5, 250
    height, span, sag, segments = 1.1, 0.5, 0.21, 48
    pitch = span / segments
    cable = [[-span / 2 + span * s, height - sag * (1 - math.cos(2 * math.pi * s)), 0]
             for s in (i / segments for i in range(segments + 1))]
    cable = [[-span / 2 - pitch, height, 0], *cable, [span / 2 + pitch, height, 0]]

    top, wire_length, wire_segments, wire_gj, start = 1.5, 0.8, 16, 0.02, 2.5
    wire_pitch, mass, wire_mass, half = wire_length / wire_segments, 0.5, 0.01, [0.12, 0.02, 0.12]
    wire = line([0.1, top + wire_pitch, -0.6], [0.1, top - wire_length - wire_pitch, -0.6], wire_segments + 2)
    inertia = mass / 3 * (half[0]**2 + half[2]**2)
    omega = math.sqrt(wire_gj / (wire_length * inertia))

    def swing(at_step):
        return start * math.cos(omega * DT * at_step)

    hooks = [tie(f"post_{i}", "post", "cable", b_point=i) for i in (0, 1)]
    hooks += [tie(f"hand_{i}", "hand", "cable", b_point=segments + 1 + i) for i in (0, 1)]
    hooks += [tie(f"beam_{i}", "beam", "wire", b_point=i) for i in (0, 1)]
    hooks += [tie(f"disk_{i}", "disk", "wire", b_point=wire_segments + 1 + i) for i in (0, 1)]
    return scene(
        "Twisted cable",
        "A slack cable with EI = 0.05 and GJ = 0.04 N m^2 is turned at one end, half a turn a second. It bows out of "
        "its plane and throws a loop, which takes a turn of twist away, and passes through itself later. Behind it a disk "
        "on a twisted wire swings with omega = sqrt(GJ / L I).",
        steps * DT, [0.4, 1.1, 1.5], [0.02, 1.0, -0.1], {"ground": {}, "slate": {}, "steel": {}, "cable": {}, "clay": {}, "oak": {}}, [
            ground(),
            body("post", "slate", box(0.04, 0.6, 0.04), [-span / 2 - pitch - 0.04, 0.6, 0], "static", collides=False),
            body("hand", "clay", box(0.04, 0.07, 0.02), [span / 2 + pitch + 0.04, height, 0], "kinematic",
                 collides=False, angular_velocity=[2 * math.pi * turns_per_second, 0, 0]),
            body("beam", "slate", box(0.4, 0.04, 0.04), [0.1, top + 0.04, -0.6], "static", collides=False),
            body("disk", "oak", box(*half), [0.1, top - wire_length - wire_pitch, -0.6], mass=mass, can_sleep=False),
        ], [
            tension((mass + wire_mass * (1 - 8.5 / (wire_segments + 2))) * G, "wire", 8, 0.002),
            *(promise("twist", "==", swing(at_step), "wire", 0.02, at_step) for at_step in (100, 200)),
            promise("torque", "within", wire_gj * swing(steps) / wire_length, "wire", 0.005),
            # Twist is link less writhe, and a loop has about one turn of that.
            promise("twist", "==", 2 * math.pi * (turns_per_second * DT * steps - 1), "cable", 0.2 * 2 * math.pi),
            promise("gap", "<", 0.001),
            promise("largest_stretch", "<", 0.001)
        ],
        ropes=[
            rope("cable", "cable", cable, 0.06, 0.008, pins=[], bend_stiffness=ei, twist_stiffness=gj, bend_damping=0.05,
                 air_friction=0.05),
            rope("wire", "steel", wire, wire_mass, 0.003, pins=[], bend_stiffness=0.02, twist_stiffness=wire_gj,
                 twist=start * (1 + 2 / wire_segments), drag_coefficient=0)
        ],
        hooks=hooks)


def overhand(size, tail, spacing):
    """Points of a loose overhand knot on a line along x, `spacing` apart: a polynomial trefoil with straight ends."""
    end, steps = 2.05, 20000
    place = [[size * (t**3 - 3 * t), size * 0.7 * (t**4 - 4 * t * t), size * 0.55 * (t**5 / 5 - 2 * t)]
             for t in (-end + 2 * end * i / steps for i in range(steps + 1))]
    way = [tail / math.hypot(1, 0.3), 0.3 * tail / math.hypot(1, 0.3), 0]
    fine = line(add(place[0], [-way[0], way[1], 0]), place[0], steps) + place + line(place[-1], add(place[-1], way), steps)
    points = [fine[0]]
    for x in fine:
        step = add(x, scaled(-1, points[-1]))
        if math.hypot(*step) >= spacing:
            points.append(add(points[-1], scaled(spacing / math.hypot(*step), step)))
    return points


def knot():
    """An overhand knot that tightens under a load, and turns about a bar that hold another."""
    radius, mass, load, held, bar_radius, bar_height = 0.012, 0.15, 5.0, 3.0, 0.04, 1.7
    points = overhand(0.048, 0.2, 2 * radius)
    first = points[0]
    knotted = [[0.3 + p[1] - first[1], 2.0 - (p[0] - first[0]), p[2] - first[2]] for p in points]
    bend, turns, spread = bar_radius + 1.01 * radius, 2.5, 2.4 * radius
    wound = [[-0.4 + bend, bar_height - 0.35 * (1 - i / 700), 0] for i in range(700)]
    for i in range(20001):
        angle = 2 * math.pi * turns * i / 20000
        wound.append([-0.4 + bend * math.cos(angle), bar_height + bend * math.sin(angle), spread * turns * i / 20000])
    wound += [add(wound[-1], [0, -0.15 * i / 700, 0]) for i in range(1, 701)]
    turned = [wound[0]]
    for x in wound:
        step = add(x, scaled(-1, turned[-1]))
        if math.hypot(*step) >= 2 * radius:
            turned.append(add(turned[-1], scaled(2 * radius / math.hypot(*step), step)))
    half = 0.09
    calm = {"linear_damping": 2, "angular_damping": 4, "can_sleep": False}
    touching = {"touches_ropes": True, "friction": 0.5, "axial_stiffness": 5e4}
    return scene(
        "A knot, and turns about a bar",
        "Ropes that touch ropes and themselves. Right, a loose overhand knot tightens under 5 kg and stays: the rope "
        "carries (M + m) g at its top. Left, two turns and a half about a bar, which is a thick rope, hold 3 kg by "
        "friction alone: the free end weighs 12 g, and e^(5 pi mu) times that could hang on the other. Without friction it runs out.",
        8, [0.35, 1.55, 2.3], [-0.02, 1.35, 0], {"ground": {}, "slate": {}, "hemp": {}, "oak": {}, "clay": {}, "sand": {}}, [
            ground(),
            body("beam", "slate", box(0.75, 0.05, 0.1), [-0.05, 2.05, 0], "static", collides=False),
            body("load", "clay", box(half, half, half), add(knotted[-1], [0, -half, 0]), mass=load, **calm),
            body("held", "oak", box(half, half, half), add(turned[0], [0, -half, 0]), mass=held, **calm),
        ], [
            tension((load + mass) * G, "knotted", 0, 0.02),
            promise("height", "==", turned[0][1] - half, "held", 0.06),
            promise("height", "==", 0.82, "load", 0.04),  # 0.54 without the knot
            promise("largest_stretch", "<", 0.01),
            promise("kinetic_energy", "<", 0.01)
        ],
        ropes=[
            rope("knotted", "hemp", knotted, mass, radius, pins=[0], air_friction=0.3, **touching),
            rope("bar", "sand", [[-0.4, bar_height, -0.15], [-0.4, bar_height, 0.2]], 1.0, bar_radius, pins=[0, 1],
                 **touching),
            rope("turned", "oak", turned, 0.1, radius, pins=[], air_friction=0.3, **touching)
        ],
        hooks=[tie("hook", "load.top", "knotted.end"), tie("eye", "held.top", "turned.start")])


def rope_snaps():
    top, load, own, strength, half, segments = 3.0, 40.0, 0.2, 900.0, 0.12, 12
    bend = [0.32, 0.62]  # the slack cord hangs out to the side by the first, at the depth of the second
    side = math.hypot(*bend)
    left, right = [-0.6, top, 0], [0.6, top, 0]
    taut = line(left, add(left, [0, -2 * side, 0]), segments)
    out, end = add(right, [bend[0], -bend[1], 0]), add(right, [0, -2 * bend[1], 0])
    slack = line(right, out, segments // 2) + line(out, end, segments // 2)[1:]
    cord = {"axial_stiffness": 4e4, "inner_friction": 400.0, "strength": strength}
    jerk = load * math.sqrt(2 * G * 2 * (side - bend[1]))
    return scene(
        "A rope snaps",
        f"Two like cords that take {strength:.0f} N, with {load:.0f} kg each. The left one gets them without "
        f"slack: up to twice {load * G:.0f} N, and it holds. The weight on the right one falls "
        f"{2 * (side - bend[1]):.2f} m first, and has {jerk:.0f} N s. That cord snaps at one place, and takes no more "
        "from the weight than its strength.",
        3, [0.6, 2.2, 4.6], [0.05, 1.75, 0], {"ground": {}, "slate": {}, "hemp": {}, "clay": {}}, [
            ground(),
            body("beam", "slate", box(1.2, 0.08, 0.1), [0, top + 0.08, 0], "static"),
            body("still", "clay", box(half, half, half), add(taut[-1], [0, -half, 0]), mass=load),
            body("dropped", "clay", box(half, half, half), add(end, [0, -half, 0]), mass=load),
        ], [
            tension((load + own * (1 - 0.5 / segments)) * G, "holds", 0, 0.005),
            promise("broken", "==", 0, "holds"),
            promise("broken", "==", 1, "snaps"),
            promise("broken", "==", 1),
            promise("height", "==", half, "dropped", 0.02),
        ],
        ropes=[rope("holds", "hemp", taut, own, 0.012, **cord), rope("snaps", "hemp", slack, own, 0.012, **cord)],
        hooks=[tie("left", "still.top", "holds.end"), tie("right", "dropped.top", "snaps.end")])


ROPE_SCENES = [
    crane, hanging_table, suspension_bridge, necklace, pulley, tug_of_war, rope_bridge, trampoline, curtain_rings,
    catch_net, washing_line, cable_and_hair, hair_wind,
    twisted_cable, knot, rope_snaps
]
