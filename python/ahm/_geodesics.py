"""Shortest paths and straight lines over the flat triangles of meshes."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._maps import as_body
from ._progress import Progress, reporting


class Path(NamedTuple):
    """A curve on a mesh: straight inside a triangle between neighbouring points."""

    points: np.ndarray  #: (k, 3) in space, world units
    face: np.ndarray  #: (k,) int32 triangle of every point; of refined polygons and cut meshes, of those triangles
    barycentric: np.ndarray  #: (k, 3) weights of the triangle's corners, in the order in which the library stores them
    length: float  #: world units
    complete: bool  #: False of a trace that ended at the boundary


def geodesic_path(surface: Any, stops: Any, to: Any = None, *, closed: bool = False,
                  progress: Progress = None) -> Optional[Path]:
    """The shortest path between two points, or through stops in their order, exact up to rounding.

    surface : a mesh, or what `ahm.surface` takes.
    stops : where the path starts, with `to`; or two or more points. Points are rows, positions, `(face, barycentric)`.
    to : where the path ends.
    closed : and back to the first stop.

    >>> import ahm
    >>> path = ahm.geodesic_path(ahm.shapes.plane(4, 3), 0, 11)
    >>> round(path.length ** 2, 9), path.points[-1].tolist()
    (13.0, [3.0, 2.0, 0.0])

    None where the surface does not connect them. Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    if to is not None:
        first, last = arguments.point(stops, "stops", on), arguments.point(to, "to", on)
        at = ("stops", False, *(np.concatenate([a, b]) for a, b in zip(first[2:5], last[2:5])),
              _stacked(first[5], last[5]))
    else:
        at = arguments.points(stops, "stops", on)
    with reporting(progress) as report:
        found = _core.path(on._body, at, arguments.flag(closed, "closed"), report)
    return None if found is None else Path(*found)


def _stacked(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    width = max(a.shape[1], b.shape[1])
    return np.concatenate([np.pad(x, ((0, 0), (0, width - x.shape[1]))) for x in (a, b)])


def geodesic_paths(surface: Any, sources: Any, targets: Any, *, progress: Progress = None) -> List[Optional[Path]]:
    """The shortest path to every target from the nearest of the sources, of one propagation.

    >>> import ahm
    >>> paths = ahm.geodesic_paths(ahm.shapes.plane(4, 3), 0, [3, 8])
    >>> [round(path.length, 9) for path in paths]
    [3.0, 2.0]

    None where there is no way. Raises as `geodesic_path`.
    """
    on = as_body(surface)
    start, end = arguments.points(sources, "sources", on), arguments.points(targets, "targets", on)
    with reporting(progress) as report:
        return [None if one is None else Path(*one) for one in _core.paths(on._body, start, end, report)]


def trace(surface: Any, start: Any, direction: Any, length: Optional[float] = None, *,
          progress: Progress = None) -> Path:
    """The straightest geodesic from a point: the exponential map [PS98].

    start : a row, a position, or `(face, barycentric)`.
    direction : (3,) vector of space, projected to the surface.
    length : world units; None: that of `direction`.

    >>> import ahm
    >>> end = ahm.trace(ahm.shapes.plane(4, 3), 0, [1, 0.5, 0], 2).points[-1]
    >>> [round(float(x), 6) for x in end]
    [1.788854, 0.894427, 0.0]

    It ends at the boundary (`complete` is False). Raises as `geodesic_path`.
    """
    on = as_body(surface)
    along = arguments.vector(direction, "direction")
    if along is None:
        raise TypeError("direction: three numbers are needed, not None")
    far = float(np.linalg.norm(along)) if length is None else arguments.real(length, "length")
    with reporting(progress) as report:
        return Path(*_core.trace(on._body, arguments.point(start, "start", on), along, far, report))
