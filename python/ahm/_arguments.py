"""Checks the arguments of public functions and converts them to the arrays that the C++ side requires. Copies only if necessary."""

from __future__ import annotations

import operator
import os
from typing import Any, Optional, Tuple

import numpy as np

INT32 = np.iinfo(np.int32)
PLURALS = {"entry": "entries", "vertex": "vertices"}


def counted(count: int, noun: str) -> str:
    """A count with its noun: "1 face", "2 faces"."""
    return f"{count} {noun if count == 1 else PLURALS.get(noun, noun + 's')}"


def array(value: Any, name: str) -> np.ndarray:
    """Converts to an array of real numbers: from an array, a list, or an object with `__array__`, DLPack or `numpy()`."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{name}: some entries are masked; fill them or remove their rows")
    try:
        result = np.asarray(unwrapped(value))
    except (ValueError, TypeError, OverflowError, RuntimeError, BufferError) as error:  # for example, tensors in GPU memory
        raise ValueError(f"{name}: not an array of numbers ({error})") from None
    if result.dtype.kind == "O" and result.ndim > 0:
        result = _of_objects(result, name)
    if result.dtype.kind not in "iuf" and not (result.size == 0 and result.dtype.kind == "f"):
        raise TypeError(f"{name}: expected real numbers, got {describe(value, result)}")
    return result


def unwrapped(value: Any) -> Any:
    """The numpy array of an object that has DLPack or `numpy()`, but not `__array__`. Other objects are returned unchanged."""
    if hasattr(value, "__array__"):
        return value
    if hasattr(value, "__dlpack__"):
        return np.from_dlpack(value)
    return value.numpy() if callable(getattr(value, "numpy", None)) else value


def _of_objects(given: np.ndarray, name: str) -> np.ndarray:
    """Converts an array of Python objects, as in data frames, to int64 or float64. Raises for the first item that is not a number."""
    for at, item in np.ndenumerate(given):
        if isinstance(item, (bool, np.bool_)) or not isinstance(item, (int, float, np.integer, np.floating)):
            raise TypeError(f"{name}{list(at)}: expected a real number, got {describe(item)}")
        if isinstance(item, int) and not -(2**63) <= item < 2**63:
            raise ValueError(f"{name}{list(at)}: {item} is out of range; it does not fit into 64 bits")
    whole = all(isinstance(item, (int, np.integer)) for item in given.flat)
    return given.astype(np.int64 if whole and given.size else np.float64)


def describe(value: Any, made: Optional[np.ndarray] = None) -> str:
    if made is not None and made.ndim > 0:
        return f"an array of type {made.dtype} and shape {made.shape}"
    return f"{type(value).__name__} {value!r:.60}"


def floats(value: Any, name: str, shape: Tuple[Optional[int], ...], finite: bool = False) -> np.ndarray:
    """Converts to float64 in C order, and checks the shape (None: any length). An array that is like that already is not copied."""
    given = array(value, name)
    if given.ndim != len(shape) or any(s is not None and s != t for s, t in zip(shape, given.shape)):
        wanted = ", ".join("n" if s is None else str(s) for s in shape) + ("," if len(shape) == 1 else "")
        raise ValueError(f"{name}: expected shape ({wanted}), got {given.shape}")
    result = np.ascontiguousarray(given, dtype=np.float64)
    if finite and not np.isfinite(result).all():
        at = tuple(int(i) for i in np.argwhere(~np.isfinite(result))[0])
        raise ValueError(f"{name}{list(at)}: {result[at]} is not finite")
    return result


def integers(value: Any, name: str, ndim: int, low: int = INT32.min, high: int = INT32.max, type=np.int32) -> np.ndarray:
    """Converts integers of any numeric type to int32 or int64 in C order. Checks that they are in [low, high]."""
    given = array(value, name)
    if given.ndim != ndim:
        raise ValueError(f"{name}: expected {ndim} dimension{'s' if ndim > 1 else ''}, got shape {given.shape}")
    if given.size and given.dtype.kind == "f":
        bad = ~(np.floor(given) == given)
        if bad.any():
            at = tuple(int(i) for i in np.argwhere(bad)[0])
            raise ValueError(f"{name}{list(at)}: {given[at]} is not an integer")
    if given.size:
        bad = (given < low) | (given > high)
        if bad.any():
            at = tuple(int(i) for i in np.argwhere(bad)[0])
            raise ValueError(f"{name}{list(at)}: {given[at]} is out of range; it must be in [{low}, {high}]")
    return np.ascontiguousarray(given, dtype=type)


def rows(value: Any, name: str, count: int) -> np.ndarray:
    """Checks one row number, or a list, of a surface with `count` rows."""
    value = unwrapped(value)
    single = np.ndim(value) == 0 and not isinstance(value, (str, bytes))
    if single:
        value = [value]
    given = array(value, name) if len(value) else np.empty(0, np.int32)
    if given.dtype.kind == "f":
        raise TypeError(f"{name}: rows must be integers, got {describe(value, given)}")
    if given.ndim != 1:
        raise ValueError(f"{name}: expected one row or a list of rows, got shape {given.shape}")
    bad = (given < 0) | (given >= count)
    if bad.any():
        k = int(np.argmax(bad))
        where = name if single else f"{name}[{k}]"
        raise ValueError(f"{where}: row {given[k]} is out of range; there are {count} rows, counted from 0")
    return np.ascontiguousarray(given, dtype=np.int32)


def row(value: Any, name: str, count: int) -> int:
    if np.ndim(unwrapped(value)) != 0:
        raise ValueError(f"{name}: expected one row, got shape {np.shape(value)}")
    return int(rows(value, name, count)[0])


def real(value: Any, name: str, positive: bool = False, finite: bool = True) -> float:
    try:
        result = float(value) if not isinstance(value, (str, bytes, bool)) else None
    except (TypeError, ValueError, OverflowError):
        result = None
    if result is None:
        raise TypeError(f"{name}: expected a number, got {describe(value)}")
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
        raise TypeError(f"{name}: expected an integer, got {describe(value)}")
    if not low <= result <= high:
        raise ValueError(f"{name}: {result} is out of range; it must be in [{low}, {high}]")
    return result


def flag(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: expected True or False, got {describe(value)}")
    return bool(value)


def choice(value: Any, name: str, choices: Tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name}: {value!r} is not one of " + ", ".join(repr(c) for c in choices))
    return value


def file_name(value: Any, name: str) -> bytes:
    """The encoded name of a file: from str, bytes or an object with `__fspath__`."""
    try:
        result = os.fsencode(value)
    except TypeError:
        raise TypeError(f"{name}: expected a file name, got {describe(value)}") from None
    if b"\0" in result:
        raise ValueError(f"{name}: {value!r:.60} contains a null character")
    return result


def vector(value: Any, name: str) -> Optional[np.ndarray]:
    """Checks a direction in space: three finite numbers, not all zero. Returns None for None."""
    if value is None:
        return None
    result = floats(value, name, (3,), finite=True)
    if not result.any():
        raise ValueError(f"{name}: the vector is zero and has no direction")
    return result
