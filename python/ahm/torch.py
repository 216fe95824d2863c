"""Local maps, operators and geodesics as tensors, for PyTorch and PyTorch Geometric. Imports torch, which `import ahm` does not.

>>> import ahm, torch, ahm.torch
>>> positions, faces = ahm.shapes.sphere(2)
>>> found = ahm.torch.edges(ahm.local_maps(ahm.TriangleMesh(positions, faces), k=12))
>>> found.edge_index.shape, found.log.dtype, found.transport.dtype
(torch.Size([2, 1944]), torch.float32, torch.complex64)

As a transform of data sets, of objects that have `pos` and `face` as those of PyTorch Geometric have:

>>> class Data: pass
>>> data = Data()
>>> data.pos, data.face = torch.from_numpy(positions), torch.from_numpy(faces.T.copy())
>>> data = ahm.torch.LocalMaps(k=12)(data)          # e.g. pre_transform=ahm.torch.LocalMaps(k=12)
>>> data.edge_index.shape, data.log.shape
(torch.Size([2, 1944]), torch.Size([1944, 2]))

`trace`, `log`, `distance` and `sample` have derivatives by points on the surface.
"""

from __future__ import annotations

import importlib
import inspect
import os
from typing import Any, Dict, NamedTuple, Optional, Union

import numpy as np

from . import _arguments as arguments
from ._clouds import PointCloud
from ._differentiable import Sampled, Traced, distance, log, sample, trace
from ._disk_cache import DiskCache, key_of
from ._fields import operators as _operators
from ._local_maps import LocalMaps as _Maps, local_maps
from ._meshes import TriangleMesh
from ._options import checked
from ._progress import Progress
from .typing import SurfaceLike, Vector

torch: Any = importlib.import_module("torch")  # Any: checkers of types need not read torch

__all__ = ["Edges", "LocalMaps", "Operators", "Sampled", "Traced", "distance", "edges", "log", "operators", "sample", "trace"]


class Edges(NamedTuple):
    """The entries of local maps as directed edges, from the neighbor j to the source i. Returned by `edges`.

    `edge_index` are coordinates of a sparse matrix (COO); `indptr` and `edge_index[0]` are its compressed rows (CSR).
    """

    edge_index: Any  #: (2, e) int64: rows of the neighbors, rows of the sources
    indptr: Any  #: (n + 1,) int64: the edges of source i are those from indptr[i] to indptr[i + 1] - 1; none where i is no source
    log: Any  #: (e, 2) float32 (or float64, as all below): coordinates of j in the frame of i, world units
    transport: Optional[Any]  #: (e,) complex64: times u + iv of a vector at j, in the frame of j, is u + iv in the frame of i
    distance: Any  #: (e,) float32: geodesic distance, world units
    weight: Any  #: (e,) float32: area of j, for integration
    quality: Optional[Any] = None  #: (e,) float32: how reliable `log` is, in (0, 1]; None if the maps were made without


def edges(maps: _Maps, dtype: Any = torch.float32) -> Edges:
    """The entries of local maps as tensors on the CPU, in the order of the rows of their sources, those of one source nearest first.

    maps : local maps of rows, from `ahm.local_maps`. `Edges.transport` and `Edges.quality` are None if they have none. Every source is
        its own first neighbor.
    dtype : torch.float32, or torch.float64. With float64 all tensors except `edge_index` share the memory of the arrays of `maps`, without
        copies: a change of one changes the other. `transport` is then a view with its conjugate bit set (`resolve_conj` makes a copy).
        If the maps have `sources`, `indptr` is new; if these do not ascend, all tensors are copies.

    The columns of `indptr` and `edge_index[0]` are in order of distance. `torch.sparse_csr_tensor` requires ascending ones:
    `torch.sparse_coo_tensor(e.edge_index.flip(0), e.weight, (n, n)).to_sparse_csr()` sorts them, in a copy.

    `transport` is the inverse of `ahm.LocalMaps.transport`, because messages go from the neighbor to the source. Rows without a
    vertex have no edges, and no number is NaN (on surfaces whose sizes single precision holds).

    Raises ValueError (another dtype; a source that is not a row; maps of another dimension than 2; a surface that is not orientable, whose
    transports are no rotations: make the maps with transport=False).
    """
    if dtype not in (torch.float32, torch.float64):
        raise ValueError(f"dtype: expected torch.float32 or torch.float64, got {dtype!r}")
    if maps.log.ndim != 2 or maps.log.shape[1] != 2:
        raise ValueError(f"maps: expected maps of dimension 2, got log of shape {maps.log.shape}")
    if maps.transport is not None and maps.transport.ndim != 2:
        raise ValueError("maps: the surface is not orientable, so transports are no complex numbers; use transport=False")
    ends, indptr = maps.edge_index(), maps.indptr
    kept: Any = slice(None)
    if len(maps) != maps.columns or (np.diff(maps.sources) != 1).any():  # `indptr` is by source, not by row
        if (np.diff(maps.sources) < 0).any():
            kept = np.argsort(ends[1], kind="stable")
            ends = np.take(ends, kept, axis=1)
        indptr = np.searchsorted(ends[1], np.arange(maps.columns + 1))
    turns = None if maps.transport is None else maps.transport.view(np.complex128)[:, 0]
    log, distance, weight, quality, transport = (
        None if values is None else torch.from_numpy(values[kept]) for values in (maps.log, maps.distance, maps.weight, maps.quality, turns))
    if dtype is torch.float32:
        log, distance, weight, quality = (None if values is None else values.float() for values in (log, distance, weight, quality))
        transport = None if transport is None else transport.to(torch.complex64).conj_physical_()
    elif transport is not None:
        transport = transport.conj()
    return Edges(torch.from_numpy(ends), torch.from_numpy(indptr), log, transport, distance, weight, quality)


class Operators(NamedTuple):
    """Operators of a surface by rows, float32, world units. Returned by `operators`."""

    mass: Any  #: (n,) area of every row
    laplacian: Any  #: (n, n) sparse: (L u)_i = sum_j w_ij (u_i - u_j)
    #: (n, n) sparse, complex64, Hermitian, positive semi-definite: (C x)_i = sum_j w_ij (x_i - R_ij x_j) for vectors x_i = u + iv in the frame
    #: of row i, with R_ij the parallel transport from j to i. Of surfaces that are not orientable: (2 n, 2 n), real, for u and v of each row
    connection_laplacian: Any
    grad_x: Any  #: (n, n) sparse: component of the gradient along the x axis of the frame of each row
    grad_y: Any  #: (n, n) sparse: component along the y axis
    frames: Any  #: (n, 3, 3) x axis, y axis and normal of every row in space
    eigenvalues: Any  #: (k_eig,) smallest eigenvalues of L x = lambda M x, ascending
    eigenvectors: Any  #: (n, k_eig) their vectors X, with X^T M X = I


def operators(surface: SurfaceLike, k_eig: int = 128, *, threads: int = 0, progress: Progress = None) -> Operators:
    """The operators that networks such as DiffusionNet [SACO22] use, as tensors on the CPU.

    surface : a mesh or a cloud. Every row must have a vertex of its own.
    k_eig, threads, progress : as in `ahm.operators`.

    PyTorch multiplies the sparse matrices with dense tensors, `torch.sparse.mm(ops.grad_x, values)`, and differentiates by these. The
    connection Laplacian takes complex ones: `torch.sparse.mm(ops.connection_laplacian, torch.complex(u, v))`.

    >>> import ahm, ahm.torch
    >>> ops = ahm.torch.operators(ahm.TriangleMesh(*ahm.shapes.sphere(2)), k_eig=8)
    >>> ops.grad_x.shape, ops.eigenvectors.shape, ops.eigenvectors.dtype
    (torch.Size([162, 162]), torch.Size([162, 8]), torch.float32)

    Raises ValueError (rows without a vertex, rows at the same position, polygons with virtual vertices, no frames in space; k_eig).
    """
    made = _operators(surface, k_eig=k_eig, threads=threads, progress=progress)
    vertex, unit, n = made.vertex_of_row, made.length_unit, len(made.tau)
    missing = np.flatnonzero(vertex < 0)
    if len(missing):
        raise ValueError(f"surface: row {missing[0]} has no vertex; remove such rows first")
    if len(np.unique(vertex)) < len(vertex):
        raise ValueError("surface: several rows share one vertex; remove duplicate points first")
    if len(vertex) < n:
        vertices = arguments.counted(n - len(vertex), "vertex")
        raise ValueError(f"surface: {vertices} of its graph are not in the input; use discretization='polygons'")
    values, vectors, frames = made.eigenvalues, made.eigenvectors, made.frames
    assert values is not None and vectors is not None  # `k_eig` is a number
    if frames is None or len(made.gradient) != 2:
        raise ValueError("surface: this one has no frames in space; use a mesh or a cloud")

    def dense(numbers: Any) -> Any:
        return torch.from_numpy(np.ascontiguousarray(numbers, np.complex64 if np.iscomplexobj(numbers) else np.float32))

    def sparse(matrix: Any) -> Any:
        width = matrix.shape[0] // n  # numbers per row: two in a real matrix of vectors
        order = (vertex[:, None] * width + np.arange(width)).ravel()
        rows = matrix[order][:, order].tocoo()
        place = torch.from_numpy(np.stack([rows.row, rows.col]).astype(np.int64))
        return torch.sparse_coo_tensor(place, dense(rows.data), rows.shape).coalesce()

    along_x, along_y = (sparse(matrix / unit) for matrix in made.gradient)
    return Operators(dense(made.mass.diagonal()[vertex] * unit**2), sparse(made.laplacian), sparse(made.connection_laplacian),
                     along_x, along_y, dense(frames[vertex]), dense(values / unit**2), dense(vectors[vertex] / unit))


class LocalMaps:
    """A transform that adds the local maps of all rows to an object with points, and returns it.

    It reads `data.pos`, (n, 3) positions, and `data.face`, (3, f) triangles as in PyTorch Geometric; without `face`, or if it is None,
    the points are a point cloud. It sets `edge_index`, `log`, `transport`, `distance` and `weight`, tensors as in `Edges`, on the
    device of `data.pos`, and with quality=True also `quality`. The edges are in the order of their sources, so that
    `torch.searchsorted(data.edge_index[1], torch.arange(len(data.pos) + 1))` are the offsets of compressed rows, also of a batch, which
    could not concatenate offsets.

    radius, k, method, transport, quality, threads : as in `ahm.local_maps`. Surfaces that are not orientable require transport=False;
        then `transport` is not set.
    sources : rows, or the name of an attribute of the object that contains them; None: all rows. The other rows get no neighbors: they
        are the target of no edge, and remain neighbors of the sources. Repeated rows count once, and rows without a vertex get no edges.
    cache : folder, which is created; None: no cache. One file per object holds its edges, under a hash of the positions, the triangles,
        the options that change numbers, and the version of ahm. Damaged files are computed again. Several processes may share the folder.
        Nothing is ever deleted.
    surface_options : options of `ahm.TriangleMesh` or `ahm.PointCloud`, such as non_manifold="split" for meshes and drop_non_finite=True
        for clouds. `threads` is passed to them, too.

    Raises ValueError and TypeError naming the argument, also when the transform is called: errors of `ahm.TriangleMesh`,
    `ahm.PointCloud` and `ahm.local_maps`, such as options of clouds for an object with `face`. OSError (files of the cache that cannot be read or written).
    """

    def __init__(self, radius: Optional[float] = None, k: Optional[int] = None, *, sources: Union[None, str, Vector] = None,
                 method: str = "auto", transport: bool = True, quality: bool = False, threads: int = 0,
                 cache: Union[None, str, "os.PathLike[str]"] = None, **surface_options: Any) -> None:
        if radius is None and k is None:
            raise ValueError("radius: missing; pass a radius or k")
        self._options = dict(checked(radius=radius, k=k, transport=transport, quality=quality, threads=threads),
                             method=arguments.choice(method, "method", ("auto", "polar", "heat")))
        for name in surface_options:
            if not any(name in inspect.signature(kind).parameters for kind in (TriangleMesh, PointCloud)):
                raise TypeError(f"LocalMaps.__init__() got an unexpected keyword argument {name!r}")
        self._surface_options = dict(surface_options, threads=threads)
        self._sources = sources
        self._cache = None if cache is None else DiskCache(cache)

    def __call__(self, data: Any) -> Any:
        faces = getattr(data, "face", None)
        for name, value in (("pos", getattr(data, "pos", None)), ("face", faces)):
            if not (torch.is_tensor(value) or (name == "face" and value is None)):
                raise TypeError(f"data.{name}: expected a tensor, got {arguments.describe(value)}")
        positions = data.pos.detach().cpu().double().numpy()
        sources = getattr(data, self._sources) if isinstance(self._sources, str) else self._sources
        if sources is not None:
            sources = sources.cpu() if torch.is_tensor(sources) else sources
            sources = np.unique(arguments.rows(sources, "sources", len(positions)))
        for name, value in self._edges(positions, None if faces is None else faces.detach().cpu().numpy().T, sources).items():
            setattr(data, name, torch.from_numpy(value).to(data.pos.device))
        return data

    def _edges(self, positions: np.ndarray, faces: Optional[np.ndarray], sources: Optional[np.ndarray]) -> Dict[str, np.ndarray]:
        key = ""
        if self._cache:
            numbers = {**self._options, **self._surface_options}
            text = [(name, np.asarray(numbers[name]).tolist()) for name in sorted(numbers) if name not in ("threads", "progress")]
            key = key_of(f"local maps {text}", positions, faces, sources)
            stored = self._cache.get(key)
            if stored is not None:
                return stored
        made = edges(self._maps(positions, faces, sources))._asdict()
        found = {name: value.numpy() for name, value in made.items() if value is not None and name != "indptr"}
        if self._cache:
            self._cache.put(key, found)
        return found

    def _maps(self, positions: np.ndarray, faces: Optional[np.ndarray], sources: Optional[np.ndarray]) -> _Maps:
        options = self._surface_options
        surface = PointCloud(positions, **options) if faces is None else TriangleMesh(positions, faces, **options)
        if sources is not None:
            sources = sources[surface._body.vertex_of_row()[sources] >= 0]
        return local_maps(surface, sources=sources, **self._options)

    def __repr__(self) -> str:
        options = [f"{name}={value!r:.60}" for name, value in {**self._options, **self._surface_options}.items()]
        if self._sources is not None:
            options.append(f"sources={self._sources!r:.60}")
        if self._cache:
            options.append(f"cache={str(self._cache.folder)!r}")
        return f"ahm.torch.LocalMaps({', '.join(options)})"
