"""Arguments as people give them, turned into what the C++ side takes: checked, and copied only where they must be."""

from __future__ import annotations

import operator
from typing import Any, Optional, Tuple

import numpy as np

INT32 = np.iinfo(np.int32)


def array(value: Any, name: str) -> np.ndarray:
    """Any array of real numbers: NumPy's, a list, what has `__array__`, DLPack or `numpy()`."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{name}: has masked entries; fill them or leave their rows out")
    if not hasattr(value, "__array__") and hasattr(value, "__dlpack__"):
        value = np.from_dlpack(value)
    if not isinstance(value, np.ndarray) and not hasattr(value, "__array__") and callable(getattr(value, "numpy", None)):
        value = value.numpy()
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
