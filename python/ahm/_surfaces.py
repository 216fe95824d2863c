"""What maps are made on: what surfaces, grids and graphs have in common."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional

import numpy as np

from . import _arguments as arguments
from . import _core


class ClosestPoints(NamedTuple):
    """Points of a surface nearest to positions in space; k of them."""

    position: np.ndarray  #: (k, 3), world units
    distance: np.ndarray  #: (k,), in space
    face: np.ndarray  #: (k,) int32; -1 of a cloud
    barycentric: List[Optional[np.ndarray]]  #: one number per corner of the face; None of a cloud
    row: np.ndarray  #: (k,) int32, of a cloud: the row in whose tangent plane the point lies; else -1


class TangentGraph(NamedTuple):
    """The graph under a surface, by vertices: arrays in compressed rows, in units of `length_unit` (docs/concepts/graph_contract.md)."""

    indptr: np.ndarray  #: (n + 1,) int64
    indices: np.ndarray  #: (e,) int32: the neighbour j of edge i -> j
    weights: np.ndarray  #: (e,) w_ij
    logs: np.ndarray  #: (e, d): where j lies, seen from i, in the frame of i
    transports: np.ndarray  #: (e, 2) (cos, sin), or (e, d, d): from the frame of j to that of i
    masses: np.ndarray  #: (n,)
    frames: Optional[np.ndarray]  #: (n, 4, 3): origin, x, y, normal in space, world units; None without
    length_unit: float
    vertex_of_row: np.ndarray  #: (rows,) int32; -1: removed
    row_of_vertex: np.ndarray  #: (n,) int32; -1: a vertex that the input does not have


class Surface:
    """What maps are made on. Immutable, and shared by threads; made by its subclasses, `ahm.read` and `ahm.surface`.

    Its rows are those of the input: vertices of a mesh, points of a cloud. All results have one entry per row.
    """

    _body: _core.Body
    _options: Dict[str, Any]
    _position_width = 3

    def __len__(self) -> int:
        """Number of rows."""
        return self._body.rows

    @property
    def points(self) -> np.ndarray:
        """(n, 3) positions as given, world units; read-only, not a copy."""
        return self._body.positions()

    @property
    def dimension(self) -> int:
        """Of the tangent spaces: 2 of surfaces."""
        return self._body.dimension

    @property
    def mean_edge_length(self) -> float:
        """Mean length h of the graph's edges, world units: the scale of the diffusion, tau = t_coef h^2."""
        return self._body.mean_edge_length

    @property
    def normals(self) -> np.ndarray:
        """(n, 3) unit normals as the graph uses them; NaN where a row has none."""
        return self._body.normals()

    @property
    def frames(self) -> Optional[np.ndarray]:
        """(n, 3, 3) tangent axes x, y and the normal of every row, in space; NaN where a row was removed. None without."""
        frames = self._body.frames()
        if frames is None:
            return None
        vertex = self._body.vertex_of_row()
        return np.where((vertex >= 0)[:, None, None], frames[vertex, 1:], np.nan)

    @property
    def report(self) -> Dict[str, Any]:
        """What was found and done while the graph was built, by name."""
        return self._body.report()

    @property
    def warnings(self) -> List[Dict[str, Any]]:
        """What one should know: dictionaries with `text`, a sentence, and `id`, `numbers`, `rows` and `name`, as listed in the C++
        headers."""
        return self._body.warnings()

    @property
    def components(self) -> np.ndarray:
        """(n,) int32 number of the connected component of every row; -1 where a row was removed."""
        vertex = self._body.vertex_of_row()
        return np.where(vertex >= 0, self._body.components()[vertex], -1).astype(np.int32)

    @property
    def graph(self) -> TangentGraph:
        """The graph itself, as arrays (copies)."""
        body = self._body
        return TangentGraph(*body.csr(), body.frames(), body.length_unit, body.vertex_of_row(), body.row_of_vertex())

    def closest_points(self, positions: Any) -> ClosestPoints:
        """The nearest points of the faces; of a cloud, of the tangent plane of the nearest row.

        positions : (k, 3), world units.

        >>> import ahm
        >>> mesh = ahm.TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> near = mesh.closest_points([[0.25, 0.25, 2.0]])
        >>> near.position.round(9).tolist(), near.distance.tolist()
        ([[0.25, 0.25, 0.0]], [2.0])

        Raises ValueError where a position is not finite.
        """
        given = arguments.floats(positions, "positions", (None, 3), finite=True)
        face, row, weights, place, distance = self._body.closest_points(given, None)
        return ClosestPoints(place, distance, face, weights, row)

    @property
    def _face_count(self) -> int:
        return 0

    _all_triangles = False

    def _corner_count(self, face: int) -> int:
        return 3

    def _state(self) -> tuple:
        raise NotImplementedError

    def __reduce__(self) -> tuple:
        return rebuild, (type(self), self._state(), self._options)

    def __copy__(self) -> Surface:
        return self

    def __deepcopy__(self, memo: Any) -> Surface:
        return self

    def __repr__(self) -> str:
        return f"<ahm.{type(self).__name__}: {self._describe()}>"

    def _describe(self) -> str:
        return f"{len(self)} rows"


def rebuild(type_: type, state: tuple, options: Dict[str, Any]) -> Surface:
    return type_(*state, **options)
