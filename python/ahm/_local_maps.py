"""Log maps around every point, within a radius: for learning on surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import DTypeLike

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._pickles import reduced
from ._progress import Progress, reporting
from ._solvers import ExactGeodesics, LogMapSolver, PolarMapSolver, as_body
from .typing import Source, Sources, SurfaceLike, Vector

if TYPE_CHECKING:
    from scipy.sparse import coo_matrix, csr_matrix


class PaddedMaps(NamedTuple):
    """Local maps as arrays with k entries per source, nearest first. Missing entries are 0. Returned by `LocalMaps.padded`."""

    indices: np.ndarray  #: (s, k) int32 rows of the neighbors
    mask: np.ndarray  #: (s, k) bool, False for missing entries
    log: np.ndarray  #: (s, k, d) coordinates of the neighbors in the source's frame, world units
    distance: np.ndarray  #: (s, k) geodesic distances of the neighbors from the source, world units
    weight: np.ndarray  #: (s, k) masses of the neighbors, world units to the power d
    transport: Optional[np.ndarray]  #: (s, k, 2) (cos, sin), or (s, k, d, d): from the source's frame to the neighbor's
    quality: Optional[np.ndarray]  #: (s, k) how reliable `log` is, in (0, 1]


class LocalMaps:
    """Local maps in compressed rows. Returned by `local_maps`.

    Source s has the entries indptr[s] : indptr[s + 1], one per neighbor, nearest first. A source that is a row
    is its own first neighbor.

    indptr : (s + 1,) int64 offsets of the sources in the other arrays.
    indices : (e,) int32 rows of the neighbors.
    log : (e, d) coordinates of the neighbors in the source's frame, world units.
    distance : (e,) geodesic distances of the neighbors from the source, as `LogMap.distance`, world units.
    weight : (e,) masses of the neighbors, for integration, world units to the power d.
    transport : (e, 2) (cos, sin), or (e, d, d): takes components in the source's frame to components in the neighbor's frame.
        `transport.view(complex)[:, 0]` are complex numbers, without a copy. None if the maps were made without.
    quality : (e,) how reliable `log` is, in (0, 1], as `LogMap.quality`; low next to the cut locus and on noise. None if the maps were
        made without. By heat, only edges that the map stretches and the difference of |log| and the distance count.
    sources : (s,) int32 rows of the sources; -1 for sources that are not rows.
    columns : number of rows of the surface.
    method : "polar" or "heat".

    >>> import ahm
    >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0, sources=[40, 0])
    >>> maps, sorted(maps.indices[maps.indptr[1] : maps.indptr[2]].tolist())
    (<ahm.LocalMaps: 2 sources, 8 entries>, [0, 1, 9])
    """

    def __init__(self, sources: np.ndarray, columns: int, indptr: np.ndarray, indices: np.ndarray, log: np.ndarray,
                 distance: np.ndarray, weight: np.ndarray, transport: Optional[np.ndarray], method: str,
                 quality: Optional[np.ndarray] = None) -> None:
        self.sources, self.columns, self.method, self.quality = sources, columns, method, quality
        self.indptr, self.indices, self.log = indptr, indices, log
        self.distance, self.weight, self.transport = distance, weight, transport

    def csr(self, values: Union[str, Vector] = "distance") -> csr_matrix:
        """One value per entry as a scipy.sparse.csr_matrix of shape (sources, rows). Its arrays are copies.

        The columns of a matrix row are in order of distance, not sorted.

        values : "distance", "weight", "u", "v", "quality", "transport" (complex), or an array of (e,) numbers.

        >>> import ahm
        >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0)
        >>> maps.csr().shape, round(float(maps.csr("weight")[40].sum()), 9)
        ((81, 81), 5.0)

        Raises ValueError for any other `values`; ImportError without scipy.
        """
        from scipy.sparse import csr_matrix

        entries = self._named(values) if isinstance(values, str) else np.asarray(values)
        if entries.dtype.kind not in "biufc":
            raise TypeError(f"values: expected numbers, got {arguments.describe(values, entries)}")
        if entries.shape != self.indices.shape:
            raise ValueError(f"values: expected shape ({len(self.indices)},), got {entries.shape}")
        # scipy requires one type for both index arrays, and modifies them in place.
        index = np.int32 if len(self.indices) <= np.iinfo(np.int32).max else np.int64
        result = csr_matrix((len(self.sources), self.columns), dtype=entries.dtype)
        result.data, result.indices, result.indptr = entries.copy(), self.indices.astype(index), self.indptr.astype(index)
        return result

    def coo(self, values: Union[str, Vector] = "distance") -> coo_matrix:
        """One value per entry as a scipy.sparse.coo_matrix of shape (sources, rows). Arguments and errors as in `csr`.

        >>> import ahm
        >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0)
        >>> matrix = maps.coo("u")
        >>> matrix.row[:3].tolist(), sorted(matrix.col[:3].tolist())
        ([0, 0, 0], [0, 1, 9])
        """
        return self.csr(values).tocoo()

    def edge_index(self) -> np.ndarray:
        """(2, e) int64 edges of a graph for message passing, as in PyTorch Geometric: from the neighbor, row 0, to the source, row 1.

        Column e is entry e: `log[e]` are the coordinates of row `edge_index[0, e]` in the frame of row `edge_index[1, e]`.

        >>> import ahm
        >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0, sources=[40])
        >>> edges = maps.edge_index()
        >>> edges.shape, edges[:, 0].tolist()
        ((2, 5), [40, 40])

        Raises ValueError if a source is not a row.
        """
        if np.any(self.sources < 0):
            raise ValueError(f"sources[{int(np.argmax(self.sources < 0))}]: not a row; an edge needs a row at both ends")
        result = np.empty((2, len(self.indices)), np.int64)
        result[0] = self.indices
        result[1] = np.repeat(self.sources, np.diff(self.indptr))
        return result

    def _named(self, values: str) -> np.ndarray:
        arguments.choice(values, "values", ("distance", "weight", "u", "v", "quality", "transport"))
        if values in "uv":
            return self.log[:, "uv".index(values)]
        if values == "transport":
            if self.transport is None:
                raise ValueError("values: 'transport' is missing; make the maps with transport=True")
            if self.transport.ndim != 2:
                raise ValueError("values: 'transport' requires rotations of the plane; these transports are matrices")
            return self.transport[:, 0] + 1j * self.transport[:, 1]
        if values == "quality" and self.quality is None:
            raise ValueError("values: 'quality' is missing; make the maps with quality=True")
        return getattr(self, values)

    def padded(self, k: Optional[int] = None, dtype: DTypeLike = np.float32) -> PaddedMaps:
        """Arrays of equal length for every source, for example for torch: `torch.from_numpy(p.log)`.

        k : number of entries per source, the nearest ones; None: the largest number of entries of any source.
        dtype : floating-point type of the result, except for indices and mask.

        >>> import ahm
        >>> p = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.0).padded(4)
        >>> sorted(p.indices[0].tolist()), p.mask[0].tolist(), p.log.dtype
        ([0, 0, 1, 9], [True, True, True, False], dtype('float32'))

        Raises ValueError (k < 1; a dtype that is not floating-point).
        """
        try:
            dtype = np.dtype(dtype)
        except TypeError:
            raise TypeError(f"dtype: {dtype!r:.60} is not a numeric type") from None
        if dtype.kind != "f":
            raise ValueError(f"dtype: {dtype} cannot hold coordinates; use a floating-point type")
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
                          spread(self.log, dtype), spread(self.distance, dtype), spread(self.weight, dtype),
                          None if self.transport is None else spread(self.transport, dtype),
                          None if self.quality is None else spread(self.quality, dtype))

    def __len__(self) -> int:
        """Number of sources."""
        return len(self.sources)

    def __reduce__(self) -> tuple:
        return reduced(LocalMaps, self.sources, self.columns, self.indptr, self.indices, self.log, self.distance, self.weight,
                       self.transport, self.method, self.quality)

    def __repr__(self) -> str:
        return f"<ahm.LocalMaps: {arguments.counted(len(self), 'source')}, {arguments.counted(len(self.indices), 'entry')}>"


def local_maps(surface: SurfaceLike, radius: Optional[float] = None, k: Optional[int] = None, *,
               sources: Optional[Sources] = None, u_axis: Optional[Vector] = None, method: str = "auto", transport: bool = True,
               quality: bool = False, margin: Optional[float] = None, t_coef: Optional[float] = None, variant: Optional[str] = None, threads: int = 0,
               progress: Progress = None) -> LocalMaps:
    """Log maps within a radius, or of the k nearest rows, around every row or around `sources`.

    Time and memory depend only on the size of these neighborhoods. The polar method first prepares the whole surface; for several
    calls pass a `PolarMapSolver` or a `SurfaceSolver`.

    surface : a `Surface`, a solver, or what `ahm.surface` takes.
    radius : radius of the maps, > 0, world units; None: large enough for k entries.
    k : maximum number of entries per source, the source included; the nearest ones are kept. None: all within the radius.
    sources : points: rows, positions, `(faces, barycentric)`, `(edges, t)`. None: all rows; rows without a vertex get no entries.
    u_axis : (3,) vector in space, projected to the surface at every source. Requires `sources`. None: as in
        `LogMapSolver.log_map`.
    method : "polar": lengths and directions of shortest paths, by exact windows and small fronts. "heat": the affine heat method,
        smooth on noisy clouds. "auto" (default): the method of a solver, otherwise "polar" for k up to 16, on meshes and on clouds with
        little noise, and "heat" elsewhere; also "heat" if margin, t_coef or variant is set.
    transport : False: without `LocalMaps.transport`, to save memory.
    quality : True: with `LocalMaps.quality`. On clouds, polar maps then take twice the time.
    margin : heat: width of the margin of each patch beyond the radius, in units of sqrt(tau); None: 2. A larger margin is more
        accurate.
    t_coef, variant : heat: as in `LogMapSolver`; None: 1 and "adaptive".
    threads, progress : as in `LogMapSolver`.

    >>> import ahm
    >>> maps = ahm.local_maps(ahm.shapes.plane(9, 9), radius=1.5, k=9)
    >>> neighbors = maps.indices[maps.indptr[40] : maps.indptr[41]]
    >>> sorted(neighbors.tolist())
    [30, 31, 32, 39, 40, 41, 48, 49, 50]
    >>> maps.csr().shape, maps.padded().log.shape
    ((81, 81), (81, 9, 2))

    Raises ValueError naming the argument; NotPositiveDefinite, ResourceExhausted.
    """
    on = as_body(surface)
    if radius is None and k is None:
        raise ValueError("radius: missing; pass a radius or k")
    if radius is not None:
        radius = arguments.real(radius, "radius", positive=True)
    of_heat = checked(margin=margin, t_coef=t_coef, variant=variant)
    options = dict(checked(radius=radius, k=k, threads=threads, transport=transport, quality=quality), method=_method(surface, method, k, of_heat),
                   **of_heat)
    axis = arguments.vector(u_axis, "u_axis")
    if sources is None:
        if axis is not None:
            raise ValueError("u_axis: requires `sources`")
        at, rows = None, np.arange(len(on), dtype=np.int32)
    else:
        at = places.points(sources, "sources", on, empty=True)
        rows = np.where(at[2] == places.ROW, at[3], -1).astype(np.int32)
    solver: Any = getattr(surface, "_solver", surface)
    prepared = isinstance(solver, PolarMapSolver) and options["method"] == "polar"
    with reporting(progress) as report:
        found = _core.local_maps(solver._core if prepared else on._body, at, axis, options, report)
    return LocalMaps(rows, len(on), **found, method=options["method"])


def _method(surface: Any, method: str, k: Optional[int], of_heat: Dict[str, Any]) -> str:
    """The method of local maps.

    of_heat : the options of the heat method that were given.
    """
    arguments.choice(method, "method", ("auto", "polar", "heat"))
    if of_heat and method == "polar":
        raise TypeError(f"{min(of_heat)}: method 'polar' has no such option")
    if method != "auto":
        return method
    solver = getattr(surface, "_solver", surface)
    if of_heat or isinstance(solver, LogMapSolver):
        return "heat"
    if isinstance(solver, (PolarMapSolver, ExactGeodesics)):
        return "polar"
    return _core.choose_method(as_body(surface)._body, k or 0)


class LocalStroke(NamedTuple):
    """The log map from a curve, for the rows within a radius of it, nearest first. Returned by `local_stroke`."""

    rows: np.ndarray  #: (e,) int32 rows within the radius
    uv: np.ndarray  #: (e, 2) coordinates of these rows along and across the curve, as in `stroke`, world units
    distance: np.ndarray  #: (e,) distances of these rows from the nearest sample of the curve, world units
    points: np.ndarray  #: (k, 3) corners of the curve on the surface, world units
    length: float  #: length of the curve, world units


def local_stroke(surface: SurfaceLike, points: Sources, radius: float, *, closed: bool = False, shape: str = "line",
                 margin: float = 2.0, t_coef: float = 1.0, variant: str = "adaptive", progress: Progress = None) -> LocalStroke:
    """Coordinates along a curve, for the rows within a radius only.

    Time and memory depend only on the size of this neighborhood. Distances are measured from the nearest sample of the curve;
    samples are half an edge apart.

    surface, radius, margin, t_coef, variant, progress : as in `local_maps` by heat.
    points, closed, shape : as in `stroke`.

    >>> import ahm
    >>> near = ahm.local_stroke(ahm.shapes.plane(40, 40), [[10, 20, 0], [20, 20, 0]], radius=2.5)
    >>> above = list(near.rows).index(22 * 40 + 15)
    >>> near.uv[above].round(3).tolist(), len(near.rows) < 100
    ([5.0, 2.0], True)

    Raises ValueError naming the argument, the index and the value.
    """
    on = as_body(surface)
    arguments.choice(shape, "shape", ("line", "circle"))
    options = checked(radius=arguments.real(radius, "radius", positive=True), margin=margin, t_coef=t_coef, variant=variant)
    at = places.points(points, "points", on)
    with reporting(progress) as report:
        found, drawn, length = _core.local_stroke(on._body, at, arguments.flag(closed, "closed"), shape == "circle", options,
                                                  report)
    return LocalStroke(found["indices"], found["log"], found["distance"], drawn, length)
