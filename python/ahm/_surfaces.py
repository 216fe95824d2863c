"""Surfaces, grids and graphs: what maps are made on."""

from __future__ import annotations

import os
from typing import Any, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from ._options import checked
from ._progress import Progress, reporting


class ClosestPoints(NamedTuple):
    """Points of a surface nearest to positions in space; k of them."""

    position: np.ndarray  #: (k, 3), world units
    distance: np.ndarray  #: (k,), in space
    face: np.ndarray  #: (k,) int32; -1 of a cloud
    barycentric: List[Optional[np.ndarray]]  #: one number per corner of the face; None of a cloud
    row: np.ndarray  #: (k,) int32, of a cloud: the row in whose tangent plane the point lies; else -1


class TangentGraph(NamedTuple):
    """The graph under a surface, by vertices: arrays in compressed rows, in units of `length_unit` (docs/graph_contract.md)."""

    indptr: np.ndarray  #: (n + 1,) int64
    indices: np.ndarray  #: (e,) int32: the neighbour j of edge i -> j
    weights: np.ndarray  #: (e,) w_ij
    logs: np.ndarray  #: (e, d): where j lies, seen from i, in the frame of i
    transports: np.ndarray  #: (e, 2) (cos, sin), or (e, d, d): from the frame of j to that of i
    masses: np.ndarray  #: (n,)
    frames: Optional[np.ndarray]  #: (n, 4, 3): origin, x, y, normal in space, world units; None without
    length_unit: float
    vertex_of_row: np.ndarray  #: (rows,) int32; -1: removed
    row_of_vertex: np.ndarray  #: (n,) int32; -1: a vertex that the input does not have


class Surface:
    """What maps are made on. Immutable, and shared by threads; made by its subclasses, `ahm.read` and `ahm.surface`.

    Its rows are those of the input: vertices of a mesh, points of a cloud. All results have one entry per row.
    """

    _body: _core.Body
    _options: Dict[str, Any]
    _position_width = 3

    def __len__(self) -> int:
        """Number of rows."""
        return self._body.rows

    @property
    def points(self) -> np.ndarray:
        """(n, 3) positions as given, world units; read-only, not a copy."""
        return self._body.positions()

    @property
    def dimension(self) -> int:
        """Of the tangent spaces: 2 of surfaces."""
        return self._body.dimension

    @property
    def mean_edge_length(self) -> float:
        """Mean length h of the graph's edges, world units: the scale of the diffusion, tau = t_coef h^2."""
        return self._body.mean_edge_length

    @property
    def normals(self) -> np.ndarray:
        """(n, 3) unit normals as the graph uses them; NaN where a row has none."""
        return self._body.normals()

    @property
    def frames(self) -> Optional[np.ndarray]:
        """(n, 3, 3) tangent axes x, y and the normal of every row, in space; NaN where a row was removed. None without."""
        frames = self._body.frames()
        if frames is None:
            return None
        vertex = self._body.vertex_of_row()
        return np.where((vertex >= 0)[:, None, None], frames[vertex, 1:], np.nan)

    @property
    def report(self) -> Dict[str, Any]:
        """What was found and done while the graph was built, by name."""
        return self._body.report()

    @property
    def warnings(self) -> List[Dict[str, Any]]:
        """What one should know: dictionaries with `id`, `numbers`, `rows` and `name`, as listed in the C++ headers."""
        return self._body.warnings()

    @property
    def components(self) -> np.ndarray:
        """(n,) int32 number of the connected component of every row; -1 where a row was removed."""
        vertex = self._body.vertex_of_row()
        return np.where(vertex >= 0, self._body.components()[vertex], -1).astype(np.int32)

    @property
    def graph(self) -> TangentGraph:
        """The graph itself, as arrays (copies)."""
        body = self._body
        return TangentGraph(*body.csr(), body.frames(), body.length_unit, body.vertex_of_row(), body.row_of_vertex())

    def closest_points(self, positions: Any) -> ClosestPoints:
        """The nearest points of the faces; of a cloud, of the tangent plane of the nearest row.

        >>> import ahm
        >>> mesh = ahm.TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> near = mesh.closest_points([[0.25, 0.25, 2.0]])
        >>> near.position.round(9).tolist(), near.distance.tolist()
        ([[0.25, 0.25, 0.0]], [2.0])

        Raises ValueError where a position is not finite.
        """
        given = arguments.floats(positions, "positions", (None, 3), finite=True)
        face, row, weights, place, distance = self._body.closest_points(given, None)
        return ClosestPoints(place, distance, face, weights, row)

    @property
    def _face_count(self) -> int:
        return 0

    def _corner_count(self, face: int) -> int:
        return 3

    def _state(self) -> tuple:
        raise NotImplementedError

    def __reduce__(self) -> tuple:
        return _rebuild, (type(self), self._state(), self._options)

    def __repr__(self) -> str:
        return f"<ahm.{type(self).__name__}: {self._describe()}>"

    def _describe(self) -> str:
        return f"{len(self)} rows"


def _rebuild(type_: type, state: tuple, options: Dict[str, Any]) -> Surface:
    return type_(*state, **options)


class TriangleMesh(Surface):
    """A triangle mesh: intrinsic Delaunay triangulation, vertex tangent spaces, cotangent weights.

    vertices : (n, 3) positions, world units.
    faces : (m, 3) rows of the vertices.
    delaunay : flip edges until all are Delaunay; the result still refers to the input mesh.
    clamp_weights : keep cotangent weights in [0, 1e4].
    non_manifold : "error", or "split": cut the mesh open where more than two faces meet in an edge.
    threads : 0: one per core. No result depends on it.
    progress : None, True (a bar), or a callable (stage, fraction).

    Raises InvalidGeometry (a ValueError) naming the elements: an index out of range, a repeated vertex, a duplicate face, a
    coordinate that is not finite, a non-manifold edge or vertex; ResourceExhausted (a MemoryError).

    >>> import ahm
    >>> mesh = ahm.TriangleMesh(*ahm.shapes.sphere(3))
    >>> mesh
    <ahm.TriangleMesh: 642 vertices, 1280 faces>
    """

    def __init__(self, vertices: Any, faces: Any, *, delaunay: bool = True, clamp_weights: bool = True,
                 non_manifold: str = "error", threads: int = 0, progress: Progress = None) -> None:
        points = arguments.floats(vertices, "vertices", (None, 3))
        triangles = arguments.integers(faces, "faces", 2)
        if triangles.shape[1] != 3:
            raise ValueError(f"faces: shape (m, 3) is needed, not {triangles.shape}; PolygonMesh takes other polygons")
        self._options = checked(delaunay=delaunay, clamp_weights=clamp_weights, non_manifold=non_manifold,
                                threads=threads)
        with reporting(progress) as report:
            self._body = _core.triangle_mesh(points, triangles, self._options, report)

    @property
    def vertices(self) -> np.ndarray:
        """The same as `points`."""
        return self.points

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int32 as given; read-only, not a copy."""
        return self._body.faces()[1].reshape(-1, 3)

    @property
    def _face_count(self) -> int:
        return len(self._body.faces()[0]) - 1

    def _state(self) -> tuple:
        return np.array(self.points), np.array(self.faces)

    def _describe(self) -> str:
        return f"{len(self)} vertices, {self._face_count} faces"


class PolygonMesh(Surface):
    """A mesh of polygons with any number of corners, planar or not.

    vertices : (n, 3) positions, world units.
    faces : a list of lists of rows, or an (m, c) array.
    discretization : "automatic": refined, unless faces are twisted; "refined": into triangles, with one virtual vertex inside
        every face; "polygons": as they are [BHKB20].
    delaunay, clamp_weights, non_manifold, threads, progress : as of `TriangleMesh`.

    Raises as `TriangleMesh`.

    >>> import ahm
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    >>> ahm.PolygonMesh(cube, sides)
    <ahm.PolygonMesh: 8 vertices, 6 faces>
    """

    def __init__(self, vertices: Any, faces: Any, *, discretization: str = "automatic", delaunay: bool = True,
                 clamp_weights: bool = True, non_manifold: str = "error", threads: int = 0,
                 progress: Progress = None) -> None:
        points = arguments.floats(vertices, "vertices", (None, 3))
        begin, corners = _polygons(faces)
        self._options = checked(discretization=discretization, delaunay=delaunay, clamp_weights=clamp_weights,
                                non_manifold=non_manifold, threads=threads)
        with reporting(progress) as report:
            self._body = _core.polygon_mesh(points, begin, corners, self._options, report)

    @property
    def vertices(self) -> np.ndarray:
        """The same as `points`."""
        return self.points

    @property
    def faces(self) -> List[np.ndarray]:
        """Views of the corners of every face, int32, as given."""
        begin, corners = self._body.faces()
        return [corners[b:e] for b, e in zip(begin[:-1], begin[1:])]

    @property
    def _face_count(self) -> int:
        return len(self._body.faces()[0]) - 1

    def _corner_count(self, face: int) -> int:
        begin = self._body.faces()[0]
        return int(begin[face + 1] - begin[face])

    def _state(self) -> tuple:
        begin, corners = self._body.faces()
        return np.array(self.points), _Compressed(np.array(begin), np.array(corners))

    def _describe(self) -> str:
        return f"{len(self)} vertices, {self._face_count} faces"


class _Compressed(NamedTuple):
    """Polygons in compressed rows, inside this package."""

    begin: np.ndarray
    corners: np.ndarray


def _polygons(faces: Any) -> _Compressed:
    if isinstance(faces, _Compressed):
        return faces
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        whole = arguments.integers(faces, "faces", 2)
        return _Compressed(np.arange(len(whole) + 1, dtype=np.int64) * whole.shape[1], whole.reshape(-1))
    if isinstance(faces, (str, bytes)) or not hasattr(faces, "__len__"):
        raise TypeError(f"faces: a list of lists of rows is needed, not {arguments.describe(faces)}")
    lists = [arguments.integers(face, f"faces[{f}]", 1) if len(np.shape(face)) != 1 or len(face) else np.empty(0, np.int32)
             for f, face in enumerate(faces)]
    begin = np.concatenate([[0], np.cumsum([len(face) for face in lists])]).astype(np.int64)
    return _Compressed(begin, np.concatenate(lists).astype(np.int32) if lists else np.empty(0, np.int32))


class PointCloud(Surface):
    """Scattered points as a surface: normals, local Delaunay triangulations, tufted Laplacian [SC20].

    points : (n, 3) positions, world units; equal points share one vertex.
    normals : (n, 3) of any length > 0, or None: estimated.
    k : neighbours per point; None: 30, and more on noisy clouds.
    normal_signs : what the signs of given normals mean: "automatic", "oriented" (trusted one by one), "unoriented".
    max_edge_ratio : points are joined only up to this multiple of the distance to the k-th neighbour.
    drop_non_finite : leave rows with NaN or infinity out (status `removed`) instead of raising.
    rows : build from these rows only, ascending; the others are `removed`.
    threads, progress : as of `TriangleMesh`.

    Raises InvalidGeometry (fewer than 3 distinct points, values that are not finite, all points on a line), ResourceExhausted.

    >>> import ahm
    >>> cloud = ahm.PointCloud(ahm.shapes.sphere(3)[0])
    >>> cloud
    <ahm.PointCloud: 642 points>
    """

    def __init__(self, points: Any, normals: Any = None, *, k: Optional[int] = None, normal_signs: str = "automatic",
                 max_edge_ratio: float = 3.0, drop_non_finite: bool = False, rows: Any = None, threads: int = 0,
                 progress: Progress = None) -> None:
        given = arguments.floats(points, "points", (None, 3))
        self._normals = None
        if normals is not None:
            self._normals = np.array(arguments.floats(normals, "normals", (len(given), 3)))
        self._options = checked(k=k, normal_signs=normal_signs, max_edge_ratio=max_edge_ratio,
                                drop_non_finite=drop_non_finite, threads=threads)
        if rows is not None:
            self._options["rows"] = arguments.rows(rows, "rows", len(given))
        with reporting(progress) as report:
            self._body = _core.point_cloud(given, self._normals, self._options, report)

    def _state(self) -> tuple:
        return np.array(self.points), self._normals

    def _describe(self) -> str:
        return f"{len(self)} points" + (", with normals" if self._normals is not None else "")


class Grid(Surface):
    """A regular grid in the plane or in space, with or without obstacles. Row numbers run fastest along the first axis.

    shape : vertices along each axis, 2 or 3 numbers >= 2.
    spacing : lengths along each axis > 0, or one for all; world units.
    origin : position of row 0; None: zero.
    blocked : None, or one value per cell, True inside obstacles: an array of shape (shape[0] - 1, shape[1] - 1, ...).

    Raises InvalidGeometry, ResourceExhausted.

    >>> import ahm
    >>> grid = ahm.Grid((5, 4), 0.5)
    >>> ahm.log_map(grid, 0).uv[grid.row((3, 2))].round(9).tolist()
    [1.5, 1.0]
    """

    def __init__(self, shape: Any, spacing: Any = 1.0, origin: Any = None, blocked: Any = None) -> None:
        self._shape = arguments.integers(shape, "shape", 1)
        d = len(self._shape)
        if np.ndim(spacing) == 0 and not isinstance(spacing, (str, bytes, bool)):
            spacing = [arguments.real(spacing, "spacing")] * d
        self._spacing = np.array(arguments.floats(spacing, "spacing", (d,)))
        self._origin = np.array(arguments.floats([0.0] * d if origin is None else origin, "origin", (d,)))
        self._blocked = np.empty(0, np.uint8)
        if blocked is not None:
            cells = np.asarray(blocked)
            if cells.dtype.kind not in "biu" or cells.shape != tuple(self._shape - 1):
                raise ValueError(f"blocked: a bool array of shape {tuple(int(s) for s in self._shape - 1)} is needed, not "
                                 f"{arguments.describe(blocked, cells)}")
            self._blocked = np.ascontiguousarray((cells != 0).ravel(order="F"), np.uint8)
        self._options = {}
        self._body = _core.grid(self._shape, self._spacing, self._origin, self._blocked)

    @property
    def _position_width(self) -> int:  # type: ignore[override]
        return len(self._shape)

    @property
    def shape(self) -> Tuple[int, ...]:
        """Vertices along each axis: a result `x` by rows is `x.reshape(grid.shape, order="F")`."""
        return tuple(int(s) for s in self._shape)

    def row(self, steps: Any) -> int:
        """The row at these steps along the axes. Raises ValueError outside of the grid."""
        at = arguments.integers(steps, "steps", 1)
        if at.shape != self._shape.shape or (at < 0).any() or (at >= self._shape).any():
            raise ValueError(f"steps: {at.tolist()} lies outside of the grid of shape {self.shape}")
        return int(np.ravel_multi_index(tuple(at), self.shape, order="F"))

    def _state(self) -> tuple:
        cells = self._blocked.reshape(self._shape - 1, order="F").astype(bool) if len(self._blocked) else None
        return self._shape, self._spacing, self._origin, cells

    def _describe(self) -> str:
        return " x ".join(str(s) for s in self.shape) + " vertices"


class Graph(Surface):
    """A tangent graph of your own, in compressed rows, whose tangent spaces are R^d (docs/graph_contract.md).

    indptr : (n + 1,), indices : (e,) the neighbour of every directed edge; each edge has its reverse.
    weights : (e,) w_ij = w_ji.
    logs : (e, d): where neighbour j lies, seen from i, in the frame of i; world units.
    transports : (e, 2) (cos, sin) or complex (e,), for d = 2; or (e, d, d): components in the frame of j -> in the frame of i.
    masses : (n,) dual areas or volumes > 0.
    frames : (n, 4, 3) origin, x, y and normal of every vertex in space, or None.
    mean_edge_length : None: the mean of |logs|.

    Raises InvalidGraph (a ValueError) naming the first law that is broken, with its vertex or edge.

    >>> import ahm, numpy as np
    >>> line = ahm.Graph([0, 1, 3, 4], [1, 0, 2, 1], weights=np.ones(4), logs=[[1], [-1], [1], [-1]],
    ...                  transports=np.ones((4, 1, 1)), masses=[0.5, 1, 0.5])
    >>> ahm.log_map(line, 0).uv.ravel().round(9).tolist()
    [0.0, 1.0, 2.0]
    """

    def __init__(self, indptr: Any, indices: Any, weights: Any, logs: Any, transports: Any, masses: Any, *,
                 frames: Any = None, mean_edge_length: Optional[float] = None, length_unit: float = 1.0,
                 is_delaunay: bool = False) -> None:
        begin = arguments.integers(indptr, "indptr", 1, 0, 2**62, np.int64)
        neighbors = arguments.integers(indices, "indices", 1)
        e = len(neighbors)
        edges = arguments.floats(logs, "logs", (e, None))
        d = edges.shape[1]
        if np.iscomplexobj(transports):
            given = np.ascontiguousarray(transports, np.complex128)
            turns = arguments.floats(given.reshape(-1).view(np.float64).reshape(-1, 2), "transports", (e, 2))
        elif np.ndim(transports) == 2:
            turns = arguments.floats(transports, "transports", (e, 2))
        else:
            turns = arguments.floats(transports, "transports", (e, d, d))
        self._options = {"length_unit": arguments.real(length_unit, "length_unit", positive=True),
                         "is_delaunay": arguments.flag(is_delaunay, "is_delaunay")}
        if mean_edge_length is not None:
            self._options["mean_edge_length"] = arguments.real(mean_edge_length, "mean_edge_length", positive=True)
        if frames is not None:
            self._options["frames"] = arguments.floats(frames, "frames", (None, 4, 3))
        self._body = _core.graph(begin, neighbors, arguments.floats(weights, "weights", (e,)), edges, turns,
                                 arguments.floats(masses, "masses", (None,)), self._options)

    def _state(self) -> tuple:
        return tuple(self._body.csr())

    @property
    def points(self) -> Optional[np.ndarray]:  # type: ignore[override]
        """(n, 3) origins of the frames; None without."""
        frames = self._options.get("frames")
        return None if frames is None else frames[:, 0]

    def _describe(self) -> str:
        return f"{len(self)} vertices, {self._body.edge_count} edges, dimension {self.dimension}"


def read(path: Union[str, "os.PathLike[str]"], kind: Optional[str] = None, **options: Any) -> Surface:
    """The surface in a file: .ply, .off, .obj, .stl, .pcd, .xyz, .txt or .csv.

    kind : "triangles", "polygons" or "cloud"; None: as the file has it. A mesh read as a cloud keeps its normals.
    options : of `TriangleMesh`, `PolygonMesh` or `PointCloud`.

    Raises IoError (an OSError) naming the file and what is wrong with it, and as these.
    """
    got = _core.read_file(os.fspath(path))
    begin, corners = got["face_begin"], got["face_vertices"]
    if kind is None:
        kind = "cloud" if begin is None else "triangles" if (np.diff(begin) == 3).all() else "polygons"
    arguments.choice(kind, "kind", ("triangles", "polygons", "cloud"))
    if kind == "cloud":
        return PointCloud(got["points"], got["normals"], **options)
    if begin is None:
        raise ValueError(f"kind: {os.fspath(path)} holds no faces; read it as a 'cloud'")
    if kind == "polygons":
        return PolygonMesh(got["points"], _Compressed(begin, corners), **options)
    if not (np.diff(begin) == 3).all():
        raise ValueError(f"kind: {os.fspath(path)} holds faces with other than 3 corners; read it as 'polygons'")
    return TriangleMesh(got["points"], corners.reshape(-1, 3), **options)


def surface(thing: Any, **options: Any) -> Surface:
    """A surface of anything that has points and perhaps faces: PyVista, trimesh, Open3D, meshio, or a tuple (V, F).

    thing : a `Surface` (returned as it is); an (n, 3) array (a cloud); a tuple `(vertices, faces)`; or an object with
        `points`, `vertices` or `point.positions`, and `faces`, `regular_faces`, `triangles` or `cells_dict`.
    options : of the class that it becomes.

    >>> import ahm
    >>> ahm.surface(ahm.shapes.plane(4, 3))
    <ahm.TriangleMesh: 12 vertices, 12 faces>

    Raises TypeError where it is none of these.
    """
    if isinstance(thing, Surface):
        if options:
            raise TypeError("surface: options make no sense for a surface that is made already")
        return thing
    if isinstance(thing, tuple) and len(thing) == 2:
        return _mesh(thing[0], thing[1], options)
    for name in ("points", "vertices"):
        found = getattr(thing, name, None)
        if found is not None and not callable(found):
            return _mesh(np.asarray(found), _faces_of(thing), options, getattr(thing, "normals", None))
    tensor = getattr(getattr(thing, "point", None), "positions", None) or getattr(getattr(thing, "vertex", None), "positions", None)
    if tensor is not None:
        triangle = getattr(getattr(thing, "triangle", None), "indices", None)
        return _mesh(tensor.numpy(), None if triangle is None else triangle.numpy(), options)
    if hasattr(thing, "__len__") or hasattr(thing, "__array__"):
        return PointCloud(thing, **options)
    raise TypeError(f"surface: {type(thing).__name__} has no points, vertices or faces")


def _mesh(points: Any, faces: Any, options: Dict[str, Any], normals: Any = None) -> Surface:
    if faces is None or (hasattr(faces, "__len__") and len(faces) == 0):
        given = None if normals is None or callable(normals) or len(normals) != len(points) else normals
        return PointCloud(points, given, **options)
    if isinstance(faces, _Compressed):
        return PolygonMesh(points, faces, **options)
    if not isinstance(faces, np.ndarray):
        lengths = {np.size(face) for face in faces}
        if lengths != {3}:
            return PolygonMesh(points, faces, **options)
        faces = np.asarray(faces)
    return (TriangleMesh if faces.shape[-1] == 3 else PolygonMesh)(points, faces, **options)


def _faces_of(thing: Any) -> Any:
    """The faces of an object: an (m, c) array, a list, compressed rows, or None."""
    try:
        regular = getattr(thing, "regular_faces", None)  # PyVista; raises where faces differ
    except ValueError:
        regular = None
    if regular is not None:
        return np.asarray(regular)
    if getattr(thing, "triangles", None) is not None:  # Open3D
        return np.asarray(thing.triangles)
    cells = getattr(thing, "cells_dict", None)  # meshio
    if cells is not None:
        kinds = [cells[kind] for kind in ("triangle", "quad", "polygon") if kind in cells]
        return [face for block in kinds for face in block] if len(kinds) != 1 else np.asarray(kinds[0])
    faces = getattr(thing, "faces", None)
    if faces is None:
        return None
    if isinstance(faces, np.ndarray) and faces.ndim == 1:  # PyVista: count, corners, count, corners
        return _padded_faces(faces)
    return faces if isinstance(faces, list) else np.asarray(faces)


def _padded_faces(flat: np.ndarray) -> List[np.ndarray]:
    result, at = [], 0
    while at < len(flat):
        result.append(flat[at + 1 : at + 1 + int(flat[at])])
        at += 1 + int(flat[at])
    return result
