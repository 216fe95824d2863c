"""Types of the arguments, for annotations.

>>> from ahm.typing import Source, SurfaceLike
>>> def nearest_row(surface: SurfaceLike, source: Source) -> int: ...
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Protocol, Sequence, SupportsIndex, Tuple, TypedDict, Union

import numpy as np

if TYPE_CHECKING:
    from ._solvers import ExactGeodesics, LogMapSolver, PolarMapSolver
    from ._surface_solver import SurfaceSolver
    from ._surfaces import Surface


class Array(Protocol):
    """An array of any package with `__array__`: numpy, pandas, PyTorch on the CPU, and others."""

    def __array__(self) -> np.ndarray: ...


class HasPoints(Protocol):
    """A mesh or cloud of another package, as `ahm.surface` accepts: PyVista, meshio, Open3D."""

    @property
    def points(self) -> object: ...


class HasVertices(Protocol):
    """A mesh of another package, as `ahm.surface` accepts: trimesh, Open3D."""

    @property
    def vertices(self) -> object: ...


class SurfaceWarning(TypedDict):
    """An entry of `Surface.warnings`."""

    id: str  #: name of the kind of warning
    text: str  #: the warning as a sentence
    numbers: Sequence[float]  #: counts and lengths in the sentence
    rows: Sequence[int]  #: some of the rows concerned
    name: str  #: name of a column or option concerned, or empty


Vector = Union[Array, Sequence[float]]  #: numbers
Matrix = Union[Array, Sequence[Sequence[float]], Sequence[Array]]  #: rows of numbers
Faces = Matrix  #: corners of every face
Edge = Union[Array, Sequence[SupportsIndex]]  #: two rows

#: One point: a row, a position, `(face, barycentric)`, or `((row, row), t)`.
Source = Union[SupportsIndex, Vector, Tuple[SupportsIndex, Vector], Tuple[Edge, float]]
#: One or more points: also (k,) rows, (k, 3) positions, `(faces, barycentric)`, `(edges, t)`, or a list.
Sources = Union[Source, Matrix, Sequence[Source], Tuple[Vector, Matrix], Tuple[Matrix, Vector]]

Solver = Union["LogMapSolver", "PolarMapSolver", "ExactGeodesics", "SurfaceSolver"]
#: What `ahm.surface` accepts.
SurfaceInput = Union["Surface", Matrix, Tuple[Matrix, Faces], HasPoints, HasVertices]
#: A surface, a solver, or what `ahm.surface` accepts.
SurfaceLike = Union[SurfaceInput, Solver]

FileName = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
