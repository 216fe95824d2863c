"""Curves as sources, geodesic Voronoi cells, farthest points, and means."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._fields import distance_and_nearest
from ._maps import LogMap
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import ExactGeodesics, Maker, PolarMapSolver, as_body, as_maker, chosen_maker
from .typing import Source, Sources, SurfaceLike, Vector, Matrix


class Stroke(NamedTuple):
    """The log map from a curve, and the curve on the surface. Returned by `stroke`."""

    map: LogMap  #: log map from the curve. u: arclength along it, v: signed distance, positive on its left
    points: np.ndarray  #: (k, 3) corners of the curve on the surface, world units
    length: float  #: length of the curve, world units
    gap: float  #: largest distance of the curve from the surface before it was projected, world units
    jump: float  #: longest of the pieces into which the curve was cut, world units


def stroke(solver: SurfaceLike, points: Sources, *, closed: bool = False, shape: str = "line", positions: Optional[Matrix] = None,
           method: Optional[str] = None, radius: Optional[float] = None, frames: bool = True,
           progress: Progress = None) -> Stroke:
    """Coordinates along a curve: the coordinates of the nearest point of the curve, plus the log map from there.

    solver : a `LogMapSolver`, an `ExactGeodesics`, or a surface (a mesh or a cloud).
    points : two or more points of the curve: rows, positions, `(face, barycentric)`, `((row, row), t)`. Consecutive points are
        joined by shortest paths, over the flat faces of a mesh or the tangent planes of a cloud. On twisted polygons they are
        joined by straight lines; choose points so close that these lines stay near the surface.
    closed : whether the last point is joined to the first.
    shape : "line": u is the arclength. "circle": a closed curve becomes a circle around the origin of the (u, v) plane.
    positions : (k, 2) coordinates (u, v) of the points, world units, linear between them; None: (arclength, 0).
    method : for a surface: "heat" (default), or "exact" over the flat triangles of a mesh.
    radius, frames, progress : as in `LogMapSolver.log_map`.

    >>> import ahm
    >>> s = ahm.stroke(ahm.shapes.plane(9, 5), [[1, 2, 0], [7, 2, 0]])
    >>> s.map.uv[9 * 3 + 4].round(6).tolist(), round(s.length, 9)
    ([3.0, 1.0], 6.0)

    Raises ValueError naming the argument, the index and the value.
    """
    made = as_maker(solver, method)
    if isinstance(made, PolarMapSolver):
        raise ValueError("method: polar maps cannot start at a curve; use 'heat' or 'exact'")
    at = places.points(points, "points", made.surface)
    arguments.choice(shape, "shape", ("line", "circle"))
    uv = np.empty((0, 2))
    if positions is not None:
        uv = arguments.floats(positions, "positions", (len(at[2]), 2), finite=True)
        if shape != "line":
            raise ValueError("positions: cannot be combined with `shape`; use one of them")
    shaped = (arguments.flag(closed, "closed"), shape == "circle", checked(radius=radius, frames=frames))
    with reporting(progress) as report:
        found, drawn, length, gap, jump = _core.stroke(made._core, at, uv, *shaped, report)
    return Stroke(LogMap(found, _StrokeRecipe(made, at, np.array(uv), shaped)), drawn, length, gap, jump)


class _StrokeRecipe(NamedTuple):
    """The inputs of the map of a stroke, which its pickle stores instead of the map."""

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
        return _core.stroke(self.maker._core, self.at, self.uv, *self.shaped, None)[0]


class Cells(NamedTuple):
    """Geodesic Voronoi cells: the nearest source of every row. Returned by `cells`."""

    labels: np.ndarray  #: (n,) int32 number of the nearest source; -1 in components without a source
    distance: np.ndarray  #: (n,) geodesic distance from that source, world units; NaN in components without a source


def cells(surface: SurfaceLike, sources: Sources, *, method: Optional[str] = None, progress: Progress = None) -> Cells:
    """Geodesic Voronoi cells: for every row, which source is nearest. Takes one pass for any number of sources.

    surface : a `Surface`, a solver, or what `ahm.surface` takes.
    sources : rows, positions, `(face, barycentric)`, `((row, row), t)`. A row may occur only once.
    method : "wavefront" (default) or "exact", as in `distance`. If `surface` is an `ExactGeodesics`, the default is "exact".
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> ahm.cells(ahm.shapes.plane(5, 2), [0, 4]).labels[[0, 1, 3, 4]].tolist()
    [0, 0, 1, 1]

    Raises ValueError naming the argument, the index and the value.
    """
    on = as_body(surface)
    method = _wavefront_or_exact(surface, method)
    _, _, kinds, rows, _, _ = places.points(sources, "sources", on)
    to_rows = np.flatnonzero(kinds == places.ROW)
    _, first = np.unique(rows[to_rows], return_index=True)
    for again in np.setdiff1d(to_rows, to_rows[first]):
        raise ValueError(f"sources[{again}]: row {rows[again]} occurs twice")
    distance, labels = distance_and_nearest(surface, sources, method=method, progress=progress)
    return Cells(labels, distance)


def _wavefront_or_exact(surface: Any, method: Optional[str]) -> str:
    if method is None:
        return "exact" if isinstance(getattr(surface, "_solver", surface), ExactGeodesics) else "wavefront"
    return arguments.choice(method, "method", ("wavefront", "exact"))


def farthest_points(surface: SurfaceLike, count: int, first: Source = 0, *, method: Optional[str] = None,
                    progress: Progress = None) -> np.ndarray:
    """Farthest point sampling: `count` rows, beginning with `first`; each is the farthest from the previous ones.

    surface : a `Surface`, a solver, or what `ahm.surface` takes.
    count : number of rows in the result, from 1 to the number of rows of the surface.
    first : a row, or another point, whose nearest row is used.
    method : as in `cells`.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> ahm.farthest_points(ahm.shapes.plane(5, 2), 2).tolist()
    [0, 9]

    Returns (count,) int32. Raises ValueError naming the argument and the value.
    """
    on = as_body(surface)
    by = _wavefront_or_exact(surface, method)
    at = places.point(first, "first", on)
    with reporting(progress) as report:
        return _core.farthest(on._body, at, arguments.integer(count, "count", 1), by == "exact", report)


class Center(NamedTuple):
    """The mean or median of points on a surface. Returned by `karcher_mean` and `geometric_median`."""

    row: Optional[int]  #: row of the graph vertex nearest to the center; None if that vertex is not in the input
    offset: np.ndarray  #: (d,) log map of the center from that vertex, in the vertex's frame, world units
    #: Position in space, world units. On a mesh: (3,), on its faces. On a cloud: (3,), in the tangent plane of a row. On a grid:
    #: (d,). On a graph: (3,), in the tangent plane of a frame; None without frames.
    position: Optional[np.ndarray]
    #: Mean: root mean square of the weighted distances. Median: weighted mean of the distances. World units.
    spread: float
    maps: int  #: number of log maps computed by the search
    converged: bool  #: whether the center is within an edge of the nearest vertex; False also after `max_maps`
    #: Distance from a minimum, measured with one more log map, from the center itself. Mean: length of the weighted mean of the
    #: points' coordinates, world units. Median: the same for their unit vectors, minus the weight share of points at the center.
    #: On clouds and graphs, the map from a point near a vertex is the shifted map of the vertex. There the residual shows only
    #: whether the search converged.
    residual: float
    #: The center in a form that other functions accept as a point: (face, barycentric) on a mesh, otherwise the position, or None
    point: Union[None, Tuple[int, np.ndarray], np.ndarray]


def karcher_mean(solver: SurfaceLike, points: Sources, weights: Optional[Vector] = None, *, start: Optional[Source] = None,
                 method: str = "auto", max_maps: int = 50, radius: Optional[float] = None, progress: Progress = None) -> Center:
    """The Karcher mean (Riemannian center of mass): a local minimum of the weighted sum of squared distances [Kar77].

    solver : a `LogMapSolver`, a `PolarMapSolver`, an `ExactGeodesics`, or a surface.
    points : k points: rows, positions, `(faces, barycentric)`, `(edges, t)`.
    weights : (k,) numbers >= 0, not all 0; None: all equal.
    start : the search begins at the row nearest to this point; None: near the point with the largest weight.
    method : for a surface: "auto" (default), "polar", "heat" or "exact", as in `log_map`.
    max_maps : maximum number of log maps, >= 1; each step of the search computes one.
    radius : radius of the maps, world units. It must cover every point, from the center and from the start. None: no limit.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> mean = ahm.karcher_mean(ahm.shapes.plane(9, 9), [0, 8, 72, 80])
    >>> mean.row, mean.converged, mean.residual < 1e-9
    (40, True, True)

    Raises ValueError naming the argument, the index and the value, also for points in different components.
    """
    return _center(chosen_maker(solver, method), points, weights, False, start, max_maps, radius, progress)


def geometric_median(solver: SurfaceLike, points: Sources, weights: Optional[Vector] = None, *, start: Optional[Source] = None,
                     method: str = "auto", max_maps: int = 50, radius: Optional[float] = None,
                     progress: Progress = None) -> Center:
    """The geometric median: a local minimum of the weighted sum of distances, near the start [FVJ09].

    Result, arguments and errors as in `karcher_mean`.

    >>> import ahm
    >>> ahm.geometric_median(ahm.shapes.plane(9, 9), [0, 8, 72], [3.0, 1.0, 1.0]).row
    0
    """
    return _center(chosen_maker(solver, method), points, weights, True, start, max_maps, radius, progress)


def _center(made: Maker, points: Any, weights: Any, median: bool, start: Any, max_maps: int, radius: Optional[float],
            progress: Progress) -> Center:
    on = made.surface
    at = places.points(points, "points", on)
    given = np.empty(0) if weights is None else _weights(weights, len(at[2]))
    begin = None if start is None else places.point(start, "start", on)
    with reporting(progress) as report:
        row, offset, position, spread, maps, converged, face, inside, seen = _core.center(
            made._core, at, given, median, begin, checked(max_maps=max_maps, radius=radius), report)
    point = (face, inside) if face is not None and inside is not None else position if on._body.has_positions else None
    residual = _residual(seen, given if len(given) else np.ones(len(seen)), median, 1e-9 * on.mean_edge_length)
    return Center(row, offset, position, spread, maps, converged, residual, point)


def _weights(weights: Any, count: int) -> np.ndarray:
    given = arguments.floats(weights, "weights", (count,), finite=True)
    if (given < 0).any():
        k = int(np.argmax(given < 0))
        raise ValueError(f"weights[{k}]: {given[k]} is less than 0")
    if not given.any():
        raise ValueError("weights: all are 0; at least one must be positive")
    return given


def _residual(seen: np.ndarray, weights: np.ndarray, median: bool, at_center: float) -> float:
    weights, seen = weights[weights > 0] / weights.max(), seen[weights > 0]
    if not median:
        return float(np.linalg.norm(weights @ seen) / weights.sum())
    away = np.linalg.norm(seen, axis=1)
    near = away <= at_center
    pull = np.linalg.norm((weights[~near] / away[~near]) @ seen[~near]) - weights[near].sum()
    return float(max(0.0, pull) / weights.sum())
