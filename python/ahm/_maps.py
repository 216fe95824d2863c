"""Logarithmic maps: the solver, and the result by rows of the input."""

from __future__ import annotations

import enum
from typing import Any, Dict, List, NamedTuple, Optional, Sequence

import numpy as np

from . import _arguments as arguments
from . import _core
from ._options import checked
from ._progress import Progress, reporting
from ._surfaces import Surface, surface as as_surface


class Status(enum.IntEnum):
    """Why a row has coordinates, or has none: the values of `LogMap.status`."""

    ok = 0
    disconnected = 1  #: in a component of the graph without a source
    beyond_radius = 2  #: farther from the source than the requested radius
    unreached = 3  #: so far that the heat has left the range of double precision, or the heat cancels
    removed = 4  #: an input point that is no vertex of the graph


class MapSource(NamedTuple):
    """Where a map starts."""

    position: Optional[np.ndarray]  #: (3,) in space, world units; None without positions
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
    <ahm.LogMap: heat, 12 rows, 12 ok, from row 0>
    >>> m.uv[11].round(9).tolist(), round(float(m.distance[11]) ** 2, 9)
    ([3.0, 2.0], 13.0)
    """

    def __init__(self, map_: _core.Map, on: Surface, recipe: tuple) -> None:
        self._map, self._surface, self._recipe = map_, on, recipe
        self._inverse: Optional[InverseMap] = None

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
        """(n,) geodesic distance from the source, world units: more accurate than |uv|; of an exact map |uv|."""
        return self._map.distance()

    @property
    def angle(self) -> np.ndarray:
        """(n,) atan2(v, u), radians in (-pi, pi]."""
        return self._map.angle()

    @property
    def spread(self) -> np.ndarray:
        """(n,) standard deviation of the coordinates over the ways by which heat arrives, world units: about the distance
        on the cut locus. Empty of a map from a curve, or made with spread=False."""
        return self._map.spread()

    @property
    def error_estimate(self) -> Optional[np.ndarray]:
        """(n,) estimate of |error of uv|, world units, with order=2; else None."""
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

        Raises InvalidArgument for a map from a curve.
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
        position, axes, row = self._map.source()
        return MapSource(position if self._surface.points is not None else None, axes, row)

    @property
    def method(self) -> str:
        """"heat" or "exact"."""
        return self._map.method

    def sample(self, points: Any) -> np.ndarray:
        """(k, 2) coordinates at points of the surface: rows, positions (k, 3), or (faces, barycentric).

        NaN where the map is not ok. In the tangent planes of a cloud it takes a map with frames.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.sample([[1.25, 0.5, 0.0]]).round(9).tolist()
        [[1.25, 0.5]]

        Raises ValueError naming the point.
        """
        return self._map.sample(arguments.points(points, "points", self._surface))[0]

    def inverse(self, uv: Any) -> InversePoints:
        """What lies at coordinates (k, 2), world units; see `InverseMap`, which has options.

        >>> import ahm
        >>> m = ahm.log_map(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0, u_axis=[1, 0, 0])
        >>> m.inverse([[1.25, 0.5], [-1, 0]]).position.round(9).tolist()
        [[1.25, 0.5, 0.0], [nan, nan, nan]]
        """
        if self._inverse is None:
            self._inverse = InverseMap(self)
        return self._inverse(uv)

    def __len__(self) -> int:
        """Number of rows."""
        return len(self._surface)

    def __reduce__(self) -> tuple:
        return _again, self._recipe

    def __repr__(self) -> str:
        row = self._map.source()[2]
        start = "a point" if row is None else f"row {row}"
        return f"<ahm.LogMap: {self.method}, {len(self)} rows, {int(self.ok.sum())} ok, from {start}>"


def _again(solver: Any, name: str, args: tuple, options: Dict[str, Any]) -> LogMap:
    """A map made again, for pickles."""
    return getattr(solver, name)(*args, **options)


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


class LogMapSolver:
    """Solves for log maps on one surface: factors once, then serves any number of sources. Immutable, shared by threads.

    surface : a `Surface`, or what `ahm.surface` takes.
    t_coef : tau = t_coef h^2, the diffusion time; > 0.
    variant : "adaptive" (Alg. 2) or "localized" (Alg. 1) of [SS25].
    order : 1, or 2: extrapolates from two or three diffusion times, with an error estimate.
    strategy : "automatic", "global" (one factorization) or "march" (band by band, any size and distance).
    expected_maps : for "automatic": the number of maps to be made; 0: many.
    memory : for "automatic": bytes that factors may take; 0: half of the machine's memory.
    accuracy : of marches, against a global solve, relative.
    ordering : "amd", or "nested_dissection": for many maps.
    threads : 0: one per core. No result depends on it.
    progress : None, True (a bar), or a callable (stage, fraction).

    Raises ValueError naming the option; NotPositiveDefinite (a RuntimeError), ResourceExhausted (a MemoryError).

    >>> import ahm
    >>> solver = ahm.LogMapSolver(ahm.TriangleMesh(*ahm.shapes.sphere(2)))
    >>> solver
    <ahm.LogMapSolver: global, on <ahm.TriangleMesh: 162 vertices, 320 faces>>
    >>> maps = solver.log_maps([0, 7, 12])
    """

    def __init__(self, surface: Any, *, t_coef: float = 1.0, variant: str = "adaptive", order: int = 1,
                 strategy: str = "automatic", expected_maps: int = 0, memory: int = 0, accuracy: float = 1e-9,
                 ordering: str = "amd", supernodal: bool = True, threads: int = 0, progress: Progress = None) -> None:
        self.surface = as_surface(surface)
        self.options = checked(t_coef=t_coef, variant=variant, order=order, strategy=strategy,
                               expected_maps=expected_maps, memory=memory, accuracy=accuracy, ordering=ordering,
                               supernodal=supernodal, threads=threads)
        with reporting(progress) as report:
            self._core = _core.Solver(self.surface._body, self.options, report)

    @property
    def strategy(self) -> str:
        """What was chosen: "global" or "march"."""
        return self._core.strategy

    def log_map(self, source: Any, *, u_axis: Any = None, radius: Optional[float] = None, frames: bool = True,
                variant: Optional[str] = None, threads: Optional[int] = None, progress: Progress = None) -> LogMap:
        """The log map of one source: a row, a position (the nearest point of the surface), or `(face, barycentric)`.

        u_axis : (3,) a vector of space, projected to the surface; None: the x axis of the row's frame, or the face's first side.
        radius : rows farther than this, world units, get `Status.beyond_radius`.
        frames : keep the transported frames, which `LogMap.frames`, `axes`, `gradient` and `inverse` need.
        variant, threads, progress : as of the solver.

        Raises ValueError naming argument, index and value; NotPositiveDefinite, ResourceExhausted.
        """
        at = arguments.point(source, "source", self.surface)
        options = dict(u_axis=u_axis, radius=radius, frames=frames, variant=variant, threads=threads)
        return self._solve(at, "log_map", source, options, progress)[0]

    def log_maps(self, sources: Any, *, u_axis: Any = None, radius: Optional[float] = None, frames: bool = False,
                 spread: bool = True, variant: Optional[str] = None, threads: Optional[int] = None, progress: Progress = None) -> List[LogMap]:
        """One map for each source, in blocks, which is faster than one by one, and the same numbers.

        sources : (k,) rows, (k, 3) positions, `(faces, barycentric)`, or a list of any.
        spread : keep `LogMap.spread`, which `quality` needs and which is a fifth of the work. Otherwise as `log_map`.
        """
        at = arguments.points(sources, "sources", self.surface)
        options = dict(u_axis=u_axis, radius=radius, frames=frames, spread=spread, variant=variant, threads=threads)
        return self._solve(at, "log_maps", sources, options, progress)

    def _solve(self, at: tuple, name: str, given: Any, options: Dict[str, Any], progress: Progress) -> List[LogMap]:
        axis = arguments.vector(options["u_axis"], "u_axis")
        core = checked(**{key: value for key, value in options.items() if key != "u_axis"})
        with reporting(progress) as report:
            found = self._core.maps(at, axis, core, report)
        single = name == "log_map"
        return [LogMap(m, self.surface, (self, "log_map", (given,), options) if single
                       else (self, "_one_of", (given, k), options)) for k, m in enumerate(found)]

    def _one_of(self, sources: Any, k: int, **options: Any) -> LogMap:
        return self.log_maps(sources, **options)[k]

    def __reduce__(self) -> tuple:
        return _solver_again, (self.surface, self.options)

    def __repr__(self) -> str:
        return f"<ahm.LogMapSolver: {self.strategy}, on {self.surface!r}>"


def _solver_again(on: Surface, options: Dict[str, Any]) -> LogMapSolver:
    return LogMapSolver(on, **options)


class _Exact:
    """Makes exact maps again, for pickles."""

    def __init__(self, on: Surface) -> None:
        self.surface = on

    def log_map(self, source: Any, **options: Any) -> LogMap:
        return log_map(self.surface, source, method="exact", **options)


def log_map(surface: Any, source: Any, *, method: str = "heat", u_axis: Any = None, radius: Optional[float] = None,
            frames: bool = True, threads: int = 0, progress: Progress = None, **options: Any) -> LogMap:
    """The log map of one source. For many sources on one surface make a `LogMapSolver`.

    surface : a `Surface`, or what `ahm.surface` takes.
    source : a row, a position, or `(face, barycentric)`.
    method : "heat": by diffusion, on any surface; "exact": by straight lines over the flat triangles of a mesh.
    u_axis, radius, frames, progress : as of `LogMapSolver.log_map`.
    options : of `LogMapSolver`, for method "heat": order, t_coef, variant, ...

    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.sphere(3), 0, method="exact")
    >>> bool(abs(m.distance.max() - 3.14159) < 0.02)
    True

    Raises ValueError naming argument, index and value; NotPositiveDefinite, ResourceExhausted.
    """
    on = as_surface(surface)
    arguments.choice(method, "method", ("heat", "exact"))
    if method == "heat":
        options.setdefault("expected_maps", 1)
        solver = LogMapSolver(on, threads=threads, progress=progress, **options)
        return solver.log_map(source, u_axis=u_axis, radius=radius, frames=frames, progress=progress)
    if options:
        raise TypeError(f"log_map: method 'exact' has no option {sorted(options)[0]!r}")
    at = arguments.point(source, "source", on)
    given = dict(u_axis=u_axis, radius=radius, frames=frames)
    with reporting(progress) as report:
        found = _core.exact_maps(on._body, at, arguments.vector(u_axis, "u_axis"),
                                 checked(radius=radius, frames=frames), report)
    return LogMap(found[0], on, (_Exact(on), "log_map", (source,), given))


def as_solver(thing: Any, options: Optional[Dict[str, Any]] = None) -> LogMapSolver:
    """The solver itself, or one on this surface."""
    return thing if isinstance(thing, LogMapSolver) else LogMapSolver(thing, **(options or {}))


def as_body(thing: Any) -> Surface:
    return thing.surface if isinstance(thing, LogMapSolver) else as_surface(thing)


__all__: Sequence[str] = ("InverseMap", "InversePoints", "LogMap", "LogMapSolver", "MapSource", "Status", "log_map")
