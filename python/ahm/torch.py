"""Local maps as tensors, for PyTorch and PyTorch Geometric. Imports torch, which `import ahm` does not.

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
"""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple, Optional

import numpy as np

from ._clouds import PointCloud
from ._local_maps import LocalMaps as _Maps, local_maps
from ._meshes import TriangleMesh
from ._options import checked

torch: Any = importlib.import_module("torch")  # Any: checkers of types need not read torch

__all__ = ["Edges", "LocalMaps", "edges"]


class Edges(NamedTuple):
    """The entries of local maps as directed edges, from the neighbor j to the source i. Returned by `edges`."""

    edge_index: Any  #: (2, e) int64: rows of the neighbors, rows of the sources
    log: Any  #: (e, 2) float32: coordinates of j in the frame of i, world units
    transport: Optional[Any]  #: (e,) complex64: times u + iv of a vector at j, in the frame of j, is u + iv in the frame of i
    distance: Any  #: (e,) float32: geodesic distance, world units
    weight: Any  #: (e,) float32: area of j, for integration


def edges(maps: _Maps) -> Edges:
    """The entries of local maps as tensors on the CPU, with the edges of each source nearest first. Every row is its own first neighbor.

    maps : local maps of rows, from `ahm.local_maps`. `Edges.transport` is None if they have none.

    `transport` is the inverse of `ahm.LocalMaps.transport`, because messages go from the neighbor to the source. Rows without a
    vertex have no edges, and no number is NaN.

    Raises ValueError (a source that is not a row; maps of another dimension than 2; a surface that is not orientable, whose
    transports are no rotations: make the maps with transport=False).
    """
    if maps.log.ndim != 2 or maps.log.shape[1] != 2:
        raise ValueError(f"maps: expected maps of dimension 2, got log of shape {maps.log.shape}")
    if maps.transport is not None and maps.transport.ndim != 2:
        raise ValueError("maps: the surface is not orientable, so transports are no complex numbers; use transport=False")
    transport = None
    if maps.transport is not None:
        transport = torch.from_numpy(np.conj(maps.transport.astype(np.float32).view(np.complex64)[:, 0]))
    log, distance, weight = (torch.from_numpy(values.astype(np.float32)) for values in (maps.log, maps.distance, maps.weight))
    return Edges(torch.from_numpy(maps.edge_index()), log, transport, distance, weight)


class LocalMaps:
    """A transform that adds the local maps of all rows to an object with points, and returns it.

    It reads `data.pos`, (n, 3) positions, and `data.face`, (3, f) triangles as in PyTorch Geometric; without `face`, or if it is None,
    the points are a point cloud. It sets `edge_index`, `log`, `transport`, `distance` and `weight`, tensors as in `Edges`, on the
    device of `data.pos`.

    radius, k, method, threads : as in `ahm.local_maps`.

    Raises ValueError and TypeError naming the argument, also when the transform is called: errors of `ahm.TriangleMesh`,
    `ahm.PointCloud` and `ahm.local_maps`.
    """

    def __init__(self, radius: Optional[float] = None, k: Optional[int] = None, *, method: str = "auto", threads: int = 0) -> None:
        if radius is None and k is None:
            raise ValueError("radius: missing; pass a radius or k")
        self._options = dict(checked(radius=radius, k=k, threads=threads), method=method)

    def __call__(self, data: Any) -> Any:
        positions = data.pos.detach().cpu().double().numpy()
        faces = getattr(data, "face", None)
        surface = PointCloud(positions) if faces is None else TriangleMesh(positions, faces.detach().cpu().numpy().T)
        for name, value in edges(local_maps(surface, **self._options))._asdict().items():
            setattr(data, name, value.to(data.pos.device))
        return data

    def __repr__(self) -> str:
        return f"ahm.torch.LocalMaps({', '.join(f'{name}={value!r}' for name, value in self._options.items())})"
