"""Gradient and eigenpairs of `ahm.operators`."""

import numpy as np
import pytest
from scipy.sparse.linalg import eigsh

import ahm


def test_gradients_of_linear_functions_on_flat_surfaces_are_exact(flat_surfaces):
    slope = np.array([0.3, -0.7, 0.0])
    for kind in ("triangles", "polygons", "cloud"):
        surface = flat_surfaces[kind]
        ops = ahm.operators(surface)
        u = surface.points[ops.row_of_vertex] @ slope
        found = sum((G @ u)[:, None] * ops.frames[:, a] for a, G in enumerate(ops.gradient)) / ops.length_unit
        np.testing.assert_allclose(found, np.tile(slope, (len(u), 1)), atol=1e-9)


def test_gradients_are_those_of_diffusion_net_on_flat_meshes(flat_surfaces):
    """(E^T E + 1e-5 I)^-1 E^T D, with the edges E of each star in the tangent plane."""
    surface = flat_surfaces["triangles"]
    ops = ahm.operators(surface)
    gx, gy = (G.toarray() for G in ops.gradient)
    points = surface.points / ops.length_unit
    pattern = ops.transports.tolil().rows  # the Laplacian of a right-angled grid has no entries for its diagonals
    for i, row in enumerate(pattern):
        neighbors = [j for j in row if j != i]
        E = (points[neighbors] - points[i]) @ ops.frames[i, :2].T
        expected = np.linalg.solve(E.T @ E + 1e-5 * np.eye(2), E.T)
        np.testing.assert_allclose([gx[i, neighbors], gy[i, neighbors]], expected, atol=1e-3 * abs(expected).max())
        np.testing.assert_allclose([gx[i, i], gy[i, i]], -np.array([gx[i, neighbors], gy[i, neighbors]]).sum(axis=1), atol=1e-12)


def test_eigenpairs_are_those_of_scipy(sphere, flat_surfaces):
    for surface in (sphere, ahm.PointCloud(sphere.points), flat_surfaces["refined"], flat_surfaces["grid"]):
        ops = ahm.operators(surface, k_eig=20)
        expected = eigsh(ops.laplacian.tocsc(), k=20, M=ops.mass.tocsc(), sigma=-0.01)[0]
        np.testing.assert_allclose(ops.eigenvalues, np.sort(expected), atol=1e-9 * max(expected))
        X = ops.eigenvectors
        np.testing.assert_allclose(X.T @ (ops.mass @ X), np.eye(20), atol=1e-9)
        np.testing.assert_allclose(ops.laplacian @ X, (ops.mass @ X) * ops.eigenvalues, atol=1e-9 * max(expected))


def test_eigenvalues_of_the_sphere_have_their_multiplicities():
    ops = ahm.operators(ahm.TriangleMesh(*ahm.shapes.sphere(4)), k_eig=49)
    degree = np.repeat(np.arange(7), 2 * np.arange(7) + 1)
    np.testing.assert_allclose(ops.eigenvalues / ops.length_unit**2, degree * (degree + 1), rtol=0.03, atol=1e-9)


def test_disconnected_surfaces_have_a_kernel_per_component(sphere):
    two = ahm.TriangleMesh(np.vstack([sphere.points, sphere.points + 5]), np.vstack([sphere.faces, sphere.faces + len(sphere)]))
    ops = ahm.operators(two, k_eig=8)
    np.testing.assert_allclose(ops.eigenvalues[:2], 0, atol=1e-10)
    np.testing.assert_allclose(ops.eigenvalues[2:] / ops.length_unit**2, 2, rtol=0.02)


def test_numbers_of_eigenpairs_are_checked(sphere):
    assert ahm.operators(sphere).eigenvalues is None
    for bad in (0, len(sphere) + 1):
        with pytest.raises(ValueError, match="k_eig"):
            ahm.operators(sphere, k_eig=bad)
    with pytest.raises(TypeError, match="k_eig"):
        ahm.operators(sphere, k_eig=1.5)
