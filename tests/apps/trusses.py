"""Plane trusses: their statics by the method of joints, and scenes of them in Hooke."""

import math


def solve(rows, right):
    """Solves a square system by elimination with pivots."""
    count = len(rows)
    table = [list(row) + [value] for row, value in zip(rows, right)]
    for i in range(count):
        pivot = max(range(i, count), key=lambda k: abs(table[k][i]))
        if abs(table[pivot][i]) < 1e-9:
            raise ValueError("a mechanism")
        table[i], table[pivot] = table[pivot], table[i]
        for k in range(i + 1, count):
            factor = table[k][i] / table[i][i]
            table[k] = [a - factor * b for a, b in zip(table[k], table[i])]
    result = [0.0] * count
    for i in reversed(range(count)):
        rest = sum(table[i][k] * result[k] for k in range(i + 1, count))
        result[i] = (table[i][count] - rest) / table[i][i]
    return result


class Truss:
    """Nodes by name in the plane z = 0, bars between them, and supports: (node, direction that is held)."""

    def __init__(self, nodes, bars, supports):
        self.nodes, self.bars, self.supports = nodes, bars, supports
        assert len(bars) + len(supports) == 2 * len(nodes), "not statically determinate"

    def length(self, bar):
        return math.dist(self.nodes[bar[0]], self.nodes[bar[1]])

    def forces(self, loads):
        """Force in each bar, tension positive, under the loads by node."""
        names = list(self.nodes)
        row = {name: 2 * i for i, name in enumerate(names)}
        count = 2 * len(names)
        rows = [[0.0] * count for _ in range(count)]
        for column, bar in enumerate(self.bars):
            for here, there in (bar, bar[::-1]):
                for axis in range(2):
                    pull = (self.nodes[there][axis] - self.nodes[here][axis]) / self.length(bar)
                    rows[row[here] + axis][column] = pull
        for i, (name, direction) in enumerate(self.supports):
            for axis in range(2):
                rows[row[name] + axis][len(self.bars) + i] = direction[axis]
        right = [0.0] * count
        for name, load in loads.items():
            for axis in range(2):
                right[row[name] + axis] -= load[axis]
        return dict(zip(self.bars, solve(rows, right)))

    def of_rods(self, node_mass=1.0, **hook):
        """A scene of small bodies at the nodes, which stay in the plane, and distance hooks between them."""
        scene = {"version": 1, "bodies": [], "hooks": []}
        held = {}
        for name, direction in self.supports:
            held.setdefault(name, []).append(direction)
        for name, (x, y) in self.nodes.items():
            free = [not any(abs(direction[axis]) > 0.5 for direction in held.get(name, [])) for axis in range(2)]
            scene["bodies"].append({"name": name, "kind": "dynamic", "mass": node_mass, "collides": False,
                                    "position": [x, y, 0], "shape": {"sphere": {"radius": 0.05}}})
            scene["hooks"].append({"name": "at_" + name, "kind": "six_degrees", "b": name, "anchor": [x, y, 0],
                                   "axis": [1, 0, 0], "second_axis": [0, 1, 0],
                                   "freedoms": [{"locked": not free[0]}, {"locked": not free[1]}] +
                                               4 * [{"locked": True}]})
        for a, b in self.bars:
            scene["hooks"].append({"name": f"{a}_{b}", "kind": "distance", "a": a, "b": b,
                                   "anchor": [*self.nodes[a], 0], "anchor_b": [*self.nodes[b], 0]} | hook)
        return scene

    def of_bars(self, bar_mass=1.0, node_mass=0.1, **hook):
        """A scene of bodies for bars, hinged to small bodies at the nodes."""
        scene = {"version": 1, "bodies": [], "hooks": []}
        for name, (x, y) in self.nodes.items():
            scene["bodies"].append({"name": name, "kind": "dynamic", "mass": node_mass, "collides": False,
                                    "position": [x, y, 0], "shape": {"sphere": {"radius": 0.05}}})
        for bar in self.bars:
            (ax, ay), (bx, by) = self.nodes[bar[0]], self.nodes[bar[1]]
            name = "_".join(bar)
            angle = math.degrees(math.atan2(by - ay, bx - ax))
            scene["bodies"].append({"name": name, "kind": "dynamic", "mass": bar_mass, "collides": False,
                                    "position": [(ax + bx) / 2, (ay + by) / 2, 0],
                                    "rotation": {"axis": [0, 0, 1], "angle_deg": angle},
                                    "shape": {"box": {"half_extents": [self.length(bar) / 2, 0.03, 0.03]}}})
            for node in bar:
                scene["hooks"].append({"name": f"{name}@{node}", "kind": "hinge", "axis": [0, 0, 1], "a": name,
                                       "b": node, "anchor": [*self.nodes[node], 0]} | hook)
        held = {}
        for name, direction in self.supports:
            held.setdefault(name, []).append(direction)
        for name, directions in held.items():
            kind = {"kind": "hinge", "axis": [0, 0, 1]} if len(directions) == 2 else {"kind": "slider",
                                                                                   "axis": [1, 0, 0]}
            scene["hooks"].append({"name": "at_" + name, "b": name, "anchor": [*self.nodes[name], 0]} | kind)
        return scene

    def weights(self, g, bar_mass, node_mass):
        """Loads by node of the weight of nodes and of bars, half of a bar at each of its ends."""
        loads = {name: -g * node_mass for name in self.nodes}
        for bar in self.bars:
            for node in bar:
                loads[node] -= 0.5 * g * bar_mass
        return {name: (0, load) for name, load in loads.items()}


def on_pin_and_roller(left, right):
    return [(left, (1, 0)), (left, (0, 1)), (right, (0, 1))]


def warren(panels=4, panel=1.0, height=1.0, base=2.0):
    """A bridge of equal triangles: 15 bars for four panels."""
    nodes = {f"b{i}": (i * panel, base) for i in range(panels + 1)}
    nodes |= {f"t{i}": ((i + 0.5) * panel, base + height) for i in range(panels)}
    bars = [(f"b{i}", f"b{i + 1}") for i in range(panels)] + [(f"t{i}", f"t{i + 1}") for i in range(panels - 1)]
    for i in range(panels):
        bars += [(f"b{i}", f"t{i}"), (f"t{i}", f"b{i + 1}")]
    return Truss(nodes, bars, on_pin_and_roller("b0", f"b{panels}"))


def pratt(panels=6, panel=3.0, height=4.0):
    """A bridge whose diagonals fall towards the middle, and are in tension."""
    nodes = {f"b{i}": (i * panel, 0.0) for i in range(panels + 1)}
    nodes |= {f"t{i}": (i * panel, height) for i in range(1, panels)}
    bars = [(f"b{i}", f"b{i + 1}") for i in range(panels)] + [(f"t{i}", f"t{i + 1}") for i in range(1, panels - 1)]
    bars += [(f"b{i}", f"t{i}") for i in range(1, panels)] + [("b0", "t1"), (f"t{panels - 1}", f"b{panels}")]
    for i in range(1, panels // 2):
        bars += [(f"t{i}", f"b{i + 1}"), (f"t{panels - i}", f"b{panels - i - 1}")]
    return Truss(nodes, bars, on_pin_and_roller("b0", f"b{panels}"))


def bracket(panels=3, panel=2.0, height=1.5):
    """A cantilever with diagonals, held at a wall by two pins."""
    nodes = {}
    for i in range(panels + 1):
        nodes |= {f"b{i}": (i * panel, 0.0), f"t{i}": (i * panel, height)}
    bars = []
    for i in range(panels):
        bars += [(f"b{i}", f"b{i + 1}"), (f"t{i}", f"t{i + 1}"), (f"t{i}", f"b{i + 1}"),
                 (f"b{i + 1}", f"t{i + 1}")]
    return Truss(nodes, bars, [("b0", (1, 0)), ("b0", (0, 1)), ("t0", (1, 0)), ("t0", (0, 1))])


def fink(span=8.0, height=2.0):
    """A roof of 11 bars on two posts."""
    nodes = {"l": (0.0, 0.0), "r": (span, 0.0), "top": (span / 2, height), "a": (span / 3, 0.0),
             "b": (2 * span / 3, 0.0), "m": (span / 4, height / 2), "n": (3 * span / 4, height / 2)}
    bars = [("l", "a"), ("a", "b"), ("b", "r"), ("l", "m"), ("m", "top"), ("top", "n"), ("n", "r"), ("m", "a"),
            ("a", "top"), ("top", "b"), ("b", "n")]
    return Truss(nodes, bars, on_pin_and_roller("l", "r"))
