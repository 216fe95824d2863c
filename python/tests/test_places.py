"""Points named in every way are the same points, wherever one is taken."""

import numpy as np
import pytest

import ahm

MESHES = ["triangles", "refined", "polygons"]


def edge_of(surface):
    """Rows of a side of face 40."""
    face = surface.faces[40]
    return int(face[0]), int(face[1])


@pytest.mark.parametrize("kind", MESHES)
def test_points_on_edges_lie_between_their_rows(flat_surfaces, kind):
    s = flat_surfaces[kind]
    a, b = edge_of(s)
    at = 0.7 * s.points[a] + 0.3 * s.points[b]
    m = ahm.log_map(s, ((a, b), 0.3), u_axis=[1, 0, 0])
    np.testing.assert_allclose(m.source.position, at, atol=1e-12)
    np.testing.assert_allclose(m.uv, (s.points - at) @ m.source.axes[:2].T, atol=1e-9)
    np.testing.assert_allclose(m.sample(((a, b), 0.3)), 0, atol=1e-9)


def test_one_point_in_every_form_has_one_map(flat_surfaces):
    s = flat_surfaces["triangles"]
    a, b, c = (int(row) for row in s.faces[40])
    middle = (s.points[a] + s.points[b]) / 2
    forms = {"row": [a, (40, [1, 0, 0]), ((a, b), 0.0), ((b, a), 1), s.points[a]],
             "edge": [((a, b), 0.5), ((b, a), 0.5), ((np.int64(a), np.uint8(b)), np.float32(0.5)), ([a, b], 0.5),
                      (40, [0.5, 0.5, 0]), middle]}
    for maker in (ahm.LogMapSolver(s), ahm.ExactGeodesics(s)):
        for same in forms.values():
            maps = maker.log_maps(same, u_axis=[1, 0, 0])
            for m in maps[1:]:
                np.testing.assert_allclose(m.uv, maps[0].uv, atol=1e-9)


def test_arrays_of_points_are_the_points_one_by_one(flat_surfaces):
    s = flat_surfaces["triangles"]
    edges, t = s.faces[[40, 7, 90], :2], [0.25, 0.5, 1.0]
    faces, weights = [40, 7], [[0.2, 0.3, 0.5], [0.0, 0.5, 0.5]]
    m = ahm.log_map(s, 20)
    one_by_one = [m.sample((edge, x))[0] for edge, x in zip(edges, t)]
    for given in ((edges, t), (edges.tolist(), np.array(t)), list(zip(edges.tolist(), t))):
        np.testing.assert_array_equal(m.sample(given), one_by_one)
    one_by_one = [m.sample((f, w))[0] for f, w in zip(faces, weights)]
    for given in ((faces, weights), (np.array(faces, np.int64), np.array(weights)), list(zip(faces, weights))):
        np.testing.assert_array_equal(m.sample(given), one_by_one)
    mixed = m.sample([3, (edges[0], 0.25), (40, weights[0]), [0.1, 0.2, 0.0]])
    np.testing.assert_array_equal(mixed[1:3], [m.sample((edges, t))[0], one_by_one[0]])


def test_single_precision_weights_are_taken_at_their_word(flat_surfaces):
    s = flat_surfaces["triangles"]
    weights = np.random.default_rng(3).dirichlet([1, 1, 1], 50)
    m = ahm.log_map(s, 20)
    near = m.sample((np.arange(50), weights.astype(np.float32)))
    np.testing.assert_allclose(near, m.sample((np.arange(50), weights)), atol=1e-6)


@pytest.mark.parametrize("method", ["unfold", "heat", "exact"])
def test_distances_from_points_between_rows_are_straight_lines(flat_surfaces, method):
    s = flat_surfaces["triangles"]
    a, b = edge_of(s)
    for source in (((a, b), 0.3), (40, [0.2, 0.5, 0.3]), [0.61, 0.83, 0.0]):
        at = ahm.log_map(s, source).source.position
        np.testing.assert_allclose(ahm.distance(s, source, method=method), np.linalg.norm(s.points - at, axis=1), atol=1e-9)


def test_rows_stand_for_points_where_rows_are_needed(flat_surfaces):
    """Means, transport and extension know rows alone: of a point in a face or on an edge the nearest corner counts."""
    for kind in ("triangles", "refined"):
        s = flat_surfaces[kind]
        a, b = edge_of(s)
        corners = len(s.faces[40])
        near_a = (40, [0.8, 0.2] + [0.0] * (corners - 2))
        for point in (((a, b), 0.2), ((b, a), 0.8), near_a, s.points[a] + [0.02, 0.01, 0.0]):
            np.testing.assert_array_equal(ahm.transport(s, point, [1.0, 2.0, 0.0]), ahm.transport(s, a, [1.0, 2.0, 0.0]))
            np.testing.assert_array_equal(ahm.extend(s, [point, 0], [1.0, 2.0]), ahm.extend(s, [a, 0], [1.0, 2.0]))
            assert ahm.karcher_mean(s, [point]).row == a
            assert ahm.farthest_points(s, 1, first=point).tolist() == [a]


def test_cells_of_any_points_are_those_of_the_nearest(flat_surfaces):
    for kind in ("triangles", "refined"):
        s = flat_surfaces[kind]
        sources = [3, (edge_of(s), 0.4), [2.6, 2.2, 0.0], (70, np.full(len(s.faces[70]), 1 / len(s.faces[70])))]
        places = np.array([ahm.log_map(s, one).source.position for one in sources])
        away = np.linalg.norm(s.points[:, None] - places[None], axis=2)
        clear = np.diff(np.sort(away, axis=1)[:, :2], axis=1)[:, 0] > 1e-9
        for method in ("unfold", "exact"):
            found = ahm.cells(s, sources, method=method)
            np.testing.assert_allclose(found.distance, away.min(axis=1), atol=1e-9)
            np.testing.assert_array_equal(found.labels[clear], away.argmin(axis=1)[clear])


def test_local_maps_around_points_between_rows(flat_surfaces):
    for kind in ("triangles", "refined", "cloud"):
        s = flat_surfaces[kind]
        sources = [17, [0.61, 0.83, 0.0], [1.4, 1.7, 0.0]]
        maps = ahm.local_maps(s, 0.6, sources=sources, u_axis=[1, 0, 0])
        assert maps.sources.tolist() == [17, -1, -1]
        for k, source in enumerate(sources):
            whole = ahm.log_map(s, source, u_axis=[1, 0, 0])
            near = maps.indices[maps.indptr[k] : maps.indptr[k + 1]]
            assert set(near) == set(np.flatnonzero(whole.distance <= 0.6))
            np.testing.assert_allclose(maps.log[maps.indptr[k] : maps.indptr[k + 1]], whole.uv[near], atol=1e-8)
    assert len(ahm.local_maps(flat_surfaces["cloud"], 0.6, sources=[])) == 0
    on_edge = ahm.local_maps(flat_surfaces["triangles"], 0.3, sources=((17, 18), 0.5))
    np.testing.assert_allclose(on_edge.distance[:2], 0.125, atol=1e-9)
