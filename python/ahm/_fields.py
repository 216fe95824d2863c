"""Distance, parallel transport, extension of scalars, curvature, and the matrices of the heat method."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import as_body, as_solver
from .typing import Sources, SurfaceLike, Vector, Matrix

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


def distance(surface: SurfaceLike, sources: Sources, *, targets: Optional[Sources] = None, method: str = "wavefront",
             radius: Optional[float] = None, progress: Progress = None) -> np.ndarray:
    """Geodesic distance from the nearest of one or more sources, world units.

    surface : a `Surface`, a solver (method "heat" reuses the factors of a `LogMapSolver`), or what `ahm.surface` takes.
    sources : one or more points: rows, positions, `(faces, barycentric)`, `(edges, t)`.
    targets : None: all rows, the result has the shape (n,). Or k points, the result has the shape (k,). Targets that are not
        rows require method "exact".
    method : "wavefront" (default): a wavefront over the triangles, best for distances on meshes. "heat": the distance of a log map
        by the heat method, smooth, best on noise. "exact": exact on the flat triangles of a mesh. On clouds, grids and graphs,
        "heat" takes one solve each with A and B and smooths over about one edge midway between sources. On meshes it uses a
        wavefront, too.
    radius : rows beyond this distance get NaN; world units. Not for method "heat".
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> mesh = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> ahm.distance(mesh, [0, 3], targets=[1, 2, 4]).round(9).tolist()
    [1.0, 1.0, 1.0]
    >>> ahm.distance(mesh, (0, [0.5, 0.5, 0]), targets=[[2.5, 0, 0]], method="exact").round(9).tolist()
    [2.0]

    Rows that are not connected to a source get NaN. Raises ValueError naming the argument, the index and the value.
    """
    return distance_and_nearest(surface, sources, targets=targets, method=method, radius=radius, progress=progress)[0]


def distance_and_nearest(surface: SurfaceLike, sources: Sources, *, targets: Optional[Sources] = None, method: str = "wavefront",
                         radius: Optional[float] = None, progress: Progress = None) -> tuple:
    """The result of `distance`, and the number of the nearest source: int32, -1 where none is connected; None for method "heat".

    Arguments and errors as in `distance`.

    >>> import ahm
    >>> ahm.distance_and_nearest(ahm.shapes.plane(5, 2), [0, 4], targets=[1, 3])[1].tolist()
    [0, 1]
    """
    on = as_body(surface)
    arguments.choice(method, "method", ("wavefront", "heat", "exact"))
    at = places.points(sources, "sources", on)
    reach = float("inf") if radius is None else arguments.real(radius, "radius", positive=True, finite=False)
    if method == "exact":
        to = None if targets is None else places.points(targets, "targets", on, empty=True)
        if to is not None and len(to[2]) == 0:
            return np.empty(0), np.empty(0, np.int32)
        with reporting(progress) as report:
            return _core.exact_distance(on._body, at, to, reach, report)
    rows = None if targets is None else _target_rows(targets, on, method)
    with reporting(progress) as report:
        if method == "heat":
            if radius is not None:
                raise ValueError("radius: method 'heat' does not support it; use 'wavefront' or 'exact'")
            found, nearest = _core.heat_distance(as_solver(surface)._core, at, report)[0], None
        else:
            found, nearest = _core.front_distance(on._body, at, reach, report)
    if rows is None:
        return found, nearest
    return found[rows], None if nearest is None else nearest[rows]


def _target_rows(targets: Any, on: Any, method: str) -> np.ndarray:
    try:
        nested = np.ndim(arguments.unwrapped(targets)) > 1 and len(targets) > 0
    except ValueError:  # parts of different lengths
        nested = True
    if nested:
        raise ValueError(f"targets: method {method!r} accepts rows only; method 'exact' accepts other points")
    return arguments.rows(targets, "targets", len(on))


class DistanceField(NamedTuple):
    """Distance and its gradient. Returned by `distance_and_gradient`."""

    distance: np.ndarray  #: (n,) geodesic distance from the nearest source, world units
    #: (n, 3) unit vectors in space that point away from the source. On grids and graphs: (n, d), in the frame of each vertex
    gradient: np.ndarray


def distance_and_gradient(solver: SurfaceLike, sources: Sources, *, progress: Progress = None) -> DistanceField:
    """Distance and its gradient by the heat method: length and direction of the radial field (Lemma 1 of [SS25]).

    No distance is differentiated.

    solver : a `LogMapSolver`, or a surface.
    sources, progress : as in `distance`.

    Raises as `distance`.

    >>> import ahm
    >>> field = ahm.distance_and_gradient(ahm.TriangleMesh(*ahm.shapes.plane(4, 3)), 0)
    >>> field.gradient[3, 0].round(9), field.distance[3].round(9)
    (1.0, 3.0)
    """
    made = as_solver(solver)
    at = places.points(sources, "sources", made.surface)
    with reporting(progress) as report:
        return DistanceField(*_core.heat_distance(made._core, at, report))


def extend(solver: SurfaceLike, points: Sources, values: Union[float, Vector], *, progress: Progress = None) -> np.ndarray:
    """Extends scalars from points to all rows. Each row gets the value of the nearest point, blended at ties ([SSC19] Sec. 4).

    solver : a `LogMapSolver`, or a surface.
    points : k points: rows, positions, `(faces, barycentric)`, `(edges, t)`. On a cloud, a position is replaced by its nearest
        row, because only rows are vertices there.
    values : (k,) one number per point.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> ahm.extend(ahm.shapes.plane(9, 2), [0, 8], [1.0, 3.0])[:9].round(1).tolist()
    [1.0, 1.0, 1.1, 1.3, 2.0, 2.7, 2.9, 3.0, 3.0]
    >>> between = ahm.extend(ahm.shapes.plane(9, 2), [((0, 1), 0.5), ((7, 8), 0.5)], [1.0, 3.0])
    >>> between[[0, 4, 8]].round(1).tolist()
    [1.0, 2.0, 3.0]

    Returns (n,), NaN where no heat arrives. Raises ValueError naming the argument, the index and the value.
    """
    made = as_solver(solver)
    at = places.points(points, "points", made.surface)
    values = arguments.unwrapped(values)
    given = arguments.floats([values] if np.ndim(values) == 0 else values, "values", (len(at[2]),), finite=True)
    with reporting(progress) as report:
        return _core.extend(made._core, at, given, report)[0]


def transport(solver: SurfaceLike, points: Sources, vectors: Union[Vector, Matrix], *, progress: Progress = None) -> np.ndarray:
    """Parallel transports vectors from points along shortest geodesic paths to all rows ([SSC19] Alg. 1).

    solver : a `LogMapSolver`, or a surface.
    points : k points: rows, positions, `(faces, barycentric)`, `(edges, t)`. Positions near a cloud are treated as in `extend`.
    vectors : (k, 3) vectors in space, projected to the tangent plane or face. Or (k, d) components: at rows in the frame of the
        row, at other points in the axes of a log map from there. A single vector may have the shape (3,) or (d,).
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> ahm.transport(ahm.shapes.plane(4, 3), 0, [1, 2, 0])[11, :2].round(9).tolist()
    [1.0, 2.0]

    Returns (n, 3) vectors in space for vectors in space, and (n, d) components in the frames of the rows for components. NaN
    where no heat arrives. Raises ValueError naming the argument, the index and the value.
    """
    made = as_solver(solver)
    at = places.points(points, "points", made.surface)
    given = arguments.array(vectors, "vectors")
    given = np.atleast_2d(given)
    width, d = given.shape[-1], made.surface.dimension
    if width not in ((3, d) if made.surface._body.has_surface else (d,)):
        raise ValueError(f"vectors: expected 3 numbers in space or {d} in a frame per point, got shape {given.shape}")
    given = arguments.floats(given, "vectors", (len(at[2]), width), finite=True)
    with reporting(progress) as report:
        return _core.transport(made._core, at, given, report)[0]


class Curvature(NamedTuple):
    """Principal curvatures of every row; NaN where a row has too few neighbors. Returned by `curvature`."""

    values: np.ndarray  #: (n, 2) kappa_1, kappa_2 with |kappa_1| >= |kappa_2|, 1 / world units
    direction: np.ndarray  #: (n, 3) unit vector in space along which the curvature is kappa_1, up to its sign


def curvature(surface: SurfaceLike, *, threads: int = 0, progress: Progress = None) -> Curvature:
    """Principal curvatures and directions of a paraboloid fitted around every row [CP05].

    surface : a mesh or a cloud.
    threads : number of threads; 0: one per core. No result depends on it.
    progress : as in `LogMapSolver`.

    >>> import ahm
    >>> k = ahm.curvature(ahm.shapes.sphere(3)).values
    >>> bool(abs(k - 1).max() < 0.05)
    True

    Raises ValueError for grids in space and for graphs without frames.
    """
    on = as_body(surface)
    with reporting(progress) as report:
        return Curvature(*_core.curvature(on._body, checked(threads=threads)["threads"], report))


class Operators(NamedTuple):
    """Mass, Laplacians, gradient and eigenpairs as scipy matrices. Returned by `operators`.

    Matrices have one row per vertex of the graph, and are in units of the graph: a length of 1 is `length_unit` world units.
    """

    mass: csr_matrix  #: (n, n) mass matrix M, diagonal
    laplacian: csr_matrix  #: (n, n) scalar graph Laplacian L, positive semi-definite: (L u)_i = sum_j w_ij (u_i - u_j)
    connection_laplacian: csr_matrix  #: connection Laplacian L^nabla: (n, n) complex Hermitian, or (n d, n d) real
    transports: csr_matrix  #: transports R_ji from the frame of j to the frame of i: (n, n) complex, or (n d, n d) real blocks
    tau: np.ndarray  #: (n,) diffusion time of every vertex, by its component, squared graph units
    length_unit: float  #: length of one graph unit, world units
    vertex_of_row: np.ndarray  #: (rows,) int32 vertex of every row of the input; -1: removed
    row_of_vertex: np.ndarray  #: (n,) int32 row of every vertex; -1: the vertex is not in the input
    #: d matrices, (n, n): gradient[a] @ u is the component of the gradient of u along axis a of the frame of each vertex
    gradient: Tuple[csr_matrix, ...]
    frames: Optional[np.ndarray]  #: (n, 3, 3) x axis, y axis and normal of every vertex in space; None without frames in space
    eigenvalues: Optional[np.ndarray]  #: (k_eig,) smallest eigenvalues of L x = lambda M x, ascending; None without `k_eig`
    eigenvectors: Optional[np.ndarray]  #: (n, k_eig) their vectors X, with X^T M X = I

    @property
    def A(self) -> csr_matrix:
        """A = M + tau L, symmetric positive definite."""
        return _plus(self.mass, self.tau, self.laplacian)

    @property
    def B(self) -> csr_matrix:
        """B = M + tau L^nabla, Hermitian positive definite."""
        repeat = self.connection_laplacian.shape[0] // len(self.tau)
        from scipy.sparse import identity, kron

        mass = self.mass if repeat == 1 else kron(self.mass, identity(repeat))
        return _plus(mass, np.repeat(self.tau, repeat), self.connection_laplacian)


def _plus(mass: Any, tau: np.ndarray, laplacian: Any) -> Any:
    from scipy.sparse import diags

    return (mass + diags(tau) @ laplacian).tocsr()


def operators(surface: SurfaceLike, *, t_coef: float = 1.0, k_eig: Optional[int] = None, threads: int = 0,
              progress: Progress = None) -> Operators:
    """Mass, Laplacians, gradient and eigenpairs of a surface, by vertices of its graph (`Operators.vertex_of_row`).

    surface : a `Surface`, or what `ahm.surface` takes.
    t_coef : factor of the diffusion time tau = t_coef h^2, with h the mean edge length of the component; > 0.
    k_eig : number of eigenpairs, at most n; None: none. They are computed by block Lanczos on libahm's own factorization.
    threads : number of threads; 0: one per core. No result depends on it.
    progress : as in `LogMapSolver`.

    The gradient is the least-squares fit to the differences along the edges of each star, with the positions of the neighbors in the
    frame of the vertex (`e_ij`), as in DiffusionNet [SACO22]. It is exact for linear functions on flat surfaces. Where the edges do
    not span the tangent space, it is the shortest such vector.

    With delaunay=False and clamp_weights=False, mass and Laplacian of a triangle mesh are those of DiffusionNet (with clamp_weights=True
    negative cotangents are zero), and so is the gradient, up to rotations of the frames, with two differences. `e_ij` has the length of the
    edge, and the angles around a vertex are scaled to 2 pi; DiffusionNet projects edges to the plane orthogonal to the normal, which
    differs by the square of the edge length, on rough meshes by a third. DiffusionNet also adds 1e-5 to the diagonal of the normal
    equations. By default the edges are flipped to the intrinsic Delaunay triangulation before.

    >>> import ahm
    >>> ops = ahm.operators(ahm.shapes.sphere(3), k_eig=9)
    >>> ops.A.shape, bool(abs(ops.laplacian.sum(axis=1)).max() < 1e-12)
    ((642, 642), True)
    >>> (ops.eigenvalues / ops.length_unit**2).round(1) + 0.0     # l (l + 1)
    array([0., 2., 2., 2., 6., 6., 6., 6., 6.])

    Raises ValueError naming the argument; ImportError without scipy.
    """
    from scipy.sparse import bsr_matrix, coo_matrix, csr_matrix, diags, triu

    on = as_body(surface)
    factor = arguments.real(t_coef, "t_coef", positive=True)
    indptr, indices, weights, logs, turns, masses = on._body.csr()
    n, d = len(masses), logs.shape[1]
    count = None if k_eig is None else arguments.integer(k_eig, "k_eig", 1, n)
    row = np.repeat(np.arange(n), np.diff(indptr))
    degree = np.bincount(row, weights, n)
    laplacian = (diags(degree) - coo_matrix((weights, (row, indices)), (n, n))).tocsr()
    if turns.ndim == 2:
        R = coo_matrix((turns[:, 0] + 1j * turns[:, 1], (row, indices)), (n, n)).tocsr()
        weighted = coo_matrix((weights * (turns[:, 0] + 1j * turns[:, 1]), (row, indices)), (n, n))
        connection = (diags(degree).astype(complex) - weighted).tocsr()
    else:
        R = bsr_matrix((turns, indices, indptr), (n * d, n * d)).tocsr()
        weighted = bsr_matrix((weights[:, None, None] * turns, indices, indptr), (n * d, n * d))
        connection = csr_matrix(diags(np.repeat(degree, d)) - weighted)
    tau = _core.diffusion_times(on._body, factor)
    values = vectors = None
    if count is not None:
        upper = triu(laplacian, format="csc")
        upper.sort_indices()
        with reporting(progress) as report:
            values, columns = _core.smallest_eigenpairs(upper.indptr.astype(np.int64), upper.indices.astype(np.int64), upper.data,
                                                        masses, count, checked(threads=threads)["threads"], report)
        vectors = columns.T
    return Operators(diags(masses).tocsr(), laplacian, connection, R, tau, on._body.length_unit,
                     on._body.vertex_of_row(), on._body.row_of_vertex(), _gradient(row, indices, logs, n), _frames(on),
                     values, vectors)


def _gradient(row: np.ndarray, neighbor: np.ndarray, logs: np.ndarray, n: int) -> Tuple[csr_matrix, ...]:
    """g_i = argmin sum_j (<g, e_ij> - (u_j - u_i))^2, as one matrix per axis."""
    from scipy.sparse import coo_matrix

    d = logs.shape[1]
    normal = np.stack([np.bincount(row, logs[:, a] * logs[:, b], n) for a in range(d) for b in range(d)], axis=1).reshape(n, d, d)
    factors = np.einsum("eab,eb->ea", np.linalg.pinv(normal, rcond=1e-12, hermitian=True)[row], logs)
    rows, columns = np.concatenate([row, row]), np.concatenate([neighbor, row])
    return tuple(coo_matrix((np.concatenate([f, -f]), (rows, columns)), (n, n)).tocsr() for f in factors.T)


def _frames(on: Any) -> Optional[np.ndarray]:
    frames = on._body.frames()
    return None if frames is None else frames[:, 1:]
