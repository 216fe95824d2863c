"""Local maps as tensors. Skipped without torch."""

import copy
import types

import numpy as np
import pytest

import ahm

torch = pytest.importorskip("torch")
import ahm.torch  # noqa: E402


def as_data(positions, faces=None):
    data = types.SimpleNamespace(pos=torch.from_numpy(np.array(positions, float)))
    if faces is not None:
        data.face = torch.from_numpy(np.ascontiguousarray(np.asarray(faces, np.int64).T))
    return data


def test_edges_are_the_entries_of_the_maps(sphere):
    maps = ahm.local_maps(sphere, 0.4)
    found = ahm.torch.edges(maps)
    assert found.edge_index.dtype == torch.int64 and found.log.dtype == torch.float32 and found.transport.dtype == torch.complex64
    np.testing.assert_array_equal(found.edge_index, maps.edge_index())
    np.testing.assert_allclose(found.log, maps.log, atol=1e-6)
    np.testing.assert_allclose(found.distance, maps.distance, atol=1e-6)
    np.testing.assert_allclose(found.weight, maps.weight, rtol=1e-6)
    assert ahm.torch.edges(ahm.local_maps(sphere, 0.4, transport=False)).transport is None


def test_edges_in_double_precision_share_the_memory_of_the_maps(sphere):
    maps = ahm.local_maps(sphere, 0.4, quality=True)
    found, single = ahm.torch.edges(maps, torch.float64), ahm.torch.edges(maps)
    for name in ("log", "distance", "weight", "quality", "transport"):
        tensor, values = getattr(found, name), getattr(maps, name)
        assert tensor.data_ptr() == values.ctypes.data and tensor.dtype in (torch.float64, torch.complex128)
        torch.testing.assert_close(tensor.resolve_conj(), getattr(single, name).to(tensor.dtype), rtol=1e-6, atol=1e-6)
        before = getattr(single, name).clone()
        values[7] = 0.5
        assert complex(tensor.resolve_conj()[7].flatten()[0]).real == 0.5
        assert bool((getattr(single, name) == before).all())
    with pytest.raises(ValueError, match="dtype"):
        ahm.torch.edges(maps, torch.float16)


@pytest.mark.filterwarnings("ignore:Sparse CSR tensor support")
def test_compressed_rows_and_coordinates_are_one_matrix(sphere):
    """The offsets share the memory of the maps of all rows. As matrices both forms are that of scipy."""
    maps = ahm.local_maps(sphere, 0.4)
    found = ahm.torch.edges(maps)
    assert found.indptr.data_ptr() == maps.indptr.ctypes.data and found.indptr.dtype == torch.int64
    n = len(sphere)
    assert torch.equal(torch.repeat_interleave(torch.arange(n), found.indptr.diff()), found.edge_index[1])
    assert torch.equal(torch.searchsorted(found.edge_index[1], torch.arange(n + 1)), found.indptr)
    matrix = torch.sparse_coo_tensor(found.edge_index.flip(0), found.weight, (n, n)).to_sparse_csr()
    assert torch.equal(matrix.crow_indices(), found.indptr)
    np.testing.assert_allclose(matrix.to_dense(), maps.csr("weight").toarray(), rtol=1e-6)


@pytest.mark.parametrize("kind", ["mesh", "cloud"])
def test_maps_of_some_sources_are_those_of_all_restricted(sphere, kind):
    """In any order. The other rows have no edges, and compressed rows still have an offset for each of them."""
    surface = sphere if kind == "mesh" else ahm.PointCloud(sphere.points)
    options = dict(radius=0.4, method="polar", quality=True)
    whole = ahm.torch.edges(ahm.local_maps(surface, **options), torch.float64)
    chosen = np.random.default_rng(1).choice(len(surface), 60, replace=False)
    for sources in (chosen, np.sort(chosen), chosen[:0], np.arange(len(surface))):
        found = ahm.torch.edges(ahm.local_maps(surface, sources=sources, **options), torch.float64)
        kept = torch.from_numpy(np.isin(whole.edge_index[1], sources))
        assert torch.equal(found.edge_index, whole.edge_index[:, kept])
        assert torch.equal(found.indptr.diff(), whole.indptr.diff() * torch.from_numpy(np.isin(np.arange(len(surface)), sources)))
        for name in ("log", "transport", "distance", "weight", "quality"):
            torch.testing.assert_close(getattr(found, name), getattr(whole, name)[kept], rtol=0, atol=0)


def test_maps_of_many_sources_are_those_of_a_few_at_a_time():
    """Polar maps are computed in batches of several thousand sources."""
    mesh = ahm.TriangleMesh(*ahm.shapes.sphere(5))
    rows = np.arange(len(mesh))
    for options in (dict(k=6), dict(radius=0.05)):
        whole = ahm.local_maps(mesh, method="polar", quality=True, **options)
        parts = [ahm.local_maps(mesh, method="polar", quality=True, sources=part, **options) for part in np.array_split(rows, 4)]
        assert np.array_equal(np.diff(whole.indptr), np.concatenate([np.diff(part.indptr) for part in parts]))
        for name in ("indices", "log", "distance", "weight", "transport", "quality"):
            assert np.array_equal(getattr(whole, name), np.concatenate([getattr(part, name) for part in parts]))


def test_maps_by_heat_depend_on_other_sources_by_the_margin_only(sphere):
    """Sources share patches, whose ends differ."""
    options = dict(radius=0.4, method="heat")
    whole, some = ahm.local_maps(sphere, **options), ahm.local_maps(sphere, sources=[600, 7, 12], **options)
    for axis in "uv":
        expected, found = whole.csr(axis).toarray()[[600, 7, 12]], some.csr(axis).toarray()
        np.testing.assert_allclose(found, expected, atol=2e-4 * 0.4)


def test_a_transform_takes_sources(sphere, tmp_path, computed):
    """As rows, or from an attribute of each object. The cache distinguishes them."""
    chosen = [7, 3, 11, 3]
    expected = ahm.torch.edges(ahm.local_maps(sphere, k=8, sources=[3, 7, 11]))
    for sources in (chosen, np.array(chosen), torch.tensor(chosen)):
        found = ahm.torch.LocalMaps(k=8, sources=sources)(as_data(sphere.points, sphere.faces))
        assert_same(found, expected)
        assert found.edge_index[1].tolist() == 8 * [3] + 8 * [7] + 8 * [11]
    data = as_data(sphere.points, sphere.faces)
    data.seeds = torch.tensor(chosen)
    assert_same(ahm.torch.LocalMaps(k=8, sources="seeds", cache=tmp_path)(data), expected)
    computed.clear()
    assert_same(ahm.torch.LocalMaps(k=8, sources=chosen, cache=tmp_path)(as_data(sphere.points, sphere.faces)), expected)
    assert len(computed) == 0
    for count, sources in enumerate((None, [3, 7], [])):
        data = ahm.torch.LocalMaps(k=8, sources=sources, cache=tmp_path)(as_data(sphere.points, sphere.faces))
        assert len(computed) == count + 1 and data.edge_index.shape == (2, 8 * (len(sphere) if sources is None else len(sources)))
    for bad, error, text in (([0, 642], ValueError, r"sources\[1\]: row 642 is out of range"), ([0.5], TypeError, "sources: rows"),
                             ("seeds", AttributeError, "seeds")):
        with pytest.raises(error, match=text):
            ahm.torch.LocalMaps(k=8, sources=bad)(as_data(sphere.points, sphere.faces))
    assert "sources=[7, 3, 11, 3]" in repr(ahm.torch.LocalMaps(k=8, sources=chosen))


def test_a_transform_passes_options_to_the_surface(sphere, tmp_path, computed):
    """Two spheres that share a vertex are cut apart there. Points that are not finite are dropped."""
    positions, faces = sphere.points, sphere.faces
    both = np.vstack([positions, positions + 2 * positions[0]])
    far = int(np.argmin(((both[642:] - positions[0])**2).sum(1))) + 642
    joined = np.vstack([faces, np.where(faces + 642 == far, 0, faces + 642)])
    mesh = lambda: as_data(both, joined)  # noqa: E731
    with pytest.raises(ValueError, match="non_manifold='split'"):
        ahm.torch.LocalMaps(k=8)(mesh())
    split = ahm.torch.edges(ahm.local_maps(ahm.TriangleMesh(both, joined, non_manifold="split"), k=8))
    assert_same(ahm.torch.LocalMaps(k=8, non_manifold="split", cache=tmp_path)(mesh()), split)
    positions = np.vstack([positions, [[np.nan, 0, 0]]])
    with pytest.raises(ValueError, match="642"):
        ahm.torch.LocalMaps(k=8)(as_data(positions))
    dropped = ahm.torch.LocalMaps(k=8, drop_non_finite=True)(as_data(positions))
    assert_same(dropped, ahm.torch.edges(ahm.local_maps(ahm.PointCloud(positions, drop_non_finite=True), k=8)))
    assert int(dropped.edge_index.max()) == 641 and bool(torch.isfinite(dropped.log).all())

    computed.clear()
    for options in (dict(rows=np.arange(600)), dict(rows=np.arange(601)), dict(smooth=0.1), dict(smooth=0)):
        ahm.torch.LocalMaps(k=8, cache=tmp_path, **options)(as_data(sphere.points))
    ahm.torch.LocalMaps(k=8, cache=tmp_path, rows=list(range(601)))(as_data(sphere.points))
    assert len(computed) == 4


def test_options_of_the_surface_are_named(sphere):
    with pytest.raises(TypeError, match=r"LocalMaps.__init__\(\) got an unexpected keyword argument 'nonmanifold'"):
        ahm.torch.LocalMaps(k=8, nonmanifold="split")
    with pytest.raises(ValueError, match="non_manifold: 'cut' is not one of"):
        ahm.torch.LocalMaps(k=8, non_manifold="cut")(as_data(sphere.points, sphere.faces))
    with pytest.raises(TypeError, match="unexpected keyword argument 'non_manifold'"):
        ahm.torch.LocalMaps(k=8, non_manifold="split")(as_data(sphere.points))


def test_quality_is_that_of_the_maps(sphere):
    maps = ahm.local_maps(sphere, 0.4, quality=True)
    quality = ahm.torch.edges(maps).quality
    np.testing.assert_allclose(quality, maps.quality, rtol=1e-6)
    data = as_data(sphere.points, sphere.faces)
    torch.testing.assert_close(ahm.torch.LocalMaps(radius=0.4, quality=True)(data).quality, quality)
    assert ahm.torch.edges(ahm.local_maps(sphere, 0.4)).quality is None
    assert not hasattr(ahm.torch.LocalMaps(radius=0.4)(as_data(sphere.points, sphere.faces)), "quality")


def test_messages_of_a_constant_field_on_a_plane_agree(flat_surfaces):
    """Vectors of the neighbors, transported to the source, are the vector there."""
    plane = flat_surfaces["triangles"]
    found = ahm.torch.edges(ahm.local_maps(plane, k=20))
    axes = torch.from_numpy(plane.frames).float()
    vector = torch.tensor([0.3, -0.7, 0.0]).expand(len(axes), 3)
    components = torch.complex((axes[:, 0] * vector).sum(1), (axes[:, 1] * vector).sum(1))
    neighbor, source = found.edge_index
    torch.testing.assert_close(components[neighbor] * found.transport, components[source], rtol=1e-5, atol=1e-5)


def test_the_direction_back_is_the_opposite_one(sphere):
    """At j the source i lies in the direction opposite to that of j at i, transported along the path between them."""
    found = ahm.torch.edges(ahm.local_maps(sphere, 0.3))
    at = {(int(j), int(i)): e for e, (j, i) in enumerate(found.edge_index.T)}
    log = torch.complex(found.log[:, 0], found.log[:, 1])
    back = [at[i, j] for j, i in at]
    here = found.distance > 0
    difference = (log[back] * found.transport + log).abs()[here] / found.distance[here]
    assert difference.median() < 0.02


def test_a_transform_fills_data_of_meshes_and_clouds(sphere):
    transform = ahm.torch.LocalMaps(k=12)
    mesh = transform(as_data(sphere.points, sphere.faces))
    expected = ahm.torch.edges(ahm.local_maps(sphere, k=12))
    for name in ("edge_index", "log", "transport", "distance", "weight"):
        torch.testing.assert_close(getattr(mesh, name), getattr(expected, name))
    cloud = transform(as_data(sphere.points))
    torch.testing.assert_close(cloud.log, ahm.torch.edges(ahm.local_maps(ahm.PointCloud(sphere.points), k=12)).log)
    assert repr(copy.deepcopy(transform)) == "ahm.torch.LocalMaps(k=12, transport=True, quality=False, threads=0, method='auto')"


def as_dictionary(data):
    return {name: getattr(data, name) for name in ("edge_index", "log", "transport", "distance", "weight")}


def assert_same(one, other):
    for name, values in as_dictionary(one).items():
        assert values.dtype == getattr(other, name).dtype and torch.equal(values, getattr(other, name))


@pytest.fixture
def computed(monkeypatch):
    """A list with one entry for every computation of local maps."""
    calls, compute = [], ahm.torch.local_maps
    monkeypatch.setattr(ahm.torch, "local_maps", lambda *args, **options: calls.append(options) or compute(*args, **options))
    return calls


def test_a_cached_transform_computes_once(sphere, tmp_path, computed):
    mesh = lambda scale=1.0: as_data(sphere.points * scale, sphere.faces)  # noqa: E731
    folder = tmp_path / "new" / "cache"
    expected = ahm.torch.LocalMaps(k=8)(mesh())
    computed.clear()
    for threads in (0, 1):
        assert_same(ahm.torch.LocalMaps(k=8, threads=threads, cache=folder)(mesh()), expected)
    assert len(computed) == 1 and [path.suffix for path in folder.iterdir()] == [".maps"]
    transform = ahm.torch.LocalMaps(k=8, cache=folder)
    assert_same(copy.deepcopy(transform)(mesh()), expected)
    assert len(computed) == 1 and repr(transform).endswith(f"cache={str(folder)!r})")


def test_the_cache_distinguishes_contents_options_and_versions(sphere, tmp_path, computed, monkeypatch):
    turned = np.roll(sphere.faces, 1, axis=1)
    for count, (options, data) in enumerate([
            (dict(k=8), as_data(sphere.points, sphere.faces)), (dict(k=9), as_data(sphere.points, sphere.faces)),
            (dict(k=8, method="heat"), as_data(sphere.points, sphere.faces)), (dict(k=8, radius=0.3), as_data(sphere.points, sphere.faces)),
            (dict(k=8), as_data(np.nextafter(sphere.points, 2), sphere.faces)), (dict(k=8), as_data(sphere.points, turned)),
            (dict(k=8), as_data(sphere.points))], start=1):
        ahm.torch.LocalMaps(**options, cache=tmp_path)(data)
        assert len(computed) == count
    monkeypatch.setattr(ahm, "__version__", "0.0.0")
    ahm.torch.LocalMaps(k=8, cache=tmp_path)(as_data(sphere.points, sphere.faces))
    assert len(computed) == 8


def test_damaged_and_foreign_files_are_computed_again(sphere, tmp_path, computed):
    transform = ahm.torch.LocalMaps(k=8, cache=tmp_path)
    expected = transform(as_data(sphere.points, sphere.faces))
    stored, = tmp_path.iterdir()
    whole = stored.read_bytes()
    transform(as_data(sphere.points * 2, sphere.faces))
    other, = set(tmp_path.iterdir()) - {stored}
    flipped = bytearray(whole)
    flipped[len(whole) // 2] ^= 1
    for count, damaged in enumerate([whole[:-100], b"", bytes(flipped), b"not a cache" * 9, other.read_bytes()], start=3):
        stored.write_bytes(damaged)
        assert_same(transform(as_data(sphere.points, sphere.faces)), expected)
        assert len(computed) == count and stored.read_bytes() == whole


def test_several_writers_may_store_the_same_entry_at_once(sphere, tmp_path):
    from concurrent.futures import ThreadPoolExecutor

    transform = ahm.torch.LocalMaps(k=8, threads=1, cache=tmp_path)
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda _: transform(as_data(sphere.points, sphere.faces)), range(16)))
    for data in found[1:]:
        assert_same(data, found[0])
    assert [path.suffix for path in tmp_path.iterdir()] == [".maps"]


def test_operators_are_by_rows_in_world_units(sphere):
    """On a sphere of radius 300, by rows: eigenvalues l (l + 1) / r^2, orthonormal vectors, gradients of coordinates along the axes."""
    for surface in (ahm.TriangleMesh(sphere.points * 300, sphere.faces), ahm.PointCloud(sphere.points * 300)):
        ops = ahm.torch.operators(surface, k_eig=9)
        expected = torch.tensor([0.0, 2, 2, 2, 6, 6, 6, 6, 6]) / 300**2
        torch.testing.assert_close(ops.eigenvalues, expected, rtol=0.05, atol=1e-9)
        X = ops.eigenvectors
        torch.testing.assert_close(X.T @ (ops.mass[:, None] * X), torch.eye(9), rtol=0, atol=1e-4)
        assert abs(float(ops.mass.sum()) / (4 * np.pi * 300**2) - 1) < 0.05
        height = torch.from_numpy(surface.points[:, 2:].astype(np.float32))
        found = torch.cat([torch.sparse.mm(G, height) for G in (ops.grad_x, ops.grad_y)], 1)
        torch.testing.assert_close(found, ops.frames[:, :2, 2], rtol=0, atol=0.05)
        torch.testing.assert_close(ops.frames.double(), torch.from_numpy(surface.frames), rtol=0, atol=1e-6)


def test_the_connection_laplacian_is_that_of_scipy_by_rows(sphere):
    """Hermitian and positive semi-definite. On a curved surface no field is parallel."""
    for surface in (sphere, ahm.PointCloud(sphere.points)):
        found = ahm.torch.operators(surface, k_eig=2).connection_laplacian
        made = ahm.operators(surface)
        matrix = found.to_dense().numpy()
        assert found.dtype == torch.complex64 and found.is_coalesced()
        vertex = made.vertex_of_row
        np.testing.assert_allclose(matrix, made.connection_laplacian.toarray()[vertex][:, vertex], atol=1e-6 * abs(matrix).max())
        np.testing.assert_allclose(matrix, matrix.conj().T, atol=1e-6 * abs(matrix).max())
        values = np.linalg.eigvalsh(matrix.astype(complex))
        assert 1e-4 * values[-1] < values[0]


def test_parallel_fields_are_the_kernel_of_the_connection_laplacian(flat_surfaces):
    for kind in ("triangles", "cloud"):
        surface = flat_surfaces[kind]
        ops = ahm.torch.operators(surface, k_eig=2)
        field = (ops.frames[:, :2] @ torch.tensor([0.3, -0.7, 0.0])).unsqueeze(2)
        field = torch.complex(field[:, 0], field[:, 1])
        assert torch.sparse.mm(ops.connection_laplacian, field).abs().max() < 1e-5
        values = np.linalg.eigvalsh(ops.connection_laplacian.to_dense().numpy().astype(complex))
        assert values[0] > -1e-6 * values[-1] and values[1] > 1e-5 * values[-1]      # the constant fields only


def test_products_with_the_connection_laplacian_have_derivatives(sphere):
    matrix = ahm.torch.operators(sphere, k_eig=2).connection_laplacian
    field = torch.randn(len(sphere), 2, dtype=torch.complex64, generator=torch.Generator().manual_seed(1)).requires_grad_()
    energy = (field.conj() * torch.sparse.mm(matrix, field)).sum().real
    energy.backward()
    torch.testing.assert_close(field.grad, 2 * torch.sparse.mm(matrix, field.detach()), rtol=1e-4, atol=1e-4)


def test_the_connection_laplacian_is_real_where_there_is_no_orientation():
    band = ahm.TriangleMesh(*moebius_band())
    n, ops = len(band), ahm.torch.operators(band, k_eig=2)
    matrix = ops.connection_laplacian.to_dense().double()
    assert ops.connection_laplacian.dtype == torch.float32 and matrix.shape == (2 * n, 2 * n)
    torch.testing.assert_close(matrix, matrix.T, rtol=0, atol=1e-5)
    assert torch.linalg.eigvalsh(matrix)[0] > -1e-5
    made = ahm.operators(band)
    order = (2 * made.vertex_of_row[:, None] + [0, 1]).ravel()
    np.testing.assert_allclose(matrix, made.connection_laplacian.toarray()[order][:, order], atol=1e-5)


def test_operators_name_rows_that_have_no_vertex_of_their_own(plane, flat_surfaces):
    positions, faces = plane
    with pytest.raises(ValueError, match="row 143 has no vertex"):
        ahm.torch.operators(ahm.TriangleMesh(np.vstack([positions, [[50.0, 50, 50]]]), faces), k_eig=4)
    with pytest.raises(ValueError, match="not in the input"):
        ahm.torch.operators(flat_surfaces["refined"], k_eig=4)


def test_rows_without_a_vertex_have_no_edges(plane):
    positions, faces = plane
    loose = lambda: as_data(np.vstack([positions, [[50.0, 50, 50]]]), faces)  # noqa: E731
    data = ahm.torch.LocalMaps(radius=2.0)(loose())
    assert int(data.edge_index.max()) == len(positions) - 1
    some = ahm.torch.LocalMaps(radius=2.0, sources=[len(positions), 7])(loose())
    kept = data.edge_index[1] == 7
    assert torch.equal(some.edge_index, data.edge_index[:, kept]) and torch.equal(some.log, data.log[kept])
    assert all(bool(torch.isfinite(t).all()) for t in (data.log, data.transport.real, data.distance, data.weight))


def test_arguments_are_named(sphere):
    with pytest.raises(ValueError, match="radius: missing"):
        ahm.torch.LocalMaps()
    with pytest.raises(ValueError, match="method"):
        ahm.torch.LocalMaps(k=8, method="fast")
    with pytest.raises(ValueError, match="not a row"):
        ahm.torch.edges(ahm.local_maps(sphere, 0.3, sources=sphere.points[:2] * 0.99))
    with pytest.raises(ValueError, match="dimension 2"):
        ahm.torch.edges(ahm.local_maps(ahm.Grid((4, 4, 4)), 1.5))
    band = ahm.TriangleMesh(*moebius_band())
    with pytest.raises(ValueError, match="orientable"):
        ahm.torch.edges(ahm.local_maps(band, 0.5))
    with pytest.raises(ValueError, match="transport=False"):
        ahm.torch.LocalMaps(0.5)(as_data(*moebius_band()))
    data = ahm.torch.LocalMaps(0.5, transport=False)(as_data(*moebius_band()))
    assert not hasattr(data, "transport") and len(data.log) == data.edge_index.shape[1]
    for pos in (None, np.zeros((3, 3))):
        with pytest.raises(TypeError, match="data.pos: expected a tensor"):
            ahm.torch.LocalMaps(k=8)(types.SimpleNamespace(pos=pos))
    with pytest.raises(TypeError, match="data.face: expected a tensor"):
        ahm.torch.LocalMaps(k=8)(types.SimpleNamespace(pos=torch.zeros(3, 3), face=[[0], [1], [2]]))


def moebius_band(n=40, m=4):
    turn, across = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    u, v = 2 * np.pi * turn.ravel() / n, 0.4 * (across.ravel() / (m - 1) - 0.5)
    positions = np.stack([(1 + v * np.cos(u / 2)) * np.cos(u), (1 + v * np.cos(u / 2)) * np.sin(u), v * np.sin(u / 2)], axis=1)
    faces = []
    for i in range(n):
        for k in range(m - 1):
            a, b = i * m + k, i * m + k + 1
            c, d = ((i + 1) * m + k, (i + 1) * m + k + 1) if i + 1 < n else (m - 1 - k, m - 2 - k)
            faces += [(a, c, b), (b, c, d)]
    return positions, np.array(faces)
