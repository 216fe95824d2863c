"""The same function in other libraries gives the same values. docs/reference/parity.md lists the functions; scripts/parity.sh runs this."""

import subprocess
from pathlib import Path

import nibabel
import numpy as np
import open3d
import pytest
import vtk
from scipy.interpolate import NearestNDInterpolator
from scipy.sparse import csgraph, csr_matrix
from scipy.spatial import cKDTree
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import ahm
import ahm.potpourri3d as pp3d

CGAL = Path(__file__).resolve().parents[2] / "build/parity/cgal_distances"


@pytest.fixture(scope="module")
def bumpy():
    """A closed surface with hills and valleys: 2562 vertices, 5120 faces."""
    V, F = ahm.shapes.sphere(4)
    return V * (1 + 0.2 * np.sin(5 * V[:, :1]) * np.cos(4 * V[:, 1:2] + 1)), F


@pytest.fixture(scope="module")
def sheet():
    """A plane of 41 x 31 vertices, 0.25 apart. Geodesic distances are straight."""
    return ahm.shapes.plane(41, 31, 0.25)


@pytest.fixture(scope="module")
def of_cgal(bumpy, tmp_path_factory):
    """Exact distances and distances by the heat method from row 7."""
    path = tmp_path_factory.mktemp("cgal") / "bumpy.off"
    pp3d.write_mesh(*bumpy, path)
    lines = subprocess.run([CGAL, path, "7"], capture_output=True, text=True, check=True).stdout.splitlines()
    return np.array([[float(x) for x in line.split()] for line in lines]).T


def in_vtk(V, F=None):
    result, points = vtk.vtkPolyData(), vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(V, float), deep=True))
    result.SetPoints(points)
    if F is not None:
        cells = vtk.vtkCellArray()
        cells.SetCells(len(F), numpy_to_vtkIdTypeArray(np.column_stack([np.full(len(F), 3), F]).ravel().astype(np.int64), deep=True))
        result.SetPolys(cells)
    return result


def run(algorithm, data):
    algorithm.SetInputData(data)
    algorithm.Update()
    return algorithm.GetOutput()


def in_open3d(V, F):
    return open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(V), open3d.utility.Vector3iVector(F))


def edge_graph(V, F):
    a, b = pp3d.edges(V, F).T
    length = np.linalg.norm(V[a] - V[b], axis=1)
    return csr_matrix((np.r_[length, length], (np.r_[a, b], np.r_[b, a])), (len(V), len(V)))


def angle_between(a, b):
    """In degrees, of unit vectors; their signs are ignored."""
    return np.degrees(np.arccos(np.clip(abs(np.einsum("ij,ij->i", a, b)), 0, 1)))


def test_exact_distances_are_those_of_cgal(bumpy, of_cgal):
    np.testing.assert_allclose(ahm.distance(bumpy, 7, method="exact"), of_cgal[0], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(ahm.log_map(bumpy, 7, method="exact").distance, of_cgal[0], rtol=1e-9, atol=1e-12)


def test_shortest_paths_have_the_length_of_cgal(bumpy, of_cgal):
    targets = np.arange(0, 2562, 40)
    for path, length in zip(ahm.geodesic_paths(bumpy, 7, targets), of_cgal[0][targets]):
        assert np.linalg.norm(np.diff(path.points, axis=0), axis=1).sum() == pytest.approx(length, rel=1e-9, abs=1e-12)
    assert ahm.geodesic_path(bumpy, 7, 2000).length == pytest.approx(of_cgal[0][2000], rel=1e-9)


def test_heat_distances_are_as_accurate_as_those_of_cgal(bumpy, of_cgal):
    """Both differ from the exact distance; this library must not differ more."""
    exact, theirs = of_cgal[:2]
    ours = pp3d.MeshHeatMethodDistanceSolver(*bumpy).compute_distance(7)
    assert abs(ours - exact).mean() <= abs(theirs - exact).mean()
    assert abs(ahm.distance(bumpy, 7) - exact).mean() <= abs(theirs - exact).mean()


def test_shortest_paths_are_at_most_the_edge_paths_of_vtk_and_scipy(bumpy):
    V, F = bumpy
    along_edges = csgraph.dijkstra(edge_graph(V, F), indices=7)
    assert (ahm.distance(bumpy, 7, method="exact") <= along_edges * (1 + 1e-12)).all()
    for target in (99, 1500, 2561):
        dijkstra = vtk.vtkDijkstraGraphGeodesicPath()
        dijkstra.SetStartVertex(7)
        dijkstra.SetEndVertex(target)
        points = vtk_to_numpy(run(dijkstra, in_vtk(V, F)).GetPoints().GetData())
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        assert length == pytest.approx(along_edges[target], rel=1e-5)
        assert 0.8 * length < ahm.geodesic_path(bumpy, 7, target).length <= length


def test_distances_agree_with_connectome_workbench(bumpy, tmp_path):
    """Its paths are edges and straight lines over pairs of triangles: at least as long as shortest paths, at most as edge paths."""
    V, F = bumpy
    surface, out = tmp_path / "bumpy.surf.gii", tmp_path / "distance.func.gii"
    intents = nibabel.nifti1.intent_codes
    image = nibabel.gifti.GiftiImage(darrays=[
        nibabel.gifti.GiftiDataArray(V.astype(np.float32), intents["NIFTI_INTENT_POINTSET"]),
        nibabel.gifti.GiftiDataArray(F.astype(np.int32), intents["NIFTI_INTENT_TRIANGLE"])])
    image.darrays[0].meta["AnatomicalStructurePrimary"] = "CortexLeft"
    nibabel.save(image, surface)
    subprocess.run(["wb_command", "-surface-geodesic-distance", surface, "7", out], check=True, capture_output=True)
    theirs = nibabel.load(out).darrays[0].data
    ours = ahm.distance(tuple(array.data for array in nibabel.load(surface).darrays), 7, method="exact")
    along_edges = csgraph.dijkstra(edge_graph(V, F), indices=7)
    assert (ours <= theirs * (1 + 1e-6)).all() and (theirs <= along_edges * (1 + 1e-6)).all()
    assert np.median(theirs[ours > 0] / ours[ours > 0]) < 1.05


def test_curvatures_agree_with_vtk():
    V, F = ahm.shapes.torus(96, 48)
    ours = ahm.curvature((V, F)).values
    for kind, values, scale in ((vtk.vtkCurvatures.SetCurvatureTypeToGaussian, ours.prod(axis=1), 6.25),
                                (vtk.vtkCurvatures.SetCurvatureTypeToMean, ours.mean(axis=1), 2.5)):
        curvatures = vtk.vtkCurvatures()
        kind(curvatures)
        theirs = vtk_to_numpy(run(curvatures, in_vtk(V, F)).GetPointData().GetScalars())
        assert np.median(abs(abs(values) - abs(theirs))) < 0.02 * scale


def test_closest_points_are_those_of_vtk_and_open3d(bumpy):
    V, F = bumpy
    queries = np.random.default_rng(3).normal(size=(300, 3))
    ours = ahm.TriangleMesh(V, F).closest_points(queries)
    locator, at = vtk.vtkCellLocator(), [0.0, 0.0, 0.0]
    locator.SetDataSet(in_vtk(V, F))
    locator.BuildLocator()
    cell, part, squared = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    for query, distance in zip(queries, ours.distance):
        locator.FindClosestPoint(query, at, cell, part, squared)
        assert float(squared) ** 0.5 == pytest.approx(distance, rel=1e-6)
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(in_open3d(V, F)))
    theirs = scene.compute_closest_points(open3d.core.Tensor(queries.astype(np.float32)))["points"].numpy()
    np.testing.assert_allclose(np.linalg.norm(theirs - queries, axis=1), ours.distance, atol=1e-5)


def test_normals_of_meshes_agree_with_vtk_and_open3d(bumpy):
    V, F = bumpy
    ours = ahm.TriangleMesh(V, F).normals
    mesh = in_open3d(V, F)
    mesh.compute_vertex_normals()
    normals = vtk.vtkPolyDataNormals()
    normals.SplittingOff()
    of_vtk = vtk_to_numpy(run(normals, in_vtk(V, F)).GetPointData().GetNormals())
    for theirs in (np.asarray(mesh.vertex_normals), of_vtk):  # other weights of the faces
        assert angle_between(ours, theirs).max() < 5 and np.median(angle_between(ours, theirs)) < 0.5


def test_normals_of_clouds_agree_with_open3d(bumpy):
    """Both fit planes to the 30 nearest neighbors, with other weights."""
    V = bumpy[0]
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(V))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(30))
    angles = angle_between(ahm.PointCloud(V).normals, np.asarray(cloud.normals))
    assert np.median(angles) < 2 and angles.max() < 15


def test_components_are_those_of_scipy(bumpy):
    V, F = bumpy
    two = np.concatenate([V, V + 9]), np.concatenate([F, F + len(V)])
    for surface in (ahm.TriangleMesh(*two), ahm.PointCloud(two[0])):
        count, theirs = csgraph.connected_components(edge_graph(*two))
        assert count == 2 and len(np.unique(surface.components * 2 + theirs)) == 2


def test_laplacians_are_those_of_scipy(bumpy):
    ops, graph = ahm.operators(bumpy), ahm.TriangleMesh(*bumpy).graph
    weights = csr_matrix((graph.weights, graph.indices, graph.indptr))
    assert abs(ops.laplacian - csgraph.laplacian(weights)).max() < 1e-12 * abs(graph.weights).max()


def test_cells_of_a_plane_are_those_of_scipy(sheet):
    V, seeds = sheet[0], np.array([3, 500, 1111, 800, 77])
    distance, nearest = cKDTree(V[seeds]).query(V, k=2)
    apart = distance[:, 1] - distance[:, 0] > 1e-9
    found = ahm.cells(sheet, seeds)
    np.testing.assert_array_equal(found.labels[apart], nearest[apart, 0])
    np.testing.assert_allclose(found.distance, distance[:, 0], atol=1e-9)
    labels = ahm.distance_and_nearest(sheet, seeds)[1]
    np.testing.assert_array_equal(labels[apart], nearest[apart, 0])


def test_farthest_points_of_a_plane_are_as_far_apart_as_those_of_open3d(sheet):
    V = sheet[0]
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(V))
    theirs = np.asarray(cloud.farthest_point_down_sample(40).points)
    ours = V[ahm.farthest_points(sheet, 40)]
    spacing = [cKDTree(points).query(points, k=2)[0][:, 1].min() for points in (ours, theirs)]
    assert spacing[0] == pytest.approx(spacing[1], rel=0.1)


def test_local_maps_of_a_plane_are_the_neighbors_of_scipy(sheet):
    V = sheet[0]
    maps = ahm.local_maps(sheet, radius=0.6)
    tree = cKDTree(V)
    assert maps.csr().nnz == tree.count_neighbors(tree, 0.6)
    for row in (0, 40, 620):
        own = slice(maps.indptr[row], maps.indptr[row + 1])
        assert sorted(maps.indices[own]) == sorted(tree.query_ball_point(V[row], 0.6))
        np.testing.assert_allclose(maps.distance[own], np.linalg.norm(V[maps.indices[own]] - V[row], axis=1), atol=1e-9)


def test_extended_values_are_the_nearest_ones_of_scipy(sheet):
    V, rows, values = sheet[0], np.array([100, 700, 1200]), np.array([1.0, 5.0, -2.0])
    near = cKDTree(V[rows]).query(V, k=2)[0]
    apart = near[:, 1] - near[:, 0] > 8 * 0.25  # extended values blend near ties
    theirs = NearestNDInterpolator(V[rows, :2], values)(V[:, :2])
    np.testing.assert_allclose(ahm.extend(sheet, rows, values)[apart], theirs[apart], atol=0.02)


def test_areas_and_contours_are_those_of_vtk(bumpy):
    V, F = bumpy
    mass = vtk.vtkMassProperties()
    mass.SetInputData(in_vtk(V, F))
    assert pp3d.face_areas(V, F).sum() == pytest.approx(mass.GetSurfaceArea(), rel=1e-6)
    assert pp3d.vertex_areas(V, F).sum() == pytest.approx(mass.GetSurfaceArea(), rel=1e-6)
    data = in_vtk(V, F)
    data.GetPointData().SetScalars(numpy_to_vtk(V[:, 2].copy(), deep=True))
    contour = vtk.vtkContourFilter()
    contour.SetValue(0, 0.23)
    lines = run(contour, data)
    corners = vtk_to_numpy(lines.GetLines().GetConnectivityArray()).reshape(-1, 2)
    points, edges = vtk_to_numpy(lines.GetPoints().GetData()), pp3d.edges(V, F)
    theirs = np.linalg.norm(points[corners[:, 0]] - points[corners[:, 1]], axis=1).sum()
    ours = 0.0
    for curve in pp3d.marching_triangles(V, F, V[:, 2], 0.23):
        at = np.array([(1 - t) * V[edges[e, 0]] + t * V[edges[e, 1]] for e, (t,) in curve])
        ours += np.linalg.norm(np.diff(at, axis=0), axis=1).sum()
    assert ours == pytest.approx(theirs, rel=1e-5)


def test_edges_are_those_of_vtk(bumpy):
    V, F = bumpy
    extract = vtk.vtkExtractEdges()
    lines = run(extract, in_vtk(V, F)).GetLines()
    assert len(pp3d.edges(V, F)) == lines.GetNumberOfCells()


WRITERS = {"ply": vtk.vtkPLYWriter, "stl": vtk.vtkSTLWriter, "obj": vtk.vtkOBJWriter, "vtp": vtk.vtkXMLPolyDataWriter,
           "vtk": vtk.vtkPolyDataWriter}


@pytest.mark.parametrize("ending", WRITERS)
def test_files_of_vtk_are_read(bumpy, ending, tmp_path):
    writer = WRITERS[ending]()
    writer.SetInputData(in_vtk(*bumpy))
    writer.SetFileName(str(tmp_path / f"mesh.{ending}"))
    writer.Write()
    mesh = ahm.read(tmp_path / f"mesh.{ending}")
    np.testing.assert_allclose(mesh.points[mesh.faces], bumpy[0][bumpy[1]], atol=1e-5)


@pytest.mark.parametrize("ending", ["ply", "stl", "obj", "off", "glb", "gltf"])
def test_meshes_of_open3d_are_read(bumpy, ending, tmp_path):
    mesh = in_open3d(*bumpy)
    mesh.compute_vertex_normals()
    mesh.compute_triangle_normals()
    assert open3d.io.write_triangle_mesh(str(tmp_path / f"mesh.{ending}"), mesh)
    found = ahm.read(tmp_path / f"mesh.{ending}")
    np.testing.assert_allclose(found.points[found.faces], bumpy[0][bumpy[1]], atol=1e-5)
    assert ahm.surface(mesh).points.shape == bumpy[0].shape


@pytest.mark.parametrize("ending", ["ply", "pcd", "xyz", "pts"])
def test_clouds_of_open3d_are_read(bumpy, ending, tmp_path):
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(bumpy[0]))
    assert open3d.io.write_point_cloud(str(tmp_path / f"cloud.{ending}"), cloud)
    np.testing.assert_allclose(ahm.read(tmp_path / f"cloud.{ending}").points, bumpy[0], atol=1e-5)
    assert ahm.surface(cloud).points.shape == bumpy[0].shape


@pytest.mark.parametrize("ending", ["ply", "obj", "off"])
def test_written_files_are_read_by_open3d(bumpy, ending, tmp_path):
    pp3d.write_mesh(*bumpy, tmp_path / f"mesh.{ending}")
    mesh = open3d.io.read_triangle_mesh(str(tmp_path / f"mesh.{ending}"))
    np.testing.assert_allclose(np.asarray(mesh.vertices)[np.asarray(mesh.triangles)], bumpy[0][bumpy[1]], atol=1e-6)
    pp3d.write_point_cloud(bumpy[0], tmp_path / "cloud.ply")
    np.testing.assert_allclose(np.asarray(open3d.io.read_point_cloud(str(tmp_path / "cloud.ply")).points), bumpy[0], atol=1e-12)
