"""Extension of griffe, which reads the package for the site: arguments of compiled classes, links between names."""

from __future__ import annotations

import re
from typing import Any

import griffe


class ReferencePages(griffe.Extension):
    """Gives compiled classes the arguments of their stubs, and makes names in docstrings links to their pages."""

    def on_package(self, *, pkg: griffe.Module, loader: griffe.GriffeLoader, **_: Any) -> None:
        names = set(pkg.members)
        for module in (pkg, *pkg.modules.values()):
            for member in module.members.values():
                if not member.is_alias:
                    prepare(member, pkg.path, names)


def prepare(item: griffe.Object, package: str, names: set[str]) -> None:
    """Prepares a class or function, and the members of a class."""
    if item.docstring is not None:
        item.docstring.value = linked(item.docstring.value, package, names - {item.name})
    if not item.is_class:
        return
    if "__new__" in item.members and "__init__" not in item.members:
        item.set_member("__init__", item.members["__new__"])
        item.members["__init__"].docstring = None
        item.members["__init__"].returns = None
    for member in item.members.values():
        if not member.is_alias:
            prepare(member, package, names)


def linked(text: str, package: str, names: set[str]) -> str:
    """Text with a link at each `Name` of the package, and at each `Name.member`."""

    def link(found: re.Match[str]) -> str:
        name = found[1].partition(".")[0]
        return f"[{found[0]}][{package}.{found[1]}]" if name in names else found[0]

    return re.sub(r"(?<!`)`([A-Za-z_]\w*(?:\.\w+)?)`(?!`)", link, text)
