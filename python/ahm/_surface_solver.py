"""One solver for maps, distances and paths on a surface."""

from __future__ import annotations

from typing import Any, List, Optional

import numpy as np

from ._fields import distance as _distance
from ._geodesics import Path, geodesic_path
from ._geodesics import trace as _trace
from ._local_maps import LocalMaps
from ._local_maps import local_maps as _local_maps
from ._maps import LogMap
from ._pickles import reduced
from ._progress import Progress
from ._solvers import chosen_maker
from ._surfaces import Surface
from .typing import Source, Sources, SurfaceLike, Vector


class SurfaceSolver:
    """Log maps, distances and paths on one surface. Prepares the method once for any number of maps; threads can share it.

    surface : a `Surface`, or what `ahm.surface` takes.
    method : "auto" (the method suggested for the surface), "polar", "heat" or "exact", as in `log_map`.
    options : threads and progress; for method "heat" also t_coef, variant and other options of `LogMapSolver`.

    Functions that take a solver (`cells`, `atlas`, `karcher_mean`, ...) also accept a SurfaceSolver.

    >>> import ahm
    >>> solver = ahm.SurfaceSolver(ahm.shapes.plane(4, 3))
    >>> solver
    <ahm.SurfaceSolver: polar, on <ahm.TriangleMesh: 12 vertices, 12 faces>>
    >>> solver.log_map(0, u_axis=[1, 0, 0]).uv[11].round(9).tolist()
    [3.0, 2.0]

    Raises ValueError naming the option; NotPositiveDefinite, ResourceExhausted.
    """

    def __init__(self, surface: SurfaceLike, method: str = "auto", **options: object) -> None:
        self._solver: Any = chosen_maker(surface, method, dict(options))

    @property
    def surface(self) -> Surface:
        """The surface of the solver."""
        return self._solver.surface

    @property
    def method(self) -> str:
        """The method in use: "polar", "heat" or "exact"."""
        return self._solver.method

    def log_map(self, source: Source, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = True,
                progress: Progress = None) -> LogMap:
        """The log map of one source. Arguments and errors as in `LogMapSolver.log_map`.

        >>> import ahm
        >>> m = ahm.SurfaceSolver(ahm.shapes.plane(4, 3)).log_map([0.5, 0.0, 0.0], u_axis=[1, 0, 0])
        >>> m.uv[11].round(9).tolist()
        [2.5, 2.0]
        """
        return self._solver.log_map(source, u_axis=u_axis, radius=radius, frames=frames, progress=progress)

    def log_maps(self, sources: Sources, *, u_axis: Optional[Vector] = None, radius: Optional[float] = None, frames: bool = True,
                 progress: Progress = None) -> List[LogMap]:
        """One map per source, computed on several threads. Arguments and errors as in `LogMapSolver.log_maps`.

        >>> import ahm
        >>> [m.source.row for m in ahm.SurfaceSolver(ahm.shapes.plane(4, 3)).log_maps([0, 7, 11])]
        [0, 7, 11]
        """
        return self._solver.log_maps(sources, u_axis=u_axis, radius=radius, frames=frames, progress=progress)

    def distance(self, sources: Sources, *, radius: Optional[float] = None, progress: Progress = None) -> np.ndarray:
        """(n,) geodesic distance of every row from the nearest source, world units. NaN where no source is connected.

        Computed by a wavefront, or exactly if the method is "exact". Arguments and errors as in `ahm.distance`.

        >>> import ahm
        >>> ahm.SurfaceSolver(ahm.shapes.plane(4, 2)).distance([0, 3])[:4].round(9).tolist()
        [0.0, 1.0, 1.0, 0.0]
        """
        method = "exact" if self.method == "exact" else "wavefront"
        return _distance(self.surface, sources, method=method, radius=radius, progress=progress)

    def path(self, start: Source, end: Source, *, progress: Progress = None) -> Optional[Path]:
        """The shortest path between two points: exact over flat faces, on clouds over tangent planes. None if not connected.

        start, end : a row, a position, `(face, barycentric)`, or `((row, row), t)`.
        progress : as in `LogMapSolver`.

        >>> import ahm
        >>> round(ahm.SurfaceSolver(ahm.shapes.plane(4, 3)).path(0, 11).length ** 2, 9)
        13.0

        Raises as `geodesic_path`.
        """
        return geodesic_path(self.surface, start, end, progress=progress)

    def trace(self, start: Source, direction: Vector, length: Optional[float] = None, *, progress: Progress = None) -> Path:
        """The straightest geodesic from a point: the exponential map. Arguments and errors as in `ahm.trace`.

        >>> import ahm
        >>> end = ahm.SurfaceSolver(ahm.shapes.plane(4, 3)).trace(0, [1, 0, 0], 2).points[-1]
        >>> end.round(9).tolist()
        [2.0, 0.0, 0.0]
        """
        return _trace(self.surface, start, direction, length, progress=progress)

    def local_maps(self, radius: Optional[float] = None, k: Optional[int] = None, *, sources: Optional[Sources] = None,
                   u_axis: Optional[Vector] = None, margin: Optional[float] = None, transport: bool = True,
                   quality: bool = False, progress: Progress = None) -> LocalMaps:
        """Log maps within a radius around every row, or around `sources`: by heat if the solver's method is "heat", otherwise
        polar. Arguments and errors as in `ahm.local_maps`.

        >>> import ahm
        >>> ahm.SurfaceSolver(ahm.shapes.plane(9, 9)).local_maps(radius=1.0, sources=[40, 0])
        <ahm.LocalMaps: 2 sources, 8 entries>
        """
        return _local_maps(self._solver, radius, k, sources=sources, u_axis=u_axis, margin=margin, transport=transport, quality=quality,
                           method="heat" if self.method == "heat" else "polar", progress=progress)

    def __reduce__(self) -> tuple:
        return reduced(SurfaceSolver, self._solver)

    def __repr__(self) -> str:
        return f"<ahm.SurfaceSolver: {self.method}, on {self.surface!r}>"
