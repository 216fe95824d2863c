"""`SurfaceSolver` has the same members, arguments and defaults in C++ and in Python, and the results of the solvers that it calls."""

import inspect
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import ahm

ROOT = Path(__file__).parents[2]
HEADER = ROOT / "libahm/surface/include/ahm/surface/surface_solver.hpp"
LOCAL_MAPS = ROOT / "libahm/core/include/ahm/maps/local_maps.hpp"
CPP_VALUES = {"{}": None, "std::numeric_limits<double>::infinity()": None, "true": True, "false": False, "0": 0, "2": 2}
ON_MAPS = {"quality", "at"}  # in Python `LogMap.quality` and `LogMap.sample`


def block(kind, name, header=HEADER):
    """The body of a class or struct of a header, without comments."""
    text = re.sub(r"//[^\n]*", "", header.read_text())
    return re.search(rf"^{kind} {name}\b[^;{{]*\{{(.*?)^\}};", text, re.M | re.S)[1]


def fields(name, header=HEADER):
    """Fields of a struct with their defaults in Python."""
    found = re.findall(r"(\w+)\s*=\s*([^;]*);", block("struct", name, header))
    return {field: CPP_VALUES[value.strip()] for field, value in found}


def keywords(function):
    return {p.name: p.default for p in inspect.signature(function).parameters.values() if p.kind is p.KEYWORD_ONLY}


def test_members_are_those_of_cpp():
    public = block("class", "SurfaceSolver").split("private:")[0]
    cpp = set(re.findall(r"\b([a-z_]+)\([^;]*\) const", public)) - {"operator"}
    python = {name for name in vars(ahm.SurfaceSolver) if not name.startswith("_")}
    assert cpp - ON_MAPS == python


def test_options_and_defaults_are_those_of_cpp():
    for function in (ahm.SurfaceSolver.log_map, ahm.SurfaceSolver.log_maps):
        assert keywords(function) == {**fields("SurfaceMapOptions"), "progress": None}
    assert keywords(ahm.SurfaceSolver.distance) == {**fields("SurfaceDistanceOptions"), "progress": None}


def test_arguments_of_lines_and_local_maps_are_those_of_cpp():
    public = block("class", "SurfaceSolver").split("private:")[0]
    for name, optional in (("path", set()), ("trace", {"length"})):  # in Python the length may be that of the direction
        cpp = re.search(rf"\b{name}\(([^)]*)\) const", public)[1]
        python = inspect.signature(getattr(ahm.SurfaceSolver, name)).parameters.values()
        given = [p for p in python if p.name != "self" and p.kind is p.POSITIONAL_OR_KEYWORD]
        assert [p.name for p in given] == [argument.split()[-1] for argument in cpp.split(",")]
        assert {p.name for p in given if p.default is not p.empty} == optional
    python = inspect.signature(ahm.SurfaceSolver.local_maps).parameters
    cpp = fields("LocalMapOptions", LOCAL_MAPS)
    assert {name: python[name].default or 0 for name in ("radius", "k")} == {name: cpp[name] for name in ("radius", "k")}
    assert python["margin"].default is None  # that of C++


@pytest.fixture(scope="module")
def mesh():
    return ahm.TriangleMesh(*ahm.shapes.sphere(3))


@pytest.mark.parametrize("method, solver", [("polar", ahm.PolarMapSolver), ("heat", ahm.LogMapSolver), ("exact", ahm.ExactGeodesics)])
def test_maps_are_those_of_the_solvers_below(mesh, method, solver):
    one = ahm.SurfaceSolver(mesh, method)
    assert one.method == method and one.surface is mesh
    made, expected = one.log_map(7, u_axis=[0, 0, 1], radius=2.0), solver(mesh).log_map(7, u_axis=[0, 0, 1], radius=2.0)
    np.testing.assert_array_equal(made.uv, expected.uv)
    np.testing.assert_array_equal(made.status, expected.status)
    assert [m.source.row for m in one.log_maps([0, 5])] == [0, 5]
    again = pickle.loads(pickle.dumps(one))
    np.testing.assert_array_equal(again.log_map(7).uv, one.log_map(7).uv)


def test_distances_paths_and_local_maps(mesh):
    solver = ahm.SurfaceSolver(mesh, "exact")
    np.testing.assert_array_equal(solver.distance([0, 9]), ahm.distance(mesh, [0, 9], method="exact"))
    np.testing.assert_array_equal(ahm.SurfaceSolver(mesh).distance(0), ahm.distance(mesh, 0))
    assert solver.path(0, 9).length == ahm.geodesic_path(mesh, 0, 9).length
    assert solver.trace(0, [1, 0, 0], 0.5).length == pytest.approx(0.5)
    assert len(solver.local_maps(radius=0.3)) == len(mesh)


def test_functions_take_it_as_a_solver(mesh):
    for method in ("polar", "heat", "exact"):
        solver = ahm.SurfaceSolver(mesh, method)
        cells = ahm.cells(solver, [0, 100])
        assert set(np.unique(cells.labels)) <= {-1, 0, 1}
        assert ahm.karcher_mean(solver, [0, 1, 2]) is not None
    np.testing.assert_array_equal(ahm.cells(solver, [0, 100]).distance, ahm.cells(mesh, [0, 100], method="exact").distance)
    assert repr(solver).startswith("<ahm.SurfaceSolver: exact, on ")


def test_options_of_another_method_are_refused(mesh):
    with pytest.raises(TypeError):
        ahm.SurfaceSolver(mesh, "polar", t_coef=2.0)
    with pytest.raises(ValueError):
        ahm.SurfaceSolver(mesh, "fast")
    assert ahm.SurfaceSolver(mesh, t_coef=2.0).method == "heat"
