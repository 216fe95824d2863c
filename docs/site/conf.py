"""Sphinx's settings for the site, which scripts/docs.sh builds from the pages that stage.py lays out."""

import pathlib
import re

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]
project = "libahm"
author = copyright = "The authors of libahm"
citation = (pathlib.Path(__file__).parents[2] / "CITATION.cff").read_text(encoding="utf-8")
release = re.search(r"^version: (\S+)$", citation, re.M).group(1)

myst_heading_anchors = 3
default_role = "py:obj"  # `Surface` in a docstring is a link where there is such a thing, code elsewhere
add_module_names = False
autodoc_member_order = "groupwise"
autodoc_mock_imports = ["torch"]  # the site builds without PyTorch
autodoc_typehints = "none"
copybutton_prompt_text = r">>> |\.\.\. "
copybutton_prompt_is_regexp = True

html_theme = "furo"
html_title = f"libahm {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False

PARAMETER = re.compile(r"(?:^|(?<=[.;] ))(\w+(?:, \w+)*) : ")


def parameters_as_fields(app, what, name, obj, options, lines):
    """`name : text`, as the docstrings of the package list parameters, several in one line or one over many, to fields."""
    result, inside = [], False
    for line in lines:
        parts = PARAMETER.split(line)
        if parts[0] == "" and len(parts) > 1:
            inside = True
        elif not inside or (line and not line.startswith(" ") and len(parts) == 1):
            inside = False
            result.append(line)
            continue
        if parts[0].strip() or not line:
            result.append("    " + parts[0].strip() if line else "")
        for names, text in zip(parts[1::2], parts[2::2]):
            result.append(f":param {names}: {text.strip()}")
    # |uv| is a norm, not the name of a substitution.
    lines[:] = [line if line.lstrip().startswith(">>>") else line.replace("|", "\\|") for line in result]


def setup(app):
    app.connect("autodoc-process-docstring", parameters_as_fields)
