"""Exact geodesics from Python: maps and curves."""

import pickle

import numpy as np
import pytest

import ahm


@pytest.fixture(scope="module")
def torus():
    return ahm.TriangleMesh(*ahm.shapes.torus(48, 24))


def test_many_exact_maps_are_the_single_ones(sphere):
    geodesics = ahm.ExactGeodesics(sphere)
    sources = [0, 77, (5, [0.2, 0.3, 0.5])]
    for threads in (1, 3):
        for m, source in zip(geodesics.log_maps(sources, frames=True, threads=threads), sources):
            single = ahm.log_map(sphere, source, method="exact")
            assert m.method == "exact"
            np.testing.assert_array_equal(m.uv, single.uv)
            np.testing.assert_array_equal(m.frames, single.frames)
    near = geodesics.log_maps(sources, radius=0.5)[0]
    assert near.distance[near.ok].max() <= 0.5 and not near.ok.all()


def test_every_function_of_maps_takes_exact_geodesics(sphere):
    geodesics = ahm.ExactGeodesics(sphere)
    functions = {
        "log_map": lambda s, **o: ahm.log_map(s, 5, **o).distance,
        "stroke": lambda s, **o: ahm.stroke(s, [0, 40, 77], **o).map.distance,
        "cells": lambda s, **o: ahm.cells(s, [0, 40], **o).distance,
        "farthest_points": lambda s, **o: ahm.farthest_points(s, 9, **o),
        "karcher_mean": lambda s, **o: ahm.karcher_mean(s, [0, 40, 77], **o).spread,
        "geometric_median": lambda s, **o: ahm.geometric_median(s, [0, 40, 77], **o).spread,
        "atlas": lambda s, **o: ahm.atlas(s, [0, 40], size=64, **o).distortion["mean"],
    }
    for name, call in functions.items():
        np.testing.assert_array_equal(call(geodesics, method="exact"), call(geodesics), err_msg=name)
        np.testing.assert_array_equal(call(sphere, method="exact"), call(geodesics), err_msg=name)
    chosen = ahm.farthest_points(geodesics, 9)
    for k in range(1, 9):
        before = ahm.distance(sphere, chosen[:k], method="exact")
        assert before[chosen[k]] == before.max()


def test_tool_paths_lie_on_the_faces(sphere):
    m = ahm.log_map(sphere, 5, method="exact")
    path = ahm.coverage(m, 1.0, 0.25, step=0.5)
    assert path.between.dtype == bool and path.between.any() and not path.between.all()
    inside = path.piece[1:] == path.piece[:-1]
    middle = (path.position[1:] + path.position[:-1])[inside] / 2
    assert sphere.closest_points(middle).distance.max() < 1e-12
    np.testing.assert_allclose(np.diff(path.arclength)[inside], np.linalg.norm(np.diff(path.position, axis=0), axis=1)[inside],
                               atol=1e-12)


def test_exact_geodesics_and_their_maps_pickle(sphere):
    geodesics = ahm.ExactGeodesics(sphere)
    assert repr(pickle.loads(pickle.dumps(geodesics))) == repr(geodesics)
    for m in (geodesics.log_map(((0, int(sphere.faces[0, 1])), 0.5)) if 0 in sphere.faces[0] else geodesics.log_map(3),
              geodesics.log_maps([3, 4])[1], ahm.stroke(geodesics, [0, 40]).map):
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(m)).uv, m.uv)


def test_lengths_scale_with_the_mesh():
    V, F = ahm.shapes.sphere(2)
    one = ahm.TriangleMesh(V, F)
    for scale in (1e-200, 1e-30, 3e40):
        s = ahm.TriangleMesh(scale * V, F)
        for get in (lambda t, r: ahm.distance(t, 0, method="exact"),
                    lambda t, r: ahm.distance(t, 0, method="exact", radius=r),
                    lambda t, r: ahm.distance(t, 0, targets=[(3, [0.2, 0.3, 0.5])], method="exact"),
                    lambda t, r: ahm.geodesic_path(t, 0, 9).length, lambda t, r: ahm.geodesic_paths(t, 0, [5])[0].length,
                    lambda t, r: ahm.geodesic_paths(t, [0], [5], pairwise=True)[0].length,
                    lambda t, r: ahm.geodesic_path(t, 0, 5, fast=True).length, lambda t, r: ahm.trace(t, 0, [r, r, 0], r).length,
                    lambda t, r: ahm.ExactGeodesics(t).log_map(0).distance, lambda t, r: ahm.distance(t, 0),
                    lambda t, r: ahm.log_map(t, 0).distance):
            np.testing.assert_allclose(get(s, scale), scale * np.asarray(get(one, 1.0)), rtol=1e-9)


def test_applications_are_exact_on_the_plane(flat_surfaces):
    for kind in ("triangles", "refined"):
        s = flat_surfaces[kind]
        geodesics = ahm.ExactGeodesics(s)
        for maker, method in ((geodesics, None), (s, "exact"), (ahm.LogMapSolver(s), "exact")):
            line = ahm.stroke(maker, [[0.5, 1.25, 0], [2.5, 1.25, 0]], method=method)
            inside = (s.points[:, 0] > 0.6) & (s.points[:, 0] < 2.4)
            side = np.sign(line.map.source.axes[2, 2])
            np.testing.assert_allclose(line.map.uv[inside], ((s.points[:, :2] - [0.5, 1.25]) * [1, side])[inside], atol=1e-9)
            assert line.map.method == "exact" and line.length == pytest.approx(2) and line.gap == pytest.approx(0, abs=1e-12)
            rows = [0, 12, 130, 142, 40]
            mean = ahm.karcher_mean(maker, rows, method=method or "auto")
            np.testing.assert_allclose(mean.position, s.points[rows].mean(axis=0), atol=1e-9)
            assert ahm.geometric_median(maker, rows, [9.0, 1, 1, 1, 1], method=method or "auto").row == 0
            charts = ahm.atlas(maker, [0, 142], method=method, size=128)
            assert (charts.chart >= 0).all() and charts.distortion["largest"] == pytest.approx(1, abs=1e-9)


def test_strokes_take_coordinates_of_their_own(flat_surfaces):
    for kind in ("triangles", "cloud"):
        s = flat_surfaces[kind]
        ends = [[0.5, 1.25, 0], [2.5, 1.25, 0]]
        plain = ahm.stroke(s, ends).map.uv
        moved = ahm.stroke(s, ends, positions=[[7.0, 1.0], [9.0, 1.0]]).map.uv
        np.testing.assert_allclose(moved, plain + [7.0, 1.0], atol=1e-6)
        turned = ahm.stroke(s, ends, positions=[[0.0, 0.0], [0.0, 2.0]]).map
        np.testing.assert_allclose(turned.uv, plain[:, ::-1] * [-1, 1], atol=1e-6)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(turned)).uv, turned.uv)


def test_local_strokes_are_strokes_nearby(flat_surfaces, sphere):
    for s, ends, radius in ((flat_surfaces["triangles"], [[0.5, 1.25, 0], [2.5, 1.25, 0]], 0.5),
                            (flat_surfaces["cloud"], [[0.5, 1.25, 0], [2.5, 1.25, 0]], 0.5), (sphere, [0, 40], 0.3)):
        near, whole = ahm.local_stroke(s, ends, radius, margin=8.0), ahm.stroke(s, ends)
        away, between_samples = whole.map.distance, s.mean_edge_length / 4
        assert set(np.flatnonzero(away <= radius - between_samples)) <= set(near.rows) <= set(np.flatnonzero(away <= radius + 1e-9))
        np.testing.assert_allclose(near.uv, whole.map.uv[near.rows], atol=1e-5)
        assert near.length == whole.length and (np.diff(near.distance) >= 0).all()


def test_points_of_paths_are_points_of_the_inputs_faces(sphere, flat_surfaces):
    V, F = ahm.shapes.sphere(3)
    rng = np.random.default_rng(5)
    turned = np.where(rng.random(len(F))[:, None] < 0.5, F, F[:, ::-1])
    for mesh in (sphere, ahm.TriangleMesh(V, turned), ahm.TriangleMesh(V, np.roll(turned, 1, axis=1))):
        for path in (ahm.geodesic_path(mesh, 0, 400), ahm.trace(mesh, (5, [0.2, 0.3, 0.5]), [1, 2, 3], 2.0),
                     *ahm.geodesic_paths(mesh, 0, [(9, [0.1, 0.1, 0.8]), 77])):
            np.testing.assert_allclose(np.einsum("kc,kcx->kx", path.barycentric, mesh.points[mesh.faces[path.face]]),
                                       path.points, atol=1e-12)
            there = ahm.log_map(mesh, (int(path.face[1]), path.barycentric[1]), method="exact").source.position
            np.testing.assert_allclose(there, path.points[1], atol=1e-9)
    s = flat_surfaces["refined"]
    path = ahm.geodesic_path(s, 0, [2.7, 1.9, 0])
    for point, face, weights in zip(path.points, path.face, path.barycentric):
        np.testing.assert_allclose(weights @ s.points[s.faces[face]], point, atol=1e-9)
    assert len(ahm.distance(s, list(zip(path.face, path.barycentric)), method="exact")) == len(s)


def test_paths_pass_over_faces_without_area():
    """Faces whose corners coincide are left out of the triangles, and all others keep their numbers."""
    V, F = ahm.shapes.plane(6, 6)
    V = np.concatenate([V, V[[7]]])  # row 36 is at the position of row 7; a sliver connects them
    around = (F == 7).any(axis=1)
    upper = V[F].mean(axis=1)[:, 1] > 1
    F = np.where((F == 7) & (around & upper)[:, None], 36, F)
    mesh = ahm.TriangleMesh(V, np.concatenate([[[7, 8, 36], [6, 7, 36]], F]))
    assert mesh.report["dropped_faces"] == 2
    path = ahm.geodesic_path(mesh, [0.2, 0.7, 0], [4.7, 3.9, 0])
    np.testing.assert_allclose(np.einsum("kc,kcx->kx", path.barycentric, V[mesh.faces[path.face]]), path.points, atol=1e-9)


def test_closed_geodesics_of_the_torus_are_its_circles(torus):
    V = torus.points
    inner = ahm.geodesic_loop(torus, [12, 24 * 16 + 13, 24 * 32 + 11])  # around the hole, near the inner equator
    assert inner.length == pytest.approx(2 * 48 * 0.6 * np.sin(np.pi / 48), rel=1e-9)
    np.testing.assert_allclose(np.hypot(*inner.points[:, :2].T), 0.6, atol=2e-3)
    np.testing.assert_allclose(inner.points[0], inner.points[-1], atol=1e-9)
    tube = ahm.geodesic_loop(torus, [3, 11, 19], fast=True)
    assert tube.length == pytest.approx(2 * np.pi * 0.4, rel=0.01) and tube.length <= 2 * 24 * 0.4 * np.sin(np.pi / 24) + 1e-9
    through = ahm.geodesic_path(torus, [3, 11, 19], closed=True)
    assert tube.length <= through.length and all(np.linalg.norm(through.points - V[r], axis=1).min() < 1e-12 for r in (3, 11, 19))


def test_loops_around_nothing_shrink_and_taut_paths_keep_their_ends(flat_surfaces):
    s = flat_surfaces["triangles"]
    assert ahm.geodesic_loop(s, [0, 12, 142]).length == pytest.approx(0, abs=1e-9)
    bent = ahm.geodesic_path(s, [0, 12, 142])
    taut = ahm.geodesic_path(s, [0, 12, 142], taut=True)
    assert bent.length == pytest.approx(5.5) and taut.length == pytest.approx(np.hypot(3, 2.5))
    np.testing.assert_allclose(taut.points[[0, -1]], s.points[[0, 142]], atol=1e-12)
    for closed in (False, True):
        nothing = ahm.geodesic_path(s, 5, 5, taut=True, closed=closed)
        assert nothing.length == 0 and np.array_equal(nothing.points[0], s.points[5])


def test_paths_and_traces_of_flat_clouds_are_straight(flat_surfaces):
    cloud = flat_surfaces["cloud"]
    start, end = np.array([0.5, 1.25, 0.0]), np.array([2.5, 0.75, 0.0])
    path = ahm.geodesic_path(cloud, start, end)
    assert path.face is None and path.barycentric is None and path.complete
    assert path.length == pytest.approx(np.linalg.norm(end - start), abs=1e-12)
    assert np.allclose(path.points[[0, -1]], [start, end], atol=1e-12)
    assert np.abs(np.cross(path.points - start, end - start)).max() < 1e-12
    line = ahm.trace(cloud, start, end - start)
    assert np.allclose(line.points[-1], end, atol=1e-12) and line.complete
    assert not ahm.trace(cloud, start, [1, 0, 0], 50).complete
    for option in ("fast", "taut"):
        with pytest.raises(ValueError, match=option + ".*faces"):
            ahm.geodesic_path(cloud, 0, 5, **{option: True})


def test_paths_over_clouds_go_in_pairs(sphere):
    cloud = ahm.PointCloud(sphere.points)
    starts, ends = [0, 5, [0.0, 0.6, 0.8]], [600, 7, 30]
    for path, a, b in zip(ahm.geodesic_paths(cloud, starts, ends, pairwise=True), starts, ends):
        np.testing.assert_array_equal(path.points, ahm.geodesic_path(cloud, a, b).points)
    apart = ahm.PointCloud(np.concatenate([sphere.points, sphere.points + 9]))
    found = ahm.geodesic_paths(apart, [0, 0], [5, 700], pairwise=True)
    assert found[0].length > 0 and found[1] is None
    with pytest.raises(ValueError, match="pairwise: .*pairwise=True"):
        ahm.geodesic_paths(cloud, [0], [5, 6])
    with pytest.raises(ValueError, match="fast: requires faces"):
        ahm.geodesic_paths(cloud, [0], [5], pairwise=True, fast=True)


def test_paths_in_pairs_are_the_single_ones(torus):
    starts, ends = [0, 5, 0, (7, [0.2, 0.3, 0.5])], [600, 7, 30, [1.4, 0, 0]]
    pairs = ahm.geodesic_paths(torus, starts, ends, pairwise=True)
    for path, a, b in zip(pairs, starts, ends):
        assert path.length == pytest.approx(ahm.geodesic_path(torus, a, b).length, rel=1e-12)
    for path, fast in zip(pairs, ahm.geodesic_paths(torus, starts, ends, pairwise=True, fast=True)):
        assert fast.length >= path.length - 1e-12
    nearest = ahm.geodesic_paths(torus, [0, 600], [30, 610])
    away = [[ahm.geodesic_path(torus, a, b).length for a in (0, 600)] for b in (30, 610)]
    assert [p.length for p in nearest] == pytest.approx(np.min(away, axis=1))
