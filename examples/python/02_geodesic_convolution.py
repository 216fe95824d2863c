"""Geodesic convolution in plain numpy: features of every point's neighborhood, in its own tangent frame, from local maps.

As in learning pipelines on surfaces, a kernel on a polar grid of bins is applied to the signals of the neighbors. A loop over
the points and one sum over all entries give the same result; the sum is ten times faster.

    python3 02_geodesic_convolution.py [--level N]
"""

import argparse
import time

import numpy as np

import ahm

RINGS, SECTORS = 3, 8


def bins_of(maps, radius):
    """The polar bin of every entry."""
    ring = np.minimum((RINGS * maps.distance / radius).astype(int), RINGS - 1)
    angle = np.arctan2(maps.log[:, 1], maps.log[:, 0])
    sector = np.floor(SECTORS * (angle + np.pi) / (2 * np.pi)).astype(int) % SECTORS
    return ring * SECTORS + sector


def features_by_loop(maps, signal, bins):
    result = np.zeros((len(maps), RINGS * SECTORS))
    for s in range(len(maps)):
        mass = np.zeros(RINGS * SECTORS)
        for e in range(maps.indptr[s], maps.indptr[s + 1]):
            result[s, bins[e]] += maps.weight[e] * signal[maps.indices[e]]
            mass[bins[e]] += maps.weight[e]
        result[s, mass > 0] /= mass[mass > 0]
    return result


def features(maps, signal, bins):
    source = np.repeat(np.arange(len(maps)), np.diff(maps.indptr))
    place, size = source * RINGS * SECTORS + bins, len(maps) * RINGS * SECTORS
    total = np.bincount(place, maps.weight * signal[maps.indices], size)
    mass = np.bincount(place, maps.weight, size)
    return np.divide(total, mass, out=np.zeros(size), where=mass > 0).reshape(len(maps), -1)


def rotation_invariant(features_of_bins):
    """The largest response over all rotations of a kernel, since the frame of a point is arbitrary."""
    kernel = np.outer(np.ones(RINGS), np.cos(2 * np.pi * np.arange(SECTORS) / SECTORS))
    grid = features_of_bins.reshape(-1, RINGS, SECTORS)
    return np.max([np.einsum("nrs,rs->n", grid, np.roll(kernel, k, axis=1)) for k in range(SECTORS)], axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", type=int, default=5, help="10 * 4^N + 2 points")
    options = parser.parse_args()

    mesh = ahm.TriangleMesh(*ahm.shapes.sphere(options.level))
    radius = 6 * mesh.mean_edge_length
    maps = ahm.local_maps(mesh, radius)
    signal = mesh.points[:, 2]
    bins = bins_of(maps, radius)
    start = time.perf_counter()
    fast = features(maps, signal, bins)
    middle = time.perf_counter()
    slow = features_by_loop(maps, signal, bins)
    end = time.perf_counter()
    assert np.allclose(fast, slow)
    print(f"{maps}: {middle - start:.3f} s by one sum, {end - middle:.3f} s by a loop")
    # The height of a sphere changes fastest at its equator and not at its poles.
    response = rotation_invariant(fast)
    equator, pole = np.argmin(np.abs(signal)), np.argmax(signal)
    print(f"response at the equator {response[equator]:.4f}, at the pole {response[pole]:.4f}")
    assert response[equator] > 5 * response[pole]


if __name__ == "__main__":
    main()
