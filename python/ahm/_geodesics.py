"""Shortest paths and straight lines over the flat triangles of meshes, and over the tangent planes of clouds."""

from __future__ import annotations

from typing import List, NamedTuple, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._progress import Progress, reporting
from ._solvers import as_body
from .typing import Source, Sources, SurfaceLike, Vector


class Path(NamedTuple):
    """A path on a mesh or a cloud. Consecutive points lie in one triangle of the mesh, or in neighboring tangent planes."""

    points: np.ndarray  #: (k, 3) points of the path in space, world units
    face: Optional[np.ndarray]  #: (k,) int32 face of the input in which each point lies; None on clouds
    #: (k, 3) barycentric coordinates of each point in its face; a list of k arrays if not all faces are triangles; None on clouds.
    #: On polygons that are not flat, the path runs over their triangles; the coordinates are those of the nearest point of the face.
    barycentric: Union[None, np.ndarray, List[np.ndarray]]
    length: float  #: length of the path, world units
    complete: bool  #: False for a trace that ended at the boundary

    def __repr__(self) -> str:
        end = "" if self.complete else ", to the boundary"
        return f"<ahm.Path: {arguments.counted(len(self.points), 'point')}, {self.length:.6g} long{end}>"


def geodesic_path(surface: SurfaceLike, stops: Sources, to: Optional[Source] = None, *, closed: bool = False, fast: bool = False,
                  taut: bool = False, progress: Progress = None) -> Optional[Path]:
    """The shortest path between two points, or through several stops in their order. On meshes it is exact up to rounding.

    surface : a mesh or a cloud, or what `ahm.surface` takes. On clouds, the length has an error of second order in the spacing,
        and none where the points lie in a plane. Clouds support neither `fast` nor `taut`.
    stops : the start of the path if `to` is used; otherwise two or more points. Points are rows, positions,
        `(face, barycentric)`, `((row, row), t)`.
    to : the end of the path.
    closed : whether the path returns to the first stop.
    fast : locally shortest paths from stop to stop, in nearly linear time. A shorter path may exist, for example on the
        other side of a hill.
    taut : pull the path taut, so that it is locally shortest everywhere. Only its ends are fixed; it leaves the
        inner stops. For closed paths see `geodesic_loop`.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> path = ahm.geodesic_path(ahm.shapes.plane(4, 3), 0, 11)
    >>> round(path.length ** 2, 9), path.points[-1].tolist()
    (13.0, [3.0, 2.0, 0.0])

    Returns None if the points are not connected. Raises ValueError naming the argument, the index and the value.
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


def geodesic_loop(surface: SurfaceLike, stops: Sources, *, fast: bool = False, progress: Progress = None) -> Optional[Path]:
    """A closed geodesic: the closed path through the stops, pulled taut until it is locally shortest everywhere [XW07].

    stops : three or more points, as in `geodesic_path`, around a handle, a limb or a hole that holds the loop.
    surface, fast, progress : as in `geodesic_path`.

    The loop begins and ends at the same point. If nothing holds it, it shrinks to a point of length 0.

    >>> import ahm
    >>> V, F = ahm.shapes.torus(48, 24, tube=0.4)
    >>> loop = ahm.geodesic_loop((V, F), [3, 11, 19])            # of the tube, through three of its rows
    >>> bool(abs(loop.length - 2 * 3.1416 * 0.4) < 0.02)
    True

    Returns None if the stops are not connected. Raises as `geodesic_path`.
    """
    return geodesic_path(surface, stops, closed=True, fast=fast, taut=True, progress=progress)


def geodesic_paths(surface: SurfaceLike, sources: Sources, targets: Sources, *, pairwise: bool = False, fast: bool = False,
                   progress: Progress = None) -> List[Optional[Path]]:
    """The shortest path to every target from the nearest of the sources, computed by one propagation.

    surface, progress : as in `geodesic_path`. Clouds require `pairwise`.
    sources, targets : one or more points each.
    pairwise : compute the path from source k to target k instead, with one propagation per distinct source.
    fast : locally shortest paths, as in `geodesic_path`; on meshes, with `pairwise`.

    >>> import ahm
    >>> paths = ahm.geodesic_paths(ahm.shapes.plane(4, 3), 0, [3, 8])
    >>> [round(path.length, 9) for path in paths]
    [3.0, 2.0]

    Returns one path per target, None where a target is not connected. Raises as `geodesic_path`.
    """
    on = as_body(surface)
    start, end = places.points(sources, "sources", on), places.points(targets, "targets", on)
    arguments.flag(fast, "fast"), arguments.flag(pairwise, "pairwise")
    if pairwise:
        if len(start[2]) != len(end[2]):
            raise ValueError(f"targets: pairwise=True requires as many targets as sources, got {len(end[2])} and {len(start[2])}")
        with reporting(progress) as report:
            found = _core.paired_paths(on._body, start, end, fast, report)
    elif fast:
        raise ValueError("fast: requires pairwise=True")
    else:
        with reporting(progress) as report:
            found = _core.paths(on._body, start, end, report)
    return [None if one is None else Path(*one) for one in found]


def trace(surface: SurfaceLike, start: Source, direction: Vector, length: Optional[float] = None, *,
          progress: Progress = None) -> Path:
    """The straightest geodesic from a point in a direction: the exponential map [PS98].

    start : a row, a position, `(face, barycentric)`, or `((row, row), t)`.
    direction : (3,) vector in space, projected to the surface.
    length : length of the geodesic, >= 0, world units; None: the length of `direction`.
    surface, progress : as in `geodesic_path`.

    >>> import ahm
    >>> end = ahm.trace(ahm.shapes.plane(4, 3), 0, [1, 0.5, 0], 2).points[-1]
    >>> [round(float(x), 6) for x in end]
    [1.788854, 0.894427, 0.0]

    A geodesic that reaches the boundary ends there, and its `complete` is False. Raises as `geodesic_path`.
    """
    on = as_body(surface)
    along = arguments.vector(direction, "direction")
    if along is None:
        raise TypeError("direction: expected three numbers, got None")
    far = float(np.linalg.norm(along)) if length is None else arguments.real(length, "length")
    with reporting(progress) as report:
        return Path(*_core.trace(on._body, places.point(start, "start", on), along, far, report))
