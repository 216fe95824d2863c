"""Simple triangle meshes for examples and tests. Every function returns (vertices, faces)."""

from __future__ import annotations

from typing import Tuple

import numpy as np

Mesh = Tuple[np.ndarray, np.ndarray]


def plane(nx: int, ny: int, spacing: float = 1.0) -> Mesh:
    """A rectangle of nx x ny vertices in the plane z = 0, cut into right-angled triangles.

    Row i + nx * j lies at (i * spacing, j * spacing, 0).

    >>> import ahm
    >>> V, F = ahm.shapes.plane(3, 2)
    >>> V.shape, F.shape
    ((6, 3), (4, 3))
    """
    x, y = np.meshgrid(np.arange(nx), np.arange(ny))
    V = spacing * np.stack([x.ravel(), y.ravel(), np.zeros(nx * ny)], axis=1)
    a = (np.arange(nx - 1)[None, :] + nx * np.arange(ny - 1)[:, None]).ravel()
    F = np.concatenate([np.stack([a, a + 1, a + nx + 1], 1), np.stack([a, a + nx + 1, a + nx], 1)])
    return V, F.astype(np.int32)


def sphere(level: int) -> Mesh:
    """The unit sphere: an icosahedron whose triangles are divided into four, `level` times. It has 10 * 4^level + 2 vertices.

    >>> import ahm
    >>> len(ahm.shapes.sphere(2)[0])
    162
    """
    g = (1 + 5**0.5) / 2
    corners = [p for a in (-1, 1) for b in (-g, g) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    V = np.array(corners, float) / np.hypot(1, g)
    near = np.linalg.norm(V[:, None] - V[None], axis=2) < 1.1
    triples = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12)
               if near[i, j] and near[j, k] and near[i, k]]
    F = np.array([f if np.linalg.det(V[list(f)]) > 0 else (f[0], f[2], f[1]) for f in triples])
    for _ in range(level):
        V, F = _subdivided(V, F)
        V /= np.linalg.norm(V, axis=1, keepdims=True)
    return V, F.astype(np.int32)


def torus(around: int, across: int, radius: float = 1.0, tube: float = 0.4) -> Mesh:
    """A torus around the z axis with `around` x `across` vertices.

    Row i * across + j lies at the angle 2 pi i / around around the axis, and at the angle 2 pi j / across around the tube. `radius`
    is the distance from the axis to the center of the tube, and `tube` the radius of the tube.

    >>> import ahm
    >>> len(ahm.shapes.torus(20, 10)[1])
    400
    """
    a, b = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across, indexing="ij")
    r = radius + tube * np.cos(b)
    V = np.stack([r * np.cos(a), r * np.sin(a), tube * np.sin(b)], axis=2).reshape(-1, 3)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(around), np.arange(across), indexing="ij"))
    at = lambda k, m: (k % around) * across + m % across  # noqa: E731
    F = np.concatenate([np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1)], 1),
                        np.stack([at(i, j), at(i + 1, j + 1), at(i, j + 1)], 1)])
    return V, F.astype(np.int32)


def _subdivided(V: np.ndarray, F: np.ndarray) -> Mesh:
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (inverse.ravel().reshape(3, -1) + len(V))
    a, b, c = F.T
    faces = np.concatenate([np.stack(f, 1) for f in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return np.concatenate([V, V[unique].mean(axis=1)]), faces
