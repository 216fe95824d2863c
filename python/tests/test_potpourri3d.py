"""The names of potpourri3d, each against a closed form, vectors through the frames that come with them."""

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


def test_what_is_not_there_says_so_and_indices_are_checked(solvers, flat):
    V, F = flat
    paths = pp3d.EdgeFlipGeodesicSolver(V, F)
    for call in (lambda: solvers["cloud"].compute_signed_distance([[0, 1]], V), lambda: paths.find_geodesic_loop([0, 1, 2]),
                 lambda: paths.find_geodesic_path_poly([0, 1, 2]), lambda: paths.find_geodesic_path(0, 5, max_iterations=3),
                 lambda: pp3d.write_mesh(V, F, "x.vtk")):
        with pytest.raises(NotImplementedError):
            call()
    for call in (lambda: solvers["mesh"].compute_log_map(180), lambda: solvers["mesh"].compute_log_map(-1),
                 lambda: solvers["distance"].compute_distance(10**6), lambda: pp3d.MeshVectorHeatSolver(V, F + 1),
                 lambda: solvers["mesh"].extend_scalar([0, 999], [1.0, 2.0]), lambda: paths.find_geodesic_path(0, 999),
                 lambda: pp3d.cotan_laplacian(V, F + 1)):
        with pytest.raises(ValueError):
            call()
    assert pp3d.MeshVectorHeatSolver(V.tolist(), F.tolist(), useIntrinsicDelaunay=False).compute_log_map(0).shape == (180, 2)
