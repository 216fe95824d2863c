"""Runs the cells of a page in order and makes its pictures: docs/python_tour.md, or docs/guides/learning.md.

    python3 run_page.py [--page PAGE.md] [--pictures FOLDER] [--level N]

A cell is a block of Python code. If it sets `figure`, that becomes the picture that follows it on the page.
"""

import argparse
import io
import re
from pathlib import Path

HOME = Path(__file__).resolve().parents[2]


def cells(text):
    """Yields the code of each cell, and the name of its picture or None."""
    for code, picture in re.findall(r"```python\n(.*?)```(?:\s*!\[[^\]]*\]\((?:\.\./)?images/([\w.]+)\))?", text, re.S):
        yield code, picture or None


def save(figure, path):
    """Saves a figure in 128 colors, which keeps pages small."""
    from PIL import Image

    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=90)
    Image.open(drawn).convert("RGB").quantize(128, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(path, optimize=True)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", type=Path, default=HOME / "docs/python_tour.md")
    parser.add_argument("--pictures", type=Path, default=HOME / "docs/images")
    parser.add_argument("--level", type=int, help="level of the shapes, instead of the page's own: a lower one is faster and coarser")
    options = parser.parse_args()
    text, names = options.page.read_text(encoding="utf-8"), {"__name__": "page"}
    if options.level:
        text = re.sub(r"^level = \d+", f"level = {options.level}", text, flags=re.M)
    for code, picture in cells(text):
        names.pop("figure", None)
        exec(compile(code, str(options.page), "exec"), names)
        if picture:
            save(names["figure"], options.pictures / picture)


if __name__ == "__main__":
    main()
