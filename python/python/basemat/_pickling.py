"""Descriptions of soils, structures, grounds, laws and motions that pickle.

A description remembers the arguments that it was made of, and is made of them again in another
process. Arrays among them are copied, so that it stays what it was.
"""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Mapping, MutableSequence
from typing import Any, NamedTuple

import numpy as np

from . import _core

_MADE = "_made"
_CALLS = "_calls"
"""Attributes: what a description was made of, and what was added to a mesh."""

_RETURNING = (
    (_core.PlaneWave, "field_from_horizontal"),
    (_core.PlaneWave, "field_from_vertical"),
    (_core.PlaneWave, "field_from_across"),
    (_core.Plan, "with_unions"),
    (_core.Trench, "elements"),
    (_core.Plan, "without_overhang"),
    (_core.PlaneWave, "reversed"),
    (_core.InclinedWave, "field"),
    (_core.Incoherence, "motion"),
    (_core.SoilColumn, "equivalent_linear"),
    (_core.EquivalentLinear, "profile"),
    (_core.StrainCurves, "iwan"),
    (_core.StressAtRest, "with_soil_below"),
    (_core.SoilProfile, "stress_at_rest"),
    (_core.Mesh, "with_stress_at_rest"),
    (_core.NearField, "mesh"),
    *((_core.FiberSection, f"with_{shape}") for shape in ("fiber", "fibers", "rectangle", "ring", "bars", "i_section", "i_section_in_space", "torsional_stiffness")),
    (_core.GmshMesh, "mesh"),
    (_core.GmshSpaceMesh, "mesh"),
)
"""Methods that return descriptions."""

_FUNCTIONS = ("free_field", "ricker", "travelling_wave", "triaxial", "vertical_incidence")
"""Functions that return descriptions."""


class Made(NamedTuple):
    """The origin of a description: a class, function or method, and its arguments."""

    owner: Any
    name: str | None
    arguments: tuple[Any, ...]
    keywords: dict[str, Any]
    calls: tuple[tuple[str, tuple[Any, ...], dict[str, Any]], ...] = ()

    def again(self) -> Any:
        """The description, made anew."""
        owner = _given(self.owner)
        make = owner if self.name is None else getattr(owner, self.name)
        found = make(
            *map(_given, self.arguments), **{k: _given(v) for k, v in self.keywords.items()}
        )
        for method, arguments, keywords in self.calls:
            getattr(found, method)(*arguments, **keywords)
        return found


def _given(value: Any) -> Any:
    return value.again() if isinstance(value, Made) else value


_PLAIN: set[type] = {int, float, str, bool, type(None)}
"""Types whose values never change: these, and the descriptions."""


def _kept(value: Any) -> Any:
    """A copy of what may change later."""
    kind = type(value)
    if kind in _PLAIN:
        return value
    if kind is tuple or kind is list:
        return kind(map(_kept, value))
    if isinstance(value, np.ndarray) and value.dtype == object:
        return _kept(value.tolist())
    if isinstance(value, np.ndarray) or hasattr(value, "tocoo"):
        return value.copy()
    if isinstance(value, _core.Mesh):
        return _how(value)
    if isinstance(value, (type, np.generic)) or _is_part(value):
        return value
    if hasattr(value, "__array__"):
        return np.array(value)
    if isinstance(value, tuple):
        return tuple(_kept(entry) for entry in value)
    if isinstance(value, MutableSequence):
        return [_kept(entry) for entry in value]
    if isinstance(value, Mapping):
        return {name: _kept(entry) for name, entry in value.items()}
    return value


def _is_part(value: Any) -> bool:
    """Whether this is a function, a structure, a ground, a law or a material of the user's, whatever else it may be."""
    methods = ("base", "conditions", "limits", "response", "step_compliance", "stress")
    return callable(value) or any(callable(getattr(value, method, None)) for method in methods)


def _made(owner: Any, name: str | None, arguments: Any, keywords: dict[str, Any]) -> Made:
    named = {name: _kept(entry) for name, entry in keywords.items()}
    return Made(owner, name, tuple(map(_kept, arguments)), named)


def _noting(call: Callable[..., Any], note: Callable[..., None]) -> Callable[..., Any]:
    """``call``, followed by ``note`` with its result and arguments."""

    @functools.wraps(call)
    def noting(*arguments: Any, **keywords: Any) -> Any:
        found = call(*arguments, **keywords)
        note(found, arguments, keywords)
        return found

    return noting


def _remembering(make: Callable[..., Any], owner: Any, name: str | None) -> Callable[..., Any]:
    """``make``, which leaves in its result how it was made: by the ``owner``, by itself without a name, or else by
    the object whose method it is."""

    def note(found: Any, arguments: Any, keywords: Any) -> None:
        if owner is None and name is not None:
            vars(found)[_MADE] = _made(_kept(arguments[0]), name, arguments[1:], keywords)
        elif hasattr(found, "__dict__"):
            vars(found)[_MADE] = _made(owner or remember, name, arguments, keywords)

    remember = _noting(make, note)
    return remember


def _how(description: Any) -> Made:
    """The origin of a description, calls that added to it included."""
    attributes = vars(description)
    made: Made = attributes[_MADE]
    return made._replace(calls=tuple(attributes.get(_CALLS, ())))


def _reduce(self: Any) -> Any:
    return Made.again, (_how(self),)


def _repr(self: Any) -> str:
    """The call that makes it; of a ground also its number of elements."""
    made = _how(self)
    if made.owner is _layer:
        return _values(self)
    is_named = isinstance(made.owner, type) or inspect.isfunction(made.owner)
    owner = made.owner if is_named else type(self)
    # A section shows all of its fibres.
    before = repr(made.owner) if isinstance(made.owner, _core.FiberSection) else owner.__name__
    name = owner.__name__ if made.name is None else f"{before}.{made.name}"
    keywords = [f"{name}={_short(value)}" for name, value in made.keywords.items()]
    call = f"{name}({', '.join([*map(_short, made.arguments), *keywords])})"
    # A count that was asked for may have been raised.
    return f"{call}  # {len(self.elements)} elements" if isinstance(self, _core.Ground) else call


def _values(self: Any) -> str:
    """The values that can be read of it."""
    names = [name for name, descriptor in vars(type(self)).items() if inspect.isgetsetdescriptor(descriptor)]
    # Arguments of the constructor as there, others by their names: the class keeps no order.
    order = [*inspect.signature(type(self)).parameters] if type(self).__text_signature__ else []
    names.sort(key=lambda name: (order.index(name) if name in order else len(order), name))
    values = [f"{name}={_short(getattr(self, name))}" for name in names if name != "__dict__"]
    return f"{type(self).__name__}({', '.join(values)})"


def _short(value: Any) -> str:
    """An argument in a few words."""
    if isinstance(value, Made):
        return f"{value.owner.__name__}(…)"
    if hasattr(value, "shape") and value.shape:
        return f"<array of shape {value.shape}>"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _prepare(described: Any) -> None:
    """Lets a class remember what its instances are made of."""
    signature = inspect.signature(described) if described.__text_signature__ else None
    described.__reduce__ = _reduce
    if described.__repr__ is object.__repr__:
        described.__repr__ = _repr
    for name, method in list(vars(described).items()):
        if isinstance(method, staticmethod) and not name.startswith("_"):
            make = getattr(described, name)
            setattr(described, name, staticmethod(_remembering(make, described, name)))
    if signature is None and sys.version_info >= (3, 10):
        # It has no constructor; older versions do not know signatures of classes.
        return

    def __init__(self: Any, *arguments: Any, **keywords: Any) -> None:
        vars(self)[_MADE] = _made(type(self), None, arguments, keywords)

    if signature is not None:
        self_parameter = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
        parameters = [self_parameter, *signature.parameters.values()]
        try:
            __init__.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
        except ValueError:
            pass
    described.__init__ = __init__


def _layer(profile: _core.SoilProfile, number: int) -> _core.SoilLayer:
    return profile.layers[number]


def _prepare_layers() -> None:
    """Lets the layers that a profile returns pickle as layers of the profile."""
    get: Any = _core.SoilProfile.layers

    def layers(self: _core.SoilProfile) -> list[_core.SoilLayer]:
        found: list[_core.SoilLayer] = get.__get__(self)
        for number, layer in enumerate(found):
            vars(layer)[_MADE] = Made(_layer, None, (self, number), {})
        return found

    _core.SoilProfile.layers = property(layers, doc=get.__doc__)  # type: ignore[method-assign,assignment]


def _prepare_call(name: str) -> None:
    """A method that adds to a mesh."""

    def note(_: Any, arguments: Any, keywords: Any) -> None:
        mesh, *others = arguments
        vars(mesh).setdefault(_CALLS, []).append((name, tuple(map(_kept, others)), _kept(keywords)))

    setattr(_core.Mesh, name, _noting(getattr(_core.Mesh, name), note))


def _prepare_extrusion() -> None:
    """A grid that adds nodes to a mesh."""
    extrude = _core.Grid.extrude

    @functools.wraps(extrude)
    def extruding(self: _core.Grid, mesh: _core.Mesh, heights: Any) -> list[list[int]]:
        before = len(mesh.nodes)
        bricks = extrude(self, mesh, heights)
        vars(mesh).setdefault(_CALLS, []).append(("add_nodes", (mesh.nodes[before:],), {}))
        return bricks

    _core.Grid.extrude = extruding  # type: ignore[method-assign]


def _prepare_all() -> None:
    """Lets all descriptions pickle; once, when the package is imported."""
    classes: list[Any] = [value for value in vars(_core).values() if isinstance(value, type)]
    for described in classes:
        if described is _core.Record:
            # A record is its samples.
            described.__reduce__ = object.__reduce__  # type: ignore[method-assign]
        elif described.__dictoffset__:
            # There is room for what it was made of.
            _prepare(described)
            _PLAIN.add(described)
        elif described.__repr__ is object.__repr__:
            described.__repr__ = _values
    # What was added to a mesh is kept with it.
    _PLAIN.remove(_core.Mesh)
    for owner, name in _RETURNING:
        setattr(owner, name, _remembering(getattr(owner, name), None, name))
    for name in [name for name in vars(_core.Mesh) if name.startswith("add_")]:
        _prepare_call(name)
    _prepare_call("revolve")
    _prepare_extrusion()
    _prepare_layers()
    for name in _FUNCTIONS:
        function = _remembering(getattr(_core, name), None, None)
        function.__module__ = "basemat"
        setattr(_core, name, function)


_prepare_all()
