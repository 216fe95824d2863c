"""Solvers for log maps: by the heat method, by polar fronts, or by exact geodesics."""

from __future__ import annotations

import threading
from typing import Any, Dict, List, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._inputs import surface as as_surface
from ._maps import LogMap
from ._options import checked
from ._pickles import reduced
from ._progress import Progress, reporting
from ._surfaces import Surface
from .typing import Source, Sources, SurfaceLike, Vector


class _Maker:
    """Base of the solvers: computes maps from packed sources, and gives each map a recipe for its pickle."""

    surface: Surface
    method: str

    def _found(self, at: tuple, axis: Any, options: Dict[str, Any], report: Any) -> list:
        raise NotImplementedError

    def _solve(self, at: tuple, u_axis: Any, progress: Progress, **options: Any) -> List[LogMap]:
        axis = arguments.vector(u_axis, "u_axis")
        recipe = _Recipe(self, tuple(np.array(x) if isinstance(x, np.ndarray) else x for x in at),
                         None if axis is None else np.array(axis), checked(**options))
        with reporting(progress) as report:
            return [LogMap(made, recipe, k) for k, made in enumerate(recipe.found(at, report))]

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: Any) -> Any:
        return self


class _Recipe:
    """The inputs of the maps of one call, which pickles store instead of the maps.

    The first access to a map of a pickle computes all maps of this pickle together. A lock makes threads do so only once.
    """

    def __init__(self, maker: _Maker, at: tuple, axis: Any, options: Dict[str, Any]) -> None:
        self.maker, self.at, self.axis, self.options = maker, at, axis, options
        self.expected: List[int] = []
        self.made: Dict[int, _core.Map] = {}
        self.lock = threading.Lock()

    @property
    def surface(self) -> Surface:
        return self.maker.surface

    def found(self, at: tuple, report: Any = None) -> list:
        return self.maker._found(at, self.axis, self.options, report)

    def expect(self, number: int) -> None:
        self.expected.append(number)

    def make(self, number: int) -> _core.Map:
        with self.lock:
            if number not in self.made:
                numbers = sorted({number, *self.expected})
                self.made.update(zip(numbers, self.found((*self.at[:2], *(x[numbers] for x in self.at[2:])))))
                self.expected.clear()
            return self.made.pop(number)

    def __reduce__(self) -> tuple:
        return reduced(_Recipe, self.maker, self.at, self.axis, self.options)


class LogMapSolver(_Maker):
    """Computes log maps on one surface by the affine heat method. Factors once for any number of sources.

    Immutable; threads can share it.

    surface : a `Surface`, or what `ahm.surface` takes.
    t_coef : factor of the diffusion time tau = t_coef h^2, with the mean edge length h; > 0.
    variant : "adaptive" (Alg. 2) or "localized" (Alg. 1) of [SS25].
    strategy : "global": one factorization of the whole graph. "march": band by band outwards from the source, for any size and
        distance. "automatic": chosen by the size of the graph, the number of maps and the memory.
    expected_maps : for "automatic": number of maps to compute; 0: many.
    memory : for "automatic": bytes available for the factors; 0: half of the machine's memory.
    accuracy : for "march": largest relative difference to a global solve, in [1e-14, 0.1].
    ordering : fill-reducing ordering of the factorization: "auto", "amd" or "nested_dissection"; "auto" takes the one with fewer operations.
    threads : number of threads; 0: one per core. No result depends on it.
    progress : None, True (a progress bar), or a callable that takes (stage, fraction).

    Raises ValueError naming the option; NotPositiveDefinite (a RuntimeError), ResourceExhausted (a MemoryError).

    >>> import ahm
    >>> solver = ahm.LogMapSolver(ahm.TriangleMesh(*ahm.shapes.sphere(2)))
    >>> solver
    <ahm.LogMapSolver: global, on <ahm.TriangleMesh: 162 vertices, 320 faces>>
    >>> maps = solver.log_maps([0, 7, 12])
    """

    method = "heat"

    def __init__(self, surface: SurfaceLike, *, t_coef: float = 1.0, variant: str = "adaptive",
                 strategy: str = "automatic", expected_maps: int = 0, memory: int = 0, accuracy: float = 1e-9,
                 ordering: str = "auto", threads: int = 0, progress: Progress = None) -> None:
        self.surface = as_body(surface)
        self.options = checked(t_coef=t_coef, variant=variant, strategy=strategy, expected_maps=expected_maps,
                               memory=memory, accuracy=accuracy, ordering=ordering, threads=threads)
        with reporting(progress) as report:
            self._core = _core.Solver(self.surface._body, self.options, report)

    @property
    def strategy(self) -> str:
        """The strategy in use: "global" or "march"."""
        return self._core.strategy

    def log_map(self, source: Source, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = True,
                variant: Optional[str] = None, threads: Optional[int] = None, progress: Progress = None) -> LogMap:
        """The log map of one source.

        source : a row, a position (the nearest point of the surface is used), `(face, barycentric)`, or `((row, row), t)`: the
            point at fraction t of an edge.
        u_axis : (3,) vector in space along which u runs, projected to the surface; None: the x axis of the row's frame, the
            direction of the edge, or the first side of the face.
        radius : rows farther than this get `Status.beyond_radius`; world units. None: no limit.
        frames : keep the transported frames, which `LogMap.frames`, `axes`, `gradient` and `inverse` require.
        variant, threads, progress : as in the constructor; None: the option of the solver.

        >>> import ahm
        >>> solver = ahm.LogMapSolver(ahm.shapes.plane(4, 3))
        >>> solver.log_map([0.5, 0.0, 0.0], u_axis=[1, 0, 0]).uv[11].round(9).tolist()
        [2.5, 2.0]

        Raises ValueError naming the argument, the index and the value; NotPositiveDefinite, ResourceExhausted.
        """
        at = places.point(source, "source", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames, variant=variant, threads=threads)[0]

    def log_maps(self, sources: Sources, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = False,
                 spread: bool = True, distances: bool = True, variant: Optional[str] = None, threads: Optional[int] = None,
                 progress: Progress = None) -> List[LogMap]:
        """One map per source, solved in blocks. Faster than one by one; the results agree up to rounding.

        sources : (k,) rows, (k, 3) positions, `(faces, barycentric)`, `(edges, t)`, or a list of any of these.
        frames : as in `log_map`, but False by default.
        spread : compute `LogMap.spread`, which `quality` requires. It takes a fifth of the time.
        distances : compute `LogMap.distance`. If False, maps take a tenth of the time on small meshes to a half on large ones.
            Their distance is then the length |uv|, or the straight-line distance in space if that is longer, and they have no
            spread.

        Other arguments and errors as in `log_map`.

        >>> import ahm
        >>> [m.source.row for m in ahm.LogMapSolver(ahm.shapes.plane(4, 3)).log_maps([0, 7, 11])]
        [0, 7, 11]
        """
        at = places.points(sources, "sources", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames, spread=spread, distances=distances, variant=variant,
                           threads=threads)

    def _found(self, at: tuple, axis: Any, options: Dict[str, Any], report: Any) -> list:
        return self._core.maps(at, axis, options, report)

    def __reduce__(self) -> tuple:
        return reduced(_solver_again, self.surface, self.options)

    def __repr__(self) -> str:
        return f"<ahm.LogMapSolver: {self.strategy}, on {self.surface!r}>"


def _solver_again(on: Surface, options: Dict[str, Any]) -> LogMapSolver:
    return LogMapSolver(on, **options)


class PolarMapSolver(_Maker):
    """Log maps in geodesic polar coordinates: the length of the shortest path times its direction at the source.

    Nothing is factored. On meshes and clouds, exact windows compute distances and directions around the source, and a front
    continues from there. On grids and graphs the front starts at the source. Immutable; threads can share it.

    `cells`, `karcher_mean`, `geometric_median` and `atlas` accept it in place of a `LogMapSolver`.

    surface : a `Surface` of dimension 2, or what `ahm.surface` takes.
    windows : number of exact windows around the source per map; None: 8 per vertex, at least 131,072; 0: none.
    threads : number of threads; 0: one per core. No result depends on it.
    progress : None, True (a progress bar), or a callable that takes (stage, fraction).

    Raises ValueError if the dimension is not 2.

    >>> import ahm
    >>> solver = ahm.PolarMapSolver(ahm.shapes.sphere(3))
    >>> solver
    <ahm.PolarMapSolver: on <ahm.TriangleMesh: 642 vertices, 1280 faces>>
    >>> [bool(abs(m.distance.max() - 3.1416) < 0.02) for m in solver.log_maps([0, 7, 12])]
    [True, True, True]
    """

    method = "polar"

    def __init__(self, surface: SurfaceLike, *, windows: Optional[int] = None, threads: int = 0,
                 progress: Progress = None) -> None:
        self.surface = as_body(surface)
        self.options = checked(windows=windows, threads=threads)
        with reporting(progress) as report:
            self._core = _core.PolarSolver(self.surface._body, self.options.get("windows"), self.options["threads"], report)

    def log_map(self, source: Source, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = True,
                progress: Progress = None) -> LogMap:
        """The polar map of one source. Arguments and errors as in `LogMapSolver.log_map`.

        >>> import ahm
        >>> m = ahm.PolarMapSolver(ahm.shapes.plane(4, 3)).log_map(((0, 1), 0.5), u_axis=[1, 0, 0])
        >>> m.uv[[0, 11]].round(9).tolist()
        [[-0.5, 0.0], [2.5, 2.0]]
        """
        at = places.point(source, "source", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames)[0]

    def log_maps(self, sources: Sources, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = False,
                 threads: Optional[int] = None, progress: Progress = None) -> List[LogMap]:
        """One map per source, several at a time, with the same results as `log_map`.

        Arguments and errors as in `log_map` and `LogMapSolver.log_maps`.

        >>> import ahm
        >>> [m.method for m in ahm.PolarMapSolver(ahm.shapes.plane(4, 3)).log_maps([0, 7])]
        ['polar', 'polar']
        """
        at = places.points(sources, "sources", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames, threads=threads)

    def _found(self, at: tuple, axis: Any, options: Dict[str, Any], report: Any) -> list:
        return self._core.maps(at, axis, options, report)

    def __reduce__(self) -> tuple:
        return reduced(_polar_again, self.surface, self.options)

    def __repr__(self) -> str:
        return f"<ahm.PolarMapSolver: on {self.surface!r}>"


def _polar_again(on: Surface, options: Dict[str, Any]) -> PolarMapSolver:
    return PolarMapSolver(on, **options)


class ExactGeodesics(_Maker):
    """Log maps by shortest paths over the flat triangles of a mesh, exact up to rounding. Prepares the triangles once.

    `stroke`, `cells`, `karcher_mean`, `geometric_median` and `atlas` accept it in place of a `LogMapSolver`. Immutable; threads
    can share it.

    surface : a mesh whose faces are flat, or what `ahm.surface` takes.
    progress : None, True (a progress bar), or a callable that takes (stage, fraction).

    Raises ValueError if the surface has no flat faces (clouds, grids, twisted polygons) or if a face has no area.

    >>> import ahm
    >>> geodesics = ahm.ExactGeodesics(ahm.shapes.sphere(3))
    >>> geodesics
    <ahm.ExactGeodesics: on <ahm.TriangleMesh: 642 vertices, 1280 faces>>
    >>> [bool(abs(m.distance.max() - 3.1416) < 0.02) for m in geodesics.log_maps([0, 7, 12])]
    [True, True, True]
    """

    method = "exact"

    def __init__(self, surface: SurfaceLike, *, progress: Progress = None) -> None:
        self.surface = as_body(surface)
        self._core = self.surface._body
        with reporting(progress) as report:
            self._core.lay_out(report)

    def log_map(self, source: Source, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = True,
                progress: Progress = None) -> LogMap:
        """The exact log map of one source. Arguments and errors as in `LogMapSolver.log_map`. A small radius saves time.

        >>> import ahm
        >>> m = ahm.ExactGeodesics(ahm.shapes.plane(4, 3)).log_map(((0, 1), 0.5), u_axis=[1, 0, 0])
        >>> m.uv[[0, 11]].round(9).tolist()
        [[-0.5, 0.0], [2.5, 2.0]]
        """
        at = places.point(source, "source", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames)[0]

    def log_maps(self, sources: Sources, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = False,
                 threads: int = 0, progress: Progress = None) -> List[LogMap]:
        """One map per source, several at a time, with the same results as `log_map`.

        Arguments and errors as in `log_map` and `LogMapSolver.log_maps`.

        >>> import ahm
        >>> [m.method for m in ahm.ExactGeodesics(ahm.shapes.plane(4, 3)).log_maps([0, 7])]
        ['exact', 'exact']
        """
        at = places.points(sources, "sources", self.surface)
        return self._solve(at, u_axis, progress, radius=radius, frames=frames, threads=threads)

    def _found(self, at: tuple, axis: Any, options: Dict[str, Any], report: Any) -> list:
        return _core.exact_maps(self._core, at, axis, options, report)

    def __reduce__(self) -> tuple:
        return reduced(ExactGeodesics, self.surface)

    def __repr__(self) -> str:
        return f"<ahm.ExactGeodesics: on {self.surface!r}>"


Maker = Union[LogMapSolver, PolarMapSolver, ExactGeodesics]


def log_map(surface: SurfaceLike, source: Source, *, method: str = "auto", u_axis: Optional[Vector] = None,
            radius: Optional[float] = None, frames: bool = True, progress: Progress = None, **options: object) -> LogMap:
    """The log map of one source: direction and distance of every row. For many sources on one surface use a `SurfaceSolver`.

    surface : a `Surface`, a solver, or what `ahm.surface` takes.
    source : a row, a position, `(face, barycentric)`, or `((row, row), t)` on an edge.
    method : "polar": length and direction of the shortest path, by a front, on any surface. "heat": the affine heat method,
        smooth on noisy clouds. "exact": shortest paths over the flat triangles of a mesh. "auto" (default): "polar" on meshes and
        on clouds with little noise, otherwise "heat"; also "heat" if `options` contains options of this method.
        `LogMap.method` is the method that was used.
    u_axis, radius, frames, progress : as in `LogMapSolver.log_map`.
    options : threads; for method "heat" also t_coef, variant and other options of `LogMapSolver`.

    >>> import ahm
    >>> m = ahm.log_map(ahm.shapes.sphere(3), 0, method="exact")
    >>> bool(abs(m.distance.max() - 3.14159) < 0.02)
    True

    Raises ValueError naming the argument, the index and the value; NotPositiveDefinite, ResourceExhausted.
    """
    maker = chosen_maker(surface, method, dict(expected_maps=1, progress=progress, **options))
    return maker.log_map(source, u_axis=u_axis, radius=radius, frames=frames, progress=progress)


def chosen_maker(thing: Any, method: str, options: Optional[Dict[str, Any]] = None) -> Maker:
    """Like `as_maker`, but accepts the method "auto": the method suggested for the surface, or heat if an option requires it."""
    arguments.choice(method, "method", ("auto", "polar", "heat", "exact"))
    thing = getattr(thing, "_solver", thing)
    if method != "auto":
        return as_maker(thing, method, options)
    if isinstance(thing, (LogMapSolver, PolarMapSolver, ExactGeodesics)):
        return as_maker(thing, None, options)
    if set(options or {}) - {"expected_maps", "progress", "threads"}:
        return as_maker(thing, "heat", options)
    return as_maker(thing, _core.choose_method(as_body(thing)._body, 0), options)


def as_maker(thing: Any, method: Optional[str] = None, options: Optional[Dict[str, Any]] = None) -> Maker:
    """A solver for this method. `thing` is returned if it is such a solver; otherwise one is made from its surface.

    method : None: the method of `thing` if it is a solver, otherwise heat.
    """
    if method is not None:
        arguments.choice(method, "method", ("polar", "heat", "exact"))
    thing = getattr(thing, "_solver", thing)
    given = options or {}
    made = {LogMapSolver: "heat", PolarMapSolver: "polar", ExactGeodesics: "exact"}.get(type(thing))
    ready = made is not None and method in (None, made)
    by = made if ready else method or "heat"
    unknown = sorted(set(given) - {"expected_maps", "progress", "threads"}) if ready or by != "heat" else []
    if unknown:
        problem = "options of an existing solver cannot be changed" if ready else f"method {by!r} has no such option"
        raise TypeError(f"{unknown[0]}: {problem}")
    if ready:
        return thing
    if by == "exact":
        return ExactGeodesics(as_body(thing), progress=given.get("progress"))
    if by == "polar":
        return PolarMapSolver(as_body(thing), threads=given.get("threads") or 0, progress=given.get("progress"))
    return LogMapSolver(as_body(thing), **given)


def as_solver(thing: Any) -> LogMapSolver:
    """`thing` if it is a `LogMapSolver`, otherwise a new solver on its surface."""
    thing = getattr(thing, "_solver", thing)
    return thing if isinstance(thing, LogMapSolver) else LogMapSolver(as_body(thing))


def as_body(thing: Any) -> Surface:
    thing = getattr(thing, "_solver", thing)
    return thing.surface if isinstance(thing, (LogMapSolver, PolarMapSolver, ExactGeodesics)) else as_surface(thing)
