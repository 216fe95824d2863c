"""Threads, signals, forks, pickles, and the order in which things go away."""

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import ahm
import ahm.potpourri3d


def run_python(code):
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def big():
    """40,000 vertices: computations that take long enough to be interrupted."""
    return ahm.TriangleMesh(*ahm.shapes.plane(200, 200))


def test_surfaces_outlive_what_is_made_from_them(plane):
    solver = ahm.LogMapSolver(ahm.TriangleMesh(*plane))
    m = solver.log_map(0)
    expected = m.uv.copy()
    inverse = ahm.InverseMap(m)
    del solver, m
    gc.collect()
    np.testing.assert_array_equal(inverse.map.uv, expected)
    assert inverse([[0.1, 0.1]]).valid.all()


def test_two_threads_on_one_solver_get_what_one_gets(sphere):
    solver = ahm.LogMapSolver(sphere)
    expected = [solver.log_map(r).uv.copy() for r in range(20)]
    found = {}

    def work(k):
        found[k] = [solver.log_map(r).uv.copy() for r in range(20)]

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    for results in found.values():
        for a, b in zip(results, expected):
            np.testing.assert_array_equal(a, b)
    assert len(found) == 4


def test_other_threads_run_during_a_computation(big):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(len(ticks))
            time.sleep(0.001)

    other = threading.Thread(target=tick)
    other.start()
    during = 0
    for _ in range(100):  # on a busy machine the other thread may miss some
        before = len(ticks)
        ahm.LogMapSolver(big)
        during = len(ticks) - before
        if during > 3:
            break
    done.set()
    other.join()
    assert during > 3


INTERRUPTED = {
    "factorization": lambda mesh, arrays: ahm.LogMapSolver(mesh),
    "exact map": lambda mesh, arrays: ahm.log_map(mesh, 0, method="exact"),
    "exact maps": lambda mesh, arrays: ahm.ExactGeodesics(mesh).log_maps([0, 1, 2, 3]),
    "local maps": lambda mesh, arrays: ahm.local_maps(mesh, 20.0),
    "atlas": lambda mesh, arrays: ahm.atlas(mesh, charts=12),
    "exact atlas": lambda mesh, arrays: ahm.atlas(mesh, charts=12, method="exact"),
    "paths": lambda mesh, arrays: ahm.geodesic_paths(mesh, [0, 1, 2], [39999] * 3, pairwise=True),
    "cloud": lambda mesh, arrays: ahm.PointCloud(arrays[0]),
    "spread points": lambda mesh, arrays: ahm.farthest_points(mesh, 8000),
    "grid": lambda mesh, arrays: ahm.Grid((2000, 2000)),
    "building": lambda mesh, arrays: ahm.TriangleMesh(*arrays),
    "polygons": lambda mesh, arrays: ahm.PolygonMesh(*arrays),
    "polar maps": lambda mesh, arrays: ahm.PolarMapSolver(mesh).log_maps(np.arange(100)),
    "distance": lambda mesh, arrays: ahm.distance(mesh, 0),
    "exact distance": lambda mesh, arrays: ahm.distance(mesh, 0, method="exact"),
    "curvature": lambda mesh, arrays: ahm.curvature(mesh),
    "cells": lambda mesh, arrays: ahm.cells(mesh, [0, 77]),
    "mean": lambda mesh, arrays: ahm.karcher_mean(mesh, [0, 199, 39999]),
    "loop": lambda mesh, arrays: ahm.geodesic_loop(mesh, [0, 199, 39999]),
    "stroke": lambda mesh, arrays: ahm.stroke(mesh, [0, 39999]),
    "local stroke": lambda mesh, arrays: ahm.local_stroke(mesh, [0, 39999], radius=5.0),
    "coverage": lambda mesh, arrays: ahm.coverage(ahm.log_map(mesh, 20100), 90.0, 0.2),
    "decal": lambda mesh, arrays: ahm.decal(ahm.log_map(mesh, 20100), 150.0, 150.0),
    "closest points": lambda mesh, arrays: mesh.closest_points(arrays[0] + 0.1),
}


@pytest.fixture
def interruptible():
    """Python's own handler, also where the tests run in the background of a shell, which ignores SIGINT."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("name", INTERRUPTED)
def test_ctrl_c_ends_a_computation_and_leaves_the_session_usable(big, name, interruptible):
    """Repeated until the signal arrives, which raises KeyboardInterrupt."""
    arrays = ahm.shapes.plane(500, 500)
    timer = threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        while True:
            INTERRUPTED[name](big, arrays)
    timer.join()
    assert ahm.log_map(ahm.shapes.plane(5, 5), 0).ok.all()


def test_progress_is_reported_and_its_exceptions_end_the_computation(big, capsys):
    seen = []
    ahm.LogMapSolver(big, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert seen and all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in seen)

    def refuse(stage, fraction):
        raise LookupError(stage)

    with pytest.raises(LookupError):
        ahm.TriangleMesh(*ahm.shapes.plane(100, 100), progress=refuse)
    ahm.TriangleMesh(*ahm.shapes.plane(30, 30), progress=True)
    assert capsys.readouterr().err
    with pytest.raises(TypeError, match="progress"):
        ahm.LogMapSolver(big, progress=3)


REPORTING = {
    "front": lambda s, solver, p: ahm.distance(s, 0, progress=p),
    "heat": lambda s, solver, p: ahm.distance(solver, 0, method="heat", progress=p),
    "extend": lambda s, solver, p: ahm.extend(solver, 0, 1.0, progress=p),
    "transport": lambda s, solver, p: ahm.transport(solver, 0, [1.0, 0.0], progress=p),
    "curvature": lambda s, solver, p: ahm.curvature(s, progress=p),
    "trace": lambda s, solver, p: ahm.trace(s, 0, [1.0, 0.0, 1.0], progress=p),
    "path": lambda s, solver, p: ahm.geodesic_path(s, 0, 9, progress=p),
    "cells": lambda s, solver, p: ahm.cells(s, [0, 9], progress=p),
    "mean": lambda s, solver, p: ahm.karcher_mean(solver, [0, 9], progress=p),
    "atlas": lambda s, solver, p: ahm.atlas(s, [0, 9, 77], progress=p),
    "geodesics": lambda s, solver, p: ahm.ExactGeodesics(s, progress=p),
    "stroke": lambda s, solver, p: ahm.stroke(solver, [0, 9], progress=p),
}


@pytest.mark.parametrize("name", REPORTING)
def test_whatever_takes_progress_reports(sphere, name):
    seen = []
    REPORTING[name](sphere, ahm.LogMapSolver(sphere), lambda stage, fraction: seen.append((stage, fraction)))
    assert seen and all(stage and 0 <= fraction <= 1 for stage, fraction in seen)


def test_a_forked_child_computes(sphere):
    solver = ahm.LogMapSolver(sphere)
    expected = solver.log_map(3).uv.copy()
    child = os.fork()
    if child == 0:
        ok = False
        try:
            ok = np.array_equal(solver.log_map(3).uv, expected) and ahm.log_map(sphere, 3).ok.all()
        finally:
            os._exit(0 if ok else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_children_forked_while_threads_compute_compute():
    result = run_python("""
        import ahm, os, threading, time, numpy as np
        V, F = ahm.shapes.plane(80, 80)
        solver, stop = ahm.LogMapSolver((V, F)), threading.Event()
        def work():
            while not stop.is_set():
                solver.log_maps([1, 2, 3, 4], threads=4), ahm.TriangleMesh(V, F), ahm.local_maps((V, F), k=8)
        threads = [threading.Thread(target=work) for _ in range(2)]
        for t in threads:
            t.start()
        failed = 0
        for _ in range(10):
            time.sleep(0.02)
            child = os.fork()
            if child == 0:
                same = False
                try:
                    a, b = solver.log_maps([3, 4], threads=4), solver.log_maps([3, 4], threads=1)
                    same = np.array_equal(a[0].uv, b[0].uv) and ahm.log_map((V, F), 5).ok.all()
                finally:
                    os._exit(0 if same else 1)
            failed += os.waitpid(child, 0)[1] != 0
        stop.set()
        print(failed)
    """)
    assert result.stdout == "0\n", result.stderr


def test_the_interpreter_ends_under_daemon_threads_that_compute():
    """They are stopped: none of them ends by itself, and none touches the ended interpreter."""
    result = run_python("""
        import ahm, threading, time
        mesh = ahm.TriangleMesh(*ahm.shapes.plane(200, 200))
        solver = ahm.LogMapSolver(ahm.shapes.plane(40, 40))
        m = solver.log_map(0)
        def forever(work):
            while True:
                work()
        for work in (lambda: ahm.LogMapSolver(mesh), lambda: ahm.local_maps(mesh, 30.0), lambda: solver.log_map(3),
                     lambda: m.frames, lambda: m.inverse([[1, 1]]), lambda: ahm.distance(mesh, 0, method="exact")):
            threading.Thread(target=forever, args=(work,), daemon=True).start()
        time.sleep(0.3)
        print("ended")
        raise SystemExit(3)
    """)
    assert (result.returncode, result.stdout, result.stderr) == (3, "ended\n", "")


def test_the_interpreter_ends_while_work_goes_on_in_the_background():
    result = run_python("""
        import ahm, os, signal, threading
        signal.signal(signal.SIGINT, signal.default_int_handler)
        mesh = ahm.TriangleMesh(*ahm.shapes.plane(400, 400))
        threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        try:
            while True:
                ahm.LogMapSolver(mesh)
        except KeyboardInterrupt:
            print("ended")
        raise SystemExit(3)
    """)
    assert (result.returncode, result.stdout, result.stderr) == (3, "ended\n", "")


@pytest.mark.parametrize("before", ["", "import ahm"])
def test_subinterpreters_are_refused(before):
    result = run_python(f"""
        {before}
        import _xxsubinterpreters as sub
        made = sub.create()
        try:
            sub.run_string(made, "import ahm")
        except sub.RunFailedError as error:
            print("refused" if "main interpreter" in str(error) else error)
    """)
    assert result.stdout == "refused\n", result.stderr


def test_pickles_make_the_same_thing_again(flat_surfaces, sphere):
    for s in (*flat_surfaces.values(), sphere, ahm.Grid((4, 3), [1, 2], blocked=np.eye(3, 2, dtype=bool))):
        again = pickle.loads(pickle.dumps(s))
        assert repr(again) == repr(s)
        np.testing.assert_array_equal(ahm.log_map(again, 0).uv, ahm.log_map(s, 0).uv)
    solver = ahm.LogMapSolver(sphere, t_coef=2.0, variant="localized")
    again = pickle.loads(pickle.dumps(solver))
    assert again.options == solver.options
    m = solver.log_map((7, [0.2, 0.3, 0.5]), u_axis=[1, 0, 0])
    for thing in (m, ahm.log_map(sphere, 5, method="exact"), ahm.log_map(sphere, 5),
                  ahm.stroke(sphere, [0, 12, 40]).map):
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(thing)).uv, thing.uv)
    rows = np.array([5, 6])
    maps = ahm.LogMapSolver(sphere).log_maps(rows)
    rows[:] = 0
    np.testing.assert_allclose(pickle.loads(pickle.dumps(maps[0])).uv, maps[0].uv, rtol=0, atol=1e-13)
    inverse = pickle.loads(pickle.dumps(ahm.InverseMap(m, max_stretch=3.0)))
    np.testing.assert_array_equal(inverse([[0.1, 0.1]]).position, ahm.InverseMap(m, max_stretch=3.0)([[0.1, 0.1]]).position)


@pytest.mark.parametrize("name", ["surface", "solver", "polar", "exact", "any", "map", "stroke", "inverse", "local", "path", "center",
                                  "graph"])
def test_pickles_of_another_version_are_refused_by_name(sphere, name, monkeypatch):
    solver = ahm.LogMapSolver(sphere)
    thing = {"surface": lambda: sphere, "solver": lambda: solver, "polar": lambda: ahm.PolarMapSolver(sphere),
             "exact": lambda: ahm.ExactGeodesics(sphere), "any": lambda: ahm.SurfaceSolver(sphere), "map": lambda: solver.log_map(3),
             "stroke": lambda: ahm.stroke(solver, [0, 40]), "inverse": lambda: ahm.InverseMap(solver.log_map(3)),
             "local": lambda: ahm.local_maps(sphere, k=5), "path": lambda: ahm.geodesic_path(sphere, 0, 40),
             "center": lambda: ahm.karcher_mean(solver, [0, 40]), "graph": lambda: sphere.graph}[name]()
    monkeypatch.setattr(ahm, "__version__", "9.8.7")
    later = pickle.dumps([thing])
    assert type(pickle.loads(later)[0]) is type(thing)
    monkeypatch.undo()
    # Names of classes and functions that only the other version has do not matter.
    for data in (later, later.replace(b"ahm._surfaces", b"ahm._sarfuces").replace(b"ahm._geodesics", b"ahm._geodasics")):
        with pytest.raises(pickle.UnpicklingError, match=f"written by ahm 9.8.7, this is ahm {ahm.__version__}"):
            pickle.loads(data)


def test_maps_of_one_call_are_made_at_once_out_of_one_pickle(sphere, monkeypatch):
    for maker in (ahm.LogMapSolver(sphere), ahm.ExactGeodesics(sphere)):
        solved = []
        found = type(maker)._found
        monkeypatch.setattr(type(maker), "_found",
                            lambda self, at, *rest: solved.append(at[3].tolist()) or found(self, at, *rest))
        maps = maker.log_maps([3, 9, 40, 77], radius=1.0, frames=True)
        for kept, expected in (([0, 1, 2, 3], [3, 9, 40, 77]), ([2], [40]), ([3, 1], [9, 77])):
            again = pickle.loads(pickle.dumps([maps[k] for k in kept]))
            solved.clear()
            for k, m in zip(kept, again):
                np.testing.assert_allclose(m.uv, maps[k].uv, rtol=0, atol=1e-13)
                np.testing.assert_array_equal(m.status, maps[k].status)
                assert m.source.row == maps[k].source.row and m.frames.shape == (642, 2, 2)
            assert solved == [expected]
        twice = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(maps[1]))))
        np.testing.assert_allclose(twice.uv, maps[1].uv, rtol=0, atol=1e-13)


def test_what_does_not_change_is_its_own_copy(sphere):
    solver = ahm.LogMapSolver(sphere)
    for thing in (sphere, solver, ahm.ExactGeodesics(sphere), solver.log_map(0)):
        assert copy.copy(thing) is thing and copy.deepcopy([thing])[0] is thing


def test_graphs_with_frames_and_reflections_pickle(flat_surfaces):
    for kind in ("cloud", "triangles"):
        g = flat_surfaces[kind].graph
        graph = ahm.Graph(*g[:6], frames=g.frames, length_unit=g.length_unit)
        np.testing.assert_array_equal(ahm.log_map(pickle.loads(pickle.dumps(graph)), 0).uv, ahm.log_map(graph, 0).uv)


def test_processes_share_work_by_pickles(sphere):
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = pool.submit(ahm.distance, sphere, 7).result(timeout=300)
    np.testing.assert_array_equal(found, ahm.distance(sphere, 7))


def test_running_out_of_memory_is_a_memory_error():
    """With 1 GB of address space left: an array that does not fit, then something that does."""
    result = run_python("""
        import resource, ahm
        grid = ahm.Grid((9000, 9000))
        most = resource.getpagesize() * int(open("/proc/self/statm").read().split()[0]) + (1 << 30)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        try:
            grid.points
        except MemoryError as error:
            print(isinstance(error, ahm.ResourceExhausted) and "::" not in str(error))
        print(ahm.log_map(ahm.shapes.sphere(2), 0).ok.all())
    """)
    assert result.stdout == "True\n" * 2, (result.stdout, result.stderr)


def test_maps_that_cannot_fit_are_refused_at_once():
    """Far larger than 4 GB, and by the hundred million vertices that nobody should wait for."""
    result = run_python("""
        import resource, ahm
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        grid = ahm.Grid((40000, 40000))
        print(grid)
        for method in ("heat", "polar"):
            try:
                ahm.log_map(grid, 0, method=method)
            except ahm.ResourceExhausted as error:
                print(error)
    """)
    assert "out of memory while preparing polar maps on 1600000000 vertices" in result.stdout, (result.stdout, result.stderr)
    assert "40000 x 40000" in result.stdout, (result.stdout, result.stderr)
    assert "maps on 1600000000 vertices need about" in result.stdout and "GB" in result.stdout, (result.stdout, result.stderr)


def test_graphs_keep_their_frames_to_themselves(flat_surfaces):
    graph = flat_surfaces["triangles"].graph
    frames = graph.frames.copy()
    mine = ahm.Graph(*graph[:6], frames=frames)
    before = mine.points.copy()
    frames[:] = 7
    np.testing.assert_array_equal(mine.points, before)
    with pytest.raises(ValueError):
        mine.points[0] = 1


def test_reprs_tell_what_things_are(sphere):
    assert repr(ahm.LogMapSolver(sphere)) == "<ahm.LogMapSolver: global, on <ahm.TriangleMesh: 642 vertices, 1280 faces>>"
    assert repr(ahm.log_map(sphere, 4)) == "<ahm.LogMap: polar, 642 rows, 642 ok, from row 4>"
    assert repr(ahm.Grid((3, 4, 5))) == "<ahm.Grid: 3 x 4 x 5 vertices>"
    assert repr(ahm.potpourri3d.GeodesicTracer(sphere.points, sphere.faces)) == f"<ahm.potpourri3d.GeodesicTracer: on {sphere!r}>"
    assert "LocalMaps: 642 sources" in repr(ahm.local_maps(sphere, 0.2))
    m = ahm.log_map(sphere, 4)
    results = ahm.geodesic_path(sphere, 4, 40), ahm.coverage(m, 0.5, 0.1), ahm.decal(m, 0.4, 0.3), ahm.atlas(sphere, charts=4)
    for result, name in zip(results, ("Path", "Coverage", "Decal", "Atlas")):
        assert repr(result).startswith(f"<ahm.{name}: ") and len(repr(result)) < 100, repr(result)


def test_warnings_have_a_sentence(sphere):
    points = np.concatenate([sphere.points, sphere.points[:1]])
    (found,) = [w for w in ahm.PointCloud(points).warnings if w["id"] == "duplicates"]
    assert found["text"] == "1 duplicate point was merged"
