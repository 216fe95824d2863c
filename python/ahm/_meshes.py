"""Triangle meshes and polygon meshes."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from ._options import checked
from ._progress import Progress, reporting
from ._surfaces import Surface
from .typing import Matrix, Faces


class TriangleMesh(Surface):
    """A triangle mesh as a surface: intrinsic Delaunay triangulation, tangent spaces at the vertices, cotangent weights.

    vertices : (n, 3) positions, world units.
    faces : (m, 3) rows of the corners of every triangle.
    delaunay : flip edges until all are Delaunay. Results still refer to the input mesh.
    clamp_weights : clamp cotangent weights to [0, 1e4].
    non_manifold : treatment of nonmanifold edges and vertices. "error": raise. "split": cut the mesh open there.
    threads : number of threads; 0: one per core. No result depends on it.
    progress : None, True (a progress bar), or a callable that takes (stage, fraction).

    Raises InvalidGeometry (a ValueError) naming the elements: an index out of range, a repeated vertex, a duplicate face, a
    coordinate that is not finite, a nonmanifold edge or vertex. Raises ResourceExhausted (a MemoryError).

    >>> import ahm
    >>> mesh = ahm.TriangleMesh(*ahm.shapes.sphere(3))
    >>> mesh
    <ahm.TriangleMesh: 642 vertices, 1280 faces>
    """

    def __init__(self, vertices: Matrix, faces: Faces, *, delaunay: bool = True, clamp_weights: bool = True,
                 non_manifold: str = "error", threads: int = 0, progress: Progress = None) -> None:
        points = arguments.floats(vertices, "vertices", (None, 3))
        triangles = arguments.integers(faces, "faces", 2)
        if triangles.shape[1] != 3:
            raise ValueError(f"faces: expected shape (m, 3), got {triangles.shape}; use PolygonMesh for other polygons")
        self._options = checked(delaunay=delaunay, clamp_weights=clamp_weights, non_manifold=non_manifold,
                                threads=threads)
        with reporting(progress) as report:
            self._body = _core.triangle_mesh(points, triangles, self._options, report)

    _all_triangles = True

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) positions of the vertices, world units; the same array as `points`."""
        return self.points

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int32 rows of the corners of every triangle of the input; a read-only view."""
        return self._body.faces()[1].reshape(-1, 3)

    @property
    def _face_count(self) -> int:
        return len(self._body.faces()[0]) - 1

    def _state(self) -> tuple:
        return np.array(self.points), np.array(self.faces)

    def _describe(self) -> str:
        return f"{arguments.counted(len(self), 'vertex')}, {arguments.counted(self._face_count, 'face')}"


class PolygonMesh(Surface):
    """A mesh of polygons with any number of corners, planar or not.

    vertices : (n, 3) positions, world units.
    faces : rows of the corners of every face, as a list of lists, or as an (m, c) array if all faces have c corners.
    discretization : "refined": triangles, with one virtual vertex inside every face that is not a triangle. "polygons": a
        Laplacian of the polygons themselves [BHKB20]. "automatic": "refined", or "polygons" if a face is twisted.
    delaunay, clamp_weights, non_manifold, threads, progress : as in `TriangleMesh`.

    Raises as `TriangleMesh`.

    >>> import ahm
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    >>> ahm.PolygonMesh(cube, sides)
    <ahm.PolygonMesh: 8 vertices, 6 faces>
    """

    def __init__(self, vertices: Matrix, faces: Faces, *, discretization: str = "automatic", delaunay: bool = True,
                 clamp_weights: bool = True, non_manifold: str = "error", threads: int = 0,
                 progress: Progress = None) -> None:
        points = arguments.floats(vertices, "vertices", (None, 3))
        begin, corners = polygons(faces)
        self._options = checked(discretization=discretization, delaunay=delaunay, clamp_weights=clamp_weights,
                                non_manifold=non_manifold, threads=threads)
        with reporting(progress) as report:
            self._body = _core.polygon_mesh(points, begin, corners, self._options, report)

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) positions of the vertices, world units; the same array as `points`."""
        return self.points

    @property
    def faces(self) -> List[np.ndarray]:
        """Rows of the corners of every face of the input: a list of int32 arrays, which are views."""
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
        return np.array(self.points), Compressed(np.array(begin), np.array(corners))

    def _describe(self) -> str:
        return f"{arguments.counted(len(self), 'vertex')}, {arguments.counted(self._face_count, 'face')}"


class Compressed(NamedTuple):
    """Polygons in compressed rows, for use inside this package."""

    begin: np.ndarray
    corners: np.ndarray


def as_faces(begin: np.ndarray, corners: np.ndarray) -> Union[np.ndarray, List[np.ndarray]]:
    """Faces as an (m, c) array if all have c corners, otherwise as a list of arrays; views."""
    counts = np.diff(begin)
    if len(counts) and (counts == counts[0]).all():
        return corners.reshape(-1, counts[0])
    return [corners[b:e] for b, e in zip(begin[:-1], begin[1:])]


def polygons(faces: Any) -> Compressed:
    if isinstance(faces, Compressed):
        return faces
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        whole = arguments.integers(faces, "faces", 2)
        return Compressed(np.arange(len(whole) + 1, dtype=np.int64) * whole.shape[1], whole.reshape(-1))
    if isinstance(faces, (str, bytes)) or not hasattr(faces, "__len__"):
        raise TypeError(f"faces: expected a list of lists of rows, got {arguments.describe(faces)}")
    lists = [arguments.integers(face, f"faces[{f}]", 1) if len(np.shape(face)) != 1 or len(face) else np.empty(0, np.int32)
             for f, face in enumerate(faces)]
    begin = np.concatenate([[0], np.cumsum([len(face) for face in lists])]).astype(np.int64)
    return Compressed(begin, np.concatenate(lists).astype(np.int32) if lists else np.empty(0, np.int32))
