"""Local Delaunay triangulations of a point cloud, with the signature of potpourri3d."""

from __future__ import annotations

from typing import List

import numpy as np

from ._clouds import PointCloud
from ._curve_distances import OnSurface
from .typing import Matrix


class PointCloudLocalTriangulation(OnSurface):
    """The Delaunay triangles of every point and its 30 nearest neighbors in its tangent plane, computed for each point separately.

    with_degeneracy_heuristic : has no effect.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> triangles = pp3d.PointCloudLocalTriangulation(ahm.shapes.plane(9, 9)[0]).get_local_triangulation()
    >>> triangles.shape[2], bool((triangles[40, :4, 0] == 40).all())
    (3, True)

    Raises ValueError (an invalid cloud, as `ahm.PointCloud`); ImportError without scipy.
    """

    def __init__(self, P: Matrix, with_degeneracy_heuristic: bool = True) -> None:
        self.surface = PointCloud(P, smooth=0)

    def get_local_triangulation(self) -> np.ndarray:
        """(n, m, 3) int64 triangles: row i has those at point i, counter-clockwise seen from the side of its normal, beginning
        with i. Missing ones are -1."""
        from scipy.spatial import Delaunay, QhullError, cKDTree

        points, frames = self.surface.points, self.surface.frames
        assert frames is not None
        count = min(31, len(points))
        near = cKDTree(points).query(points, count)[1]
        found: List[np.ndarray] = []
        for row, others in enumerate(near):
            rows = np.append(row, others[others != row][: count - 1])
            try:
                triangles = Delaunay((points[rows] - points[row]) @ frames[row, :2].T).simplices
            except (QhullError, ValueError):  # points on a line, or a removed point without a frame
                triangles = np.empty((0, 3), int)
            own = triangles[(triangles == 0).any(axis=1)]
            turn = (np.argmax(own == 0, axis=1)[:, None] + np.arange(3)) % 3
            found.append(rows[np.take_along_axis(own, turn, axis=1)])
        result = np.full((len(points), max(map(len, found)), 3), -1)
        for row, own in enumerate(found):
            result[row, : len(own)] = own
        return result
