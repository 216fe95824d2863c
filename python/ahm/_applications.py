"""Curves as sources, cells, spread points, and means."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Tuple

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._fields import distance_and_nearest
from ._maps import LogMap
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import ExactGeodesics, Maker, PolarMapSolver, as_body, as_maker, chosen_maker, tolerance_of


class Stroke(NamedTuple):
    """A log map from a curve, and the curve as it was drawn on the surface."""

    map: LogMap  #: u: arclength, v: signed distance, positive on the curve's left
    points: np.ndarray  #: (k, 3), world units
    length: float  #: world units
    gap: float  #: largest distance of the lines between the given points from the surface, world units
    jump: float  #: largest distance between neighbouring points of the drawn curve, world units


def stroke(solver: Any, points: Any, *, closed: bool = False, shape: str = "line", positions: Any = None,
           method: Optional[str] = None, tolerance: Optional[float] = None, radius: Optional[float] = None,
           frames: bool = True, progress: Progress = None) -> Stroke:
    """Coordinates along a curve: every row gets those of the nearest point of the curve, moved on by the way from there.

    solver : a `LogMapSolver` or `ExactGeodesics`, or a surface (a mesh or cloud).
    points : two or more, joined by shortest paths over flat faces and over the tangent planes of clouds, on twisted polygons by
        straight lines that should stay near the surface: rows, positions, (face, barycentric), ((row, row), t).
    closed : joins the last to the first.
    shape : "line": u is the arclength; "circle": a closed curve becomes a circle about the origin.
    positions : (k, 2) coordinates that the given points get instead of (arclength, 0), world units; straight in between.
    method : of a surface: "heat" (default), or "exact" over the flat triangles of a mesh.
    tolerance : of exact maps, as of `ExactGeodesics`.
    radius, frames, progress : as of `LogMapSolver.log_map`.

    >>> import ahm
    >>> s = ahm.stroke(ahm.shapes.plane(9, 5), [[1, 2, 0], [7, 2, 0]])
    >>> s.map.uv[9 * 3 + 4].round(6).tolist(), round(s.length, 9)
    ([3.0, 1.0], 6.0)

    Raises ValueError naming argument, index and value.
    """
    made = as_maker(solver, method, tolerance=tolerance)
    if isinstance(made, PolarMapSolver):
        raise ValueError("method: polar maps start at points; a stroke takes 'heat' or 'exact'")
    at = places.points(points, "points", made.surface)
    arguments.choice(shape, "shape", ("line", "circle"))
    uv = np.empty((0, 2))
    if positions is not None:
        uv = arguments.floats(positions, "positions", (len(at[2]), 2), finite=True)
        if shape != "line":
            raise ValueError("positions: have a shape of their own; leave `shape` out")
    shaped = (arguments.flag(closed, "closed"), shape == "circle", checked(radius=radius, frames=frames))
    with reporting(progress) as report:
        found, drawn, length, gap, jump = _core.stroke(made._maker, at, uv, *shaped, report)
    return Stroke(LogMap(found, _StrokeRecipe(made, at, np.array(uv), shaped)), drawn, length, gap, jump)


class _StrokeRecipe(NamedTuple):
    """How the map of a stroke is made, for its pickle."""

    maker: Maker
    at: tuple
    uv: np.ndarray
    shaped: Tuple[bool, bool, Dict[str, Any]]

    @property
    def surface(self) -> Any:
        return self.maker.surface

    def expect(self, number: int) -> None:
        pass

    def make(self, number: int) -> Any:
        return _core.stroke(self.maker._maker, self.at, self.uv, *self.shaped, None)[0]


class Cells(NamedTuple):
    """Geodesic Voronoi cells, by rows."""

    labels: np.ndarray  #: (n,) int32 number of the nearest source; -1 in components without one
    distance: np.ndarray  #: (n,) from that source, world units; NaN in components without one


def cells(surface: Any, sources: Any, *, method: Optional[str] = None, tolerance: Optional[float] = None,
          progress: Progress = None) -> Cells:
    """Which of the sources is nearest to every row, in one pass, whatever their number.

    sources : rows, positions, (face, barycentric), ((row, row), t); rows each once.
    method : "unfold" (default) or "exact", as of `distance`; an `ExactGeodesics` instead of a surface is exact, too.
    tolerance : of exact distances, as of `ExactGeodesics`.
    progress : as of `LogMapSolver`.

    >>> import ahm
    >>> ahm.cells(ahm.shapes.plane(5, 2), [0, 4]).labels[[0, 1, 3, 4]].tolist()
    [0, 0, 1, 1]

    Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    method = _unfold_or_exact(surface, method)
    _, _, kinds, rows, _, _ = places.points(sources, "sources", on)
    to_rows = np.flatnonzero(kinds == places.ROW)
    _, first = np.unique(rows[to_rows], return_index=True)
    for again in np.setdiff1d(to_rows, to_rows[first]):
        raise ValueError(f"sources[{again}]: row {rows[again]} is given twice")
    distance, labels = distance_and_nearest(surface, sources, method=method, tolerance=tolerance, progress=progress)
    return Cells(labels, distance)


def _unfold_or_exact(surface: Any, method: Optional[str]) -> str:
    if method is None:
        return "exact" if isinstance(surface, ExactGeodesics) else "unfold"
    return arguments.choice(method, "method", ("unfold", "exact"))


def farthest_points(surface: Any, count: int, first: Any = 0, *, method: Optional[str] = None,
                    tolerance: Optional[float] = None, progress: Progress = None) -> np.ndarray:
    """`count` rows spread evenly, each the farthest from those before it, beginning with `first`.

    surface : a `Surface`, or what `ahm.surface` takes.
    count : 1 to the number of rows.
    first : a row; since the result is rows, of any other point the nearest one.
    method, tolerance : as of `cells`.
    progress : as of `LogMapSolver`.

    >>> import ahm
    >>> ahm.farthest_points(ahm.shapes.plane(5, 2), 2).tolist()
    [0, 9]

    Returns (count,) int32. Raises ValueError naming argument and value.
    """
    on = as_body(surface)
    by = _unfold_or_exact(surface, method)
    within = tolerance_of(surface, by, tolerance)
    at = places.point(first, "first", on)
    with reporting(progress) as report:
        return _core.farthest(on._body, at, arguments.integer(count, "count", 1),
                              within if by == "exact" else None, report)


class Center(NamedTuple):
    """A point of the surface, near a row."""

    row: Optional[int]  #: the nearest one; None where that vertex is none of the input
    offset: np.ndarray  #: (d,) log map of the center from there, in its frame, world units
    position: Optional[np.ndarray]  #: (3,) in space, world units: on the faces of a mesh, in the tangent plane of a row of a
    #: cloud; (d,) on a grid; of a graph in the tangent plane of a frame, None without
    spread: float  #: mean: root mean squared distance; median: mean distance; world units
    maps: int  #: log maps that the search took
    converged: bool  #: False where `max_maps` ended it
    residual: float  #: how far from a least value, seen by one more log map from the center itself. Mean: length of the weighted
    #: mean of the points' coordinates, world units; median: of their unit vectors, less the weight of points at the center.
    #: On clouds and graphs a map from beside a vertex is that of the vertex, shifted: there it tells of convergence alone
    point: Any  #: the center as functions take points: (face, barycentric) of a mesh, else the position, or None


def karcher_mean(solver: Any, points: Any, weights: Any = None, *, start: Any = None, method: str = "auto",
                 tolerance: Optional[float] = None, max_maps: int = 50, radius: Optional[float] = None,
                 progress: Progress = None) -> Center:
    """The Riemannian center of mass: where the weighted sum of squared distances is least, near the start [Kar77].

    solver : a `LogMapSolver` or `ExactGeodesics`, or a surface.
    points : k points: rows, positions, `(faces, barycentric)`, `(edges, t)`.
    weights : (k,) >= 0, or None: all equal.
    start : where the search begins, the row nearest to this point; None: near the point of the largest weight.
    method : of a surface: "auto" (default), "polar", "heat" or "exact", as of `log_map`.
    tolerance : of exact maps, as of `ExactGeodesics`.
    max_maps : >= 1; each step is one log map. radius : of the maps, world units; it must reach from the center and the start to
        every point. progress : as of `LogMapSolver`.

    >>> import ahm
    >>> mean = ahm.karcher_mean(ahm.shapes.plane(9, 9), [0, 8, 72, 80])
    >>> mean.row, mean.converged, mean.residual < 1e-9
    (40, True, True)

    Raises ValueError naming argument, index and value; points in different components have no mean.
    """
    return _center(chosen_maker(solver, method, tolerance=tolerance), points, weights, False, start, max_maps, radius, progress)


def geometric_median(solver: Any, points: Any, weights: Any = None, *, start: Any = None, method: str = "auto",
                     tolerance: Optional[float] = None, max_maps: int = 50, radius: Optional[float] = None,
                     progress: Progress = None) -> Center:
    """Where the weighted sum of distances is least, near the start [FVJ09]. Result, arguments and errors as of `karcher_mean`.

    >>> import ahm
    >>> ahm.geometric_median(ahm.shapes.plane(9, 9), [0, 8, 72], [3.0, 1.0, 1.0]).row
    0
    """
    return _center(chosen_maker(solver, method, tolerance=tolerance), points, weights, True, start, max_maps, radius, progress)


def _center(made: Maker, points: Any, weights: Any, median: bool, start: Any, max_maps: int, radius: Optional[float],
            progress: Progress) -> Center:
    on = made.surface
    at = places.points(points, "points", on)
    given = np.empty(0) if weights is None else _weights(weights, len(at[2]))
    begin = None if start is None else places.point(start, "start", on)
    with reporting(progress) as report:
        row, offset, position, spread, maps, converged, face, inside, seen = _core.center(
            made._maker, at, given, median, begin, checked(max_maps=max_maps, radius=radius), report)
    point = (face, inside) if face is not None else position if on._body.has_positions else None
    residual = _residual(seen, given if len(given) else np.ones(len(seen)), median, 1e-9 * on.mean_edge_length)
    return Center(row, offset, position, spread, maps, converged, residual, point)


def _weights(weights: Any, count: int) -> np.ndarray:
    given = arguments.floats(weights, "weights", (count,), finite=True)
    if (given < 0).any():
        k = int(np.argmax(given < 0))
        raise ValueError(f"weights[{k}]: {given[k]} is less than 0")
    if not given.any():
        raise ValueError("weights: all are 0")
    return given


def _residual(seen: np.ndarray, weights: np.ndarray, median: bool, at_center: float) -> float:
    weights, seen = weights[weights > 0] / weights.max(), seen[weights > 0]
    if not median:
        return float(np.linalg.norm(weights @ seen) / weights.sum())
    away = np.linalg.norm(seen, axis=1)
    near = away <= at_center
    pull = np.linalg.norm((weights[~near] / away[~near]) @ seen[~near]) - weights[near].sum()
    return float(max(0.0, pull) / weights.sum())
