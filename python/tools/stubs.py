"""Writes the docstrings of the compiled module into its stubs, where editors look for them.

    python tools/stubs.py           # writes
    python tools/stubs.py --check   # fails if they differ

Types stand in the stubs and texts in the module; `mypy.stubtest` holds the signatures together.
"""

from __future__ import annotations

import ast
import difflib
import inspect
import sys
import textwrap
from pathlib import Path
from typing import Any

import basemat

STUBS = Path(__file__).parents[1] / "python" / "basemat" / "_core.pyi"


def literal(text: str, indent: int) -> str:
    """A docstring so far to the right."""
    margin = " " * indent
    raw = "r" if "\\" in text else ""
    end = "\n" if "\n" in text else ""
    return textwrap.indent(f'{raw}"""{text}{end}"""', margin, lambda line: line.strip() != "")


def is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)


class Stubs:
    """The lines of a stub file and the places where texts belong."""

    def __init__(self, source: str) -> None:
        self.lines = source.splitlines()
        self.source = source

    def documented(self) -> str:
        """The file with the texts of the module."""
        for node in reversed(ast.parse(self.source).body):
            if isinstance(node, ast.ClassDef):
                owner = getattr(basemat._core, node.name)
                for member in reversed(node.body):
                    if isinstance(member, ast.FunctionDef) and not member.name.startswith("_"):
                        value = vars(owner)[member.name]
                        # The text of a static method is that of its function.
                        self.replace_body(member, getattr(value, "__func__", value))
                self.replace_head(node, owner)
            elif isinstance(node, ast.FunctionDef):
                self.replace_body(node, getattr(basemat._core, node.name))
        return "\n".join(self.lines) + "\n"

    def replace_body(self, node: ast.FunctionDef, value: Any) -> None:
        """A function's body becomes its text."""
        first, last = node.body[0], node.end_lineno or node.lineno
        head = self.lines[first.lineno - 1][: first.col_offset]
        start = first.lineno - 1
        if not head.strip():
            # The body is on lines of its own.
            start -= 1
            head = self.lines[start]
        text = inspect.getdoc(value)
        body = [" ..."] if text is None else ["", *literal(text, node.col_offset + 4).split("\n")]
        body[0] = head.rstrip() + body[0]
        self.lines[start:last] = body

    def replace_head(self, node: ast.ClassDef, owner: Any) -> None:
        """A class's text stands before its members."""
        first = node.body[0]
        start = first.lineno - 1 - len(getattr(first, "decorator_list", []))
        end = first.end_lineno or start if is_text(first) else start
        text = literal(inspect.getdoc(owner) or "", 4).split("\n")
        after = self.lines[end] if end < len(self.lines) else ""
        self.lines[start:end] = [*text, *([""] if after.strip() else [])]


def main() -> None:
    """Writes or checks."""
    before = STUBS.read_text("utf-8")
    after = Stubs(before).documented()
    if "--check" not in sys.argv[1:]:
        STUBS.write_text(after, "utf-8")
    elif before != after:
        lines = difflib.unified_diff(before.splitlines(), after.splitlines(), "stubs", "module")
        sys.exit("\n".join([*lines, "python tools/stubs.py writes the texts of the module"]))


if __name__ == "__main__":
    main()
