"""Pages of the reference: one for each class and function, from docstrings, with types of the stubs."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pdoc.docstrings

STUBS = Path(__file__).parents[1] / "python" / "basemat" / "_core.pyi"
MODULES = ("basemat", "basemat.opensees")
"""Modules whose public names have pages."""
GROUPS = {
    "Structures": ("Structure", "Mesh", "GmshMesh", "GmshSpaceMesh", "Grid", "Layer", "Storey", "PlanStorey", "DeformedShape"),
    "Soil and ground": ("Ground", "Soil", "SoilProfile", "SoilLayer", "Strip", "Plan", "Trench", "TrenchElements", "NearField"),
    "Laws of the interface": ("InterfaceLaw", "Limits", "Joint", "ShallowFooting"),
    "Springs and materials": ("Hysteresis", "Material", "BeamSection", "Iwan", "DruckerPrager"),
    "Motions": ("FreeField", "Spectrum", "PlaneWave", "SoilColumn", "InclinedWave", "EquivalentLinear"),
    "Simulations and results": ("Simulation", "Summary", "State", "Probe", "Load", "JointResults", "Interaction", "Fragility"),
}
"""Heads of a group: these classes and those that extend them; all others are in a group at the end."""
_WIDTH = 88
"""Characters of a line of code that a page shows without a break."""


class Stubs:
    """Types of the compiled classes and functions."""

    def __init__(self) -> None:
        tree = ast.parse(STUBS.read_text("utf-8"))
        #: Nodes of functions and methods by "name" or "Class.name"; several of an overloaded one.
        self.functions: dict[str, list[ast.FunctionDef]] = {}
        self.aliases: dict[str, str] = {}
        for node in tree.body:
            if isinstance(node, ast.AnnAssign) and node.value is not None and isinstance(node.target, ast.Name):
                self.aliases[node.target.id] = ast.unparse(node.value)
            elif isinstance(node, ast.FunctionDef):
                self.functions.setdefault(node.name, []).append(node)
            elif isinstance(node, ast.ClassDef):
                for member in node.body:
                    if isinstance(member, ast.FunctionDef):
                        self.functions.setdefault(f"{node.name}.{member.name}", []).append(member)

    def plain(self, text: str) -> str:
        """A type with the choices of words in place of their names."""
        for _ in range(3):
            text = re.sub(r"\b_[A-Z]\w+\b", lambda found: self.aliases.get(found[0], found[0][1:]), text)
        return re.sub(r"\bnp\.|\bLiteral(?=\[)", lambda found: "" if found[0] == "np." else "one of ", text)

    @staticmethod
    def default(text: str) -> str:
        """A default as a user writes it."""
        return re.sub(r"\b1e309\b|(?<!\.)\binf\b", "math.inf", text)

    def calls(self, path: str, shown: str) -> list[str]:
        """Calls of a compiled function, each with its parameters, under the ``shown`` name."""
        found = []
        for node in self.functions.get(path, []):
            arguments = node.args
            parts: list[str] = []
            positional = [*arguments.posonlyargs, *arguments.args]
            defaults = [None] * (len(positional) - len(arguments.defaults)) + list(arguments.defaults)
            for argument, default in zip(positional, defaults):
                if argument.arg not in ("self", "cls"):
                    parts.append(self.parameter(argument, default))
            if arguments.kwonlyargs:
                parts.append("*")
                parts += [self.parameter(*pair) for pair in zip(arguments.kwonlyargs, arguments.kw_defaults)]
            returned = "" if node.name == "__new__" or node.returns is None else self.plain(ast.unparse(node.returns))
            found.append(call(shown, parts, returned))
        return found

    def parameter(self, argument: ast.arg, default: ast.expr | None) -> str:
        """A parameter with its type and default."""
        kind = "" if argument.annotation is None else f": {self.plain(ast.unparse(argument.annotation))}"
        value = "" if default is None else f" = {self.default(ast.unparse(default))}"
        return f"{argument.arg}{kind}{value}"


def call(name: str, parts: list[str], returned: str) -> str:
    """A call as code, a line for each parameter if it is long."""
    end = f") -> {returned}" if returned else ")"
    line = f"{name}({', '.join(parts)}{end}"
    return line if len(line) <= _WIDTH else "\n".join([f"{name}(", *(f"    {part}," for part in parts), end])


class Reference:
    """All pages, by their paths."""

    def __init__(self) -> None:
        self.stubs, self.pages = Stubs(), {}
        #: Page of each public name, with the module for those beside basemat's.
        self.page_of: dict[str, str] = {}
        names = [(module, name) for module in map(importlib.import_module, MODULES) for name in public_names(module)]
        for module, name in names:
            # `Fragility` and `fragility` are one file where a system takes both letters for the same.
            folder = "" if isinstance(getattr(module, name), type) else "functions/"
            self.page_of.setdefault(name, f"{folder if module.__name__ == 'basemat' else 'opensees/'}{name}.md")
        for module, name in names:
            self.pages[f"api/{self.page_of[name]}"] = self.page(name, getattr(module, name))
        self.groups = self.grouped()
        self.pages["api/index.md"] = self.index()

    def grouped(self) -> dict[str, list[str]]:
        """Names of the classes and functions in groups."""
        import basemat

        found: dict[str, list[str]] = {title: [] for title in GROUPS}
        found.update({"Parts of your own": [], "Functions": [], "Other classes": [], "Errors and warnings": [], "OpenSees": []})
        heads = {title: tuple(getattr(basemat, name) for name in names) for title, names in GROUPS.items()}
        for name, page in self.page_of.items():
            value = getattr(basemat, name, None)
            title = "Other classes"
            if page.startswith("opensees/"):
                title = "OpenSees"
            elif not isinstance(value, type):
                title = "Functions"
            elif name.startswith("User"):
                title = "Parts of your own"
            elif issubclass(value, BaseException):
                title = "Errors and warnings"
            else:
                title = next((group for group, classes in heads.items() if issubclass(value, classes)), title)
            found[title].append(name)
        return found

    def index(self) -> str:
        """The page with the first line of each class and function."""
        import basemat
        import basemat.opensees

        lines = ["# Reference", "", "One page for each class and function. `python -m basemat` prints this list.", ""]
        for title, names in self.groups.items():
            lines += [f"## {title}", "", "|name|what it is|", "|---|---|"]
            for name in names:
                value = getattr(basemat, name, None) or getattr(basemat.opensees, name)
                lines.append(f"|[`{name}`]({self.page_of[name]})|{first_sentence(value)}|")
            lines.append("")
        return "\n".join(lines)

    def page(self, name: str, value: Any) -> str:
        """The page of a class or function."""
        lines = [f"# {name}", "", *self.code(name, name, value), *self.text(value, name)]
        if isinstance(value, type):
            bases = [base.__name__ for base in value.__mro__[1:] if base.__name__ in self.page_of]
            if bases:
                lines += [f"It has the members of {', '.join(self.link(base, name) for base in bases)}, too.", ""]
            for member, kind in members(value):
                found = getattr(value, member, None)
                is_call = callable(found) and not isinstance(kind, property)
                lines += [f"## {member} {{: #{name}.{member} }}", ""]
                if is_call:
                    lines += self.code(f"{name}.{member}", member, found)
                elif types := self.property_type(f"{name}.{member}", kind):
                    lines += ["```python", f"{member}: {types}", "```", ""]
                lines += self.text(kind if isinstance(kind, property) else found, name)
        return "\n".join(lines) + "\n"

    def code(self, path: str, shown: str, value: Any) -> list[str]:
        """Calls of a function or class as code."""
        calls = self.stubs.calls(f"{path}.__new__" if isinstance(value, type) else path, shown)
        if not calls:
            if isinstance(value, type) and ("__init__" not in vars(value) or issubclass(value, BaseException)):
                return []
            with_types = signature(value, shown, self.stubs)
            calls = [with_types] if with_types else []
        return ["```python", *calls, "```", ""] if calls else []

    def property_type(self, path: str, kind: Any) -> str:
        """Type of an attribute."""
        for node in self.stubs.functions.get(path, []):
            return "" if node.returns is None else self.stubs.plain(ast.unparse(node.returns))
        returned = getattr(getattr(kind, "fget", None), "__annotations__", {}).get("return", "")
        return str(returned)

    def text(self, value: Any, owner: str) -> list[str]:
        """The docstring, with links."""
        markdown = pdoc.docstrings.convert(inspect.getdoc(value) or "", "google", None)
        # Headings of arguments are below those of members.
        markdown = re.sub(r"^#+ (\w.*)$", r"**\1**", markdown, flags=re.M)
        return [re.sub(r"(?<!`)`([A-Za-z_][\w.]*)`(?!`)", lambda found: self.link(found[1], owner), markdown), ""]

    def link(self, target: str, owner: str) -> str:
        """A name as a link to its page, from the page of ``owner``."""
        path = target[len("basemat.") :] if target.startswith("basemat.") else target
        head, _, member = path.partition(".")
        if head not in self.page_of and hasattr(self.owner_class(owner), head):
            head, member = owner, head
        page = self.page_of.get(head)
        if page is None:
            return f"`{target}`"
        up = "../" if "/" in self.page_of[owner] else ""
        anchor = f"#{head}.{member.partition('.')[0]}" if member else ""
        return f"[`{target}`]({up}{page}{anchor})"

    @staticmethod
    def owner_class(owner: str) -> Any:
        """The class or function of a page."""
        return next(found for module in map(importlib.import_module, MODULES) if (found := getattr(module, owner, None)))


def public_names(module: Any) -> list[str]:
    """Classes and functions of a module that it defines, and those of the package that belong to it."""
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return [name for name in listed if isinstance(getattr(module, name), type) or inspect.isroutine(getattr(module, name))]
    import basemat

    found = []
    for name, value in vars(module).items():
        is_part = isinstance(value, type) or inspect.isroutine(value)
        if is_part and name[0] != "_" and not hasattr(basemat, name) and value.__module__.startswith("basemat"):
            if value.__module__ == module.__name__ or name == "NonlinearModel":
                found.append(name)
    return found


def members(value: Any) -> Iterator[tuple[str, Any]]:
    """Public members of a class with a text, in the order of their definition."""
    for name, member in vars(value).items():
        if name[0] != "_" and not isinstance(member, (int, float, str)) and inspect.getdoc(getattr(value, name, None) or member):
            if callable(member) or isinstance(member, (property, staticmethod, classmethod)) or inspect.isgetsetdescriptor(member):
                yield name, member


def signature(value: Any, shown: str, stubs: Stubs) -> str:
    """A call of a function of Python with its types."""
    try:
        found = inspect.signature(value)
    except (TypeError, ValueError):
        return ""
    parts = []
    for parameter in found.parameters.values():
        if parameter.name == "self":
            continue
        if parameter.kind == parameter.KEYWORD_ONLY and "*" not in parts:
            parts.append("*")
        prefix = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
        kind = "" if parameter.annotation is parameter.empty else f": {stubs.plain(annotation(parameter.annotation))}"
        default = "" if parameter.default is parameter.empty else f" = {stubs.default(repr(parameter.default))}"
        parts.append(f"{prefix}{parameter.name}{kind}{default}")
    is_typed = not isinstance(value, type) and found.return_annotation is not found.empty
    return call(shown, parts, stubs.plain(annotation(found.return_annotation)) if is_typed else "")


def annotation(kind: Any) -> str:
    """A type as its text."""
    return kind if isinstance(kind, str) else getattr(kind, "__name__", str(kind))


def first_sentence(value: Any) -> str:
    """The first sentence of a docstring for a cell of a table."""
    text = " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())
    sentence = re.split(r"(?<=[.:;]) (?=[A-Z`])", text)[0]
    return re.sub(r"(?<!`)`([\w.]+)`(?!`)", r"`\1`", sentence.rstrip(".:;")).replace("|", "\\|")
