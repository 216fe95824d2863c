"""Fields, geodesics, local maps and applications against closed forms and each other."""

import math

import numpy as np
import pytest
from scipy.sparse import csgraph

import ahm


def test_local_maps_are_the_maps_around_every_row(flat_surfaces):
    for kind in ("triangles", "refined", "cloud", "grid"):
        s = flat_surfaces[kind]
        maps = ahm.local_maps(s, radius=0.6)
        P = np.asarray(s.points)
        near = np.linalg.norm(P[:, None] - P[None], axis=2) <= 0.6
        assert maps.indptr[-1] == near.sum() and len(maps) == len(s)
        source = np.repeat(np.arange(len(s)), np.diff(maps.indptr))
        assert near[source, maps.indices].all()
        np.testing.assert_allclose(maps.distance, np.linalg.norm(P[source] - P[maps.indices], axis=1), atol=1e-8)
        np.testing.assert_allclose(maps.distance, np.linalg.norm(maps.log, axis=1), atol=1e-12)


def test_local_maps_in_csr_and_padded_hold_the_same_numbers(sphere):
    maps = ahm.local_maps(sphere, 0.4, sources=[5, 0, 77])
    for values in ("distance", "weight", "u", "v", "transport"):
        matrix = maps.csr(values)
        assert matrix.shape == (3, 642) and matrix.indptr.dtype == matrix.indices.dtype
    indices, log = maps.indices.copy(), maps.log.copy()
    near = ahm.local_maps(sphere, 0.4).csr()
    near.sort_indices()
    assert csgraph.connected_components(near)[0] == 1
    distances = csgraph.dijkstra(near, indices=0)
    assert np.abs(distances - np.arccos(np.clip(sphere.points @ sphere.points[0], -1, 1))).max() < 0.1
    assert near.astype("f4").dtype == np.float32 and near[[1, 2]].shape == (2, 642)
    u = maps.csr("u")
    for k in (None, 4):
        padded = maps.padded(k, np.float64)
        assert padded.log.dtype == np.float64 and maps.padded(k).log.dtype == np.float32
        for s in range(3):
            rows = padded.indices[s][padded.mask[s]]
            assert rows[0] == maps.sources[s]
            np.testing.assert_array_equal(padded.log[s, padded.mask[s], 0], u[s].toarray()[0][rows])
            assert (padded.log[s][~padded.mask[s]] == 0).all()
            assert len(rows) == (np.diff(maps.indptr)[s] if k is None else 4)
    u.sort_indices()
    u.data[:] = 0
    np.testing.assert_array_equal(maps.indices, indices)
    np.testing.assert_array_equal(maps.log, log)
    most = ahm.local_maps(sphere, 0.4, k=4, sources=[5, 0, 77])
    np.testing.assert_array_equal(most.padded(dtype=float).log, maps.padded(4, float).log)


def test_local_maps_of_the_nearest_rows_need_no_radius(flat_surfaces):
    for kind in ("triangles", "refined", "cloud"):
        maps = ahm.local_maps(flat_surfaces[kind], k=7)
        P = np.asarray(flat_surfaces[kind].points)
        away = np.sort(np.linalg.norm(P[:, None] - P[None], axis=2), axis=1)[:, :7]
        np.testing.assert_allclose(np.sort(maps.distance.reshape(-1, 7), axis=1), away, atol=1e-8)
    assert np.diff(ahm.local_maps(flat_surfaces["refined"], k=1000, sources=[4]).indptr).tolist() == [143]


def test_distances_by_three_methods_on_the_plane(flat_surfaces):
    s = flat_surfaces["triangles"]
    solver = ahm.LogMapSolver(s)
    P = s.points
    for method, tolerance in (("wavefront", 1e-9), ("exact", 1e-9), ("heat", 1e-9)):
        np.testing.assert_allclose(ahm.distance(solver, 20, method=method), np.linalg.norm(P - P[20], axis=1), atol=tolerance)
    truth = np.minimum(np.linalg.norm(P - P[0], axis=1), np.linalg.norm(P - P[142], axis=1))
    for method in ("wavefront", "exact"):
        found, nearest = ahm.distance_and_nearest(s, [0, 142], method=method)
        np.testing.assert_allclose(found, truth, atol=1e-9)
        clear = np.abs(np.linalg.norm(P - P[0], axis=1) - np.linalg.norm(P - P[142], axis=1)) > 1e-9
        np.testing.assert_array_equal(nearest[clear], (np.linalg.norm(P - P[0], axis=1) > np.linalg.norm(P - P[142], axis=1))[clear])
    assert np.nanmax(ahm.distance(s, 0, radius=1.0)) <= 1.0
    np.testing.assert_array_equal(ahm.distance(s, 0, targets=(1, 2)), ahm.distance(s, 0, targets=[1, 2]))
    np.testing.assert_allclose(ahm.distance(s, [[0.1, 0.2, 0]], targets=[[1.1, 0.2, 0], [0.1, 1.2, 0]], method="exact"), 1.0)


def test_distance_and_gradient_point_away_on_the_plane(flat_surfaces):
    for kind in ("triangles", "cloud"):
        s = flat_surfaces[kind]
        field = ahm.distance_and_gradient(s, 20)
        np.testing.assert_allclose(field.gradient * field.distance[:, None], s.points - s.points[20], atol=1e-9)


def test_transport_keeps_vectors_on_the_plane_and_lengths_on_the_sphere(flat_surfaces, sphere):
    carried = ahm.transport(flat_surfaces["cloud"], 3, [1.0, 2.0, 0.0])
    np.testing.assert_allclose(carried, np.tile([1.0, 2, 0], (143, 1)), atol=1e-9)
    carried = ahm.transport(sphere, 0, [[0, 0, 3.0]])
    length = np.linalg.norm([0, 0, 3.0] - sphere.normals[0] * sphere.normals[0, 2] * 3)
    np.testing.assert_allclose(np.linalg.norm(carried, axis=1), length, rtol=1e-9)
    np.testing.assert_allclose(np.einsum("ij,ij->i", carried, sphere.normals), 0, atol=1e-9)
    # Transport of components in the frames.
    local = sphere.frames[0, :2] @ [0, 0, 3.0]
    frames = ahm.transport(sphere, 0, local)
    np.testing.assert_allclose(np.einsum("ia,iax->ix", frames, sphere.frames[:, :2]), carried, atol=1e-12)


def test_extension_is_the_quotient_of_solutions_by_the_operators(sphere):
    from scipy.sparse.linalg import spsolve

    ops = ahm.operators(sphere, t_coef=2.0)
    solver = ahm.LogMapSolver(sphere, t_coef=2.0)
    values, ones = np.zeros(642), np.zeros(642)
    rows = [3, 300, 555]
    values[rows], ones[rows] = [1.0, -2.0, 5.0], 1.0
    A = ops.A.tocsc()
    np.testing.assert_array_equal(ops.vertex_of_row, np.arange(642))
    expected = spsolve(A, values) / spsolve(A, ones)
    np.testing.assert_allclose(ahm.extend(solver, rows, [1.0, -2.0, 5.0]), expected, rtol=1e-6)


def test_transported_directions_solve_the_connection_operator(sphere):
    from scipy.sparse.linalg import spsolve

    ops = ahm.operators(sphere)
    assert abs(ops.B - ops.B.getH()).max() < 1e-12 and ops.connection_laplacian.dtype == complex
    rhs = np.zeros(642, complex)
    rhs[9] = 0.6 + 0.8j
    y = spsolve(ops.B.tocsc(), rhs)
    carried = ahm.transport(sphere, 9, [0.6, 0.8])
    known = sphere.points @ sphere.points[9] > -0.99  # at the antipode all directions cancel
    np.testing.assert_allclose((carried[:, 0] + 1j * carried[:, 1])[known], (y / np.abs(y))[known], atol=1e-6)


def test_operators_of_reflecting_graphs_are_real_blocks(flat_surfaces):
    for kind in ("cloud", "grid"):
        ops = ahm.operators(flat_surfaces[kind])
        n = len(ops.tau)
        assert ops.B.shape in ((n, n), (2 * n, 2 * n)) and ops.A.shape == (n, n)
        assert abs(ops.B - ops.B.getH()).max() < 1e-12


def test_curvatures_of_the_torus():
    mesh = ahm.TriangleMesh(*ahm.shapes.torus(120, 60))
    k = ahm.curvature(mesh)
    np.testing.assert_allclose(np.abs(k.values[:, 0]), 1 / 0.4, rtol=0.05)
    assert np.abs(k.direction @ np.array([0, 0, 1.0]))[:60].max() > 0.99


def test_paths_are_straight_lines_on_the_plane(flat_surfaces):
    s = flat_surfaces["triangles"]
    path = ahm.geodesic_path(s, [0.1, 0.2, 0], [2.7, 1.9, 0])
    assert path.length == pytest.approx(np.hypot(2.6, 1.7), abs=1e-9)
    line = np.array([2.6, 1.7]) / np.hypot(2.6, 1.7)
    np.testing.assert_allclose((path.points[:, :2] - [0.1, 0.2]) @ [-line[1], line[0]], 0, atol=1e-9)
    np.testing.assert_allclose(path.points[[0, -1]], [[0.1, 0.2, 0], [2.7, 1.9, 0]], atol=1e-12)
    around = ahm.geodesic_path(s, [0, 12, 142], closed=True)
    assert around.length == pytest.approx(3 + 2.5 + np.hypot(3, 2.5))
    legs = ahm.geodesic_paths(s, [0], [12, 142, (3, [0.2, 0.3, 0.5])])
    assert [leg.length for leg in legs[:2]] == pytest.approx([3, np.hypot(3, 2.5)])


def test_traces_undo_paths_and_end_at_the_boundary(sphere, flat_surfaces):
    m = ahm.log_map(sphere, 0, method="exact", u_axis=[0, 0, 1])
    for row in (33, 401):
        along = m.uv[row] @ m.source.axes[:2]
        end = ahm.trace(sphere, 0, along)
        np.testing.assert_allclose(end.points[-1], sphere.points[row], atol=1e-6)
        assert end.complete
    ray = ahm.trace(flat_surfaces["triangles"], 20, [1, 0, 0], 99)
    assert not ray.complete and ray.points[-1][0] == pytest.approx(3)


def test_surfaces_that_are_not_connected_have_no_path():
    V, F = ahm.shapes.plane(3, 3)
    two = ahm.TriangleMesh(np.concatenate([V, V + 9]), np.concatenate([F, F + 9]))
    assert ahm.geodesic_path(two, 0, 9) is None
    assert ahm.geodesic_paths(two, 0, [1, 9])[1] is None
    assert np.isnan(ahm.distance(two, 0)[9:]).all() and np.isnan(ahm.distance(two, 0, method="exact")[9:]).all()


def test_cells_and_spread_points(flat_surfaces):
    s = flat_surfaces["triangles"]
    seeds = ahm.farthest_points(s, 5, first=[0.0, 0.0, 0.0])
    assert seeds.tolist()[:2] == [0, 142] and len(set(seeds.tolist())) == 5
    cells = ahm.cells(s, seeds)
    away = np.linalg.norm(s.points[:, None] - s.points[seeds][None], axis=2)
    np.testing.assert_allclose(cells.distance, away.min(axis=1), atol=1e-9)
    np.testing.assert_allclose(away[np.arange(143), cells.labels], away.min(axis=1), atol=1e-9)


def test_means_and_medians_on_the_plane(flat_surfaces):
    for kind in ("triangles", "cloud"):
        s = flat_surfaces[kind]
        rows = [0, 12, 130, 142, 40]
        weights = [1.0, 2, 1, 1, 3]
        mean = ahm.karcher_mean(s, rows, weights)
        np.testing.assert_allclose(mean.position, np.average(s.points[rows], axis=0, weights=weights), atol=1e-8)
        assert mean.converged
        assert ahm.geometric_median(s, rows, [9.0, 1, 1, 1, 1]).row == 0


def test_strokes_on_the_plane(flat_surfaces):
    for kind in ("triangles", "cloud"):
        s = flat_surfaces[kind]
        found = ahm.stroke(s, [[0.5, 1.25, 0], [2.5, 1.25, 0]])
        assert found.length == pytest.approx(2)
        inside = (s.points[:, 0] > 0.6) & (s.points[:, 0] < 2.4)
        expected = s.points[:, :2] - [0.5, 1.25]
        side = np.sign(found.map.source.axes[2, 2])
        np.testing.assert_allclose(found.map.uv[inside], (expected * [1, side])[inside], atol=1e-6)
        assert found.map.spread.max() < 1e-6 and found.map.quality[inside].min() > 0.5
        beyond = np.maximum(0, np.maximum(0.5 - s.points[:, 0], s.points[:, 0] - 2.5))
        away = np.hypot(beyond, s.points[:, 1] - 1.25)
        np.testing.assert_allclose(found.map.distance, away, atol=1e-6)
        within = ahm.stroke(s, [[0.5, 1.25, 0], [2.5, 1.25, 0]], radius=0.5).map
        clear = np.abs(away - 0.5) > 1e-6
        np.testing.assert_array_equal(within.ok[clear], (away < 0.5)[clear])
        np.testing.assert_array_equal(np.isnan(within.angle), ~within.ok)


def test_decals_keep_their_area_and_paint_rows(flat_surfaces):
    m = ahm.log_map(flat_surfaces["triangles"], 70, u_axis=[1, 0, 0])
    piece = ahm.decal(m, 1.1, 0.7, angle=0.3)
    area = sum(np.linalg.norm(np.cross(piece.points[f[k]] - piece.points[f[0]], piece.points[f[k + 1]] - piece.points[f[0]])) / 2
               for f in piece.faces for k in range(1, len(f) - 1))
    assert area == pytest.approx(1.1 * 0.7) and piece.uv.min() >= 0 and piece.uv.max() <= 1
    places = ahm.decal_coordinates(m, 1.1, 0.7)
    np.testing.assert_allclose(places[70], 0.5)


def test_isolines_of_the_height_of_a_sphere_are_circles():
    points, faces = ahm.shapes.sphere(4)
    lines = ahm.isolines((points, faces), points[:, 2], every=0.4)
    assert [line.level for line in lines] == pytest.approx([-0.8, -0.4, 0, 0.4, 0.8])
    for line in lines:
        assert line.closed and line.length == pytest.approx(2 * np.pi * np.sqrt(1 - line.level**2), rel=0.01)
        assert np.allclose(line.points[:, 2], line.level)


def test_a_tool_path_covers_a_box_and_its_top():
    corners = np.array([[x, y, z] for x in (0, 4) for y in (0, 3) for z in (0, 2)], float)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    box = ahm.PolygonMesh(corners, faces)
    path = ahm.tool_path(box, 0.3)
    assert path.measures["area"] == pytest.approx(52)
    assert path.measures["covered"] > 0.99 and path.measures["double_covered"] < 0.03
    assert np.allclose(np.sum(path.axis * path.travel, axis=1), 0, atol=1e-9)
    assert set(path.kind) <= {"pass", "link", "approach", "retreat"}
    for near, length in (([2, 0, 2.0], 4), ([4, 1.5, 0.1], 3)):
        edge = ahm.tool_path(box, 0.3, feature=1.5, near=near)
        assert [p.length for p in edge.passes if p.kind == "seed"] == pytest.approx([length])
    for extra, message in (({"feature": 0}, "in \\(0, 180\\]"), ({"near": [0, 0, 0.0]}, "near: has no effect without feature"),
                           ({"feature": 1.5, "near": [0, 0, 9.0]}, "the point near the feature edge is 7")):
        with pytest.raises(ValueError, match=message):
            ahm.tool_path(box, 0.3, **extra)
    top = ahm.tool_path(box, 0.3, facing=[0, 0, 1], plane=([0, 1, 0], [0, 1, 0]), one_way=True)
    on_passes = np.concatenate([np.arange(p.begin, p.end) for p in top.passes])
    assert np.allclose(top.position[on_passes, 2], 2) and (np.abs(top.travel[on_passes, 0]) > 0.99).all()
    assert top.measures["area"] == pytest.approx(12)
    assert ahm.tool_path(box, 0.3, rows=corners[:, 2] == 2).measures["area"] == pytest.approx(12)
    with pytest.raises(ValueError, match="array of bool"):
        ahm.tool_path(box, 0.3, rows=[0, 1])
    with pytest.raises(ValueError, match="point 0 of the seed curve is 1"):
        ahm.tool_path(box, 0.3, curve=[[0, 0, 3], [4, 0, 2]])
    ring = [[1, 1, 2], [3, 1, 2], [3, 2, 2], [1, 2, 2]]
    for extra, message in (({"max_angle": 0.5}, "max_angle: has no effect without facing"), ({"closed": True}, "closed: has no effect")):
        with pytest.raises(ValueError, match=message):
            ahm.tool_path(box, 0.3, **extra)
    for side, area in (("inside", 2), ("outside", 50)):
        assert ahm.tool_path(box, 0.3, **{side: ring}).measures["area"] == pytest.approx(area, abs=0.01)
    for arguments, message in (((5.1e3,), "larger than the region"), ((-1,), "spacing"), ((1, "top"), "seed")):
        with pytest.raises(ValueError, match=message):
            ahm.tool_path(box, arguments[0], **({"seed": arguments[1]} if len(arguments) > 1 else {}))


def test_tool_paths_start_at_lines_and_cover_discs():
    points, faces = ahm.shapes.plane(41, 31)  # 40 by 30 units
    plate = ahm.TriangleMesh(points, faces)
    middle = [20.0, 15.0, 0.0]
    row = int(np.argmin(np.linalg.norm(points - middle, axis=1)))
    u = ahm.log_map(plate, row).source.axes[0]
    for line, along in (((row, [1, 2, 0]), [1, 2]), ((middle, [1, 2, 0]), [1, 2]), ((row, math.pi / 2), [-u[1], u[0]])):
        path = ahm.tool_path(plate, 4, line=line)
        seeds = [p for p in path.passes if p.kind == "seed"]
        assert len(seeds) == 1 and path.measures["covered"] > 0.99
        offset = path.position[seeds[0].begin:seeds[0].end, :2] - middle[:2]
        assert np.abs(offset @ [-along[1], along[0]]).max() < 1e-9 * np.abs(offset).max()
    for center in (row, middle):
        disc = ahm.tool_path(plate, 1, center=center, radius=9.0)
        assert np.linalg.norm(disc.position[disc.kind == "pass"] - middle, axis=1).max() < 9 + 1e-9
        assert math.pi * 8.6**2 < disc.measures["area"] < math.pi * 9**2  # whole triangles with sides up to 0.4 spacings
    for arguments, message in (({"line": ([20, 15, 9.0], [1, 0, 0])}, "the point of the seed line is 9 from the surface"),
                               ({"line": (row, [0, 0, 1])}, "perpendicular to the surface"),
                               ({"line": (row, 1.0), "seed": "boundary"}, "use one of seed, plane, curve, line and feature"),
                               ({"line": (5000, 1.0)}, r"line\[0\]: row 5000 is out of range"),
                               ({"line": (row, math.nan)}, r"line\[1\]"),
                               ({"center": [20, 15, 9.0], "radius": 5}, "the center of the region is 9 from the surface"),
                               ({"center": row}, "center: has no effect without radius"),
                               ({"radius": 3}, "radius: has no effect without center"),
                               ({"center": row, "radius": -1}, "radius")):
        with pytest.raises(ValueError, match=message):
            ahm.tool_path(plate, 4, **arguments)
    with pytest.raises(TypeError, match=r"line: expected \(point, direction\)"):
        ahm.tool_path(plate, 4, line=row)


def test_poses_of_a_tool_path_are_rotations_by_the_quaternion():
    path = ahm.tool_path(ahm.shapes.sphere(2), 0.4, lead=0.2)
    w, x, y, z = path.quaternion.T
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    np.testing.assert_allclose(path.poses[:, :3, :3], np.moveaxis(rotation, 2, 0), atol=1e-12)
    np.testing.assert_array_equal(path.poses[:, :3, 3], path.position)
    np.testing.assert_array_equal(path.poses[:, 3], np.tile([0, 0, 0, 1], (len(path.kind), 1)))


def test_closed_passes_are_joined_to_a_spiral():
    bowl = ahm.shapes.sphere(3)
    keep = bowl[0][:, 2] < 0.3
    path = ahm.tool_path(bowl, 0.1, rows=keep, seed="boundary", spiral=True)
    assert [p.kind for p in path.passes].count("spiral") == 1
    assert path.measures["covered"] > 0.99 and path.measures["double_covered"] < 0.03


def test_tool_paths_are_programs_and_messages():
    path = ahm.tool_path(ahm.shapes.sphere(2), 0.5, lead=0.1, offset=0.2)
    assert np.linalg.norm(path.position - path.contact, axis=1).max() > 0.19
    program = path.gcode(800, axes=5).splitlines()
    assert program[-1] == "M2" and sum("F800" in line for line in program) == 1
    assert "G64 P0.0025" in program[3] and path.chord_error == 0.0025  # a 200th of the spacing
    assert "G61" in path.gcode(800, axes=5, blend=0).splitlines()
    with pytest.raises(ValueError, match="faces sideways or down"):
        path.gcode(800)
    torn = path._replace(kind=np.where(np.arange(len(path.kind)) == 30, "missing", path.kind))
    for write in (lambda: torn.gcode(800, axes=5), torn.ros_yaml):
        with pytest.raises(ValueError, match="1 missing link"):
            write()
    yaml = pytest.importorskip("yaml")
    for message in ("PoseArray", "Path"):
        documents = list(yaml.safe_load_all(path.ros_yaml(message, frame='the "part"', feed=60)))
        assert len(documents) == 1 and documents[0]["header"]["frame_id"] == 'the "part"'
        poses = [p["pose"] if message == "Path" else p for p in documents[0]["poses"]]
        np.testing.assert_array_equal([[p["position"][c] for c in "xyz"] for p in poses], path.position)
        np.testing.assert_array_equal([[p["orientation"][c] for c in "wxyz"] for p in poses], path.quaternion)
        if message == "Path":
            stamps = [p["header"]["stamp"]["secs"] + 1e-9 * p["header"]["stamp"]["nsecs"] for p in documents[0]["poses"]]
            np.testing.assert_allclose(stamps, path.arclength, atol=1e-9)
        try:  # Debian: python3-genpy python3-geometry-msgs python3-nav-msgs
            import genpy
            from geometry_msgs.msg import PoseArray
            from nav_msgs.msg import Path
        except ImportError:
            continue
        filled = {"PoseArray": PoseArray, "Path": Path}[message]()
        genpy.message.fill_message_args(filled, documents)  # as `rostopic pub -f`
        filled._check_types()
        assert len(filled.poses) == len(path.position)


def test_coverage_lines_are_equally_spaced_on_the_plane(flat_surfaces):
    m = ahm.log_map(flat_surfaces["triangles"], 70, u_axis=[1, 0, 0])
    for pattern in ("raster", "spiral"):
        path = ahm.coverage(m, 1.0, 0.2, pattern=pattern)
        assert np.linalg.norm(path.position - m.source.position, axis=1).max() <= 1.0 + 1e-9
        np.testing.assert_allclose(np.einsum("ij,ij->i", path.normal, path.heading), 0, atol=1e-12)
    path = ahm.coverage(m, 1.0, 0.2)
    assert path.pieces == len(set(path.piece.tolist())) and np.nanmax(np.abs(path.spacing - 0.2)) < 1e-9


def test_atlases_cover_every_face_and_stay_within_the_texture():
    mesh = ahm.TriangleMesh(*ahm.shapes.torus(40, 20))
    rough = ahm.atlas(mesh, [0, 400], size=512)
    fine = ahm.atlas(mesh, charts=4, max_distortion=1.5, size=512)
    assert fine.distortion["percentile_95"] < 1.5 and len(fine.sources) > len(rough.sources)
    assert (fine.chart >= 0).all() and fine.uv.min() >= 0 and fine.uv.max() <= 1
    assert fine.faces.shape == (1600, 3) and fine.uv.shape == (4800, 2)
    mixed = ahm.PolygonMesh(ahm.shapes.plane(3, 2)[0], [[0, 1, 4, 3], [1, 2, 5], [1, 5, 4]])
    assert [len(f) for f in ahm.atlas(mixed, charts=1, size=64).faces] == [4, 3, 3]


def test_clouds_have_atlases_too(sphere):
    a = ahm.atlas(ahm.PointCloud(sphere.points, sphere.points), charts=8, size=256)
    assert len(a.faces) > 1000 and len(a.points) == 642


def test_local_maps_have_a_method(sphere):
    by = {method: ahm.local_maps(sphere, 0.4, method=method) for method in ("auto", "polar", "heat")}
    assert [maps.method for maps in by.values()] == ["polar", "polar", "heat"]
    assert np.array_equal(by["auto"].log, by["polar"].log)
    whole = ahm.PolarMapSolver(sphere).log_map(7)
    entries = slice(by["polar"].indptr[7], by["polar"].indptr[8])
    near = by["polar"].indices[entries]
    assert np.allclose(by["polar"].log[entries], whole.uv[near], atol=1e-12)
    assert set(near) == set(np.flatnonzero(whole.distance <= 0.4))
    for solver, method in ((ahm.PolarMapSolver(sphere), "polar"), (ahm.SurfaceSolver(sphere, "polar"), "polar"),
                           (ahm.LogMapSolver(sphere), "heat"), (ahm.SurfaceSolver(sphere, "heat"), "heat")):
        maps = ahm.local_maps(solver, 0.4) if not isinstance(solver, ahm.SurfaceSolver) else solver.local_maps(0.4)
        assert maps.method == method and np.array_equal(maps.log, by[method].log)
    assert ahm.local_maps(sphere, 0.4, variant="localized", sources=[0]).method == "heat"
    with pytest.raises(TypeError, match="margin: method 'polar' has no such option"):
        ahm.local_maps(sphere, 0.4, method="polar", margin=3)
    grid = ahm.local_maps(ahm.Grid((9, 7), 0.5), 0.8, method="polar")
    assert np.allclose(grid.distance, np.hypot(*grid.log.T)) and len(grid) == 63


def test_local_maps_are_edges_with_transports(sphere):
    maps = ahm.local_maps(sphere, k=9)
    edges = maps.edge_index()
    assert edges.shape == (2, 9 * len(sphere)) and edges.dtype == np.int64 and edges.flags.c_contiguous
    matrix = maps.coo("transport")
    assert np.array_equal(edges, [matrix.col, matrix.row])
    assert np.array_equal(maps.transport.view(complex)[:, 0], matrix.data)
    # Opposite edges have opposite transports.
    there = {(i, j): z for j, i, z in zip(*edges, matrix.data)}
    assert max(abs(z * there[j, i] - 1) for (i, j), z in there.items() if (j, i) in there) < 1e-9
    without = ahm.local_maps(sphere, k=9, transport=False)
    assert without.transport is None and np.array_equal(without.log, maps.log)
    assert without.padded().transport is None and without.quality is None
    for values in ("transport", "quality"):
        with pytest.raises(ValueError, match=f"{values}=True"):
            without.csr(values)
    judged = ahm.local_maps(sphere, k=9, quality=True)
    assert np.array_equal(judged.csr("quality").data, judged.quality) and judged.padded().quality.shape == (len(sphere), 9)
    assert 0.9 < judged.quality.min() <= judged.quality.max() <= 1
    with pytest.raises(ValueError, match=r"sources\[0\]: not a row"):
        ahm.local_maps(sphere, 0.3, sources=[[0, 0, 1.0], [0.6, 0, 0.8]]).edge_index()
