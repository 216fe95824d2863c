"""The names and signatures of the package potpourri3d: change a script's import to `import ahm.potpourri3d as pp3d`.

The results are computed by this library. Distances in components without a source are NaN, indices out of range raise ValueError,
and paths are the shortest ones. Features that this library does not have raise NotImplementedError. Tangent vectors have two
components in the frames of `get_tangent_frames`; these frames differ from those of potpourri3d.

>>> import ahm
>>> import ahm.potpourri3d as pp3d
>>> V, F = ahm.shapes.sphere(3)
>>> solver = pp3d.MeshVectorHeatSolver(V, F)
>>> solver.compute_log_map(0).shape, len(solver.compute_log_maps([0, 5, 7]))
((642, 2), 3)
"""

from __future__ import annotations

from typing import Any, List, Optional, Tuple

import numpy as np

from . import _arguments as arguments
from ._clouds import PointCloud
from ._fields import DistanceField, distance_and_gradient, extend, operators, transport
from ._geodesics import geodesic_loop, geodesic_path, geodesic_paths, trace
from ._mesh_files import read_mesh, read_point_cloud, read_polygon_mesh, write_mesh, write_point_cloud
from ._meshes import PolygonMesh, TriangleMesh
from ._solvers import LogMapSolver
from ._surfaces import Surface

_STRATEGIES = {"AffineLocal": "localized", "AffineAdaptive": "adaptive"}


def _mesh(V: Any, F: Any) -> Tuple[np.ndarray, np.ndarray]:
    points = arguments.floats(V, "V", (None, 3))
    faces = arguments.integers(F, "F", 2, 0, len(points) - 1)
    if faces.shape[1] != 3:
        raise ValueError(f"F: expected shape (m, 3), got {faces.shape}")
    return points, faces


def face_areas(V: Any, F: Any) -> np.ndarray:
    """(m,) areas of the triangles.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.face_areas(*ahm.shapes.plane(2, 2)).tolist()
    [0.5, 0.5]

    Raises ValueError (wrong shape; a row out of range).
    """
    points, faces = _mesh(V, F)
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def vertex_areas(V: Any, F: Any) -> np.ndarray:
    """(n,) area of every vertex: a third of the areas of its triangles.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> round(float(pp3d.vertex_areas(*ahm.shapes.plane(4, 3)).sum()), 9)
    6.0

    Raises ValueError (wrong shape; a row out of range).
    """
    points, faces = _mesh(V, F)
    return np.bincount(faces.ravel(), np.repeat(face_areas(points, faces) / 3, 3), len(points))


def cotan_laplacian(V: Any, F: Any, denom_eps: float = 0.0) -> Any:
    """The cotangent Laplacian of the input triangles: (n, n) scipy CSR, positive semi-definite.

    The weight of an edge is half of the sum of the cotangents of the opposite angles. `denom_eps` is added to the denominators of
    the cotangents.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> V, F = ahm.shapes.plane(4, 3)
    >>> bool(abs((pp3d.cotan_laplacian(V, F) @ V)[5]).max() < 1e-12)           # linear functions are harmonic inside
    True

    Raises ValueError (wrong shape; a row out of range); ImportError without scipy.
    """
    from scipy.sparse import coo_matrix, diags

    points, faces = _mesh(V, F)
    rows, columns, weights = [], [], []
    for k in range(3):
        apex, i, j = (faces[:, (k + s) % 3] for s in range(3))
        a, b = points[i] - points[apex], points[j] - points[apex]
        weights.append(0.5 * np.einsum("ij,ij->i", a, b) / (np.linalg.norm(np.cross(a, b), axis=1) + denom_eps))
        rows.append(i)
        columns.append(j)
    n, w = len(points), np.concatenate(weights)
    W = coo_matrix((w, (np.concatenate(rows), np.concatenate(columns))), (n, n))
    W = (W + W.T).tocsr()
    return (diags(np.asarray(W.sum(axis=1)).ravel()) - W).tocsr()


def edges(V: Any, F: Any) -> np.ndarray:
    """(e, 2) vertices of every edge, the smaller number first, sorted.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.edges(*ahm.shapes.plane(2, 2)).tolist()
    [[0, 1], [0, 2], [0, 3], [1, 3], [2, 3]]

    Raises ValueError (wrong shape; a row out of range).
    """
    faces = _mesh(V, F)[1]
    return np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)


class _On:
    surface: Surface

    def _row(self, value: Any, name: str) -> int:
        return arguments.row(value, name, len(self.surface))

    def _rows(self, values: Any, name: str) -> np.ndarray:
        return arguments.rows(values, name, len(self.surface))

    def __repr__(self) -> str:
        return f"<{__name__}.{type(self).__name__}: on {self.surface!r}>"


class _Heat(_On):
    """Methods of all solvers that use the heat method."""

    _one, _many = "v_ind", "v_inds"  # names of the parameters, for messages

    def __init__(self, surface: Surface, t_coef: float) -> None:
        self.surface = surface
        self.solver = LogMapSolver(surface, t_coef=t_coef)

    def _distance(self, sources: Any) -> np.ndarray:
        field: DistanceField = distance_and_gradient(self.solver, self._rows(sources, self._many))
        return field.distance

    def _distance_from_one(self, source: Any) -> np.ndarray:
        return self._distance([self._row(source, self._one)])

    def compute_distances(self, v_inds: Any) -> np.ndarray:
        """(k, n) distances from each of k vertices separately."""
        return np.array([self._distance([v]) for v in self._rows(v_inds, self._many)])

    def extend_scalar(self, v_inds: Any, values: Any) -> np.ndarray:
        """(n,) values extended to all vertices: each gets the value of the nearest one of v_inds, blended at ties."""
        return extend(self.solver, self._rows(v_inds, self._many), values)

    def get_tangent_frames(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Three (n, 3) arrays: the tangent axes x and y, and the normals."""
        frames = self.surface.frames
        assert frames is not None
        return frames[:, 0], frames[:, 1], frames[:, 2]

    def transport_tangent_vector(self, v_ind: int, vector: Any) -> np.ndarray:
        """(n, 2) the vector at v_ind, parallel transported to every vertex, in the frames of `get_tangent_frames`."""
        return self.transport_tangent_vectors([self._row(v_ind, self._one)], [vector])

    def transport_tangent_vectors(self, v_inds: Any, vectors: Any) -> np.ndarray:
        """(n, 2) vectors at v_inds, parallel transported: each vertex gets that of the nearest one, blended at ties."""
        given = arguments.floats(vectors, "vectors", (None, 2), finite=True)
        return transport(self.solver, self._rows(v_inds, self._many), given)

    def compute_log_map(self, v_ind: int, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) log map from v_ind, in its frame. strategy: "AffineLocal" (Alg. 1 of [SS25]) or "AffineAdaptive" (Alg. 2)."""
        return self.compute_log_maps([self._row(v_ind, self._one)], strategy)[0]

    def compute_log_maps(self, v_inds: Any, strategy: str = "AffineLocal") -> List[np.ndarray]:
        """One log map per source, solved in blocks."""
        if strategy not in _STRATEGIES:
            raise NotImplementedError(f"strategy: {strategy!r} is not supported; use 'AffineLocal' or 'AffineAdaptive'")
        rows = self._rows(v_inds, self._many)
        return [m.uv for m in self.solver.log_maps(rows, variant=_STRATEGIES[strategy], distances=False)]

    def compute_signed_distance(self, *given: Any, **options: Any) -> np.ndarray:
        raise NotImplementedError("compute_signed_distance: not supported; use `ahm.stroke` for signed distances from a curve")


class MeshHeatMethodDistanceSolver(_Heat):
    """Geodesic distance on a triangle mesh by the heat method (`ahm.distance_and_gradient`).

    use_robust : use the intrinsic Delaunay triangulation.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshHeatMethodDistanceSolver(*ahm.shapes.plane(4, 3))
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (an invalid mesh, as `ahm.TriangleMesh`; a row out of range, naming the parameter; t_coef).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0, use_robust: bool = True) -> None:
        super().__init__(TriangleMesh(V, F, delaunay=bool(use_robust)), t_coef)

    def compute_distance(self, v_ind: int) -> np.ndarray:
        """(n,) distances from a vertex."""
        return self._distance_from_one(v_ind)

    def compute_distance_multisource(self, v_inds: Any) -> np.ndarray:
        """(n,) distances from the nearest of several vertices."""
        return self._distance(v_inds)


def compute_distance(V: Any, F: Any, v_ind: int) -> np.ndarray:
    """(n,) distances from a vertex of a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.compute_distance(*ahm.shapes.plane(4, 3), 0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises as `MeshHeatMethodDistanceSolver`.
    """
    return MeshHeatMethodDistanceSolver(V, F).compute_distance(v_ind)


def compute_distance_multisource(V: Any, F: Any, v_inds: Any) -> np.ndarray:
    """(n,) distances from the nearest of several vertices of a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> len(pp3d.compute_distance_multisource(*ahm.shapes.plane(4, 3), [0, 3]))
    12

    Raises as `MeshHeatMethodDistanceSolver`.
    """
    return MeshHeatMethodDistanceSolver(V, F).compute_distance_multisource(v_inds)


class MeshVectorHeatSolver(_Heat):
    """Log maps, parallel transport and extension of scalars on a triangle mesh, by the heat method.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshVectorHeatSolver(*ahm.shapes.plane(4, 3))
    >>> x, y, n = solver.get_tangent_frames()
    >>> uv = solver.compute_log_map(0)
    >>> (uv[11, 0] * x[0] + uv[11, 1] * y[0]).round(9).tolist()          # in space: from row 0 to row 11
    [3.0, 2.0, 0.0]

    Raises ValueError (an invalid mesh, as `ahm.TriangleMesh`; a row out of range, naming the parameter; t_coef),
    NotImplementedError (a strategy that `compute_log_map` does not list).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0, use_intrinsic_delaunay: bool = True, *,
                 useIntrinsicDelaunay: Optional[bool] = None) -> None:
        delaunay = use_intrinsic_delaunay if useIntrinsicDelaunay is None else useIntrinsicDelaunay
        super().__init__(TriangleMesh(V, F, delaunay=bool(delaunay)), t_coef)

    def get_connection_laplacian(self) -> Any:
        """The connection Laplacian in the frames of `get_tangent_frames`: (n, n) scipy CSR, complex Hermitian."""
        found = operators(self.surface)
        if not np.array_equal(found.vertex_of_row, np.arange(len(self.surface))) or found.tau.shape != (len(self.surface),):
            raise NotImplementedError("get_connection_laplacian: requires a mesh in which every vertex is used by a face and none was split")
        if found.connection_laplacian.dtype != complex:
            raise NotImplementedError("get_connection_laplacian: the surface is not orientable; its connection Laplacian is not complex")
        return found.connection_laplacian


class PolygonMeshHeatSolver(_Heat):
    """Distances, log maps, parallel transport and extension of scalars on a polygon mesh, by the heat method.

    >>> import ahm.potpourri3d as pp3d
    >>> V = [[x, y, 0] for y in range(3) for x in range(4)]
    >>> quads = [[i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j] for j in range(2) for i in range(3)]
    >>> pp3d.PolygonMeshHeatSolver(V, quads).compute_distance([0])[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (an invalid mesh, as `ahm.PolygonMesh`; a row out of range), NotImplementedError (`compute_signed_distance`).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        super().__init__(PolygonMesh(V, F), t_coef)

    def compute_distance(self, v_inds: Any) -> np.ndarray:
        """(n,) distances from the nearest of one or more vertices."""
        return self._distance(v_inds)


class PointCloudHeatSolver(_Heat):
    """Distances, log maps, parallel transport and extension of scalars on a point cloud, by the heat method.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.PointCloudHeatSolver(ahm.shapes.plane(9, 9)[0])
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (an invalid cloud, as `ahm.PointCloud`; a row out of range), NotImplementedError
    (`compute_signed_distance`).
    """

    _one, _many = "p_ind", "p_inds"

    def __init__(self, P: Any, t_coef: float = 1.0) -> None:
        super().__init__(PointCloud(P), t_coef)

    def compute_distance(self, p_ind: int) -> np.ndarray:
        """(n,) distances from a point."""
        return self._distance_from_one(p_ind)

    def compute_distance_multisource(self, p_inds: Any) -> np.ndarray:
        """(n,) distances from the nearest of several points."""
        return self._distance(p_inds)

    # The methods of meshes, with the parameter names of clouds.

    def extend_scalar(self, p_inds: Any, values: Any) -> np.ndarray:
        """(n,) values extended to all points: each gets the value of the nearest one of p_inds, blended at ties."""
        return super().extend_scalar(p_inds, values)

    def transport_tangent_vector(self, p_ind: int, vector: Any) -> np.ndarray:
        """(n, 2) the vector at p_ind, parallel transported to every point, in the frames of `get_tangent_frames`."""
        return super().transport_tangent_vector(p_ind, vector)

    def transport_tangent_vectors(self, p_inds: Any, vectors: Any) -> np.ndarray:
        """(n, 2) vectors at p_inds, parallel transported: each point gets that of the nearest one, blended at ties."""
        return super().transport_tangent_vectors(p_inds, vectors)

    def compute_log_map(self, p_ind: int, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) log map from p_ind, in its frame. strategy: "AffineLocal" (Alg. 1 of [SS25]) or "AffineAdaptive" (Alg. 2)."""
        return super().compute_log_map(p_ind, strategy)


class EdgeFlipGeodesicSolver(_On):
    """Paths on a triangle mesh: shortest between two vertices, locally shortest through several vertices.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> paths = pp3d.EdgeFlipGeodesicSolver(*ahm.shapes.plane(4, 3))
    >>> paths.find_geodesic_path(0, 11)[[0, -1]].tolist()
    [[0.0, 0.0, 0.0], [3.0, 2.0, 0.0]]

    Raises ValueError (a row out of range; vertices that are not connected), NotImplementedError (limits on iterations).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def find_geodesic_path(self, v_start: int, v_end: int, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of the shortest path. Raises ValueError if the vertices are not connected."""
        ends = [self._row(v_start, "v_start"), self._row(v_end, "v_end")]
        return self._path(geodesic_path, ends, max_iterations, max_relative_length_decrease)

    def find_geodesic_paths(self, v_starts: Any, v_ends: Any) -> List[np.ndarray]:
        """The shortest path from v_starts[i] to v_ends[i] for every i, as from `find_geodesic_path`."""
        starts, ends = self._rows(v_starts, "v_starts"), self._rows(v_ends, "v_ends")
        found = geodesic_paths(self.surface, starts, ends, pairwise=True)
        return [self._points(path, [a, b]) for path, a, b in zip(found, starts, ends)]

    def find_geodesic_path_poly(self, v_list: Any, max_iterations: Optional[int] = None,
                                max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of the path through the vertices, pulled taut until it is locally shortest. Only its ends are fixed."""
        return self._path(_pulled_taut, v_list, max_iterations, max_relative_length_decrease)

    def find_geodesic_loop(self, v_list: Any, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of a closed geodesic: the closed path through the vertices, pulled taut until it is locally shortest.

        If nothing holds the loop, it shrinks to one point."""
        return self._path(geodesic_loop, v_list, max_iterations, max_relative_length_decrease)

    def _path(self, find: Any, vertices: Any, *limits: Any) -> np.ndarray:
        if any(limit is not None for limit in limits):
            raise NotImplementedError("max_iterations, max_relative_length_decrease: not supported; paths are not computed by iterations")
        rows = self._rows(vertices, "v_list")
        return self._points(find(self.surface, rows), rows)

    @staticmethod
    def _points(path: Any, rows: Any) -> np.ndarray:
        if path is None:
            raise ValueError(f"no path connects the vertices {[int(r) for r in rows]}")
        return path.points


def _pulled_taut(surface: Surface, rows: np.ndarray) -> Any:
    return geodesic_path(surface, rows, taut=True)


class GeodesicTracer(_On):
    """Straightest geodesics on a triangle mesh (`ahm.trace`). Their length is the length of `direction_xyz`.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> tracer = pp3d.GeodesicTracer(*ahm.shapes.plane(4, 3))
    >>> tracer.trace_geodesic_from_vertex(0, [1.5, 1.0, 0.0])[-1].round(9).tolist()
    [1.5, 1.0, 0.0]

    Raises ValueError (a row or face out of range; invalid barycentric coordinates; a direction of length 0), NotImplementedError
    (a limit on iterations).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def trace_geodesic_from_vertex(self, start_vert: int, direction_xyz: Any, max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points of the geodesic. It ends at the boundary if it reaches it."""
        return self._trace(self._row(start_vert, "start_vert"), direction_xyz, max_iterations)

    def trace_geodesic_from_face(self, start_face: int, bary_coords: Any, direction_xyz: Any,
                                 max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points of the geodesic. It ends at the boundary if it reaches it."""
        face = arguments.integer(start_face, "start_face", 0, self.surface._face_count - 1)
        return self._trace((face, bary_coords), direction_xyz, max_iterations)

    def trace_geodesics_from_vertices(self, start_verts: Any, directions_xyz: Any) -> List[np.ndarray]:
        """The geodesic from start_verts[i] in the direction directions_xyz[i], for every i."""
        starts = self._rows(start_verts, "start_verts")
        directions = arguments.floats(directions_xyz, "directions_xyz", (len(starts), 3), finite=True)
        return [self._trace(int(v), d, None) for v, d in zip(starts, directions)]

    def _trace(self, start: Any, direction: Any, max_iterations: Optional[int]) -> np.ndarray:
        if max_iterations is not None:
            raise NotImplementedError("max_iterations: not supported; geodesics are traced to their full length")
        return trace(self.surface, start, direction).points


__all__ = [
    "EdgeFlipGeodesicSolver", "GeodesicTracer", "MeshHeatMethodDistanceSolver", "MeshVectorHeatSolver",
    "PointCloudHeatSolver", "PolygonMeshHeatSolver", "compute_distance", "compute_distance_multisource",
    "cotan_laplacian", "edges", "face_areas", "read_mesh", "read_point_cloud", "read_polygon_mesh",
    "vertex_areas", "write_mesh", "write_point_cloud",
]
