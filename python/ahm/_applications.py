"""Curves as sources, cells, spread points, and means."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._fields import distance_and_nearest
from ._maps import LogMap
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import ExactGeodesics, Maker, as_body, as_maker


class Stroke(NamedTuple):
    """A log map from a curve, and the curve as it was drawn on the surface."""

    map: LogMap  #: u: arclength, v: signed distance, positive on the curve's left
    points: np.ndarray  #: (k, 3), world units
    length: float  #: world units
    gap: float  #: largest distance of the lines between the given points from the surface, world units
    jump: float  #: largest distance between neighbouring points of the drawn curve, world units


def stroke(solver: Any, points: Any, *, closed: bool = False, shape: str = "line", positions: Any = None,
           method: Optional[str] = None, radius: Optional[float] = None, frames: bool = True,
           progress: Progress = None) -> Stroke:
    """Coordinates along a curve: every row gets those of the nearest point of the curve, moved on by the way from there.

    solver : a `LogMapSolver` or `ExactGeodesics`, or a surface (a mesh or cloud).
    points : two or more, joined by shortest paths over flat faces, elsewhere by straight lines that should stay near the
        surface: rows, positions, (face, barycentric), ((row, row), t).
    closed : joins the last to the first.
    shape : "line": u is the arclength; "circle": a closed curve becomes a circle about the origin.
    positions : (k, 2) coordinates that the given points get instead of (arclength, 0), world units; straight in between.
    method : of a surface: "heat" (default), or "exact" over the flat triangles of a mesh.
    radius, frames, progress : as of `LogMapSolver.log_map`.

    >>> import ahm
    >>> s = ahm.stroke(ahm.shapes.plane(9, 5), [[1, 2, 0], [7, 2, 0]])
    >>> s.map.uv[9 * 3 + 4].round(6).tolist(), round(s.length, 9)
    ([3.0, 1.0], 6.0)

    Raises ValueError naming argument, index and value.
    """
    made = as_maker(solver, method)
    at = places.points(points, "points", made.surface)
    arguments.choice(shape, "shape", ("line", "circle"))
    uv = np.empty((0, 2))
    if positions is not None:
        uv = arguments.floats(positions, "positions", (len(at[2]), 2), finite=True)
        if shape != "line":
            raise ValueError("positions: have a shape of their own; leave `shape` out")
    with reporting(progress) as report:
        found, drawn, length, gap, jump = _core.stroke(made._core, at, uv, arguments.flag(closed, "closed"), shape == "circle",
                                                       checked(radius=radius, frames=frames), report)
    recipe = (_StrokeMap(made), "map", (points,),
              dict(closed=closed, shape=shape, positions=positions, radius=radius, frames=frames))
    return Stroke(LogMap(found, made.surface, recipe), drawn, length, gap, jump)


class _StrokeMap:
    """Makes the map of a stroke again, for pickles."""

    def __init__(self, solver: Maker) -> None:
        self.solver = solver

    def map(self, points: Any, **options: Any) -> LogMap:
        return stroke(self.solver, points, **options).map


class Cells(NamedTuple):
    """Geodesic Voronoi cells, by rows."""

    labels: np.ndarray  #: (n,) int32 number of the nearest source; -1 in components without one
    distance: np.ndarray  #: (n,) from that source, world units; NaN in components without one


def cells(surface: Any, sources: Any, *, method: Optional[str] = None, progress: Progress = None) -> Cells:
    """Which of the sources is nearest to every row, in one pass, whatever their number.

    sources : rows, positions, (face, barycentric), ((row, row), t); rows each once.
    method : "unfold" (default) or "exact", as of `distance`; an `ExactGeodesics` instead of a surface is exact, too.

    >>> import ahm
    >>> ahm.cells(ahm.shapes.plane(5, 2), [0, 4]).labels[[0, 1, 3, 4]].tolist()
    [0, 0, 1, 1]

    Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    if method is None:
        method = "exact" if isinstance(surface, ExactGeodesics) else "unfold"
    arguments.choice(method, "method", ("unfold", "exact"))
    _, _, kinds, rows, _, _ = places.points(sources, "sources", on)
    on_rows = np.flatnonzero(kinds == places.ROW)
    _, first = np.unique(rows[on_rows], return_index=True)
    for again in np.setdiff1d(on_rows, on_rows[first]):
        raise ValueError(f"sources[{again}]: row {rows[again]} is given twice")
    distance, labels = distance_and_nearest(on, sources, method=method, progress=progress)
    return Cells(labels, distance)


def farthest_points(surface: Any, count: int, first: Any = 0, *, progress: Progress = None) -> np.ndarray:
    """`count` rows spread evenly, each the farthest from those before it, beginning with `first`.

    first : a row; of any other point the nearest one.

    >>> import ahm
    >>> ahm.farthest_points(ahm.shapes.plane(5, 2), 2).tolist()
    [0, 9]

    Returns (count,) int32. Raises ValueError.
    """
    on = as_body(surface)
    at = places.point(first, "first", on)
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


def karcher_mean(solver: Any, points: Any, weights: Any = None, *, start: Any = None, method: Optional[str] = None,
                 max_maps: int = 50, radius: Optional[float] = None, progress: Progress = None) -> Center:
    """The Riemannian center of mass: where the weighted sum of squared distances is least, near the start [Kar77].

    solver : a `LogMapSolver` or `ExactGeodesics`, or a surface.
    points : k rows; of any other point the nearest one. weights : (k,) >= 0, or None: all equal.
    start : a row, or any other point; None: the point of the largest weight.
    method : of a surface: "heat" (default), or "exact" over the flat triangles of a mesh.
    max_maps : each step is one log map. radius : of the maps.

    >>> import ahm
    >>> mean = ahm.karcher_mean(ahm.shapes.plane(9, 9), [0, 8, 72, 80])
    >>> mean.row, mean.converged
    (40, True)

    Raises ValueError naming argument, index and value.
    """
    return _center(as_maker(solver, method), points, weights, False, start, max_maps, radius, progress)


def geometric_median(solver: Any, points: Any, weights: Any = None, *, start: Any = None, method: Optional[str] = None,
                     max_maps: int = 50, radius: Optional[float] = None, progress: Progress = None) -> Center:
    """Where the weighted sum of distances is least, near the start [FVJ09]. Otherwise as `karcher_mean`.

    >>> import ahm
    >>> ahm.geometric_median(ahm.shapes.plane(9, 9), [0, 8, 72], [3.0, 1.0, 1.0]).row
    0
    """
    return _center(as_maker(solver, method), points, weights, True, start, max_maps, radius, progress)


def _center(made: Maker, points: Any, weights: Any, median: bool, start: Any, max_maps: int, radius: Optional[float],
            progress: Progress) -> Center:
    at = places.points(points, "points", made.surface)
    given = np.empty(0) if weights is None else arguments.floats(weights, "weights", (len(at[2]),), finite=True)
    begin = None if start is None else places.point(start, "start", made.surface)
    with reporting(progress) as report:
        return Center(*_core.center(made._core, at, given, median, begin, checked(max_maps=max_maps, radius=radius), report))
