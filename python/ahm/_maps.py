"""Logarithmic maps by rows of the input, and the way back."""

from __future__ import annotations

import enum
from typing import Any, Dict, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._surfaces import Surface


class Status(enum.IntEnum):
    """Why a row has coordinates, or has none: the values of `LogMap.status`."""

    ok = 0
    disconnected = 1  #: in a component of the graph without a source
    beyond_radius = 2  #: farther from the source than the requested radius
    unreached = 3  #: so far that the heat has left the range of double precision, or the heat cancels
    removed = 4  #: an input point that is no vertex of the graph


class MapSource(NamedTuple):
    """Where a map starts."""

    position: Optional[np.ndarray]  #: (3,) in space, world units; of a graph the origin of a frame, None without
    axes: Optional[np.ndarray]  #: (3, 3) u axis, v axis and normal in space; None without
    row: Optional[int]  #: None where the source is no row


class InversePoints(NamedTuple):
    """What lies at coordinates (u, v); k of them, NaN and -1 where nothing does."""

    position: np.ndarray  #: (k, 3) on the flat triangle, world units
    normal: np.ndarray  #: (k, 3) unit: those of the corners, interpolated
    du: np.ndarray  #: (k, 3) derivative of the position by u
    dv: np.ndarray  #: (k, 3) derivative of the position by v
    triangle: np.ndarray  #: (k, 3) int32 rows of the triangle
    barycentric: np.ndarray  #: (k, 3)

    @property
    def valid(self) -> np.ndarray:
        """(k,) bool: whether something lies there."""
        return self.triangle[:, 0] >= 0


class LogMap:
    """A log map on the rows of the input: NaN exactly where `status` is not ok. Arrays are views, read-only, not copies.

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
        """Out of a pickle it is made when it is first asked for."""
        if self._made is None:
            self._made = self._recipe.make(self._number)
        return self._made

    @property
    def surface(self) -> Surface:
        """What the map is on."""
        return self._surface

    @property
    def uv(self) -> np.ndarray:
        """(n, 2) coordinates phi in the source's frame, world units; (n, d) on grids and graphs of other dimensions."""
        return self._map.uv()

    @property
    def distance(self) -> np.ndarray:
        """(n,) geodesic distance from the source, world units: more accurate than |uv|; of an exact map |uv|. Of a stroke that
        from the curve; where its coordinates are `positions`, from its nearest sample, a quarter of an edge off at most."""
        return self._map.distance()

    @property
    def angle(self) -> np.ndarray:
        """(n,) atan2(v, u), radians in (-pi, pi]."""
        return self._map.angle()

    @property
    def spread(self) -> np.ndarray:
        """(n,) standard deviation of the coordinates over the ways by which heat arrives, world units: about the distance
        on the cut locus. NaN of a map made with spread=False."""
        return self._map.spread()

    @property
    def error_estimate(self) -> Optional[np.ndarray]:
        """(n,) estimate of |error of uv|, world units, of polar maps; None for heat and exact maps."""
        found = self._map.error_estimate()
        return found if len(found) else None

    @property
    def status(self) -> np.ndarray:
        """(n,) uint8, values of `Status`."""
        return self._map.status()

    @property
    def ok(self) -> np.ndarray:
        """(n,) bool: status is ok."""
        return self.status == Status.ok

    @property
    def quality(self) -> np.ndarray:
        """(n,) in (0, 1]: below 0.5 a vector is, as a rule, wrong by more than a tenth of its length. Computed anew each time.

        Raises InvalidArgument for a map made with spread=False.
        """
        return self._map.quality()

    @property
    def frames(self) -> np.ndarray:
        """(n, d, d) the source's axes carried to every row: column a is source axis a in the frame of the row (Eq. 11, 12).

        Raises InvalidArgument where the map was made with frames=False.
        """
        return self._map.frames()

    @property
    def axes(self) -> np.ndarray:
        """(n, 2, 3) the source's u and v axis carried to every row, as vectors of space. Raises as `frames`."""
        return self._map.axes()

    @property
    def gradient(self) -> np.ndarray:
        """(n, 3) unit vectors of space that point away from the source; 0 at the source. Raises as `frames`."""
        return self._map.gradient()

    @property
    def corner_uv(self) -> np.ndarray:
        """(corners, 2) coordinates at every corner of every face, which may differ from corner to corner of a vertex where
        the map is cut open along its cut locus: what textures need."""
        return self._map.corners()

    @property
    def source(self) -> MapSource:
        """Where the map starts, and its axes."""
        return MapSource(*self._map.source())

    @property
    def method(self) -> str:
        """"polar", "heat" or "exact"."""
        return self._map.method

    def sample(self, points: Any) -> np.ndarray:
        """(k, 2) coordinates at points of the surface: rows, positions (k, 3), (faces, barycentric), (edges, t).

        NaN where the map is not ok. In the tangent planes of a cloud it takes a map with frames.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.sample([[1.25, 0.5, 0.0]]).round(9).tolist()
        [[1.25, 0.5]]

        Raises ValueError naming the point.
        """
        return self._map.sample(places.points(points, "points", self._surface, empty=True))[0]

    def inverse(self, uv: Any) -> InversePoints:
        """What lies at coordinates `uv` (k, 2), world units; see `InverseMap`, which has options.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.inverse([[1.25, 0.5], [-1, 0]]).position.round(9).tolist()
        [[1.25, 0.5, 0.0], [nan, nan, nan]]

        Raises ValueError (shape; a map without frames; grids and graphs).
        """
        if self._inverse is None:
            self._inverse = InverseMap(self)
        return self._inverse(uv)

    def __len__(self) -> int:
        """Number of rows."""
        return len(self._surface)

    def __reduce__(self) -> tuple:
        return _again, (self._recipe, self._number)

    def __copy__(self) -> LogMap:
        return self

    def __deepcopy__(self, memo: Any) -> LogMap:
        return self

    def __repr__(self) -> str:
        row = self._map.source()[2]
        start = "a point" if row is None else f"row {row}"
        return f"<ahm.LogMap: {self.method}, {len(self)} rows, {int(self.ok.sum())} ok, from {start}>"


def _again(recipe: Any, number: int) -> LogMap:
    """A map out of a pickle."""
    recipe.expect(number)
    return LogMap(None, recipe, number)


class InverseMap:
    """From coordinates back to the surface, where the map has an inverse: from triangles that keep their orientation in the
    plane, have corners to be trusted, and are not stretched beyond bounds.

    map : a `LogMap` with frames, of a mesh or cloud.
    max_stretch : triangles with an edge this many times longer or shorter in the plane than in space are left out; > 1.
    min_quality : rows of a lower `LogMap.quality` are left out; 0: none.

    >>> import ahm
    >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
    >>> inverse = ahm.InverseMap(m)
    >>> inverse([[2.5, 1.5]]).position.round(9).tolist()
    [[2.5, 1.5, 0.0]]

    Raises InvalidArgument (no frames, max_stretch).
    """

    def __init__(self, map: LogMap, *, max_stretch: float = 4.0, min_quality: float = 0.5) -> None:
        if not isinstance(map, LogMap):
            raise TypeError(f"map: a LogMap is needed, not {type(map).__name__}")
        self.map = map
        self._options = checked(max_stretch=max_stretch, min_quality=min_quality)
        self._core = _core.Inverse(map._map, self._options)

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3) int32 rows of the triangles that answer, nearest to the source first."""
        return self._core.triangles()

    def __call__(self, uv: Any) -> InversePoints:
        """What lies at coordinates (k, 2), world units."""
        return InversePoints(*self._core.at(arguments.floats(uv, "uv", (None, 2))))

    def __reduce__(self) -> tuple:
        return _inverse_again, (self.map, self._options)

    def __repr__(self) -> str:
        return f"<ahm.InverseMap: {len(self.triangles)} triangles>"


def _inverse_again(map_: LogMap, options: Dict[str, Any]) -> InverseMap:
    return InverseMap(map_, **options)
