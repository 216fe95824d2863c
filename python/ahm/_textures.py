"""Decals, tool paths and texture atlases."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._maps import InverseMap, LogMap
from ._meshes import as_faces
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import as_maker
from .typing import Sources, SurfaceLike


def _inverse(thing: Union[LogMap, InverseMap]) -> InverseMap:
    return thing if isinstance(thing, InverseMap) else InverseMap(thing)


class Decal(NamedTuple):
    """The piece of the surface under an image, as a separate small mesh. Returned by `decal`."""

    points: np.ndarray  #: (p, 3) positions, world units
    normals: np.ndarray  #: (p, 3) unit normals
    #: Corners of every face, counter-clockwise: triangles of the surface, cut along the borders of the image. An (m, 3) array if
    #: no triangle is cut, otherwise a list of arrays
    faces: Union[np.ndarray, List[np.ndarray]]
    uv: np.ndarray  #: (p, 2) image coordinates in [0, 1]; (0, 0) is the lower left corner of the image
    hidden: int  #: number of triangles left out: under another sheet of the map, or not connected to the rest of the decal

    def __repr__(self) -> str:
        return f"<ahm.Decal: {arguments.counted(len(self.points), 'point')}, {arguments.counted(len(self.faces), 'face')}>"


def decal(map: Union[LogMap, InverseMap], width: float, height: float, *, angle: float = 0.0, mirrored: bool = False,
          radius: Optional[float] = None, lift: float = 0.0) -> Decal:
    """Maps an image, a rectangle of the (u, v) plane with its center at the source, to the surface.

    map : a `LogMap` with frames, or an `InverseMap`.
    width, height : size of the image, > 0, world units.
    angle : angle from the u axis to the left-to-right direction of the image, counter-clockwise, radians.
    mirrored : exchange left and right.
    radius : cut off everything farther from the source than this, world units; None: nothing.
    lift : offset of the decal along the normals, world units.

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
    """The image coordinates of every row: (n, 2) in [0, 1], for painting clouds. NaN for rows outside the image.

    Arguments and errors as in `decal`.

    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.plane(9, 9), 40, u_axis=[1, 0, 0])
    >>> ahm.decal_coordinates(m, 4.0, 2.0)[41].round(6).tolist()
    [0.75, 0.5]

    Raises ValueError naming the argument.
    """
    options = checked(width=width, height=height, angle=angle, mirrored=mirrored, radius=radius)
    return _inverse(map)._core.image_coordinates(options)


class Coverage(NamedTuple):
    """A path that covers a disc of the surface: k points in order of travel. Returned by `coverage`."""

    position: np.ndarray  #: (k, 3) positions, world units
    normal: np.ndarray  #: (k, 3) unit normals of the surface
    heading: np.ndarray  #: (k, 3) directions of travel, unit vectors perpendicular to the normals
    uv: np.ndarray  #: (k, 2) coordinates (u, v), world units
    piece: np.ndarray  #: (k,) int32 number of the connected piece, from 0; a tool must lift between pieces
    line: np.ndarray  #: (k,) int32 number of the raster line, from 0; 0 on a spiral
    arclength: np.ndarray  #: (k,) distance from the start of the piece along the path, world units
    spacing: np.ndarray  #: (k,) distance in space to the neighboring line, world units; NaN where there is none
    between: np.ndarray  #: (k,) bool, additional points where a shortest path between points of the pattern bends at an edge
    pieces: int  #: number of pieces
    planned: int  #: number of points of the pattern in the plane; missing points lie outside the valid region of the map

    def __repr__(self) -> str:
        found = len(self.between) - int(np.count_nonzero(self.between))
        return f"<ahm.Coverage: {arguments.counted(len(self.uv), 'point')}, {found} of {self.planned} of the pattern, pieces: {self.pieces}>"


def coverage(map: Union[LogMap, InverseMap], radius: float, spacing: float, *, pattern: str = "raster",
             step: Optional[float] = None, angle: float = 0.0) -> Coverage:
    """A tool path: lines of equal spacing in the (u, v) plane, mapped to the surface, with normals.

    On meshes the points are joined by shortest paths. Where these bend at an edge, the path has additional points.

    map : a `LogMap` with frames, or an `InverseMap`.
    radius : radius of the disc around the source that is covered, > 0, world units.
    spacing : distance between lines, or between turns of the spiral, > 0, world units.
    pattern : "raster" or "spiral".
    step : longest distance between consecutive points in the plane, world units; None: half of the spacing.
    angle : angle from the u axis to the lines, or to the first ray of the spiral, radians.

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
    """The surface cut into charts, each flattened by its own log map, and packed into one square texture. Returned by `atlas`."""

    points: np.ndarray  #: (p, 3) positions, world units: the rows of a mesh, or the vertices of a cloud's graph
    #: Corners of every face as numbers of `points`: an (m, c) array if all faces have c corners, otherwise a list of arrays.
    #: Faces are oriented consistently where possible
    faces: Union[np.ndarray, List[np.ndarray]]
    chart: np.ndarray  #: (faces,) int32 number of the chart of every face; -1: no chart
    chart_uv: np.ndarray  #: (corners, 2) coordinates (u, v) in the frame of the chart's source, world units; NaN without a chart
    uv: np.ndarray  #: (corners, 2) texture coordinates in [0, 1], (0, 0) is the lower left corner; NaN without a chart
    sources: np.ndarray  #: (charts,) int32 row of every chart's source; -1: the source is a vertex that is not in the input
    #: Distortion D = max(1 / sigma1, sigma2) of the triangles: mean, median, percentile_95, largest. Also the shares flipped,
    #: flipped_area and collapsed_area (D > 1e6, not included in the mean)
    distortion: Dict[str, float]

    def __repr__(self) -> str:
        points, faces = arguments.counted(len(self.points), "point"), arguments.counted(len(self.faces), "face")
        return f"<ahm.Atlas: charts: {len(self.sources)}, {points}, {faces}>"


def atlas(solver: SurfaceLike, sources: Optional[Sources] = None, *, charts: int = 20, max_distortion: Optional[float] = None,
          method: Optional[str] = None, size: int = 2048, margin: int = 4,
          progress: Progress = None) -> Atlas:
    """A texture atlas: geodesic Voronoi cells around sources, each flattened by the log map from its source.

    solver : a solver, or a mesh or a cloud.
    sources : k points, one per chart. Charts start at rows; for other points the nearest row is used. None: farthest points.
    charts : number of farthest points if `sources` is None.
    method : for a surface: "heat" (default), "polar", or "exact": exact cells and charts over the flat triangles of a mesh.
    max_distortion : add sources until the triangles have at most this distortion, except for 1 % of a chart's area; > 1. None: add
        no sources.
    size : side of the square texture, texels.
    margin : empty texels around each chart.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> a = ahm.atlas(ahm.shapes.torus(24, 12), charts=6)
    >>> len(a.faces), a.uv.shape, bool((a.chart >= 0).all())
    (576, (1728, 2), True)

    Raises ValueError naming the argument.
    """
    made = as_maker(solver, method)
    at = None if sources is None else places.points(sources, "sources", made.surface)
    options = checked(max_distortion=max_distortion, size=size)
    options["margin"] = arguments.integer(margin, "margin")
    with reporting(progress) as report:
        points, begin, corners, *rest = _core.atlas(made._core, at, arguments.integer(charts, "charts", 1), options, report)
    return Atlas(points, as_faces(begin, corners), *rest)
