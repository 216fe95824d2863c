#!/usr/bin/env python3
"""Fails where a tracked page or source contains a phrase of scripts/banned_words.txt."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Pages whose text is not rewritten yet: only the lines for all files apply.
LATER: set = set()


def rules():
    """(pattern, whether for pages only)"""
    for line in (ROOT / "scripts/banned_words.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            pages_only = line.startswith("pages: ")
            yield re.compile(line.removeprefix("pages: "), re.I), pages_only


def prose(text):
    """The lines of a page, with code, links and comments blanked."""
    text = re.sub(r"^```.*?^```", lambda block: "\n" * block.group().count("\n"), text, flags=re.M | re.S)
    text = re.sub(r"`[^`\n]*`", "``", text)
    return re.sub(r"\]\([^)\n]*\)", "]", text)


def findings():
    patterns = list(rules())
    files = subprocess.run(["git", "ls-files", "-z", "*.md", "*.hpp", "*.cpp", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in filter(None, files.stdout.split("\0")):
        path = ROOT / name
        if not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        is_page = name.endswith(".md")
        lines = (prose(text) if is_page else text).splitlines()
        for pattern, pages_only in patterns:
            if pages_only and (not is_page or name in LATER):
                continue
            for number, line in enumerate(lines, 1):
                for match in pattern.finditer(line):
                    yield f"{name}:{number}: '{match.group()}' ({pattern.pattern})"


def main():
    found = list(findings())
    print("\n".join(found))
    if found:
        sys.exit(f"check_words.py: {len(found)} banned phrases; scripts/banned_words.txt lists them, CONTRIBUTING.md the style")


if __name__ == "__main__":
    main()
