"""Logarithmic maps by rows of the input, and their inverse maps."""

from __future__ import annotations

import enum
from typing import Any, Dict, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._pickles import reduced
from ._surfaces import Surface
from .typing import Sources, Matrix


class Status(enum.IntEnum):
    """Whether a row has coordinates, and if not why: the values of `LogMap.status`."""

    ok = 0  #: the row has coordinates
    disconnected = 1  #: the row is in a component of the graph without a source
    beyond_radius = 2  #: the row is farther from the source than the requested radius
    unreached = 3  #: the row is so far away that its heat is below the range of double precision, or the heat cancels
    removed = 4  #: the row has no vertex in the graph


class MapSource(NamedTuple):
    """The point where a map starts, and its axes. Returned by `LogMap.source`."""

    position: Optional[np.ndarray]  #: (3,) position in space, world units; on graphs the origin of the frame, None without frames
    axes: Optional[np.ndarray]  #: (3, 3) u axis, v axis and normal in space; None without frames
    row: Optional[int]  #: row of the source; None if the source is not a row


class InversePoints(NamedTuple):
    """The points of the surface at k coordinates (u, v); NaN and -1 where there is none. Returned by `LogMap.inverse`."""

    position: np.ndarray  #: (k, 3) positions on the flat triangles, world units
    normal: np.ndarray  #: (k, 3) unit normals, interpolated from the corners of the triangle
    du: np.ndarray  #: (k, 3) derivative of the position by u
    dv: np.ndarray  #: (k, 3) derivative of the position by v
    triangle: np.ndarray  #: (k, 3) int32 rows of the corners of the triangle
    barycentric: np.ndarray  #: (k, 3) barycentric coordinates in the triangle

    @property
    def valid(self) -> np.ndarray:
        """(k,) bool: whether a point of the surface has these coordinates."""
        return self.triangle[:, 0] >= 0


class LogMap:
    """A log map: one entry per row of the input. Numbers are NaN exactly where `status` is not ok.

    The arrays `uv`, `distance`, `spread`, `error_estimate`, `bounded` and `status` are read-only views, not copies.

    >>> import ahm
    >>> mesh = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> m = ahm.log_map(mesh, 0, u_axis=[1, 0, 0])
    >>> m
    <ahm.LogMap: polar, 12 rows, 12 ok, from row 0>
    >>> m.uv[11].round(9).tolist(), round(float(m.distance[11]) ** 2, 9)
    ([3.0, 2.0], 13.0)
    """

    def __init__(self, made: Optional[_core.Map], recipe: Any, number: int = 0) -> None:
        self._made, self._recipe, self._number = made, recipe, number
        self._surface: Surface = recipe.surface
        self._inverse: Optional[InverseMap] = None

    @property
    def _map(self) -> _core.Map:
        """The map of the C++ library. After unpickling, the first access computes it again."""
        if self._made is None:
            self._made = self._recipe.make(self._number)
        return self._made

    @property
    def surface(self) -> Surface:
        """The surface of the map."""
        return self._surface

    @property
    def uv(self) -> np.ndarray:
        """(n, 2) coordinates (u, v) in the source's frame, world units; (n, d) on grids and graphs of other dimensions."""
        return self._map.uv()

    @property
    def distance(self) -> np.ndarray:
        """(n,) geodesic distance from the source, world units. More accurate than the length |uv|; for exact maps equal to it.

        For a stroke, the distance from the curve. With user-defined `positions` it is the distance from the nearest sample of the
        curve, with an error of at most a quarter of an edge."""
        return self._map.distance()

    @property
    def angle(self) -> np.ndarray:
        """(n,) direction of every row, seen from the source: atan2(v, u), radians in (-pi, pi]."""
        return self._map.angle()

    @property
    def spread(self) -> np.ndarray:
        """(n,) standard deviation of the coordinates over the paths of the heat, world units. About the distance at the cut locus.

        For polar and exact maps it is half of the longest jump to a neighbor. NaN if the map was computed with spread=False."""
        return self._map.spread()

    @property
    def error_estimate(self) -> Optional[np.ndarray]:
        """(n,) estimated length of the error of `uv`, world units, for polar maps. None for heat and exact maps."""
        found = self._map.error_estimate()
        return found if len(found) else None

    @property
    def bounded(self) -> Optional[np.ndarray]:
        """(n,) 1 where `distance` is only a lower bound, the straight line in space; otherwise 0, and NaN as everywhere.

        None where no distance is raised to a bound: for exact maps, maps of curves, and graphs without a surface."""
        found = self._map.bounded()
        return found if len(found) else None

    @property
    def status(self) -> np.ndarray:
        """(n,) uint8, a value of `Status` for every row."""
        return self._map.status()

    @property
    def ok(self) -> np.ndarray:
        """(n,) bool: whether the row has coordinates (`status` is ok)."""
        return self.status == Status.ok

    @property
    def quality(self) -> np.ndarray:
        """(n,) how reliable `uv` is, in (0, 1]. Below 0.5 its error usually exceeds a tenth of its length.

        Every access computes it again. Raises InvalidArgument for a map computed with spread=False.
        """
        return self._map.quality()

    @property
    def frames(self) -> np.ndarray:
        """(n, d, d) the source's axes, parallel transported to every row: column a is axis a in the frame of the row (Eq. 11, 12).

        Raises InvalidArgument for a map computed with frames=False.
        """
        return self._map.frames()

    @property
    def axes(self) -> np.ndarray:
        """(n, 2, 3) the source's u and v axis, parallel transported to every row, as vectors in space. Raises as `frames`."""
        return self._map.axes()

    @property
    def gradient(self) -> np.ndarray:
        """(n, 3) gradient of the distance: unit vectors in space that point away from the source; 0 at the source. Raises as
        `frames`."""
        return self._map.gradient()

    @property
    def corner_uv(self) -> np.ndarray:
        """(corners, 2) coordinates (u, v) at every corner of every face, for textures.

        Along the cut locus the map is cut open: corners at the same vertex may have different coordinates."""
        return self._map.corners()

    @property
    def source(self) -> MapSource:
        """The point where the map starts, and its axes."""
        return MapSource(*self._map.source())

    @property
    def method(self) -> str:
        """The method by which the map was computed: "polar", "heat" or "exact"."""
        return self._map.method

    def sample(self, points: Sources) -> np.ndarray:
        """The coordinates (u, v) at k points of the surface, as an array (k, 2); NaN where the map is not ok.

        points : rows, positions (k, 3), `(faces, barycentric)`, `(edges, t)`. On a cloud, points that are not rows require a map
            with frames.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.sample([[1.25, 0.5, 0.0]]).round(9).tolist()
        [[1.25, 0.5]]

        Raises ValueError naming the point.
        """
        return self._map.sample(places.points(points, "points", self._surface, empty=True))[0]

    def inverse(self, uv: Matrix) -> InversePoints:
        """The points of the surface at coordinates `uv` (k, 2), world units. `InverseMap` does the same with options.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.inverse([[1.25, 0.5], [-1, 0]]).position.round(9).tolist()
        [[1.25, 0.5, 0.0], [nan, nan, nan]]

        Raises ValueError (wrong shape; a map without frames; a map on a grid or a graph).
        """
        if self._inverse is None:
            self._inverse = InverseMap(self)
        return self._inverse(uv)

    def __len__(self) -> int:
        """Number of rows."""
        return len(self._surface)

    def __reduce__(self) -> tuple:
        return reduced(_again, self._recipe, self._number)

    def __copy__(self) -> LogMap:
        return self

    def __deepcopy__(self, memo: Any) -> LogMap:
        return self

    def __repr__(self) -> str:
        row = self._map.source()[2]
        start = "a point" if row is None else f"row {row}"
        return f"<ahm.LogMap: {self.method}, {arguments.counted(len(self), 'row')}, {int(self.ok.sum())} ok, from {start}>"


def _again(recipe: Any, number: int) -> LogMap:
    """Unpickles a map."""
    recipe.expect(number)
    return LogMap(None, recipe, number)


class InverseMap:
    """The inverse of a log map: from coordinates (u, v) to points of the surface.

    It uses only triangles that keep their orientation in the plane, are stretched by at most `max_stretch`, and have corners of
    sufficient quality.

    map : a `LogMap` with frames, on a mesh or a cloud.
    max_stretch : triangles with an edge longer or shorter in the plane than in space by more than this factor are left out; > 1.
    min_quality : rows with a lower `LogMap.quality` are left out; 0: none.

    >>> import ahm
    >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
    >>> inverse = ahm.InverseMap(m)
    >>> inverse([[2.5, 1.5]]).position.round(9).tolist()
    [[2.5, 1.5, 0.0]]

    Raises InvalidArgument (no frames, max_stretch).
    """

    def __init__(self, map: LogMap, *, max_stretch: float = 4.0, min_quality: float = 0.5) -> None:
        if not isinstance(map, LogMap):
            raise TypeError(f"map: expected a LogMap, got {type(map).__name__}")
        self.map = map
        self._options = checked(max_stretch=max_stretch, min_quality=min_quality)
        self._core = _core.Inverse(map._map, self._options)

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3) int32 rows of the triangles in use, nearest to the source first."""
        return self._core.triangles()

    def __call__(self, uv: Matrix) -> InversePoints:
        """The points of the surface at coordinates `uv` (k, 2), world units."""
        return InversePoints(*self._core.at(arguments.floats(uv, "uv", (None, 2))))

    def __reduce__(self) -> tuple:
        return reduced(_inverse_again, self.map, self._options)

    def __repr__(self) -> str:
        return f"<ahm.InverseMap: {len(self.triangles)} triangles>"


def _inverse_again(map_: LogMap, options: Dict[str, Any]) -> InverseMap:
    return InverseMap(map_, **options)
