"""The stubs list what the extension module contains. Everything public has types and a docstring, and every function an example."""

import ast
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import ahm
import ahm.potpourri3d as pp3d
from ahm import _core


def parameters(function):
    return [a.arg for a in function.args.args]


def test_the_stubs_list_the_contents_of_the_module():
    stubs = ast.parse(Path(_core.__file__).with_name("_core.pyi").read_text())
    classes = {n.name: n for n in stubs.body if isinstance(n, ast.ClassDef)}
    functions = {n.name: n for n in stubs.body if isinstance(n, ast.FunctionDef)}
    public = {name for name in dir(_core) if not name.startswith("_")}
    assert public == set(classes) | set(functions)
    for name, node in classes.items():
        real = getattr(_core, name)
        assert [base.__name__ for base in real.__bases__ if base.__name__ != "pybind11_object"] == [b.id for b in node.bases]
        if issubclass(real, BaseException):
            continue
        members = {n.name: n for n in node.body if isinstance(n, ast.FunctionDef)}
        assert {m for m in vars(real) if not m.startswith("_")} == {m for m in members if m != "__init__"}
        for member, stub in members.items():
            is_property = isinstance(inspect.getattr_static(real, member), property)
            assert is_property == any(getattr(d, "id", "") == "property" for d in stub.decorator_list)
            if not is_property:
                assert count(getattr(real, member)) == len(parameters(stub)), f"{name}.{member}"
    for name, stub in functions.items():
        assert count(getattr(_core, name)) == len(parameters(stub)), name


@pytest.mark.parametrize("check", ["types", "stubs"])
def test_mypy_finds_nothing(check, tmp_path, tmp_path_factory):
    """The package agrees with its types and stubs. What pybind11 adds to every class is ignored."""
    pytest.importorskip("mypy")
    settings, passed = tmp_path / "mypy.ini", tmp_path / "allowed"
    cache = tmp_path_factory.getbasetemp() / "mypy"  # shared by the checks
    settings.write_text(f"[mypy]\nignore_missing_imports = true\ncache_dir = {cache}\n")
    passed.write_text(r"ahm\._core\.(Body|Inverse|Map|PolarSolver|Solver)(\.__init__)?" + "\n")
    command = {"types": ["mypy", "--config-file", settings, "-p", "ahm"],
               "stubs": ["mypy.stubtest", "ahm._core", "--mypy-config-file", settings, "--allowlist", passed, "--ignore-unused-allowlist"]}
    home = str(Path(ahm.__file__).parents[1])
    result = subprocess.run([sys.executable, "-m", *map(str, command[check])], capture_output=True, text=True, timeout=900,
                            cwd=home, env={**os.environ, "MYPYPATH": home})
    assert result.returncode == 0, result.stdout + result.stderr


CALLS = """
import os
from typing import List
import numpy as np
import ahm
import ahm.potpourri3d as pp3d
from ahm.typing import Source, SurfaceLike

V, F = ahm.shapes.sphere(2)
mesh = ahm.TriangleMesh(V, F)
solver = ahm.SurfaceSolver(mesh)

def far(surface: SurfaceLike, source: Source) -> float:
    m: ahm.LogMap = ahm.log_map(surface, source, radius=1.0)
    return float(m.distance.max())

far(mesh, 0), far((V, F), np.int64(3)), far(solver, [0.0, 0.0, 1.0]), far(V, V[3]), far([[0, 0, 0], [1, 0, 0], [0, 1, 0]], 2)
far(mesh, (7, [0.2, 0.3, 0.5])), far(mesh, ((0, 1), 0.5)), far(mesh, (7, np.ones(3) / 3)), far(mesh, (F[0, :2], 0.5))
solver.log_maps([0, 5, 7]), solver.log_maps(V[:3]), solver.log_maps(([1, 2], np.ones((2, 3)) / 3)), solver.log_maps((F[:, :2], V[:, 0]))
mixed: List[Source] = [4, (7, [0.2, 0.3, 0.5]), [0, 0, 1.0], ((0, 1), 0.5)]
solver.log_maps(mixed)
ahm.distance(mesh, 0, targets=[1, 2]), ahm.stroke(mesh, [0, 40]), ahm.read(os.fspath("mesh.ply")), ahm.extend(mesh, [0, 1], [1.0, 2.0])
ahm.Grid((4, 3), 0.5, blocked=np.zeros((3, 2), bool)), pp3d.compute_distance(V, F, 0), ahm.local_maps(mesh, 0.2).csr("u")
length: float = solver.trace(0, [1, 0, 0], 2).length
text: str = mesh.warnings[0]["text"]

ahm.log_map("mesh.ply", 0)  # error
ahm.log_map(mesh, "0")  # error
ahm.log_map(mesh, {"row": 0})  # error
ahm.log_map(mesh, None)  # error
ahm.log_map(mesh)  # error
ahm.log_map(mesh, 0, u_axis=1.0)  # error
ahm.distance(mesh, 0, targets="all")  # error
ahm.geodesic_path(mesh, 0, {1, 2})  # error
ahm.TriangleMesh(V)  # error
ahm.read(3)  # error
solver.trace(0, "x")  # error
mesh.warnings[0]["sentence"]  # error
ahm.log_map(mesh, 0).uv()  # error
pp3d.compute_distance(V, F, "0")  # error
"""


def test_mypy_accepts_correct_calls_and_rejects_wrong_ones(tmp_path, tmp_path_factory):
    pytest.importorskip("mypy")
    (tmp_path / "calls.py").write_text(CALLS)
    home = str(Path(ahm.__file__).parents[1])
    command = ["mypy", "--ignore-missing-imports", "--cache-dir", str(tmp_path_factory.getbasetemp() / "mypy"), "calls.py"]
    result = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, timeout=900, cwd=tmp_path,
                            env={**os.environ, "MYPYPATH": home})
    found = {int(line.split(":")[1]) for line in result.stdout.splitlines() if ": error:" in line}
    assert found == {k for k, line in enumerate(CALLS.splitlines(), 1) if line.endswith("# error")}, result.stdout


def annotations(function):
    signature = inspect.signature(function)
    return [str(signature.return_annotation), *(str(p.annotation) for p in signature.parameters.values())]


@pytest.mark.parametrize("module", [ahm, pp3d], ids=["ahm", "potpourri3d"])
def test_no_public_signature_contains_any(module):
    for name in module.__all__:
        thing = getattr(module, name)
        if inspect.isfunction(thing):
            assert "Any" not in " ".join(annotations(thing)), name
        elif inspect.isclass(thing) and thing.__module__.startswith("ahm.") and thing.__module__ != "ahm._core":
            fields = {field: str(kind) for field, kind in vars(thing).get("__annotations__", {}).items() if not field.startswith("_")}
            assert not any("Any" in kind for kind in fields.values()), f"{name}: {fields}"
            for member, value in inspect.getmembers(thing):
                value = value.fget if isinstance(value, property) else value
                if inspect.isfunction(value) and (not member.startswith("_") or (member == "__init__" and thing is not ahm.LogMap)):
                    assert "Any" not in " ".join(annotations(value)), f"{name}.{member}"


def count(function):
    """Number of parameters in the signature that pybind11 writes at the start of the docstring."""
    inside = function.__doc__.split("\n")[0].split("(", 1)[1].rsplit(")", 1)[0]
    return len(re.findall(r"(?:^|, )(?:self|arg\d+)\b", inside))


def test_everything_public_has_types_and_text():
    for name in ahm.__all__:
        thing = getattr(ahm, name)
        assert thing.__doc__, name
        if inspect.isfunction(thing):
            signature = inspect.signature(thing)
            assert signature.return_annotation is not inspect.Signature.empty, name
            assert all(p.annotation is not inspect.Parameter.empty for p in signature.parameters.values()), name
            assert ">>>" in thing.__doc__, f"{name}: no example"
        if inspect.isclass(thing) and thing.__module__.startswith("ahm."):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{member}"
                    assert ">>>" in value.__doc__ or isinstance(value, property), f"{name}.{member}: no example"


def documented():
    """Functions, classes with a constructor, and methods, with their names and docstrings."""
    for name in ahm.__all__:
        thing = getattr(ahm, name)
        if inspect.isfunction(thing):
            yield name, thing, thing.__doc__
        elif inspect.isclass(thing) and thing.__module__.startswith("ahm.") and not issubclass(thing, (Exception, tuple, ahm.LogMap)):
            if "__init__" in vars(thing):
                yield name, thing.__init__, thing.__doc__
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            if not member.startswith("_") and inspect.isfunction(value):
                yield f"{name}.{member}", value, value.__doc__


@pytest.mark.parametrize("name, thing, text", documented(), ids=lambda x: x if isinstance(x, str) and len(x) < 40 else "")
def test_docstrings_describe_every_argument_and_the_errors(name, thing, text):
    """Or name the function whose arguments and errors they share."""
    if not re.search(r"[Aa]rguments and errors as in\s+`", text):
        unknown = [p for p in inspect.signature(thing).parameters if p != "self" and not re.search(rf"\b{p}\b", text)]
        assert not unknown, f"{name}: no description of {unknown}"
        assert "Raises" in text or name == "LocalMaps", f"{name}: no errors"


@pytest.mark.parametrize("name", pp3d.__all__)
def test_docstrings_of_potpourri3d_have_an_example_and_the_errors(name):
    text = inspect.getdoc(getattr(pp3d, name))
    assert ">>>" in text and "Raises" in text


def test_all_lists_everything_that_is_public():
    assert sorted(ahm.__all__) == sorted(set(ahm.__all__))
    public = {name for name in vars(ahm) if not name.startswith("_") and not inspect.ismodule(getattr(ahm, name))}
    assert public | {"shapes"} == set(ahm.__all__)
