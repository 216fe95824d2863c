"""The base class of meshes, clouds, grids and graphs."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from ._pickles import reduced
from .typing import Matrix, SurfaceWarning


class ClosestPoints(NamedTuple):
    """The points of a surface nearest to k positions in space. Returned by `Surface.closest_points`."""

    position: np.ndarray  #: (k, 3) positions of the nearest points, world units
    distance: np.ndarray  #: (k,) distances in space from the nearest points, world units
    face: np.ndarray  #: (k,) int32 faces of the nearest points; -1 on clouds
    barycentric: List[Optional[np.ndarray]]  #: k arrays, one number per corner of the face; None on clouds
    row: np.ndarray  #: (k,) int32 on clouds, the row whose tangent plane contains the point; -1 on meshes


class TangentGraph(NamedTuple):
    """The tangent graph of a surface, by vertices, in compressed rows (docs/concepts/graph_contract.md).

    Lengths are in units of `length_unit`. Returned by `Surface.graph`.
    """

    indptr: np.ndarray  #: (n + 1,) int64 offsets of the edges of every vertex
    indices: np.ndarray  #: (e,) int32 neighbor j of the directed edge i -> j
    weights: np.ndarray  #: (e,) edge weights w_ij
    logs: np.ndarray  #: (e, d) logarithms: position of neighbor j in the frame of i
    transports: np.ndarray  #: (e, 2) (cos, sin), or (e, d, d): from the frame of j to the frame of i
    masses: np.ndarray  #: (n,) masses of the vertices
    frames: Optional[np.ndarray]  #: (n, 4, 3) origin, x axis, y axis and normal in space, world units; None without frames
    length_unit: float  #: length of 1 in these arrays, world units
    vertex_of_row: np.ndarray  #: (rows,) int32 vertex of every row of the input; -1: removed
    row_of_vertex: np.ndarray  #: (n,) int32 row of every vertex; -1: the vertex is not in the input


class Surface:
    """Base class of meshes, clouds, grids and graphs. Immutable; threads can share it.

    Create one with a subclass, `ahm.read` or `ahm.surface`. Its rows are those of the input: the vertices of a mesh or the points
    of a cloud. All results have one entry per row.
    """

    _body: _core.Body
    _options: Dict[str, Any]
    _position_width = 3
    _read_warnings: List[SurfaceWarning] = []  # of the file

    def __len__(self) -> int:
        """Number of rows."""
        return self._body.rows

    @property
    def points(self) -> np.ndarray:
        """(n, 3) positions of the input, world units; a read-only view."""
        return self._body.positions()

    @property
    def dimension(self) -> int:
        """Dimension of the tangent spaces; 2 for surfaces."""
        return self._body.dimension

    @property
    def mean_edge_length(self) -> float:
        """Mean length h of the graph's edges, world units. The diffusion time is tau = t_coef h^2."""
        return self._body.mean_edge_length

    @property
    def normals(self) -> np.ndarray:
        """(n, 3) unit normals, with the orientation that the graph uses; NaN where a row has none."""
        return self._body.normals()

    @property
    def frames(self) -> Optional[np.ndarray]:
        """(n, 3, 3) x axis, y axis and normal of every row in space; NaN where a row was removed. None without frames in space."""
        frames = self._body.frames()
        if frames is None:
            return None
        vertex = self._body.vertex_of_row()
        return np.where((vertex >= 0)[:, None, None], frames[vertex, 1:], np.nan)

    @property
    def report(self) -> Mapping[str, Union[bool, int, float, str]]:
        """Statistics of the construction of the graph, by name."""
        return self._body.report()

    @property
    def warnings(self) -> List[SurfaceWarning]:
        """Problems of the file (`ahm.read`) and of the input: dictionaries with a sentence `text`, and `id`, `numbers`, `rows` and
        `name`.

        The C++ header of each surface lists the ids."""
        return [*self._read_warnings, *self._body.warnings()]

    @property
    def components(self) -> np.ndarray:
        """(n,) int32 number of the connected component of every row, from 0; -1 where a row was removed."""
        vertex = self._body.vertex_of_row()
        return np.where(vertex >= 0, self._body.components()[vertex], -1).astype(np.int32)

    @property
    def graph(self) -> TangentGraph:
        """The tangent graph of the surface, as arrays (copies)."""
        body = self._body
        return TangentGraph(*body.csr(), body.frames(), body.length_unit, body.vertex_of_row(), body.row_of_vertex())

    def closest_points(self, positions: Matrix) -> ClosestPoints:
        """The nearest point of the surface for each of k positions: on the faces of a mesh, or in the tangent planes of a cloud.

        On a cloud, the point lies in the tangent plane of the nearest row.

        positions : (k, 3), world units.

        >>> import ahm
        >>> mesh = ahm.TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> near = mesh.closest_points([[0.25, 0.25, 2.0]])
        >>> near.position.round(9).tolist(), near.distance.tolist()
        ([[0.25, 0.25, 0.0]], [2.0])

        Raises ValueError if a position is not finite.
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
        return reduced(_again, type(self), self._state(), self._options)

    def __copy__(self) -> Surface:
        return self

    def __deepcopy__(self, memo: Any) -> Surface:
        return self

    def __repr__(self) -> str:
        return f"<ahm.{type(self).__name__}: {self._describe()}>"

    def _describe(self) -> str:
        return arguments.counted(len(self), "row")


def _again(type_: type, state: tuple, options: Dict[str, Any]) -> Surface:
    return type_(*state, **options)
