"""The names and signatures of the package potpourri3d, so that `import ahm.potpourri3d as pp3d` keeps a script running.

Results are those of this library: distances of components without a source are NaN, indices out of range raise ValueError, and
paths are the shortest. What this library does not have raises NotImplementedError. Tangent vectors have two components in the
frames of `get_tangent_frames`, which are a choice of gauge and not that package's.

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
        raise ValueError(f"F: shape (m, 3) is needed, not {faces.shape}")
    return points, faces


def face_areas(V: Any, F: Any) -> np.ndarray:
    """(m,) areas of triangles.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.face_areas(*ahm.shapes.plane(2, 2)).tolist()
    [0.5, 0.5]

    Raises ValueError (a shape; a row out of range).
    """
    points, faces = _mesh(V, F)
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def vertex_areas(V: Any, F: Any) -> np.ndarray:
    """(n,) a third of the areas of the triangles at every vertex.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> round(float(pp3d.vertex_areas(*ahm.shapes.plane(4, 3)).sum()), 9)
    6.0

    Raises ValueError (a shape; a row out of range).
    """
    points, faces = _mesh(V, F)
    return np.bincount(faces.ravel(), np.repeat(face_areas(points, faces) / 3, 3), len(points))


def cotan_laplacian(V: Any, F: Any, denom_eps: float = 0.0) -> Any:
    """(n, n) scipy CSR, positive semi-definite: half the cotangents opposite each edge, of the triangles as given.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> V, F = ahm.shapes.plane(4, 3)
    >>> bool(abs((pp3d.cotan_laplacian(V, F) @ V)[5]).max() < 1e-12)           # linear functions are harmonic inside
    True

    Raises ValueError (a shape; a row out of range); ImportError without scipy.
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
    """(e, 2) vertices of every edge, the smaller one first, sorted.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.edges(*ahm.shapes.plane(2, 2)).tolist()
    [[0, 1], [0, 2], [0, 3], [1, 3], [2, 3]]

    Raises ValueError (a shape; a row out of range).
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
    """What all solvers by heat offer."""

    _one, _many = "v_ind", "v_inds"  # as the parameters are called

    def __init__(self, surface: Surface, t_coef: float) -> None:
        self.surface = surface
        self.solver = LogMapSolver(surface, t_coef=t_coef)

    def _distance(self, sources: Any) -> np.ndarray:
        field: DistanceField = distance_and_gradient(self.solver, self._rows(sources, self._many))
        return field.distance

    def _distance_from_one(self, source: Any) -> np.ndarray:
        return self._distance([self._row(source, self._one)])

    def compute_distances(self, v_inds: Any) -> np.ndarray:
        """(k, n) distances from each of k vertices alone."""
        return np.array([self._distance([v]) for v in self._rows(v_inds, self._many)])

    def extend_scalar(self, v_inds: Any, values: Any) -> np.ndarray:
        """(n,) each vertex takes the value of the nearest one of v_inds, blended at ties."""
        return extend(self.solver, self._rows(v_inds, self._many), values)

    def get_tangent_frames(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Three (n, 3) arrays: the tangent axes x and y, and the normals."""
        frames = self.surface.frames
        assert frames is not None
        return frames[:, 0], frames[:, 1], frames[:, 2]

    def transport_tangent_vector(self, v_ind: int, vector: Any) -> np.ndarray:
        """(n, 2) the vector at v_ind carried to every vertex, in the frames of `get_tangent_frames`."""
        return self.transport_tangent_vectors([self._row(v_ind, self._one)], [vector])

    def transport_tangent_vectors(self, v_inds: Any, vectors: Any) -> np.ndarray:
        """(n, 2) the same, of several vectors: the nearest one counts, blended at ties."""
        given = arguments.floats(vectors, "vectors", (None, 2), finite=True)
        return transport(self.solver, self._rows(v_inds, self._many), given)

    def compute_log_map(self, v_ind: int, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) in the frame of v_ind. strategy: "AffineLocal" or "AffineAdaptive"."""
        return self.compute_log_maps([self._row(v_ind, self._one)], strategy)[0]

    def compute_log_maps(self, v_inds: Any, strategy: str = "AffineLocal") -> List[np.ndarray]:
        """One map for each source, in blocks."""
        if strategy not in _STRATEGIES:
            raise NotImplementedError(f"strategy: {strategy!r} is not there; 'AffineLocal' and 'AffineAdaptive' are")
        rows = self._rows(v_inds, self._many)
        return [m.uv for m in self.solver.log_maps(rows, variant=_STRATEGIES[strategy], distances=False)]

    def compute_signed_distance(self, *given: Any, **options: Any) -> np.ndarray:
        raise NotImplementedError("compute_signed_distance is not there; `ahm.stroke` gives signed distances along a curve")


class MeshHeatMethodDistanceSolver(_Heat):
    """Geodesic distance on a triangle mesh by heat (`ahm.distance_and_gradient`); use_robust: intrinsic Delaunay triangulation.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshHeatMethodDistanceSolver(*ahm.shapes.plane(4, 3))
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (a mesh as of `ahm.TriangleMesh`; a row out of range, by its parameter's name; t_coef).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0, use_robust: bool = True) -> None:
        super().__init__(TriangleMesh(V, F, delaunay=bool(use_robust)), t_coef)

    def compute_distance(self, v_ind: int) -> np.ndarray:
        """(n,) from a vertex."""
        return self._distance_from_one(v_ind)

    def compute_distance_multisource(self, v_inds: Any) -> np.ndarray:
        """(n,) from the nearest of several vertices."""
        return self._distance(v_inds)


def compute_distance(V: Any, F: Any, v_ind: int) -> np.ndarray:
    """(n,) distance from a vertex of a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.compute_distance(*ahm.shapes.plane(4, 3), 0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises as `MeshHeatMethodDistanceSolver`.
    """
    return MeshHeatMethodDistanceSolver(V, F).compute_distance(v_ind)


def compute_distance_multisource(V: Any, F: Any, v_inds: Any) -> np.ndarray:
    """(n,) distance from the nearest of several vertices of a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> len(pp3d.compute_distance_multisource(*ahm.shapes.plane(4, 3), [0, 3]))
    12

    Raises as `MeshHeatMethodDistanceSolver`.
    """
    return MeshHeatMethodDistanceSolver(V, F).compute_distance_multisource(v_inds)


class MeshVectorHeatSolver(_Heat):
    """Log maps, transport and extension on a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshVectorHeatSolver(*ahm.shapes.plane(4, 3))
    >>> x, y, n = solver.get_tangent_frames()
    >>> uv = solver.compute_log_map(0)
    >>> (uv[11, 0] * x[0] + uv[11, 1] * y[0]).round(9).tolist()          # in space: from row 0 to row 11
    [3.0, 2.0, 0.0]

    Raises ValueError (a mesh as of `ahm.TriangleMesh`; a row out of range, by its parameter's name; t_coef),
    NotImplementedError (another strategy than those of `compute_log_map`).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0, use_intrinsic_delaunay: bool = True, *,
                 useIntrinsicDelaunay: Optional[bool] = None) -> None:
        delaunay = use_intrinsic_delaunay if useIntrinsicDelaunay is None else useIntrinsicDelaunay
        super().__init__(TriangleMesh(V, F, delaunay=bool(delaunay)), t_coef)

    def get_connection_laplacian(self) -> Any:
        """(n, n) complex Hermitian scipy CSR, in the frames of `get_tangent_frames`."""
        found = operators(self.surface)
        if not np.array_equal(found.vertex_of_row, np.arange(len(self.surface))) or found.tau.shape != (len(self.surface),):
            raise NotImplementedError("get_connection_laplacian: of meshes whose vertices all are used by faces, uncut")
        if found.connection_laplacian.dtype != complex:
            raise NotImplementedError("get_connection_laplacian: a surface that is not orientable has none of complex numbers")
        return found.connection_laplacian


class PolygonMeshHeatSolver(_Heat):
    """Distance, log maps, transport and extension on a polygon mesh.

    >>> import ahm.potpourri3d as pp3d
    >>> V = [[x, y, 0] for y in range(3) for x in range(4)]
    >>> quads = [[i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j] for j in range(2) for i in range(3)]
    >>> pp3d.PolygonMeshHeatSolver(V, quads).compute_distance([0])[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (a mesh as of `ahm.PolygonMesh`; a row out of range), NotImplementedError (`compute_signed_distance`).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        super().__init__(PolygonMesh(V, F), t_coef)

    def compute_distance(self, v_inds: Any) -> np.ndarray:
        """(n,) from the nearest of one or more vertices."""
        return self._distance(v_inds)


class PointCloudHeatSolver(_Heat):
    """Distance, log maps, transport and extension on a point cloud.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.PointCloudHeatSolver(ahm.shapes.plane(9, 9)[0])
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (a cloud as of `ahm.PointCloud`; a row out of range), NotImplementedError (`compute_signed_distance`).
    """

    _one, _many = "p_ind", "p_inds"

    def __init__(self, P: Any, t_coef: float = 1.0) -> None:
        super().__init__(PointCloud(P), t_coef)

    def compute_distance(self, p_ind: int) -> np.ndarray:
        """(n,) from a point."""
        return self._distance_from_one(p_ind)

    def compute_distance_multisource(self, p_inds: Any) -> np.ndarray:
        """(n,) from the nearest of several points."""
        return self._distance(p_inds)

    # The same as of meshes, under the names that parameters of clouds have.

    def extend_scalar(self, p_inds: Any, values: Any) -> np.ndarray:
        """(n,) each point takes the value of the nearest one of p_inds, blended at ties."""
        return super().extend_scalar(p_inds, values)

    def transport_tangent_vector(self, p_ind: int, vector: Any) -> np.ndarray:
        """(n, 2) the vector at p_ind carried to every point, in the frames of `get_tangent_frames`."""
        return super().transport_tangent_vector(p_ind, vector)

    def transport_tangent_vectors(self, p_inds: Any, vectors: Any) -> np.ndarray:
        """(n, 2) the same, of several vectors: the nearest one counts, blended at ties."""
        return super().transport_tangent_vectors(p_inds, vectors)

    def compute_log_map(self, p_ind: int, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) in the frame of p_ind. strategy: "AffineLocal" or "AffineAdaptive"."""
        return super().compute_log_map(p_ind, strategy)


class EdgeFlipGeodesicSolver(_On):
    """Paths on a triangle mesh: between two vertices the shortest of all; through several, locally shortest.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> paths = pp3d.EdgeFlipGeodesicSolver(*ahm.shapes.plane(4, 3))
    >>> paths.find_geodesic_path(0, 11)[[0, -1]].tolist()
    [[0.0, 0.0, 0.0], [3.0, 2.0, 0.0]]

    Raises ValueError (a row out of range; no way between the vertices), NotImplementedError (limits on iterations).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def find_geodesic_path(self, v_start: int, v_end: int, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of the shortest path. Raises ValueError where there is none."""
        ends = [self._row(v_start, "v_start"), self._row(v_end, "v_end")]
        return self._path(geodesic_path, ends, max_iterations, max_relative_length_decrease)

    def find_geodesic_paths(self, v_starts: Any, v_ends: Any) -> List[np.ndarray]:
        """One shortest path from each vertex to the one beside it, as of `find_geodesic_path`."""
        starts, ends = self._rows(v_starts, "v_starts"), self._rows(v_ends, "v_ends")
        found = geodesic_paths(self.surface, starts, ends, pairwise=True)
        return [self._points(path, [a, b]) for path, a, b in zip(found, starts, ends)]

    def find_geodesic_path_poly(self, v_list: Any, max_iterations: Optional[int] = None,
                                max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points: the way through the vertices, made locally shortest; only its two ends stay where they are."""
        return self._path(_pulled_taut, v_list, max_iterations, max_relative_length_decrease)

    def find_geodesic_loop(self, v_list: Any, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of a closed geodesic: the closed way through the vertices, made locally shortest. One point is left
        where nothing holds it."""
        return self._path(geodesic_loop, v_list, max_iterations, max_relative_length_decrease)

    def _path(self, find: Any, vertices: Any, *limits: Any) -> np.ndarray:
        if any(limit is not None for limit in limits):
            raise NotImplementedError("max_iterations, max_relative_length_decrease: paths are not found by iterations")
        rows = self._rows(vertices, "v_list")
        return self._points(find(self.surface, rows), rows)

    @staticmethod
    def _points(path: Any, rows: Any) -> np.ndarray:
        if path is None:
            raise ValueError(f"no path leads through the vertices {[int(r) for r in rows]}")
        return path.points


def _pulled_taut(surface: Surface, rows: np.ndarray) -> Any:
    return geodesic_path(surface, rows, taut=True)


class GeodesicTracer(_On):
    """Straightest geodesics on a triangle mesh (`ahm.trace`), as long as `direction_xyz` is.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> tracer = pp3d.GeodesicTracer(*ahm.shapes.plane(4, 3))
    >>> tracer.trace_geodesic_from_vertex(0, [1.5, 1.0, 0.0])[-1].round(9).tolist()
    [1.5, 1.0, 0.0]

    Raises ValueError (a row or face out of range; barycentric coordinates; a direction of length 0), NotImplementedError (a limit
    on iterations).
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def trace_geodesic_from_vertex(self, start_vert: int, direction_xyz: Any, max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points; it ends at the boundary."""
        return self._trace(self._row(start_vert, "start_vert"), direction_xyz, max_iterations)

    def trace_geodesic_from_face(self, start_face: int, bary_coords: Any, direction_xyz: Any,
                                 max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points; it ends at the boundary."""
        face = arguments.integer(start_face, "start_face", 0, self.surface._face_count - 1)
        return self._trace((face, bary_coords), direction_xyz, max_iterations)

    def trace_geodesics_from_vertices(self, start_verts: Any, directions_xyz: Any) -> List[np.ndarray]:
        """One curve for each vertex and the direction (k, 3) beside it."""
        starts = self._rows(start_verts, "start_verts")
        directions = arguments.floats(directions_xyz, "directions_xyz", (len(starts), 3), finite=True)
        return [self._trace(int(v), d, None) for v, d in zip(starts, directions)]

    def _trace(self, start: Any, direction: Any, max_iterations: Optional[int]) -> np.ndarray:
        if max_iterations is not None:
            raise NotImplementedError("max_iterations: geodesics are traced to their end")
        return trace(self.surface, start, direction).points


__all__ = [
    "EdgeFlipGeodesicSolver", "GeodesicTracer", "MeshHeatMethodDistanceSolver", "MeshVectorHeatSolver",
    "PointCloudHeatSolver", "PolygonMeshHeatSolver", "compute_distance", "compute_distance_multisource",
    "cotan_laplacian", "edges", "face_areas", "read_mesh", "read_point_cloud", "read_polygon_mesh",
    "vertex_areas", "write_mesh", "write_point_cloud",
]
