"""The map around every point, within a radius: for learning on surfaces."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._maps import as_body
from ._options import checked
from ._progress import Progress, reporting


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
    sources : (s,) int32 rows.
    """

    def __init__(self, sources: np.ndarray, columns: int, indptr: np.ndarray, indices: np.ndarray, log: np.ndarray,
                 distance: np.ndarray, weight: np.ndarray, transport: np.ndarray) -> None:
        self.sources, self.columns = sources, columns
        self.indptr, self.indices, self.log = indptr, indices, log
        self.distance, self.weight, self.transport = distance, weight, transport

    def csr(self, values: Any = "distance") -> Any:
        """A scipy.sparse.csr_matrix, sources x rows, over the arrays themselves.

        values : "distance", "weight", "u", "v", "transport" (complex), or (e,) numbers of your own.
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
        if values.shape != self.indices.shape:
            raise ValueError(f"values: shape ({len(self.indices)},) is needed, not {values.shape}")
        result = csr_matrix((len(self.sources), self.columns), dtype=values.dtype)
        result.data, result.indices, result.indptr = values, self.indices, self.indptr
        return result

    def padded(self, k: Optional[int] = None, dtype: Any = np.float32) -> PaddedMaps:
        """The k nearest entries of every source; None: as many as the longest has. For torch: `torch.from_numpy(p.log)`."""
        counts = np.diff(self.indptr)
        k = int(counts.max(initial=0)) if k is None else arguments.integer(k, "k", 1)
        place = np.arange(len(self.indices)) - np.repeat(self.indptr[:-1], counts)
        source = np.repeat(np.arange(len(counts)), counts)
        if counts.max(initial=0) > k:
            source, kept = source[place < k], place < k
            place = place[kept]
        else:
            kept = slice(None)

        def spread(values: np.ndarray, dtype: Any) -> np.ndarray:
            result = np.zeros((len(counts), k) + values.shape[1:], dtype)
            result[source, place] = values[kept]
            return result

        return PaddedMaps(spread(self.indices, np.int32), spread(np.ones(len(self.indices), bool), bool),
                          *(spread(x, dtype) for x in (self.log, self.distance, self.weight, self.transport)))

    def __len__(self) -> int:
        """Number of sources."""
        return len(self.sources)

    def __repr__(self) -> str:
        return f"<ahm.LocalMaps: {len(self)} sources, {len(self.indices)} entries>"


def local_maps(surface: Any, radius: Optional[float] = None, k: Optional[int] = None, *, sources: Any = None, margin: float = 2.0,
               t_coef: float = 1.0, variant: str = "adaptive", threads: int = 0, progress: Progress = None) -> LocalMaps:
    """The log map around every row, or around `sources`, of everything within a radius or of the k nearest rows.

    radius : world units, > 0; None, with k: as far as those are.
    k : keep only so many nearest entries per source, the source itself included; None: all within the radius.
    sources : (s,) rows; None: all rows, of which those without a vertex have no entries.
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
    rows = None if sources is None else arguments.rows(sources, "sources", len(on))
    with reporting(progress) as report:
        found = _core.local_maps(on._body, rows, options, report)
    return LocalMaps(np.arange(len(on), dtype=np.int32) if rows is None else rows, len(on), **found)
