"""Point clouds."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._options import checked
from ._progress import Progress, reporting
from ._surfaces import Surface


class PointCloud(Surface):
    """Scattered points as a surface: normals, local Delaunay triangulations, tufted Laplacian [SC20].

    points : (n, 3) positions, world units; equal points share one vertex.
    normals : (n, 3) of any length > 0, or None: estimated.
    k : neighbours per point; None: 30.
    normal_signs : what the signs of given normals mean: "automatic", "oriented" (trusted one by one), "unoriented".
    smooth : the points are smoothed before the graph is built (`points` stay as given). None: where there is noise; 0: not;
        else everywhere, over neighbourhoods of this radius, world units.
    max_edge_ratio : points are joined only up to this multiple of the distance to the k-th neighbour.
    drop_non_finite : leave rows with NaN or infinity out (status `removed`) instead of raising.
    rows : build from these rows only, ascending; the others are `removed`.
    threads, progress : as of `TriangleMesh`.

    Raises InvalidGeometry (fewer than 3 distinct points, values that are not finite, all points on a line), ResourceExhausted.

    >>> import ahm
    >>> cloud = ahm.PointCloud(ahm.shapes.sphere(3)[0])
    >>> cloud
    <ahm.PointCloud: 642 points>
    """

    def __init__(self, points: Any, normals: Any = None, *, k: Optional[int] = None, normal_signs: str = "automatic",
                 smooth: Optional[float] = None, max_edge_ratio: float = 3.0, drop_non_finite: bool = False,
                 rows: Any = None, threads: int = 0, progress: Progress = None) -> None:
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
                raise ValueError(f"rows[{k}]: {chosen[k]} follows {chosen[k - 1]}; they have to ascend")
        with reporting(progress) as report:
            self._body = _core.point_cloud(given, self._normals, self._options, report)

    def _state(self) -> tuple:
        return np.array(self.points), self._normals

    def _describe(self) -> str:
        return f"{len(self)} points" + (", with normals" if self._normals is not None else "")
