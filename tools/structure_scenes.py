"""Scenes of structures whose forces statics tells, for `hooke load` too; make_scenes.py writes them."""
import math

from rope_scenes import line, rope, tension, tie
from scene_kit import G, Z, add, at_point, body, box, ground, hook, promise, scaled, scene, turn


def bar(name, material, start, end, mass, half_width, half_depth, **more):
    """A body from one node to another, in a plane of constant z."""
    way = add(end, scaled(-1, start))
    return body(name, material, box(math.hypot(*way) / 2, half_width, half_depth), scaled(0.5, add(start, end)),
                mass=mass, rotation=turn(Z, math.atan2(way[1], way[0])), collides=False, **more)


def truss_bridge():
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
    return scene(
        "Truss bridge",
        f"A Warren truss of {len(chords + diagonals)} bars of {mass:.0f} kg in equal triangles, hinged, on a pin and a "
        f"roller, with {load:.0f} kg under its middle. By the method of sections the upper chord carries M / h there. "
        f"Hinges take {strength / 1000:.0f} kN: hooke load scenes/truss_bridge.json --on load tells how much more.", 5,
        [6.5, 4.6, 13], [6, 3.1, 0],
        {"ground": {}, "steel": {}, "rose": {}, "cable": {}, "sand": {}, "crate": {}}, [
            ground(),
            body("pier", "sand", box(0.5, (base - 0.2) / 2, 0.8), [0, (base - 0.2) / 2, 0], "static",
                 array={"list": [[0, 0, 0], [span, 0, 0]]}), *bodies,
            body("load", "crate", box(0.6, 0.6, 0.6), add(nodes[middle], [0, -1, 0]), mass=load),
        ], [
            promise("force", "within", math.hypot(moment / high, mass * G / 2), f"{chord}@{chord[:2]}", 0.001),
            promise("force", "within", left, "pin", 0.001),
            promise("force", "within", load * G, "hanger", 0.001),
            promise("height", "==", base, middle, 1e-4),
            promise("gap", "<", 1e-4),
            promise("broken", "==", 0),
        ], hooks=hooks)


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
        [0.35, 3.3, 3.6], [0.35, 3.3, 0],
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


STRUCTURE_SCENES = [truss_bridge, crane_jib, mobile, cantilever]
