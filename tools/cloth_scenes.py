"""Scenes of cloth in wind, on ropes and over things; make_scenes.py writes them."""
import math

from rope_scenes import line, rope, tension, tie
from scene_kit import DT, G, X, Y, Z, add, at_point, body, box, fall, ground, promise, scaled, scene, turn

AIR = 1.225  # kg/m^3


def strip(pull, weight, wind, length, parts=2000):
    """The way (z, y) along a strip of cloth that is pulled by `pull` (z, y) [N/m] at its beginning, and what pulls it
    on at its end. Its weight [N/m^2] acts on its length, the wind along z on its height alone."""
    z = y = 0.0
    tz, ty = pull
    ds = length / parts
    for _ in range(parts):
        t = math.hypot(tz, ty)
        z, y = z + ds * tz / t, y + ds * ty / t
        tz, ty = tz - wind * ds * abs(ty) / t, ty + weight * ds
    return [z, y], [tz, ty]


def held_strip(start, end, length, string, weight, wind=0.0, foot=0.0, guess=(100.0, -100.0)):
    """A strip from `start` with a weight `foot` [N/m] at its lower edge, which a light string ties to `end`: the pull
    at the start, where the foot is, the pull of the string, all per width. By Newton's method on the string's
    length and direction."""

    def solve(pull):
        way, (tz, ty) = strip(pull, weight, wind, length)
        ty += foot
        dz, dy = end[0] - start[0] - way[0], end[1] - start[1] - way[1]
        size = math.hypot(tz, ty)
        return (math.hypot(dz, dy) - string, (tz * dy - ty * dz) / size), way, size

    pull, e = list(guess), 1e-4
    for _ in range(60):
        f, way, size = solve(pull)
        if math.hypot(*f) < 1e-12:
            break
        fz, fy = solve([pull[0] + e, pull[1]])[0], solve([pull[0], pull[1] + e])[0]
        a, b, c, d = (fz[0] - f[0]) / e, (fy[0] - f[0]) / e, (fz[1] - f[1]) / e, (fy[1] - f[1]) / e
        step = [(b * f[1] - d * f[0]) / (a * d - b * c), (c * f[0] - a * f[1]) / (a * d - b * c)]
        limit = min(1.0, 0.2 * math.hypot(*pull) / (math.hypot(*step) + 1e-12))
        pull = [p + limit * s for p, s in zip(pull, step)]
    assert math.hypot(*f) < 1e-9
    return pull, [start[0] + way[0], start[1] + way[1]], size


def slack_line(a, b, length, aside, segments):
    """Two straight halves of this length together, their middle to one side."""
    reach = math.dist(a, b)
    elbow = add(scaled(0.5, add(a, b)), scaled(math.sqrt(length**2 - reach**2) / 2, aside))
    return line(a, elbow, segments // 2) + line(elbow, b, segments // 2)[1:]


def sail():
    """A square sail between a yard and a boom; two sheets hold the boom against the wind."""
    width, length, density, boom_mass = 2.4, 2.2, 0.4, 6.0
    speed, drag = 11.0, 1.2
    yard, cleat, sheet = [0, 3.6, 0], [0, 0.25, -0.9], 1.7
    wind = 0.5 * AIR * drag * speed**2
    _, foot, pull = held_strip([yard[2], yard[1]], [cleat[2], cleat[1]], length, sheet, density * G, wind,
                               boom_mass * G / width)
    half = [width / 2 + 0.1, 0.03, 0.03]
    sides = (("port", -1), ("starboard", 1))
    columns, rows = 17, 15
    start = [yard[1] - length, yard[2]]  # y, z of the boom: the sail hangs straight, the sheets are slack
    ropes, hooks = [], []
    for name, side in sides:
        low, high = [side * half[0], *cleat[1:]], [side * half[0], *start]
        ropes.append(rope(f"sheet_{name}", "hemp", slack_line(low, high, sheet, [side, 0, 0], 12), 0.05, 0.012))
        hooks.append(tie(f"knot_{name}", "boom", f"sheet_{name}", b_point="last"))
    hooks += [tie(f"lace_{k}", "boom", "sail", b_point=(rows - 1) * columns + k) for k in range(columns)]
    return scene(
        "Square sail",
        "A wind of 11 m/s fills a sail that hangs from a yard. Its foot is laced to a boom, and two sheets hold that. "
        "The sail takes the form in which its tension carries the wind and its weight, and that is what the sheets feel.",
        12, [4.4, 2.6, 5.2], [0, 2.2, 0.2],
        {"ground": {}, "oak": {}, "hemp": {}, "ivory": {}}, [
            ground(),
            body("deck", "oak", box(1.7, 0.1, 1.5), [0, 0.1, -0.3], "static"),
            body("mast", "oak", {"cylinder": {"radius": 0.06, "half_height": 1.95}}, [0, 2.1, -0.35], "static", collides=False),
            body("yard", "oak", box(width / 2 + 0.15, 0.035, 0.035), add(yard, [0, 0.035, 0]), "static", collides=False),
            body("boom", "oak", box(*half), [0, *start], mass=boom_mass, linear_damping=0.5, angular_damping=0.5,
                 collides=False),
        ], [
            *(tension(pull * width / 2, f"sheet_{name}", 6, 0.01) for name, _ in sides),
            promise("height", "==", foot[1], "boom", 0.01),
            promise("z", "==", foot[0], "boom", 0.01),
        ],
        world={"particle_substeps": 4, "wind": {"velocity": [0, 0, speed], "air_density": AIR}},
        ropes=ropes,
        hooks=hooks,
        cloths=[{
            "name": "sail", "material": "ivory", "columns": columns, "rows": rows, "corner": [-width / 2, yard[1], 0],
            "width": width, "height": length, "areal_density": density, "drag_coefficient": drag, "lift_coefficient": 0,
            "stretch_stiffness": 1e5, "shear_stiffness": 2e3, "damping": 2, "bend_stiffness": 6e-3, "tethers": True, "pins": [{"row": 0}]
        }])


def large_flag():
    """24 000 points."""
    columns, rows, width, height, density, top = 200, 120, 6.0, 3.6, 0.18, 9.0
    mass = density * width * height
    return scene(
        "Large flag",
        "A flag of 6 m by 3.6 m, 200 x 120 points, in gusts. The wind carries it: its middle stays near the middle of "
        "its pole's part, so that its potential energy is m g times that height.",
        1.5, [7.5, 5.2, 11.5], [2.6, 6.6, 0], {"ground": {}, "steel": {}, "rose": {}}, [
            ground(),
            body("pole", "steel", {"cylinder": {"radius": 0.07, "half_height": top / 2 + 0.1}}, [-0.08, top / 2 + 0.1, 0],
                 "static", collides=False),
            body("knob", "steel", {"sphere": {"radius": 0.13}}, [-0.08, top + 0.3, 0], "static", collides=False),
        ], [
            promise("potential_energy", "within", mass * G * (top - height / 2), None, 0.08),
            at_point("x", "<", 1.02 * width, "large_flag", columns - 1),
            promise("lowest", ">", top - height - 1.5, "large_flag"),
            promise("highest", "<", top + 1.0, "large_flag"),
            promise("mean_stretch", "<", 0.03),
        ],
        world={"substeps": 4, "particle_substeps": 5, "wind": {"velocity": [7, 0, 1.2], "gust": 0.4, "side_gust": 0.3, "correlation_time": 0.7}},
        cloths=[{
            "name": "large_flag", "material": "rose", "columns": columns, "rows": rows, "corner": [0, top, 0],
            "width": width, "height": height, "areal_density": density, "tethers": True, "pins": [{"column": 0}]
        }])


def flags():
    """65 536 points: much alike and nothing in common, as many workers like it."""
    points, spacing, density, top, apart, rows = 32, 0.04, 0.1, 3.0, [2.5, 1, 2.0], 8
    size = (points - 1) * spacing
    count = rows * rows
    first = [-apart[0] * rows / 2, 0, -apart[2] * (rows - 1) / 2]
    grid = {"grid": [rows, 1, rows], "spacing": apart}
    mass = density * size**2 * count
    return scene(
        "Flags",
        "64 flags of 32 x 32 points in a steady wind of 10 m/s. It carries them: their middles stay near the middles "
        "of their poles' parts, so that the potential energy is m g times that height, and their free edges stream with it.",
        1.5, [10, 6.5, 17], [-0.5, 1.8, 2], {"ground": {}, "steel": {}, "rose": {}}, [
            ground(),
            dict(body("pole", "steel", {"cylinder": {"radius": 0.03, "half_height": top / 2 + 0.05}},
                      [first[0] - 0.04, top / 2 + 0.05, first[2]], "static", collides=False), array=grid),
        ], [
            promise("potential_energy", "within", mass * G * (top - size / 2), None, 0.1),
            at_point("x", ">", first[0] + 0.6 * size, "flag[0]", points - 1),
            at_point("x", "<", first[0] + (rows - 1) * apart[0] + 1.02 * size, f"flag[{count - 1}]", points - 1),
            promise("lowest", ">", top - 1.6 * size, "flag[27]"),
            promise("highest", "<", top + 0.6 * size, "flag[36]"),
            promise("mean_stretch", "<", 0.02),
        ],
        world={"substeps": 4, "particle_substeps": 5, "wind": {"velocity": [10, 0, 2]}},
        cloths=[{
            "name": "flag", "material": "rose", "columns": points, "rows": points, "corner": [first[0], top, first[2]],
            "width": size, "height": size, "areal_density": density, "bend": "isometric", "tethers": True,
            "pins": [{"column": 0}], "array": grid
        }])


def tent():
    """Two panels on a ridge pole over two uprights that only stand; guys draw the eaves down."""
    ridge, length, panel, density = 1.9, 3.6, 1.7, 0.35
    columns, rows = 25, 13
    spar_mass, upright_mass, lantern = 3.0, 2.0, 1.5
    eave = [1.35, ridge - math.sqrt(panel**2 - 1.35**2)]  # z, y
    reach = eave[1] / (ridge - eave[1])
    peg = [eave[0] * (1 + reach), 0.0]
    guy = 1.02 * reach * panel
    pull, foot, _ = held_strip([0, ridge], peg, panel, guy, density * G, guess=(40.0, -40.0))
    on_upright = -pull[1] * length + (spar_mass / 2 + lantern / 2) * G
    xs = [k * 4 for k in range(7)]  # columns with guys
    ropes, hooks, cloths, bodies = [], [], [], []
    for name, side in (("l", -1), ("r", 1)):
        cloths.append({
            "name": f"panel_{name}", "material": "ivory", "columns": columns, "rows": rows,
            # Both begin on one line, where they are laced to the spar: they do not touch each other.
            "group": -1,
            "corner": [-length / 2, ridge, side * 0.0], "column_direction": X,
            "row_direction": [0, eave[1] - ridge, side * eave[0]], "width": length, "height": panel,
            "areal_density": density, "stretch_stiffness": 3e4, "shear_stiffness": 5e3, "bend_stiffness": 6e-3, "damping": 1,
            "air_friction": 0.5
        })
        hooks += [tie(f"lace_{name}{k}", "spar", f"panel_{name}", b_point=k) for k in range(0, columns, 2)]
        for n, k in enumerate(xs):
            x = length * (k / (columns - 1) - 0.5)
            low, high = [x, 0, side * peg[0]], [x, eave[1], side * eave[0]]
            ropes.append(rope(f"guy_{name}{n}", "hemp", slack_line(low, high, guy, X, 8), 0.02, 0.006))
            hooks.append(tie(f"eyelet_{name}{n}", f"panel_{name}", f"guy_{name}{n}", a_point=(rows - 1) * columns + k,
                             b_point="last"))
            bodies.append(body(f"peg_{name}{n}", "oak", {"cylinder": {"radius": 0.02, "half_height": 0.08}},
                               [x, 0.04, side * (peg[0] + 0.02)], "static", collides=False))
    for name, side in (("w", -1), ("e", 1)):
        top, low = [side * length / 2, ridge, 0], [side * (length / 2 + 1.7), 0, 0]
        half = (ridge - 0.06) / 2  # the end ropes come to the spar beside their rims
        bodies += [
            body(f"upright_{name}", "oak", {"cylinder": {"radius": 0.03, "half_height": half}}, [top[0], half, 0],
                 mass=upright_mass),
            body(f"peg_{name}", "oak", {"cylinder": {"radius": 0.02, "half_height": 0.08}}, add(low, [side * 0.02, 0.04, 0]),
                 "static", collides=False)
        ]
        hooks.append(tie(f"top_{name}", f"upright_{name}", "spar", anchor=top))
        distance = math.dist(low, top)
        ropes.append(rope(f"end_{name}", "hemp", slack_line(low, top, 1.0005 * distance, Z, 10), 0.02, 0.006))
        hooks.append(tie(f"end_knot_{name}", "spar", f"end_{name}", b_point="last"))
    bodies += [
        body("spar", "oak", box(length / 2 + 0.05, 0.025, 0.025), [0, ridge, 0], mass=spar_mass, collides=False),
        body("lantern", "rose", {"cylinder": {"radius": 0.08, "half_height": 0.12}}, [0, ridge - 0.5, 0], mass=lantern)
    ]
    ropes.append(rope("cord", "hemp", line([0, ridge, 0], [0, ridge - 0.38, 0], 4), 0.01, 0.005, pins=[]))
    hooks += [tie("cord_top", "spar", "cord", b_point=0), tie("cord_end", "lantern", "cord", b_point="last")]
    return scene(
        "Tent",
        "Two panels hang from a ridge pole on two uprights, which stand on the ground and are held by nothing else; ten "
        "guys draw the eaves down. The panels sag as catenaries, and each upright carries half of what they pull. After "
        "six seconds a breeze comes up.",
        10, [4.6, 2.6, 5.6], [0, 0.9, 0],
        {"ground": {"friction": 0.7}, "oak": {"friction": 0.7}, "hemp": {}, "ivory": {}, "rose": {}}, [ground(), *bodies], [
            *(promise("force", "within", on_upright, f"top_{name}", 0.03, 360) for name in "we"),
            promise("force", "within", lantern * G, "cord_end", 0.01, 360),
            *(at_point("height", "==", foot[1], f"panel_{name}", (rows - 1) * columns + 12, 0.02, 360) for name in "lr"),
            promise("height", "==", ridge, "spar", 0.02),
            promise("gap", "<", 0.01),
        ],
        world={"particle_substeps": 2, "wind": {"velocity": [0, 0, 0]}},
        ropes=ropes,
        cloths=cloths,
        hooks=hooks,
        timeline=[{"at_step": 360, "wind": {"velocity": [1.5, 0, 4], "gust": 0.4}}])


def silk_and_felt():
    """Half of the cloth is silk, half felt, sewn together over a ball."""
    radius, middle, side, gap = 0.4, 0.95, 1.3, 0.12
    columns, rows, thickness, drag = 21, 41, 0.006, 1.2
    kinds = {
        "silk": {"areal_density": 0.1, "bend_stiffness": 1.2e-5, "stretch_stiffness": 5e3, "shear_stiffness": 5e2},
        "felt": {"areal_density": 0.3, "bend_stiffness": 6e-4, "stretch_stiffness": 1e4, "shear_stiffness": 4e3}
    }
    top = middle + radius + thickness / 2
    cloths = [{
        "name": name, "material": name, "columns": columns, "rows": rows, "corner": [x, top + gap, -side / 2],
        "column_direction": X, "row_direction": Z, "width": side / 2, "height": side, "damping": 0.05,
        "bend_damping": 0.02, "drag_coefficient": drag, "thickness": thickness
    } | kinds[name] for name, x in (("silk", -side / 2), ("felt", 0))]

    def fallen(kind, step):
        """Flat against the air: m dv/dt = m g - rho C A v^2 / 2, while the ball is not reached."""
        t, fastest = step * DT, math.sqrt(2 * kinds[kind]["areal_density"] * G / (AIR * drag))
        return fastest**2 / G * math.log(math.cosh(G * t / fastest))

    middle_of = (rows // 2) * columns
    return scene(
        "Silk and felt",
        "Two cloths of the same size, sewn together, fall over one ball: left silk of 100 g/m^2 that hardly resists "
        "bending, right felt, three times as heavy and far stiffer. The silk falls into folds, the felt stands off.",
        4, [0.75, 1.65, 2.1], [0, 0.85, 0],
        {"ground": {}, "slate": {"friction": 0.6}, "silk": {}, "felt": {}}, [
            ground(),
            body("ball", "slate", {"sphere": {"radius": radius}}, [0, middle, 0], "static"),
            body("foot", "slate", {"cylinder": {"radius": 0.1, "half_height": (middle - radius) / 2 + 0.03}},
                 [0, (middle - radius) / 2 + 0.03, 0], "static", collides=False),
        ], [
            at_point("height", "==", top + gap - fallen("silk", 8), "silk", middle_of + 6, 0.003, 8),
            at_point("height", "==", top + gap - fallen("felt", 8), "felt", middle_of + columns - 7, 0.003, 8),
            promise("highest", "==", top, "silk", 0.012),
            promise("highest", "==", top, "felt", 0.012),
            promise("lowest", ">", middle - 2 * radius, "silk"),
            at_point("x", ">", -1.3 * radius, "silk", middle_of),
            at_point("x", ">", 1.35 * radius, "felt", middle_of + columns - 1),
            promise("mean_stretch", "<", 0.01),
            promise("penetration", "<", 0.003),
            promise("gap", "<", 0.003),
        ],
        world={"particle_substeps": 2},
        cloths=cloths,
        seams=[{"name": "seam", "a": "silk.right", "b": "felt.left"}])


def sling(length, span, radius):
    """A roller of this radius hangs in a sling between two bars: how far its axis is below them, or above."""
    low, high = 0.0, math.pi / 2
    for _ in range(80):  # the angle that the sling turns by on either side
        turned = 0.5 * (low + high)
        free = length / 2 - radius * turned
        low, high = (turned, high) if radius * math.sin(turned) + free * math.cos(turned) > span / 2 else (low, turned)
    return radius * math.cos(low) - (length / 2 - radius * low) * math.sin(low)


def hammock():
    """A roller, 140 times as heavy as the cloth, lies in it."""
    columns, rows, width, length, span, bars = 19, 41, 1.1, 2.3, 1.9, 1.5
    radius, half, mass, density, thickness = 0.2, 0.3, 80.0, 0.25, 0.008
    sag = math.sqrt(length**2 - span**2) / 2
    start = bars - sag + radius + 0.45
    depth = sling(length, span, radius + thickness / 2)
    vertices, triangles = [], []
    for r in range(rows):
        part = 2 * r / (rows - 1) - 1
        for c in range(columns):
            vertices.append([width * (c / (columns - 1) - 0.5), -sag * (1 - abs(part)), part * span / 2])
    for r in range(rows - 1):
        for c in range(columns - 1):
            a, b = r * columns + c, (r + 1) * columns + c
            triangles += [[a, b, a + 1], [a + 1, b, b + 1]] if (r + c) % 2 else [[a, b, b + 1], [a, b + 1, a + 1]]
    return scene(
        "Hammock",
        "A roller of 80 kg drops into a hammock of half a kilogram. Cloth that does not stretch lies around it and "
        "goes straight to both bars: that says how deep it hangs.",
        8, [2.9, 1.9, 2.5], [0, 0.85, 0], {"ground": {}, "steel": {}, "clay": {"friction": 0.6}, "ivory": {}}, [
            ground(),
            *(body(f"bar_{name}", "steel", {"capsule": {"radius": 0.03, "half_height": width / 2 + 0.05}},
                   [0, bars, side * (span / 2 + 0.025)], "static", rotation=turn(Z, math.pi / 2), collides=False)
              for name, side in (("n", -1), ("s", 1))),
            *(body(f"post_{name}{k}", "steel", {"cylinder": {"radius": 0.04, "half_height": bars / 2}},
                   [x, bars / 2, side * (span / 2 + 0.025)], "static", collides=False)
              for name, side in (("n", -1), ("s", 1)) for k, x in enumerate((-width / 2 - 0.1, width / 2 + 0.1))),
            body("roller", "clay", {"capsule": {"radius": radius, "half_height": half}}, [0, start, 0],
                 mass=mass, rotation=turn(Z, math.pi / 2), angular_damping=0.5),
        ], [
            promise("height", "==", bars + depth, "roller", 0.05 * -depth),
            promise("z", "==", 0, "roller", 0.05),
            promise("speed", "<", 0.1, "roller"),
            promise("mean_stretch", "<", 0.01),
            fall("roller", start, 16),
        ],
        world={"substeps": 8, "particle_substeps": 2},
        meshes={"sling": {"vertices": vertices, "triangles": triangles}},
        cloths=[{
            "name": "hammock", "material": "ivory", "mesh": "sling", "position": [0, bars, 0], "areal_density": density,
            "thickness": thickness, "stretch_stiffness": 1e5, "shear_stiffness": 5e3, "bend_stiffness": 1e-3, "damping": 2,
            "tethers": True, "pins": [*range(columns), *range((rows - 1) * columns, rows * columns)]
        }])


def tablecloth():
    """The cloth is drawn from under the plates."""
    top, long, wide, overhang = 0.75, 1.2, 0.8, 0.15
    columns, rows, thickness = 49, 29, 0.004
    length, width = long + overhang, wide - 0.04
    begin, ramp, speed, friction, cloth_friction = 0.5, 0.15, 6.0, 0.25, 0.5
    plates = [("plate", [-0.2, 0.18], 0.12, 0.012, 0.7, "ivory"), ("bowl", [0.2, -0.15], 0.09, 0.03, 0.5, "clay"),
              ("vase", [0.1, 0.2], 0.075, 0.05, 0.6, "slate")]
    drawn = 0.5 * speed * ramp
    back = 0.02 - long / 2  # where the cloth ends

    def dragged(x):
        """The cloth drags a thing until its own end is under the middle; the table stops it."""
        way = x - back
        time = math.sqrt(2 * way * ramp / speed) if way < drawn else ramp + (way - drawn) / speed
        fast = math.sqrt(friction * cloth_friction) * G * time
        return x + 0.5 * fast * time + fast**2 / (2 * friction * G)

    pulled = [{"time": begin + ramp * k / 6, "offset": [drawn * (k / 6)**2, 0, 0]} for k in range(7)]
    pulled.append({"time": begin + ramp + 0.4, "offset": [drawn + 0.4 * speed, 0, 0]})
    gap = 0.001
    return scene(
        "Tablecloth",
        "A cloth is drawn from under a plate, a bowl and a vase at six meters per second. Friction drags them along only "
        "as long as the cloth slides under them, and the table stops them.",
        3, [1.2, 1.75, 1.4], [0.1, 0.6, 0],
        {"ground": {"color": [0.12, 0.11, 0.10]}, "oak": {"friction": friction}, "silk": {"color": [0.30, 0.03, 0.06]}} |
        {plate[5]: {"friction": friction} for plate in plates}, [
            ground(),
            body("table", "oak", box(long / 2, 0.02, wide / 2), [0, top - 0.02, 0], "static"),
            *(body(f"leg_{k}", "oak", box(0.03, top / 2 - 0.02, 0.03), [x * 0.54, top / 2 - 0.02, z * 0.34], "static",
                   collides=False) for k, (x, z) in enumerate(((-1, -1), (-1, 1), (1, -1), (1, 1)))),
            *(body(name, tone, {"cylinder": {"radius": radius, "half_height": half}},
                   [x, top + thickness + half + gap, z], mass=mass) for name, (x, z), radius, half, mass, tone in plates),
        ], [
            *(promise("height", "==", top + half, name, 0.002) for name, _, _, half, _, _ in plates),
            # The end takes 15 % of the time from the middle to the rim, and drags on.
            *(promise("x", "==", dragged(x), name, 0.25 * (dragged(x) - x)) for name, (x, _), *_ in plates[:2]),
            promise("speed", "<", 0.01, "plate"),
        ],
        world={"particle_substeps": 6},
        cloths=[{
            "name": "tablecloth", "material": "silk", "columns": columns, "rows": rows, "corner": [back, top + (thickness + gap) / 2, -width / 2],
            "column_direction": X, "row_direction": Z, "width": length, "height": width, "areal_density": 0.2,
            "thickness": thickness, "stretch_stiffness": 2e4, "shear_stiffness": 2e3, "bend_stiffness": 1e-4, "damping": 0.5,
            "pins": [{"column": columns - 1, "motion": {"keyframes": pulled}}]
        }])


def seams():
    """Banners sewn of two pieces, with weights at the foot: one seam holds, one is too weak."""
    columns, rows, wide, tall, density, top, foot, finer = 17, 9, 0.8, 0.5, 2.0, 2.4, 4.0, 25
    cloths, sewn = [], []
    weight = (foot + density * wide * tall) * G
    for name, x, strength in (("banner", -0.9, None), ("torn", 0.1, 0.5 * weight / wide)):
        cloth = {
            "width": wide, "height": tall, "areal_density": density, "stretch_stiffness": 1e5, "shear_stiffness": 0,
            "bend": "none", "damping": 2, "air_friction": 3
        }
        cloths.append({"name": name, "material": "rose"} | cloth |
                      {"columns": columns, "rows": rows, "corner": [x, top, 0], "pins": [{"row": 0}]})
        loads = [{"point": (rows - 1) * finer + k, "mass": foot / (finer - 1) * (1 if 0 < k < finer - 1 else 0.5)}
                 for k in range(finer)]
        cloths.append({"name": name + "_foot", "material": "moss"} | cloth |
                      {"columns": finer, "rows": rows, "corner": [x, top - tall, 0], "loads": loads})
        sewn.append({"name": "seam_" + name, "a": name + ".bottom", "b": name + "_foot.top"} |
                    ({"strength": strength} if strength else {}))
    return scene(
        "Seams",
        "Banners sewn of two pieces, the lower one finer, with weights at the foot. Each stitch carries its share of "
        "what hangs on the seam; the other seam, half as strong as the load, parts.", 5, [0, 1.9, 4.2], [0, 1.5, 0], {
            "ground": {},
            "rose": {},
            "moss": {}
        }, [ground()], [
            promise("force", "within", weight / (finer - 1), f"seam_banner[{finer // 2}]", 0.02),
            promise("force", "within", weight / (finer - 1) / 2, "seam_banner[0]", 0.05),
            promise("broken", "==", 0, "seam_banner[0]", 0.1),
            promise("broken", "==", 1, "seam_torn[0]", 0.1),
            promise("broken", "==", finer, None, 0.1),
            promise("gap", "<", 0.0005),
            at_point("height", "==", top - 2 * tall, "banner_foot", "last", 0.01),
            promise("highest", "<", 0.7, "torn_foot"),
        ], world={"particle_substeps": 4}, cloths=cloths, seams=sewn)


def flag_torn():
    columns, rows, width, height, top, speed, holds = 31, 21, 1.5, 1.0, 2.6, 0.5, 0.3
    middle, last = rows // 2, columns - 1
    legs = [(range(middle), 1), (range(middle + 1, rows), -1)]
    hands = [{"point": row * columns + last, "motion": {"velocity": [0, 0, way * speed]}} for leg, way in legs
             for row in leg]
    seconds = 3
    return scene(
        "A flag is torn",
        f"A flag on a pole takes a strain of {100 * holds:.0f} %. Two hands hold its free edge, above and below the middle, "
        f"and go apart at {2 * speed:.0f} m/s. Points split across the pull, threads beside a crack carry less, and so the "
        "tear runs toward the pole.",
        seconds, [3.4, 2.9, 2.9], [0.9, 2.0, 0], {"ground": {}, "steel": {}, "rose": {}}, [
            ground(),
            body("pole", "steel", {"cylinder": {"radius": 0.03, "half_height": top / 2 + 0.1}},
                 [-0.035, top / 2 + 0.1, 0], "static", collides=False),
        ], [
            promise("broken", "==", 0, "flag", at_step=3),
            promise("broken", ">", columns // 2, "flag"),
            at_point("z", "within", seconds * speed, "flag", last, 0.001),
            at_point("x", "==", 0, "flag", 0, 0.001),
        ],
        world={"particle_substeps": 2},
        cloths=[{
            "name": "flag", "material": "rose", "columns": columns, "rows": rows, "corner": [0, top, 0], "width": width,
            "height": height, "areal_density": 0.2, "stretch_stiffness": 600, "shear_stiffness": 120, "damping": 0.02,
            "tear_strain": holds, "pins": [{"column": 0}, *hands]
        }])


CLOTH_SCENES = [sail, large_flag, flags, tent, silk_and_felt, seams, hammock, tablecloth, flag_torn]
