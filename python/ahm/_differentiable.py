"""Geodesics that PyTorch differentiates: exponential map, log map, distance, and interpolation in a log map. Public as `ahm.torch`.

The derivatives are exact on the flat faces of a mesh. The faces along a geodesic unfold into a plane, where the geodesic is a straight
line. They jump where the geodesic passes a vertex and at the cut locus. Second derivatives raise an error.
"""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._maps import InverseMap, LogMap
from ._options import checked
from ._solvers import as_body
from ._surfaces import Surface
from .typing import SurfaceLike

torch: Any = importlib.import_module("torch")  # Any: checkers of types need not read torch


class Traced(NamedTuple):
    """The ends of straightest geodesics. Returned by `trace`."""

    position: Any  #: (..., 3) points of the surface, world units
    complete: Any  #: (...) bool: False where the geodesic ended at the boundary before its full length


class Sampled(NamedTuple):
    """Values at coordinates of a log map. Returned by `sample`."""

    value: Any  #: (..., channels) values, or (...) of values without channels; 0 where not valid
    valid: Any  #: (...) bool: whether a triangle of the map contains the coordinates


def trace(surface: SurfaceLike, point: Any, vector: Any) -> Traced:
    """The ends of the straightest geodesics from points along vectors: the exponential map.

    surface : a mesh, or a solver on one.
    point : (..., 3) tensor of positions. The geodesic starts at the nearest point of the surface.
    vector : (..., 3) tensor, world units. It is projected to the tangent plane of the point: to that of the face, or of
        `Surface.frames` at a vertex. The geodesic is as long as the projected vector. Both tensors are broadcast.

    The derivatives are those of the polyhedral trace. Up to the next vertex, the geodesic moves as a line in the unfolded plane of the
    faces that it crosses. So the derivative by `point` and by `vector` is the rotation of the tangent plane at the start to that at the
    end. Along a geodesic that ends at the boundary, it is the motion of the point on the boundary.

    >>> import ahm, ahm.torch, torch
    >>> plane = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> vector = torch.tensor([1.2, 0.3, 0.0], dtype=torch.float64, requires_grad=True)
    >>> end = ahm.torch.trace(plane, torch.tensor([0.5, 1.2, 0.0]), vector).position
    >>> end.sum().backward()
    >>> [round(float(x), 6) for x in end], vector.grad.round(decimals=9).tolist()
    ([1.7, 1.5, 0.0], [1.0, 1.0, 0.0])

    Raises TypeError and ValueError naming the argument (no mesh; a surface that is not orientable; shapes; numbers that are not finite;
    a vector that leaves the surface at a vertex of the boundary).
    """
    on = _mesh(surface)
    point, vector, shape = _rows(point, vector, "point", "vector")
    along = arguments.floats(_numbers(vector), "vector", (None, 3), finite=True)
    end, complete, by_point, by_vector = _core.exponential(on._body, _places(point, "point", on), along, None)
    position = _Derived.apply(point, vector, end, by_point, by_vector)
    return Traced(position.reshape(*shape, 3), torch.from_numpy(complete.astype(bool)).to(point.device).reshape(shape))


def log(surface: SurfaceLike, source: Any, target: Any, *, threads: int = 0) -> Any:
    """The log map of each source at its target: the vector with `trace(surface, source, vector)` = target, along the shortest path.

    surface : a mesh, or a solver on one.
    source, target : (..., 3) tensors of positions, which are broadcast. The nearest points of the surface are used.
    threads : number of threads; 0: one per core. No result depends on it.

    Returns a (..., 3) tensor of vectors in the tangent planes of the sources, as long as the distances. At a vertex the tangent plane is
    that of `Surface.frames`. Where the shortest path bends at a vertex, `trace` does not follow it.

    The derivatives are exact on the faces. The path is straight in the unfolded plane of the faces that it crosses. So moving the
    target moves the vector likewise, turned to the plane of the source; moving the source changes it by the opposite. At the cut locus
    the derivatives are those along one of the shortest paths. One propagation per distinct source computes all of its targets.

    >>> import ahm, ahm.torch, torch
    >>> plane = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> ahm.torch.log(plane, torch.tensor([0.5, 1.5, 0.0]), torch.tensor([2.5, 0.5, 0.0])).round(decimals=6).tolist()
    [2.0, -1.0, 0.0]

    Raises TypeError and ValueError naming the argument (as `trace`; a target that is not connected to its source).
    """
    source, target, shape, found = _ends(surface, source, target, threads)
    distance, departure, _, by_source, by_target = found
    return _Derived.apply(source, target, distance[:, None] * departure, by_source, by_target).reshape(*shape, 3)


def distance(surface: SurfaceLike, source: Any, target: Any, *, threads: int = 0) -> Any:
    """The exact geodesic distance of each target from its source, as a (...) tensor.

    surface, source, target, threads : as in `log`.

    The derivative by the target is the unit vector along the shortest path where it arrives; by the source, minus that where it leaves.
    Both are 0 at the distance 0. At the cut locus they are those of one of the shortest paths.

    >>> import ahm, ahm.torch, torch
    >>> plane = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> target = torch.tensor([2.5, 0.5, 0.0], requires_grad=True)
    >>> ahm.torch.distance(plane, torch.tensor([0.5, 0.5, 0.0]), target).backward()
    >>> target.grad.abs().round(decimals=6).tolist()
    [1.0, 0.0, 0.0]

    Raises as `log`.
    """
    source, target, shape, found = _ends(surface, source, target, threads)
    distance, departure, arrival, _, _ = found
    return _Derived.apply(source, target, distance[:, None], -departure[:, None], arrival[:, None]).reshape(shape)


def sample(values: Any, map: Union[LogMap, InverseMap], uv: Any) -> Sampled:
    """Values of the rows, interpolated at coordinates of a log map.

    values : (n, channels) or (n,) tensor, one entry per row of the surface. There may be several axes of channels.
    map : a log map with frames, or an `ahm.InverseMap`.
    uv : (..., 2) tensor of coordinates, world units.

    The value is linear in every triangle of the map, in the plane of its coordinates. Gradients go to `values` and to `uv`.
    Coordinates outside of the triangles that `ahm.InverseMap` uses have the value 0 and no gradient.

    >>> import ahm, ahm.torch, torch
    >>> mesh = ahm.TriangleMesh(*ahm.shapes.plane(4, 3))
    >>> uv = torch.tensor([[1.25, 0.5], [-1.0, 0.0]], requires_grad=True)
    >>> found = ahm.torch.sample(torch.tensor(mesh.points[:, 0]), ahm.log_map(mesh, 0, u_axis=[1, 0, 0]), uv)
    >>> found.value.sum().backward()
    >>> found.value.round(decimals=6).tolist(), found.valid.tolist(), uv.grad.abs().round(decimals=6).tolist()
    ([1.25, 0.0], [True, False], [[1.0, 0.0], [0.0, 0.0]])

    Raises TypeError and ValueError naming the argument (shapes; numbers that are not finite; as `ahm.LogMap.inverse`).
    """
    _check(values, "values")
    _check(uv, "uv")
    if not isinstance(map, (LogMap, InverseMap)):
        raise TypeError(f"map: expected a LogMap or an InverseMap, got {type(map).__name__}")
    whole = map if isinstance(map, LogMap) else map.map
    if values.ndim == 0 or len(values) != len(whole):
        raise ValueError(f"values: expected one entry per row, shape ({len(whole)}, ...), got {tuple(values.shape)}")
    if uv.ndim == 0 or uv.shape[-1] != 2:
        raise ValueError(f"uv: expected shape (..., 2), got {tuple(uv.shape)}")
    flat = uv.reshape(-1, 2)
    numbers = arguments.floats(_numbers(flat), "uv", (None, 2), finite=True)
    triangle = (map.inverse(numbers) if isinstance(map, LogMap) else map(numbers)).triangle
    inside = np.flatnonzero((triangle[:, 0] >= 0) & (triangle[:, 0] != triangle[:, 1]))
    rows = torch.from_numpy(triangle[inside].astype(np.int64)).to(values.device)
    corner = torch.from_numpy(whole.uv[triangle[inside]]).to(uv.device)
    at = torch.from_numpy(inside).to(values.device)
    first, second, place = (x - corner[:, 0] for x in (corner[:, 1], corner[:, 2], flat[at.to(uv.device)].double()))
    area = _cross(first, second)
    weight = torch.stack([_cross(place, second) / area, _cross(first, place) / area], 1)
    weight = torch.cat([1 - weight.sum(1, keepdim=True), weight], 1).to(values)
    found = torch.einsum("kc,kc...->k...", weight, values[rows])
    result = values.new_zeros(len(flat), *values.shape[1:]).index_put((at,), found)
    valid = torch.zeros(len(flat), dtype=torch.bool, device=values.device).index_fill(0, at, True)
    return Sampled(result.reshape((*uv.shape[:-1], *values.shape[1:])), valid.reshape(uv.shape[:-1]))


class _Derived(torch.autograd.Function):
    """Values (k, m) of two points (k, 3), with their derivatives (k, m, 3)."""

    @staticmethod
    def forward(context: Any, first: Any, second: Any, value: np.ndarray, by_first: np.ndarray, by_second: np.ndarray) -> Any:
        context.save_for_backward(*(torch.from_numpy(np.ascontiguousarray(by)).to(first) for by in (by_first, by_second)))
        return torch.from_numpy(np.ascontiguousarray(value)).to(first)

    @staticmethod
    def backward(context: Any, gradient: Any) -> Any:
        if torch.is_grad_enabled():
            raise RuntimeError("ahm.torch: geodesics have no second derivatives; differentiate without create_graph")
        return (*(torch.einsum("km,kmd->kd", gradient, by) for by in context.saved_tensors), None, None, None)


def _cross(a: Any, b: Any) -> Any:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _mesh(surface: SurfaceLike) -> Surface:
    on = as_body(surface)
    if on._face_count == 0:
        raise ValueError(f"surface: expected a mesh, got {on!r}; there use ahm.trace, ahm.log_map and ahm.distance, without derivatives")
    return on


def _check(value: Any, name: str) -> None:
    if not torch.is_tensor(value):
        raise TypeError(f"{name}: expected a tensor, got {arguments.describe(value)}")
    if not value.is_floating_point():
        raise TypeError(f"{name}: expected a tensor of floating-point numbers, got {value.dtype}")


def _rows(first: Any, second: Any, *names: str) -> Tuple[Any, Any, Any]:
    """Both tensors as (k, 3) of one type, and the shape of the k rows."""
    for value, name in zip((first, second), names):
        _check(value, name)
        if value.ndim == 0 or value.shape[-1] != 3:
            raise ValueError(f"{name}: expected shape (..., 3), got {tuple(value.shape)}")
    dtype = torch.promote_types(first.dtype, second.dtype)
    try:
        first, second = torch.broadcast_tensors(first.to(dtype), second.to(first.device, dtype))
    except RuntimeError:
        raise ValueError(f"{names[1]}: shape {tuple(second.shape)} does not fit the shape {tuple(first.shape)} of {names[0]}") from None
    return first.reshape(-1, 3), second.reshape(-1, 3), first.shape[:-1]


def _numbers(tensor: Any) -> np.ndarray:
    return np.ascontiguousarray(tensor.detach().cpu().double().numpy())


def _places(tensor: Any, name: str, on: Surface) -> tuple:
    return places.points(arguments.floats(_numbers(tensor), name, (None, 3), finite=True), name, on, empty=True)


def _ends(surface: SurfaceLike, source: Any, target: Any, threads: int) -> Tuple[Any, Any, Any, Tuple[np.ndarray, ...]]:
    on = _mesh(surface)
    source, target, shape = _rows(source, target, "source", "target")
    count = checked(threads=threads)["threads"]
    connected, *found = _core.geodesic_ends(on._body, _places(source, "source", on), _places(target, "target", on), count, None)
    if not connected.all():
        k = int(np.argmin(connected))
        raise ValueError(f"target[{k}]: {_numbers(target[k]).tolist()} is not connected to source[{k}], {_numbers(source[k]).tolist()}")
    return source, target, shape, tuple(found)
