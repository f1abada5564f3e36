"""Writes the stubs of the compiled module, which editors and type checkers read.

    python tools/stubs.py           # writes
    python tools/stubs.py --check   # fails if they differ

Signatures, defaults and texts are those of the module, types those of the Rust sources. ``annotations.txt`` has the
types that Rust leaves open: words of a choice, functions, and objects of several classes.
"""

from __future__ import annotations

import difflib
import inspect
import re
import sys
import textwrap
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import rust_types
from rust_types import Member, Module

import basemat

ROOT = Path(__file__).parents[1]
ANNOTATIONS = Path(__file__).with_name("annotations.txt")
STUBS = ROOT / "python" / "basemat" / "_core.pyi"
CORE: Any = basemat._core
WIDTH = 110
SUBCLASSED = 1 << 10
"""Flag of a class that may be extended."""
UNLISTED = {"__repr__", "__str__", "__reduce__"}
"""Members that all objects have."""


def literal(text: str | None, indent: int) -> list[str]:
    """Lines of an indented docstring."""
    if not text:
        return []
    raw = "r" if "\\" in text else ""
    end = "\n" if "\n" in text else ""
    return textwrap.indent(f'{raw}"""{text}{end}"""', " " * indent, lambda line: line.strip() != "").split("\n")


def code(default: Any) -> str:
    """A default as code."""
    if default is ...:
        sys.exit("a default that is no literal: PyO3 shows it as an ellipsis")
    return f'"{default}"' if isinstance(default, str) else repr(default).replace("inf", "1e999")


class Exceptions:
    """Types that the Rust sources leave open, and those that differ from them."""

    def __init__(self, text: str) -> None:
        self.head, _, rest = text.partition("\n# Types that the Rust sources leave open")
        words, _, members = rest.partition("\n# Members")
        self.words = {
            name: kind for kind, names in re.findall(r"^(.+) <- (.+)$", words, re.M) for name in names.split()
        }
        #: Pairs (types of parameters, type of the result) of each member, several of an overloaded function.
        self.members: dict[str, list[tuple[dict[str, str], str | None]]] = {}
        for path, parameters, returned in re.findall(r"^([\w.]+)(?:\((.*)\))?(?: -> (.+))?$", members, re.M):
            types = dict(part.split(": ", 1) for part in rust_types.split(parameters or ""))
            self.members.setdefault(path, []).append((types, returned or None))
        self.used: set[str] = set()

    def word(self, name: str) -> str | None:
        """Type of the texts and objects that a parameter may be."""
        if name in self.words:
            self.used.add(name)
        return self.words.get(name)


class Stubs:
    """The stubs of the module."""

    def __init__(self, exceptions: Exceptions, module: Module) -> None:
        self.exceptions, self.module = exceptions, module
        self.visited: set[str] = set()

    def written(self) -> str:
        """All of the file."""
        lines, written = [self.exceptions.head.rstrip()], set()
        for name in self.module.structs.values():
            for owner in reversed(getattr(CORE, name).__mro__[:-1]):
                if owner.__name__ not in written:
                    written.add(owner.__name__)
                    lines += ["", *self.class_of(owner)]
        for name, function in self.module.functions.items():
            written.add(name)
            lines += ["", *self.calls(name, function, getattr(CORE, name), 0, "")]
        public = {name for name, value in vars(CORE).items() if callable(value) and name[:2] != "__"}
        same("names of the module", public, written)
        same("types of parameters", self.exceptions.used, set(self.exceptions.words))
        same("members with other types", self.visited, set(self.exceptions.members))
        return "\n".join(lines) + "\n"

    def class_of(self, owner: Any) -> list[str]:
        """Lines of a class."""
        name = owner.__name__
        parent = "" if owner.__base__ is object else f"({owner.__base__.__name__})"
        decorator = "@disjoint_base" if owner.__flags__ & SUBCLASSED else "@final"
        lines = [decorator, f"class {name}{parent}:", *literal(inspect.getdoc(owner), 4), ""]
        members = {**self.module.members.get(name, {})}
        if name in self.module.comparable:
            members["__eq__"] = Member("method", {"value": "object"}, "bool")
        # Methods that the package adds in Python, whose signatures have types.
        for added, value in sorted(vars(owner).items(), key=lambda item: item[0]):
            if added not in members and added[0] != "_" and (hasattr(value, "__code__") or isinstance(value, staticmethod)):
                members[added] = Member("method")
        for member_name, member in members.items():
            if member_name not in UNLISTED:
                lines += self.member(member_name, member, owner)
        same(f"members of {name}", public_names(vars(owner)), public_names(members))
        return lines if lines[-1] else lines[:-1]

    def member(self, name: str, member: Member, owner: Any) -> list[str]:
        """Lines of a member of a class."""
        value = vars(owner)[name]
        if member.kind == "classattr":
            return [f"    {name}: ClassVar[{self.result(name, member, owner.__name__)}]"]
        if member.kind == "getter":
            kind = self.result(name, member, owner.__name__)
            text = literal(inspect.getdoc(value), 8) or ["        ..."]
            return ["    @property", f"    def {name}(self) -> {kind}:", *text]
        if isinstance(value, staticmethod) and name != "__new__":
            return ["    @staticmethod", *self.calls(name, member, value.__func__, 4, owner.__name__)]
        return self.calls(name, member, owner if name == "__new__" else value, 4, owner.__name__)

    def result(self, name: str, member: Member, owner: str) -> str:
        """Type of an attribute."""
        [(_, returned)] = self.special(name, owner)
        return returned or self.module.python_type(member.returned, owner, None, False)

    def special(self, name: str, owner: str) -> list[tuple[dict[str, str], str | None]]:
        """Types that differ from those of the Rust sources."""
        path = f"{owner}.{name}" if owner else name
        self.visited.update({path} & set(self.exceptions.members))
        return self.exceptions.members.get(path, [({}, None)])

    def calls(self, name: str, member: Member, value: Any, indent: int, owner: str) -> list[str]:
        """Lines of a function or method, of each overload of it."""
        overloads = self.special(name, owner)
        lines = []
        for types, returned in overloads:
            lines += [" " * indent + "@overload"] if len(overloads) > 1 else []
            lines += self.call(name, member, value, indent, owner, {**types}, returned)
        return lines

    def call(
        self, name: str, member: Member, value: Any, indent: int, owner: str, types: dict[str, str], returned: str | None
    ) -> list[str]:
        """Lines of a function or method."""
        signature = inspect.signature(value)
        parameters, kind = ["cls"] if name == "__new__" else [], None
        # Python has its own names for the parameters of special methods.
        special = name.startswith("__") and name not in ("__new__", "__init__")
        rust_names = iter(member.parameters)
        for parameter in signature.parameters.values():
            before, kind = kind, parameter.kind
            if before == parameter.POSITIONAL_ONLY != kind and parameters != ["self"]:
                parameters.append("/")
            if kind == parameter.KEYWORD_ONLY != before:
                parameters.append("*")
            rust_name = next(rust_names) if special and parameter.name != "self" else parameter.name
            parameters.append(self.parameter(parameter, rust_name, member, owner, types))
        if kind == inspect.Parameter.POSITIONAL_ONLY and parameters != ["self"]:
            parameters.append("/")
        if types:
            sys.exit(f"{owner}.{name} has no parameters {sorted(types)}")
        if returned is None and isinstance(signature.return_annotation, str):
            returned = signature.return_annotation
        if returned is None:
            returned = "Self" if name == "__new__" else self.module.python_type(member.returned, owner, None, False)
        margin, text = " " * indent, literal(inspect.getdoc(value) if name[0] != "_" else None, indent + 4)
        end = f") -> {returned}:" + ("" if text else " ...")
        head = f"{margin}def {name}({', '.join(parameters)}{end}"
        if len(head) <= WIDTH:
            return [head, *text]
        return [f"{margin}def {name}(", *(f"{margin}    {part}," for part in parameters), f"{margin}{end}", *text]

    def parameter(
        self, parameter: inspect.Parameter, rust_name: str, member: Member, owner: str, types: dict[str, str]
    ) -> str:
        """A parameter with its type and default."""
        name, default = parameter.name, parameter.default
        if name == "self":
            return name
        if isinstance(parameter.annotation, str):
            kind = parameter.annotation.replace("'", '"')
        elif name in types:
            kind = types.pop(name)
        else:
            kind = self.rust_kind(rust_name, member, owner)
        if default is None and not re.search(r"\bNone$|^Any$", kind):
            kind += " | None"
        return f"{name}: {kind}" + ("" if default is parameter.empty else f" = {code(default)}")

    def rust_kind(self, name: str, member: Member, owner: str) -> str:
        """Type of a parameter in the Rust sources, of options that are handed on to the class in its constructor."""
        rust = member.parameters.get(name) or self.module.members[owner]["__new__"].parameters[name]
        if rust == "object":
            return rust
        try:
            return self.module.python_type(rust, owner, self.exceptions.word(name), True)
        except KeyError:
            sys.exit(f"{owner}: the parameter {name}: {rust} has no type")


def public_names(names: Iterable[str]) -> set[str]:
    """Names that begin with no underscore."""
    return {name for name in names if name[0] != "_"}


def same(subject: str, needed: set[str], found: set[str]) -> None:
    """Ends the program if a name is missing or too many."""
    if needed != found:
        sys.exit(f"{subject}: missing {sorted(needed - found)}, not needed {sorted(found - needed)}")


def main() -> None:
    """Writes or checks."""
    after = Stubs(Exceptions(ANNOTATIONS.read_text("utf-8")), rust_types.read(ROOT / "src")).written()
    if "--check" not in sys.argv[1:]:
        STUBS.write_text(after, "utf-8")
        return
    before = STUBS.read_text("utf-8")
    if before != after:
        lines = difflib.unified_diff(before.splitlines(), after.splitlines(), "stubs", "module", lineterm="")
        sys.exit("\n".join([*lines, "python tools/stubs.py writes the stubs"]))


if __name__ == "__main__":
    main()
