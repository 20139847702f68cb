"""Scenes of fields: magnets, suction, liquid; make_scenes.py writes them."""
import math

from rope_scenes import line, rope, tie
from scene_kit import (DT, G, Random, X, Y, Z, add, at_point, body, box, dot, ground, hook, promise, scaled, scene, turn)

K = 1e-7  # mu_0 / 4 pi [T m / A]


def flux_density(moment, d):
    r = math.sqrt(dot(d, d))
    n = scaled(1 / r, d)
    return scaled(K / r**3, add(scaled(3 * dot(moment, n), n), scaled(-1, moment)))


def force_along(axis, moment, at, sources):
    """On a dipole, by others: the slope of its energy."""
    step = 1e-5

    def energy(x):
        return -sum(dot(moment, flux_density(m, add(x, scaled(-1, c)))) for c, m in sources)

    return (energy(add(at, scaled(-step, axis))) - energy(add(at, scaled(step, axis)))) / (2 * step)


def magnet():
    """Discs that float above each other, needles along the lines of a bar's field, two blocks that meet."""
    table = 0.5
    # Two blocks on a table.
    block, weight, apart, half, friction = 150.0, 0.8, 0.36, 0.04, 0.05
    glide = [1.1, table + half, 0]
    # Discs on an axis, each against the one below.
    disc, mass, bottom = 250.0, 1.0, [-1.1, table + 0.03, 0]
    # Needles on two rings about the bar.
    bar, bar_at, needle = [500.0, 0, 0], [0, table + 0.04, 0], 0.5
    places = [[bar_at[0] + r * math.cos(a), table + 0.04, r * math.sin(a)]
              for r, count, phase in ((0.3, 8, 0.5), (0.5, 12, 0.0))
              for a in (2 * math.pi * (k + phase) / count for k in range(count))]

    def needle_moment(angle):  # about y, from the x axis
        return [needle * math.cos(angle), 0, -needle * math.sin(angle)]

    heights = [bottom[1] + 0.25, bottom[1] + 0.55]
    angles = [0.0] * len(places)
    for _ in range(60):
        rest = [(bar_at, bar)] + [(p, needle_moment(a)) for p, a in zip(places, angles)]
        rest += [(add(glide, [s * half, 0, 0]), [block, 0, 0]) for s in (-1, 1)]
        floats = [(bottom, [0, disc, 0]), ([bottom[0], heights[0], 0], [0, -disc, 0]),
                  ([bottom[0], heights[1], 0], [0, disc, 0])]
        for k in (0, 1):
            others = rest + floats[:k + 1] + floats[k + 2:]
            low, high = bottom[1] + 0.1, bottom[1] + 1.0
            if k == 0:
                high = heights[1] - 0.05
            else:
                low = heights[0] + 0.05
            for _ in range(50):
                y = (low + high) / 2
                up = force_along(Y, floats[k + 1][1], [bottom[0], y, 0], others)
                low, high = (y, high) if up > mass * G else (low, y)
            heights[k] = y
            floats[k + 1] = ([bottom[0], y, 0], floats[k + 1][1])
        for n, p in enumerate(places):
            sources = rest[:n + 1] + rest[n + 2:] + floats
            b = [0, 0, 0]
            for c, m in sources:
                b = add(b, flux_density(m, add(p, scaled(-1, c))))
            angles[n] = math.atan2(-b[2], b[0])
            rest[n + 1] = (p, needle_moment(angles[n]))
    start = 0.9  # rad: of all needles
    turns = [math.remainder(a - start, 2 * math.pi) for a in angles]
    # The blocks glide together against friction; F = 3 mu_0 m^2 / (2 pi r^4), and the bar's pull.
    xs, vs, substep = [glide[0] - apart / 2, glide[0] + apart / 2], [0.0, 0.0], DT / 64
    for _ in range(15 * 64):
        for k, sign in ((0, 1), (1, -1)):
            others = [(bar_at, bar), ([xs[1 - k], *glide[1:]], [block, 0, 0])]
            force = force_along(X, [block, 0, 0], [xs[k], *glide[1:]], others)
            vs[k] += substep * (force / weight - sign * friction * G)
        xs = [x + substep * v for x, v in zip(xs, vs)]
    bodies = [
        ground(),
        body("table", "oak", box(1.6, 0.04, 0.8), [0, table - 0.04, 0], "static"),
        *(body(f"leg_{n}", "oak", box(0.05, (table - 0.08) / 2, 0.05), [x, (table - 0.08) / 2, z], "static", collides=False)
          for n, (x, z) in enumerate(((-1.5, -0.7), (-1.5, 0.7), (1.5, -0.7), (1.5, 0.7)))),
        body("tube", "glass", {"cylinder": {"radius": 0.115, "half_height": 0.45}}, add(bottom, [0, 0.42, 0]), collides=False,
             kind="static"),
        *(body(f"disc_{k}", tone, {"cylinder": {"radius": 0.1, "half_height": 0.03}}, [bottom[0], y, 0], kind,
               dipole_moment=[0, disc * (-1)**k, 0],
               **({} if kind == "static" else {"mass": mass, "linear_damping": 2}))
          for k, (tone, kind, y) in enumerate((("slate", "static", bottom[1]),
                                               ("rose", "dynamic", bottom[1] + 0.35), ("slate", "dynamic", bottom[1] + 0.6)))),
        body("bar_north", "rose", box(0.06, 0.03, 0.03), add(bar_at, [0.06, -0.01, 0]), "static"),
        body("bar_south", "slate", box(0.06, 0.03, 0.03), add(bar_at, [-0.06, -0.01, 0]), "static"),
        body("bar", "steel", box(0.004, 0.031, 0.031), add(bar_at, [0, -0.01, 0]), "static", dipole_moment=bar),
    ]
    hooks = [hook(f"axis_{k}", "slider", f"disc_{k}", [bottom[0], y, 0], axis=Y)
             for k, y in ((1, bottom[1] + 0.35), (2, bottom[1] + 0.6))]
    for n, p in enumerate(places):
        halves = [0.035, 0.004, 0.011]
        bodies.append({
            "name": f"needle_{n}", "kind": "dynamic", "position": p, "rotation": turn(Y, start), "mass": 0.02,
            "angular_damping": 3, "dipole_moment": [needle, 0, 0],
            "shape": {"parts": [{"shape": box(*halves), "position": [s * halves[0], 0, 0], "material": tone}
                                for s, tone in ((1, "rose"), (-1, "ivory"))]}
        })
        hooks.append(hook(f"pivot_{n}", "hinge", f"needle_{n}", p, axis=Y))
    bodies += [body(f"block_{name}", "steel", box(half, half, half), add(glide, [s * apart / 2, 0, 0]), mass=weight,
                    dipole_moment=[block, 0, 0]) for name, s in (("l", -1), ("r", 1))]
    return scene(
        "Magnets",
        "Left, discs of 250 A m^2 and 1 kg float above each other where their repulsion is their weight. Middle, twenty "
        "compass needles turn into the field of a bar. Right, two blocks pull each other with 3 mu0 m^2 / (2 pi r^4), "
        "glide together against friction and stay.",
        8, [0.5, 1.9, 2.4], [0, 0.62, 0], {"ground": {}, "oak": {}, "rose": {}, "slate": {}, "steel": {}, "ivory": {},
                                            "glass": {}}, bodies, [
            *(promise("height", "==", y, f"disc_{k + 1}", 0.001) for k, y in enumerate(heights)),
            *(promise("angle", "==", turns[n], f"pivot_{n}", 0.02) for n in range(len(places))),
            *(promise("x", "==", x, f"block_{name}", 0.02 * abs(x - glide[0] - s * apart / 2), 15)
              for x, name, s in zip(xs, "lr", (-1, 1))),
            promise("x", "==", glide[0] + half, "block_r", 0.01),
            promise("x", "==", glide[0] - half, "block_l", 0.01),
        ], hooks=hooks, material_pairs=[{"a": "steel", "b": "oak", "friction": friction}])


def suction():
    """A nozzle sucks up what lies below it; what lies too far stays."""
    mouth, strength, reach = [0, 1.5, 0], 26.0, 2.4
    table = 0.7

    def pull(at):
        d = add(mouth, scaled(-1, at))
        r = math.sqrt(dot(d, d))
        return scaled(strength * max(0.0, 1 - r / reach) / r, d)

    def flown(at, steps):
        """Free flight by small steps."""
        x, v, h = list(at), [0, 0, 0], DT / 256
        for _ in range(256 * steps):
            v = add(v, scaled(h, add(pull(x), [0, -G, 0])))
            x = add(x, scaled(h, v))
        return x

    radius = 0.045
    balls = {"light": (0.02, [-0.22, table + radius, 0.05]), "heavy": (2.0, [0.22, table + radius, 0.05])}
    # A ball on a string beside it: across the string suction is as strong as weight.
    peg, length = [1.25, 2.0, 0], 0.7

    def bob(angle):
        return add(peg, [-length * math.sin(angle), -length * math.cos(angle), 0])

    low, high = 0.0, 1.2
    for _ in range(60):
        angle = (low + high) / 2
        force = add(pull(bob(angle)), [0, -G, 0])
        # Towards the nozzle along the string's circle; the string keeps its plane by a pull of its own.
        low, high = (angle, high) if force[0] * -math.cos(angle) + force[1] * math.sin(angle) > 0 else (low, angle)
    # A ribbon held on the table: each part points the way in which all that is beyond it is pulled.
    ribbon, parts = 0.6, 24
    chain = line([-0.68, table, 0], [-0.68, table + ribbon, 0], parts)
    for _ in range(300):
        beyond = [add(pull(x), [0, -G, 0]) for x in chain]
        beyond[-1] = scaled(0.5, beyond[-1])
        for k in range(parts - 1, 0, -1):
            beyond[k] = add(beyond[k], beyond[k + 1])
        for k in range(parts):
            force = beyond[k + 1]
            chain[k + 1] = add(chain[k], scaled(ribbon / parts / math.sqrt(dot(force, force)), force))
    random = Random(7)
    leaves = [[random.jitter(0.5), table + 0.02 + 0.012 * n, random.jitter(0.3)] for n in range(14)]
    crate = [-1.6, 0.12, 0.5]
    return scene(
        "Suction",
        "A nozzle pulls everything with 26 m/s^2 at its mouth, less with the way and nothing from 2.4 m on. A ball of "
        "20 g and one of 2 kg rise side by side, leaves follow, a ribbon and a ball on a string lean over, and a crate "
        "that friction holds stays where it is.",
        7, [1.5, 1.75, 3.1], [0.1, 1.05, 0],
        {"ground": {}, "oak": {}, "steel": {}, "slate": {}, "clay": {}, "rose": {}, "moss": {}, "sand": {}, "hemp": {},
         "ivory": {}, "crate": {}}, [
            ground(),
            body("table", "oak", box(0.7, 0.03, 0.45), [0, table - 0.03, 0], "static"),
            body("foot", "slate", box(0.05, (table - 0.06) / 2, 0.3), [0, (table - 0.06) / 2, 0], "static"),
            body("nozzle", "steel", {"cylinder": {"radius": 0.2, "half_height": 0.12}}, add(mouth, [0, 0.12, 0]), "static"),
            body("hose", "slate", {"cylinder": {"radius": 0.1, "half_height": 0.5}}, add(mouth, [0, 0.74, 0]), "static"),
            body("post", "slate", {"cylinder": {"radius": 0.025, "half_height": peg[1] / 2}},
                 [peg[0] + 0.3, peg[1] / 2, peg[2]], "static"),
            body("arm", "slate", box(0.17, 0.015, 0.015), add(peg, [0.15, 0.015, 0]), "static", collides=False),
            *(body(name, tone, {"sphere": {"radius": radius}}, place, mass=mass)
              for (name, (mass, place)), tone in zip(balls.items(), ("ivory", "rose"))),
            body("bob", "clay", {"sphere": {"radius": 0.06}}, bob(0), mass=0.5, linear_damping=2.5),
            body("crate", "crate", box(0.12, 0.12, 0.12), crate, density=300),
            *(body(f"leaf_{n}", ("moss", "sand")[n % 2], box(0.03, 0.003, 0.018), place, density=300,
                   rotation=turn(Y, random.jitter(3)), drag_coefficient=1.1) for n, place in enumerate(leaves)),
        ], [
            *(promise("height", "==", flown(place, 12)[1], name, 0.004, 12) for name, (_, place) in balls.items()),
            promise("x", "==", flown(balls["heavy"][1], 12)[0], "heavy", 0.004, 12),
            *(promise("height", ">", mouth[1] - 0.35, name) for name in (*balls, "leaf_0", "leaf_13")),
            promise("x", "==", bob(angle)[0], "bob", 0.01),
            promise("height", "==", bob(angle)[1], "bob", 0.01),
            promise("x", "==", crate[0], "crate", 0.002),
            at_point("height", "==", chain[-1][1], "ribbon", 4 * (parts + 1) - 1, 0.015),
        ],
        fields=[{"name": "suction", "suction": {"center": mouth, "strength": strength, "reach": reach}}],
        ropes=[rope("string", "hemp", line(peg, bob(0), 7), 0.005, 0.004)],
        cloths=[{
            "name": "ribbon", "material": "rose", "columns": parts + 1, "rows": 7, "corner": [-0.68, table + 0.004, -0.07],
            "column_direction": X, "row_direction": Z, "width": ribbon, "height": 0.14, "areal_density": 0.15,
            "bend_stiffness": 2e-5, "damping": 0.05, "air_friction": 0.05, "pins": [{"column": 0}]
        }],
        hooks=[tie("knot", "bob", "string", b_point="last")])


def buoyancy():
    """What floats, how deep, and what sinks."""
    level, density = 1.0, 1000.0
    raft, load = [0.6, 0.1, 0.45], 40.0
    raft_mass = 0.5 * density * 8 * raft[0] * raft[1] * raft[2]
    draught = (raft_mass + load) / (density * 4 * raft[0] * raft[2])
    raft_at = level - draught + raft[1]
    chest = 0.17
    ball, buoy, stone = 0.22, 0.18, 0.16
    drum = [0.16, 0.22]  # radius and half its height
    volume = 4 / 3 * math.pi * buoy**3
    lift = (density - 200) * volume * G
    moored = [1.15, 0.55, 0.3]
    start = level - 0.3

    # Upright the drum would not stand: its metacenter lies r^2 / 4 d above the middle of its draught d, its center
    # of mass higher.
    assert drum[0]**2 / (4 * 0.3 * 2 * drum[1]) < (1 - 0.3) * drum[1]

    # The stone sinks against the drag of the liquid: m dv/dt = (m - rho V) g - k m v, k = drag rho / density.
    drag, heavy = 1.5, 2600.0
    rate = drag * density / heavy
    fast = (1 - density / heavy) * G / rate
    t = 20 * DT
    sunk = fast * (t - (1 - math.exp(-rate * t)) / rate)
    water = {"color": [0.10, 0.30, 0.42], "shininess": 200, "opacity": 0.35}
    return scene(
        "Buoyancy",
        "In a basin a raft with a chest on it, a ball and a drum float as deep as they are heavy, a buoy pulls at its "
        "rope with the weight of the water it displaces less its own, and a stone sinks.",
        8, [1.6, 1.9, 3.6], [0.1, 0.75, 0],
        {"ground": {}, "sand": {}, "oak": {}, "crate": {}, "ivory": {}, "rose": {}, "steel": {}, "slate": {}, "hemp": {},
         "glass": water}, [
            ground("sand"),
            body("water", "glass", box(1.9, level / 2, 1.2), [0, level / 2, 0], "static", collides=False),
            body("raft", "oak", box(*raft), [-0.75, raft_at + 0.1, 0], mass=raft_mass),
            body("chest", "crate", box(chest, chest, chest), [-0.75, raft_at + raft[1] + chest + 0.1, 0], mass=load),
            body("ball", "rose", {"sphere": {"radius": ball}}, [0.35, level + 0.3, 0.55], density=density / 2),
            body("drum", "steel", {"cylinder": {"radius": drum[0], "half_height": drum[1]}}, [0.45, level + 0.1, -0.5],
                 density=300, rotation=turn(Z, 0.1)),
            body("buoy", "ivory", {"sphere": {"radius": buoy}}, moored, density=200),
            body("stone", "slate", {"sphere": {"radius": stone}}, [1.5, start, -0.6], density=heavy),
        ], [
            promise("height", "==", raft_at, "raft", 0.004),
            promise("height", "==", raft_at + raft[1] + chest, "chest", 0.006),
            promise("tilt", "<", 0.5, "raft"),
            promise("height", "==", level, "ball", 0.004),
            promise("tilt", ">", 85, "drum"),
            promise("force", "within", lift, "mooring", 0.01),
            promise("height", "==", start - sunk, "stone", 0.01 * sunk, 20),
            promise("height", "==", stone, "stone", 0.003),
        ],
        world={"sleeping": False, "wind": {"air_density": 0}},
        fields=[{"name": "water_field", "liquid": {"height": level, "density": density, "drag": drag}}],
        ropes=[rope("cable", "hemp", line([moored[0], 0, moored[2]], add(moored, [0, -buoy, 0]), 10), 0.01, 0.008)],
        hooks=[tie("mooring", "buoy", "cable", b_point="last")])


FIELD_SCENES = [magnet, suction, buoyancy]
