"""docs/reference/parity.md lists every public function, with the tests that compare it with another library, or a reason why none does."""

import inspect
import re
from pathlib import Path

import ahm
import ahm.potpourri3d as pp3d

HOME = Path(__file__).parents[2]
PAGE = (HOME / "docs/reference/parity.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in PAGE.splitlines() if line.startswith("| `")]
TESTS = re.findall(r"^def (test_\w+)", (HOME / "scripts/parity/test_parity.py").read_text(encoding="utf-8"), re.M)


def public():
    yield from (name for name in ahm.__all__ if inspect.isfunction(getattr(ahm, name)))
    yield from (f"pp3d.{name}" for name in pp3d.__all__ if inspect.isfunction(getattr(pp3d, name)))
    yield from (f"Surface.{name}" for name in dir(ahm.Surface) if not name.startswith("_"))


def test_every_public_function_is_in_one_row():
    listed = [name for row in ROWS for name in re.findall(r"`([\w.]+)`", row[0])]
    assert sorted(listed) == sorted(public())


def test_every_function_of_another_library_is_compared_or_exempt():
    for functions, others, *rest in ROWS:
        tests = re.findall(r"`(test_\w+)`", " ".join(rest))
        assert set(tests) <= set(TESTS), functions
        reason = re.search(r"exempt: (.+)", " ".join(rest))
        assert others.startswith("none") or tests or (reason and len(reason.group(1).split()) > 4), functions


def test_every_comparison_is_in_the_table():
    assert set(TESTS) == set(re.findall(r"`(test_\w+)`", PAGE))
