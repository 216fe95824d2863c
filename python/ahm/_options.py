"""Checks the options that several functions share."""

from __future__ import annotations

from typing import Any, Callable, Dict

from . import _arguments as arguments


def _whole(low: int, high: int = arguments.INT32.max) -> Callable[[Any, str], int]:
    return lambda value, name: arguments.integer(value, name, low, high)


def _one_of(*words: str) -> Callable[[Any, str], str]:
    return lambda value, name: arguments.choice(value, name, words)


def _positive(value: Any, name: str) -> float:
    return arguments.real(value, name, positive=True)


def _radius(value: Any, name: str) -> float:
    return arguments.real(value, name, positive=True, finite=False)


CHECKS: Dict[str, Callable[[Any, str], Any]] = {
    "t_coef": _positive,
    "variant": _one_of("adaptive", "localized"),
    "strategy": _one_of("automatic", "global", "march"),
    "expected_maps": _whole(0),
    "memory": _whole(0, 2**62),
    "accuracy": _positive,
    "ordering": _one_of("auto", "amd", "nested_dissection"),
    "threads": _whole(0, 4096),
    "windows": _whole(0, 2**62),
    "radius": _radius,
    "frames": arguments.flag,
    "spread": arguments.flag,
    "distances": arguments.flag,
    "k": _whole(1),
    "margin": _positive,
    "transport": arguments.flag,
    "quality": arguments.flag,
    "delaunay": arguments.flag,
    "clamp_weights": arguments.flag,
    "non_manifold": _one_of("error", "split"),
    "discretization": _one_of("automatic", "polygons", "refined"),
    "normal_signs": _one_of("automatic", "oriented", "unoriented"),
    "smooth": arguments.real,
    "max_edge_ratio": _positive,
    "drop_non_finite": arguments.flag,
    "max_maps": _whole(1),
    "max_stretch": _positive,
    "min_quality": arguments.real,
    "width": _positive,
    "height": _positive,
    "angle": arguments.real,
    "mirrored": arguments.flag,
    "lift": arguments.real,
    "spacing": _positive,
    "step": _positive,
    "pattern": _one_of("raster", "spiral"),
    "max_distortion": _positive,
    "size": _whole(1),
}


def checked(**given: Any) -> Dict[str, Any]:
    """Checks the options that are not None and returns them. The others keep their defaults in C++."""
    return {name: CHECKS[name](value, name) for name, value in given.items() if value is not None}
