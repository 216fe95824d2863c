"""What calls from Python cost: not a test, since it measures time.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/benchmark.py [--level N]
"""

import argparse
import resource
import time

import numpy as np

import ahm
from ahm import _arguments, _core


def best(call, repeats=5):
    """Seconds of CPU of the best of several calls."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", type=int, default=7, help="10 * 4^N + 2 vertices")
    options = parser.parse_args()
    V, F = ahm.shapes.sphere(options.level)

    before = memory()
    mesh = ahm.TriangleMesh(V, F)
    print(f"{mesh}: {memory() - before:.0f} MB more, input {(V.nbytes + F.nbytes) / 2**20:.0f} MB")
    solver = ahm.LogMapSolver(mesh)
    at = _arguments.point(0, "source", mesh)
    core = best(lambda: solver._core.maps(at, None, {"frames": True}, None))
    whole = best(lambda: solver.log_map(0).uv)
    small = ahm.LogMapSolver(ahm.shapes.plane(3, 3))
    tiny = best(lambda: [small.log_map(0).uv for _ in range(1000)]) / 1000
    print(f"log map: {1e3 * whole:.1f} ms of CPU, of which the extension module {1e3 * core:.1f} ms")
    print(f"the same call on 9 vertices, solve and all: {1e6 * tiny:.0f} us, {100 * tiny / whole:.2f} % of it")

    m = solver.log_map(0)
    before = memory()
    columns = [m.uv, m.distance, m.angle, m.spread, m.status]
    held = sum(c.nbytes for c in columns) / 2**20
    print(f"{held:.1f} MB of results as arrays: {memory() - before:.1f} MB more")

    radius = 3 * mesh.mean_edge_length
    body = mesh._body
    core = best(lambda: _core.local_maps(body, None, {"radius": radius}, None), 1)
    start = time.process_time()
    maps = ahm.local_maps(mesh, radius)
    whole = time.process_time() - start
    print(f"{maps}: {whole:.2f} s of CPU, of which the extension module {core:.2f} s")
    start = time.process_time()
    maps.padded(16)
    print(f"padded to 16 entries: {time.process_time() - start:.2f} s of CPU")


if __name__ == "__main__":
    main()
