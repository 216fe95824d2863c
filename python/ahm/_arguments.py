"""Arguments as people give them, turned into what the C++ side takes: checked, and copied only where they must be."""

from __future__ import annotations

import operator
from typing import Any, Optional, Tuple

import numpy as np

INT32 = np.iinfo(np.int32)


def array(value: Any, name: str) -> np.ndarray:
    """Any array of real numbers: NumPy's, a list, what has `__array__` or DLPack."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{name}: has masked entries; fill them or leave their rows out")
    if not hasattr(value, "__array__") and hasattr(value, "__dlpack__"):
        value = np.from_dlpack(value)
    try:
        result = np.asarray(value)
    except (ValueError, TypeError, OverflowError) as error:
        raise ValueError(f"{name}: not an array of numbers ({error})") from None
    if result.dtype.kind not in "iuf" and not (result.size == 0 and result.dtype.kind == "f"):
        raise TypeError(f"{name}: real numbers are needed, not {describe(value, result)}")
    return result


def describe(value: Any, made: Optional[np.ndarray] = None) -> str:
    if made is not None and made.ndim > 0:
        return f"an array of type {made.dtype} and shape {made.shape}"
    return f"{type(value).__name__} {value!r:.60}"


def floats(value: Any, name: str, shape: Tuple[Optional[int], ...], finite: bool = False) -> np.ndarray:
    """C order, float64, of this shape (None: any length); the array itself where it is so already."""
    given = array(value, name)
    if given.ndim != len(shape) or any(s is not None and s != t for s, t in zip(shape, given.shape)):
        wanted = ", ".join("n" if s is None else str(s) for s in shape) + ("," if len(shape) == 1 else "")
        raise ValueError(f"{name}: shape ({wanted}) is needed, not {given.shape}")
    result = np.ascontiguousarray(given, dtype=np.float64)
    if finite and not np.isfinite(result).all():
        at = tuple(int(i) for i in np.argwhere(~np.isfinite(result))[0])
        raise ValueError(f"{name}{list(at)}: {result[at]} is not finite")
    return result


def integers(value: Any, name: str, ndim: int, low: int = INT32.min, high: int = INT32.max, type=np.int32) -> np.ndarray:
    """C order, int32 or int64; whole numbers of any type, in [low, high]."""
    given = array(value, name)
    if given.ndim != ndim:
        raise ValueError(f"{name}: {ndim} dimension{'s' if ndim > 1 else ''} needed, not shape {given.shape}")
    if given.size and given.dtype.kind == "f":
        bad = ~(np.floor(given) == given)
        if bad.any():
            at = tuple(int(i) for i in np.argwhere(bad)[0])
            raise ValueError(f"{name}{list(at)}: {given[at]} is not a whole number")
    if given.size:
        bad = (given < low) | (given > high)
        if bad.any():
            at = tuple(int(i) for i in np.argwhere(bad)[0])
            raise ValueError(f"{name}{list(at)}: {given[at]} is out of range; {low} to {high} can be")
    return np.ascontiguousarray(given, dtype=type)


def rows(value: Any, name: str, count: int) -> np.ndarray:
    """Row numbers of a surface of `count` rows."""
    if np.ndim(value) == 0 and not isinstance(value, (str, bytes)):
        value = [value]
    given = array(value, name) if len(value) else np.empty(0, np.int32)
    if given.dtype.kind == "f":
        raise TypeError(f"{name}: rows are whole numbers, not {describe(value, given)}")
    if given.ndim != 1:
        raise ValueError(f"{name}: one row or a list of rows is needed, not shape {given.shape}")
    bad = (given < 0) | (given >= count)
    if bad.any():
        k = int(np.argmax(bad))
        raise ValueError(f"{name}[{k}]: row {given[k]} is out of range; there are {count} rows, counted from 0")
    return np.ascontiguousarray(given, dtype=np.int32)


def real(value: Any, name: str, positive: bool = False, finite: bool = True) -> float:
    try:
        result = float(value) if not isinstance(value, (str, bytes, bool)) else None
    except (TypeError, ValueError, OverflowError):
        result = None
    if result is None:
        raise TypeError(f"{name}: a number is needed, not {describe(value)}")
    if result != result or (finite and result in (float("inf"), -float("inf"))):
        raise ValueError(f"{name}: {result} is not finite")
    if positive and result <= 0:
        raise ValueError(f"{name}: {result} is not greater than 0")
    return result


def integer(value: Any, name: str, low: int = 0, high: int = INT32.max) -> int:
    try:
        result = operator.index(value) if not isinstance(value, (bool, np.bool_)) else None
    except TypeError:
        result = None
    if result is None:
        raise TypeError(f"{name}: a whole number is needed, not {describe(value)}")
    if not low <= result <= high:
        raise ValueError(f"{name}: {result} is out of range; {low} to {high} can be")
    return result


def flag(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: True or False is needed, not {describe(value)}")
    return bool(value)


def choice(value: Any, name: str, choices: Tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name}: {value!r} is none of " + ", ".join(repr(c) for c in choices))
    return value


def vector(value: Any, name: str) -> Optional[np.ndarray]:
    return None if value is None else floats(value, name, (3,), finite=True)


def is_row(value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return False
    try:
        operator.index(value)
    except TypeError:
        return False
    return True


class Points:
    """Points of one surface, collected: rows, positions and points in faces."""

    def __init__(self, name: str, single: bool, surface: Any) -> None:
        self.name, self.single, self.surface = name, single, surface
        self.kinds: list = []
        self.index: list = []
        self.values: list = []

    def where(self, k: int) -> str:
        return self.name if self.single else f"{self.name}[{k}]"

    def add_row(self, row: int) -> None:
        count = len(self.surface)
        if not 0 <= row < count:
            raise ValueError(f"{self.where(len(self.kinds))}: row {row} is out of range; there are {count} rows, "
                             "counted from 0")
        self._add(0, row, ())

    def add_position(self, position: Any) -> None:
        where = self.where(len(self.kinds))
        given = array(position, where)
        wanted = self.surface._position_width
        if given.shape != (wanted,):
            raise ValueError(f"{where}: a position has {wanted} numbers, not shape {given.shape}")
        given = np.concatenate([np.asarray(given, float), np.zeros(3 - wanted)])
        if not np.isfinite(given).all():
            raise ValueError(f"{where}: the position {given.tolist()} is not finite")
        self._add(1, -1, given)

    def add_face(self, face: Any, barycentric: Any) -> None:
        where = self.where(len(self.kinds))
        face = integer(face, where + ", face", 0, INT32.max)
        count = self.surface._face_count
        if face >= count:
            raise ValueError(f"{where}: face {face} is out of range; there are {count} faces, counted from 0")
        given = array(barycentric, where + ", barycentric coordinates")
        corners = self.surface._corner_count(face)
        if given.shape != (corners,):
            raise ValueError(f"{where}: face {face} has {corners} corners; its barycentric coordinates are so many, "
                             f"not shape {given.shape}")
        weights = np.asarray(given, float)
        if not np.isfinite(weights).all():
            raise ValueError(f"{where}: the barycentric coordinates {weights.tolist()} are not finite")
        # Single precision is not precise enough for the sum to be 1 in double precision.
        if given.dtype.itemsize < 8 and abs(weights.sum() - 1) < 1e-5:
            weights = weights / weights.sum()
        self._add(2, face, weights)

    def _add(self, kind: int, index: int, values: Any) -> None:
        self.kinds.append(kind)
        self.index.append(index)
        self.values.append(values)

    def packed(self) -> tuple:
        count = np.array([len(v) for v in self.values], np.int32)
        values = np.zeros((len(count), max(3, int(count.max(initial=0)))))
        for k, v in enumerate(self.values):
            values[k, : len(v)] = v
        return (self.name, self.single, np.array(self.kinds, np.uint8), np.array(self.index, np.int32), count, values)


def point(value: Any, name: str, surface: Any) -> tuple:
    """One point: a row, a position, or `(face, barycentric)`."""
    result = Points(name, True, surface)
    _add_one(result, value)
    return result.packed()


def points(value: Any, name: str, surface: Any) -> tuple:
    """Points: one, or an array of rows (k,) or positions (k, 3), arrays `(faces, barycentric)`, or a list of any."""
    if is_row(value) or _is_face_point(value):
        return point(value, name, surface)
    result = Points(name, False, surface)
    if isinstance(value, tuple) and len(value) == 2 and np.ndim(value[0]) == 1 and np.ndim(value[1]) == 2:
        faces, weights = array(value[0], name + ", faces"), array(value[1], name + ", barycentric coordinates")
        if len(faces) != len(weights):
            raise ValueError(f"{name}: {len(faces)} faces, but {len(weights)} rows of barycentric coordinates")
        for f, w in zip(faces, weights):
            result.add_face(f, w)
        return result.packed()
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        raise TypeError(f"{name}: rows, positions or (face, barycentric) are needed, not {describe(value)}")
    if len(value) == 0:
        raise ValueError(f"{name}: is empty; at least one point is needed")
    try:
        mixed = isinstance(value, (list, tuple)) and any(isinstance(one, (bool, np.bool_)) for one in value)
        whole = None if mixed else array(value, name)
    except (TypeError, ValueError):
        whole = None
    if whole is not None and whole.ndim == 1 and whole.dtype.kind in "iu":
        numbers = rows(whole, name, len(surface))
        k = len(numbers)
        return (name, False, np.zeros(k, np.uint8), numbers, np.zeros(k, np.int32), np.zeros((k, 3)))
    if whole is not None and whole.ndim == 2:
        for position in whole:
            result.add_position(position)
        return result.packed()
    if whole is not None and whole.ndim == 1:
        raise TypeError(f"{name}: rows are whole numbers, and a list of positions has the shape (k, 3), "
                        f"not {describe(value, whole)}")
    for one in value:
        _add_one(result, one)
    return result.packed()


def _is_face_point(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and is_row(value[0]) and not is_row(value[1])


def _add_one(result: Points, value: Any) -> None:
    if is_row(value):
        result.add_row(operator.index(value))
    elif _is_face_point(value):
        result.add_face(value[0], value[1])
    elif isinstance(value, (str, bytes)) or np.ndim(value) == 0:
        raise TypeError(f"{result.where(len(result.kinds))}: a row, a position or (face, barycentric) is needed, "
                        f"not {describe(value)}")
    else:
        result.add_position(value)
