"""Earthquake response of structures that uplift and slide on elastic ground.

Units are SI, per metre of thickness; x points to the right, y up, rotations and moments are
counter-clockwise; pressure is positive in compression, shear is what the structure exerts on the
soil. ``python -m basemat`` says what there is; the README of the package has a first program.
"""

from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import _animation, _exchange, _frames, _meshes, _pickling as _pickling, _plots, _push_over, _report, _shapes, _shell_moments, _walls
from ._beds import SpringDashpots as SpringDashpots
from ._core import *
from ._core import __version__ as __version__
from ._errors import *
from ._files import load as load, save as _save
from ._fragility import Fragility as Fragility, fragility as fragility, plot_demands as plot_demands
from ._intensities import (
    incremental_dynamic_analysis as incremental_dynamic_analysis,
    multiple_stripes as multiple_stripes,
)
from ._plots import plot_stress_strain as plot_stress_strain
from ._protocols import *
from ._sweep import merge as merge, sweep as sweep

for _class, _name, _method in (
    (Run, "to_frame", _frames.to_frame),
    (Run, "contact_frame", _frames.contact_frame),
    (Run, "motion_frame", _frames.motion_frame),
    (Run, "envelope_frame", _frames.envelope_frame),
    (Run, "foundation_frame", _frames.foundation_frame),
    (Run, "energy_frame", _frames.energy_frame),
    (Run, "floor_spectra", _frames.floor_spectra),
    (Run, "plot", _plots.plot_run),
    (Run, "plot_modes", _plots.plot_modes),
    (Run, "plot_contact_plan", _plots.plot_contact_plan),
    (Run, "plot_moment_rotation", _plots.plot_moment_rotation),
    (Run, "plot_settlement_rotation", _plots.plot_settlement_rotation),
    (Run, "plot_wall_pressures", _walls.plot_wall_pressures),
    (Run, "animate", _animation.animate),
    (Run, "report", _report.report),
    (Run, "save", _save),
    (Run, "to_xarray", _exchange.to_xarray),
    (DeformedShape, "to_pyvista", _exchange.shape_to_pyvista),
    (Mesh, "to_pyvista", _exchange.mesh_to_pyvista),
    (JointResults, "to_frame", _frames.joint_frame),
    (JointResults, "contact_frame", _frames.joint_contact_frame),
    (JointResults, "envelope_frame", _frames.joint_envelope_frame),
    (BeamSections, "to_frame", _frames.beam_sections_frame),
    (BeamSections, "fiber_frame", _frames.fiber_frame),
    (Spectrum, "to_frame", _frames.spectrum_frame),
    (Spectrum, "plot", _plots.plot_spectrum),
    (SoilProfile, "plot", _plots.plot_profile),
    (EquivalentLinear, "to_frame", _frames.equivalent_linear_frame),
    (Impedances, "to_frame", _frames.impedance_frame),
    (Impedances, "plot", _plots.plot_impedances),
    (KinematicMotions, "to_frame", _frames.kinematic_frame),
    (PushOver, "plot", _push_over.plot_push_over),
    (PushOver, "to_frame", _push_over.push_over_frame),
    (DeformedShape, "plot", _shapes.plot_shape),
    (FemModel, "plot_shell_moments", _shell_moments.plot_shell_moments),
    (Mesh, "plot_shells", _shapes.plot_shells),
    (Mesh, "plot_solids", _shapes.plot_solids),
):
    _method.__name__, _method.__qualname__ = _name, f"{_class.__name__}.{_name}"
    setattr(_class, _name, _method)

_meshes.from_arrays.__qualname__ = "Mesh.from_arrays"
setattr(Mesh, "from_arrays", staticmethod(_meshes.from_arrays))

# Classes, functions and constants; neither modules nor what begins with an underscore.
__all__ = sorted(
    name
    for name, value in globals().items()
    if not name.startswith("_") and not hasattr(value, "__path__") and not hasattr(value, "__spec__")
)

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        # Programs of 0.2.0 define bases by this name.
        if name == "ContactNode":
            import warnings

            warnings.warn("ContactNode is called BaseNode", DeprecationWarning, stacklevel=2)
            return BaseNode
        raise AttributeError(f"module 'basemat' has no attribute '{name}'")
