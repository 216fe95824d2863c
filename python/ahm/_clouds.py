"""Point clouds."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._options import checked
from ._progress import Progress, reporting
from ._surfaces import Surface
from .typing import Vector, Matrix


class PointCloud(Surface):
    """Scattered points as a surface: normals, local Delaunay triangulations, tufted Laplacian [SC20].

    points : (n, 3) positions, world units. Equal points share one vertex of the graph.
    normals : (n, 3) normals of any length > 0; None: estimated from the points.
    k : number of neighbors per point; None: 30.
    normal_signs : meaning of the signs of `normals`. "automatic": the majority in each component decides which side is up.
        "oriented": every sign is correct. "unoriented": the signs are ignored.
    smooth : radius of the neighborhoods for smoothing, world units. The points are smoothed before the graph is built; `points`
        returns the input. None: automatic, where the noise exceeds 0.12 of the spacing. 0: no smoothing.
    max_edge_ratio : two points are joined only if their distance is at most this multiple of the distance to the k-th neighbor.
    drop_non_finite : drop points with NaN or infinite coordinates (status `removed`) instead of raising.
    rows : rows to build the surface from, ascending; None: all. The other rows get the status `removed`.
    threads, progress : as in `TriangleMesh`.

    Raises InvalidGeometry (fewer than 3 distinct points, values that are not finite, all points on a line), ResourceExhausted.

    >>> import ahm
    >>> cloud = ahm.PointCloud(ahm.shapes.sphere(3)[0])
    >>> cloud
    <ahm.PointCloud: 642 points>
    """

    def __init__(self, points: Matrix, normals: Optional[Matrix] = None, *, k: Optional[int] = None,
                 normal_signs: str = "automatic", smooth: Optional[float] = None, max_edge_ratio: float = 3.0,
                 drop_non_finite: bool = False, rows: Optional[Vector] = None, threads: int = 0,
                 progress: Progress = None) -> None:
        given = arguments.floats(points, "points", (None, 3))
        self._normals = None
        if normals is not None:
            self._normals = np.array(arguments.floats(normals, "normals", (len(given), 3)))
        self._options = checked(k=k, normal_signs=normal_signs, smooth=smooth, max_edge_ratio=max_edge_ratio,
                                drop_non_finite=drop_non_finite, threads=threads)
        if rows is not None:
            self._options["rows"] = chosen = np.array(arguments.rows(rows, "rows", len(given)))
            if (np.diff(chosen) <= 0).any():
                k = int(np.argmax(np.diff(chosen) <= 0)) + 1
                raise ValueError(f"rows[{k}]: {chosen[k]} follows {chosen[k - 1]}; rows must ascend")
        with reporting(progress) as report:
            self._body = _core.point_cloud(given, self._normals, self._options, report)

    def _state(self) -> tuple:
        return np.array(self.points), self._normals

    def _describe(self) -> str:
        return arguments.counted(len(self), "point") + (", with normals" if self._normals is not None else "")
