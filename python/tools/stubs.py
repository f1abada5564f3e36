"""Writes the stubs of the compiled module, which editors and type checkers read.

    python tools/stubs.py           # writes
    python tools/stubs.py --check   # fails if they differ

Signatures, defaults and texts are those of the module. Types, and the order of members, stand in ``annotations.txt``.
"""

from __future__ import annotations

import difflib
import inspect
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import basemat

ANNOTATIONS = Path(__file__).with_name("annotations.txt")
STUBS = Path(__file__).parents[1] / "python" / "basemat" / "_core.pyi"
CORE: Any = basemat._core
WIDTH = 110
SUBCLASSED = 1 << 10
"""Flag of a class that may be extended."""


def literal(text: str | None, indent: int) -> list[str]:
    """Lines of a docstring so far to the right."""
    if not text:
        return []
    raw = "r" if "\\" in text else ""
    end = "\n" if "\n" in text else ""
    return textwrap.indent(f'{raw}"""{text}{end}"""', " " * indent, lambda line: line.strip() != "").split("\n")


def shown(default: Any) -> str:
    """A default as code."""
    if default is ...:
        sys.exit("a default that is no literal: PyO3 shows it as an ellipsis")
    return f'"{default}"' if isinstance(default, str) else repr(default).replace("inf", "1e999")


def split(arguments: str) -> dict[str, str]:
    """Types by the names of parameters, from ``name: type, …``."""
    found, depth, part = {}, 0, ""
    for sign in f"{arguments},":
        depth += (sign in "[(") - (sign in ")]")
        if sign == "," and depth == 0:
            name, _, own = part.partition(":")
            if own:
                found[name.strip()] = own.strip()
            part = ""
        else:
            part += sign
    return found


class Stubs:
    """The stubs of the module with the types of a file."""

    def __init__(self, annotations: str) -> None:
        head, _, rest = annotations.partition("\n# Parameters")
        types, _, classes = rest.partition("\n\nclass ")
        self.head, self.classes = head.rstrip(), f"class {classes}"
        types = types.replace("\n    ", " ")
        self.types = {
            name: own for own, names in re.findall(r"^(.+) <- (.+)$", types, re.M) for name in names.split()
        }
        self.used: set[str] = set()

    def written(self) -> str:
        """All of the file."""
        lines, seen = [self.head], set()
        functions = re.findall(r"^def (\w+)", self.classes, re.M)
        for block in re.split(r"\n(?=class |def )", self.classes.strip()):
            kind, line = block.split(" ", 1)
            if kind == "class":
                name, *members = line.split("\n")
                lines += ["", *self.class_of(name, [own.strip() for own in members if own.strip()])]
            else:
                name = re.match(r"\w+", line)[0]  # type: ignore[index]
                lines += [] if lines[-1] else [""]
                lines += ["@overload"] if functions.count(name) > 1 else []
                lines += self.call(line.strip(), getattr(CORE, name), 0)
            seen.add(name)
        public = {name for name, own in vars(CORE).items() if callable(own) and name[:2] != "__"}
        self.same("names of the module", public, seen)
        self.same("types of parameters", self.used, set(self.types))
        return "\n".join(lines) + "\n"

    @staticmethod
    def same(subject: str, needed: set[str], found: set[str]) -> None:
        """Ends the program if a name is missing or too many."""
        if needed != found:
            sys.exit(f"{subject}: missing {sorted(needed - found)}, not needed {sorted(found - needed)}")

    def class_of(self, name: str, members: list[str]) -> list[str]:
        """Lines of a class."""
        owner = getattr(CORE, name)
        parent = "" if owner.__base__ is object else f"({owner.__base__.__name__})"
        decorator = "@disjoint_base" if owner.__flags__ & SUBCLASSED else "@final"
        lines = [decorator, f"class {name}{parent}:", *literal(inspect.getdoc(owner), 4), ""]
        seen = set()
        for member in members:
            own = re.match(r"\w+", member)[0]  # type: ignore[index]
            seen.add(own)
            value = vars(owner)[own]
            if member.startswith(f"{own}: ClassVar"):
                lines.append(f"    {member}")
            elif member.startswith(f"{own}: "):
                lines += ["    @property", f"    def {own}(self) -> {member[len(own) + 2 :]}:"]
                lines += literal(inspect.getdoc(value), 8) or ["        ..."]
            elif isinstance(value, staticmethod) and own != "__new__":
                lines += ["    @staticmethod", *self.call(member, value.__func__, 4)]
            else:
                lines += self.call(member, owner if own == "__new__" else value, 4, name)
        lines = lines if lines[-1] else lines[:-1]
        self.same(f"members of {name}", {own for own in vars(owner) if own[0] != "_"}, {own for own in seen if own[0] != "_"})
        return lines

    def call(self, line: str, value: Any, indent: int, owner: str | None = None) -> list[str]:
        """Lines of a function or method from its annotation ``name(parameter: type, …) -> type``."""
        name, arguments, returned = re.match(r"(\w+)(?:\((.*)\))?(?: -> (.+))?$", line).groups()  # type: ignore[union-attr]
        own = split(arguments or "")
        returned = returned or ("Self" if name == "__new__" else None)
        signature = inspect.signature(value)
        parameters, kind = [], None
        if name == "__new__":
            parameters.append("cls")
        for parameter in signature.parameters.values():
            before, kind = kind, parameter.kind
            if before == parameter.POSITIONAL_ONLY != kind and parameters != ["self"]:
                parameters.append("/")
            if kind == parameter.KEYWORD_ONLY != before:
                parameters.append("*")
            parameters.append(self.parameter(parameter, own))
        if kind == inspect.Parameter.POSITIONAL_ONLY and parameters != ["self"]:
            parameters.append("/")
        if own:
            sys.exit(f"{owner}.{name} has no parameters {sorted(own)}")
        returned = returned or signature.return_annotation
        margin, text = " " * indent, literal(inspect.getdoc(value) if name[0] != "_" else None, indent + 4)
        end = f") -> {returned}:" + ("" if text else " ...")
        head = f"{margin}def {name}({', '.join(parameters)}{end}"
        if len(head) <= WIDTH:
            return [head, *text]
        return [f"{margin}def {name}(", *(f"{margin}    {own}," for own in parameters), f"{margin}{end}", *text]

    def parameter(self, parameter: inspect.Parameter, own: dict[str, str]) -> str:
        """A parameter with its type and default."""
        name, default = parameter.name, parameter.default
        if name == "self":
            return name
        if isinstance(parameter.annotation, str):
            kind = parameter.annotation.replace("'", '"')
        elif name in own:
            kind = own.pop(name)
        elif name in self.types:
            kind = self.types[name]
            self.used.add(name)
        else:
            sys.exit(f"the parameter {name} has no type")
        if default is None and not re.search(r"\bNone$|^Any$", kind):
            kind += " | None"
        return f"{name}: {kind}" + ("" if default is parameter.empty else f" = {shown(default)}")


def main() -> None:
    """Writes or checks."""
    after = Stubs(ANNOTATIONS.read_text("utf-8")).written()
    if "--check" not in sys.argv[1:]:
        STUBS.write_text(after, "utf-8")
        return
    before = STUBS.read_text("utf-8")
    if before != after:
        lines = difflib.unified_diff(before.splitlines(), after.splitlines(), "stubs", "module", lineterm="")
        sys.exit("\n".join([*lines, "python tools/stubs.py writes the stubs"]))


if __name__ == "__main__":
    main()
