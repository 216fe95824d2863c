"""Cost of calls from Python: CPU seconds of the best of several calls. Not a test, since it measures time.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/benchmark.py [--vertices N]
"""

import argparse
import resource
import time

import numpy as np

import ahm
from ahm import _core, _places


def best(call, repeats=7):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def peak():
    """The peak memory of the process so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def overhead(solver):
    """The time that a call spends outside the extension module, and the time of a call with almost no work."""
    at = _places.point(0, "source", solver.surface)
    core = best(lambda: solver._core.maps(at, None, {"frames": True}, None))
    whole = best(lambda: solver.log_map(0).uv)
    small = ahm.LogMapSolver(ahm.shapes.plane(3, 3))
    tiny = best(lambda: [small.log_map(0).uv for _ in range(1000)]) / 1000
    print(f"log map: {1e3 * whole:.1f} ms, of which the extension module {1e3 * core:.1f} ms")
    print(f"a complete call on 9 vertices: {1e6 * tiny:.0f} us, {100 * tiny / whole:.2f} % of it")


def memory(solver):
    """The arrays of a map are views, so they need no memory of their own."""
    m = solver.log_map(0)
    before = peak()
    columns = [m.uv, m.distance, m.angle, m.spread, m.status]
    print(f"{sum(c.nbytes for c in columns) / 2**20:.1f} MB of results as arrays: {peak() - before:.1f} MB more")


def local(mesh):
    radius = 3 * mesh.mean_edge_length
    before = peak()
    core = best(lambda: _core.local_maps(mesh._body, None, None, {"radius": radius}, None), 2)
    between = peak()
    whole = best(lambda: ahm.local_maps(mesh, radius), 2)
    maps = ahm.local_maps(mesh, radius)
    held = sum(x.nbytes for x in (maps.indptr, maps.indices, maps.log, maps.distance, maps.weight, maps.transport)) / 2**20
    print(f"{maps}: {whole:.2f} s, of which the extension module {core:.2f} s")
    print(f"{held:.0f} MB of results: peak {between - before:.0f} MB more by the extension module, {peak() - between:.0f} MB by Python")
    before = peak()
    distances = maps.csr("distance")
    print(f"as a scipy matrix of {distances.nnz} entries: {peak() - before:.1f} MB more")
    padded = best(lambda: maps.padded(16), 3)
    print(f"padded to 16 entries: {padded:.2f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vertices", type=int, default=100_000)
    options = parser.parse_args()
    around = max(8, round((1.6 * options.vertices) ** 0.5))
    V, F = ahm.shapes.torus(around, max(5, options.vertices // around))
    mesh = ahm.TriangleMesh(V, F)
    print(mesh)
    solver = ahm.LogMapSolver(mesh)
    overhead(solver)
    memory(solver)
    local(mesh)


if __name__ == "__main__":
    main()
