"""A simulation as the text of a program that makes it again."""

from __future__ import annotations

import inspect
import keyword
import math
import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _core
from ._parameters import model_of_opensees
from ._pickling import _CALLS, _MADE, Made, _layer

_SHORT = 30
"""Numbers up to which a list stands in the text; longer ones are arrays in a file beside it."""

_DEFAULTS: dict[str, Any] = {"fixed_base": False}
"""Arguments of a simulation that are left out of the program; others are if they are None or empty."""


class Program:
    """Lines of Python that make a simulation again, and the arrays that they read from a file.

    ``missing``: in words, what the text does not hold: functions, files of meshes.
    """

    def __init__(self, simulation: _core.Simulation) -> None:
        self.arrays: dict[str, Any] = {}
        self.missing: list[str] = []
        self._lines: list[str] = []
        self._classes: dict[type, str] = {}
        self._names: dict[int, str] = {}
        self._keep: list[Any] = []
        self._subject = ""
        arguments = simulation._arguments
        given = []
        for name, value in arguments.items():
            if value is None or value is _DEFAULTS.get(name) or isinstance(value, list) and not value:
                continue
            self._subject = name
            if name in ("time_step", "fixed_base"):
                given.append(f"{name}={self._text(value)}")
                continue
            text = self._text(value)
            if text != name:
                self._lines.append(f"{name} = {text}")
            self._name(value, name)
            given.append(f"{name}={name}")
        self._lines.append(f"simulation = bm.Simulation({', '.join(given)})")

    def text(self, file: str) -> str:
        """The program; ``file``: name of the file of arrays."""
        head = ["import numpy as np", "", "import basemat as bm", ""]
        if any("sparse." in line for line in self._lines):
            head.insert(1, "from scipy import sparse")
        if self.arrays:
            head += [f"data = np.load({file!r})"]
        sources = [line for source in self._classes.values() for line in ("", source, "")]
        return "\n".join([*head, *sources, *self._lines]) + "\n"

    def _name(self, value: Any, name: str) -> None:
        """Lets later lines use a variable for a value."""
        self._names[id(value)] = name
        # The number of an object is its own only while it lives.
        self._keep.append(value)

    def _text(self, value: Any) -> str:
        """A value as an expression."""
        if id(value) in self._names:
            return self._names[id(value)]
        if isinstance(value, Made):
            return self._made(value)
        if value is None or isinstance(value, (bool, int, str)):
            return repr(value)
        if isinstance(value, (float, np.generic)):
            return _number(value.item() if isinstance(value, np.generic) else value)
        if isinstance(value, np.ndarray):
            return self._array(value)
        if hasattr(value, "tocoo"):
            return self._sparse(value.tocoo())
        if isinstance(value, (list, tuple)):
            return self._list(value)
        if isinstance(value, Mapping):
            return "{" + ", ".join(f"{self._text(k)}: {self._text(v)}" for k, v in value.items()) + "}"
        return self._object(value)

    def _list(self, value: Any) -> str:
        numbers = len(value) > _SHORT and all(isinstance(number, (int, float, np.number)) for number in value)
        if numbers:
            return self._array(np.asarray(value))
        texts = [self._text(entry) for entry in value]
        # Equal storeys, or springs, once.
        if len(texts) > 1 and len(set(texts)) == 1 and isinstance(value, list):
            return f"[{texts[0]}] * {len(texts)}"
        inner = ", ".join(texts)
        return f"[{inner}]" if isinstance(value, list) else f"({inner}{',' * (len(texts) == 1)})"

    def _array(self, value: Any) -> str:
        if value.size <= _SHORT and value.dtype.kind in "fiu":
            return f"np.array({self._list(value.tolist())})" if value.ndim else _number(value.item())
        name = f"{self._subject}_{len(self.arrays)}"
        self.arrays[name] = value
        return f'data["{name}"]'

    def _sparse(self, value: Any) -> str:
        parts = ", ".join(self._array(np.asarray(indices)) for indices in (value.row, value.col))
        return f"sparse.coo_matrix(({self._array(value.data)}, ({parts})), shape={tuple(value.shape)}).tocsr()"

    def _call(self, function: str, arguments: Any, keywords: Mapping[str, Any]) -> str:
        texts = [self._text(argument) for argument in arguments]
        texts += [f"{name}={self._text(argument)}" for name, argument in keywords.items()]
        return f"{function}({', '.join(texts)})"

    def _made(self, made: Made) -> str:
        """The call that made a description; with calls that added to it, a variable."""
        if made.owner is _layer:
            profile, number = made.arguments
            return f"{self._text(profile)}.layers[{number}]"
        if isinstance(made.owner, type) or inspect.isroutine(made.owner) or hasattr(made.owner, "__wrapped__"):
            function = f"bm.{made.owner.__name__}" + ("" if made.name is None else f".{made.name}")
            if made.owner in (_core.GmshMesh, _core.GmshSpaceMesh):
                self.missing.append(f"the file {made.arguments[0] if made.arguments else ''}")
        else:
            function = f"{self._text(made.owner)}.{made.name}"
        text = self._call(function, made.arguments, made.keywords)
        if not made.calls:
            return text
        name = f"{self._subject}_mesh" if made.owner is _core.Mesh else f"{self._subject}_part"
        while name in self._names.values():
            name += "_"
        self._lines.append(f"{name} = {text}")
        self._name(made, name)
        self._lines += [self._call(f"{name}.{method}", arguments, keywords) for method, arguments, keywords in made.calls]
        return name

    def _object(self, value: Any) -> str:
        """An object of a class of the package, or of the user's."""
        if isinstance(value, _core.Record):
            samples, known = np.asarray(value.accelerations), _core.el_centro_1940()
            if value.time_step == known.time_step and np.array_equal(samples, known.accelerations):
                return "bm.el_centro_1940()"
            return f"bm.Record({_number(value.time_step)}, {self._array(samples)})"
        attributes = getattr(value, "__dict__", {})
        if _MADE in attributes:
            return self._made(attributes[_MADE]._replace(calls=tuple(attributes.get(_CALLS, ()))))
        if isinstance(value, _core.DofCombination):
            return f"bm.DofCombination({dict(value.terms)})"
        if isinstance(value, _core.BaseFaces):
            return f"bm.BaseFaces({self._list([list(face) for face in value])})"
        kind = type(value)
        if kind.__module__ == "basemat":
            return self._of_package(value)
        if (model := model_of_opensees(value)) is not None:
            return self._text(model)
        return self._of_user(value)

    def _of_package(self, value: Any) -> str:
        """An object by its arguments, which it gives for pickles or as attributes."""
        name = f"bm.{type(value).__name__}"
        if hasattr(value, "__getnewargs_ex__"):
            return self._call(name, *value.__getnewargs_ex__())
        if hasattr(value, "__getnewargs__"):
            return self._call(name, value.__getnewargs__(), {})
        parameters = inspect.signature(type(value)).parameters
        return self._call(name, (), {parameter: getattr(value, parameter) for parameter in parameters if hasattr(value, parameter)})

    def _of_user(self, value: Any) -> str:
        """An object of a class that the user wrote: its class and its attributes; or a name that is said to be missing."""
        kind = type(value)
        words = f"the {kind.__name__} of the argument {self._subject}"
        if hasattr(kind, "_state_outside"):
            self.missing.append(kind._state_outside)
            return self._subject
        if inspect.isroutine(value) or isinstance(value, type) or not hasattr(value, "__dict__"):
            function = getattr(value, "__name__", kind.__name__)
            self.missing.append(f"the function {function} of the argument {self._subject}")
            return function if function.isidentifier() and not keyword.iskeyword(function) else "the_function"
        try:
            self._classes.setdefault(kind, textwrap.dedent(inspect.getsource(kind)).rstrip())
        except (OSError, TypeError):
            self.missing.append(words)
            return self._subject
        name = f"{self._subject}_object"
        while name in self._names.values():
            name += "_"
        attributes = ", ".join(f"{attribute!r}: {self._text(value)}" for attribute, value in vars(value).items())
        self._lines += [f"{name} = {kind.__name__}.__new__({kind.__name__})", f"vars({name}).update({{{attributes}}})"]
        self._name(value, name)
        return name


def _number(value: Any) -> str:
    """A number to its last bit."""
    if isinstance(value, float) and not math.isfinite(value):
        return f'float("{value}")'
    return repr(value)
