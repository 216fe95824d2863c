"""Stubs describe the extension module. Everything public has types and a docstring, functions also an example."""

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


def test_the_stubs_list_what_the_module_has():
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
    """The package agrees with its types and stubs. Members that pybind11 adds to every class are allowed."""
    pytest.importorskip("mypy")
    settings, passed = tmp_path / "mypy.ini", tmp_path / "allowed"
    cache = tmp_path_factory.getbasetemp() / "mypy"  # shared by both checks
    settings.write_text(f"[mypy]\nignore_missing_imports = true\ncache_dir = {cache}\n")
    passed.write_text(r"ahm\._core\.(Body|Inverse|Map|PolarSolver|Solver)(\.__init__)?" + "\n")
    command = {"types": ["mypy", "--config-file", settings, "-p", "ahm"],
               "stubs": ["mypy.stubtest", "ahm._core", "--mypy-config-file", settings, "--allowlist", passed, "--ignore-unused-allowlist"]}
    home = str(Path(ahm.__file__).parents[1])
    result = subprocess.run([sys.executable, "-m", *map(str, command[check])], capture_output=True, text=True, timeout=900,
                            cwd=home, env={**os.environ, "MYPYPATH": home})
    assert result.returncode == 0, result.stdout + result.stderr


def count(function):
    """Number of parameters of the signature, which pybind11 writes to the first line of the docstring."""
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
            assert ">>>" in thing.__doc__, f"{name} has no example"
        if inspect.isclass(thing) and thing.__module__.startswith("ahm."):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{member}"
                    assert ">>>" in value.__doc__ or isinstance(value, property), f"{name}.{member} has no example"


def documented():
    """Functions, callable classes and methods, with their names and docstrings."""
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
    """Or name the function with the same arguments and errors."""
    if not re.search(r"[Aa]rguments and errors as in\s+`", text):
        unknown = [p for p in inspect.signature(thing).parameters if p != "self" and not re.search(rf"\b{p}\b", text)]
        assert not unknown, f"{name} does not describe {unknown}"
        assert "Raises" in text or name == "LocalMaps", f"{name} does not describe its errors"


@pytest.mark.parametrize("name", pp3d.__all__)
def test_texts_of_old_names_have_an_example_and_the_errors(name):
    text = inspect.getdoc(getattr(pp3d, name))
    assert ">>>" in text and "Raises" in text


def test_all_lists_everything_that_is_public():
    assert sorted(ahm.__all__) == sorted(set(ahm.__all__))
    public = {name for name in vars(ahm) if not name.startswith("_") and not inspect.ismodule(getattr(ahm, name))}
    assert public | {"shapes"} == set(ahm.__all__)
