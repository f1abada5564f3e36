"""Earthquake response of structures that uplift and slide on elastic ground.

Units are SI, per metre of thickness; x points to the right, y up, rotations and moments are
counter-clockwise; pressure is positive in compression, shear is what the structure exerts on the
soil. See the README of the package for a first program.
"""

from __future__ import annotations

from ._core import (
    MODES,
    STANDARD_GRAVITY,
    Adhesive,
    Bonded,
    Checkpoint,
    ContactNode,
    Coulomb,
    Extremes,
    FoundationState,
    FoundationSummary,
    FreeField,
    Ground,
    HalfPlaneGround,
    InterfaceLaw,
    Ledger,
    Load,
    MatrixModel,
    Peak,
    Probe,
    Record,
    RigidBlock,
    Row,
    Run,
    SectionRows,
    ServiceCheck,
    SharedKernels,
    ShearBuilding,
    Simulation,
    Soil,
    Spectrum,
    SpringGround,
    State,
    Steps,
    StepStart,
    Storey,
    Strip,
    Structure,
    ThinLayer,
    TimeScheme,
    VariableFriction,
    Yielding,
    el_centro_1940,
    log_spaced,
)
from ._errors import CheckpointError, Error, FileError, InputError, StepError
from ._sweep import sweep

__all__ = [name for name in dir() if not name.startswith("_") and name != "annotations"]
