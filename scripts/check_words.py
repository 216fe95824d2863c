#!/usr/bin/env python3
"""Fails where a page, a comment or a message contains a phrase of scripts/banned_words.txt.

    check_words.py [FILE ...]     default: all tracked pages and sources
"""

import io
import pathlib
import re
import subprocess
import sys
import tokenize

ROOT = pathlib.Path(__file__).resolve().parents[1]
SUFFIXES = {".md", ".hpp", ".cpp", ".py", ".js", ".sh", ".cmake", ".txt"}


def rules():
    """(pattern, whether it applies to strings, too)"""
    for line in (ROOT / "scripts/banned_words.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            yield re.compile(line.removeprefix("not in strings: "), re.I), not line.startswith("not in strings: ")


def page(text):
    """(line number, text, whether it is a string) of a page, without code and links."""
    text = re.sub(r"^```.*?^```", lambda block: "\n" * block.group().count("\n"), text, flags=re.M | re.S)
    text = re.sub(r"\]\([^)\n]*\)", "]", re.sub(r"`[^`\n]*`", "``", text))
    return [(number, line, False) for number, line in enumerate(text.splitlines(), 1)]


C_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'', re.S)


def c_source(text):
    """Comments and string literals; examples (\\code ... \\endcode) and quoted code are left out."""
    text = re.sub(r"\\code.*?\\endcode", lambda block: "\n" * block.group().count("\n"), text, flags=re.S)
    for match in C_TOKEN.finditer(text):
        token, start = match.group(), text.count("\n", 0, match.start()) + 1
        is_string = token[0] in "\"'"
        if is_string and (text[max(0, match.start() - 9):match.start()].endswith("#include ") or " " not in token):
            continue
        for number, line in enumerate(re.sub(r"`[^`\n]*`", "``", token).splitlines(), start):
            yield number, line, is_string


def python_source(text):
    """Comments, docstrings and strings, without examples (>>> ...)."""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT or (token.type == tokenize.STRING and " " in token.string):
            is_example = False
            for number, line in enumerate(re.sub(r"`[^`\n]*`", "``", token.string).splitlines(), token.start[0]):
                is_example = line.lstrip().startswith((">>>", "...")) or (is_example and line.strip() != "")
                if not is_example:
                    yield number, line, token.type == tokenize.STRING


def script(text):
    """Comments that fill a line, or follow two blanks."""
    for number, line in enumerate(text.splitlines(), 1):
        comment = re.search(r"(?:^\s*|  )#\s(.*)", line)
        if comment:
            yield number, re.sub(r"`[^`\n]*`", "``", comment.group(1)), False


READERS = {".md": page, ".py": python_source, ".sh": script, ".cmake": script, ".txt": script}


def findings(names):
    patterns = list(rules())
    for name in names:
        path = ROOT / name
        if path.suffix not in SUFFIXES or not path.is_file():
            continue
        for number, text, is_string in READERS.get(path.suffix, c_source)(path.read_text(encoding="utf-8")):
            for pattern, in_strings in patterns:
                if in_strings or not is_string:
                    for match in pattern.finditer(text):
                        yield f"{name}:{number}: '{match.group()}' ({pattern.pattern})"


def main():
    names = sys.argv[1:]
    if not names:
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
        names = list(filter(None, listed.stdout.split("\0")))
        names.remove("scripts/banned_words.txt")
    found = list(findings(names))
    print("\n".join(found))
    if found:
        sys.exit(f"check_words.py: {len(found)} banned phrases; scripts/banned_words.txt lists them, CONTRIBUTING.md the style")


if __name__ == "__main__":
    main()
