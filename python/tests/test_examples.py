"""Every example runs, at small size; the code on the page for Python works."""

import doctest
import subprocess
import sys
from pathlib import Path

import pytest

HOME = Path(__file__).parents[2]
SMALL = {"01": ["--size", "2000"], "02": ["--level", "3"], "03": ["--level", "4"], "04": ["--level", "4"],
         "05": ["--size", "40"], "06": ["--figures", "2", "--epochs", "2"], "07": ["-k", "8", "--processes", "1"],
         "08": ["--figures", "1", "--epochs", "2"]}
EXAMPLES = sorted((HOME / "examples/python").glob("0*.py"))


def test_every_example_has_a_small_size():
    assert [path.name[:2] for path in EXAMPLES] == sorted(SMALL)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(path):
    if path.stem in ("06_segment_shapes", "07_dataset", "08_diffusion_net"):
        pytest.importorskip("torch")
    result = subprocess.run([sys.executable, str(path), *SMALL[path.name[:2]]], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stderr


def test_the_benchmark_runs():
    result = subprocess.run([sys.executable, str(HOME / "examples/python/benchmark.py"), "--vertices", "300"], capture_output=True,
                            text=True, timeout=600)
    assert result.returncode == 0 and "as a scipy matrix" in result.stdout, result.stderr


def test_pictures_are_drawn_where_matplotlib_is_there(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "map.png"
    result = subprocess.run([sys.executable, str(EXAMPLES[0]), "--size", "1000", "--save", str(picture)],
                            capture_output=True, text=True, timeout=600)
    assert result.returncode == 0 and picture.read_bytes()[:4] == b"\x89PNG", result.stderr


def test_the_tour_runs_and_has_its_pictures(tmp_path):
    pytest.importorskip("matplotlib")
    result = subprocess.run([sys.executable, str(HOME / "examples/python/run_page.py"), "--level", "4", "--pictures", str(tmp_path)],
                            capture_output=True, text=True, timeout=900)
    assert result.returncode == 0, result.stderr
    pictures = {path.name for path in tmp_path.iterdir()}
    text = (HOME / "docs/python_tour.md").read_text(encoding="utf-8")
    assert pictures == {path.name for path in (HOME / "docs/images").glob("python_*.png")} and len(pictures) == text.count("](images/")


def test_the_guide_to_learning_runs_and_has_its_picture(tmp_path):
    pytest.importorskip("torch")
    pytest.importorskip("matplotlib")
    page = HOME / "docs/guides/learning.md"
    result = subprocess.run([sys.executable, str(HOME / "examples/python/run_page.py"), "--page", str(page), "--level", "3",
                             "--pictures", str(tmp_path)], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["local_map.png"]
    assert "](../images/local_map.png)" in page.read_text(encoding="utf-8") and (HOME / "docs/images/local_map.png").exists()


def test_the_page_for_python_is_true(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    failed, tried = doctest.testfile(str(HOME / "docs/guides/python.md"), module_relative=False)
    assert failed == 0 and tried > 20
