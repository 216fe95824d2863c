"""Shortest paths and straight lines over the flat triangles of meshes, and over the tangent planes of clouds."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._progress import Progress, reporting
from ._solvers import as_body


class Path(NamedTuple):
    """A curve on a mesh: straight inside a triangle between neighbouring points. Of a cloud: from tangent plane to tangent plane."""

    points: np.ndarray  #: (k, 3) in space, world units
    face: Any  #: (k,) int32 face of the input of every point; of clouds None, as the next
    barycentric: Any  #: (k, 3) weights of its corners; a list of k arrays where faces have other numbers of corners. Of polygons
    #: that are not flat, of the point of the face nearest to the path, which runs over their triangles
    length: float  #: world units
    complete: bool  #: False of a trace that ended at the boundary

    def __repr__(self) -> str:
        return f"<ahm.Path: {len(self.points)} points, {self.length:.6g} long{'' if self.complete else ', to the boundary'}>"


def geodesic_path(surface: Any, stops: Any, to: Any = None, *, closed: bool = False, fast: bool = False, taut: bool = False,
                  progress: Progress = None) -> Optional[Path]:
    """The shortest path between two points, or through stops in their order, exact up to rounding.

    surface : a mesh or a cloud, or what `ahm.surface` takes. Over clouds paths are straight on planes, and short to second order in
        the spacing elsewhere; they take neither `fast` nor `taut`.
    stops : where the path starts, with `to`; or two or more points. Points are rows, positions, `(face, barycentric)`,
        `((row, row), t)`.
    to : where the path ends.
    closed : and back to the first stop.
    fast : locally shortest from stop to stop: at any size in time near linear, but there may be a shorter way on the other
        side of a hill.
    taut : pulled taut, so that it leaves its stops and is locally shortest everywhere: only its ends stay; of a closed one
        see `geodesic_loop`.
    progress : as of `LogMapSolver`.

    >>> import ahm
    >>> path = ahm.geodesic_path(ahm.shapes.plane(4, 3), 0, 11)
    >>> round(path.length ** 2, 9), path.points[-1].tolist()
    (13.0, [3.0, 2.0, 0.0])

    None where the surface does not connect them. Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    if to is None:
        at = places.points(stops, "stops", on)
    else:
        at = places.joined(places.point(stops, "stops", on), places.point(to, "to", on))
    arguments.flag(closed, "closed"), arguments.flag(fast, "fast"), arguments.flag(taut, "taut")
    with reporting(progress) as report:
        found = _core.path(on._body, at, closed, fast, taut, report)
    return None if found is None else Path(*found)


def geodesic_loop(surface: Any, stops: Any, *, fast: bool = False, progress: Progress = None) -> Optional[Path]:
    """A closed geodesic: the closed path through the stops, pulled taut until it is locally shortest everywhere [XW07].

    stops : three or more points, as of `geodesic_path`, around what shall hold the loop: a handle, a limb, a hole.
    surface, fast, progress : as of `geodesic_path`.

    It begins and ends at the same point. Around nothing that would hold it, it shrinks to a point, of length 0.

    >>> import ahm
    >>> V, F = ahm.shapes.torus(48, 24, tube=0.4)
    >>> loop = ahm.geodesic_loop((V, F), [3, 11, 19])            # of the tube, through three of its rows
    >>> bool(abs(loop.length - 2 * 3.1416 * 0.4) < 0.02)
    True

    None where the surface does not connect them. Raises as `geodesic_path`.
    """
    return geodesic_path(surface, stops, closed=True, fast=fast, taut=True, progress=progress)


def geodesic_paths(surface: Any, sources: Any, targets: Any, *, pairwise: bool = False, fast: bool = False,
                   progress: Progress = None) -> List[Optional[Path]]:
    """The shortest path to every target from the nearest of the sources, of one propagation.

    surface, progress : as of `geodesic_path`; over clouds `pairwise` alone. sources, targets : one or more points each.
    pairwise : instead to target k from source k, one propagation for every distinct source.
    fast : with `pairwise`, on meshes: locally shortest, as of `geodesic_path`.

    >>> import ahm
    >>> paths = ahm.geodesic_paths(ahm.shapes.plane(4, 3), 0, [3, 8])
    >>> [round(path.length, 9) for path in paths]
    [3.0, 2.0]

    None where there is no way. Raises as `geodesic_path`.
    """
    on = as_body(surface)
    start, end = places.points(sources, "sources", on), places.points(targets, "targets", on)
    arguments.flag(fast, "fast"), arguments.flag(pairwise, "pairwise")
    if pairwise:
        if len(start[2]) != len(end[2]):
            raise ValueError(f"targets: {len(end[2])} points for the {len(start[2])} sources; pairwise there are as many")
        with reporting(progress) as report:
            found = _core.paired_paths(on._body, start, end, fast, report)
    elif fast:
        raise ValueError("fast: goes with pairwise=True")
    else:
        with reporting(progress) as report:
            found = _core.paths(on._body, start, end, report)
    return [None if one is None else Path(*one) for one in found]


def trace(surface: Any, start: Any, direction: Any, length: Optional[float] = None, *,
          progress: Progress = None) -> Path:
    """The straightest geodesic from a point: the exponential map [PS98].

    start : a row, a position, `(face, barycentric)`, or `((row, row), t)`.
    direction : (3,) vector of space, projected to the surface.
    length : >= 0, world units; None: that of `direction`. surface, progress : as of `geodesic_path`.

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
        return Path(*_core.trace(on._body, places.point(start, "start", on), along, far, report))
