"""Where made models come to rest: poses_test.py PROGRAM (Poses | LongPoses).

Each pose must outlive a disturbance of 1 mm, drops must be counted to the last and repeat to the bit, with any number
of workers, and poses that are each other's image must be as frequent. The exit code is 1 if one is not so.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""
DISTURBANCE = 0.001  # [m]


def prism(outline, caps, half):
    """An outline in the x-y plane, counter-clockwise, from z = -half to half; `caps` are convex faces of it."""
    n = len(outline)
    points = [(x, y, z) for z in (-half, half) for x, y in outline]
    faces = [tuple(reversed(cap)) for cap in caps] + [tuple(k + n for k in cap) for cap in caps]
    faces += [(k, (k + 1) % n, (k + 1) % n + n, k + n) for k in range(n)]
    return points, faces


def ring(radius, sides, turned=0.0):
    return [(radius * math.cos(2 * math.pi * k / sides + turned), radius * math.sin(2 * math.pi * k / sides + turned))
            for k in range(sides)]


def scaled(size, outline):
    return [(size * x, size * y) for x, y in outline]


def round_prism(radius, half, sides):
    return prism(ring(radius, sides), [tuple(range(sides))], half)


def turned_about_y(profile, sides):
    """A solid of revolution. The profile (radius, height) goes from the axis below by the outside to the axis above."""
    points = [(0, profile[0][1], 0)]
    for radius, height in profile[1:-1]:
        points += [(x, height, -z) for x, z in ring(radius, sides)]
    points.append((0, profile[-1][1], 0))
    last = len(points) - 1
    faces = []
    for k in range(sides):
        after = (k + 1) % sides
        faces.append((0, 1 + after, 1 + k))
        for row in range(len(profile) - 3):
            low, high = 1 + row * sides, 1 + (row + 1) * sides
            faces += [(low + k, low + after, high + after), (low + k, high + after, high + k)]
        top = last - sides
        faces.append((top + k, top + after, last))
    return points, faces


def nut():
    """A hexagonal nut, 16 cm across its flats, with a hole of six sides."""
    outer, inner, half = ring(0.08 / math.cos(math.pi / 6), 6), ring(0.045, 6), 0.03
    points = [(x, y, z) for z in (-half, half) for ring_of in (outer, inner) for x, y in ring_of]
    faces = []
    for k in range(6):
        after = (k + 1) % 6
        faces += [(k, after, after + 12, k + 12), (k + 6, k + 18, after + 18, after + 6),
                  (k + 12, after + 12, after + 18, k + 18), (k, k + 6, after + 6, after)]
    return points, faces


MODELS = {
    "box": lambda: prism([(0, 0), (0.05, 0), (0.05, 0.1), (0, 0.1)], [(0, 1, 2, 3)], 0.075),
    "tetrahedron": lambda: ([(0.05, 0.05, 0.05), (0.05, -0.05, -0.05), (-0.05, 0.05, -0.05), (-0.05, -0.05, 0.05)],
                            [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]),
    "cylinder": lambda: round_prism(0.04, 0.05, 24),
    "cone": lambda: turned_about_y([(0, 0), (0.05, 0), (0, 0.1)], 24),
    "angle": lambda: prism(scaled(0.04, [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]),
                           [(0, 1, 2, 3), (0, 3, 4, 5)], 0.05),
    "tee": lambda: prism(scaled(0.04, [(-0.5, 0), (0.5, 0), (0.5, 2), (1.5, 2), (1.5, 3), (-1.5, 3), (-1.5, 2),
                                       (-0.5, 2)]),
                         [(0, 1, 2, 7), (7, 2, 4, 5), (2, 3, 4), (7, 5, 6)], 0.03),
    "wedge": lambda: prism([(0, 0), (0.12, 0), (0, 0.06)], [(0, 1, 2)], 0.04),
    "nut": nut,
    "bottle": lambda: turned_about_y([(0, 0), (0.035, 0), (0.035, 0.12), (0.014, 0.16), (0.014, 0.2), (0, 0.2)], 16),
    "bowl": lambda: turned_about_y([(0, 0), (0.045, 0), (0.07, 0.035), (0.085, 0.08), (0.077, 0.08), (0.062, 0.04),
                                    (0.037, 0.01), (0, 0.01)], 10),
}


def write(path, model):
    points, faces = model
    path.write_text("".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points) +
                    "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces))


def images(poses):
    """Groups of poses that are each other's image by the model's symmetry: lying as high and tipping as easily."""
    groups = []
    for pose in poses:
        figures = [pose[key] for key in ("probability", "height", "margin", "tip_angle")]
        for group in groups:
            first = [group[0][key] for key in ("probability", "height", "margin", "tip_angle")]
            if all(math.isclose(a, b, rel_tol=1e-4) for a, b in zip(figures, first)):
                group.append(pose)
                break
        else:
            groups.append([pose])
    return groups


class Trials(unittest.TestCase):
    drops = 100

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hooke_poses_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def settle(self, name, *words):
        done = subprocess.run([PROGRAM, "settle", f"{name}.obj", "--json", "-", *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True, check=False, timeout=1500)
        self.assertEqual((done.returncode, done.stderr), (0, ""), name)
        return done.stdout

    def try_model(self, name):
        write(self.folder / f"{name}.obj", MODELS[name]())
        began = time.monotonic()
        out = self.settle(name, "--drops", self.drops, "--disturb", DISTURBANCE)
        took = time.monotonic() - began
        self.assertEqual(self.settle(name, "--drops", self.drops, "--disturb", DISTURBANCE, "--workers", 3), out, name)
        report = json.loads(out)
        poses = report["poses"]
        for number, pose in enumerate(poses):
            self.assertEqual(pose["stays"], report["disturbances"], f"pose {number} of {name}")
        self.assertAlmostEqual(sum(pose["probability"] for pose in poses), 1, places=9)
        counts = [round(pose["frequency"] * self.drops) for pose in poses]
        others = sum(round(other["frequency"] * self.drops) for other in report["other_poses"])
        self.assertEqual(others, round(report["elsewhere"] * self.drops))
        self.assertEqual(sum(counts) + others + round(report["moving"] * self.drops), self.drops)
        # All but one drop in a hundred lie in a stable pose.
        self.assertGreaterEqual(sum(counts), 0.99 * self.drops, name)
        print(f"{name:12s} {len(poses):3d} poses, {self.drops} drops, elsewhere {others}, "
              f"moving {round(report['moving'] * self.drops)}, {took:.1f} s")
        for group in images(poses):
            self.compare_images(name, group)

    def compare_images(self, name, group):
        """Pearson's chi-squared of equal shares: its mean is the number of degrees of freedom k, its variance 2 k.

        Facets around a round side are not compared: docs/settle.md says by how much they differ.
        """
        counts = [round(pose["frequency"] * self.drops) for pose in group]
        print(f"    {len(group):3d} poses, height {group[0]['height']:.4f} m: slow rolling "
              f"{sum(pose['probability'] for pose in group):.4f}, dropped {sum(counts) / self.drops:.4f}")
        mean, degrees = sum(counts) / len(counts), len(counts) - 1
        if not 0 < degrees < 6 or mean < 5:
            return
        spread = sum((count - mean)**2 for count in counts) / mean
        self.assertLess(spread, degrees + 4.5 * math.sqrt(2 * degrees) + 4, f"{name}: {counts}")


class Poses(Trials):
    def test_two_models_dropped_a_hundred_times(self):
        for name in ("box", "bowl"):
            with self.subTest(name):
                self.try_model(name)


class LongPoses(Trials):
    drops = 1000

    def test_ten_models_dropped_a_thousand_times(self):
        for name in MODELS:
            with self.subTest(name):
                self.try_model(name)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
