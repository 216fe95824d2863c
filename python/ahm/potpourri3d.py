"""The names and signatures of the package potpourri3d: change a script's import to `import ahm.potpourri3d as pp3d`.

The results are computed by this library. Distances in components without a source are NaN, indices out of range raise ValueError,
and paths are the shortest ones. Options that this library does not have raise NotImplementedError. Tangent vectors have two
components in the frames of `get_tangent_frames`; these frames differ from those of potpourri3d.

A point of a curve is a row, `(row, [])`, `(edge, [t])` with edges numbered as in `edges`, or `(face, [a, b, c])`, where `c` may be
left out.

>>> import ahm
>>> import ahm.potpourri3d as pp3d
>>> V, F = ahm.shapes.sphere(3)
>>> solver = pp3d.MeshVectorHeatSolver(V, F)
>>> solver.compute_log_map(0).shape, len(solver.compute_log_maps([0, 5, 7]))
((642, 2), 3)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, List, Optional, Sequence, SupportsIndex, Tuple, Union

import numpy as np

from . import _arguments as arguments
from ._clouds import PointCloud
from ._curve_distances import Curves, MeshFastMarchingDistanceSolver, MeshSignedHeatSolver, OnSurface, nearer, only_zero_set
from ._fields import distance_and_gradient, extend, operators, transport
from ._geodesics import Path, geodesic_path, geodesic_paths, trace
from ._local_triangles import PointCloudLocalTriangulation
from ._mesh_arrays import (MeshMarchingTrianglesSolver, checked_mesh, cotan_laplacian, edges, face_areas, marching_triangles,
                           validate_mesh, validate_points, vertex_areas)
from ._mesh_files import read_mesh, read_point_cloud, read_polygon_mesh, write_mesh, write_point_cloud
from ._meshes import PolygonMesh, TriangleMesh
from ._solvers import LogMapSolver
from ._surfaces import Surface
from .typing import Faces, Matrix, Source, Vector

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

_STRATEGIES = {"AffineLocal": "localized", "AffineAdaptive": "adaptive"}


class _Heat(OnSurface):
    """Methods of all solvers that use the heat method."""

    _one, _many = "v_ind", "v_inds"  # names of the parameters, for messages

    def __init__(self, surface: Surface, t_coef: float) -> None:
        self.surface = surface
        self.solver = LogMapSolver(surface, t_coef=t_coef)

    def _distance(self, sources: Vector) -> np.ndarray:
        return distance_and_gradient(self.solver, self._rows(sources, self._many)).distance

    def _distance_from_one(self, source: SupportsIndex) -> np.ndarray:
        return self._distance([self._row(source, self._one)])

    def compute_distances(self, v_inds: Vector) -> np.ndarray:
        """(k, n) distances from each of k vertices separately."""
        return np.array([self._distance([v]) for v in self._rows(v_inds, self._many)])

    def extend_scalar(self, v_inds: Vector, values: Vector) -> np.ndarray:
        """(n,) values extended to all vertices: each gets the value of the nearest one of v_inds, blended at ties."""
        return extend(self.solver, self._rows(v_inds, self._many), values)

    def get_tangent_frames(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Three (n, 3) arrays: the tangent axes x and y, and the normals."""
        frames = self.surface.frames
        assert frames is not None
        return frames[:, 0], frames[:, 1], frames[:, 2]

    def transport_tangent_vector(self, v_ind: SupportsIndex, vector: Vector) -> np.ndarray:
        """(n, 2) the vector at v_ind, parallel transported to every vertex, in the frames of `get_tangent_frames`."""
        return self.transport_tangent_vectors([self._row(v_ind, self._one)], np.asarray(vector)[None])

    def transport_tangent_vectors(self, v_inds: Vector, vectors: Matrix) -> np.ndarray:
        """(n, 2) vectors at v_inds, parallel transported: each vertex gets that of the nearest one, blended at ties."""
        given = arguments.floats(vectors, "vectors", (None, 2), finite=True)
        return transport(self.solver, self._rows(v_inds, self._many), given)

    def compute_log_map(self, v_ind: SupportsIndex, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) log map from v_ind, in its frame.

        strategy: "AffineLocal" (Alg. 1 of [SS25]), "AffineAdaptive" (Alg. 2), or "VectorHeat": the distance in the direction of
        its gradient, relative to the transported axis ([SSC19] Sec. 5).
        """
        return self.compute_log_maps([self._row(v_ind, self._one)], strategy)[0]

    def compute_log_maps(self, v_inds: Vector, strategy: str = "AffineLocal") -> List[np.ndarray]:
        """One log map per source, solved in blocks."""
        arguments.choice(strategy, "strategy", ("VectorHeat", *_STRATEGIES))
        rows = self._rows(v_inds, self._many)
        if strategy == "VectorHeat":
            return [self._vector_heat_map(int(row)) for row in rows]
        return [m.uv for m in self.solver.log_maps(rows, variant=_STRATEGIES[strategy], distances=False)]

    def _vector_heat_map(self, row: int) -> np.ndarray:
        field = distance_and_gradient(self.solver, row)
        x, y, _ = self.get_tangent_frames()
        away = np.einsum("ij,ij->i", field.gradient, x) + 1j * np.einsum("ij,ij->i", field.gradient, y)
        axis = transport(self.solver, row, [1.0, 0.0])
        turn = away * (axis[:, 0] - 1j * axis[:, 1])
        result = field.distance * np.divide(turn, abs(turn), out=np.zeros_like(turn), where=turn != 0)
        return np.stack([result.real, result.imag], axis=1)


def _without_faults(V: Matrix, F: Faces) -> np.ndarray:
    """The faces of a mesh without those that repeat a corner or another face."""
    faces = checked_mesh(V, F)[1]
    corners = np.sort(faces, axis=1)
    first = np.sort(np.unique(corners, axis=0, return_index=True)[1])
    return faces[first[(np.diff(corners[first], axis=1) > 0).all(axis=1)]]


class MeshHeatMethodDistanceSolver(_Heat):
    """Geodesic distance on a triangle mesh by the heat method (`ahm.distance_and_gradient`).

    Faces that repeat a corner or another face are left out. The mesh is cut open at nonmanifold edges and vertices. Distances on
    sheets that are joined to that of the source only there are NaN; `PointCloudHeatSolver` has distances on all sheets.

    use_robust : use the intrinsic Delaunay triangulation.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshHeatMethodDistanceSolver(*ahm.shapes.plane(4, 3))
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (a coordinate that is not finite; a row out of range, naming the parameter; t_coef).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0, use_robust: bool = True) -> None:
        super().__init__(TriangleMesh(V, _without_faults(V, F), delaunay=bool(use_robust), non_manifold="split"), t_coef)

    def compute_distance(self, v_ind: SupportsIndex) -> np.ndarray:
        """(n,) distances from a vertex."""
        return self._distance_from_one(v_ind)

    def compute_distance_multisource(self, v_inds: Vector) -> np.ndarray:
        """(n,) distances from the nearest of several vertices."""
        return self._distance(v_inds)


def compute_distance(V: Matrix, F: Faces, v_ind: SupportsIndex) -> np.ndarray:
    """(n,) distances from a vertex of a triangle mesh.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.compute_distance(*ahm.shapes.plane(4, 3), 0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises as `MeshHeatMethodDistanceSolver`.
    """
    return MeshHeatMethodDistanceSolver(V, F).compute_distance(v_ind)


def compute_distance_multisource(V: Matrix, F: Faces, v_inds: Vector) -> np.ndarray:
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

    Raises ValueError (an invalid mesh, as `ahm.TriangleMesh`; a row out of range, naming the parameter; t_coef; a strategy).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0, use_intrinsic_delaunay: bool = True, *,
                 useIntrinsicDelaunay: Optional[bool] = None) -> None:
        delaunay = use_intrinsic_delaunay if useIntrinsicDelaunay is None else useIntrinsicDelaunay
        super().__init__(TriangleMesh(V, F, delaunay=bool(delaunay)), t_coef)

    def get_connection_laplacian(self) -> csc_matrix:
        """The connection Laplacian in the frames of `get_tangent_frames`: (n, n) scipy CSC, complex Hermitian."""
        found = operators(self.surface)
        if not np.array_equal(found.vertex_of_row, np.arange(len(self.surface))) or found.tau.shape != (len(self.surface),):
            raise NotImplementedError("get_connection_laplacian: requires a mesh in which every vertex is used by a face; use "
                                      "ahm.operators")
        if found.connection_laplacian.dtype != complex:
            raise NotImplementedError("get_connection_laplacian: the surface is not orientable; use ahm.operators")
        return found.connection_laplacian.tocsc()


class PolygonMeshHeatSolver(_Heat):
    """Distances, log maps, parallel transport and extension of scalars on a polygon mesh, by the heat method.

    >>> import ahm.potpourri3d as pp3d
    >>> V = [[x, y, 0] for y in range(3) for x in range(4)]
    >>> quads = [[i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j] for j in range(2) for i in range(3)]
    >>> pp3d.PolygonMeshHeatSolver(V, quads).compute_distance([0])[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (an invalid mesh, as `ahm.PolygonMesh`; a row out of range), NotImplementedError (options of the level sets
    other than the defaults).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0) -> None:
        super().__init__(PolygonMesh(V, F), t_coef)

    def compute_distance(self, v_inds: Vector) -> np.ndarray:
        """(n,) distances from the nearest of one or more vertices."""
        return self._distance(v_inds)

    def compute_signed_distance(self, curves: Curves, level_set_constraint: str = "ZeroSet") -> np.ndarray:
        """(n,) distances from the nearest of several curves, given by their vertices; positive on their left."""
        only_zero_set(level_set_constraint)
        given = self._curves(curves)
        return self._distance_from_curves(self.solver, given, [True] * len(given))


class PointCloudHeatSolver(_Heat):
    """Distances, log maps, parallel transport and extension of scalars on a point cloud, by the heat method.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.PointCloudHeatSolver(ahm.shapes.plane(9, 9)[0])
    >>> solver.compute_distance(0)[:4].round(9).tolist()
    [0.0, 1.0, 2.0, 3.0]

    Raises ValueError (an invalid cloud, as `ahm.PointCloud`; a row out of range), NotImplementedError (options of the level sets
    other than the defaults).
    """

    _one, _many = "p_ind", "p_inds"

    def __init__(self, P: Matrix, t_coef: float = 1.0) -> None:
        super().__init__(PointCloud(P), t_coef)

    def compute_distance(self, p_ind: SupportsIndex) -> np.ndarray:
        """(n,) distances from a point."""
        return self._distance_from_one(p_ind)

    def compute_distance_multisource(self, p_inds: Vector) -> np.ndarray:
        """(n,) distances from the nearest of several points."""
        return self._distance(p_inds)

    def compute_signed_distance(self, curves: Curves, cloud_normals: Matrix, preserve_source_normals: bool = False,
                                level_set_constraint: str = "ZeroSet", soft_level_set_weight: float = -1) -> np.ndarray:
        """(n,) distances from the nearest of several curves, given by their points; positive on their left, seen from the side to
        which `cloud_normals` (n, 3) point."""
        only_zero_set(level_set_constraint, preserve_source_normals, soft_level_set_weight)
        normals, ours = arguments.floats(cloud_normals, "cloud_normals", (len(self.surface), 3)), self.surface.normals
        result = np.full(len(self.surface), np.nan)
        for curve in self._curves(curves):
            rows = [int(row) for row in curve]  # type: ignore[arg-type]
            seen_from_below = np.einsum("ij,ij->", normals[rows], ours[rows]) < 0
            found = self._distance_from_curves(self.solver, [curve], [True])
            result = nearer(result, -found if seen_from_below else found)
        return result

    # The methods of meshes, with the parameter names of clouds.

    def extend_scalar(self, p_inds: Vector, values: Vector) -> np.ndarray:
        """(n,) values extended to all points: each gets the value of the nearest one of p_inds, blended at ties."""
        return super().extend_scalar(p_inds, values)

    def transport_tangent_vector(self, p_ind: SupportsIndex, vector: Vector) -> np.ndarray:
        """(n, 2) the vector at p_ind, parallel transported to every point, in the frames of `get_tangent_frames`."""
        return super().transport_tangent_vector(p_ind, vector)

    def transport_tangent_vectors(self, p_inds: Vector, vectors: Matrix) -> np.ndarray:
        """(n, 2) vectors at p_inds, parallel transported: each point gets that of the nearest one, blended at ties."""
        return super().transport_tangent_vectors(p_inds, vectors)

    def compute_log_map(self, p_ind: SupportsIndex, strategy: str = "AffineLocal") -> np.ndarray:
        """(n, 2) log map from p_ind, in its frame, with the strategies of meshes."""
        return super().compute_log_map(p_ind, strategy)


class EdgeFlipGeodesicSolver(OnSurface):
    """Paths on a triangle mesh: shortest between two vertices, locally shortest through several vertices.

    Paths are not computed by iterations: `max_iterations` has no effect.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> paths = pp3d.EdgeFlipGeodesicSolver(*ahm.shapes.plane(4, 3))
    >>> paths.find_geodesic_path(0, 11)[[0, -1]].tolist()
    [[0.0, 0.0, 0.0], [3.0, 2.0, 0.0]]

    Raises ValueError (a row out of range; vertices that are not connected).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def find_geodesic_path(self, v_start: SupportsIndex, v_end: SupportsIndex, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of the shortest path. Raises ValueError if the vertices are not connected."""
        ends = np.array([self._row(v_start, "v_start"), self._row(v_end, "v_end")])
        return self._points(geodesic_path(self.surface, ends), ends)

    def find_geodesic_paths(self, v_starts: Vector, v_ends: Vector) -> List[np.ndarray]:
        """The shortest path from v_starts[i] to v_ends[i] for every i, as from `find_geodesic_path`."""
        starts, ends = self._rows(v_starts, "v_starts"), self._rows(v_ends, "v_ends")
        found = geodesic_paths(self.surface, starts, ends, pairwise=True)
        return [self._points(path, [a, b]) for path, a, b in zip(found, starts, ends)]

    def find_geodesic_path_poly(self, v_list: Vector, max_iterations: Optional[int] = None,
                                max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of the path through the vertices, pulled taut until it is locally shortest. Only its ends are fixed.

        If it were shorter than `max_relative_length_decrease` times the path of shortest paths between the vertices, the latter is
        returned."""
        return self._taut(v_list, False, max_relative_length_decrease)

    def find_geodesic_loop(self, v_list: Vector, max_iterations: Optional[int] = None,
                           max_relative_length_decrease: Optional[float] = None) -> np.ndarray:
        """(k, 3) points of a closed geodesic: the closed path through the vertices, pulled taut until it is locally shortest.

        If nothing holds the loop, it shrinks to one point. `max_relative_length_decrease` as in `find_geodesic_path_poly`."""
        return self._taut(v_list, True, max_relative_length_decrease)

    def _taut(self, v_list: Vector, closed: bool, max_relative_length_decrease: Optional[float]) -> np.ndarray:
        rows = self._rows(v_list, "v_list")
        least = arguments.real(max_relative_length_decrease or 0, "max_relative_length_decrease")
        path = geodesic_path(self.surface, rows, closed=closed, taut=True)
        if path is not None and least > 0:
            before = geodesic_path(self.surface, rows, closed=closed)
            if before is not None and path.length < least * before.length:
                path = before
        return self._points(path, rows)

    @staticmethod
    def _points(path: Optional[Path], rows: Union[np.ndarray, Sequence[int]]) -> np.ndarray:
        if path is None:
            raise ValueError(f"no path connects the vertices {[int(r) for r in rows]}")
        return path.points


class GeodesicTracer(OnSurface):
    """Straightest geodesics on a triangle mesh (`ahm.trace`). Their length is the length of `direction_xyz`.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> tracer = pp3d.GeodesicTracer(*ahm.shapes.plane(4, 3))
    >>> tracer.trace_geodesic_from_vertex(0, [1.5, 1.0, 0.0])[-1].round(9).tolist()
    [1.5, 1.0, 0.0]

    Raises ValueError (a row or face out of range; invalid barycentric coordinates; a direction of length 0).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)

    def trace_geodesic_from_vertex(self, start_vert: SupportsIndex, direction_xyz: Vector,
                                   max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points of the geodesic. It ends at the boundary if it reaches it, or after `max_iterations` triangles."""
        return self._trace(self._row(start_vert, "start_vert"), direction_xyz, max_iterations)

    def trace_geodesic_from_face(self, start_face: SupportsIndex, bary_coords: Vector, direction_xyz: Vector,
                                 max_iterations: Optional[int] = None) -> np.ndarray:
        """(k, 3) points of the geodesic. It ends at the boundary if it reaches it, or after `max_iterations` triangles."""
        face = arguments.integer(start_face, "start_face", 0, self.surface._face_count - 1)
        return self._trace((face, bary_coords), direction_xyz, max_iterations)

    def trace_geodesics_from_vertices(self, start_verts: Vector, directions_xyz: Matrix) -> List[np.ndarray]:
        """The geodesic from start_verts[i] in the direction directions_xyz[i], for every i."""
        starts = self._rows(start_verts, "start_verts")
        directions = arguments.floats(directions_xyz, "directions_xyz", (len(starts), 3), finite=True)
        return [self._trace(int(v), d, None) for v, d in zip(starts, directions)]

    def _trace(self, start: Source, direction: Vector, max_iterations: Optional[int]) -> np.ndarray:
        points = trace(self.surface, start, direction).points
        return points if max_iterations is None else points[: arguments.integer(max_iterations, "max_iterations", 1, 2**63 - 1) + 1]


__all__ = [
    "EdgeFlipGeodesicSolver", "GeodesicTracer", "MeshFastMarchingDistanceSolver", "MeshHeatMethodDistanceSolver",
    "MeshMarchingTrianglesSolver", "MeshSignedHeatSolver", "MeshVectorHeatSolver", "PointCloudHeatSolver",
    "PointCloudLocalTriangulation", "PolygonMeshHeatSolver", "compute_distance", "compute_distance_multisource",
    "cotan_laplacian", "edges", "face_areas", "marching_triangles", "read_mesh", "read_point_cloud", "read_polygon_mesh",
    "validate_mesh", "validate_points", "vertex_areas", "write_mesh", "write_point_cloud",
]
