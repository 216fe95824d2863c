"""Distances from points and curves on triangle meshes, with the signatures of potpourri3d."""

from __future__ import annotations

from functools import cached_property
from typing import Any, List, Optional, Sequence, SupportsIndex, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _places as places
from ._applications import stroke
from ._fields import distance
from ._mesh_arrays import edges_and_sides
from ._meshes import TriangleMesh
from ._solvers import ExactGeodesics, LogMapSolver
from ._surfaces import Surface
from .typing import Array, Faces, Matrix, Source, Vector

CurvePoint = Union[SupportsIndex, Tuple[SupportsIndex], Tuple[SupportsIndex, Vector]]
Curves = Sequence[Union[Array, Sequence[CurvePoint]]]


class OnSurface:
    """A surface, and checks of rows and curves on it."""

    surface: Surface

    def _row(self, value: SupportsIndex, name: str) -> int:
        return arguments.row(value, name, len(self.surface))

    def _rows(self, values: Vector, name: str) -> np.ndarray:
        return arguments.rows(values, name, len(self.surface))

    def __repr__(self) -> str:
        return f"<ahm.potpourri3d.{type(self).__name__}: on {self.surface!r}>"

    @cached_property
    def _edges(self) -> np.ndarray:
        return edges_and_sides(np.asarray(self.surface.faces))[0]  # type: ignore[attr-defined]

    def _point(self, value: Any, name: str) -> Source:
        """A point of a curve in the form that `ahm` accepts."""
        if places.is_row(value):
            return self._row(value, name)
        index, weights = value if len(value) == 2 else (value[0], [])
        given = arguments.floats(weights, name, (None,), finite=True)
        if len(given) == 0:
            return self._row(index, name)
        if len(given) == 1:
            return tuple(self._edges[arguments.integer(index, name, 0, len(self._edges) - 1)]), float(given[0])
        return index, given if len(given) > 2 else np.append(given, 1 - given.sum())

    def _curves(self, curves: Any) -> List[List[Source]]:
        return [[self._point(p, f"curves[{k}][{i}]") for i, p in enumerate(curve)] for k, curve in enumerate(curves)]

    def _distance_from_curves(self, solver: Union[LogMapSolver, ExactGeodesics], curves: List[List[Source]],
                              signed: Sequence[bool]) -> np.ndarray:
        """Distance from the nearest of several curves; from signed curves positive on their left. NaN without curves."""
        result = np.full(len(self.surface), np.nan)
        for curve, has_sign in zip(curves, signed):
            closed = len(curve) > 3 and _same(curve[0], curve[-1])
            if len(curve) == 1:
                found = distance(self.surface, curve)
            else:
                m = stroke(solver, curve[:-1] if closed else curve, closed=closed).map
                found = np.where((m.uv[:, 1] < 0) & has_sign, -m.distance, m.distance)
            result = nearer(result, found)
        return result


def _same(a: Source, b: Source) -> bool:
    """Whether two results of `OnSurface._point` are equal."""
    if places.is_row(a) or places.is_row(b):
        return bool(places.is_row(a) and places.is_row(b) and a == b)
    return np.array_equal(a[0], b[0]) and np.array_equal(a[1], b[1])  # type: ignore[index, arg-type]


def nearer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(a) | (abs(b) < abs(a)), b, a)


def only_zero_set(level_set_constraint: str, preserve_source_normals: bool = False, soft_level_set_weight: float = -1) -> None:
    if level_set_constraint.lower() != "zeroset" or preserve_source_normals or soft_level_set_weight >= 0:
        raise NotImplementedError("level_set_constraint, preserve_source_normals, soft_level_set_weight: only the defaults are "
                                  "supported; each curve is the zero set of its distance, as in `ahm.stroke`")


class MeshFastMarchingDistanceSolver(OnSurface):
    """Geodesic distance from points and curves on a triangle mesh, by a wavefront or exactly, not by fast marching.

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshFastMarchingDistanceSolver(*ahm.shapes.plane(4, 3))
    >>> solver.compute_distance([[4, 7]], sign=True)[[0, 8]].round(9).tolist()
    [-1.0, 1.0]

    Raises ValueError (an invalid mesh, as `ahm.TriangleMesh`; an invalid point of a curve), NotImplementedError (initial distances
    other than 0).
    """

    def __init__(self, V: Matrix, F: Faces) -> None:
        self.surface = TriangleMesh(V, F)

    def compute_distance(self, curves: Curves, distances: Sequence[Vector] = (), sign: bool = False) -> np.ndarray:
        """(n,) distances from the points of all curves, by a wavefront. With `sign` exact from the curves, positive on their left."""
        if any(np.any(np.asarray(initial) != 0) for initial in distances):
            raise NotImplementedError("distances: initial distances other than 0 are not supported; compute each source separately "
                                      "and add its distance")
        given = self._curves(curves)
        if sign:
            return self._distance_from_curves(ExactGeodesics(self.surface), given, [True] * len(given))
        return distance(self.surface, [point for curve in given for point in curve])


class MeshSignedHeatSolver(OnSurface):
    """Signed distance from curves on a triangle mesh (`ahm.stroke`, by the heat method).

    >>> import ahm, ahm.potpourri3d as pp3d
    >>> solver = pp3d.MeshSignedHeatSolver(*ahm.shapes.plane(4, 3))
    >>> solver.compute_distance([[(4, []), (7, [])]])[[0, 8]].round(9).tolist()
    [-1.0, 1.0]

    Raises ValueError (an invalid mesh, as `ahm.TriangleMesh`; an invalid point of a curve), NotImplementedError (options of the
    level sets other than the defaults).
    """

    def __init__(self, V: Matrix, F: Faces, t_coef: float = 1.0) -> None:
        self.surface = TriangleMesh(V, F)
        self.solver = LogMapSolver(self.surface, t_coef=t_coef)

    def compute_distance(self, curves: Curves, curve_signs: Sequence[bool] = (), points: Sequence[CurvePoint] = (),
                         preserve_source_normals: bool = False, level_set_constraint: str = "ZeroSet",
                         soft_level_set_weight: float = -1, *, is_signed: Optional[Sequence[bool]] = None) -> np.ndarray:
        """(n,) distances from the nearest curve or point. Positive on the left of a curve, unless its entry of `curve_signs` (or
        `is_signed`) is False."""
        only_zero_set(level_set_constraint, preserve_source_normals, soft_level_set_weight)
        given, signs = self._curves(curves), list(curve_signs if is_signed is None else is_signed)
        found = self._distance_from_curves(self.solver, given, signs + [True] * (len(given) - len(signs)))
        if len(points) == 0:
            return found
        return nearer(found, distance(self.surface, [self._point(p, f"points[{k}]") for k, p in enumerate(points)]))
