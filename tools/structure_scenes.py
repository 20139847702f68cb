"""Scenes of structures whose forces statics tells, for `hooke load` too; make_scenes.py writes them."""
import math

from rope_scenes import line, rope, tension, tie
from scene_kit import (G, Z, add, at_point, body, box, ground, hook, prism, product, promise, rotated, scaled, scene,
                       sector, turn)


def bar(name, material, start, end, mass, half_width, half_depth, **more):
    """A body from one node to another, in a plane of constant z."""
    way = add(end, scaled(-1, start))
    return body(name, material, box(math.hypot(*way) / 2, half_width, half_depth), scaled(0.5, add(start, end)),
                mass=mass, rotation=turn(Z, math.atan2(way[1], way[0])), collides=False, **more)


def warren_bridge():
    """A truss of equal triangles on a pin and a roller with a load under its middle, and its forces by statics."""
    panels, panel, base, mass, node_mass, load, strength = 6, 2.0, 3.0, 40.0, 5.0, 2000.0, 60e3
    high = panel * math.sqrt(3) / 2
    nodes = {f"b{i}": [i * panel, base, 0] for i in range(panels + 1)}
    nodes |= {f"t{i}": [(i + 0.5) * panel, base + high, 0] for i in range(panels)}
    chords = [(f"b{i}", f"b{i + 1}") for i in range(panels)] + [(f"t{i}", f"t{i + 1}") for i in range(panels - 1)]
    diagonals = [pair for i in range(panels) for pair in ((f"b{i}", f"t{i}"), (f"t{i}", f"b{i + 1}"))]
    middle = f"b{panels // 2}"
    bodies, hooks = [], []
    for pairs, material, depth in ((chords, "steel", 0.25), (diagonals, "rose", 0.2)):
        for a, b in pairs:
            bodies.append(bar(f"{a}_{b}", material, nodes[a], nodes[b], mass, 0.07, depth))
            hooks += [hook(f"{a}_{b}@{end}", "hinge", end, nodes[end], f"{a}_{b}", axis=Z, break_force=strength)
                      for end in (a, b)]
    bodies += [body(name, "cable", {"cylinder": {"radius": 0.13, "half_height": 0.3}}, place, mass=node_mass,
                    rotation=turn([1, 0, 0], math.pi / 2), collides=False) for name, place in nodes.items()]
    hooks += [hook("pin", "hinge", "b0", nodes["b0"], axis=Z),
              hook("roller", "slider", f"b{panels}", nodes[f"b{panels}"], axis=[1, 0, 0]),
              hook("hanger", "ball", middle, nodes[middle], "load")]
    # By the method of sections: half of each bar's weight at each of its nodes; the moment about the middle.
    weights = {name: node_mass * G for name in nodes}
    for pair in chords + diagonals:
        for end in pair:
            weights[end] += mass * G / 2
    weights[middle] += load * G
    span = panels * panel
    left = sum(weight * (span - nodes[name][0]) for name, weight in weights.items()) / span
    center = nodes[middle][0]
    moment = left * center - sum(weight * max(center - nodes[name][0], 0) for name, weight in weights.items())
    chord = f"t{panels // 2 - 1}_t{panels // 2}"
    bodies = [ground(),
              body("pier", "sand", box(0.5, (base - 0.2) / 2, 0.8), [0, (base - 0.2) / 2, 0], "static",
                   array={"list": [[0, 0, 0], [span, 0, 0]]}), *bodies,
              body("load", "crate", box(0.6, 0.6, 0.6), add(nodes[middle], [0, -1, 0]), mass=load)]
    # A hinge takes the chord's force and half its weight across; each newton in the middle adds span / 4 to the moment.
    across = mass * G / 2
    more = (math.sqrt(strength**2 - across**2) * high - moment) / (span / 4)
    return {"bodies": bodies, "hooks": hooks, "count": len(chords + diagonals), "mass": mass, "load": load,
            "strength": strength, "base": base, "left": left, "middle": middle, "hinge": f"{chord}@{chord[:2]}",
            "force": math.hypot(moment / high, across), "more": more}


BRIDGE_LOOK = {"ground": {}, "steel": {}, "rose": {}, "cable": {}, "sand": {}, "crate": {}}


def truss_bridge():
    bridge = warren_bridge()
    return scene(
        "Truss bridge",
        f"A Warren truss of {bridge['count']} bars of {bridge['mass']:.0f} kg in equal triangles, hinged, on a pin and a "
        f"roller, with {bridge['load']:.0f} kg under its middle. By the method of sections the upper chord carries M / h "
        f"there. Hinges take {bridge['strength'] / 1000:.0f} kN: hooke load scenes/truss_bridge.json --on load tells how "
        "much more.", 5, [6.5, 4.6, 13], [6, 3.1, 0], BRIDGE_LOOK, bridge["bodies"], [
            promise("force", "within", bridge["force"], bridge["hinge"], 0.001),
            promise("force", "within", bridge["left"], "pin", 0.001),
            promise("force", "within", bridge["load"] * G, "hanger", 0.001),
            promise("height", "==", bridge["base"], bridge["middle"], 1e-4),
            promise("gap", "<", 1e-4),
            promise("broken", "==", 0),
        ], hooks=bridge["hooks"])


def bridge_collapse():
    bridge = warren_bridge()
    more, steps = bridge["more"], 120
    pushes = [{"at_step": start, "force": {"object": "load", "force": [0, -share * more, 0], "steps": steps}}
              for start, share in ((60, 0.99), (60 + steps, 1.01))]
    return scene(
        "Collapse of a bridge",
        f"The truss bridge, pulled down at its load. By statics, and by hooke load scenes/truss_bridge.json --on load, its "
        f"upper chord gives at {more / 1000:.2f} kN more than it carries. From 1 s on it is 1 % less, and holds; from 3 s on "
        "it is 1 % more.", 4, [6.5, 4.6, 13], [6, 2.6, 0], BRIDGE_LOOK, bridge["bodies"], [
            promise("force", "within", bridge["force"], bridge["hinge"], 0.001, 59),
            promise("force", "within", 0.99 * bridge["strength"], bridge["hinge"], 0.01, 170),
            promise("height", "==", bridge["base"], bridge["middle"], 1e-3, 179),
            promise("broken", "==", 0, at_step=179),
            promise("broken", ">", 0),
            promise("height", "<", bridge["base"] - 1, bridge["middle"]),
        ], hooks=bridge["hooks"], timeline=pushes)


def arch_limit():
    stones, radius, half, limit = 48, 2.0, 0.3, 0.1075
    step = 180 / stones
    turns = [turn(Z, math.radians((i + 0.5) * step)) for i in range(stones)]
    places = [rotated(one, [radius, 0, 0]) for one in turns]
    meshes, bodies = {}, [ground()]
    for name, material, share, z in (("thick", "sand", 1.03, -1.0), ("thin", "rose", 0.97, 1.0)):
        ring = sector(radius * (1 - share * limit / 2), radius * (1 + share * limit / 2), step, half)
        ring["vertices"] = [[x - radius, y, depth] for x, y, depth in ring["vertices"]]
        meshes[name] = ring
        bodies.append(body(name, material, {"hull": name}, density=2200,
                           array={"list": [add(place, [0, 0, z]) for place in places], "rotations": turns}))
    top = places[stones // 2][1]
    key = f"[{stones // 2}]"
    return scene(
        "Arches at their limit",
        f"Two half circles of {stones} stones without mortar. By thrust alone one stands from a thickness of 0.1075 of its "
        "middle radius on (Milankovitch 1907; Heyman 1969). The one behind has 3 % more, and stands; the one in front has "
        "3 % less, and falls.", 8, [2.4, 2.2, 7], [0, 0.9, 0], {"ground": {"friction": 1}, "sand": {"friction": 1},
                                                               "rose": {"friction": 1}}, bodies, [
            promise("height", "==", top, "thick" + key, 0.03),
            promise("height", "<", top - 0.5, "thin" + key),
        ], meshes=meshes, world={"sleeping": False})


def tower_collapse():
    storeys, slab_half, thick, post, tall, removed = 5, 1.0, 0.1, 0.14, 0.4, 60
    corner = slab_half - post
    high = 2 * (thick + tall)
    corners = [[x * corner, 0, z * corner] for x in (1, -1) for z in (1, -1)]
    bodies = [ground()]
    for i in range(storeys):
        bodies += [body(f"posts_{i}", "sand", box(post, tall, post), [0, i * high + tall, 0], density=2000,
                        array={"list": corners}),
                   body(f"floor_{i}", "slate", box(slab_half, thick, slab_half), [0, i * high + 2 * tall + thick, 0],
                        density=1000)]
    top = storeys * high - thick
    return scene(
        "A tower falls",
        f"{storeys} floors on four posts each, loose. It stands as it is; after one second two posts of the lowest floor are "
        "gone, and the weight is no longer above what bears it: it tips to their side.", 7, [6, 3.4, 8.5], [0.8, 1.9, 0],
        {"ground": {"friction": 0.7}, "sand": {"friction": 0.7}, "slate": {"friction": 0.7}}, bodies, [
            promise("height", "==", top, f"floor_{storeys - 1}", 0.02, removed),
            promise("x", "==", 0, f"floor_{storeys - 1}", 0.01, removed),
            promise("x", ">", 1, f"floor_{storeys - 1}"),
            promise("height", "<", 0.5 * top, f"floor_{storeys - 1}"),
        ], world={"substeps": 16}, timeline=[{"at_step": removed, "remove": f"posts_0[{i}]"} for i in (0, 1)])


def part_on_plane():
    size, half, slope = 0.3, 0.15, math.radians(20)
    outline = [[0, 0], [1, 0], [2.5, 1], [1.5, 1]]
    middle = [1.25, 0.5]
    part = prism([[size * (x - middle[0]), size * (y - middle[1])] for x, y in outline], half)
    normal = [1 / math.sqrt(3.25), -1.5 / math.sqrt(3.25)]  # of the long side that it may lie on
    lying = size * (normal[0] * (1 - middle[0]) - normal[1] * middle[1])
    side = turn(Z, -math.pi / 2 - math.atan2(normal[1], normal[0]))
    end = turn([1, 0, 0], math.pi / 2)
    tilted = turn(Z, -slope)
    up, down = [math.sin(slope), math.cos(slope), 0], [math.cos(slope), -math.sin(slope), 0]
    nudge = turn([0.6, 0, 0.8], 2e-3)
    lift = 1e-3
    origin = [0, 0.6, -1.2]

    def on_slope(way, z):
        return add(add(add(origin, scaled(way, down)), scaled(lying, up)), [0, 0, z])

    seconds, slow = 2, 0.3
    speed = G * (math.sin(slope) - slow * math.cos(slope))
    return scene(
        "A part on a plane",
        "A prism that leans, as hooke settle finds its rest: on its ends and its long sides it stays, lifted by 1 mm and "
        "turned by 2 mrad; on its short side, over which its center hangs, it rolls over to a long one. On a slope of 20 "
        "degrees it stays with friction 0.6, and slides with 0.3.", seconds, [1.6, 1.3, 2.2], [0.1, 0.25, -0.2],
        {"ground": {"friction": 0.6}, "oak": {"friction": 0.6}, "clay": {"friction": 0.6}, "steel": {"friction": 0.6},
         "ivory": {"friction": slow * slow / 0.6}}, [
            ground(),
            body("slope", "oak", box(1.4, 0.05, 0.5), add(origin, scaled(-0.05, up)), "static", rotation=tilted),
            body("on_side", "clay", {"hull": "part"}, [-0.9, lying + lift, 0.4], rotation=product(nudge, side)),
            body("on_end", "steel", {"hull": "part"}, [0, half + lift, 0.4], rotation=product(nudge, end)),
            body("rolls", "clay", {"hull": "part"}, [0.9, size * middle[1] + lift, 0.4], rotation=nudge),
            body("stays", "clay", {"hull": "part"}, on_slope(0, -0.25), rotation=product(tilted, side)),
            body("slides", "ivory", {"hull": "part"}, on_slope(-1.0, 0.25), rotation=product(tilted, side)),
        ], [
            promise("height", "==", lying, "on_side", 2e-3),
            promise("height", "==", half, "on_end", 2e-3),
            promise("height", "==", lying, "rolls", 2e-3),
            promise("x", "==", on_slope(0, 0)[0], "stays", 2e-3),
            promise("speed", "<", 0.01, "stays"),
            promise("speed", "within", speed, "slides", 0.02, 60),
        ], meshes={"part": part})


def crane_jib():
    foot, top, reach, load, jib, stay, cord = 3.0, 5.5, 4.0, 500.0, 60.0, 25.0, 1.0
    rise = top - foot
    root, tip, head = [0, foot, 0], [reach, foot, 0], [0, top, 0]
    low, half, segments = 1.5, 0.4, 15
    ends = line(tip, add(tip, [0, -low, 0]), segments)
    # Moments about the jib's root give the force up at its tip, moments about the head that along the ground.
    up = (load + cord) * G + jib * G / 2
    across = (up + stay * G / 2) * reach / rise
    strength = 20e3
    return scene(
        "Jib crane",
        f"A jib of {jib:.0f} kg is hinged to a mast and held by a stay of {stay:.0f} kg; {load:.0f} kg hang on its tip. "
        "Statics: moments about the jib's root and about the mast's head give the force in the stay, tension, and in "
        "the jib, compression. hooke load scenes/crane_jib.json --on load tells what breaks first.", 6,
        [3.4, 4.2, 9], [1.7, 2.9, 0], {"ground": {}, "slate": {}, "steel": {}, "rose": {}, "cable": {}, "clay": {}}, [
            ground(),
            body("mast", "slate", box(0.15, top / 2 + 0.1, 0.15), [-0.15, top / 2 + 0.1, 0], "static", collides=False),
            bar("jib", "steel", root, tip, jib, 0.08, 0.08),
            bar("stay", "rose", tip, head, stay, 0.04, 0.04),
            body("load", "clay", box(half, half, half), add(ends[-1], [0, -half, 0]), mass=load),
        ], [
            promise("force", "within", math.hypot(across, up), "stay_tip", 0.001),
            promise("force", "within", math.hypot(across, up + stay * G), "stay_head", 0.001),
            promise("force", "within", math.hypot(across, jib * G / 2), "jib_root", 0.001),
            tension((load + cord * (1 - 0.5 / segments)) * G, "cord", 0, 0.001),
            promise("height", "==", foot - low - half, "load", 0.002),
            promise("broken", "==", 0),
        ],
        ropes=[rope("cord", "cable", ends, cord, 0.02, pins=[], strength=15e3)],
        hooks=[hook("jib_root", "hinge", "jib", root, "mast", axis=Z, break_force=strength),
               hook("stay_head", "hinge", "stay", head, "mast", axis=Z, break_force=strength),
               hook("stay_tip", "hinge", "jib", tip, "stay", axis=Z, break_force=strength),
               tie("cord_tip", "jib", "cord", b_point=0, anchor=tip), tie("hook", "load.top", "cord.end")])


def mobile():
    """Each arm hangs by an eye above its line, by arms that are as long as what hangs on the other side is heavy."""
    eye, thread, threads = 0.05, 0.004, []
    bodies, hooks, promises = [], [], []

    def hang(name, top, bottom, below, anchor_above, above, weight):
        ropes = rope(name, "cable", line(top, bottom, 4), thread, 0.004, pins=[] if above else [0], strength=60)
        threads.append(ropes)
        if above:
            hooks.append(tie(f"{name}_above", above, name, b_point=0, anchor=anchor_above))
        hooks.append(tie(f"{name}_below", below, name, b_point="last", anchor=bottom))
        promises.append(tension((weight + thread * (1 - 0.5 / 4)) * G, name, 0, 0.002))

    def leaf(name, material, place, mass, radius):
        bodies.append(body(name, material, {"cylinder": {"radius": radius, "half_height": 0.01}}, place, mass=mass,
                           rotation=turn([1, 0, 0], math.pi / 2), collides=False))

    # From below: (mass on the left, mass on the right, length, arm's mass). The lower arm hangs on the right.
    arms = [(0.3, 0.5, 0.8, 0.1), (0.6, None, 1.1, 0.15), (0.9, None, 1.5, 0.2)]
    total, levels = None, []
    for left, right, length, own in arms:
        right = total if right is None else right
        pair = left + right + 2 * thread
        # Moments about the eye: m_left x = m_right (l - x) + m_own (l / 2 - x).
        x = length * (right + thread + own / 2) / (pair + own)
        levels.append((left, right, length, own, x))
        total = pair + own
    bodies.append(body("beam", "oak", box(0.6, 0.04, 0.06), [0, 4.04, 0], "static", collides=False))
    place = [0, 3.6, 0]
    tones = ["rose", "slate", "sand", "ivory"]
    above, weight, drop = None, total, 0.3
    start = [0, 4.0, 0]
    for level, (left, right, length, own, x) in reversed(list(enumerate(levels))):
        name = f"arm{level}"
        center = add(place, [length / 2 - x, -eye, 0])
        bodies.append(body(name, "steel", box(length / 2, 0.008, 0.008), center, mass=own, collides=False,
                           can_sleep=False))
        hang(f"thread{level}", start, place, name, start, above, weight)
        promises.append(promise("tilt", "<", 0.5, name))
        for side, mass, at in (("left", left, -x), ("right", right, length - x)):
            end = add(place, [at, -eye, 0])
            bottom = add(end, [0, -drop, 0])
            if side == "right" and level > 0:
                above, start, place, weight = name, end, bottom, right
                continue
            radius = 0.16 * math.sqrt(mass)
            leaf_name = f"leaf{level}_{side}"
            leaf(leaf_name, tones[level] if side == "left" else tones[3], add(bottom, [0, -radius, 0]), mass, radius)
            hang(f"{leaf_name}_thread", end, bottom, leaf_name, end, name, mass)
    return scene(
        "Mobile",
        "Three arms and four leaves, each arm with its own weight. Arms hang level where the moments about their eyes are "
        "in balance; each thread carries all that is below it. Threads take 60 N.", 20,
        [1.1, 2.75, 3.0], [0.35, 3.3, 0],
        {"oak": {}, "cable": {}, "steel": {}, "rose": {}, "slate": {}, "sand": {}, "ivory": {}}, bodies, promises,
        ropes=threads, hooks=hooks)


def cantilever():
    length, load, stiffness, segments, own = 2.0, 10.0, 2000.0, 40, 2.0
    height, half = 1.5, 0.12
    # Clamped by its first two points, so that its free length begins at the second.
    points = line([-length / segments, height, 0], [length, height, 0], segments + 1)
    free = own * segments / (segments + 1)
    bend = load * G * length**3 / (3 * stiffness) + free * G * length**3 / (8 * stiffness)
    return scene(
        "Cantilever",
        f"A rod of EI = {stiffness:.0f} N m^2 out of a wall, with {load:.0f} kg at its end. Euler and Bernoulli: it bends by "
        "P l^3 / 3 EI and, under its own weight W, by W l^3 / 8 EI.", 10,
        [1.4, 1.7, 3.6], [0.9, 1.3, 0], {"ground": {}, "sand": {}, "steel": {}, "clay": {}}, [
            ground(),
            body("wall", "sand", box(0.3, 1.0, 0.5), [-0.3, 1.0, 0], "static", collides=False),
            body("load", "clay", box(half, half, half), [length, height - half, 0], mass=load, angular_damping=2),
        ], [
            at_point("height", "==", height - bend, "rod", "last", 0.01 * bend),
            promise("force", "within", load * G, "end", 0.001),
            promise("kinetic_energy", "<", 1e-3),
        ],
        ropes=[rope("rod", "steel", points, own, 0.025, pins=[0, 1], bend_stiffness=stiffness, bend_damping=0.1)],
        hooks=[tie("end", "load.top", "rod.end")])


STRUCTURE_SCENES = [truss_bridge, bridge_collapse, crane_jib, mobile, cantilever, arch_limit, tower_collapse, part_on_plane]
