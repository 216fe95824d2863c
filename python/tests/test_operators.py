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


def cotangent_laplacian(V, F):
    """Dense L of (L u)_i = sum_j w_ij (u_i - u_j), w_ij the mean of the cotangents opposite of the edge."""
    L = np.zeros((len(V), len(V)))
    for s in range(3):
        i, j, k = F[:, s], F[:, (s + 1) % 3], F[:, (s + 2) % 3]
        a, b = V[i] - V[k], V[j] - V[k]
        w = 0.5 * (a * b).sum(1) / np.linalg.norm(np.cross(a, b), axis=1)
        for rows, columns, sign in ((i, j, -1), (j, i, -1), (i, i, 1), (j, j, 1)):
            np.add.at(L, (rows, columns), sign * w)
    return L


def stars(V, F):
    """For each vertex of a closed mesh: its neighbors in order, and the angles of the edges to them, with a sum of 2 pi."""
    following = [{} for _ in V]
    for face in F:
        for s in range(3):
            i, j, k = face[s], face[(s + 1) % 3], face[(s + 2) % 3]
            a, b = V[j] - V[i], V[k] - V[i]
            following[i][j] = k, np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))
    for star in following:
        ring, angles = [min(star)], [0.0]
        for _ in range(len(star) - 1):
            k, angle = star[ring[-1]]
            ring.append(k)
            angles.append(angles[-1] + angle)
        yield ring, np.array(angles) * 2 * np.pi / sum(angle for _, angle in star.values())


def products(E):
    """B^T B for the least-squares gradient B = (E^T E)^-1 E^T, which does not depend on the axes."""
    B = np.linalg.solve(E.T @ E, E.T)
    return B.T @ B


def differences_of_gradients(V, F):
    """Largest relative differences of the gradient to the least-squares gradient of DiffusionNet, up to rotations of the frames: from the
    logs of the edges, and from the edges projected to the tangent planes."""
    ops = ahm.operators(ahm.TriangleMesh(V, F, delaunay=False))
    gx, gy = (G.toarray() / ops.length_unit for G in ops.gradient)
    worst = np.zeros(2)
    for i, (ring, angles) in enumerate(stars(V, F)):
        edges = V[ring] - V[i]
        logs = np.linalg.norm(edges, axis=1)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        found = np.outer(gx[i, ring], gx[i, ring]) + np.outer(gy[i, ring], gy[i, ring])
        for c, E in enumerate((logs, edges @ ops.frames[i, :2].T)):
            worst[c] = max(worst[c], abs(found - products(E)).max() / abs(found).max())
    return worst


def test_operators_are_those_of_diffusion_net_on_curved_meshes():
    """The cotangent Laplacian, the lumped mass, and the least-squares gradient, written independently."""
    V, F = ahm.shapes.sphere(2)
    V = V * (1 + 0.1 * np.sin(5 * V[:, :1]) * np.cos(4 * V[:, 1:2]))
    ops = ahm.operators(ahm.TriangleMesh(V, F, delaunay=False, clamp_weights=False))
    expected = cotangent_laplacian(V, F)
    np.testing.assert_allclose(ops.laplacian.toarray(), expected, atol=1e-6 * abs(expected).max())
    areas = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1) / 2
    np.testing.assert_allclose(ops.mass.diagonal() * ops.length_unit**2, np.bincount(F.ravel(), np.repeat(areas / 3, 3)), rtol=1e-6)
    assert differences_of_gradients(V, F)[0] < 1e-6


def test_gradients_differ_from_those_of_projected_edges_by_the_square_of_the_edge_length():
    coarse, fine = (differences_of_gradients(*ahm.shapes.sphere(level))[1] for level in (2, 3))
    assert 3 * fine < coarse < 0.1


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
