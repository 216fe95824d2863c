#!/usr/bin/env python3
"""The program of a build without optional libraries (preset lean): what it links, and its maps of a mesh and of a cloud.

    lean_test.py PROGRAM [OTHER]    OTHER: a program with all of them, whose maps must be equal to 1e-12; not compared if it does not exist
"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import latitude_mesh

program, other = None, None
SYSTEM = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6", "libpthread.so.0", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}


def write_mesh(path, n):
    """An ellipsoid of 2 n (n - 1) + 2 vertices."""
    points = [(0, 0, 1.2)]
    for i in range(1, n):
        theta = math.pi * i / n
        points += [(math.sin(theta) * math.cos(math.pi * j / n), 0.8 * math.sin(theta) * math.sin(math.pi * j / n), 1.2 * math.cos(theta))
                   for j in range(2 * n)]
    points.append((0, 0, -1.2))
    latitude_mesh.write_off(path, points, latitude_mesh.faces_of(n))


def write_cloud(path, n):
    """Points of the unit sphere, on a spiral."""
    rows = []
    for k in range(n):
        z, phi = 1 - (2 * k + 1) / n, k * math.pi * (3 - math.sqrt(5))
        rows.append(f"{math.sqrt(1 - z * z) * math.cos(phi)!r} {math.sqrt(1 - z * z) * math.sin(phi)!r} {z!r}\n")
    path.write_text("".join(rows))


class LeanProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def map_of(self, by, file, source, method):
        """Rows of the map, as dictionaries of numbers."""
        output = self.folder / "map.csv"
        subprocess.run([by, "logmap", str(file), "--source", str(source), "--method", method, "-o", str(output)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        with output.open() as lines:
            return [{name: float(row[name]) for name in ("x", "y", "z", "u", "v", "distance")} for row in csv.DictReader(lines)]

    def expect_equal_maps(self, file, source, method):
        """Compares with the other program: to 1e-12 of the greatest distance."""
        rows = self.map_of(program, file, source, method)
        if other:
            expected = self.map_of(other, file, source, method)
            self.assertEqual(len(rows), len(expected))
            tolerance = 1e-12 * max(row["distance"] for row in expected)
            for i, (a, b) in enumerate(zip(rows, expected)):
                for name in ("u", "v", "distance"):
                    self.assertAlmostEqual(a[name], b[name], delta=tolerance, msg=f"{method}: {name} of row {i}")
        return rows

    def test_it_links_only_fmt_and_the_standard_libraries(self):
        lines = subprocess.run(["objdump", "-p", program], check=True, capture_output=True, text=True).stdout.splitlines()
        needed = {line.split()[1] for line in lines if line.split()[:1] == ["NEEDED"]}
        self.assertIn("libc.so.6", needed)
        self.assertEqual({name for name in needed - SYSTEM if not name.startswith("libfmt.so.")}, set())

    def test_maps_of_a_mesh(self):
        file = self.folder / "mesh.off"
        write_mesh(file, 144)  # 41,186 vertices: the factors have large fronts
        for method in ("polar", "heat", "exact"):
            rows = self.expect_equal_maps(file, 5000, method)
            # Both poles together: at least as far as from pole to pole, at most half of a circle of radius 1.2.
            self.assertGreater(rows[0]["distance"] + rows[-1]["distance"], 2.4, method)
            self.assertLess(rows[0]["distance"] + rows[-1]["distance"], math.pi * 1.2, method)

    def test_maps_of_a_cloud(self):
        file = self.folder / "cloud.xyz"
        write_cloud(file, 10000)
        spacing = math.sqrt(4 * math.pi / 10000)
        for method in ("polar", "heat"):
            rows = self.expect_equal_maps(file, 4000, method)
            center = [rows[4000][axis] for axis in "xyz"]
            for i, row in enumerate(rows):
                cosine = sum(row[axis] * c for axis, c in zip("xyz", center))
                if cosine > 0:  # the hemisphere around the source
                    self.assertAlmostEqual(row["distance"], math.acos(min(cosine, 1)), delta=spacing, msg=f"{method}: row {i}")


if __name__ == "__main__":
    program = sys.argv[1]
    other = sys.argv[2] if len(sys.argv) > 2 and pathlib.Path(sys.argv[2]).exists() else None
    print(f"Comparing maps with {other}" if other else "No other program to compare maps with")
    unittest.main(argv=sys.argv[:1])
