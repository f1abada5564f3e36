"""Parameters of descriptions, with their values and units."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from . import _core
from ._pickling import _MADE, Made, _layer

_UNIT = re.compile(
    r"(?<![\w/'’`.])(kg m²/m|kg m²|kg/m³|kg/m²|kg/m|kg|N·m/rad|N·m/m|N·m|N s/m|N/m|N|Pa s/m|Pa/m|m/Pa|Pa|m/s²|m/s|m⁴/m|m³/m|"
    r"m²|m|rad/s|rad|s|Hz|bytes)(?![\w·²³⁴/'’])"
)
"""A unit in a docstring."""

Row = tuple[str, str, str]
"""Name of a parameter, its value and its unit."""


Known = Mapping[int, str]
"""Names of objects that have separate rows, by their ``id``."""


def rows_of(name: str, value: Any, known: Known) -> Iterator[Row]:
    """Rows of a description and of those that it is made of; ``name``: what it is for the simulation."""
    model = model_of_opensees(value)
    value = value if model is None else model
    made = value if isinstance(value, Made) else getattr(value, "__dict__", {}).get(_MADE)
    if isinstance(value, _core.Record):
        samples = len(value.accelerations)
        yield name, f"Record of {samples} samples, peak {value.peak_acceleration:.6g}", "m/s²"
        yield f"{name}: time step", f"{value.time_step:.9g}", "s"
    elif made is not None and made.owner is not _layer:
        yield from _rows_of_call(name, made, known)
    elif isinstance(value, (list, tuple)):
        yield from _rows_of_list(name, value, known)
    elif type(value).__module__ == "basemat" and _signature(type(value)):
        given = {attribute: getattr(value, attribute) for attribute in _signature(type(value)) if hasattr(value, attribute)}
        yield name, type(value).__name__, ""
        yield from _rows_of_arguments(name, given, inspect.getdoc(type(value)) or "", known)
    elif hasattr(type(value), "_state_outside"):
        yield name, repr(value), ""
    elif not inspect.isroutine(value) and hasattr(value, "__dict__"):
        # Of a class that the user wrote.
        yield name, type(value).__name__, ""
        yield from _rows_of_arguments(name, vars(value), "", known)
    else:
        yield name, _shown(value), ""


def model_of_opensees(value: Any) -> _core.Structure | None:
    """The structure that stands for a linear model of OpenSees, with its beams of fibres; None for other objects."""
    model = getattr(value, "_model", None)
    if not isinstance(model, _core.MatrixModel):
        return None
    with_fibers = getattr(value, "__basemat_structure__", None)
    return with_fibers if isinstance(with_fibers, _core.Structure) else model


def _rows_of_call(name: str, made: Made, known: Known) -> Iterator[Row]:
    """Rows of a call, its defaults included."""
    is_class = isinstance(made.owner, type)
    owner = made.owner if is_class or inspect.isroutine(made.owner) or hasattr(made.owner, "__wrapped__") else type(made.owner)
    if isinstance(made.owner, Made):
        # A mesh made from another one.
        yield from _rows_of_call(name, made.owner, known)
        owner = made.owner.owner
    function = owner if made.name is None else getattr(owner, made.name)
    yield name, owner.__name__ + ("" if made.name is None else f".{made.name}"), ""
    parameters = {argument: one for argument, one in _signature(function).items() if argument != "self"}
    given = {argument: one.default for argument, one in parameters.items() if one.default not in (None, one.empty)}
    arguments = {**dict(zip(parameters, made.arguments)), **made.keywords}
    merged = {**given, **arguments}
    ordered = {argument: merged[argument] for argument in parameters if argument in merged}
    docs = "\n".join(inspect.getdoc(documented) or "" for documented in (function, owner))
    yield from _rows_of_arguments(name, ordered, docs, known)
    for method, values, keywords in made.calls:
        yield f"{name}: {method}", ", ".join(map(_shown, (*values, *keywords.values()))), ""


def _rows_of_arguments(name: str, arguments: Mapping[str, Any], docs: str, known: Known) -> Iterator[Row]:
    for argument, value in arguments.items():
        if value is None:
            continue
        path = f"{name}: {argument.replace('_', ' ')}"
        if id(value) in known:
            yield path, known[id(value)], ""
        elif _is_description(value) or isinstance(value, (list, tuple)) and any(map(_is_description, value)):
            yield from rows_of(path, value, known)
        else:
            # Numbers of degrees of freedom have no unit, though what they read has one.
            has_unit = argument != "row" and not isinstance(value, (bool, str))
            yield path, _shown(value), _unit(argument, docs) if has_unit else ""


def _rows_of_list(name: str, values: Any, known: Known) -> Iterator[Row]:
    """Rows of the entries, equal neighbours once."""
    found = [list(rows_of("", value, known)) for value in values]
    first = 0
    for place in range(1, len(found) + 1):
        if place < len(found) and found[place] == found[first]:
            continue
        numbers = f"{first}" if place == first + 1 else f"{first} to {place - 1}"
        for path, value, unit in found[first]:
            yield f"{name} {numbers}{path}", value, unit
        first = place


def _is_description(value: Any) -> bool:
    """Whether a value needs separate rows."""
    return isinstance(value, Made) or _MADE in getattr(value, "__dict__", {}) or isinstance(value, (_core.Record, _core.Soil))


def _signature(function: Any) -> dict[str, inspect.Parameter]:
    try:
        return dict(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return {}


def _unit(name: str, docs: str) -> str:
    """The unit of a parameter in the docstring that describes it; none for ratios and numbers."""
    for part in re.split(rf"``{name}``|^\s*{name}:", docs, flags=re.M)[1:]:
        # Names that share their words: ``left`` to ``right`` (m).
        part = re.sub(r"^(\s*(,|and|or|to|, and)\s*``\w+``)+", "", part)
        # Up to the next parameter, or the next entry of a list of arguments.
        sentence = re.split(r"``|\n\s*\w+: |\. [A-Z]", part, maxsplit=1)[0]
        if found := _UNIT.search(sentence):
            return found[1]
    return ""


def _shown(value: Any) -> str:
    """A value in a cell."""
    if isinstance(value, (bool, str)) or value is None:
        return str(value)
    if isinstance(value, (int, float, np.generic)):
        return f"{value:.9g}"
    if hasattr(value, "shape") and value.shape:
        return f"array of shape {tuple(value.shape)}, largest {abs(value).max():.6g} (in the program)"
    if isinstance(value, (list, tuple)) and len(value) <= 12:
        text = f"[{', '.join(map(_shown, value))}]"
        return text if len(text) <= 200 else f"{text[:160]}… (in the program)"
    if isinstance(value, (list, tuple)):
        return f"list of {len(value)} (in the program)"
    text = str(value)
    return text if len(text) <= 200 else f"{text[:160]}… (in the program)"
