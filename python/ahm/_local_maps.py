"""The map around every point, within a radius: for learning on surfaces."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import as_body


class PaddedMaps(NamedTuple):
    """Local maps as arrays of the same length for every source; what is missing is 0 and `mask` False."""

    indices: np.ndarray  #: (s, k) int32 rows
    mask: np.ndarray  #: (s, k) bool
    log: np.ndarray  #: (s, k, d)
    distance: np.ndarray  #: (s, k)
    weight: np.ndarray  #: (s, k)
    transport: np.ndarray  #: (s, k, 2) (cos, sin), or (s, k, d, d)


class LocalMaps:
    """Local maps in compressed rows: source s has the entries indptr[s] : indptr[s + 1], nearest first, itself included.

    indptr : (s + 1,) int64. indices : (e,) int32 rows. log : (e, d) coordinates in the source's frame, world units.
    distance : (e,) geodesic, as `LogMap.distance`. weight : (e,) masses, world units to the power d, as integration weights.
    transport : (e, 2) (cos, sin), or (e, d, d): components in the source's frame -> components in the neighbour's.
    sources : (s,) int32 rows; -1 of sources that are no rows. columns : the number of rows. Made by `local_maps`.

    >>> import ahm
    >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0, sources=[40, 0])
    >>> maps, sorted(maps.indices[maps.indptr[1] : maps.indptr[2]].tolist())
    (<ahm.LocalMaps: 2 sources, 8 entries>, [0, 1, 9])
    """

    def __init__(self, sources: np.ndarray, columns: int, indptr: np.ndarray, indices: np.ndarray, log: np.ndarray,
                 distance: np.ndarray, weight: np.ndarray, transport: np.ndarray) -> None:
        self.sources, self.columns = sources, columns
        self.indptr, self.indices, self.log = indptr, indices, log
        self.distance, self.weight, self.transport = distance, weight, transport

    def csr(self, values: Any = "distance") -> Any:
        """A scipy.sparse.csr_matrix, sources x rows, with arrays of its own, whose order in a row is that of distance.

        values : "distance", "weight", "u", "v", "transport" (complex), or (e,) numbers of your own.

        >>> import ahm
        >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0)
        >>> maps.csr().shape, round(float(maps.csr("weight")[40].sum()), 9)
        ((81, 81), 5.0)

        Raises ValueError where `values` are none of these; ImportError without scipy.
        """
        from scipy.sparse import csr_matrix

        if isinstance(values, str):
            arguments.choice(values, "values", ("distance", "weight", "u", "v", "transport"))
            if values in "uv":
                values = self.log[:, "uv".index(values)]
            elif values == "transport":
                if self.transport.ndim != 2:
                    raise ValueError("values: these transports are matrices, not rotations of the plane")
                values = self.transport[:, 0] + 1j * self.transport[:, 1]
            else:
                values = getattr(self, values)
        values = np.asarray(values)
        if values.dtype.kind not in "biufc":
            raise TypeError(f"values: numbers are needed, not {arguments.describe(values, values)}")
        if values.shape != self.indices.shape:
            raise ValueError(f"values: shape ({len(self.indices)},) is needed, not {values.shape}")
        # scipy needs both kinds of indices to have one type, and changes them in place.
        index = np.int32 if len(self.indices) <= np.iinfo(np.int32).max else np.int64
        result = csr_matrix((len(self.sources), self.columns), dtype=values.dtype)
        result.data, result.indices, result.indptr = values.copy(), self.indices.astype(index), self.indptr.astype(index)
        return result

    def padded(self, k: Optional[int] = None, dtype: Any = np.float32) -> PaddedMaps:
        """The k nearest entries of every source; None: as many as the longest has. For torch: `torch.from_numpy(p.log)`.

        dtype : a floating type, of all but indices and mask.

        >>> import ahm
        >>> p = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0).padded(4)
        >>> sorted(p.indices[0].tolist()), p.mask[0].tolist(), p.log.dtype
        ([0, 0, 1, 9], [True, True, True, False], dtype('float32'))

        Raises ValueError (k < 1; a dtype that does not hold coordinates).
        """
        try:
            dtype = np.dtype(dtype)
        except TypeError:
            raise TypeError(f"dtype: {dtype!r:.60} is no type of numbers") from None
        if dtype.kind != "f":
            raise ValueError(f"dtype: {dtype} cannot hold coordinates; a floating type is needed")
        counts = np.diff(self.indptr)
        width = int(counts.max(initial=0)) if k is None else arguments.integer(k, "k", 1)
        place = np.arange(len(self.indices)) - np.repeat(self.indptr[:-1], counts)
        source = np.repeat(np.arange(len(counts)), counts)
        kept: Any = slice(None)
        if counts.max(initial=0) > width:
            kept = place < width
            source, place = source[kept], place[kept]

        def spread(values: np.ndarray, dtype: Any) -> np.ndarray:
            result = np.zeros((len(counts), width) + values.shape[1:], dtype)
            result[source, place] = values[kept]
            return result

        return PaddedMaps(spread(self.indices, np.int32), spread(np.ones(len(self.indices), bool), bool),
                          *(spread(x, dtype) for x in (self.log, self.distance, self.weight, self.transport)))

    def __len__(self) -> int:
        """Number of sources."""
        return len(self.sources)

    def __repr__(self) -> str:
        return f"<ahm.LocalMaps: {len(self)} sources, {len(self.indices)} entries>"


def local_maps(surface: Any, radius: Optional[float] = None, k: Optional[int] = None, *, sources: Any = None, u_axis: Any = None, margin: float = 2.0,
               t_coef: float = 1.0, variant: str = "adaptive", threads: int = 0, progress: Progress = None) -> LocalMaps:
    """The log map around every row, or around `sources`, of everything within a radius or of the k nearest rows.

    radius : world units, > 0; None, with k: as far as those are.
    k : keep only so many nearest entries per source, the source itself included; None: all within the radius.
    sources : points (rows, positions, `(faces, barycentric)`, `(edges, t)`); None: all rows, of which those without a vertex
        have no entries.
    u_axis : (3,) a vector of space, projected to the surface at every source that is given; None: as of `LogMapSolver.log_map`.
    margin : how far beyond the radius each patch reaches, in units of sqrt(tau).
    t_coef, variant, threads, progress : as of `LogMapSolver`.

    >>> import ahm
    >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.5, k=9)
    >>> neighbours = maps.indices[maps.indptr[40] : maps.indptr[41]]
    >>> sorted(neighbours.tolist())
    [30, 31, 32, 39, 40, 41, 48, 49, 50]
    >>> maps.csr().shape, maps.padded().log.shape
    ((81, 81), (81, 9, 2))

    Raises ValueError naming the argument; NotPositiveDefinite, ResourceExhausted.
    """
    on = as_body(surface)
    if radius is None and k is None:
        raise ValueError("radius: is missing; give a radius, or k")
    if radius is not None:
        radius = arguments.real(radius, "radius", positive=True)
    options = checked(radius=radius, k=k, margin=margin, t_coef=t_coef,
                      variant=variant, threads=threads)
    axis = arguments.vector(u_axis, "u_axis")
    if sources is None:
        if axis is not None:
            raise ValueError("u_axis: goes with `sources`")
        at, rows = None, np.arange(len(on), dtype=np.int32)
    else:
        at = places.points(sources, "sources", on, empty=True)
        rows = np.where(at[2] == places.ROW, at[3], -1).astype(np.int32)
    with reporting(progress) as report:
        found = _core.local_maps(on._body, at, axis, options, report)
    return LocalMaps(rows, len(on), **found)


class LocalStroke(NamedTuple):
    """The surroundings of a curve, nearest first."""

    rows: np.ndarray  #: (e,) int32
    uv: np.ndarray  #: (e, 2) as of `stroke`, world units
    distance: np.ndarray  #: (e,) from the curve, world units
    points: np.ndarray  #: (k, 3) the curve as drawn, world units
    length: float  #: world units


def local_stroke(surface: Any, points: Any, radius: float, *, closed: bool = False, shape: str = "line", margin: float = 2.0,
                 t_coef: float = 1.0, variant: str = "adaptive", progress: Progress = None) -> LocalStroke:
    """`stroke` within a radius alone: time and memory of what lies there, however large the surface is.

    points, closed, shape : as of `stroke`. radius, margin, t_coef, variant, progress : as of `local_maps`. Distances are those from
        the nearest sample of the curve, which are half an edge apart.

    >>> import ahm
    >>> near = ahm.local_stroke(ahm.shapes.plane(40, 40), [[10, 20, 0], [20, 20, 0]], radius=2.5)
    >>> above = list(near.rows).index(22 * 40 + 15)
    >>> near.uv[above].round(3).tolist(), len(near.rows) < 100
    ([5.0, 2.0], True)

    Raises ValueError naming argument, index and value.
    """
    on = as_body(surface)
    arguments.choice(shape, "shape", ("line", "circle"))
    options = checked(radius=arguments.real(radius, "radius", positive=True), margin=margin, t_coef=t_coef, variant=variant)
    at = places.points(points, "points", on)
    with reporting(progress) as report:
        found, drawn, length = _core.local_stroke(on._body, at, arguments.flag(closed, "closed"), shape == "circle", options,
                                                  report)
    return LocalStroke(found["indices"], found["log"], found["distance"], drawn, length)
