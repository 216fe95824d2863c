"""Areas, edges, the cotangent Laplacian and contours of a triangle mesh that is two arrays, with the signatures of potpourri3d."""

from __future__ import annotations

from typing import TYPE_CHECKING, Dict, List, Sequence, Tuple

import numpy as np

from . import _arguments as arguments
from .typing import Faces, Matrix, Vector

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

EdgePoint = Tuple[int, List[float]]  #: (edge, [t]): the point at fraction t of an edge


def checked_mesh(V: Matrix, F: Faces) -> Tuple[np.ndarray, np.ndarray]:
    """Checks shapes and row numbers. Returns float64 and int32 arrays."""
    points = arguments.floats(V, "V", (None, 3))
    faces = arguments.integers(F, "F", 2, 0, len(points) - 1)
    if faces.shape[1] != 3:
        raise ValueError(f"F: expected shape (m, 3), got {faces.shape}")
    return points, faces


def face_areas(V: Matrix, F: Faces) -> np.ndarray:
    """(m,) areas of the triangles.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.face_areas(*ahm.shapes.plane(2, 2)).tolist()
    [0.5, 0.5]

    Raises ValueError (wrong shape; a row out of range).
    """
    points, faces = checked_mesh(V, F)
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def vertex_areas(V: Matrix, F: Faces) -> np.ndarray:
    """(n,) area of every vertex: a third of the areas of its triangles.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> round(float(pp3d.vertex_areas(*ahm.shapes.plane(4, 3)).sum()), 9)
    6.0

    Raises ValueError (wrong shape; a row out of range).
    """
    points, faces = checked_mesh(V, F)
    return np.bincount(faces.ravel(), np.repeat(face_areas(points, faces) / 3, 3), len(points))


def cotan_laplacian(V: Matrix, F: Faces, denom_eps: float = 0.0) -> csr_matrix:
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

    points, faces = checked_mesh(V, F)
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


def edges(V: Matrix, F: Faces) -> np.ndarray:
    """(e, 2) vertices of every edge, in the order and direction in which the edges first occur in `F`.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.edges(*ahm.shapes.plane(2, 2)).tolist()
    [[0, 1], [1, 3], [3, 0], [3, 2], [2, 0]]

    Raises ValueError (wrong shape; a row out of range).
    """
    return edges_and_sides(checked_mesh(V, F)[1])[0]


def edges_and_sides(faces: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The edges as in `edges`, and (m, 3): the edge from corner k to corner k + 1 of every face."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    _, first, edge = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_inverse=True)
    number = np.empty(len(first), int)
    number[np.argsort(first)] = np.arange(len(first))
    return sides[np.sort(first)], number[edge.ravel()].reshape(-1, 3)


class MeshMarchingTrianglesSolver:
    """Contours of functions that are linear on every triangle.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> V, F = ahm.shapes.plane(2, 2)
    >>> pp3d.MeshMarchingTrianglesSolver(V, F).marching_triangles(V[:, 0], 0.25)
    [[(0, [0.25]), (2, [0.75]), (3, [0.75])]]

    Raises ValueError (wrong shape; a row out of range; a value that is not finite).
    """

    def __init__(self, V: Matrix, F: Faces) -> None:
        points, faces = checked_mesh(V, F)
        self._count = len(points)
        self._edges, self._sides = edges_and_sides(faces)

    def marching_triangles(self, u: Vector, isoval: float = 0.0) -> List[List[EdgePoint]]:
        """The curves u = isoval: lists of (edge, [t]), edges numbered as in `edges`. A closed curve repeats its first point."""
        values = arguments.floats(u, "u", (self._count,), finite=True) - arguments.real(isoval, "isoval")
        a, b = values[self._edges].T
        crossed = (a >= 0) != (b >= 0)
        pairs = self._sides[crossed[self._sides]].reshape(-1, 2)  # every triangle has two crossed sides or none
        t = np.divide(a, a - b, out=np.zeros(len(a)), where=crossed)
        return [[(edge, [float(t[edge])]) for edge in chain] for chain in _chains(pairs.tolist())]


def _chains(pairs: Sequence[Sequence[int]]) -> List[List[int]]:
    """Joins pairs into open chains, which begin where a number occurs once, and closed ones, which repeat their first number."""
    at: Dict[int, List[int]] = {}
    for k, pair in enumerate(pairs):
        for end in pair:
            at.setdefault(end, []).append(k)
    used = [False] * len(pairs)
    chains = []
    for start in sorted(at, key=lambda end: len(at[end]) != 1):
        chain = [start]
        while True:
            after = next((k for k in at[chain[-1]] if not used[k]), None)
            if after is None:
                break
            used[after] = True
            chain.append(sum(pairs[after]) - chain[-1])
        if len(chain) > 1:
            chains.append(chain)
    return chains


def marching_triangles(V: Matrix, F: Faces, u: Vector, isoval: float = 0.0) -> List[List[EdgePoint]]:
    """The curves u = isoval on a mesh, as `MeshMarchingTrianglesSolver.marching_triangles`.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> V, F = ahm.shapes.sphere(2)
    >>> [curve] = pp3d.marching_triangles(V, F, V[:, 2], 0.1)
    >>> curve[0] == curve[-1]
    True

    Raises as `MeshMarchingTrianglesSolver`.
    """
    return MeshMarchingTrianglesSolver(V, F).marching_triangles(u, isoval)


def validate_mesh(V: Matrix, F: Faces, force_triangular: bool = False, test_indices: bool = False) -> None:
    """Checks the shapes of `V` and `F` and the rows in `F`. Other faces than triangles are allowed without `force_triangular`.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> pp3d.validate_mesh(*ahm.shapes.plane(4, 3))

    Raises ValueError (wrong shape; a row out of range), in contrast to potpourri3d also without `test_indices`.
    """
    points = arguments.floats(V, "V", (None, 3))
    for f, face in enumerate(F if isinstance(F, (list, tuple)) else arguments.array(F, "F")):
        corners = arguments.integers(face, f"F[{f}]", 1, 0, len(points) - 1)
        if len(corners) < 3 or (force_triangular and len(corners) > 3):
            raise ValueError(f"F[{f}]: expected {'three' if force_triangular else 'at least three'} corners, got {len(corners)}")


def validate_points(V: Matrix) -> None:
    """Checks that `V` has the shape (n, 3).

    >>> import ahm.potpourri3d as pp3d
    >>> pp3d.validate_points([[0, 0, 0], [1, 2, 3]])

    Raises ValueError.
    """
    arguments.floats(V, "V", (None, 3))
