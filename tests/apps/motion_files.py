"""Reads the files that `hooke export` writes, by the rules of their formats and nothing of Hooke's."""

import csv
import json
import math
import re
import struct


class Glb:
    """A .glb file: names of its roots, and their vertices in the world at a time."""

    SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
    CODES = {5126: "f", 5125: "I", 5123: "H"}

    def __init__(self, path):
        content = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size = struct.unpack_from("<I", content, 12)[0]
        self.json = json.loads(content[20:20 + size])
        self.binary = content[28 + size:]
        self.read = {}

    def accessor(self, number):
        if number not in self.read:
            accessor = self.json["accessors"][number]
            width = self.SIZES[accessor["type"]]
            code = self.CODES[accessor["componentType"]]
            offset = self.json["bufferViews"][accessor["bufferView"]]["byteOffset"]
            numbers = struct.unpack_from(f"<{accessor['count'] * width}{code}", self.binary, offset)
            self.read[number] = [numbers[i:i + width] for i in range(0, len(numbers), width)]
        return self.read[number]

    def roots(self):
        nodes = self.json["nodes"]  # Lights have no vertices.
        return {nodes[i]["name"]: i for i in self.json["scenes"][0]["nodes"] if "extensions" not in nodes[i]}

    def channels(self, node):
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                if channel["target"]["node"] == node:
                    yield channel["target"]["path"], animation["samplers"][channel["sampler"]]

    def value(self, sampler, time, path):
        """The output of a sampler at a time, with as many numbers as there are for each key."""
        times = [t[0] for t in self.accessor(sampler["input"])]
        numbers = [x for item in self.accessor(sampler["output"]) for x in item]
        width = len(numbers) // len(times)
        values = [numbers[i * width:(i + 1) * width] for i in range(len(times))]
        if time <= times[0]:
            return values[0]
        if time >= times[-1]:
            return values[-1]
        last = max(i for i, t in enumerate(times) if t <= time)
        if sampler["interpolation"] == "STEP":
            return values[last]
        part = (time - times[last]) / (times[last + 1] - times[last])
        a, b = values[last], values[last + 1]
        return slerp(a, b, part) if path == "rotation" else [x + part * (y - x) for x, y in zip(a, b)]

    def vertices(self, node, time):
        """Vertices of a node and of those below it; none where its scale is zero."""
        content = self.json["nodes"][node]
        pose = {"translation": content.get("translation", [0, 0, 0]), "rotation": content.get("rotation", [0, 0, 0, 1]),
                "scale": [1, 1, 1], "weights": None}
        for path, sampler in self.channels(node):
            pose[path] = self.value(sampler, time, path)
        if pose["scale"] == [0, 0, 0]:
            return []
        points = self.mesh(content["mesh"], pose["weights"]) if "mesh" in content else []
        for child in content.get("children", []):
            points += self.vertices(child, time)
        return [add(pose["translation"], rotate(pose["rotation"], p)) for p in points]

    def mesh(self, number, weights):
        primitive = self.json["meshes"][number]["primitives"][0]
        points = [list(p) for p in self.accessor(primitive["attributes"]["POSITION"])]
        for weight, target in zip(weights or [], primitive.get("targets", [])):
            if weight != 0:
                for p, shift in zip(points, self.accessor(target["POSITION"])):
                    for i in range(3):
                        p[i] += weight * shift[i]
        return points


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rotate(q, v):
    t = [2 * x for x in cross(q[:3], v)]
    return [x + q[3] * y + z for x, y, z in zip(v, t, cross(q[:3], t))]


def slerp(a, b, part):
    """As the specification has it: the short way, by whatever sign that takes."""
    cosine = sum(x * y for x, y in zip(a, b))
    sign = -1 if cosine < 0 else 1
    angle = math.acos(min(1, abs(cosine)))
    if angle < 1e-6:
        return [x + part * (sign * y - x) for x, y in zip(a, b)]
    return [(math.sin((1 - part) * angle) * x + sign * math.sin(part * angle) * y) / math.sin(angle)
            for x, y in zip(a, b)]


def obj(path):
    """Vertices of each object of an .obj file."""
    objects, vertices = {}, None
    for line in path.read_text().splitlines():
        word, _, rest = line.partition(" ")
        if word == "o":
            vertices = objects.setdefault(rest, [])
        elif word == "v":
            vertices.append([float(x) for x in rest.split()])
    return objects


def table(path):
    """Rows of a .csv file by object, point and frame."""
    with open(path, encoding="utf-8", newline="") as file:
        return {(row["object"], row["point"], int(row["frame"])): row for row in csv.DictReader(file)}


def point_cache(path):
    """Frames of a .pc2 file, each a list of vertices."""
    content = path.read_bytes()
    mark, version, points, start, step, frames = struct.unpack_from("<12siiffi", content)
    assert (mark, version, start, step) == (b"POINTCACHE2\0", 1, 0, 1)
    assert len(content) == 32 + 12 * points * frames
    numbers = struct.unpack_from(f"<{3 * points * frames}f", content, 32)
    vertices = [numbers[i:i + 3] for i in range(0, len(numbers), 3)]
    return [vertices[i * points:(i + 1) * points] for i in range(frames)]


class Usda:
    """The prims of a .usda file: for each path its type, its metadata and its attributes as text."""

    def __init__(self, path):
        self.prims, self.types = {}, {}
        stack, samples, pending = [], None, None
        for line in path.read_text(encoding="utf-8").splitlines():
            text = line.strip()
            begin = re.match(r'(?:def|class) ?(\w*) "(\w+)"', text)
            if begin:
                stack.append(begin[2])
                self.types["/" + "/".join(stack)] = begin[1]
                pending = self.prims.setdefault("/" + "/".join(stack), {})
            elif samples is not None and text != "}":
                frame, _, value = text.rstrip(",").partition(": ")
                samples[int(frame)] = value
            elif text == "}":
                if samples is None:
                    stack.pop()
                samples = None
            elif text.endswith(".timeSamples = {"):
                samples = self.here(stack).setdefault(text.split(".timeSamples")[0].split()[-1], {})
            elif " = " in text and stack:
                name, _, value = text.partition(" = ")
                self.here(stack)[name.split()[-1]] = value

    def here(self, stack):
        return self.prims["/" + "/".join(stack)]

    @staticmethod
    def numbers(text):
        return [float(x) for x in re.findall(r"-?[\d.]+(?:e[+-]?\d+)?", text)]

    def value(self, path, attribute, frame):
        """Numbers of an attribute at a frame, blended along straight lines."""
        value = self.prims[path][attribute]
        if isinstance(value, str):
            return self.numbers(value)
        keys = sorted(value)
        before = max((k for k in keys if k <= frame), default=keys[0])
        after = min((k for k in keys if k >= frame), default=keys[-1])
        a, b = self.numbers(value[before]), self.numbers(value[after])
        part = 0 if after == before else (frame - before) / (after - before)
        return [x + part * (y - x) for x, y in zip(a, b)]

    def vectors(self, path, attribute, frame):
        numbers = self.value(path, attribute, frame)
        return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]
