"""Log maps from Python: exact on flat surfaces, for every discretization, source and method."""

import numpy as np
import pytest

import ahm
from conftest import in_plane

KINDS = ["triangles", "refined", "polygons", "cloud", "grid"]
SOURCE = 5 + 13 * 4


def axis_of(surface):
    return None if isinstance(surface, ahm.Grid) else [1.0, 0, 0]


def plane_vectors(surface, m, at):
    """Positions of rows relative to `at`, in the axes of the map."""
    offsets = in_plane(surface, slice(None)) - at
    axes = m.source.axes
    return offsets if axes is None else offsets @ axes[:2, :2].T


@pytest.mark.parametrize("kind", KINDS)
def test_flat_maps_are_positions_relative_to_the_source(flat_surfaces, kind):
    s = flat_surfaces[kind]
    m = ahm.log_map(s, SOURCE, u_axis=axis_of(s))
    assert m.ok.all()
    np.testing.assert_allclose(m.uv, plane_vectors(s, m, s.points[SOURCE, :2]), atol=1e-9)
    np.testing.assert_allclose(m.distance, np.linalg.norm(m.uv, axis=1), atol=1e-9)
    np.testing.assert_allclose(m.angle, np.arctan2(m.uv[:, 1], m.uv[:, 0]))


@pytest.mark.parametrize("kind", KINDS)
def test_sources_between_rows_are_exact_on_the_plane(flat_surfaces, kind):
    s = flat_surfaces[kind]
    at = [0.61, 0.83] if kind == "grid" else [0.61, 0.83, 0.0]
    m = ahm.log_map(s, at, u_axis=axis_of(s))
    np.testing.assert_allclose(m.uv, plane_vectors(s, m, at[:2]), atol=1e-9)


def test_a_source_in_a_face_is_where_its_weights_say(flat_surfaces):
    for kind, weights in (("triangles", [0.2, 0.5, 0.3]), ("polygons", [0.25, 0.25, 0.3, 0.2])):
        s = flat_surfaces[kind]
        at = np.asarray(weights) @ s.points[s.faces[17]]
        for given in (weights, np.array(weights, np.float32)):
            m = ahm.log_map(s, (17, given), u_axis=[1, 0, 0])
            np.testing.assert_allclose(m.uv, plane_vectors(s, m, at[:2]), atol=1e-6)
            np.testing.assert_allclose(m.source.position, at, atol=1e-7)


def test_exact_maps_agree_with_heat_on_the_plane(flat_surfaces):
    s = flat_surfaces["triangles"]
    heat, exact = (ahm.log_map(s, SOURCE, method=method, u_axis=[0, 1, 0]) for method in ("heat", "exact"))
    assert (heat.method, exact.method) == ("heat", "exact")
    np.testing.assert_allclose(heat.uv, exact.uv, atol=1e-9)


def test_distances_on_the_sphere_are_great_circles(sphere):
    V = sphere.points
    truth = np.arccos(np.clip(V @ V[0], -1, 1))
    assert np.abs(ahm.log_map(sphere, 0, method="exact").distance - truth).max() < 0.01
    polar, heat = ahm.log_map(sphere, 0), ahm.log_map(sphere, 0, method="heat")
    for m in (polar, heat):
        assert np.abs(m.distance - truth)[truth < 2.5].max() < 0.03
    assert polar.error_estimate.shape == (642,) and heat.error_estimate is None


def test_distances_that_are_only_bounds_are_marked(sphere):
    for method in ("polar", "heat"):
        m = ahm.log_map(sphere, 0, method=method)
        straight = np.linalg.norm(sphere.points - sphere.points[0], axis=1)
        assert set(m.bounded) <= {0, 1}
        np.testing.assert_allclose(m.distance[m.bounded == 1], straight[m.bounded == 1])
    assert ahm.log_map(sphere, 0, method="exact").bounded is None
    grid = ahm.Grid([5, 5], spacing=1)
    assert ahm.log_map(grid, 0).bounded is None


def test_batches_are_the_same_maps(sphere):
    solver = ahm.LogMapSolver(sphere)
    sources = [0, 17, 333]
    for m, source in zip(solver.log_maps(sources), sources):
        np.testing.assert_allclose(m.uv, solver.log_map(source).uv, atol=1e-10)
        assert m.source.row == source


def test_sources_can_be_given_in_every_form(sphere):
    solver = ahm.LogMapSolver(sphere)
    for given in ([0, 5], (0, 5), np.array([0, 5], np.uint8), np.array([0, 5], np.int64)[::1], np.array([[0, 9], [5, 9]])[:, 0]):
        assert [m.source.row for m in solver.log_maps(given)] == [0, 5]
    faces = ([3, 4], [[0.2, 0.3, 0.5], [1, 0, 0]])
    for m, f, w in zip(solver.log_maps(faces), *faces):
        np.testing.assert_allclose(m.source.position, np.asarray(w) @ sphere.points[sphere.faces[f]])
    mixed = solver.log_maps([0, (3, [0.2, 0.3, 0.5]), [0.0, 0.0, 2.0]])
    assert mixed[0].source.row == 0 and mixed[2].source.position[2] > 0.9
    positions = solver.log_maps(sphere.points[:2].astype(np.float32))
    np.testing.assert_allclose(positions[1].source.position, sphere.points[1], atol=1e-6)


def test_rows_beyond_the_radius_or_the_component_say_so():
    V, F = ahm.shapes.plane(9, 9)
    two = ahm.TriangleMesh(np.concatenate([V, V + [0, 0, 5], [[9, 9, 9]]]), np.concatenate([F, F + len(V)]))
    m = ahm.log_map(two, 0, radius=3.0)
    S = ahm.Status
    near = np.linalg.norm(V, axis=1) <= 3 + 1e-9
    assert (m.status[:81] == np.where(near, S.ok, S.beyond_radius)).all()
    assert (m.status[81:162] == S.disconnected).all() and m.status[162] == S.removed
    np.testing.assert_array_equal(np.isnan(m.uv[:, 0]), ~m.ok)
    np.testing.assert_array_equal(np.isnan(m.distance), ~m.ok)


def test_axes_are_the_sources_axes_carried_over_the_plane(flat_surfaces):
    for kind in ("triangles", "polygons", "cloud"):
        m = ahm.log_map(flat_surfaces[kind], SOURCE, u_axis=[1, 0, 0])
        np.testing.assert_allclose(m.axes, np.broadcast_to(m.source.axes[:2], (143, 2, 3)), atol=1e-7)
        assert m.frames.shape == (143, 2, 2)
        radial = m.uv[:, :1] * m.axes[:, 0] + m.uv[:, 1:] * m.axes[:, 1]
        np.testing.assert_allclose(m.gradient * m.distance[:, None], radial, atol=1e-9)


def test_maps_without_frames_refuse_what_needs_them(sphere):
    m = ahm.log_map(sphere, 0, frames=False)
    for ask in (lambda: m.frames, lambda: m.axes, lambda: m.gradient, lambda: m.inverse([[0, 0]])):
        with pytest.raises(ahm.InvalidArgument, match="frames=True"):
            ask()


def test_sampling_and_inverting_undo_each_other(flat_surfaces):
    for kind in ("triangles", "refined", "cloud"):
        m = ahm.log_map(flat_surfaces[kind], SOURCE, u_axis=[1, 0, 0])
        there = np.array([[0.3, 0.4, 0], [1.1, 1.7, 0], [2.9, 0.05, 0]])
        uv = m.sample(there)
        back = m.inverse(uv)
        assert back.valid.all()
        np.testing.assert_allclose(back.position, there, atol=1e-9)
        corners = m.surface.points[back.triangle]
        np.testing.assert_allclose(np.einsum("kc,kcx->kx", back.barycentric, corners), there, atol=1e-9)
        assert not m.inverse([[99.0, 0]]).valid.any()


def test_coordinates_alone_are_the_same(sphere):
    solver = ahm.LogMapSolver(sphere)
    whole, alone = (solver.log_maps([0, 9], distances=wanted) for wanted in (True, False))
    for one, other in zip(whole, alone):
        assert (one.uv == other.uv).all() and (one.status == other.status).all()
        assert other.distance == pytest.approx(np.maximum(
            np.hypot(*other.uv.T), np.linalg.norm(sphere.points - sphere.points[other.source.row], axis=1)), abs=1e-12)
        assert np.isnan(other.spread).all()
    assert (whole[0].distance > np.hypot(*whole[0].uv.T) + 1).any()
    with pytest.raises(ahm.InvalidArgument, match="spread=True"):
        alone[0].quality


def test_quality_and_spread_tell_of_the_cut_locus(sphere):
    m = ahm.log_map(sphere, 0)
    opposite = int(np.argmin(sphere.points @ sphere.points[0]))
    assert m.quality[opposite] < 0.5 < m.quality[m.distance < 1].min()
    assert m.spread[opposite] > 1
    assert ahm.log_map(sphere, 0, method="exact").quality[m.distance < 1].min() > 0.5


def test_corners_of_faces_have_the_coordinates_of_their_rows_on_the_plane(flat_surfaces):
    s = flat_surfaces["triangles"]
    m = ahm.log_map(s, SOURCE)
    np.testing.assert_allclose(m.corner_uv.reshape(-1, 3, 2), m.uv[s.faces], atol=1e-9)


def test_results_are_views_that_outlive_everything_else(plane):
    m = ahm.log_map(plane, 0)
    uv, distance = m.uv, m.distance
    copies = uv.copy(), distance.copy()
    assert m.uv.__array_interface__["data"] == uv.__array_interface__["data"]
    with pytest.raises(ValueError):
        uv[0] = 1
    del m
    np.testing.assert_array_equal(uv, copies[0])
    np.testing.assert_array_equal(distance, copies[1])


def test_input_in_c_order_is_used_in_place_and_other_input_is_the_same(plane):
    V, F = plane
    reference = ahm.log_map((V, F), 7).uv
    for v in (V.tolist(), np.asfortranarray(V), V[::-1][::-1], V.astype(">f8"), np.concatenate([V, V], 1)[:, :3]):
        np.testing.assert_array_equal(ahm.log_map((np.asarray(v), F), 7).uv, reference)
    for f in (F.tolist(), F.astype(np.int64), F.astype(np.uint16), F.astype(float), np.asfortranarray(F)):
        np.testing.assert_array_equal(ahm.log_map(ahm.TriangleMesh(V, f), 7).uv, reference)
    np.testing.assert_allclose(ahm.log_map((V.astype(np.float32), F), 7).uv, reference, atol=1e-6)


def test_grids_in_space_and_graphs_of_a_line():
    grid = ahm.Grid((4, 5, 3), [0.5, 0.25, 1.0], origin=[1, 2, 3])
    m = ahm.log_map(grid, grid.row((1, 1, 1)))
    np.testing.assert_allclose(m.uv, grid.points - grid.points[grid.row((1, 1, 1))], atol=1e-9)
    n = 50
    steps = np.repeat(np.arange(n), 2)[1:-1].reshape(-1, 2)
    pairs = np.sort(np.concatenate([steps, steps[:, ::-1]]).view("i8,i8"), axis=0).view("i8").reshape(-1, 2)
    line = ahm.Graph(np.searchsorted(pairs[:, 0], np.arange(n + 1)), pairs[:, 1], np.full(len(pairs), 10.0),
                     0.1 * (pairs[:, 1:] - pairs[:, :1]), np.ones((len(pairs), 1, 1)), np.full(n, 0.1))
    np.testing.assert_allclose(ahm.log_map(line, 20).uv[:, 0], 0.1 * (np.arange(n) - 20), atol=1e-9)


def test_obstacles_cut_grids_into_rooms():
    blocked = np.zeros((5, 4), bool)
    blocked[2] = True
    grid = ahm.Grid((6, 5), 1.0, blocked=blocked)
    status = ahm.log_map(grid, 0).status.reshape(grid.shape, order="F")
    assert (status[:3] == 0).all() and (status[3:] == ahm.Status.disconnected).all()


def test_maps_of_grids_go_around_obstacles():
    blocked = np.zeros((12, 8), bool)
    blocked[4:8, :6] = True
    grid = ahm.Grid((13, 9), 1.0, blocked=blocked)
    m = ahm.log_map(grid, grid.row((1, 0)))
    assert m.method == "polar" and ahm.log_map(ahm.Grid((4, 4, 4)), 0).method == "heat"
    around = np.hypot(3, 6) + 4 + np.hypot(4, 6)  # by the two corners
    far = grid.row((12, 0))
    np.testing.assert_allclose(m.distance[far], around, rtol=0.01)
    np.testing.assert_allclose(m.uv[far] / m.distance[far], np.array([3, 6]) / np.hypot(3, 6), atol=0.05)


def test_a_surfaces_graph_makes_the_same_maps(sphere):
    g = sphere.graph
    again = ahm.Graph(g.indptr, g.indices, g.weights, g.logs, g.transports, g.masses, length_unit=g.length_unit,
                      is_delaunay=True, frames=g.frames)
    np.testing.assert_allclose(ahm.log_map(again, 3, method="heat").uv, ahm.log_map(sphere, 3, method="heat").uv, atol=1e-12)


def test_strategies_and_variants_agree_on_the_plane(plane):
    for options in ({"strategy": "march"}, {"variant": "localized"}, {"ordering": "nested_dissection"}, {"t_coef": 3.0},
                    {"threads": 1}):
        np.testing.assert_allclose(ahm.log_map(plane, 20, **options).uv, ahm.log_map(plane, 20).uv, atol=1e-8)
    assert ahm.LogMapSolver(plane, strategy="march").strategy == "march"
