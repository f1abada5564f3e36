"""Results and shapes as objects of xarray and PyVista: methods of the results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import _ELEMENT_UNITS, MODES, DeformedShape, Mesh, Run
from ._errors import InputError
from ._figures import was_kept
from ._shapes import usual_scale

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from pyvista import UnstructuredGrid
    from xarray import Dataset

_CELL_TYPES = {1: 1, 2: 3, 3: 5, 4: 9}
"""Types of VTK by the number of points: vertex, line, triangle, quadrilateral."""
_ASCII = str.maketrans({"·": " ", "²": "2", "³": "3", "⁴": "4", "°": "deg"})
"""Signs of units that texts of VTK cannot hold."""
_POLYGON, _QUADRATIC_QUAD, _HEXAHEDRON = 7, 23, 12
"""Types of VTK of other cells."""


def to_xarray(self: Run) -> Dataset:
    """The run as an ``xarray.Dataset``, with the unit of each variable in ``attrs["units"]``; it needs xarray.

    Time series are along "time" (s), energies are called "energy_…", envelopes "envelope_…" along "element". Snapshots of the
    contact, "contact_…", are along "contact_time" and "element", with the names of the modes in ``attrs["modes"]``; those of the
    structure, "displacement" and "velocity", are along "motion_time" and "dof". Coordinates "left", "right", "bottom" and
    "top", in plan "front" and "back", are the ends of the elements (m). ``attrs["ground_motion"]`` has the motion in words.
    ``to_netcdf`` writes a file.
    """
    try:
        import xarray
    except ImportError as error:
        raise ImportError("to_xarray needs xarray: pip install xarray") from error
    units = self.units
    coordinates: dict[str, Any] = {"time": ("time", self.time, {"units": "s"})}
    variables: dict[str, Any] = {}
    for name, values in self.series.items():
        if name != "time":
            variables[name] = "time", values, {"units": units.get(name, "")}
    balances = {**self.energy_balances}
    # Energies have a value for each step, as the series.
    times = balances.pop("time")
    along = "time" if np.array_equal(times, self.time) else "energy_time"
    coordinates.setdefault(along, (along, times, {"units": "s"}))
    for name, values in balances.items():
        variables[f"energy_{name}"] = along, values, {"units": units.get(name, "")}
    ends = ("left", "right", "front", "back")
    for name, values in self.envelope.items():
        element_unit = {"units": "s" if name.endswith("_time") else _ELEMENT_UNITS.get(name, "")}
        if name in ends:
            coordinates[name] = "element", values, {"units": "m"}
        else:
            variables[f"envelope_{name}"] = "element", values, element_unit
    for number, name in enumerate(("bottom", "top")):
        coordinates[name] = "element", self.heights[:, number], {"units": "m"}
    if was_kept(self, "contact"):
        snapshots = {**self.contact}
        coordinates["contact_time"] = "contact_time", snapshots.pop("time"), {"units": "s"}
        for name, values in snapshots.items():
            attributes = {"units": "", "modes": list(MODES)} if name == "mode" else {"units": _ELEMENT_UNITS.get(name, "")}
            variables[f"contact_{name}"] = ("contact_time", "element"), values, attributes
    if was_kept(self, "motion"):
        motion = self.motion
        coordinates["motion_time"] = "motion_time", motion["time"], {"units": "s"}
        if self.dof_names is not None:
            coordinates["dof"] = "dof", self.dof_names
        for name, unit in (("displacement", "m or rad"), ("velocity", "m/s or rad/s")):
            variables[name] = ("motion_time", "dof"), motion[name], {"units": unit}
    return xarray.Dataset(variables, coordinates, {"ground_motion": self._ground_motion})


def pyvista() -> Any:
    """The module pyvista, or an error that says how to get it."""
    try:
        import pyvista as found
    except ImportError as error:
        raise ImportError("to_pyvista needs PyVista: pip install pyvista") from error
    return found


def shape_to_pyvista(
    self: DeformedShape, displacement: ArrayLike | None = None, *, scale: float | None = None
) -> UnstructuredGrid:
    """The shape as a ``pyvista.UnstructuredGrid``, which ``plot()`` shows and one can turn; it needs PyVista.

    ``displacement``: all n degrees of freedom, array of shape (n,), m and rad, as for `DeformedShape.plot`; the shape at rest
    unless given. ``scale``: factor on the displacements of the points; unless given, a round one that makes the largest a
    twentieth to a tenth of the structure's size. Point data "displacement" (m) is not scaled; field data "scale" has the
    factor, and "units" the unit of each array as texts "name: unit".
    """
    module, points, moves = pyvista(), self.points, None
    factor = 0.0
    if displacement is not None:
        moves = self.displacements(displacement)
        factor = usual_scale(points, float(np.linalg.norm(moves, axis=1).max(initial=0.0))) if scale is None else scale
        points = points + factor * moves
    cells = [cell for cell in self.cells if cell]
    grid: UnstructuredGrid = _grid(module, points, cells, [_CELL_TYPES.get(len(cell), _POLYGON) for cell in cells])
    if moves is not None:
        grid.point_data["displacement"] = moves
        grid.field_data["scale"] = [factor]
    grid.field_data["units"] = ["points: m", "displacement: m"]
    return grid


def mesh_to_pyvista(
    self: Mesh,
    values: Mapping[str, ArrayLike] | None = None,
    *,
    elements: Sequence[int] | None = None,
    units: Mapping[str, str] | None = None,
) -> UnstructuredGrid:
    """Elements of the mesh as a ``pyvista.UnstructuredGrid`` with values as cell data; it needs PyVista.

    In the plane z is zero. Cell data "element" has the numbers of the elements.

    Args:
        values: names and arrays of shape (elements,) or (elements, components), one row for each of ``elements``; none unless
            given.
        elements: numbers of the elements in the grid; all with two nodes or more unless given.
        units: unit of each of the values, stored in the field data "units" as texts "name: unit", in ASCII, such as
            "moment: N m/m"; none unless given.
    """
    module, connected, nodes = pyvista(), self.elements, self.nodes
    numbers = [k for k, cell in enumerate(connected) if len(cell) > 1] if elements is None else [int(k) for k in elements]
    for number in numbers:
        if not 0 <= number < len(connected):
            raise InputError(f"element is {number}, but must be one of the mesh's {len(connected)}")
    is_plane = nodes.shape[1] == 2
    points = np.column_stack([nodes, np.zeros(len(nodes))]) if is_plane else nodes
    types = []
    for number in numbers:
        count = len(connected[number])
        eight = _QUADRATIC_QUAD if is_plane else _HEXAHEDRON
        types.append(eight if count == 8 else _CELL_TYPES.get(count, _POLYGON))
    grid: UnstructuredGrid = _grid(module, points, [connected[number] for number in numbers], types)
    grid.cell_data["element"] = np.array(numbers)
    for name, given in (values or {}).items():
        array = np.asarray(given, dtype=float)
        if array.ndim not in (1, 2) or len(array) != len(numbers):
            rows = f"a row for each of {len(numbers)} elements"
            raise InputError(f"values '{name}' have the shape {array.shape}, but must have {rows}")
        grid.cell_data[name] = array
    texts = [f"{name}: {unit}".translate(_ASCII) for name, unit in (units or {}).items()]
    grid.field_data["units"] = ["points: m", *texts]
    return grid


def _grid(module: Any, points: NDArray[np.float64], cells: Sequence[Sequence[int]], types: Sequence[int]) -> Any:
    """A grid of cells by the numbers of their points."""
    if not cells:
        raise InputError("there are no elements to draw")
    flat = np.concatenate([[len(cell), *cell] for cell in cells])
    return module.UnstructuredGrid(flat, np.array(types, dtype=np.uint8), np.asarray(points, dtype=float))
