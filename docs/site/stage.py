"""Lays out the pages of the site: the repository's own, with links to sources turned into pages that show them, and the
tables of the C++ API from Doxygen's tag file.

    stage.py REPOSITORY TAGFILE STAGE
"""

import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

root, tag_file, stage = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s#:]+)(#[^)\s]*)?\)")
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".txt": "cmake", ".cff": "yaml", ".bib": "bibtex"}
written = set()
shown = set()  # files and folders outside of the pages that a page links to


def write(path, text):
    """Only what changed, so that Sphinx reads only that again."""
    target = stage / path
    written.add(target)
    if target.exists() and target.read_text(encoding="utf-8") == text:
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")


def link_to(page, staged):
    """Turns the links of `page`, a path in the repository, into links of the site."""

    def replace(match):
        text, target, anchor = match.group(1), match.group(2), match.group(3) or ""
        path = (root / page.parent / target).resolve().relative_to(root)
        if not (root / path).exists():
            sys.exit(f"{page}: there is no {target}")
        if path.suffix == ".md":
            staged_target = pathlib.Path("index.md") if path == pathlib.Path("README.md") else path
        else:
            shown.add(path)
            staged_target = source_page(path)
        up = "../" * len(staged.parent.parts)
        return f"[{text}]({up}{staged_target}{anchor})"

    return replace


def source_page(path):
    return pathlib.Path("sources") / f"{path}.md"


def page(path, staged=None, after=""):
    staged = staged or path
    parts = re.split(r"(```.*?```)", (root / path).read_text(encoding="utf-8"), flags=re.S)  # code is no page
    parts[::2] = [LINK.sub(link_to(path, staged), part) for part in parts[::2]]
    write(staged, "".join(parts) + after)


def show(path):
    """A page with the source at `path`, or with all of a folder's."""
    files = sorted(f for f in (root / path).rglob("*.*") if f.is_file()) if (root / path).is_dir() else [root / path]
    lines = ["---", "orphan: true", "---", f"# {path}"]
    for file in files:
        lines += ["", f"## {file.relative_to(root / path)}"] if len(files) > 1 else [""]
        lines += [f"````{LANGUAGES.get(file.suffix, 'text')}", file.read_text(encoding="utf-8").rstrip(), "````"]
    write(source_page(path), "\n".join(lines) + "\n")


def headers():
    """The table of the public headers, each with the first sentence of its comment, linked to Doxygen's pages."""
    tags = ElementTree.parse(tag_file).getroot()
    pages = {}
    for compound in tags.iter("compound"):
        if compound.get("kind") == "file":
            path = (root / compound.findtext("path") / compound.findtext("name")).relative_to(root)
            if path.suffix == ".hpp":
                pages[str(path)] = compound.findtext("filename")
    result, last = "", None
    rooms = ["libahm/base", "libahm/cholesky", "libahm/core", "libahm/surface", "libahm/applications", "backends", "libahm/io", "libahm/render",
             "libahm/conformance"]  # upwards
    for header in sorted(pages, key=lambda h: ([h.startswith(r) for r in rooms].index(True), str(pathlib.Path(h).parent), h)):
        text = re.search(r"/// \\file\n((?:/// .*\n)+)", (root / header).read_text(encoding="utf-8"))
        if text is None:
            sys.exit(f"{header}: no \\file comment")
        sentence = re.split(r"(?<=[.:])\s", text.group(1).replace("/// ", "").replace("\n", " "))[0].rstrip(":. ")
        name = header.split("/include/")[1]
        folder = str(pathlib.Path(name).parent)
        if folder != last:
            result += f"\n## {folder}/\n\n| header | |\n|---|---|\n"
            last = folder
        result += f'| <a href="cpp/{pages[header]}"><code>{name}</code></a> | {sentence} |\n'
    return result


contents = (root / "docs/site/contents.md").read_text(encoding="utf-8")
page(pathlib.Path("README.md"), pathlib.Path("index.md"), "\n" + contents)
pages = ["CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", *(str(p.relative_to(root)) for p in (root / "docs").rglob("*.md"))]
pages = [page for page in pages if not page.startswith("docs/site/")]
pages += [str(p.relative_to(root)) for top in ("backends", "benchmarks", "web") for p in (root / top).rglob("README.md")]
for path in pages:
    orphan = not path.startswith("docs/") and path.endswith("README.md")
    page(pathlib.Path(path))
    if orphan:
        staged = stage / path
        write(path, "---\norphan: true\n---\n" + staged.read_text(encoding="utf-8").removeprefix("---\norphan: true\n---\n"))
page(pathlib.Path("docs/site/cpp_api.md"), pathlib.Path("cpp_api.md"), headers())
page(pathlib.Path("docs/site/python_api.md"), pathlib.Path("python_api.md"))
for path in shown:
    show(path)
for old in stage.rglob("*.md"):
    if old not in written:
        old.unlink()
images = stage / "docs/images"
if not images.is_symlink():
    images.symlink_to(root / "docs/images")
