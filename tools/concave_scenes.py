"""Scenes of concave solids, for make_scenes.py: wheels with teeth, a ring on a peg, links of a chain. In the
laboratory (`hooke run --stepper declared`) triangles meet triangles; the solver takes the same solids as
convex parts."""
import math

from paper_scenes import laboratory
from scene_kit import (DT, G, X, Y, Z, body, box, fall, ground, hook, promise, rotated, scene, solid_mass, turn,
                       weight_energy)


def ring_mesh(spine, section):
    """A closed tube: the points of `section` (out, along, counter-clockwise) at each (place, out, along) of a
    closed line."""
    vertices = [[p + s * o + t * a for p, o, a in zip(place, out, along)]
                for place, out, along in spine for s, t in section]
    n, m = len(spine), len(section)
    triangles = []
    for i in range(n):
        for k in range(m):
            here, there, up = i * m, (i + 1) % n * m, (k + 1) % m
            triangles += [[here + k, here + up, there + up], [here + k, there + up, there + k]]
    return {"vertices": vertices, "triangles": triangles}


def round_section(radius, count):
    """A regular polygon with flat sides to the left and right, `radius` to the sides."""
    corner = radius / math.cos(math.pi / count)
    angles = [(k + 0.5) * 2 * math.pi / count for k in range(count)]
    return [[corner * math.cos(a), corner * math.sin(a)] for a in angles]


# ---- Gears ------------------------------------------------------------------------------------------------


def gear(teeth, module, half, pressure, backlash, steps=3):
    """A spur gear about z, a tooth at +x; flanks are involutes (Litvin, Gear Geometry), in `steps` pieces."""
    pitch = module * teeth / 2
    base, tip, root = pitch * math.cos(pressure), pitch + 0.9 * module, pitch - 1.2 * module

    def involute(r):
        angle = math.acos(base / r)
        return math.tan(angle) - angle

    at_pitch = (math.pi * module / 2 - backlash) / 2 / pitch  # half the angle of a tooth
    start = max(base, root)
    radii = [start + (tip - start) * (k / steps)**0.7 for k in range(steps + 1)]
    flank = [(r, at_pitch + involute(pitch) - involute(r)) for r in radii]
    if root < base:
        flank.insert(0, (root, flank[0][1] + 0.15 * module / root))  # a fillet
    outline = []
    for tooth in range(teeth):
        middle = 2 * math.pi * tooth / teeth
        outline += [[r * math.cos(middle - a), r * math.sin(middle - a)] for r, a in flank]
        outline += [[r * math.cos(middle + a), r * math.sin(middle + a)] for r, a in reversed(flank)]
    n = len(outline)
    vertices = [[x, y, z] for z in (-half, half) for x, y in outline] + [[0, 0, -half], [0, 0, half]]
    triangles = []
    for k in range(n):
        after = (k + 1) % n
        triangles += [[2 * n + 1, n + k, n + after], [2 * n, after, k]]  # star-shaped about the middle
        triangles += [[k, after, n + after], [k, n + after, n + k]]
    return {"vertices": vertices, "triangles": triangles}


def gears():
    module, pressure, backlash = 0.1, math.radians(25), 0.004
    counts, speed = [12, 24, 16], 2.0
    radii = [module * count / 2 for count in counts]
    height = 1.8
    places = [[-radii[0] - radii[1], height, 0], [0, height, 0], [radii[1] + radii[2], height, 0]]
    meshes = {f"gear{n}": gear(n, module, 0.1 + 0.02 * (n == 24), pressure, backlash) for n in counts}
    # A tooth of the first and third points at the middle one, which has gaps there: 24 and 16 are even.
    shift = {12: 0.0, 24: math.pi / 24, 16: 0.0}
    kinds = {"driver": 12, "wheel": 24, "last": 16}
    bodies, hooks = [], []
    for (name, count), place, tone in zip(kinds.items(), places, ["clay", "sand", "moss"]):
        more = {"rotation": turn(Z, shift[count])}
        if name == "driver":
            made = body(name, tone, {"mesh": f"gear{count}"}, place, "kinematic",
                        angular_velocity=[0, 0, speed], **more)
        else:
            made = body(name, tone, {"mesh": f"gear{count}"}, place, density=100, can_sleep=False,
                        angular_damping=2, **more)
            hooks.append(hook(f"axle of {name}", "hinge", name, place, axis=Z))
        bodies.append(made)
    bodies.append(body("ball", "clay", {"sphere": {"radius": 0.1}}, [3.2, 3, 0]))
    step = 150
    angle = speed * step * DT

    def tilt(name, sign):
        turned = sign * angle * counts[0] / kinds[name] + shift[kinds[name]]
        return promise("tilt", "==", math.degrees(math.acos(math.cos(turned))), name,
                       1.5 * math.degrees(2 * backlash / (module * kinds[name] / 2)) + 0.1, step)

    return scene(
        "Gears", "Wheels of 12, 24 and 16 teeth on fixed axles, the first one driven. Teeth are all that connects "
        "them: they turn as 12/24 and 12/16, within the play of the teeth. A ball falls beside them.", 3, [0, 2.2, 7.2], [0, 1.75, 0], {
            "clay": {"friction": 0, "restitution": 0}, "sand": {"friction": 0, "restitution": 0},
            "moss": {"friction": 0, "restitution": 0}
        }, bodies, [
            fall("ball", 3, 20), tilt("wheel", -1), tilt("last", 1),
            promise("angular_speed", "==", speed * counts[0] / counts[1], "wheel", 0.1),
            promise("angular_speed", "==", speed * counts[0] / counts[2], "last", 0.15)
        ], meshes=meshes, hooks=hooks, **laboratory(rollback="event", sweep="none", epsilon=1e-5))


# ---- A ring on a peg --------------------------------------------------------------------------------------


def torus(ring, wire, around, across):
    """About y."""
    spine = []
    for i in range(around):
        a = 2 * math.pi * i / around
        out = [math.cos(a), 0, math.sin(a)]
        spine.append(([ring * x for x in out], out, Y))
    return ring_mesh(spine, [[s, t] for s, t in round_section(wire, across)])


def post(radius, height, count):
    """A prism along y that stands at the origin."""
    angles = [-2 * math.pi * k / count for k in range(count)]
    vertices = [[radius * math.cos(a), y, radius * math.sin(a)] for y in (0, height) for a in angles]
    triangles = [[count, count + k, count + k + 1] for k in range(1, count - 1)]
    triangles += [[0, k + 1, k] for k in range(1, count - 1)]
    for k in range(count):
        after = (k + 1) % count
        triangles += [[k, after, count + after], [k, count + after, count + k]]
    return {"vertices": vertices, "triangles": triangles}


def torus_on_peg():
    ring, wire, peg = 0.5, 0.12, 0.2
    y0, step = 2.4, 24
    return scene(
        "A torus on a peg",
        "A ring falls askew and turning on a peg, and stays on it: it comes to rest on the ground, flat, with the "
        "peg through its hole. Friction ends its turning.", 6, [1.6, 2.0, 3.6], [0, 0.65, 0], {
            "ground": {"friction": 0.4}, "oak": {"friction": 0.4}, "rose": {"friction": 0.4, "restitution": 0.2}
        }, [
            ground(),
            body("peg", "oak", {"mesh": "peg"}, kind="static"),
            body("torus", "rose", {"mesh": "torus"}, [0.1, y0, 0.05], density=400, rotation=turn(Z, 0.35),
                 angular_velocity=[0, 4, 0], can_sleep=False)
        ], [
            fall("torus", y0, step),
            promise("height", "==", wire, "torus", 0.001),
            promise("tilt", "<", 0.5, "torus"),
            promise("x", "<", ring - wire - peg + 0.02, "torus"),
            promise("x", ">", -(ring - wire - peg + 0.02), "torus"),
            promise("z", "<", ring - wire - peg + 0.02, "torus"),
            promise("z", ">", -(ring - wire - peg + 0.02), "torus"),
            promise("angular_speed", "<", 0.01, "torus")
        ], meshes={"torus": torus(ring, wire, 24, 8), "peg": post(peg, 1.2, 16)}, **laboratory(rollback="event", sweep="none"))


# ---- A chain ----------------------------------------------------------------------------------------------


def link(length, width, wire, bends, across):
    """A link in the x-y plane, `length` along y and `width` along x inside, of wire of radius `wire`. The
    middle piece of each bend is straight across, so that links hang on flat pieces."""
    out = width / 2 + wire
    spine = []
    for side in (1, -1):
        middle = side * (length / 2 - width / 2)
        # The inner sides of its pieces are to be width / 2 from the middle of the bend.
        bend = width / 2 / math.cos(math.pi / bends / 2) + wire
        for k in range(bends + 1):
            a = math.pi * (k / bends) + (0 if side > 0 else math.pi)
            direction = [math.cos(a), math.sin(a), 0]
            reach = out if k in (0, bends) else bend
            spine.append(([reach * direction[0], middle + reach * direction[1], 0], direction, [0, 0, 1]))
    return ring_mesh(spine, [[s, -t] for s, t in round_section(wire, across)])


def chain_of_links():
    length, width, wire, count = 0.5, 0.26, 0.05, 5
    top, slack, density = 3.0, 0.03, 1000
    mesh = link(length, width, wire, 7, 8)
    mass = solid_mass(mesh, density)
    bodies = [body("hook", "steel", {"mesh": "link"}, [0, top, 0], "static")]
    for k in range(1, count + 1):
        place = [0, top - k * (length - slack), 0]
        quarter = {"rotation": turn(Y, math.pi / 2)} if k % 2 else {}
        spin = {"angular_velocity": [0, 1, 0]} if k == count else {}
        bodies.append(body(f"link{k}", "steel" if k % 2 == 0 else "slate", {"mesh": "link"}, place,
                           density=density, can_sleep=False, **quarter, **spin))
    heights = [top - k * length for k in range(1, count + 1)]
    return scene(
        "A chain of links", "Closed links fall into one another and hang: each one link's inner length below the "
        "one that holds it, five of them on one that is fixed. The last one turns at "
        "first.", 4, [1.2, 2.2, 4.2], [0, 1.75, 0], {
            "steel": {"friction": 0.5}, "slate": {"friction": 0.5}
        }, bodies, [
            promise("height", "==", heights[-1], f"link{count}", 0.004),
            promise("height", "==", heights[1], "link2", 0.004),
            weight_energy([(mass, y) for y in heights], 0.002),
            promise("angular_speed", "<", 0.08, f"link{count}")  # friction ends its turning
        ], meshes={"link": mesh}, **laboratory(rollback="event", sweep="none"))
