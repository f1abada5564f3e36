"""Results as pandas frames: methods of the results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._core import (
    _ELEMENT_UNITS,
    MODES,
    BeamSections,
    EquivalentLinear,
    Impedances,
    JointResults,
    KinematicMotions,
    Run,
    Spectrum,
)
from ._errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from pandas import DataFrame


def pandas() -> Any:
    """The module pandas, or an error that says how to get it."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("frames and sweeps need pandas: pip install pandas") from error
    return pandas


_UNITS = {
    "m": "depth x y z residual_slip residual_slip_across residual_settlement displacement",
    "rad": "residual_rotation residual_rotation_across",
    "Pa": "shear_modulus",
    "s": "time period",
    "m/s": "pseudo_velocity",
    "m/s²": "acceleration pseudo_acceleration peak_acceleration",
    "N/m": "coupling",
    "N/m²": "horizontal vertical",
    "N": "rocking",
    "Hz": "frequency",
}
_UNIT = {**_ELEMENT_UNITS, **{name: unit for unit, names in _UNITS.items() for name in names.split()}}


def with_units(frame: DataFrame, units: dict[str, str], run: Run | None = None) -> DataFrame:
    """The frame, with the units of its columns and its index in ``attrs``, and with the ground motion of a run."""
    names = [name for name in (frame.index.name, *frame.columns) if name is not None]
    frame.attrs["units"] = {name: units.get(name, "") for name in names}
    if run is not None:
        frame.attrs["ground_motion"] = run._ground_motion
    return frame


def to_frame(self: Run) -> DataFrame:
    """All time series as a pandas frame, indexed by the time (s).

    Units of the columns of this and of all other frames are in ``frame.attrs["units"]``. Frames of a run have its ground
    motion in ``frame.attrs["ground_motion"]``: peak, duration and time step in words.
    """
    return with_units(pandas().DataFrame(self.series).set_index("time"), self.units, self)


def contact_frame(self: Run) -> DataFrame:
    """Snapshots of the base as a tidy pandas frame: a row per frame and element.

    Columns: "time" (s), "element", "x" (m), "gap", "slip" (m), "pressure", "shear" (Pa), "mode"; in plan also
    "y", "slip_across" (m) and "shear_across" (Pa), and with walls "z", the height of the element's middle (m).
    """
    sides = {"x": ("left", "right"), "y": ("front", "back")} if self.in_plan else {"x": ("left", "right")}
    places = {name: 0.5 * (self.envelope[low] + self.envelope[high]) for name, (low, high) in sides.items()}
    if self.heights.any():
        places["z"] = self.heights.mean(axis=1)
    return with_units(_contact_table(self.contact, places), _UNIT, self)


def _contact_table(contact: Mapping[str, Any], places: Mapping[str, Any]) -> DataFrame:
    """Snapshots of elements with these coordinates, a row per frame and element."""
    columns = {**contact}
    time, modes = columns.pop("time"), columns.pop("mode")
    frames, elements = modes.shape
    table = {"time": np.repeat(time, elements), "element": np.tile(np.arange(elements), frames)}
    table.update({name: np.tile(coordinates, frames) for name, coordinates in places.items()})
    table.update({name: values.ravel() for name, values in columns.items()})
    modes = pandas().Categorical.from_codes(modes.ravel(), categories=MODES)
    return pandas().DataFrame({**table, "mode": modes})


def joint_frame(self: JointResults) -> DataFrame:
    """All time series of the joint as a pandas frame, indexed by the time (s)."""
    return with_units(pandas().DataFrame(self.series).set_index("time"), self.units)


def joint_contact_frame(self: JointResults) -> DataFrame:
    """Snapshots of the joint as a tidy pandas frame: a row per frame and element.

    Columns: "time" (s), "element", "x" and "z", the middle of the element on the upper side at rest (m), "gap", "slip"
    (m), "pressure", "shear" (Pa), "mode".
    """
    left, right, bottom, top = self.elements.T
    places = {"x": 0.5 * (left + right), "z": 0.5 * (bottom + top)}
    return with_units(_contact_table(self.contact, places), _UNIT)


def joint_envelope_frame(self: JointResults) -> DataFrame:
    """`JointResults.envelope` as a pandas frame: a row per element."""
    return with_units(pandas().DataFrame(self.envelope).rename_axis("element"), _UNIT)


def motion_frame(self: Run, quantity: Literal["displacement", "velocity"] = "displacement") -> DataFrame:
    """The structure's "displacement" or "velocity" as a pandas frame, indexed by the time (s).

    ``quantity``: one of them, "displacement" by default. A column per degree of freedom (m and rad, or
    m/s and rad/s) of the snapshots in `Run.motion`, by its name in `Run.dof_names` or its
    number.
    """
    motion = self.motion
    if quantity not in ("displacement", "velocity"):
        raise InputError(f"quantity is '{quantity}', but must be 'displacement' or 'velocity'")
    index = pandas().Index(motion["time"], name="time")
    frame = pandas().DataFrame(motion[quantity], index=index, columns=self.dof_names)
    return with_units(frame, _UNIT, self)


def envelope_frame(self: Run) -> DataFrame:
    """`Run.envelope` as a pandas frame: a row per element."""
    frame = pandas().DataFrame(self.envelope)
    return with_units(frame.rename_axis("element"), _UNIT, self)


def foundation_frame(self: Run) -> DataFrame:
    """`Run.foundations` as a pandas frame: a row each, largest values with their signs.

    Columns are ends (m), the static normal force, residual slip, settlement (m) and rotation (rad), and the columns of
    `Run.series`: of a factor of safety the least value; in plan also the directions across: "torque" and others.
    """
    rows = []
    for foundation, peaks in zip(self.foundations, self._foundation_peaks):
        row: dict[str, float | None] = {"left": foundation.ends[0], "right": foundation.ends[1]}
        row.update(peaks, static_normal_force=foundation.static_normal_force)
        for name in ("residual_slip", "residual_settlement", "residual_rotation"):
            row[name] = getattr(foundation, name)
        if self.in_plan:
            row["front"], row["back"] = foundation.depth
            for name in ("residual_slip_across", "residual_rotation_across"):
                row[name] = getattr(foundation, name)
        rows.append(row)
    units = {**_UNIT, **self.units, "static_normal_force": self.units["normal_force"]}
    return with_units(pandas().DataFrame(rows, dtype=float).rename_axis("foundation"), units, self)


def energy_frame(self: Run) -> DataFrame:
    """`Run.energy_balances` as a pandas frame, indexed by the time (s), J/m, in plan J."""
    frame = pandas().DataFrame(self.energy_balances).set_index("time")
    return with_units(frame, self.units, self)


def floor_spectra(
    self: Run,
    periods: ArrayLike,
    damping: float = 0.05,
    *,
    probes: Sequence[str] | None = None,
) -> DataFrame:
    """Floor spectra as a pandas frame: total accelerations (m/s²), a column per probe.

    Args:
        periods: natural periods, array of shape (m,), s: the index of the frame.
        damping: damping ratio; 0.05 by default.
        probes: names of acceleration probes; all those with the unit "m/s²" unless given.
    """
    units = self.units
    names = [name for name in self.probes if units[name] == "m/s²"] if probes is None else probes
    columns = {name: self.floor_spectrum(name, periods, damping).acceleration for name in names}
    index = pandas().Index(np.asarray(periods, dtype=float), name="period")
    frame = pandas().DataFrame(columns, index=index)
    return with_units(frame, {"period": "s", **dict.fromkeys(names, "m/s²")}, self)


def _of(result: Any, index: str, columns: str) -> DataFrame:
    """A frame of arrays of an object, the first of which is its index."""
    values = {name: getattr(result, name) for name in columns.split()}
    frame = pandas().DataFrame(values, index=pandas().Index(getattr(result, index), name=index))
    return with_units(frame, _UNIT)


def equivalent_linear_frame(self: EquivalentLinear) -> DataFrame:
    """The layers of the site as a pandas frame, indexed by the depth of their tops (m)."""
    frame = _of(self, "depth", "shear_modulus modulus_ratio damping largest_strain effective_strain")
    frame["peak_acceleration"] = self.peak_acceleration[: len(self.depth)]
    return with_units(frame, _UNIT)


def spectrum_frame(self: Spectrum) -> DataFrame:
    """The spectrum as a pandas frame, indexed by the period (s)."""
    return _of(self, "period", "displacement pseudo_velocity pseudo_acceleration acceleration")


def impedance_frame(self: Impedances) -> DataFrame:
    """The impedances as a pandas frame of complex numbers, indexed by the frequency (Hz)."""
    return _of(self, "frequency", "horizontal vertical rocking coupling")


def kinematic_frame(self: KinematicMotions) -> DataFrame:
    """The motions as a pandas frame of complex numbers, indexed by the frequency (Hz)."""
    frame = _of(self, "frequency", "horizontal rotation vertical")
    return with_units(frame, {"frequency": "Hz", "rotation": "1/m"})


_BEAM_UNITS = {
    name: unit
    for unit, names in {
        "m": "x y z length fiber_y fiber_z",
        "m²": "area",
        "1/m": "curvature curvature_about_y",
        "rad/m": "twist_rate",
        "N": "axial_force shear shear_along_z",
        "N·m": "moment moment_about_y torque",
        "Pa": "stress",
    }.items()
    for name in names.split()
}


def beam_sections_frame(self: BeamSections) -> DataFrame:
    """The sections as a pandas frame: a row per section.

    Columns: "x", "y", "z" (m), "length" (m), "axial_strain", "curvature" (1/m), "axial_force" (N), "moment" (N·m) and "shear"
    (N); in space also "curvature_about_y", "moment_about_y", "shear_along_z", "twist_rate" (rad/m) and "torque".
    """
    names = ["length", "axial_strain", "curvature", "axial_force", "moment", "shear"]
    if self.position[:, 2].any() or self.twist_rate.any() or self.curvature_about_y.any():
        names += ["curvature_about_y", "moment_about_y", "shear_along_z", "twist_rate", "torque"]
    columns = {name: getattr(self, name) for name in names}
    table = {**dict(zip("xyz", self.position.T)), **columns}
    return with_units(pandas().DataFrame(table).rename_axis("section"), _BEAM_UNITS)


def fiber_frame(self: BeamSections) -> DataFrame:
    """The fibres of all sections as a tidy pandas frame: a row per section and fibre.

    Columns: "section", "fiber" (numbers from 0), "fiber_y", "fiber_z" (m), "area" (m²), "strain" and "stress" (Pa).
    """
    sections, fibers = self.fiber_strain.shape if len(self.length) else (0, 0)
    table: dict[str, Any] = {"section": np.repeat(np.arange(sections), fibers), "fiber": np.tile(np.arange(fibers), sections)}
    for axis, coordinates in zip("yz", self.fiber_position.reshape(-1, 2).T):
        table[f"fiber_{axis}"] = np.tile(coordinates, sections)
    table["area"] = np.tile(self.fiber_area, sections)
    table["strain"], table["stress"] = self.fiber_strain.ravel(), self.fiber_stress.ravel()
    return with_units(pandas().DataFrame(table), _BEAM_UNITS)
