"""Pickles that begin with the version of the package. Another version refuses them before it reads the rest."""

from __future__ import annotations

import pickle
import sys
from typing import Any, Callable


class _Version:
    def __reduce__(self) -> tuple:
        return check_version, (_version(),)


_VERSION = _Version()


def _version() -> str:
    return sys.modules[__package__].__version__  # type: ignore[index]


def check_version(written: str) -> _Version:
    if written != _version():
        raise pickle.UnpicklingError(f"the pickle was written by ahm {written}, this is ahm {_version()}; compute the object again")
    return _VERSION


def rebuild(version: _Version, make: Callable, *state: Any) -> Any:
    return make(*state)


def reduced(make: Callable, *state: Any) -> tuple:
    """The result of `__reduce__` of an object that `make(*state)` makes again."""
    return rebuild, (_VERSION, make, *state)


def reduced_tuple(value: tuple) -> tuple:
    """`__reduce__` of a named tuple."""
    return reduced(type(value), *value)
