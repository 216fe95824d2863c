"""Functions with the names of potpourri3d, against closed forms. Frames of the solvers convert vectors."""

import inspect
import os

import numpy as np
import pytest

import ahm
import ahm.potpourri3d as pp3d


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
    with pytest.raises(NotImplementedError, match="VectorHeat"):
        solver.compute_log_map(0, "VectorHeat")


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
    assert len(pp3d.edges(V, F)) == len(V) + len(F) - 1
    B = pp3d.MeshVectorHeatSolver(V, F).get_connection_laplacian()
    assert B.shape == (180, 180) and abs(B - B.getH()).max() < 1e-12
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
    """Log map and transport on the unit sphere as vectors in space, by the frames of the solver."""
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
    axis = np.cross(p, V)  # parallel transport along a great circle: a rotation about its axis
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


# name: parameters after self, with the defaults of potpourri3d
SIGNATURES = {
    "MeshHeatMethodDistanceSolver": "V F t_coef=1.0 use_robust=True", "MeshHeatMethodDistanceSolver.compute_distance": "v_ind",
    "MeshHeatMethodDistanceSolver.compute_distance_multisource": "v_inds", "compute_distance": "V F v_ind",
    "compute_distance_multisource": "V F v_inds", "MeshVectorHeatSolver": "V F t_coef=1.0 use_intrinsic_delaunay=True",
    "MeshVectorHeatSolver.extend_scalar": "v_inds values", "MeshVectorHeatSolver.get_tangent_frames": "",
    "MeshVectorHeatSolver.get_connection_laplacian": "", "MeshVectorHeatSolver.transport_tangent_vector": "v_ind vector",
    "MeshVectorHeatSolver.transport_tangent_vectors": "v_inds vectors",
    "MeshVectorHeatSolver.compute_log_map": "v_ind strategy='AffineLocal'", "PolygonMeshHeatSolver": "V F t_coef=1.0",
    "PolygonMeshHeatSolver.compute_distance": "v_inds", "PolygonMeshHeatSolver.extend_scalar": "v_inds values",
    "PolygonMeshHeatSolver.get_tangent_frames": "", "PolygonMeshHeatSolver.transport_tangent_vectors": "v_inds vectors",
    "PolygonMeshHeatSolver.compute_signed_distance": "*given **options", "EdgeFlipGeodesicSolver": "V F t_coef=1.0",
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
    "PointCloudHeatSolver.compute_signed_distance": "*given **options",
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
    # Scripts also run with additional parameters, such as `strategy` of the log map of a cloud.
    assert found[: len(wanted)] == wanted and all("=" in more for more in found[len(wanted) :])


def test_files_come_back_as_they_were_written(flat, tmp_path):
    V, F = flat
    for ending in ("obj", "off", "ply"):
        pp3d.write_mesh(V / 3, F, tmp_path / f"mesh.{ending}")
        v, f = pp3d.read_mesh(tmp_path / f"mesh.{ending}")
        np.testing.assert_array_equal(v, V / 3)
        np.testing.assert_array_equal(f, F)
    pp3d.write_mesh(V, [[0, 1, 16, 15], [1, 2, 16]], str(tmp_path / "polygons.obj"), UV_coords=V[:, :2], UV_type="per-vertex")
    assert pp3d.read_polygon_mesh(tmp_path / "polygons.obj")[1] == [[0, 1, 16, 15], [1, 2, 16]]
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


def test_what_is_not_there_says_so_and_indices_are_checked(solvers, flat):
    V, F = flat
    paths = pp3d.EdgeFlipGeodesicSolver(V, F)
    for call in (lambda: solvers["cloud"].compute_signed_distance([[0, 1]], V), lambda: paths.find_geodesic_loop([0, 1, 2], 9),
                 lambda: solvers["polygons"].compute_signed_distance([[0, 1]], level_set_constraint="ZeroSet"),
                 lambda: paths.find_geodesic_path_poly([0, 1, 2], max_relative_length_decrease=0.1), lambda: paths.find_geodesic_path(0, 5, max_iterations=3),
                 lambda: pp3d.write_mesh(V, F, "x.vtk")):
        with pytest.raises(NotImplementedError):
            call()
    for call in (lambda: solvers["mesh"].compute_log_map(180), lambda: solvers["mesh"].compute_log_map(-1),
                 lambda: solvers["distance"].compute_distance(10**6), lambda: pp3d.MeshVectorHeatSolver(V, F + 1),
                 lambda: solvers["mesh"].extend_scalar([0, 999], [1.0, 2.0]), lambda: paths.find_geodesic_path(0, 999),
                 lambda: pp3d.cotan_laplacian(V, F + 1)):
        with pytest.raises(ValueError):
            call()
    tracer = pp3d.GeodesicTracer(V, F)
    for call, name in ((lambda: solvers["mesh"].compute_log_map(-1), "v_ind"), (lambda: solvers["distance"].compute_distance(180), "v_ind"),
                       (lambda: solvers["cloud"].compute_distance(-7), "p_ind"), (lambda: paths.find_geodesic_path(0, -7), "v_end"),
                       (lambda: solvers["cloud"].extend_scalar([0, 999], [1, 2]), r"p_inds\[1\]"), (lambda: paths.find_geodesic_path(180, 0), "v_start"),
                       (lambda: tracer.trace_geodesic_from_vertex(999, [1, 0, 0]), "start_vert"), (lambda: solvers["mesh"].compute_log_map([0]), "v_ind"),
                       (lambda: tracer.trace_geodesic_from_face(999, [1, 0, 0], [1, 0, 0]), "start_face")):
        with pytest.raises(ValueError, match=f"^{name}: "):
            call()
    assert pp3d.MeshVectorHeatSolver(V.tolist(), F.tolist(), useIntrinsicDelaunay=False).compute_log_map(0).shape == (180, 2)
