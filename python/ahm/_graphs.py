"""Regular grids, and user-defined tangent graphs."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from ._surfaces import Surface
from .typing import Array, Matrix, Vector


class Grid(Surface):
    """A regular grid in the plane or in space, with or without obstacles. The row number changes fastest along the first axis.

    shape : number of vertices along each axis, 2 or 3 numbers >= 2.
    spacing : edge length along each axis, or one number for all axes; > 0, world units.
    origin : position of row 0, world units; None: zero.
    blocked : bool array of shape (shape[0] - 1, shape[1] - 1, ...), True for cells inside obstacles; None: no obstacles.

    Raises InvalidGeometry, ResourceExhausted.

    >>> import ahm
    >>> grid = ahm.Grid((5, 4), 0.5)
    >>> ahm.log_map(grid, 0).uv[grid.row((3, 2))].round(9).tolist()
    [1.5, 1.0]
    """

    def __init__(self, shape: Vector, spacing: Union[float, Vector] = 1.0, origin: Optional[Vector] = None,
                 blocked: Union[None, Array, Sequence[Sequence[bool]], Sequence[Sequence[Sequence[bool]]]] = None) -> None:
        self._shape = arguments.integers(shape, "shape", 1)
        d = len(self._shape)
        if np.ndim(spacing) == 0 and not isinstance(spacing, (str, bytes, bool)):
            spacing = [arguments.real(spacing, "spacing")] * d
        self._spacing = np.array(arguments.floats(spacing, "spacing", (d,)))
        self._origin = np.array(arguments.floats([0.0] * d if origin is None else origin, "origin", (d,)))
        self._blocked = np.empty(0, np.uint8)
        if blocked is not None:
            cells = np.asarray(blocked)
            if cells.dtype.kind not in "biu" or cells.shape != tuple(self._shape - 1):
                raise ValueError(f"blocked: expected a bool array of shape {tuple(int(s) for s in self._shape - 1)}, got "
                                 f"{arguments.describe(blocked, cells)}")
            self._blocked = np.ascontiguousarray((cells != 0).ravel(order="F"), np.uint8)
        self._options = {}
        self._body = _core.grid(self._shape, self._spacing, self._origin, self._blocked)

    @property
    def _position_width(self) -> int:  # type: ignore[override]
        return len(self._shape)

    @property
    def shape(self) -> Tuple[int, ...]:
        """Number of vertices along each axis. `x.reshape(grid.shape, order="F")` is a result `x` as an array over the grid."""
        return tuple(int(s) for s in self._shape)

    def row(self, steps: Vector) -> int:
        """The row of the vertex at `steps`, its integer coordinates along the axes. Raises ValueError outside the grid.

        >>> import ahm
        >>> ahm.Grid((5, 4)).row((3, 2))
        13
        """
        at = arguments.integers(steps, "steps", 1)
        if at.shape != self._shape.shape or (at < 0).any() or (at >= self._shape).any():
            raise ValueError(f"steps: {at.tolist()} is outside the grid of shape {self.shape}")
        return int(np.ravel_multi_index(tuple(at), self.shape, order="F"))

    def _state(self) -> tuple:
        cells = self._blocked.reshape(self._shape - 1, order="F").astype(bool) if len(self._blocked) else None
        return self._shape, self._spacing, self._origin, cells

    def _describe(self) -> str:
        return " x ".join(str(s) for s in self.shape) + " vertices"


class Graph(Surface):
    """A user-defined tangent graph with tangent spaces R^d, in compressed rows (docs/concepts/graph_contract.md).

    indptr : (n + 1,) integers: vertex i has the directed edges indptr[i] : indptr[i + 1].
    indices : (e,) neighbor j of every directed edge i -> j. The reverse of every edge is an edge, too.
    weights : (e,) edge weights w_ij = w_ji.
    logs : (e, d) logarithms: position of neighbor j in the frame of i, in units of `length_unit`.
    transports : (e, 2) (cos, sin), or (e,) complex, both for d = 2; or (e, d, d). They take components in the frame of j to
        components in the frame of i.
    masses : (n,) dual areas or volumes, > 0, in units of `length_unit` to the power d.
    frames : (n, 4, 3) origin, x axis, y axis and normal of every vertex in space, world units; or None.
    mean_edge_length : in units of `length_unit`; None: the mean of |logs|.
    length_unit : length of 1 in `logs` and `mean_edge_length`, a power of two, world units. Results are in world units.
    is_delaunay : whether the graph is that of a Delaunay triangulation, d = 2. Distances are then computed by a wavefront.

    Raises InvalidGraph (a ValueError) naming the first violation of the graph contract, with its vertex or edge.

    >>> import ahm, numpy as np
    >>> line = ahm.Graph([0, 1, 3, 4], [1, 0, 2, 1], weights=np.ones(4), logs=[[1], [-1], [1], [-1]],
    ...                  transports=np.ones((4, 1, 1)), masses=[0.5, 1, 0.5])
    >>> ahm.log_map(line, 0).uv.ravel().round(9).tolist()
    [0.0, 1.0, 2.0]
    """

    def __init__(self, indptr: Vector, indices: Vector, weights: Vector, logs: Matrix, transports: Union[Vector, Matrix],
                 masses: Vector, *, frames: Union[None, Array, Sequence[Matrix]] = None,
                 mean_edge_length: Optional[float] = None, length_unit: float = 1.0,
                 is_delaunay: bool = False) -> None:
        begin = arguments.integers(indptr, "indptr", 1, 0, 2**62, np.int64)
        neighbors = arguments.integers(indices, "indices", 1)
        e, n = len(neighbors), len(begin) - 1
        if n < 1 or begin[0] != 0 or begin[-1] != e or (np.diff(begin) < 0).any():
            raise ValueError(f"indptr: must ascend from 0 to {e}, the length of `indices`")
        outside = (neighbors < 0) | (neighbors >= n)
        if outside.any():
            k = int(np.argmax(outside))
            raise ValueError(f"indices[{k}]: {neighbors[k]} is out of range; there are {n} vertices, counted from 0")
        edges = arguments.floats(logs, "logs", (e, None), finite=True)
        d = edges.shape[1]
        if d < 1:
            raise ValueError(f"logs: expected shape ({e}, d) with d >= 1, got {edges.shape}")
        if isinstance(transports, (list, tuple)):
            transports = _listed(transports)
        if np.iscomplexobj(transports):
            given = np.ascontiguousarray(transports, np.complex128)
            turns = arguments.floats(given.reshape(-1).view(np.float64).reshape(-1, 2), "transports", (e, 2))
        elif np.ndim(transports) == 2:
            turns = arguments.floats(transports, "transports", (e, 2), finite=True)
        else:
            turns = arguments.floats(transports, "transports", (e, d, d), finite=True)
        if turns.ndim == 2 and d != 2:
            raise ValueError(f"transports: (cos, sin) requires logs of shape (e, 2), got (e, {d})")
        unit = arguments.real(length_unit, "length_unit", positive=True)
        if np.frexp(unit)[0] != 0.5:
            raise ValueError(f"length_unit: {unit} is not a power of two")
        self._options = {"length_unit": unit,
                         "is_delaunay": arguments.flag(is_delaunay, "is_delaunay")}
        if mean_edge_length is not None:
            self._options["mean_edge_length"] = arguments.real(mean_edge_length, "mean_edge_length", positive=True)
        if frames is not None:
            self._options["frames"] = np.array(arguments.floats(frames, "frames", (n, 4, 3), finite=True))
            self._options["frames"].flags.writeable = False
        self._body = _core.graph(begin, neighbors, arguments.floats(weights, "weights", (e,), finite=True), edges, turns,
                                 arguments.floats(masses, "masses", (n,), finite=True), self._options)

    def _state(self) -> tuple:
        return tuple(self._body.csr())

    @property
    def points(self) -> Optional[np.ndarray]:  # type: ignore[override]
        """(n, 3) origins of the frames, world units; None without frames."""
        frames = self._options.get("frames")
        return None if frames is None else frames[:, 0]

    def _describe(self) -> str:
        return f"{arguments.counted(len(self), 'vertex')}, {arguments.counted(self._body.edge_count, 'edge')}, dimension {self.dimension}"


def _listed(transports: Any) -> np.ndarray:
    try:
        return np.asarray(transports)
    except ValueError as error:
        raise ValueError(f"transports: not an array of numbers ({error})") from None
