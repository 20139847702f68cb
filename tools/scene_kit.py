"""What make_scenes.py is written with: vectors, meshes, random numbers, and the words of the scene format."""
import json
import math
import re

WIDTH = 110  # columns of a line
G = 9.81
DT = 1 / 60

PALETTE = {  # linear
    "ground": {"color": [0.30, 0.29, 0.27], "shininess": 4},
    "crate": {"color": [1, 1, 1], "texture": "models/crate.png", "shininess": 10},
    "oak": {"color": [0.30, 0.18, 0.09], "shininess": 20},
    "sand": {"color": [0.52, 0.41, 0.26], "shininess": 8},
    "clay": {"color": [0.42, 0.17, 0.10], "shininess": 10},
    "moss": {"color": [0.16, 0.24, 0.12], "shininess": 10},
    "slate": {"color": [0.10, 0.16, 0.25], "shininess": 30},
    "ivory": {"color": [0.72, 0.67, 0.55], "roughness": 0.3},
    "steel": {"color": [0.56, 0.57, 0.58], "metalness": 1, "roughness": 0.3},
    "rose": {"color": [0.60, 0.10, 0.14], "shininess": 90},
    "felt": {"color": [0.50, 0.62, 0.06], "roughness": 1, "sheen": 0.7},
    "silk": {"color": [0.62, 0.10, 0.20], "roughness": 0.4, "sheen": 0.5},
    "rubber": {"color": [0.03, 0.04, 0.06], "shininess": 60},
    "trampoline": {"color": [0.05, 0.09, 0.30], "shininess": 20},
    "cable": {"color": [0.30, 0.30, 0.31], "metalness": 1, "roughness": 0.45},
    "dark_hair": {"color": [0.09, 0.04, 0.018], "roughness": 0.4, "hair": True},
    "brown_hair": {"color": [0.15, 0.07, 0.03], "roughness": 0.4, "hair": True},
    "skin": {"color": [0.62, 0.40, 0.30], "roughness": 0.6},
    "hemp": {"color": [0.45, 0.33, 0.18], "shininess": 4},
    "glass": {"color": [0.62, 0.72, 0.78], "roughness": 0.04, "transmission": 0.9},
}
# Full hair on a head whose skin it hides.
HAIR = {"skin": {"color": [0.09, 0.05, 0.03], "roughness": 0.8}, "dark_hair": {"color": [0.13, 0.06, 0.025]},
        "brown_hair": {"color": [0.22, 0.11, 0.045]}}
TONES = ["sand", "clay", "moss", "slate"]  # of many like things

# ---- Text -------------------------------------------------------------------------------------------------


def number(value):
    """Rounded to a micrometer or a part in 10^7, without an exponent where it can be."""
    if isinstance(value, int):
        return value
    short = float(f"{value:.7g}") if abs(value) >= 10 or 1e-9 < abs(value) < 5e-7 else round(value, 6)
    return int(short) if short == int(short) and abs(short) < 1e15 else short


def rounded(value):
    if isinstance(value, float):
        return number(value)
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    return [rounded(one) for one in value] if isinstance(value, (list, tuple)) else value


def wrapped(text, indent):
    """Breaks a line of JSON after the commas that are not in strings."""
    lines, line = [], ""
    for word in re.findall(r'(?! )(?:"(?:[^"\\]|\\.)*"|[^",])+', text):
        candidate = line + ", " + word if line else word
        if line and len(candidate) > WIDTH - 1 - indent:
            lines.append(line + ",")
            candidate = word
        line = candidate
    return ("\n" + " " * indent).join(lines + [line])


def text_of(scene):
    """One line for each object of a list and for each name."""
    entries = []
    for key, value in rounded(scene).items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            items = [wrapped(json.dumps(one), 5) for one in value]
            entries.append(f'"{key}": [\n    ' + ",\n    ".join(items) + "\n  ]")
        elif key in ("materials", "meshes"):
            items = [wrapped(f'"{name}": {json.dumps(one)}', 5) for name, one in value.items()]
            entries.append(f'"{key}": {{\n    ' + ",\n    ".join(items) + "\n  }")
        else:
            entries.append(wrapped(f'"{key}": {json.dumps(value)}', 4))
    return "{\n  // Written by tools/make_scenes.py, which has the formulas.\n  " + ",\n  ".join(
        entries) + "\n}\n"


# ---- Numbers ----------------------------------------------------------------------------------------------


class Random:
    """A linear congruential generator (Numerical Recipes), of which the upper 24 bits are used."""

    def __init__(self, seed=12345):
        self.state = seed

    def unit(self):
        self.state = (1664525 * self.state + 1013904223) % 2**32
        return (self.state >> 8) / 2**24

    def jitter(self, size):
        return size * (2 * self.unit() - 1)

    def rotation(self):
        """Uniform over all rotations (Shoemake 1992)."""
        u, a, b = self.unit(), 2 * math.pi * self.unit(), 2 * math.pi * self.unit()
        p, q = math.sqrt(1 - u), math.sqrt(u)
        return [p * math.sin(a), p * math.cos(a), q * math.sin(b), q * math.cos(b)]


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def scaled(s, a):
    return [s * x for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turn(axis, radians):
    """The quaternion of a turn about a unit axis."""
    return [*scaled(math.sin(radians / 2), axis), math.cos(radians / 2)]


def product(p, q):
    v = add(add(scaled(p[3], q[:3]), scaled(q[3], p[:3])), cross(p[:3], q[:3]))
    return [*v, p[3] * q[3] - dot(p[:3], q[:3])]


def rotated(q, v):
    return product(product(q, [*v, 0]), [-q[0], -q[1], -q[2], q[3]])[:3]


X, Y, Z = [1, 0, 0], [0, 1, 0], [0, 0, 1]

# ---- Meshes -----------------------------------------------------------------------------------------------


def hull_of(points):
    """Triangles of the convex hull, by trying all triples: for a few dozen points in general position."""
    triangles, volume = [], 0.0
    count = len(points)
    for i in range(count):
        for j in range(i + 1, count):
            for k in range(j + 1, count):
                normal = cross(add(points[j], scaled(-1, points[i])), add(points[k], scaled(-1, points[i])))
                sides = [dot(normal, add(p, scaled(-1, points[i]))) for p in points]
                if max(sides) < 1e-9:
                    triangles.append([i, j, k])
                elif min(sides) > -1e-9:
                    triangles.append([i, k, j])
                else:
                    continue
                volume += abs(dot(points[i], cross(points[j], points[k]))) / 6  # the origin is inside
    return {"vertices": points, "triangles": triangles}, volume


def fibonacci_points(count, radius):
    """Evenly on a sphere, along a spiral of the golden angle."""
    points = []
    for i in range(count):
        y = 1 - 2 * (i + 0.5) / count
        angle = math.pi * (3 - math.sqrt(5)) * i
        points.append(
            scaled(radius,
                   [math.sqrt(1 - y * y) * math.cos(angle), y,
                    math.sqrt(1 - y * y) * math.sin(angle)]))
    return points


def prism(outline, half):
    """A polygon in the x-y plane, counter-clockwise, from z = -half to half."""
    n = len(outline)
    triangles = [[n, n + k, n + k + 1] for k in range(1, n - 1)] + [[0, k + 1, k] for k in range(1, n - 1)]
    for k in range(n):
        after = (k + 1) % n
        triangles += [[k, after, n + after], [k, n + after, n + k]]
    return {"vertices": [[x, y, z] for z in (-half, half) for x, y in outline], "triangles": triangles}


def sector(inner, outer, degrees, half):
    """A piece of a ring about z, its middle at +x."""
    a = math.radians(degrees / 2)
    return prism([[inner * math.cos(a), -inner * math.sin(a)], [outer * math.cos(a), -outer * math.sin(a)],
                  [outer * math.cos(a), outer * math.sin(a)], [inner * math.cos(a), inner * math.sin(a)]],
                 half)


def solid_moments(mesh):
    """Volume and center of a closed mesh."""
    volume, center = 0.0, [0, 0, 0]
    for i, j, k in mesh["triangles"]:
        a, b, c = (mesh["vertices"][n] for n in (i, j, k))
        part = dot(a, cross(b, c)) / 6
        volume += part
        center = add(center, scaled(part / 4, add(a, add(b, c))))
    return volume, scaled(1 / volume, center)


def solid_mass(mesh, density):
    return density * solid_moments(mesh)[0]


# ---- Parts of scenes --------------------------------------------------------------------------------------


def scene(title, description, seconds, eye, target, materials, bodies, expect, world=None, **more):
    made = {
        "$schema": "schema.json",
        "version": 1,
        "title": title,
        "description": description,
        "seconds": seconds
    }
    if world:
        made["world"] = world
    made |= {key: more.pop(key) for key in ("meshes",) if key in more}
    made["materials"] = {name: PALETTE[name] | changes for name, changes in materials.items()}
    hooks = {"hooks": more.pop("hooks")} if "hooks" in more else {}
    camera = {"eye": eye, "target": target} | ({"fov_deg": more.pop("fov_deg")} if "fov_deg" in more else {})
    return made | more | {"bodies": bodies} | hooks | {"camera": camera, "expect": expect}


def spot(position, target, color, intensity, inner_deg, outer_deg):
    """A light that shines from one place to another."""
    return {"kind": "spot", "position": position, "direction": add(target, scaled(-1, position)), "color": color,
            "intensity": intensity, "inner_deg": inner_deg, "outer_deg": outer_deg}


def low_sun(direction, intensity=1.4):
    """Warm light of a low sun, whose shadows are long."""
    return {"sky": {"brightness": 0.85, "sun": intensity, "sun_direction": direction, "sun_color": [1, 0.82, 0.6]}}


def box(x, y, z):
    return {"box": {"half_extents": [x, y, z]}}


def body(name, material, shape, position=None, kind="dynamic", **more):
    made = {"name": name, "material": material, "kind": kind, "shape": shape}
    if kind == "static":
        del made["kind"]
    return made | ({"position": position} if position else {}) | more


def hook(name, kind, b, anchor, a=None, **more):
    """Holds b to a, or to the world."""
    return {"name": name, "kind": kind} | ({"a": a} if a else {}) | {"b": b, "anchor": anchor} | more


def ground(material="ground"):
    return body("ground", material, {"half_space": {}}, kind="static")


def slab(x, z):
    """Ground as a box whose top is at y = 0."""
    return body("ground", "ground", box(x, 1, z), [0, -1, 0], kind="static")


def promise(quantity, op, value, of=None, tolerance=None, at_step=None):
    made = {"quantity": quantity} | ({"of": of} if of else {}) | {"op": op, "value": value}
    made |= {"tolerance": tolerance} if tolerance is not None else {}
    return made | ({"at_step": at_step} if at_step is not None else {})


def at_point(quantity, op, value, of, point, tolerance=None, at_step=None):
    return promise(quantity, op, value, of, tolerance, at_step) | {"point": point}


def fall(of, height, step, gravity=G, speed=0.0):
    """Free fall, y = y0 + v t - g t^2 / 2, while nothing is in the way; 1 % of the way is for the scheme."""
    t = step * DT
    drop = gravity * t * t / 2
    return promise("height", "==", height + speed * t - drop, of, 0.01 * drop, step)


def weight_energy(masses_and_heights, tolerance, gravity=G):
    """The potential energy, the sum of m g y, at the end."""
    return promise("potential_energy", "within", gravity * sum(m * y for m, y in masses_and_heights), None,
                   tolerance)
