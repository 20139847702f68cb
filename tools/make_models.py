#!/usr/bin/env python3
"""Writes Hooke's own models, scenes/models/*.3ds and their images, all in meters and z up.

usage: make_models.py [--check]

With --check it writes nothing and fails if a file there differs. The same bytes each time: no clock, no random numbers, coordinates rounded before they are packed.
"""
import math
import pathlib
import struct
import sys
import zlib

SEGMENTS = 20  # of the lantern, around its axis


# ---- .3ds -------------------------------------------------------------------------------------------------

def chunk(kind, *contents):
    content = b"".join(contents)
    return struct.pack("<HI", kind, 6 + len(content)) + content


def text(string):
    return string.encode("ascii") + b"\0"


def color(kind, rgb):
    return chunk(kind, chunk(0x0011, bytes(rgb)))


def percent(kind, value):
    return chunk(kind, chunk(0x0030, struct.pack("<H", value)))


def material(name, rgb, shininess, image=None, transparency=0):
    parts = [chunk(0xA000, text(name)), color(0xA010, rgb), color(0xA020, rgb), color(0xA030, (60, 60, 60)),
             percent(0xA040, shininess), percent(0xA041, 50),
             percent(0xA050, transparency),
             chunk(0xA100, struct.pack("<H", 3))]
    if image:
        parts.append(chunk(0xA200, chunk(0x0030, struct.pack("<H", 100)), chunk(0xA300, text(image))))
    return chunk(0xAFFF, *parts)


class Mesh:
    """Triangles with a material and smoothing groups each; corners with a position and an image coordinate."""

    def __init__(self):
        self.corners, self.faces, self.index_of = [], [], {}

    def corner(self, position, uv):
        key = tuple(round(v, 5) + 0.0 for v in (*position, *uv))
        if key not in self.index_of:
            self.index_of[key] = len(self.corners)
            self.corners.append(key)
        return self.index_of[key]

    def triangle(self, corners, material_name, group):
        indices = [self.corner(*c) for c in corners]
        if len({self.corners[i][:3] for i in indices}) == 3:
            self.faces.append((indices, material_name, group))

    def quad(self, corners, material_name, group):
        a, b, c, d = corners
        self.triangle((a, b, c), material_name, group)
        self.triangle((a, c, d), material_name, group)

    def chunk(self, name):
        count = struct.pack("<H", len(self.corners))
        positions = b"".join(struct.pack("<3f", *c[:3]) for c in self.corners)
        uvs = b"".join(struct.pack("<2f", *c[3:]) for c in self.corners)
        faces = b"".join(struct.pack("<4H", *indices, 7) for indices, _, _ in self.faces)
        lists = []
        for used in sorted({m for _, m, _ in self.faces}):
            members = [i for i, (_, m, _) in enumerate(self.faces) if m == used]
            lists.append(chunk(0x4130, text(used), struct.pack(f"<H{len(members)}H", len(members), *members)))
        groups = struct.pack(f"<{len(self.faces)}I", *(group for _, _, group in self.faces))
        return chunk(0x4000, text(name), chunk(
            0x4100, chunk(0x4110, count, positions), chunk(0x4140, count, uvs),
            chunk(0x4160, struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)),
            chunk(0x4120, struct.pack("<H", len(self.faces)), faces, *lists, chunk(0x4150, groups))))


def file_3ds(materials, name, mesh):
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)), chunk(
        0x3D3D, chunk(0x3D3E, struct.pack("<I", 3)), *materials, chunk(0x0100, struct.pack("<f", 1)),
        mesh.chunk(name)))


# ---- .png -------------------------------------------------------------------------------------------------

def file_png(width, height, pixel):
    """`pixel(u, v)` gives 0-1 colors; u to the right, v up, both 0-1."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rgb = pixel((x + 0.5) / width, 1 - (y + 0.5) / height)
            # Steps of 4 hide the last digits of the machine's sine, and pack better.
            rows += bytes(min(255, max(0, int(64 * c + 0.5) * 4)) for c in rgb)

    def block(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    return (b"\x89PNG\r\n\x1a\n" + block(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0))
            + block(b"IDAT", zlib.compress(bytes(rows), 9)) + block(b"IEND", b""))


def mix(a, b, t):
    t = min(1.0, max(0.0, t))
    return tuple(x + (y - x) * t for x, y in zip(a, b))


# ---- lantern ----------------------------------------------------------------------------------------------

BODY_RADIUS, BODY_HALF, COLLAR = 0.19, 0.165, 0.085
BODY_RINGS = 10


def lantern_profile():
    """(radius, height, material, smoothing group) from the tip of the tassel to the lid; the last two belong
    to the band below the point."""
    points = [(0.0, -0.300, None, 0), (0.044, -0.296, "tassel", 1), (0.027, -0.236, "tassel", 2),
              (0.036, -0.220, "gold", 4), (0.024, -0.204, "gold", 4), (COLLAR, -0.195, "wood", 8),
              (COLLAR, -BODY_HALF, "wood", 16)]
    for ring in range(1, BODY_RINGS):
        angle = math.pi * (ring / BODY_RINGS - 0.5)
        bulge = math.cos(angle) ** 0.8
        pleat = 1.0 if ring % 2 == 0 else 0.965  # bamboo hoops push the paper out
        points.append(((COLLAR + (BODY_RADIUS - COLLAR) * bulge) * pleat, BODY_HALF * math.sin(angle),
                       "paper", 32))
    return points + [(COLLAR, BODY_HALF, "paper", 32), (COLLAR, 0.195, "wood", 64), (0.068, 0.195, "wood", 128),
                     (0.068, 0.178, "wood", 256), (0.0, 0.178, "wood", 512)]


def lantern():
    mesh, profile = Mesh(), lantern_profile()

    def corner(point, segment, is_paper):
        radius, height = point[0], point[1]
        angle = 2 * math.pi * (segment % SEGMENTS) / SEGMENTS
        position = (radius * math.cos(angle), radius * math.sin(angle), height)
        uv = (segment / SEGMENTS, 0.5 + 0.5 * height / BODY_HALF) if is_paper else (0.0, 0.0)
        return position, uv

    for low, high in zip(profile, profile[1:]):
        is_paper = high[2] == "paper"
        for s in range(SEGMENTS):
            mesh.quad((corner(low, s, is_paper), corner(low, s + 1, is_paper), corner(high, s + 1, is_paper),
                       corner(high, s, is_paper)), high[2], high[3])
    materials = [material("paper", (255, 214, 150), 8, "lantern.png"), material("wood", (62, 30, 18), 30),
                 material("gold", (214, 166, 62), 60), material("tassel", (178, 26, 30), 6)]
    return file_3ds(materials, "lantern", mesh)


def lantern_pixel(u, v):
    glow = 1 - (2 * v - 1) ** 2
    rgb = mix((0.80, 0.40, 0.15), (1.0, 0.90, 0.66), 0.25 + 0.75 * glow)
    fiber = 0.5 + 0.5 * math.sin(90 * u + 7 * math.sin(23 * v)) * math.sin(70 * v + 5 * math.sin(31 * u))
    rgb = mix(rgb, (0.93, 0.72, 0.42), 0.18 * fiber)
    hoop = abs((0.5 + math.asin(max(-1, min(1, 2 * v - 1))) / math.pi) * BODY_RINGS / 2 % 1.0 - 0.5)
    rgb = mix(rgb, (0.58, 0.34, 0.14), 0.55 * (1 - (0.5 - hoop) / 0.035) if hoop > 0.465 else 0.0)
    # Four blossoms, and a twig through each.
    x, y = ((u * 4) % 1.0 - 0.5) * 0.30, (v - 0.5) * 0.52
    twig = abs(y + 0.035 - 0.6 * x * x * 10 - 0.012 * math.sin(60 * x))
    if abs(x) < 0.12:
        rgb = mix(rgb, (0.30, 0.15, 0.10), (0.006 - twig) / 0.002)
    radius, angle = math.hypot(x, y), math.atan2(y, x)
    petal = 0.062 * (0.72 + 0.28 * abs(math.cos(2.5 * (angle - math.pi / 2))))
    rgb = mix(rgb, (0.74, 0.07, 0.10), (petal - radius) / 0.003)
    if radius < petal:
        rgb = mix(rgb, (0.95, 0.36, 0.34), (radius / petal - 0.35) * 0.6)
    rgb = mix(rgb, (0.98, 0.80, 0.30), (0.015 - radius) / 0.003)
    edge = min(v, 1 - v)
    rgb = mix(rgb, (0.66, 0.08, 0.09), (0.085 - edge) / 0.004)
    return mix(rgb, (0.90, 0.70, 0.26), (0.010 - abs(edge - 0.062)) / 0.004)


# ---- pudding ----------------------------------------------------------------------------------------------

LOBES, LOBE_SEGMENTS = 16, 5


def pudding():
    """Jelly turned out of a square mold with flutes, 0.4 m high and 0.9 m wide; it fills a box of that size."""
    mesh = Mesh()
    profile = [(0.0, 0.0, 0, 1), (0.445, 0.0, 0.7, 1), (0.455, 0.03, 1, 2), (0.45, 0.1, 1, 2), (0.44, 0.18, 1, 2),
               (0.43, 0.26, 1, 2), (0.415, 0.33, 0.8, 2), (0.39, 0.375, 0.5, 2), (0.35, 0.398, 0.2, 2),
               (0.29, 0.404, 0, 2), (0.0, 0.396, 0, 2)]  # half width, height, depth of the flutes, smoothing group

    def corner(point, segment):
        half, height, depth, _ = point
        angle = 2 * math.pi * (segment % (LOBES * LOBE_SEGMENTS)) / (LOBES * LOBE_SEGMENTS)
        x, y = math.cos(angle), math.sin(angle)
        radius = half * (x ** 4 + y ** 4) ** -0.25  # a square with round corners
        radius *= 1 + 0.06 * depth * (abs(math.cos(0.5 * LOBES * angle)) ** 0.7 - 0.7)
        return (radius * x, radius * y, height), (0.0, 0.0)

    for low, high in zip(profile, profile[1:]):
        for s in range(LOBES * LOBE_SEGMENTS):
            mesh.quad((corner(low, s), corner(low, s + 1), corner(high, s + 1), corner(high, s)), "jelly", high[3])
    return file_3ds([material("jelly", (178, 18, 20), 85, transparency=22)], "pudding", mesh)


# ---- crate ------------------------------------------------------------------------------------------------

CRATE_HALF, CRATE_FRAME, CRATE_DEPTH = 0.25, 0.055, 0.018


def crate():
    """A box whose six faces are panels set back in a frame."""
    mesh, h, f = Mesh(), CRATE_HALF, CRATE_HALF - CRATE_FRAME
    axes = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    for axis in range(3):
        for sign in (1, -1):
            # right x up is outward; on the sides up is z, so that planks stand the same way
            n = tuple(sign * c for c in axes[axis])
            up = axes[2] if axis < 2 else axes[1]
            right = (up[1] * n[2] - up[2] * n[1], up[2] * n[0] - up[0] * n[2], up[0] * n[1] - up[1] * n[0])

            def corner(x, y, depth):
                position = tuple(x * r + y * u + depth * o for r, u, o in zip(right, up, n))
                return position, (0.5 + 0.5 * x / h, 0.5 + 0.5 * y / h)

            square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            group = 1 << (2 * axis + (sign < 0))
            mesh.quad([corner(x * f, y * f, h - CRATE_DEPTH) for x, y in square], "planks", group)
            for (x0, y0), (x1, y1) in zip(square, square[1:] + square[:1]):
                mesh.quad((corner(x0 * h, y0 * h, h), corner(x1 * h, y1 * h, h), corner(x1 * f, y1 * f, h),
                           corner(x0 * f, y0 * f, h)), "planks", group)
                mesh.quad((corner(x0 * f, y0 * f, h), corner(x1 * f, y1 * f, h),
                           corner(x1 * f, y1 * f, h - CRATE_DEPTH), corner(x0 * f, y0 * f, h - CRATE_DEPTH)),
                          "planks", 64 << (square.index((x0, y0))))
    return file_3ds([material("planks", (176, 122, 70), 12, "crate.png")], "crate", mesh)


def crate_pixel(u, v):
    border = CRATE_FRAME / (2 * CRATE_HALF)
    edge_x, edge_y = min(u, 1 - u), min(v, 1 - v)
    in_frame = min(edge_x, edge_y) < border
    upright = edge_x < border and (edge_x < edge_y or edge_y >= border) if in_frame else True
    along, across = (v, u) if upright else (u, v)
    plank = int((u - border) / (1 - 2 * border) * 5) if not in_frame else 7 + 2 * upright + (across > 0.5)
    wave = 3 * math.sin(4 * along + 2.1 * plank) + 1.5 * math.sin(9 * along + 1.3 * plank)
    grain = 0.5 + 0.5 * math.sin(150 * across + wave + 5 * math.sin(1.7 * plank))
    fine = 0.5 + 0.5 * math.sin(420 * across + 2 * wave)
    rgb = mix((0.47, 0.30, 0.16), (0.74, 0.53, 0.31), 0.35 + 0.4 * grain + 0.15 * fine)
    rgb = mix(rgb, (0.62, 0.40, 0.22), 0.35 * (0.5 + 0.5 * math.sin(2.9 * plank)))
    if in_frame:
        rgb = mix(rgb, (0.36, 0.22, 0.12), 0.35)
        corner_x, corner_y = abs(edge_x - border / 2), abs(edge_y - border / 2)
        if edge_x < border and edge_y < border:  # a nail
            rgb = mix(rgb, (0.16, 0.15, 0.15), (0.013 - math.hypot(corner_x, corner_y)) / 0.004)
        if abs(edge_x - edge_y) < 0.003 and edge_x < border:
            rgb = mix(rgb, (0.15, 0.09, 0.05), 0.7)
        return rgb
    gap = abs(((u - border) / (1 - 2 * border) * 5) % 1.0 - 0.5)
    rgb = mix(rgb, (0.14, 0.08, 0.04), (gap - 0.475) / 0.015)
    return mix(rgb, (0.20, 0.12, 0.07), 0.6 - (min(edge_x, edge_y) - border) / 0.03)


def main():
    folder = pathlib.Path(__file__).resolve().parent.parent / "scenes/models"
    files = {"lantern.3ds": lantern(), "lantern.png": file_png(512, 256, lantern_pixel),
             "pudding.3ds": pudding(), "crate.3ds": crate(), "crate.png": file_png(256, 256, crate_pixel)}
    if sys.argv[1:] == ["--check"]:
        stale = [name for name, content in files.items()
                 if not (folder / name).is_file() or (folder / name).read_bytes() != content]
        if stale:
            sys.exit(f"{', '.join(stale)}: not what tools/make_models.py writes")
        return
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


if __name__ == "__main__":
    main()
