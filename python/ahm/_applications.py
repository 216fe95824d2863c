"""Curves as sources, cells, spread points, and means."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._maps import LogMap, LogMapSolver, as_body, as_solver
from ._options import checked
from ._progress import Progress, reporting


class Stroke(NamedTuple):
    """A log map from a curve, and the curve as it was drawn on the surface."""

    map: LogMap  #: u: arclength, v: signed distance, positive on the curve's left
    points: np.ndarray  #: (k, 3), world units
    length: float  #: world units


def stroke(solver: Any, points: Any, *, closed: bool = False, shape: str = "line", radius: Optional[float] = None,
           frames: bool = True, progress: Progress = None) -> Stroke:
    """Coordinates along a curve: every row gets those of the nearest point of the curve, moved on by the way from there.

    solver : a `LogMapSolver`, or a surface (a mesh or cloud).
    points : two or more, joined by straight lines that should stay near the surface: rows, positions, (face, barycentric).
    closed : joins the last to the first.
    shape : "line": u is the arclength; "circle": a closed curve becomes a circle about the origin.
    radius, frames, progress : as of `LogMapSolver.log_map`.

    >>> import ahm
    >>> s = ahm.stroke(ahm.shapes.plane(9, 5), [[1, 2, 0], [7, 2, 0]])
    >>> s.map.uv[9 * 3 + 4].round(6).tolist(), round(s.length, 9)
    ([3.0, 1.0], 6.0)

    Raises ValueError naming argument, index and value.
    """
    made = as_solver(solver)
    arguments.choice(shape, "shape", ("line", "circle"))
    at = arguments.points(points, "points", made.surface)
    arguments.flag(closed, "closed")
    with reporting(progress) as report:
        found, drawn, length = _core.stroke(made._core, at, closed, shape == "circle",
                                            checked(radius=radius, frames=frames), report)
    recipe = (_StrokeMap(made), "map", (points,), dict(closed=closed, shape=shape, radius=radius, frames=frames))
    return Stroke(LogMap(found, made.surface, recipe), drawn, length)


class _StrokeMap:
    """Makes the map of a stroke again, for pickles."""

    def __init__(self, solver: LogMapSolver) -> None:
        self.solver = solver

    def map(self, points: Any, **options: Any) -> LogMap:
        return stroke(self.solver, points, **options).map


class Cells(NamedTuple):
    """Geodesic Voronoi cells, by rows."""

    labels: np.ndarray  #: (n,) int32 number of the nearest source; -1 in components without one
    distance: np.ndarray  #: (n,) from that source, world units; NaN in components without one


def cells(surface: Any, sources: Any, *, progress: Progress = None) -> Cells:
    """Which of the sources is nearest to every row, in one pass, whatever their number.

    sources : rows or positions (the nearest row), each once.

    >>> import ahm
    >>> ahm.cells(ahm.shapes.plane(5, 2), [0, 4]).labels[[0, 1, 3, 4]].tolist()
    [0, 0, 1, 1]

    Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    at = arguments.points(sources, "sources", on)
    with reporting(progress) as report:
        return Cells(*_core.cells(on._body, at, report))


def farthest_points(surface: Any, count: int, first: Any = 0, *, progress: Progress = None) -> np.ndarray:
    """`count` rows spread evenly, each the farthest from those before it, beginning with `first` (a row or position).

    >>> import ahm
    >>> ahm.farthest_points(ahm.shapes.plane(5, 2), 2).tolist()
    [0, 9]

    Returns (count,) int32. Raises ValueError.
    """
    on = as_body(surface)
    at = arguments.point(first, "first", on)
    with reporting(progress) as report:
        return _core.farthest(on._body, at, arguments.integer(count, "count", 1), report)


class Center(NamedTuple):
    """A point of the surface, near a row."""

    row: Optional[int]  #: the nearest one; None where that vertex is none of the input
    offset: np.ndarray  #: (d,) log map of the center from there, in its frame, world units
    position: Optional[np.ndarray]  #: (3,) in the tangent plane of the row, world units; None on grids and graphs
    spread: float  #: mean: root mean squared distance; median: mean distance; world units
    maps: int  #: log maps used
    converged: bool


def karcher_mean(solver: Any, points: Any, weights: Any = None, *, start: Any = None, max_maps: int = 50,
                 radius: Optional[float] = None, progress: Progress = None) -> Center:
    """The Riemannian center of mass: where the weighted sum of squared distances is least, near the start [Kar77].

    solver : a `LogMapSolver`, or a surface.
    points : k rows or positions (the nearest row). weights : (k,) >= 0, or None: all equal.
    start : a row or position; None: the point of the largest weight.
    max_maps : each step is one log map. radius : of the maps.

    >>> import ahm
    >>> mean = ahm.karcher_mean(ahm.shapes.plane(9, 9), [0, 8, 72, 80])
    >>> mean.row, mean.converged
    (40, True)

    Raises ValueError naming argument, index and value.
    """
    return _center(solver, points, weights, False, start, max_maps, radius, progress)


def geometric_median(solver: Any, points: Any, weights: Any = None, *, start: Any = None, max_maps: int = 50,
                     radius: Optional[float] = None, progress: Progress = None) -> Center:
    """Where the weighted sum of distances is least, near the start [FVJ09]. Otherwise as `karcher_mean`.

    >>> import ahm
    >>> ahm.geometric_median(ahm.shapes.plane(9, 9), [0, 8, 72], [3.0, 1.0, 1.0]).row
    0
    """
    return _center(solver, points, weights, True, start, max_maps, radius, progress)


def _center(solver: Any, points: Any, weights: Any, median: bool, start: Any, max_maps: int, radius: Optional[float],
            progress: Progress) -> Center:
    made = as_solver(solver)
    at = arguments.points(points, "points", made.surface)
    given = np.empty(0) if weights is None else arguments.floats(weights, "weights", (len(at[2]),), finite=True)
    begin = None if start is None else arguments.point(start, "start", made.surface)
    with reporting(progress) as report:
        return Center(*_core.center(made._core, at, given, median, begin, checked(max_maps=max_maps, radius=radius), report))
