"""Decals, tool paths and atlases."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._maps import InverseMap, LogMap
from ._meshes import as_faces
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import as_maker


def _inverse(thing: Union[LogMap, InverseMap]) -> InverseMap:
    return thing if isinstance(thing, InverseMap) else InverseMap(thing)


class Decal(NamedTuple):
    """A piece of the surface under an image: a small mesh of its own."""

    points: np.ndarray  #: (p, 3) world units
    normals: np.ndarray  #: (p, 3)
    faces: Any  #: list of corners, counter-clockwise: triangles of the surface, cut along the borders of the image; (m, 3)
    #: where none is cut
    uv: np.ndarray  #: (p, 2) in [0, 1]: (0, 0) the lower left corner of the image
    hidden: int  #: triangles left out, since another sheet of the map lies over the same place

    def __repr__(self) -> str:
        return f"<ahm.Decal: {len(self.points)} points, {len(self.faces)} faces>"


def decal(map: Union[LogMap, InverseMap], width: float, height: float, *, angle: float = 0.0, mirrored: bool = False,
          radius: Optional[float] = None, lift: float = 0.0) -> Decal:
    """A rectangle of the (u, v) plane with its middle at the source, carried to the surface.

    map : a `LogMap` with frames, or an `InverseMap`.
    width, height : world units. angle : radians from the u axis to the image's direction from left to right.
    mirrored : left and right exchanged. radius : cut off what is farther. lift : along the normals, world units.

    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.plane(9, 9), 40, u_axis=[1, 0, 0])
    >>> piece = ahm.decal(m, 3.0, 2.0)
    >>> piece.points.min(axis=0).round(6).tolist(), piece.points.max(axis=0).round(6).tolist()
    ([2.5, 3.0, 0.0], [5.5, 5.0, 0.0])

    Raises ValueError naming the argument.
    """
    options = checked(width=width, height=height, angle=angle, mirrored=mirrored, radius=radius, lift=lift)
    points, normals, begin, corners, uv, hidden = _inverse(map)._core.decal(options)
    return Decal(points, normals, as_faces(begin, corners), uv, hidden)


def decal_coordinates(map: Union[LogMap, InverseMap], width: float, height: float, *, angle: float = 0.0,
                      mirrored: bool = False, radius: Optional[float] = None) -> np.ndarray:
    """Where every row lies in the image, (n, 2) in [0, 1]; NaN where it does not: to paint clouds.

    Arguments and errors as of `decal`.


    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.plane(9, 9), 40, u_axis=[1, 0, 0])
    >>> ahm.decal_coordinates(m, 4.0, 2.0)[41].round(6).tolist()
    [0.75, 0.5]

    Raises ValueError naming the argument.
    """
    options = checked(width=width, height=height, angle=angle, mirrored=mirrored, radius=radius)
    return _inverse(map)._core.image_coordinates(options)


class Coverage(NamedTuple):
    """A path that covers a disc of the surface, k points in order of travel."""

    position: np.ndarray  #: (k, 3) world units
    normal: np.ndarray  #: (k, 3) unit
    heading: np.ndarray  #: (k, 3) unit, perpendicular to the normal
    uv: np.ndarray  #: (k, 2)
    piece: np.ndarray  #: (k,) int32, from 0; a tool must lift between pieces
    line: np.ndarray  #: (k,) int32 of the raster; 0 on a spiral
    arclength: np.ndarray  #: (k,) from the start of the piece along the path
    spacing: np.ndarray  #: (k,) distance in space to the neighbouring line; NaN where there is none
    between: np.ndarray  #: (k,) bool; not of the pattern, but where the shortest way over the faces of a mesh bends
    pieces: int
    planned: int  #: points of the pattern in the plane; those missing lie outside of the valid region

    def __repr__(self) -> str:
        found = len(self.between) - int(np.count_nonzero(self.between))
        return f"<ahm.Coverage: {len(self.uv)} points, {found} of {self.planned} of the pattern, pieces: {self.pieces}>"


def coverage(map: Union[LogMap, InverseMap], radius: float, spacing: float, *, pattern: str = "raster",
             step: Optional[float] = None, angle: float = 0.0) -> Coverage:
    """Lines of equal spacing in log coordinates, carried to the surface, normals included. On meshes its points are joined by
    shortest paths, which have points of their own where they bend over an edge.

    map : a `LogMap` with frames, or an `InverseMap`.
    radius : of the disc about the source. spacing : between lines or turns. step : between points; None: half of the
        spacing. All in world units. pattern : "raster" or "spiral". angle : radians from the u axis.

    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.plane(9, 9), 40, u_axis=[1, 0, 0])
    >>> path = ahm.coverage(m, radius=3, spacing=1)
    >>> path.pieces, path.normal[0].tolist()
    (5, [0.0, 0.0, 1.0])

    Raises ValueError naming the argument.
    """
    options = checked(radius=radius, spacing=spacing, pattern=pattern, step=step, angle=angle)
    inverse = _inverse(map)
    return Coverage(*inverse._core.coverage(inverse.map._map, options))


class Atlas(NamedTuple):
    """The surface cut into charts, each flattened by its own log map, and packed into one square texture."""

    points: np.ndarray  #: (p, 3): the rows of a mesh, or the vertices of a cloud's graph
    faces: Any  #: (m, c) places in `points` of the corners, a list where faces differ; all oriented alike where that is possible
    chart: np.ndarray  #: (faces,) int32; -1: no chart
    chart_uv: np.ndarray  #: (corners, 2) world units, in the frame of the chart's source; NaN without a chart
    uv: np.ndarray  #: (corners, 2) in [0, 1] of the texture, (0, 0) the lower left corner; NaN without a chart
    sources: np.ndarray  #: (charts,) int32 row of every chart's source; -1: a vertex that the input does not have
    distortion: Dict[str, float]  #: of D = max(1 / sigma1, sigma2): mean, median, percentile_95, largest; shares collapsed_area
    #: (D > 1e6, not in the mean), flipped, flipped_area

    def __repr__(self) -> str:
        return f"<ahm.Atlas: charts: {len(self.sources)}, {len(self.points)} points, {len(self.faces)} faces>"


def atlas(solver: Any, sources: Any = None, *, charts: int = 20, max_distortion: Optional[float] = None,
          method: Optional[str] = None, tolerance: Optional[float] = None, size: int = 2048, margin: int = 4,
          progress: Progress = None) -> Atlas:
    """A texture atlas: geodesic cells around sources, each flattened by the log map from its source.

    solver : a `LogMapSolver` or `ExactGeodesics`, or a mesh or cloud.
    sources : k points; charts start at rows, so that of any other point the nearest row counts; None: `charts` rows spread
        evenly.
    method : of a surface: "heat" (default), "polar", or "exact" over the flat triangles of a mesh: cells and charts.
    tolerance : of exact maps, as of `ExactGeodesics`.
    max_distortion : > 1: adds sources until the charts are as good as that; None: keeps to the sources.
    size, margin : texels of a side of the square, and free around each chart.
    progress : as of `LogMapSolver`.

    >>> import ahm
    >>> a = ahm.atlas(ahm.shapes.torus(24, 12), charts=6)
    >>> len(a.faces), a.uv.shape, bool((a.chart >= 0).all())
    (576, (1728, 2), True)

    Raises ValueError naming the argument.
    """
    made = as_maker(solver, method, tolerance=tolerance)
    at = None if sources is None else places.points(sources, "sources", made.surface)
    options = checked(max_distortion=max_distortion, size=size)
    options["margin"] = arguments.integer(margin, "margin")
    with reporting(progress) as report:
        points, begin, corners, *rest = _core.atlas(made._maker, at, arguments.integer(charts, "charts", 1), options, report)
    return Atlas(points, as_faces(begin, corners), *rest)
