"""Wrong arguments raise errors that name argument, index and value; no call crashes, hangs or succeeds."""

import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import ahm
from conftest import words_of_cpp

NAN = float("nan")


@pytest.mark.parametrize("call, text", [
    (lambda s: ahm.log_map(s, 642), r"source: row 642 is out of range; there are 642 rows"),
    (lambda s: ahm.log_map(s, -1), r"source: row -1 is out of range"),
    (lambda s: ahm.log_map(s, [0.0, NAN, 0.0]), r"source: the position \[0.0, nan, 0.0\] is not finite"),
    (lambda s: ahm.log_map(s, (1280, [1, 0, 0])), r"source: face 1280 is out of range; there are 1280 faces"),
    (lambda s: ahm.log_map(s, (3, [1, 0])), r"source: face 3 has 3 corners"),
    (lambda s: ahm.log_map(s, (3, [0.5, 0.5, 0.5])), r"source: .*sum"),
    (lambda s: ahm.log_map(s, (3, [-0.5, 0.75, 0.75])), r"source: .*-0.5"),
    (lambda s: ahm.LogMapSolver(s).log_maps([0, 5, 9999]), r"sources\[2\]: row 9999"),
    (lambda s: ahm.LogMapSolver(s).log_maps(np.array([[0, 0, 1], [0, NAN, 1]])), r"sources\[1\]: the position"),
    (lambda s: ahm.LogMapSolver(s).log_maps([]), r"sources: is empty"),
    (lambda s: ahm.LogMapSolver(s).log_maps([2**40]), r"sources\[0\]: row 1099511627776"),
    (lambda s: ahm.LogMapSolver(s, t_coef=-1), r"t_coef: -1.0 is not greater than 0"),
    (lambda s: ahm.LogMapSolver(s, variant="best"), r"variant: 'best' is not one of 'adaptive', 'localized'"),
    (lambda s: ahm.log_map(s, 0, radius=NAN), r"radius: nan is not finite"),
    (lambda s: ahm.log_map(s, 0, radius=0), r"radius: 0.0 is not greater than 0"),
    (lambda s: ahm.log_map(s, 0, u_axis=[0, NAN, 0]), r"u_axis\[1\]: nan is not finite"),
    (lambda s: ahm.log_map(s, 0, u_axis=[0, 1]), r"u_axis: expected shape \(3,\), got \(2,\)"),
    (lambda s: ahm.log_map(s, 0, u_axis=s.normals[0]), r"source: "),
    (lambda s: ahm.log_map(s, 0, method="magic"), r"method: 'magic' is not one of"),
    (lambda s: ahm.log_map(s, (-1, [1, 0, 0])), r"source: face -1 is out of range; there are 1280 faces"),
    (lambda s: ahm.log_map(s, (0.5, [1, 0, 0])), r"source: expected a row, a position, \(face, barycentric\)"),
    (lambda s: ahm.log_map(s, {"row": 3}), r"source: expected a row, a position"),
    (lambda s: ahm.log_map(s, 0, u_axis=[0, 0, 0]), r"u_axis: the vector is zero"),
    (lambda s: ahm.trace(s, 0, [0, 0, 0]), r"direction: the vector is zero"),
    (lambda s: ahm.LogMapSolver("scan.ply"), r"surface: 'scan.ply' is a name; read files with ahm.read"),
    (lambda s: ahm.LogMapSolver({"points": 1}), r"surface: dict has no points"),
    (lambda s: ahm.atlas(s, [3, 7, 3]), r"sources\[2\]: another chart already starts at this row"),
    (lambda s: ahm.local_maps(s, 0.3).padded(dtype=int), r"dtype: int64 cannot hold coordinates"),
    (lambda s: ahm.local_maps(s, 0.3).padded(dtype="f99"), r"dtype: 'f99' is not a numeric type"),
    (lambda s: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[NAN], [-1]], np.ones((2, 1, 1)), [1, 1]), r"logs\[0, 0\]: nan"),
    (lambda s: ahm.read(None), r"path: expected a file name"),
    (lambda s: ahm.TriangleMesh(s.points, [[0, 1, 10**30]]), r"faces\[0, 2\]: 1000000000000000000000000000000 is out of range"),
    (lambda s: ahm.TriangleMesh([[0, 0, None]], s.faces), r"vertices\[0, 2\]: expected a real number, got NoneType"),
    (lambda s: ahm.Graph([0, 1, 2], [1, 0], [1, 1], np.empty((2, 0)), np.ones((2, 2)), [1, 1]), r"logs: expected shape \(2, d\)"),
    (lambda s: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[1], [-1]], [[1], [2, 3]], [1, 1]), r"transports: not an array"),
    (lambda s: ahm.Graph(*s.graph[:6], frames=np.full((642, 4, 3), NAN)), r"frames\[0, 0, 0\]: nan"),
    (lambda s: ahm.coverage(ahm.log_map(s, 0), 1.0, 0.1, step=0), r"step: 0.0 is not greater than 0"),
    (lambda s: ahm.coverage(ahm.log_map(s, 0), 1.0, 1e-7), r"about 6.28319e\+14 points"),
    (lambda s: ahm.local_maps(s, 0.3).csr(["a"]), r"values: expected numbers"),
    (lambda s: ahm.surface((s.points, np.array(3))), r"faces: expected 2 dimensions"),
    (lambda s: ahm.surface((s.points, iter(s.faces))), r"faces: expected real numbers"),
    (lambda s: ahm.surface((s.points, "abc")), r"faces: expected real numbers"),
    (lambda s: ahm.surface((3, 4)), r"vertices: expected shape \(n, 3\)"),
    (lambda s: ahm.read("a\0b.ply"), r"path: .*null"),
    (lambda s: ahm.local_maps(s, radius=0), r"radius"),
    (lambda s: ahm.local_maps(s), r"radius: missing"),
    (lambda s: ahm.local_maps(s, 0.2, sources=[1, 2, -7]), r"sources\[2\]: row -7"),
    (lambda s: ahm.distance(s, 0, targets=[0.5]), r"targets: rows must be integers"),
    (lambda s: ahm.extend(s, [0, 1], [1.0]), r"values: expected shape \(2,\), got \(1,\)"),
    (lambda s: ahm.extend(s, [0, 1], [1.0, NAN]), r"values\[1\]: nan is not finite"),
    (lambda s: ahm.transport(s, [0], [[1, 2, 3, 4]]), r"vectors: expected 3 numbers in space or 2 in a frame"),
    (lambda s: ahm.karcher_mean(s, [0, 700]), r"points\[1\]: row 700"),
    (lambda s: ahm.karcher_mean(s, [0, (3, [0.2, 0.3])]), r"points\[1\]: face 3 has 3 corners"),
    (lambda s: ahm.log_map(s, ((0, 700), 0.5)), r"source: row 700 is out of range"),
    (lambda s: ahm.log_map(s, (s.faces[0, :2], NAN)), r"source, t: nan is not finite"),
    (lambda s: ahm.log_map(s, (s.faces[0, :2], 1.5)), r"source: t is 1.5 on an edge"),
    (lambda s: ahm.log_map(s, ((0, int(np.argmin(s.points @ s.points[0]))), 0.5)), r"source: .*edge"),
    (lambda s: ahm.cells(s, [((0, int(np.argmin(s.points @ s.points[0]))), 0.5)], method="exact"), r"sources\[0\]: .*edge"),
    (lambda s: ahm.karcher_mean(s, [((0, int(np.argmin(s.points @ s.points[0]))), 0.5)]), r"points\[0\]: .*edge"),
    (lambda s: ahm.log_map(ahm.PointCloud(s.points), ((0, 1), 0.5)), r"source: "),
    (lambda s: ahm.LogMapSolver(s).log_maps(([[0, 1]], [0.5, 0.5])), r"sources: the numbers of edges and values of t differ: 1 and 2"),
    (lambda s: ahm.cells(s, [4, 5, 4]), r"sources\[2\]: row 4 occurs twice"),
    (lambda s: ahm.log_map(s, 0, method="exact", t_coef=2), r"t_coef: method 'exact' has no such option"),
    (lambda s: ahm.log_map(ahm.LogMapSolver(s), 0, t_coef=2), r"t_coef: options of an existing solver cannot be changed"),
    (lambda s: ahm.stroke(s, [0, 12], positions=[[0, 0]]), r"positions: expected shape \(2, 2\)"),
    (lambda s: ahm.stroke(s, [0, 12], positions=[[0, 0], [0, NAN]]), r"positions\[1, 1\]: nan"),
    (lambda s: ahm.stroke(s, [0, 12], positions=[[0, 0], [1, 0]], shape="circle"), r"positions: cannot be combined with `shape`"),
    (lambda s: ahm.stroke(s, [5]), r"points: "),
    (lambda s: ahm.geodesic_path(s, [5]), r"stops: 1 point; a path needs at least 2"),
    (lambda s: ahm.geodesic_paths(s, [0, 1], [2], pairwise=True), r"targets: .*as many targets as sources, got 1 and 2"),
    (lambda s: ahm.geodesic_paths(s, [0], [2], fast=True), r"fast: requires pairwise"),
    (lambda s: ahm.local_maps(s, 0.2, u_axis=[1, 0, 0]), r"u_axis: requires"),
    (lambda s: ahm.ExactGeodesics(ahm.PointCloud(s.points)), r"faces"),
    (lambda s: ahm.trace(s, 0, [1, 0, 0], -1), r"length"),
    (lambda s: ahm.geodesic_path(s, 0, 99999), r"to: row 99999"),
    (lambda s: ahm.coverage(ahm.log_map(s, 0), 1.0, 0.0), r"spacing: 0.0 is not greater than 0"),
    (lambda s: s.closest_points([[0, 0, float("inf")]]), r"positions\[0, 2\]: inf is not finite"),
    (lambda s: ahm.TriangleMesh(s.points, [[0, 1, 99999]]), r"99999"),
    (lambda s: ahm.TriangleMesh(s.points, [[0, 1, -1]]), r"-1"),
    (lambda s: ahm.TriangleMesh(s.points, [[0, 1, 2.5]]), r"faces\[0, 2\]: 2.5 is not an integer"),
    (lambda s: ahm.TriangleMesh(s.points, [[0, 1, 2**35]]), r"faces\[0, 2\]: 34359738368 is out of range"),
    (lambda s: ahm.TriangleMesh(s.points[:, :2], s.faces), r"vertices: expected shape \(n, 3\), got \(642, 2\)"),
    (lambda s: ahm.TriangleMesh(np.where(s.points == s.points[7], NAN, s.points), s.faces), r"7"),
    (lambda s: ahm.TriangleMesh(np.empty((0, 3)), np.empty((0, 3), int)), r""),
    (lambda s: ahm.PolygonMesh(s.points, [[0, 1]]), r"corner"),
    (lambda s: ahm.PolygonMesh(s.points, [[0, 1, 2], [3, "a", 4]]), r"faces\[1\]"),
    (lambda s: ahm.PointCloud([[0, 0, 0], [1, 0, 0]]), r"2 points; at least 3"),
    (lambda s: ahm.PointCloud(s.points, s.points[:5]), r"normals: expected shape \(642, 3\)"),
    (lambda s: ahm.Grid((1, 5)), r"2"),
    (lambda s: ahm.Grid((4, 5), blocked=np.ones((4, 5), bool)), r"blocked: .*\(3, 4\)"),
    (lambda s: ahm.Graph([0, 1, 2], [1, 5], [1, 1], [[1], [-1]], np.ones((2, 1, 1)), [1, 1]), r"5"),
    (lambda s: ahm.log_map(ahm.Grid((4, 4)), 0, method="exact"), r"mesh"),
    (lambda s: ahm.log_map(ahm.PointCloud(s.points), 0, method="exact"), r"faces"),
])
def test_errors_name_argument_index_and_value(sphere, call, text):
    with pytest.raises((ValueError, TypeError), match=text) as caught:
        call(sphere)
    assert not words_of_cpp(caught.value), caught.value


V6 = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [2, 0, 0]]
TWISTED = [[0, 0, 0], [3, 2, 0], [4, 1, 0], [3, 0, 0], [0, 1, 0], [-1, 0.5, 0]]  # a bow


@pytest.mark.parametrize("call, text", [
    (lambda f: ahm.TriangleMesh(V6, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]), r"edge has more.*non_manifold='split'"),
    (lambda f: ahm.TriangleMesh(V6, [[0, 1, 2], [0, 3, 4]]), r"bow ties.*non_manifold='split'"),
    (lambda f: ahm.PolygonMesh(TWISTED, [[0, 1, 2, 3, 4, 5]], discretization="refined"), r"twisted.*discretization='polygons'"),
    (lambda f: ahm.ExactGeodesics(f["polygons"]), r"discretization='refined', or use method 'heat'"),
    (lambda f: ahm.ExactGeodesics(ahm.PolygonMesh(TWISTED, [[0, 1, 2, 3, 4, 5]])), r"method 'heat'"),
    (lambda f: ahm.ExactGeodesics(f["cloud"]), r"method 'heat'"),
    (lambda f: ahm.PointCloud([[0, 0, 0], [1, 0, 0], [0, NAN, 0], [1, 1, 0]]), r"drop_non_finite=True"),
    (lambda f: ahm.LogMapSolver(f["triangles"], t_coef=1e300), r"t_coef"),
    (lambda f: ahm.LogMapSolver(f["cloud"]).log_map(0, frames=False).sample([[0.1, 0.1, 0.0]]), r"frames=True"),
    (lambda f: ahm.LogMapSolver(f["cloud"]).log_map(0, frames=False).gradient, r"frames=True"),
    (lambda f: ahm.coverage(ahm.log_map(f["cloud"], 0, frames=False), 1, 0.1), r"frames=True"),
    (lambda f: ahm.LogMapSolver(f["cloud"]).log_maps([0], spread=False)[0].quality, r"spread=True"),
    (lambda f: ahm.curvature(ahm.Grid((3, 3, 3))), r"mesh or a cloud"),
    (lambda f: ahm.ExactGeodesics(f["grid"]), r"mesh or a cloud"),
    (lambda f: ahm.decal(ahm.log_map(f["grid"], 0), 1, 1), r"mesh or a cloud"),
    (lambda f: ahm.log_map(f["grid"], 0).corner_uv, r"mesh or a cloud"),
    (lambda f: ahm.log_map(f["grid"], 0, u_axis=[1, 0, 0]), r"source: a u axis needs a mesh or a cloud"),
    (lambda f: ahm.log_map(f["grid"], [99.0, 0.0]), r"source: .*99.*outside the grid"),
    (lambda f: ahm.atlas(f["grid"]), r"mesh or a cloud"),
    (lambda f: ahm.atlas(f["triangles"], charts=90, size=16), r"do not fit"),
    (lambda f: ahm.atlas(f["triangles"], size=3), r"size is 3"),
    (lambda f: ahm.atlas(f["triangles"], max_distortion=0.5), r"max_distortion is 0.5"),
    (lambda f: ahm.InverseMap(ahm.log_map(f["triangles"], 0), max_stretch=0.5), r"max_stretch"),
    (lambda f: ahm.stroke(f["triangles"], [0, 12], shape="circle"), r"closed"),
    (lambda f: ahm.stroke(f["triangles"], [0, 12, 0]), r"turns back"),
    (lambda f: ahm.stroke(f["triangles"], [[0, 0, 0], [1e9, 0, 0]]), r"points"),
    (lambda f: ahm.karcher_mean(f["triangles"], [0, 1], [0, 0]), r"weights: all are 0"),
    (lambda f: ahm.karcher_mean(f["triangles"], [0, 1], [1, -1]), r"weights\[1\]: -1.0 is less than 0"),
    (lambda f: ahm.karcher_mean(f["triangles"], [0, 142], radius=0.1), r"point 1, .*raise the radius"),
    (lambda f: ahm.farthest_points(f["triangles"], 144), r"count.*144"),
    (lambda f: ahm.local_maps(f["triangles"], float("inf")), r"radius: inf"),
    (lambda f: ahm.PointCloud(f["cloud"].points, rows=[3, 2, 5]), r"rows\[1\]: 2 follows 3"),
    (lambda f: ahm.PointCloud(f["cloud"].points, k=2), r"k is 2"),
    (lambda f: ahm.PointCloud(f["cloud"].points, max_edge_ratio=0.5), r"max_edge_ratio is 0.5"),
    (lambda f: ahm.PointCloud(f["cloud"].points, smooth=-0.5), r"smooth is -0.5; give a radius in world units, 0 for none"),
    (lambda f: ahm.PointCloud([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]), r"on a line"),
    (lambda f: ahm.LogMapSolver(f["triangles"], accuracy=0.5), r"accuracy is 0.5"),
    (lambda f: ahm.Grid((70000, 70000)), r"more vertices than can be numbered"),
    (lambda f: ahm.Grid((3, 3), blocked=np.ones((2, 2), bool)), r"all 4 cells"),
    (lambda f: ahm.Grid((3, 3), spacing=0), r"spacing 0"),
    (lambda f: ahm.Graph([0, 2, 1], [1], [1], [[1]], np.ones((1, 1, 1)), [1, 1]), r"indptr: must ascend from 0 to 1, "),
    (lambda f: ahm.Graph([0, 1, 2], [1, 5], [1, 1], [[1], [-1]], np.ones((2, 1, 1)), [1, 1]), r"indices\[1\]: 5"),
    (lambda f: ahm.Graph([0, 1, 2], [1, 0], [1, 2], [[1], [-1]], np.ones((2, 1, 1)), [1, 1]), r"another weight"),
    (lambda f: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[1], [-1]], np.ones((2, 2)), [1, 1]), r"transports: \(cos, sin\)"),
    (lambda f: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[1], [-1]], 2 * np.ones((2, 1, 1)), [1, 1]), r"not orthogonal"),
    (lambda f: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[1], [-1]], np.ones((2, 1, 1)), [1, 0]), r"mass of vertex 1 is 0"),
    (lambda f: ahm.Graph([0, 1, 2], [1, 0], [1, 1], [[1], [-1]], np.ones((2, 1, 1)), [1]), r"masses: expected shape \(2,\)"),
    (lambda f: ahm.transport(f["grid"], 0, [1, 2, 3]), r"vectors: "),
    (lambda f: ahm.read(__file__), r"unknown file type"),
    (lambda f: ahm.trace(f["grid"], 0, [1, 0, 0]), r"start: .*geodesic needs a mesh or a cloud|a geodesic needs a mesh or a cloud"),
])
def test_errors_of_the_library_speak_python(flat_surfaces, call, text):
    with pytest.raises(Exception, match=text) as caught:
        call(flat_surfaces)
    assert isinstance(caught.value, (ahm.Error, ValueError, TypeError)) and not words_of_cpp(caught.value), caught.value


def test_types_that_are_no_numbers_raise_type_errors(sphere):
    for bad in ("3", b"3", True, None, 1.5, 3 + 0j, object(), {"a": 1}, {1, 2}, [None], ["a"], [[1, 2], [3]]):
        with pytest.raises((TypeError, ValueError)):
            ahm.log_map(sphere, bad)
        with pytest.raises((TypeError, ValueError)):
            ahm.LogMapSolver(sphere).log_maps([0, bad])
    for bad in ("abc", None, 7, object(), [[1, 2], [3]], np.array([["a"] * 3]), np.ones((4, 3), complex)):
        with pytest.raises((TypeError, ValueError)):
            ahm.TriangleMesh(bad, [[0, 1, 2]])
        with pytest.raises((TypeError, ValueError)):
            ahm.TriangleMesh(np.eye(3), bad)
    with pytest.raises(ValueError, match="masked"):
        ahm.PointCloud(np.ma.masked_greater(sphere.points, 0.9))


def test_exceptions_are_pythons_and_the_librarys(sphere, tmp_path):
    with pytest.raises(ahm.InvalidGeometry) as caught:
        ahm.TriangleMesh(sphere.points, [[0, 1, 1]])
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, ahm.Error)
    with pytest.raises(ahm.IoError) as caught:
        ahm.read(tmp_path / "nothing.ply")
    assert isinstance(caught.value, OSError) and "nothing.ply" in str(caught.value)
    unused = ahm.TriangleMesh(np.concatenate([sphere.points, [[9, 9, 9]]]), sphere.faces)
    with pytest.raises(ahm.InvalidArgument, match="source: row 642 is used by no face") as caught:
        ahm.log_map(unused, 642)
    assert caught.value.fault == "row_unused" and issubclass(ahm.ResourceExhausted, MemoryError)
    assert issubclass(ahm.NotPositiveDefinite, RuntimeError) and pickle.loads(pickle.dumps(caught.value)).args


def test_files_may_have_any_name(tmp_path):
    path = os.fsencode(tmp_path) + b"/\xff\xfe.obj"
    with pytest.raises(ahm.IoError) as caught:
        ahm.read(path)
    assert os.fsencode(str(caught.value)).count(path) == 1
    with open(path, "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for name in (path, os.fsdecode(path), Path(os.fsdecode(path))):
        assert len(ahm.read(name)) == 3


def test_surfaces_keep_the_warnings_of_the_file(tmp_path):
    path = tmp_path / "odd.obj"
    path.write_text("$ made by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert [w["id"] for w in ahm.read(path).warnings] == ["lines_skipped"]


def test_no_points_give_no_results(sphere):
    m = ahm.log_map(sphere, 0)
    for none in ([], np.empty((0, 3)), np.empty(0, int)):
        assert m.sample(none).shape == (0, 2) and m.inverse(np.empty((0, 2))).position.shape == (0, 3)
        for method in ("wavefront", "heat", "exact"):
            assert ahm.distance(sphere, 0, targets=none, method=method).shape == (0,)
        assert len(ahm.local_maps(sphere, 0.3, sources=none)) == 0


def random_thing(rng):
    shape = tuple(rng.integers(0, 5, rng.integers(0, 4)))
    values = rng.choice([0, 1, 2, 3, -1, 7, 1e9, 0.5, NAN, np.inf], shape)
    kind = rng.integers(0, 8)
    if kind < 4:
        with np.errstate(invalid="ignore"):
            return values.astype(rng.choice(["f4", "f8", "i4", "i8", "u1", "?", "c16", ">f8"]))
    if kind == 4:
        return values.tolist()
    if kind == 5:
        return (int(rng.integers(-2, 9)), values.tolist())
    return rng.choice(np.array([None, "x", -1, 3, 10**30, NAN, True, b"", 2.5], object))


def test_random_arguments_give_results_or_errors(sphere, plane):
    """Each call raises ValueError or TypeError, or returns a result of the right shape."""
    rng = np.random.default_rng(7)
    solver, flat = ahm.LogMapSolver(sphere), ahm.TriangleMesh(*plane)
    m, exact = solver.log_map(0), ahm.ExactGeodesics(flat)
    calls = [
        lambda x, y: solver.log_map(x, u_axis=y), lambda x, y: solver.log_maps(x, radius=y),
        lambda x, y: ahm.extend(solver, x, y), lambda x, y: ahm.transport(solver, x, y),
        lambda x, y: ahm.distance(flat, x, targets=y), lambda x, y: ahm.distance(flat, x, targets=y, method="exact"),
        lambda x, y: ahm.geodesic_path(flat, x, y), lambda x, y: ahm.geodesic_loop(flat, x),
        lambda x, y: ahm.geodesic_paths(flat, x, y, pairwise=True, fast=True), lambda x, y: ahm.local_stroke(flat, x, y),
        lambda x, y: ahm.stroke(exact, x, positions=y), lambda x, y: ahm.cells(exact, x), lambda x, y: exact.log_maps(x, radius=y),
        lambda x, y: ahm.atlas(exact, x, size=64), lambda x, y: exact.log_map((x, y)), lambda x, y: ahm.geodesic_paths(flat, x, y),
        lambda x, y: ahm.trace(flat, x, y), lambda x, y: ahm.cells(flat, x), lambda x, y: ahm.farthest_points(flat, y, x),
        lambda x, y: ahm.karcher_mean(solver, x, y), lambda x, y: ahm.stroke(solver, x), lambda x, y: m.sample(x),
        lambda x, y: m.inverse(x), lambda x, y: ahm.local_maps(flat, x, y), lambda x, y: ahm.local_maps(flat, 0.3, sources=x),
        lambda x, y: ahm.TriangleMesh(x, y), lambda x, y: ahm.PolygonMesh(x, y), lambda x, y: ahm.PointCloud(x, y),
        lambda x, y: ahm.Grid(np.clip(np.nan_to_num(np.real(x)), -2, 7) if np.ndim(x) else x, y), lambda x, y: ahm.decal(m, x, y),
        lambda x, y: ahm.coverage(m, x, y), lambda x, y: ahm.surface(x), lambda x, y: flat.closest_points(x),
        lambda x, y: ahm.Graph(x, y, x, y, x, y), lambda x, y: ahm.atlas(solver, x, charts=y, size=64),
    ]
    refused = 0
    for round_ in range(40):
        for call in calls:
            try:
                call(random_thing(rng), random_thing(rng))
            except (ValueError, TypeError) as error:
                assert not words_of_cpp(error), error
                refused += 1
    assert refused > 500


def test_objects_of_other_packages_are_taken_by_what_they_have(plane, sphere):
    V, F = plane

    class Thing:
        def __init__(self, **given):
            self.__dict__.update(given)

    padded = np.concatenate([np.full((len(F), 1), 3), F], axis=1).ravel()
    quads = {"quad": np.array([[0, 1, 14, 13]])}
    for thing in (Thing(points=V, regular_faces=F), Thing(points=V, faces=padded), Thing(vertices=V, faces=F),
                  Thing(vertices=V, triangles=F), Thing(points=V, cells_dict={"triangle": F}),
                  Thing(points=V, cells_dict={5: F, 3: F[:, :2]}), Thing(vertices=V, faces=F, triangles=V[F])):
        assert repr(ahm.surface(thing)) == repr(ahm.TriangleMesh(V, F))
    assert isinstance(ahm.surface(Thing(points=V, cells_dict=quads)), ahm.PolygonMesh)
    assert isinstance(ahm.surface(Thing(points=V, cells_dict={**quads, "triangle": np.delete(F, [0, 120], axis=0)})), ahm.PolygonMesh)
    assert isinstance(ahm.surface(Thing(points=sphere.points)), ahm.PointCloud)
    assert isinstance(ahm.surface(Thing(points=sphere.points, normals=sphere.normals)), ahm.PointCloud)
    for kind in ("tetra", "hexahedron"):
        with pytest.raises(ValueError, match=f"'{kind}' are not faces"):
            ahm.surface(Thing(points=V, cells_dict={"triangle": F, kind: np.array([[0, 1, 2, 3]])}))
    mixed = np.array([3, 0, 1, 14, 4, 1, 2, 15, 14])
    assert [len(face) for face in ahm.surface(Thing(points=V, faces=mixed)).faces] == [3, 4]
    for padded, text in (([-1, 0, 1, 2], r"faces\[0\]: cannot read a face of -1"),
                         ([3, 0, 1, 13, 4, 1, 2], r"faces\[4\]: cannot read a face of 4 corners; numbers left in the array: 2"),
                         ([3, 0, 1.5, 13], r"faces\[2\]: 1.5")):
        with pytest.raises(ValueError, match=text):
            ahm.surface(Thing(points=V, faces=np.array(padded)))
    assert ahm.surface(sphere) is sphere
    with pytest.raises(TypeError, match="no points"):
        ahm.surface(3)


class Tensor:
    """Like tensors of Open3D: without `__array__` and truth value."""

    def __init__(self, values):
        self.values = values

    def numpy(self):
        return self.values

    def __len__(self):
        return len(self.values)

    def __bool__(self):
        raise RuntimeError("a tensor of many elements has no truth value")


def test_tensors_are_arrays(sphere):
    class Columns:
        def __init__(self, **given):
            self.__dict__.update(given)

        def __getattr__(self, name):
            raise KeyError(name)

    points, normals = Tensor(sphere.points.astype(np.float32)), Tensor(sphere.normals)
    assert repr(ahm.surface(Columns(point=Columns(positions=points)))) == "<ahm.PointCloud: 642 points>"
    assert "with normals" in repr(ahm.surface(Columns(point=Columns(positions=points, normals=normals))))
    mesh = Columns(vertex=Columns(positions=points), triangle=Columns(indices=Tensor(sphere.faces.astype(np.int64))))
    assert repr(ahm.surface(mesh)) == repr(sphere)
    assert repr(ahm.TriangleMesh(points, Tensor(sphere.faces))) == repr(sphere)
    assert repr(ahm.surface((points, Tensor(sphere.faces)))) == repr(sphere)
    objects = ahm.TriangleMesh(sphere.points.astype(object), sphere.faces.astype(object))
    np.testing.assert_array_equal(objects.points, sphere.points)

    class Elsewhere(Tensor):
        def __array__(self, dtype=None):
            raise RuntimeError("call detach() first")

    with pytest.raises(ValueError, match="vertices: .*detach"):
        ahm.TriangleMesh(Elsewhere(sphere.points), sphere.faces)


class Frame:
    """As a data frame: its index operator selects columns, and its protocol is `__array__`."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None):
        return np.asarray(self.values, dtype)

    def __len__(self):
        return len(self.values)

    def __getitem__(self, column):
        raise KeyError(column)


class DlpackOnly:
    """As a tensor without `__array__`."""

    def __init__(self, values):
        self.values = np.array(values)

    def __dlpack__(self, **options):
        return self.values.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.values.__dlpack_device__()

    def __len__(self):
        return len(self.values)


def arrays_of(package):
    if package == "pandas":
        pandas = pytest.importorskip("pandas")
        return lambda values: pandas.DataFrame(values) if np.ndim(values) == 2 else pandas.Series(values, index=np.arange(len(values)) + 7)
    return pytest.importorskip("torch").tensor


@pytest.mark.parametrize("make", [Frame, DlpackOnly, "pandas", "torch"])
def test_arrays_of_other_packages_are_arrays_everywhere(make, sphere):
    make = arrays_of(make) if isinstance(make, str) else make
    V, F = np.array(sphere.points), np.array(sphere.faces)
    mesh = ahm.TriangleMesh(make(V), make(F))
    np.testing.assert_array_equal(mesh.points, V)
    assert repr(ahm.surface((make(V), make(F)))) == repr(sphere) and repr(ahm.surface(make(V))) == "<ahm.PointCloud: 642 points>"
    rows, position, u_axis = np.array([3, 99, 7]), np.array([0.1, 0.2, 0.9]), np.array([0.0, 1.0, 0.0])
    solver = ahm.LogMapSolver(sphere)
    for call in (lambda of: ahm.log_map(sphere, of(position), u_axis=of(u_axis)).uv, lambda of: ahm.distance(sphere, of(rows)),
                 lambda of: ahm.distance(sphere, of(V[:4] * 1.1)), lambda of: ahm.distance(sphere, 0, targets=of(rows)),
                 lambda of: np.stack([m.uv for m in solver.log_maps(of(rows))]), lambda of: ahm.extend(solver, of(rows), of(rows / 7)),
                 lambda of: ahm.transport(solver, of(rows[:1]), of(V[:1])), lambda of: ahm.PointCloud(of(V), of(V)).normals,
                 lambda of: sphere.closest_points(of(V * 2)).position, lambda of: ahm.cells(sphere, of(rows)).labels,
                 lambda of: ahm.log_map(sphere, (7, of(np.array([0.2, 0.3, 0.5])))).uv,
                 lambda of: ahm.karcher_mean(solver, of(rows), of(np.ones(3))).position):
        np.testing.assert_array_equal(call(make), call(np.asarray))


def test_files_are_read_as_what_they_contain(tmp_path):
    obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    for faces, kind in (("f 1 2 3\nf 1 3 4\n", ahm.TriangleMesh), ("f 1 2 3 4\n", ahm.PolygonMesh), ("", ahm.PointCloud)):
        path = tmp_path / "shape.obj"
        path.write_text(obj + faces)
        s = ahm.read(path)
        assert type(s) is kind and s.points.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    with pytest.raises(ValueError, match="no faces"):
        ahm.read(path, kind="triangles")


def test_the_length_unit_of_a_graph_is_a_power_of_two(sphere):
    g = sphere.graph
    for unit in (0.25, 1.0, 2.0**-1000):
        assert ahm.Graph(*g[:6], length_unit=unit).graph.length_unit == unit
    for unit in (3.0, 0.1, 1 + 2**-52, -2.0, 0.0, float("inf")):
        with pytest.raises(ValueError, match="length_unit: "):
            ahm.Graph(*g[:6], length_unit=unit)
