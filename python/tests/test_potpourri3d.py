"""The names of potpourri3d, each against a closed form, vectors through the frames that come with them."""

import inspect
import os

import numpy as np
import pytest
from scipy.sparse import csc_matrix

import ahm
import ahm.potpourri3d as pp3d
from ahm._curve_distances import _same


@pytest.fixture(scope="module")
def flat():
    return ahm.shapes.plane(15, 12, 0.5)


def in_space(solver, vectors, at=slice(None)):
    x, y, _ = solver.get_tangent_frames()
    return vectors[:, :1] * x[at] + vectors[:, 1:] * y[at]


@pytest.fixture(scope="module")
def solvers(flat):
    V, F = flat
    quads = [[i + 15 * j, i + 1 + 15 * j, i + 16 + 15 * j, i + 15 + 15 * j] for j in range(11) for i in range(14)]
    return {"mesh": pp3d.MeshVectorHeatSolver(V, F), "polygons": pp3d.PolygonMeshHeatSolver(V, quads),
            "cloud": pp3d.PointCloudHeatSolver(V), "distance": pp3d.MeshHeatMethodDistanceSolver(V, F, t_coef=2.0)}


@pytest.mark.parametrize("name", ["mesh", "polygons", "cloud"])
def test_log_maps_are_offsets_in_the_frame_of_the_source(solvers, flat, name):
    solver, V = solvers[name], flat[0]
    for strategy in ("AffineLocal", "AffineAdaptive"):
        m = solver.compute_log_map(40, strategy)
        assert m.shape == (180, 2) and m.dtype == np.float64
        np.testing.assert_allclose(in_space(solver, m, np.full(180, 40)), V - V[40], atol=1e-8)
    for a, k in zip(solver.compute_log_maps([3, 99]), (3, 99)):
        np.testing.assert_allclose(a, solver.compute_log_map(k), atol=1e-9)
    by_vector_heat = in_space(solver, solver.compute_log_map(40, "VectorHeat"), np.full(180, 40))
    np.testing.assert_allclose(np.linalg.norm(by_vector_heat, axis=1), np.linalg.norm(V - V[40], axis=1), atol=1e-8)
    assert np.linalg.norm(by_vector_heat - (V - V[40]), axis=1).max() < 0.5  # one edge


@pytest.mark.parametrize("name", ["mesh", "polygons", "cloud"])
def test_vectors_are_carried_unchanged_over_the_plane(solvers, name):
    solver = solvers[name]
    x, y, n = solver.get_tangent_frames()
    np.testing.assert_allclose(np.cross(x, y), n, atol=1e-12)
    carried = in_space(solver, solver.transport_tangent_vector(7, [0.3, -2.0]))
    np.testing.assert_allclose(carried, np.tile(0.3 * x[7] - 2 * y[7], (180, 1)), atol=1e-8)
    two = solver.transport_tangent_vectors([7, 170], [[1.0, 0.0], [1.0, 0.0]])
    assert two.shape == (180, 2)


@pytest.mark.parametrize("name", ["mesh", "polygons", "cloud"])
def test_constants_extend_to_themselves(solvers, name):
    np.testing.assert_allclose(solvers[name].extend_scalar([0, 90, 179], [2.5] * 3), 2.5, rtol=1e-9)


def test_distances_are_straight_on_the_plane(solvers, flat):
    V, F = flat
    truth = np.linalg.norm(V - V[40], axis=1)
    for name in ("distance", "polygons", "cloud"):
        np.testing.assert_allclose(solvers[name].compute_distance(40), truth, atol=1e-8)
    np.testing.assert_allclose(pp3d.compute_distance(V, F, 40), truth, atol=1e-8)
    several = solvers["distance"].compute_distance_multisource([0, 179])
    nearest = np.minimum(np.linalg.norm(V, axis=1), np.linalg.norm(V - V[179], axis=1))
    assert several[0] < 1e-3 and np.median(np.abs(several - nearest)) < 0.1
    np.testing.assert_array_equal(several, solvers["distance"].compute_distance_multisource(np.array([0, 179])))
    assert solvers["cloud"].compute_distance_multisource([0, 179]).shape == (180,)


def test_operators_are_the_textbooks(flat):
    V, F = flat
    L = pp3d.cotan_laplacian(V, F)
    assert abs(L - L.T).max() < 1e-12 and abs(L.sum(axis=1)).max() < 1e-12
    inside = (V[:, 0] > 0) & (V[:, 0] < 7) & (V[:, 1] > 0) & (V[:, 1] < 5.5)
    np.testing.assert_allclose((L @ (V[:, 0] ** 2))[inside], -2 * 0.25, atol=1e-9)
    assert pp3d.face_areas(V, F).sum() == pytest.approx(7 * 5.5) == pytest.approx(pp3d.vertex_areas(V, F).sum())
    edges = pp3d.edges(V, F)
    assert len(edges) == len(V) + len(F) - 1 == len(np.unique(np.sort(edges, axis=1), axis=0))
    assert edges[:3].tolist() == np.stack([F[0], np.roll(F[0], -1)], axis=1).tolist()
    B = pp3d.MeshVectorHeatSolver(V, F).get_connection_laplacian()
    assert isinstance(B, csc_matrix) and B.shape == (180, 180) and abs(B - B.getH()).max() < 1e-12
    x, y, _ = pp3d.MeshVectorHeatSolver(V, F).get_tangent_frames()
    constant = x[:, 0] + 1j * y[:, 0]
    assert abs(B @ constant).max() < 1e-9


def test_paths_and_traces_are_straight(flat):
    V, F = flat
    path = pp3d.EdgeFlipGeodesicSolver(V, F).find_geodesic_path(0, 179)
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() == pytest.approx(np.hypot(7, 5.5))
    tracer = pp3d.GeodesicTracer(V, F)
    np.testing.assert_allclose(tracer.trace_geodesic_from_vertex(0, [1.0, 0.5, 0])[-1], [1, 0.5, 0], atol=1e-9)
    start = np.array([0.2, 0.3, 0.5]) @ V[F[3]]
    np.testing.assert_allclose(tracer.trace_geodesic_from_face(3, [0.2, 0.3, 0.5], [0.7, 0.9, 0])[-1], start + [0.7, 0.9, 0], atol=1e-9)


def test_paths_through_vertices_are_pulled_taut_and_loops_close(flat):
    paths = pp3d.EdgeFlipGeodesicSolver(*flat)
    poly = paths.find_geodesic_path_poly([0, 14, 179])
    assert np.linalg.norm(np.diff(poly, axis=0), axis=1).sum() == pytest.approx(np.hypot(7, 5.5))
    np.testing.assert_allclose(poly[[0, -1]], flat[0][[0, 179]], atol=1e-12)
    V, F = ahm.shapes.torus(48, 24)
    loop = pp3d.EdgeFlipGeodesicSolver(V, F).find_geodesic_loop([12, 24 * 16 + 12, 24 * 32 + 12])
    assert np.linalg.norm(np.diff(loop, axis=0), axis=1).sum() == pytest.approx(2 * 48 * 0.6 * np.sin(np.pi / 48))
    np.testing.assert_allclose(loop[0], loop[-1], atol=1e-12)
    with pytest.raises(ValueError, match="no path"):
        pp3d.EdgeFlipGeodesicSolver(np.concatenate([V, V + 9]), np.concatenate([F, F + len(V)])).find_geodesic_path(0, len(V))


def test_batches_are_the_calls_one_by_one(solvers, flat):
    V, F = flat
    for name in ("distance", "polygons", "cloud"):
        found = solvers[name].compute_distances([3, 99])
        assert found.shape == (2, 180)
        np.testing.assert_array_equal(found[1], solvers[name].compute_distance(99))
    paths, tracer = pp3d.EdgeFlipGeodesicSolver(V, F), pp3d.GeodesicTracer(V, F)
    for path, ends in zip(paths.find_geodesic_paths([0, 5], [179, 7]), ((0, 179), (5, 7))):
        np.testing.assert_allclose(path, paths.find_geodesic_path(*ends), atol=1e-12)
    for curve, start in zip(tracer.trace_geodesics_from_vertices([0, 16], [[1, 0.5, 0], [0.3, 0.3, 0]]), (0, 16)):
        np.testing.assert_allclose(curve[0], V[start], atol=1e-12)


@pytest.fixture(scope="module")
def balls():
    V, F = ahm.shapes.sphere(4)
    return V, {"mesh": pp3d.MeshVectorHeatSolver(V, F), "polygons": pp3d.PolygonMeshHeatSolver(V, F.tolist()),
               "cloud": pp3d.PointCloudHeatSolver(V)}


@pytest.mark.parametrize("name", ["mesh", "polygons", "cloud"])
def test_vectors_in_the_gauge_are_those_of_the_sphere(balls, name):
    """Log map and transport of the unit sphere in space, found through the frames that come with the solver."""
    V, solver = balls[0], balls[1][name]
    x, y, n = solver.get_tangent_frames()
    for a, b in ((x, x), (y, y), (n, n)):
        np.testing.assert_allclose(np.einsum("ij,ij->i", a, b), 1, atol=1e-12)
    assert np.abs(np.einsum("ij,ij->i", n, V)).min() > 0.999 and np.abs(np.einsum("ij,ij->i", x, V)).max() < 0.05
    p = V[7]
    angle = np.arccos(np.clip(V @ p, -1, 1))
    near = (angle > 0) & (angle < 1)
    away = V - np.outer(V @ p, p)
    log = away * (angle / np.maximum(np.linalg.norm(away, axis=1), 1e-30))[:, None]
    found = in_space(solver, solver.compute_log_map(7), np.full(len(V), 7))
    assert np.linalg.norm(found - log, axis=1)[near].max() < 0.02
    start = np.cross(p, [0, 0, 1.0])
    start /= np.linalg.norm(start)
    carried = in_space(solver, solver.transport_tangent_vector(7, [x[7] @ start, y[7] @ start]))
    axis = np.cross(p, V)  # Parallel transport along a great circle is the turn about its axis.
    along = axis / np.maximum(np.linalg.norm(axis, axis=1), 1e-30)[:, None]
    turned = start * np.cos(angle)[:, None] + np.cross(along, start) * np.sin(angle)[:, None] + along * (
        along @ start * (1 - np.cos(angle)))[:, None]
    assert np.linalg.norm(carried - turned, axis=1)[near].max() < 0.05


@pytest.mark.parametrize("make", [pp3d.MeshHeatMethodDistanceSolver, lambda V, F: pp3d.PolygonMeshHeatSolver(V, F.tolist()),
                                  lambda V, F: pp3d.PointCloudHeatSolver(V)])
def test_distances_on_the_sphere_are_great_circles(balls, make):
    V, F = ahm.shapes.sphere(4)
    angle = np.arccos(np.clip(V @ V[7], -1, 1))
    assert np.abs(make(V, F).compute_distance(7) - angle)[angle < 2.5].max() < 0.07  # an edge


# All public names of potpourri3d 1.4.0: parameters after self, with their defaults (there [] where () is here)
SIGNATURES = {
    "MeshHeatMethodDistanceSolver": "V F t_coef=1.0 use_robust=True", "MeshHeatMethodDistanceSolver.compute_distance": "v_ind",
    "MeshHeatMethodDistanceSolver.compute_distance_multisource": "v_inds", "compute_distance": "V F v_ind",
    "compute_distance_multisource": "V F v_inds", "MeshVectorHeatSolver": "V F t_coef=1.0 use_intrinsic_delaunay=True",
    "MeshVectorHeatSolver.extend_scalar": "v_inds values", "MeshVectorHeatSolver.get_tangent_frames": "",
    "MeshVectorHeatSolver.get_connection_laplacian": "", "MeshVectorHeatSolver.transport_tangent_vector": "v_ind vector",
    "MeshVectorHeatSolver.transport_tangent_vectors": "v_inds vectors",
    "MeshVectorHeatSolver.compute_log_map": "v_ind strategy='AffineLocal'", "MeshFastMarchingDistanceSolver": "V F",
    "MeshFastMarchingDistanceSolver.compute_distance": "curves distances=() sign=False", "MeshMarchingTrianglesSolver": "V F",
    "MeshMarchingTrianglesSolver.marching_triangles": "u isoval=0.0", "marching_triangles": "V F u isoval=0.0",
    "MeshSignedHeatSolver": "V F t_coef=1.0", "MeshSignedHeatSolver.compute_distance":
    "curves curve_signs=() points=() preserve_source_normals=False level_set_constraint='ZeroSet' soft_level_set_weight=-1",
    "PolygonMeshHeatSolver": "V F t_coef=1.0",
    "PolygonMeshHeatSolver.compute_distance": "v_inds", "PolygonMeshHeatSolver.extend_scalar": "v_inds values",
    "PolygonMeshHeatSolver.get_tangent_frames": "", "PolygonMeshHeatSolver.transport_tangent_vectors": "v_inds vectors",
    "PolygonMeshHeatSolver.compute_signed_distance": "curves level_set_constraint='ZeroSet'", "EdgeFlipGeodesicSolver": "V F t_coef=1.0",
    "EdgeFlipGeodesicSolver.find_geodesic_path": "v_start v_end max_iterations=None max_relative_length_decrease=None",
    "EdgeFlipGeodesicSolver.find_geodesic_path_poly": "v_list max_iterations=None max_relative_length_decrease=None",
    "EdgeFlipGeodesicSolver.find_geodesic_loop": "v_list max_iterations=None max_relative_length_decrease=None",
    "GeodesicTracer": "V F t_coef=1.0",
    "GeodesicTracer.trace_geodesic_from_vertex": "start_vert direction_xyz max_iterations=None",
    "GeodesicTracer.trace_geodesic_from_face": "start_face bary_coords direction_xyz max_iterations=None",
    "PointCloudHeatSolver": "P t_coef=1.0", "PointCloudHeatSolver.compute_distance": "p_ind",
    "PointCloudHeatSolver.compute_distance_multisource": "p_inds", "PointCloudHeatSolver.compute_log_map": "p_ind",
    "PointCloudHeatSolver.extend_scalar": "p_inds values", "PointCloudHeatSolver.transport_tangent_vector": "p_ind vector",
    "PointCloudHeatSolver.transport_tangent_vectors": "p_inds vectors", "PointCloudHeatSolver.get_tangent_frames": "",
    "PointCloudHeatSolver.compute_signed_distance":
    "curves cloud_normals preserve_source_normals=False level_set_constraint='ZeroSet' soft_level_set_weight=-1",
    "PointCloudLocalTriangulation": "P with_degeneracy_heuristic=True", "PointCloudLocalTriangulation.get_local_triangulation": "",
    "validate_mesh": "V F force_triangular=False test_indices=False", "validate_points": "V",
    "face_areas": "V F", "vertex_areas": "V F", "cotan_laplacian": "V F denom_eps=0.0", "edges": "V F", "read_mesh": "filename",
    "read_polygon_mesh": "filename", "read_point_cloud": "filename", "write_point_cloud": "V filename",
    "write_mesh": "V F filename UV_coords=None UV_type=None",
}


@pytest.mark.parametrize("name", SIGNATURES)
def test_signatures_are_those_that_scripts_use(name):
    thing = pp3d
    for part in name.split("."):
        thing = getattr(thing, part)
    wanted = SIGNATURES[name].split()
    found = []
    for p in inspect.signature(thing).parameters.values():
        if p.kind is p.KEYWORD_ONLY or p.name == "self":
            continue
        stars = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        found.append(stars + p.name + ("" if p.default is p.empty else f"={p.default!r}"))
    # An additional parameter with a default, as `strategy` of a cloud's log map, breaks no script.
    assert found[: len(wanted)] == wanted and all("=" in more for more in found[len(wanted) :])


def test_files_come_back_as_they_were_written(flat, tmp_path):
    V, F = flat
    for ending in ("obj", "off", "ply"):
        pp3d.write_mesh(V / 3, F, tmp_path / f"mesh.{ending}")
        v, f = pp3d.read_mesh(tmp_path / f"mesh.{ending}")
        np.testing.assert_array_equal(v, V / 3)
        np.testing.assert_array_equal(f, F)
    for kind, corners in (("per-vertex", [1, 2, 17, 16]), ("per-face", [1, 1, 1, 1]), ("per-corner", [1, 2, 3, 4])):
        uv = V[: {"per-vertex": len(V), "per-face": 2, "per-corner": 7}[kind], :2]
        pp3d.write_mesh(V, [[0, 1, 16, 15], [1, 2, 16]], str(tmp_path / "polygons.obj"), UV_coords=uv, UV_type=kind)
        assert pp3d.read_polygon_mesh(tmp_path / "polygons.obj")[1] == [[0, 1, 16, 15], [1, 2, 16]]
        face = next(line for line in (tmp_path / "polygons.obj").read_text().splitlines() if line.startswith("f"))
        assert [int(corner.split("/")[1]) for corner in face.split()[1:]] == corners
    for ending in ("ply", "xyz"):
        pp3d.write_point_cloud(V / 7, tmp_path / f"cloud.{ending}")
        np.testing.assert_array_equal(pp3d.read_point_cloud(tmp_path / f"cloud.{ending}"), V / 7)


def test_files_are_written_whole_or_not_at_all(flat, tmp_path, monkeypatch):
    path = tmp_path / "mesh.obj"
    pp3d.write_mesh(*flat, os.fsencode(path))
    before = path.read_bytes()

    def fail(*names):
        raise OSError("the disk is full")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="full"):
        pp3d.write_mesh(flat[0][:3], [[0, 1, 2]], path)
    assert path.read_bytes() == before and os.listdir(tmp_path) == ["mesh.obj"]


def straight(V):
    """A curve along y = 2.5 to the right, through two rows; and the signed distance from it."""
    on_line = np.flatnonzero(V[:, 1] == 2.5)
    return [int(on_line[0]), int(on_line[-1])], V[:, 1] - 2.5


def test_signed_distances_are_positive_on_the_left_of_a_curve(solvers, flat):
    V, F = flat
    curve, truth = straight(V)
    signed, fast = pp3d.MeshSignedHeatSolver(V, F), pp3d.MeshFastMarchingDistanceSolver(V, F)
    for found in (signed.compute_distance([curve]), solvers["polygons"].compute_signed_distance([curve]),
                  solvers["cloud"].compute_signed_distance([curve], np.tile([0, 0, 2.0], (180, 1))),
                  fast.compute_distance([curve], sign=True)):
        np.testing.assert_allclose(found, truth, atol=1e-8)
    below = solvers["cloud"].compute_signed_distance([curve], np.tile([0, 0, -1.0], (180, 1)))
    np.testing.assert_allclose(below, -truth, atol=1e-8)
    for option in ({"curve_signs": [False]}, {"is_signed": [False]}):
        np.testing.assert_allclose(signed.compute_distance([curve], **option), abs(truth), atol=1e-8)
    with_point = signed.compute_distance([curve], points=[0])
    lengths = np.linalg.norm(V, axis=1)
    nearer, farther = lengths < abs(truth) - 1e-6, lengths > abs(truth) + 1e-6  # between them rounding decides
    np.testing.assert_allclose(with_point[nearer], lengths[nearer], atol=1e-8)
    np.testing.assert_allclose(with_point[farther], truth[farther], atol=1e-8)


def test_closed_curves_are_positive_inside_if_counter_clockwise(flat):
    V, F = flat
    square = [15 * j + i for i, j in ((4, 3), (10, 3), (10, 8), (4, 8), (4, 3))]
    inside = (V[:, 0] > 2) & (V[:, 0] < 5) & (V[:, 1] > 1.5) & (V[:, 1] < 4)
    outside = (V[:, 0] < 2) | (V[:, 0] > 5) | (V[:, 1] < 1.5) | (V[:, 1] > 4)
    for found in (pp3d.MeshSignedHeatSolver(V, F).compute_distance([square]),
                  pp3d.MeshFastMarchingDistanceSolver(V, F).compute_distance([square], sign=True)):
        assert (found[inside] > 0).all() and (found[outside] < 0).all()


def test_points_of_curves_are_the_same_only_if_their_values_are(flat):
    point = pp3d.MeshFastMarchingDistanceSolver(*flat)._point
    given = [3, 4, (3, [0.25]), (3, [0.25 + 1e-10]), (3, [0.2, 0.3]), (3, [0.2, 0.3 + 1e-10]), (4, [0.2, 0.3])]
    same = [[_same(point(a, "a"), point(b, "b")) for a in given] for b in given]
    np.testing.assert_array_equal(same, np.eye(len(given)))


def test_points_of_curves_are_rows_points_on_edges_and_points_in_faces(flat):
    V, F = flat
    fast, edges = pp3d.MeshFastMarchingDistanceSolver(V, F), pp3d.edges(V, F)
    for point, place in ((3, V[3]), ((3, []), V[3]), ((3,), V[3]), ((7, [0.25]), V[edges[7]].T @ [0.75, 0.25]),
                         ((5, [0.2, 0.3]), V[F[5]].T @ [0.2, 0.3, 0.5]), ((5, [0.2, 0.3, 0.5]), V[F[5]].T @ [0.2, 0.3, 0.5])):
        np.testing.assert_allclose(fast.compute_distance([[point]]), np.linalg.norm(V - place, axis=1), atol=1e-8)
    with pytest.raises(ValueError, match=r"curves\[0\]\[1\]"):
        fast.compute_distance([[0, 180]])


def test_contours_of_linear_functions_are_straight_and_of_closed_surfaces_closed(flat):
    V, F = flat
    edges = pp3d.edges(V, F)
    [line] = pp3d.marching_triangles(V, F, V[:, 0] + 0.3 * V[:, 1], 3.3)
    points = np.array([(1 - t) * V[edges[e, 0]] + t * V[edges[e, 1]] for e, (t,) in line])
    np.testing.assert_allclose(points @ [1, 0.3, 0], 3.3, atol=1e-12)
    assert {0.0, 5.5} == {*points[[0, -1], 1]} and (np.linalg.norm(np.diff(points, axis=0), axis=1) < 1).all()
    V, F = ahm.shapes.torus(48, 24)
    solver = pp3d.MeshMarchingTrianglesSolver(V, F)
    both = solver.marching_triangles(V[:, 1], 0.05)
    assert len(both) == 2 and all(curve[0] == curve[-1] for curve in both)
    assert solver.marching_triangles(V[:, 1], 9.0) == []


def test_local_triangulations_are_the_fans_of_the_points():
    """A point with 30 points around it: a fan of 30 triangles, and two triangles at each of the others."""
    angle = 2 * np.pi * np.arange(30) / 30
    P = np.concatenate([[[0, 0, 0]], np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)])
    found = pp3d.PointCloudLocalTriangulation(P).get_local_triangulation()
    assert found.shape == (31, 30, 3)
    around = [1 + k % 30 for k in range(32)]
    assert {tuple(t) for t in found[0]} == {(0, around[k], around[k + 1]) for k in range(30)}
    for k in range(1, 31):
        assert {tuple(t) for t in found[k, :2]} == {(k, around[k], 0), (k, 0, around[(k - 2) % 30])} and (found[k, 2:] == -1).all()
    V, F = ahm.shapes.sphere(3)
    own = pp3d.PointCloudLocalTriangulation(V).get_local_triangulation()
    fans = {tuple(np.roll(f, -np.argmin(f))) for f in F}
    found = [tuple(np.roll(t, -np.argmin(t))) for t in own[own[:, :, 0] >= 0]]
    assert set(found) == fans and len(found) == 3 * len(F)


def test_distances_accept_meshes_with_faults(flat):
    """Faces that repeat a corner or another face change nothing; a nonmanifold mesh is cut open, which leaves its sheets flat."""
    V, F = flat
    truth = np.linalg.norm(V - V[40], axis=1)
    faulty = np.concatenate([F, F[:5], F[7:9, ::-1], [[3, 3, 4], [9, 9, 9]]])
    np.testing.assert_allclose(pp3d.compute_distance(V, faulty, 40), truth, atol=1e-8)
    generator = np.random.default_rng(5)
    P = generator.random((300, 3))
    soup = np.concatenate([generator.integers(0, 300, (600, 3)), np.arange(300).reshape(-1, 3)])
    found = pp3d.MeshHeatMethodDistanceSolver(P, soup).compute_distance_multisource([1, 2, 3])
    assert found.shape == (300,) and (found[[1, 2, 3]] == 0).all() and (found[np.isfinite(found)] >= 0).all()
    with pytest.raises(ValueError, match="faces"):
        pp3d.MeshVectorHeatSolver(P, soup)


def test_distances_end_where_sheets_meet_in_edges_of_three_faces():
    V = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [-1, 0, 1], [-1, 0, -1]])
    found = pp3d.compute_distance(V, [[0, 1, 2], [1, 0, 3], [0, 1, 4]], 2)
    assert np.isfinite(found[:3]).all() and np.isnan(found[3:]).all()


def test_limits_on_iterations_are_accepted(flat):
    V, F = flat
    paths, tracer = pp3d.EdgeFlipGeodesicSolver(V, F), pp3d.GeodesicTracer(V, F)
    np.testing.assert_array_equal(paths.find_geodesic_path(0, 179, 100, 0.5), paths.find_geodesic_path(0, 179))
    around = [0, 14, 179]
    taut, loose = paths.find_geodesic_path_poly(around, 100, 0.5), paths.find_geodesic_path_poly(around, max_relative_length_decrease=0.9)
    np.testing.assert_array_equal(taut, paths.find_geodesic_path_poly(around))
    assert np.linalg.norm(np.diff(loose, axis=0), axis=1).sum() == pytest.approx(7 + 5.5)
    triangle = [0, 14, 179]
    assert np.ptp(paths.find_geodesic_loop(triangle), axis=0).max() < 1e-9
    kept = paths.find_geodesic_loop(triangle, max_relative_length_decrease=0.5)
    assert np.linalg.norm(np.diff(kept, axis=0), axis=1).sum() == pytest.approx(7 + 5.5 + np.hypot(7, 5.5))
    full, cut = tracer.trace_geodesic_from_vertex(0, [3, 1.7, 0]), tracer.trace_geodesic_from_vertex(0, [3, 1.7, 0], max_iterations=4)
    assert len(full) > 5
    np.testing.assert_array_equal(cut, full[:5])


def test_options_that_are_missing_are_refused(solvers, flat):
    V, F = flat
    curve = [straight(V)[0]]
    signed, fast = pp3d.MeshSignedHeatSolver(V, F), pp3d.MeshFastMarchingDistanceSolver(V, F)
    for call, alternative in ((lambda: solvers["cloud"].compute_signed_distance(curve, V, level_set_constraint="None"), "ahm.stroke"),
                              (lambda: solvers["polygons"].compute_signed_distance(curve, level_set_constraint="Multiple"), "ahm.stroke"),
                              (lambda: signed.compute_distance(curve, preserve_source_normals=True), "ahm.stroke"),
                              (lambda: signed.compute_distance(curve, soft_level_set_weight=1.0), "ahm.stroke"),
                              (lambda: fast.compute_distance(curve, distances=[[0, 0.5]]), "separately"),
                              (lambda: pp3d.write_mesh(V, F, "x.vtk"), r"\.obj"),
                              (lambda: pp3d.write_mesh(V, F, "x.ply", V[:, :2], "per-vertex"), r"\.obj")):
        with pytest.raises(NotImplementedError, match=alternative):
            call()


def test_wrong_arguments_are_refused_by_name(solvers, flat):
    V, F = flat
    paths, tracer = pp3d.EdgeFlipGeodesicSolver(V, F), pp3d.GeodesicTracer(V, F)
    mesh, cloud = solvers["mesh"], solvers["cloud"]
    for call, name in ((lambda: mesh.compute_log_map(-1), "v_ind"), (lambda: mesh.compute_log_map(180), "v_ind"),
                       (lambda: mesh.compute_log_map([0]), "v_ind"), (lambda: solvers["distance"].compute_distance(180), "v_ind"),
                       (lambda: mesh.extend_scalar([0, 999], [1.0, 2.0]), r"v_inds\[1\]"),
                       (lambda: mesh.compute_log_map(0, "other"), "strategy"),
                       (lambda: cloud.compute_distance(-7), "p_ind"), (lambda: cloud.extend_scalar([0, 999], [1, 2]), r"p_inds\[1\]"),
                       (lambda: paths.find_geodesic_path(0, -7), "v_end"), (lambda: paths.find_geodesic_path(180, 0), "v_start"),
                       (lambda: tracer.trace_geodesic_from_vertex(999, [1, 0, 0]), "start_vert"),
                       (lambda: tracer.trace_geodesic_from_face(999, [1, 0, 0], [1, 0, 0]), "start_face"),
                       (lambda: pp3d.MeshVectorHeatSolver(V, F + 1), "2 faces"), (lambda: pp3d.cotan_laplacian(V, F + 1), "F"),
                       (lambda: pp3d.validate_mesh(V, F + 1), "F"), (lambda: pp3d.validate_mesh(V, [[0, 1, 2, 3]], True), r"F\[0\]"),
                       (lambda: pp3d.validate_points(V[:, :2]), "V")):
        with pytest.raises(ValueError, match=f"^{name}"):
            call()
    assert pp3d.MeshVectorHeatSolver(V.tolist(), F.tolist(), useIntrinsicDelaunay=False).compute_log_map(0).shape == (180, 2)


def test_the_list_of_names_is_complete():
    assert {name.split(".")[0] for name in SIGNATURES} == set(pp3d.__all__)
