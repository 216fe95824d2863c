"""Derivatives of geodesics by points on the surface. Skipped without torch."""

import numpy as np
import pytest

import ahm

torch = pytest.importorskip("torch")
import ahm.torch  # noqa: E402


def bumpy_sphere():
    V, F = ahm.shapes.sphere(3)
    return V * (1 + 0.15 * np.sin(5 * V[:, :1]) * np.cos(4 * V[:, 1:2] + V[:, 2:])), F


@pytest.fixture(scope="module", params=["plane", "sphere", "bumps"])
def mesh(request):
    shapes = {"plane": lambda: ahm.shapes.plane(9, 8, 0.25), "sphere": lambda: ahm.shapes.sphere(3), "bumps": bumpy_sphere}
    return ahm.TriangleMesh(*shapes[request.param]())


def points(mesh, count, seed=1, grad=True):
    """Positions inside faces, away from their sides."""
    random = np.random.default_rng(seed)
    face = random.integers(0, len(mesh.faces), count)
    weight = random.uniform(0.2, 1, (count, 3))
    found = np.einsum("kc,kcd->kd", weight / weight.sum(1, keepdims=True), mesh.points[mesh.faces[face]])
    return torch.tensor(found, requires_grad=grad)


def vectors(count, length, seed=2):
    found = np.random.default_rng(seed).normal(size=(count, 3))
    return torch.tensor(length * found / np.linalg.norm(found, axis=1, keepdims=True), requires_grad=True)


def position(mesh, point, vector):
    return ahm.torch.trace(mesh, point, vector).position


def test_gradcheck(mesh):
    p, q, v = points(mesh, 8), points(mesh, 8, seed=5), vectors(8, 0.4)
    assert torch.autograd.gradcheck(lambda p, v: position(mesh, p, v), (p, v))
    assert torch.autograd.gradcheck(lambda p, q: ahm.torch.distance(mesh, p, q), (p, q))
    assert torch.autograd.gradcheck(lambda p, q: ahm.torch.log(mesh, p, q), (p, q))
    assert torch.autograd.gradcheck(lambda p, v: ahm.torch.distance(mesh, position(mesh, p, v), q.detach()), (p, v))


def test_gradcheck_of_interpolation(mesh):
    m = ahm.log_map(mesh, 30, method="exact")
    uv = vectors(8, 0.37)[:, :2].detach().requires_grad_()
    values = torch.tensor(np.random.default_rng(0).normal(size=(len(mesh), 2)), requires_grad=True)
    assert ahm.torch.sample(values, m, uv).valid.any()
    assert torch.autograd.gradcheck(lambda values, uv: ahm.torch.sample(values, m, uv).value, (values, uv))


def test_interpolation_is_that_of_the_inverse_map(mesh):
    m = ahm.log_map(mesh, 30)
    uv = np.random.default_rng(1).uniform(-0.9, 0.9, (5, 7, 2))
    found = ahm.torch.sample(torch.tensor(mesh.points), m, torch.tensor(uv))
    expected = m.inverse(uv.reshape(-1, 2))
    assert found.value.shape == (5, 7, 3) and found.valid.shape == (5, 7)
    np.testing.assert_array_equal(found.valid.reshape(-1), expected.valid)
    np.testing.assert_allclose(found.value.reshape(-1, 3), np.nan_to_num(expected.position), atol=1e-12)
    inverse = ahm.InverseMap(m, min_quality=0)
    single = ahm.torch.sample(torch.tensor(mesh.points[:, 0]).float(), inverse, torch.tensor([0.1, 0.05]))
    assert single.value.dtype == torch.float32 and single.value.shape == ()
    np.testing.assert_allclose(single.value, inverse([[0.1, 0.05]]).position[0, 0], atol=1e-6)


def test_values_are_those_of_the_functions_without_derivatives(mesh):
    p, q, v = (x.detach() for x in (points(mesh, 6), points(mesh, 6, seed=5), vectors(6, 0.4)))
    paths = ahm.geodesic_paths(mesh, p.numpy(), q.numpy(), pairwise=True)
    np.testing.assert_allclose(ahm.torch.distance(mesh, p, q), [path.length for path in paths], atol=1e-12)
    start = [(path.points[1] - path.points[0]) / np.linalg.norm(path.points[1] - path.points[0]) for path in paths]
    np.testing.assert_allclose(ahm.torch.log(mesh, p, q), [path.length * d for path, d in zip(paths, start)], atol=1e-9)
    traced = ahm.torch.trace(mesh, p, v)
    for k in range(6):
        normal = mesh.closest_points(p[k : k + 1].numpy()).face[0]
        a, b, c = mesh.points[mesh.faces[normal]]
        n = np.cross(b - a, c - a) / np.linalg.norm(np.cross(b - a, c - a))
        along = v[k].numpy() - n * (n @ v[k].numpy())
        path = ahm.trace(mesh, p[k].numpy(), along)
        np.testing.assert_allclose(traced.position[k], path.points[-1], atol=1e-12)
        assert bool(traced.complete[k]) == path.complete


def test_the_log_map_is_the_inverse_of_the_trace(mesh):
    rows = torch.tensor(mesh.points[[30, 31, 44]])
    for p in (points(mesh, 12, grad=False), rows):
        v = ahm.torch.log(mesh, p, position(mesh, p, vectors(len(p), 0.2))).detach()  # tangent
        torch.testing.assert_close(ahm.torch.log(mesh, p, position(mesh, p, v)), v, rtol=0, atol=1e-9)


def test_derivatives_of_the_distance_are_differences_of_the_public_distance(mesh):
    p, q = points(mesh, 5), points(mesh, 5, seed=5)
    ahm.torch.distance(mesh, p, q).sum().backward()
    h = 1e-6
    for k in range(5):
        def away(source, target):
            return float(ahm.distance(mesh, source, targets=target[None], method="exact")[0])

        a, b = p[k].detach().numpy(), q[k].detach().numpy()
        for axis in np.eye(3):
            by_source = (away(a + h * axis, b) - away(a - h * axis, b)) / (2 * h)
            by_target = (away(a, b + h * axis) - away(a, b - h * axis)) / (2 * h)
            assert abs(by_source - float(p.grad[k] @ axis)) < 1e-7 and abs(by_target - float(q.grad[k] @ axis)) < 1e-7


def test_a_mean_by_descent_is_the_karcher_mean():
    mesh = ahm.TriangleMesh(*bumpy_sphere())
    landmarks = torch.tensor(mesh.points[[3, 20, 100, 200]])
    x = landmarks[0]
    for _ in range(30):
        x = x.detach().requires_grad_()
        (0.5 * ahm.torch.distance(mesh, x, landmarks) ** 2).mean().backward()
        step = -x.grad
        x = position(mesh, x.detach(), step)
    mean = torch.from_numpy(ahm.karcher_mean(mesh, [3, 20, 100, 200], method="exact").position)
    energy = [float((ahm.torch.distance(mesh, y, landmarks) ** 2).mean()) for y in (x, mean)]
    assert float(step.norm()) < 1e-9 and energy[0] <= energy[1] < 1.001 * energy[0]


def test_a_geodesic_that_ends_at_the_boundary_has_the_derivatives_of_its_end():
    plane = ahm.TriangleMesh(*ahm.shapes.plane(5, 5))
    p = torch.tensor([[1.2, 2.1, 0.0], [2.3, 2.2, 0.0]], dtype=torch.float64, requires_grad=True)
    v = torch.tensor([[7.0, 3.0, 1.0], [0.5, 0.4, 0.0]], dtype=torch.float64, requires_grad=True)
    traced = ahm.torch.trace(plane, p, v)
    assert traced.complete.tolist() == [False, True]
    torch.testing.assert_close(traced.position[0], torch.tensor([4.0, 3.3, 0.0], dtype=torch.float64), rtol=0, atol=1e-12)
    assert torch.autograd.gradcheck(lambda p, v: position(plane, p, v), (p, v))


def test_shapes_types_and_equal_points(mesh):
    p, q = points(mesh, 4).detach(), points(mesh, 3, seed=5).detach()
    table = ahm.torch.distance(mesh, p[:, None], q[None], threads=1)
    assert table.shape == (4, 3) and ahm.torch.log(mesh, p[:, None], q).shape == (4, 3, 3)
    torch.testing.assert_close(table[2], ahm.torch.distance(mesh, p[2], q), rtol=0, atol=0)
    single = p[0].float().requires_grad_()
    found = ahm.torch.distance(mesh, single, q[0].float())
    found.backward()
    assert found.shape == () and found.dtype == single.grad.dtype == torch.float32
    same = p[0].clone().requires_grad_()
    zero = ahm.torch.distance(mesh, same, p[0])
    zero.backward()
    assert float(zero) == 0 and same.grad.tolist() == [0, 0, 0]
    assert ahm.torch.log(mesh, p[:0], q[:0]).shape == (0, 3) and ahm.torch.trace(mesh, p[:0], q[:0]).complete.shape == (0,)


def test_at_the_cut_locus_the_derivative_is_that_of_one_path():
    square, F = ahm.shapes.plane(3, 3)
    V = np.vstack([square, square + [0, 0, 1e-3]])
    rim = [0, 1, 2, 5, 8, 7, 6, 3]
    sides = [f for a, b in zip(rim, rim[1:] + rim[:1]) for f in ((a, b, b + 9), (a, b + 9, a + 9))]
    pillow = ahm.TriangleMesh(V, np.vstack([F[:, ::-1], F + 9, sides]))
    top = torch.tensor([1.01, 1.0, 1e-3], dtype=torch.float64, requires_grad=True)
    bottom = torch.tensor([1.01, 1.0, 0.0], dtype=torch.float64)
    ahm.torch.distance(pillow, top, bottom).backward()
    np.testing.assert_allclose(top.grad.abs().numpy(), [1, 0, 0], atol=1e-3)   # to the nearer side
    assert bool(torch.isfinite(ahm.torch.log(pillow, top, bottom)).all())
    top = torch.tensor([1.0, 1.0, 1e-3], dtype=torch.float64, requires_grad=True)
    ahm.torch.distance(pillow, top, bottom * torch.tensor([1 / 1.01, 1, 1])).backward()
    np.testing.assert_allclose(sorted(top.grad.abs().tolist()), [0, 0, 1], atol=1e-3)   # to one of four sides


def test_positions_off_the_surface_are_those_of_the_nearest_points(mesh):
    p, q = points(mesh, 5), points(mesh, 5, seed=5, grad=False)
    near = mesh.closest_points(p.detach().numpy())
    a, b, c = np.moveaxis(mesh.points[mesh.faces[near.face]], 1, 0)
    normal = np.cross(b - a, c - a)
    off = (p.detach() + 0.01 * torch.tensor(normal / np.linalg.norm(normal, axis=1, keepdims=True))).requires_grad_()
    for x in (p, off):
        ahm.torch.distance(mesh, x, q).sum().backward()
    torch.testing.assert_close(off.grad, p.grad, rtol=0, atol=1e-9)
    np.testing.assert_allclose(np.einsum("kd,kd->k", off.grad, normal), 0, atol=1e-9)


def test_second_derivatives_are_refused(mesh):
    p, q = points(mesh, 2), points(mesh, 2, seed=5, grad=False)
    with pytest.raises(RuntimeError, match="geodesics have no second derivatives"):
        torch.autograd.grad(ahm.torch.distance(mesh, p, q).sum(), p, create_graph=True)


def test_faults_are_named(sphere):
    p, far = torch.zeros(2, 3), torch.tensor([[0.0, 0, 1], [float("nan"), 0, 0]])
    for call, error, text in [
            (lambda: ahm.torch.distance(sphere, [0, 0, 1], p), TypeError, "source: expected a tensor"),
            (lambda: ahm.torch.distance(sphere, p, torch.tensor([1, 2, 3])), TypeError, "target: expected a tensor of floating-point"),
            (lambda: ahm.torch.log(sphere, p, p[:, :2]), ValueError, r"target: expected shape \(\.\.\., 3\), got \(2, 2\)"),
            (lambda: ahm.torch.log(sphere, p, torch.zeros(3, 3)), ValueError, r"target: shape \(3, 3\) does not fit"),
            (lambda: ahm.torch.distance(sphere, p, far), ValueError, r"target\[1, 0\]: nan is not finite"),
            (lambda: ahm.torch.trace(sphere, p, far), ValueError, r"vector\[1, 0\]: nan is not finite"),
            (lambda: ahm.torch.distance(sphere, p, p, threads=-1), ValueError, "threads"),
            (lambda: ahm.torch.distance(ahm.PointCloud(sphere.points), p, p), ValueError, "surface: expected a mesh, got .*; there use ahm.trace"),
            (lambda: ahm.torch.log(ahm.PointCloud(sphere.points), p, p), ValueError, "surface: expected a mesh, got .*; there use ahm.trace"),
            (lambda: ahm.torch.trace(ahm.PointCloud(sphere.points), p, p), ValueError, "surface: expected a mesh, got .*; there use ahm.trace"),
            (lambda: ahm.torch.sample(torch.zeros(5), ahm.log_map(sphere, 0), p[:, :2]), ValueError, r"values: expected one entry per row"),
            (lambda: ahm.torch.sample(torch.zeros(642), sphere, p[:, :2]), TypeError, "map: expected a LogMap"),
            (lambda: ahm.torch.sample(torch.zeros(642), ahm.log_map(sphere, 0), p), ValueError, r"uv: expected shape \(\.\.\., 2\)"),
            (lambda: ahm.torch.sample(torch.zeros(642), ahm.log_map(sphere, 0), far[:, :2]), ValueError, r"uv\[1, 0\]: nan")]:
        with pytest.raises(error, match=text):
            call()
    two = ahm.TriangleMesh(np.vstack([sphere.points, sphere.points + [5, 0, 0]]), np.vstack([sphere.faces, sphere.faces + 642]))
    with pytest.raises(ValueError, match=r"target\[1\]: .* is not connected to source\[1\]"):
        ahm.torch.distance(two, torch.tensor([[0.0, 0, 1]]), torch.tensor([[0.0, 1, 0], [5.0, 0, 1]]))
    corner = ahm.TriangleMesh(*ahm.shapes.plane(3, 3))
    with pytest.raises(ValueError, match=r"point\[0\]: the direction leaves the surface at vertex"):
        ahm.torch.trace(corner, torch.tensor([0.0, 0, 0]), torch.tensor([-1.0, -1, 0]))
