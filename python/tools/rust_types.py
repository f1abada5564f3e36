"""Types of the compiled module's functions and members, read from the Rust sources.

`read` finds the classes (``#[pyclass]``), their members (``#[pymethods]``) and functions (``#[pyfunction]``), and
translates the Rust types of parameters and results. It reads no macros: members that Python sees are written out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ARRAY = "NDArray[np.float64]"
SIMPLE = {
    **dict.fromkeys(["f64"], "float"),
    **dict.fromkeys(["usize", "u32", "u64", "i64", "isize", "Count"], "int"),
    **dict.fromkeys(["str", "String", "char"], "str"),
    **dict.fromkeys(["Numbers", "Points", "Pairs", "PointGrid", "Vectors", "PerElement", "Connectivity"], "ArrayLike"),
    "bool": "bool",
    "BackfillArguments": "tuple[float, Soil] | tuple[float, Soil, DampingLaw]",
    "BaseLike": "_Base",
    "BoxHeights": "float | Sequence[float | None]",
    "BlockMaterials": "_Solid | Sequence[_Solid | Sequence[_Solid]]",
    "Cells": "ArrayLike | Sequence[Sequence[int]]",
    "Contact": "Sequence[int] | Sequence[Sequence[int]]",
    "ContactMesh": "Strip | Sequence[Strip] | Plan",
    "ElasticList": "Material | Sequence[Material]",
    "ElasticMaterial": "Material",
    "FarFieldSoil": "Soil",
    "FiberLaw": "_FiberLaw",
    "FiberSectionList": "FiberSection | Sequence[FiberSection]",
    "GroupPart": "_GmshPart",
    "LawLike": "Hysteresis | UserHysteresis",
    "Matrix": "_MatrixLike",
    "NodeLists": "Sequence[BaseNode] | Sequence[Sequence[BaseNode]]",
    "Profile": "Soil | SoilProfile",
    "PlaneTensors": "ArrayLike",
    "PathBuf": "str | os.PathLike[str]",
    "PyBytes": "bytes",
    "PyDict": "dict[str, Any]",
    "RotaryInertia": "float | Sequence[float]",
    "RowLike": "_RowLike",
    "Rows": ARRAY,
    "SolidLike": "_Solid",
    "SolidList": "_Solid | Sequence[_Solid]",
    "SpringList": "Sequence[_Spring]",
}
"""Python's types of the Rust types other than lists, tuples and classes of the module."""
NUMBERS = {"f64": "float64", "Complex64": "complex128", "u8": "uint8", "u64": "uint64"}
"""Numbers of arrays: numpy's names by Rust's."""
WRAPPERS = {"PyResult", "Bound", "Py", "PyRef", "PyRefMut", "PyClassInitializer"}
"""Rust types that hold a value of their last argument's type."""


@dataclass
class Member:
    """A function, a member of a class, or a constant of one."""

    kind: str
    """Its attribute "getter", "staticmethod", "new" or "classattr", else "method" or "function"."""
    parameters: dict[str, str] = field(default_factory=dict)
    """Rust types by the names of parameters."""
    returned: str = "()"
    """Rust type of the result."""


@dataclass
class Module:
    """Classes and functions of the module, by Python's names."""

    structs: dict[str, str] = field(default_factory=dict)
    """Python's names of classes by Rust's."""
    comparable: set[str] = field(default_factory=set)
    """Classes that compare their values."""
    members: dict[str, dict[str, Member]] = field(default_factory=dict)
    """Members by the names of classes, in the order of the sources."""
    functions: dict[str, Member] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    """Rust types by the names that the sources give them."""

    def python_type(self, rust: str, owner: str, open_type: str | None, is_parameter: bool) -> str:
        """Python's type of a Rust type; a ``KeyError`` names a Rust type without one.

        ``owner``: the class that ``Self`` stands for. ``open_type``: Python's type of texts and objects, which the Rust
        type leaves open. ``is_parameter``: lists are any sequences then; those of results are lists.
        """
        rust = re.sub(r"^(&|'\w+ |mut )*", "", rust.strip())
        name, inner = name_and_arguments(rust)
        parts = [part for part in split(inner) if not re.fullmatch(r"'\w+", part)]
        sequence = "Sequence" if is_parameter else "list"

        def of(part: str) -> str:
            return self.python_type(part, owner, open_type, is_parameter)

        if rust.startswith("("):
            return f"tuple[{', '.join(map(of, parts))}]" if parts else "None"
        if rust.startswith("["):
            return "bytes" if inner == "u8" else f"{sequence}[{of(re.split(r'; *[A-Z0-9]+$', inner)[0])}]"
        if name in WRAPPERS:
            return of(parts[-1])
        if name == "Option":
            kind = of(parts[0])
            return kind if kind == "Any" or kind.endswith("None") else f"{kind} | None"
        if name == "Vec":
            return f"{sequence}[{of(parts[0])}]"
        if name == "ListOf":
            # A single object is a list of one.
            return f"{of(parts[0])} | Sequence[{of(parts[0])}]"
        if name == "PairList":
            return f"{sequence}[tuple[{', '.join(map(of, parts))}]]"
        if name in ("BTreeMap", "OrderedDict"):
            return f"{'Mapping' if is_parameter else 'dict'}[{', '.join(map(of, parts))}]"
        if name in ("Array", "PyArray2", "PyArray3"):
            return f"NDArray[np.{NUMBERS[parts[0] if parts else 'f64']}]"
        if name in ("PyAny", "str") and open_type is not None:
            return open_type
        if name in self.aliases:
            return of(self.aliases[name])
        return {"Self": owner, **self.structs, **SIMPLE}[name]


def name_and_arguments(text: str) -> tuple[str, str]:
    """Name of a generic type, and the text of its arguments."""
    found = re.fullmatch(r"([\w:]*)[<(\[](.*)[>)\]]", text, re.S)
    return (found[1].rpartition("::")[2], found[2]) if found else (text.rpartition("::")[2], "")


def split(text: str) -> list[str]:
    """Parts of a list between its commas, those within brackets left aside."""
    parts, depth, start = [], 0, 0
    for place, sign in enumerate(text):
        depth += (sign in "<([{") - (sign in ">)]}" and text[place - 1 : place + 1] != "->")
        if sign == "," and depth == 0:
            parts.append(text[start:place].strip())
            start = place + 1
    return [part for part in [*parts, text[start:].strip()] if part]


def end_of_bracket(text: str, start: int) -> int:
    """Place after the bracket that closes the one at ``start``."""
    depth = 0
    for place in range(start, len(text)):
        depth += (text[place] in "([{") - (text[place] in ")]}")
        if depth == 0:
            return place + 1
    raise ValueError(text[start : start + 80])


def code_of(source: str) -> str:
    """A source with blanks in place of its comments and texts."""

    def blank(found: re.Match[str]) -> str:
        return re.sub(r"[^\n]", " ", found[0])

    comments_and_texts = r'//[^\n]*|r#"(?:.|\n)*?"#|"(?:\\(?:.|\n)|[^"\\])*"|\'(?:\\.|[^\'\\])\''
    return re.sub(comments_and_texts, blank, source)


def functions(code: str, source: str) -> Iterator[tuple[str, str, dict[str, str], str]]:
    """Attributes, name, parameters and result of the functions and constants of a block, those of inner blocks left out."""
    start = 0
    for found in re.finditer(r"\bfn (\w+)(?:<[^>(]*>)?\s*\(|\bconst (\w+): (\w+) = [^;]*;", code):
        if found.start() < start:
            continue
        attributes = "".join(re.findall(r"#\[(?:[^\[\]]|\[[^\]]*\])*\]", source[start : found.start()]))
        if found[2]:
            start = found.end()
            yield attributes, found[2], {}, found[3]
            continue
        end = end_of_bracket(code, found.end() - 1)
        parameters = {}
        for part in split(code[found.end() : end - 1]):
            name, _, kind = re.sub(r"#\[[^\]]*\]\s*|^mut ", "", part).partition(":")
            if name.strip() not in ("self", "&self", "&mut self", "slf") and "Python<" not in kind:
                parameters[re.sub(r"^mut ", "", name.strip())] = " ".join(kind.split())
        body = code.index("{", end)
        returned = re.match(r"\s*->((?:.|\n)*?)(?:\bwhere\b.*)?$", code[end:body], re.S)
        start = end_of_bracket(code, body)
        yield attributes, found[1], parameters, " ".join(returned[1].split()) if returned else "()"


def read(folder: Path) -> Module:
    """Classes and functions of all sources in a folder."""
    module = Module()
    blocks: list[tuple[str, str, str]] = []
    for path in sorted(folder.rglob("*.rs")):
        source = path.read_text("utf-8")
        code = code_of(source)
        module.aliases.update(re.findall(r"^(?:pub\S* )?type (\w+)(?:<'\w+>)? =\s*([^;]+);", code, re.M))
        for found in re.finditer(r'#\[pyclass\(name = "(\w+)"([^\]]*)\)\]', source):
            struct = re.compile(r"struct (\w+)").search(code, found.end())
            assert struct is not None
            module.structs[struct[1]] = found[1]
            if re.search(r"\beq\b", found[2]):
                module.comparable.add(found[1])
        for found in re.finditer(r"#\[pymethods\]\s*impl (\w+) \{", code):
            end = end_of_bracket(code, found.end() - 1)
            blocks.append((found[1], code[found.end() : end - 1], source[found.end() : end - 1]))
        for found in re.finditer(r"#\[pyfunction", code):
            attributes, name, parameters, returned = next(functions(code[found.start() :], source[found.start() :]))
            renamed = re.search(r'pyfunction\(name = "(\w+)"', attributes)
            module.functions[renamed[1] if renamed else name] = Member("function", parameters, returned)
    for struct_name, code, source in blocks:
        if struct_name not in module.structs:
            continue
        members = module.members.setdefault(module.structs[struct_name], {})
        for attributes, name, parameters, returned in functions(code, source):
            kind = re.search(r"#\[(getter|staticmethod|new|classattr)\]", attributes)
            renamed = re.search(r'#\[pyo3\(name = "(\w+)"\)\]', attributes)
            python_name = "__new__" if kind and kind[1] == "new" else renamed[1] if renamed else name
            members[python_name] = Member(kind[1] if kind else "method", parameters, returned)
    return module
