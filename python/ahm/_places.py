"""Checks sources and targets, and packs them into arrays: rows, positions, points in faces and on edges."""

from __future__ import annotations

import operator
from typing import Any, List, Tuple

import numpy as np

from . import _arguments as arguments

ROW, POSITION, IN_FACE, ON_EDGE = range(4)  # the same numbers as in src/body.cpp


class Places:
    """Collects and checks points of one surface, in the order of the input."""

    def __init__(self, name: str, single: bool, surface: Any) -> None:
        self.name, self.single, self.surface = name, single, surface
        self.kinds: List[int] = []
        self.index: List[int] = []
        self.values: List[Any] = []

    def where(self, k: int) -> str:
        return self.name if self.single else f"{self.name}[{k}]"

    def here(self) -> str:
        return self.where(len(self.kinds))

    def add(self, value: Any) -> None:
        value = _unwrapped(value)
        if is_row(value):
            self._add(ROW, self._row(value), ())
        elif _is_face_point(value):
            self._add(IN_FACE, *self._in_face(*value))
        elif _is_edge_point(value, self.surface):
            self._add(ON_EDGE, *self._on_edge(*value))
        elif (isinstance(value, (str, bytes, dict, set)) or not hasattr(value, "__len__") or getattr(value, "ndim", 1) == 0
              or (isinstance(value, tuple) and any(hasattr(part, "__len__") for part in value))):
            raise TypeError(f"{self.here()}: expected a row, a position, (face, barycentric) or ((row, row), t), "
                            f"got {arguments.describe(value)}")
        else:
            given = arguments.array(value, self.here())
            width = self.surface._position_width
            if self.single and given.dtype.kind in "iu":
                several = "; use log_maps for several rows" if self.name == "source" else ""
                raise ValueError(f"{self.name}: expected one row, or a position of {width} floats; got integers of shape "
                                 f"{given.shape}{several}")
            if given.ndim != 1:
                raise ValueError(f"{self.here()}: expected a position of {width} numbers, got shape {given.shape}")
            self._add(POSITION, -1, positions(given[None], self.where, len(self.kinds), self.surface)[0])

    def packed(self) -> tuple:
        count = np.array([len(v) for v in self.values], np.int32)
        values = np.zeros((len(count), max(3, int(count.max(initial=0)))))
        for k, v in enumerate(self.values):
            values[k, : len(v)] = v
        return (self.name, self.single, np.array(self.kinds, np.uint8), np.array(self.index, np.int32), count, values)

    def _add(self, kind: int, index: int, values: Any) -> None:
        self.kinds.append(kind)
        self.index.append(index)
        self.values.append(values)

    def _row(self, row: Any) -> int:
        row, count = operator.index(row), len(self.surface)
        if not 0 <= row < count:
            raise ValueError(f"{self.here()}: row {row} is out of range; there are {count} rows, counted from 0")
        return row

    def _in_face(self, face: Any, barycentric: Any) -> Tuple[int, np.ndarray]:
        face, count = operator.index(face), self.surface._face_count
        if not 0 <= face < count:
            raise ValueError(f"{self.here()}: face {face} is out of range; there are {count} faces, counted from 0")
        given = arguments.array(barycentric, self.here() + ", barycentric coordinates")
        corners = self.surface._corner_count(face)
        if given.shape != (corners,):
            raise ValueError(f"{self.here()}: face {face} has {corners} corners; expected as many barycentric coordinates, "
                             f"got shape {given.shape}")
        weights = np.asarray(given, float)
        if not np.isfinite(weights).all():
            raise ValueError(f"{self.here()}: the barycentric coordinates {weights.tolist()} are not finite")
        # The sum of single-precision weights is not 1 in double precision.
        if given.dtype.itemsize < 8 and abs(weights.sum() - 1) < 1e-5:
            weights = weights / weights.sum()
        return face, weights

    def _on_edge(self, edge: Any, t: Any) -> Tuple[int, Tuple[int, float]]:
        first, second = (self._row(row) for row in edge)
        return first, (second, arguments.real(t, self.here() + ", t"))


def point(value: Any, name: str, surface: Any) -> tuple:
    """Packs one point: a row, a position of floats, `(face, barycentric)`, or `((row, row), t)` on an edge.

    A list or array of integers is refused, because it looks like several rows."""
    result = Places(name, True, surface)
    result.add(value)
    return result.packed()


def points(value: Any, name: str, surface: Any, empty: bool = False) -> tuple:
    """Packs points: one point, rows (k,), positions (k, 3), `(faces, barycentric)`, `(edges, t)`, or a list of any of these.

    Three integers are rows, three other numbers are a position.

    empty : whether there may be no points.
    """
    value = _unwrapped(value)
    if is_row(value) or _is_face_point(value) or _is_edge_point(value, surface):
        return point(value, name, surface)
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        raise TypeError(f"{name}: expected rows, positions, (face, barycentric) or ((row, row), t), "
                        f"got {arguments.describe(value)}")
    if len(value) == 0 and empty:
        return of_rows(np.empty(0, np.int32), name)
    if len(value) == 0:
        raise ValueError(f"{name}: is empty; at least one point is needed")
    result = Places(name, False, surface)
    columns = _columns(value)
    in_triangles = columns is not None and _in_triangles(value, name, surface)
    if in_triangles:
        return in_triangles
    if columns is None:
        whole = _whole(value, name)
        if whole is not None and whole.ndim == 1 and whole.dtype.kind in "iu":
            return of_rows(arguments.rows(whole, name, len(surface)), name)
        if whole is not None and whole.ndim == 2:
            return _of_positions(positions(whole, result.where, 0, surface), name)
        if whole is not None and whole.shape == (surface._position_width,) and whole.dtype.kind == "f":
            return point(whole, name, surface)
        if whole is not None and whole.ndim == 1:
            raise TypeError(f"{name}: expected rows (integers) or positions of shape (k, 3), "
                            f"got {arguments.describe(value, whole)}")
        columns = value
    elif len(value[0]) != len(value[1]):
        what = ("faces", "rows of barycentric coordinates") if np.ndim(value[0]) == 1 else ("edges", "values of t")
        raise ValueError(f"{name}: the numbers of {what[0]} and {what[1]} differ: {len(value[0])} and {len(value[1])}")
    for one in columns:
        result.add(one)
    return result.packed()


def of_rows(rows: np.ndarray, name: str) -> tuple:
    k = len(rows)
    return (name, False, np.full(k, ROW, np.uint8), rows, np.zeros(k, np.int32), np.zeros((k, 3)))


def joined(first: tuple, second: tuple) -> tuple:
    """Joins two packed lists. The result has the name of the first."""
    width = max(first[5].shape[1], second[5].shape[1])
    values = [np.pad(x, ((0, 0), (0, width - x.shape[1]))) for x in (first[5], second[5])]
    return (first[0], False, *(np.concatenate([a, b]) for a, b in zip(first[2:5], second[2:5])), np.concatenate(values))


def positions(given: np.ndarray, where: Any, first: int, surface: Any) -> np.ndarray:
    """Checks that positions are finite. Returns (k, 3): the third coordinate on a grid in the plane is 0."""
    wanted = surface._position_width
    if given.shape[1] != wanted:
        raise ValueError(f"{where(first)}: expected a position of {wanted} numbers, got shape {given.shape[1:]}")
    result = np.zeros((len(given), 3))
    result[:, :wanted] = given
    bad = ~np.isfinite(result).all(axis=1)
    if bad.any():
        k = int(np.argmax(bad))
        raise ValueError(f"{where(first + k)}: the position {given[k].tolist()} is not finite")
    return result


def _of_positions(values: np.ndarray, name: str) -> tuple:
    k = len(values)
    return (name, False, np.full(k, POSITION, np.uint8), np.full(k, -1, np.int32), np.full(k, 3, np.int32), values)


def _in_triangles(value: tuple, name: str, surface: Any) -> Any:
    """Packs (faces (k,), barycentric (k, 3)) on triangles all at once. None on any fault; points are then checked one by one."""
    try:
        faces, weights = np.asarray(value[0]), np.asarray(value[1])
    except ValueError:
        return None
    k, sound = len(faces), surface._all_triangles and faces.ndim == 1 and faces.dtype.kind in "iu" and weights.dtype.kind == "f"
    if not sound or weights.shape != (k, 3) or not ((faces >= 0) & (faces < surface._face_count)).all():
        return None
    single = weights.dtype.itemsize < 8
    weights = weights.astype(np.float64)
    total = weights.sum(axis=1, keepdims=True)
    if not np.isfinite(weights).all() or (single and (abs(total - 1) >= 1e-5).any()):
        return None
    if single:
        weights /= total
    return (name, False, np.full(k, IN_FACE, np.uint8), faces.astype(np.int32), np.full(k, 3, np.int32), weights)


def _whole(value: Any, name: str) -> Any:
    """The value as one array of numbers; None if it is not an array of numbers."""
    if isinstance(value, (list, tuple)) and any(isinstance(one, (bool, np.bool_)) for one in value):
        return None
    try:
        return arguments.array(value, name)
    except (TypeError, ValueError):
        return None


def _columns(value: Any) -> Any:
    """The points of `(faces, barycentric)` or `(edges, t)`; None for anything else."""
    if not (isinstance(value, tuple) and len(value) == 2 and all(hasattr(one, "__len__") for one in value)):
        return None
    try:
        first = np.ndim(value[0])
    except ValueError:  # lists of different lengths
        return None
    of_faces = first == 1 and len(value[0]) > 0 and is_row(value[0][0]) and len(value[1]) > 0 and np.ndim(value[1][0]) == 1
    of_edges = first == 2 and np.shape(value[0])[1] == 2 and np.ndim(value[1]) == 1
    return list(zip(*value)) if of_faces or of_edges else None


def _unwrapped(value: Any) -> Any:
    return tuple(arguments.unwrapped(part) for part in value) if type(value) is tuple else value


def is_row(value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return False
    try:
        operator.index(value)
    except TypeError:
        return False
    return True


def _is_face_point(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and is_row(value[0]) and not is_row(value[1]) and np.ndim(value[1]) > 0


def _is_edge_point(value: Any, surface: Any) -> bool:
    if not (isinstance(value, tuple) and len(value) == 2 and not isinstance(value[1], (str, bytes))):
        return False
    edge, t = value
    if surface._position_width == 2:  # a grid has no edge points; this is a list of a position and a row
        return False
    return (hasattr(edge, "__len__") and not isinstance(edge, (str, bytes, dict, set)) and len(edge) == 2
            and all(is_row(row) for row in edge) and np.ndim(t) == 0)
