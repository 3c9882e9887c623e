# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Counts what may not grow: lines, parameters and constants of the tracker, lines of the page."""

from __future__ import annotations

import argparse
import ast
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "het_ros" / "tracking"
OPERATOR = PACKAGE.parent / "operator"
COMMAND = {"main.py", "config.py", "demo.py"}  # command line, its settings, a camera of footage
CONFIGURATIONS = {"default": "config.py", "paper": "paper/config.py"}


def main(arguments: list[str] | None = None) -> int:
    """Print the counts; returns 0."""
    parser = argparse.ArgumentParser(
        description="Count lines, parameters and constants of the tracker, lines of the page.",
        epilog="example: python .ci/count.py",
    )
    parser.add_argument("package", type=Path, nargs="?", default=PACKAGE, help="the folder")
    package = parser.parse_args(arguments).package
    lines = {file: len(file.read_text().splitlines()) for file in sorted(package.rglob("*.py"))}
    paper = sum(n for file, n in lines.items() if file.parent.name == "paper")
    whole = sum(lines.values())
    print(f"lines: {whole} in {len(lines)} files, {whole - paper} without paper/")
    print(f"of them code: {sum(map(code_lines, lines))}, the rest is text and empty lines")
    for name, file in CONFIGURATIONS.items():
        print(f"parameters, {name}: {parameters(ast.parse((package / file).read_text()))}")
    found = [
        f"{file.relative_to(package)}:{line} {name}"
        for file in lines
        for line, name in constants(ast.parse(file.read_text()))
    ]
    print(f"module constants outside a frozen dataclass: {len(found)}", *found, sep="\n  ")
    parts = {file.name: code_lines(file) for file in OPERATOR.glob("*.py")}
    command = sum(lines for name, lines in parts.items() if name in COMMAND)
    page = sum(page_lines(file) for kind in ("js", "css") for file in OPERATOR.rglob(f"*.{kind}"))
    print(f"operator, code: server and bridge {sum(parts.values()) - command},", end=" ")
    print(f"command and demo {command}, page {page}")
    return 0


def code_lines(file: Path) -> int:
    """Lines of a file that are neither empty nor comment nor docstring."""
    texts: set[int] = set()
    for node in ast.walk(ast.parse(file.read_text())):
        documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
        if isinstance(node, documented) and ast.get_docstring(node) is not None:
            texts.update(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    layout = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT}
    layout |= {tokenize.DEDENT, tokenize.ENCODING, tokenize.ENDMARKER}
    code: set[int] = set()
    with file.open("rb") as source:
        for token in tokenize.tokenize(source.readline):
            if token.type not in layout:
                code.update(range(token.start[0], token.end[0] + 1))
    return len(code - texts)


def page_lines(file: Path) -> int:
    """Lines of JavaScript or CSS that are neither empty nor comment."""
    text = re.sub(r"/\*.*?\*/", "", file.read_text(), flags=re.DOTALL)
    lines = map(str.strip, text.splitlines())
    return sum(bool(line) and not line.startswith("//") for line in lines)


def parameters(module: ast.Module) -> int:
    """Fields of a module's classes that are declared with ``parameter(...)``."""
    calls = (node for node in ast.walk(module) if isinstance(node, ast.Call))
    return sum(isinstance(call.func, ast.Name) and call.func.id == "parameter" for call in calls)


def constants(module: ast.Module) -> Iterator[tuple[int, str]]:
    """(line, name) of what a module sets to numbers or words; types and configurations are not."""
    for node in module.body:
        if isinstance(node, ast.Assign):
            names, value = node.targets, node.value
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            names, value = [node.target], node.value
        else:
            continue
        numbers = [
            n
            for n in ast.walk(value)
            if isinstance(n, ast.Constant) and isinstance(n.value, (int, float))
        ]
        # Types as tuple[float, ...], and tables of functions, are no constants.
        other = isinstance(value, ast.Subscript) or any(
            isinstance(n, ast.Lambda) for n in ast.walk(value)
        )
        if numbers and not other:
            yield from ((node.lineno, ast.unparse(name)) for name in names)


if __name__ == "__main__":
    raise SystemExit(main())
