"""Every form of a point has the same result, in every function that takes points."""

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


@pytest.mark.parametrize("method", ["wavefront", "heat", "exact"])
def test_distances_from_points_between_rows_are_straight_lines(flat_surfaces, method):
    s = flat_surfaces["triangles"]
    a, b = edge_of(s)
    for source in (((a, b), 0.3), (40, [0.2, 0.5, 0.3]), [0.61, 0.83, 0.0]):
        at = ahm.log_map(s, source).source.position
        np.testing.assert_allclose(ahm.distance(s, source, method=method), np.linalg.norm(s.points - at, axis=1), atol=1e-9)


def test_vectors_and_values_start_where_they_are_given(flat_surfaces):
    """Vectors stay what they are on the plane; values are the quotient of the solutions from the points' corners."""
    from scipy.sparse.linalg import splu

    for kind in MESHES + ["cloud", "grid"]:
        s = flat_surfaces[kind]
        points = [[0.61, 0.83, 0.0], [2.2, 1.9, 0.0]] if kind != "grid" else [[0.61, 0.83], [2.2, 1.9]]
        if kind in MESHES:
            points += [(edge_of(s), 0.2), (70, np.full(len(s.faces[70]), 1 / len(s.faces[70]))), 7]
        plane = [1.0, 2.0, 0.0] if kind != "grid" else [1.0, 2.0]
        np.testing.assert_allclose(ahm.transport(s, points, [plane] * len(points)), np.tile(plane, (143, 1)), atol=1e-9)
        np.testing.assert_allclose(ahm.extend(s, points, [2.5] * len(points)), 2.5, rtol=1e-9)
        values = ahm.extend(s, points[:2], [0.0, 1.0])
        assert values[0] < 1e-3 and values[142] > 1 - 1e-3
    s = flat_surfaces["triangles"]
    ops = ahm.operators(s)
    weights = np.zeros((143, 2))
    weights[s.faces[40], 0], weights[s.faces[70], 1] = [0.2, 0.3, 0.5], [0.6, 0.4, 0.0]
    heat = splu(ops.A.tocsc()).solve(weights)
    found = ahm.extend(s, ([40, 70], [[0.2, 0.3, 0.5], [0.6, 0.4, 0.0]]), [-1.0, 3.0])
    np.testing.assert_allclose(found, (heat @ [-1.0, 3.0]) / heat.sum(axis=1), rtol=1e-6)
    # Components are those of the axes that a log map from there has.
    axes = ahm.log_map(s, (40, [0.2, 0.3, 0.5])).source.axes
    np.testing.assert_allclose(ahm.transport(s, (40, [0.2, 0.3, 0.5]), [0.6, 0.8]) @ np.array([1, 0]),
                               s.frames[:, 0] @ (0.6 * axes[0] + 0.8 * axes[1]), atol=1e-9)


def test_heat_knows_the_distance_from_several_points(flat_surfaces):
    for kind in ("triangles", "refined", "cloud", "grid"):
        s = flat_surfaces[kind]
        width = 2 if kind == "grid" else 3
        places = np.array([[0.61, 0.83, 0.0], [2.2, 1.9, 0.0], [2.6, 0.1, 0.0]])[:, :width]
        P = np.asarray(s.points)[:, :width]
        away = np.linalg.norm(P[:, None] - places[None], axis=2)
        found = ahm.distance(s, places, method="heat")
        clear = np.diff(np.sort(away, axis=1)[:, :2], axis=1)[:, 0] > 0.75  # heat from two sides mixes at the border
        known = clear | (kind in MESHES)
        np.testing.assert_allclose(found[known], away.min(axis=1)[known], atol=1e-9 if kind in MESHES else 0.125)
        if kind not in MESHES:  # half an edge; rows near the points would be farther off
            rows = away.argmin(axis=0)
            snapped = ahm.distance(s, rows, method="heat")
            assert np.abs(found - away.min(axis=1))[clear].mean() < 0.5 * np.abs(snapped - away.min(axis=1))[clear].mean()
        assert clear.sum() > 60
        gradient = ahm.distance_and_gradient(s, places).gradient
        outward = (P - places[away.argmin(axis=1)]) / away.min(axis=1)[:, None]
        assert np.einsum("ij,ij->i", gradient, outward)[clear & (away.min(axis=1) > 0.3)].min() > 0.95


def test_means_of_points_between_rows_are_means_of_their_positions(flat_surfaces):
    for kind in MESHES + ["cloud", "grid"]:
        s = flat_surfaces[kind]
        width = 2 if kind == "grid" else 3
        points = [list(p[:width]) for p in ([0.61, 0.83, 0.0], [2.2, 1.9, 0.0], [1.9, 0.4, 0.0])] + [4]
        places = np.array([*points[:3], np.asarray(s.points)[4, :width]])
        weights = [1.0, 2.0, 3.0, 0.5]
        for method in ["heat"] + ["exact"] * (kind in MESHES[:2]):
            mean = ahm.karcher_mean(s, points, weights, method=method)
            np.testing.assert_allclose(mean.position, np.average(places, axis=0, weights=weights), atol=1e-8)
            assert mean.converged and mean.residual < 1e-8
            median = ahm.geometric_median(s, points, [1, 9, 1, 1], method=method)
            np.testing.assert_allclose(median.position, places[1], atol=1e-8)
            assert median.residual < 1e-6
            away = np.linalg.norm(np.asarray(s.points)[:, :width] - mean.position, axis=1)
            np.testing.assert_allclose(ahm.log_map(s, mean.point, method=method).distance, away, atol=1e-8)


def test_means_of_the_sphere_are_on_it_and_estimate_their_error(sphere):
    rng = np.random.default_rng(5)
    faces, weights = rng.integers(0, 1280, 9), rng.dirichlet(np.ones(3), 9)
    near = (sphere.points[sphere.faces[faces]].mean(axis=1) @ [0, 0, 1]) > -0.2
    points = (faces[near], weights[near])
    for method, most in (("heat", 0.02), ("exact", 0.01)):
        mean = ahm.karcher_mean(sphere, points, method=method)
        assert mean.converged and 0 < mean.residual < most
        face, inside = mean.point
        np.testing.assert_allclose(inside @ sphere.points[sphere.faces[face]], mean.position, atol=1e-12)
        # From far away, one map is not sufficient: the search has not converged.
        far = ahm.karcher_mean(sphere, points, method=method, max_maps=1, start=[0.9, 0.9, 0.1])
        assert not far.converged and far.residual > mean.residual


def test_graphs_know_where_their_sources_lie(flat_surfaces):
    g = flat_surfaces["triangles"].graph
    placed = ahm.Graph(*g[:6], frames=g.frames, length_unit=g.length_unit)
    m = ahm.log_map(placed, 40)
    np.testing.assert_array_equal(m.source.position, flat_surfaces["triangles"].points[40])
    np.testing.assert_allclose(m.source.axes, g.frames[40, 1:], atol=1e-12)
    bare = ahm.Graph(*g[:6], length_unit=g.length_unit)
    assert ahm.log_map(bare, 40).source[:2] == (None, None) and ahm.log_map(bare, 40).source.row == 40
    assert ahm.karcher_mean(bare, [0, 12]).residual < 1e-9 and ahm.karcher_mean(bare, [0, 12]).position is None


def test_rows_stand_for_points_where_the_result_is_rows(flat_surfaces):
    s = flat_surfaces["triangles"]
    a, b = edge_of(s)
    for point in (((a, b), 0.2), ((b, a), 0.8), (40, [0.8, 0.2, 0.0]), s.points[a] + [0.02, 0.01, 0.0]):
        assert ahm.farthest_points(s, 1, first=point).tolist() == [a]
        assert ahm.atlas(s, [point, 0]).sources.tolist() == [a, 0]


def test_cells_of_any_points_are_those_of_the_nearest(flat_surfaces):
    for kind in ("triangles", "refined"):
        s = flat_surfaces[kind]
        sources = [3, (edge_of(s), 0.4), [2.6, 2.2, 0.0], (70, np.full(len(s.faces[70]), 1 / len(s.faces[70])))]
        places = np.array([ahm.log_map(s, one).source.position for one in sources])
        away = np.linalg.norm(s.points[:, None] - places[None], axis=2)
        clear = np.diff(np.sort(away, axis=1)[:, :2], axis=1)[:, 0] > 1e-9
        for method in ("wavefront", "exact"):
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


def test_noisy_points_are_smoothed_unless_that_is_turned_off(sphere):
    noisy = sphere.points * np.where(np.arange(len(sphere.points)) ** 2 % 7 < 3, 1.05, 0.95)[:, None]
    smoothed = {s: any(w["id"] == "smoothed" for w in ahm.PointCloud(noisy, smooth=s).warnings) for s in (None, 0, 0.5)}
    assert smoothed == {None: True, 0: False, 0.5: True}


@pytest.mark.parametrize("several", [[3], [3, 4], [0, 5, 7], (0, 5, 7), np.array([0, 5, 7]), np.array([[3, 4]]),
                                     np.arange(9, dtype=np.uint8)], ids=str)
def test_integers_are_no_position(sphere, several):
    """They look like rows. Floats are a position."""
    for make in (ahm.log_map, ahm.SurfaceSolver(sphere).log_map, ahm.LogMapSolver(sphere).log_map):
        with pytest.raises(ValueError, match="source: .*use log_maps for several rows"):
            make(*([sphere] if make is ahm.log_map else []), several)
    for call, name in ((lambda: ahm.trace(sphere, several, [1.0, 0, 0]), "start"), (lambda: ahm.geodesic_path(sphere, several, 9), "stops"),
                       (lambda: ahm.geodesic_path(sphere, 9, several), "to"), (lambda: ahm.farthest_points(sphere, 3, several), "first")):
        with pytest.raises(ValueError, match=f"{name}: expected one row, or a position of 3 floats; got integers"):
            call()
    np.testing.assert_array_equal(ahm.log_map(sphere, [0, 0, 1.0]).uv, ahm.log_map(sphere, np.array([0.0, 0.0, 1.0])).uv)
