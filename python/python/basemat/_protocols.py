"""Parts that users write in Python, as protocols for type checkers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol

__all__ = [
    "Mode",
    "UserGround",
    "UserHysteresis",
    "UserLaw",
    "UserMaterial",
    "UserPlanLaw",
    "UserStructure",
    "UserUniaxialMaterial",
]

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._core import (
        BaseFaces,
        BaseNode,
        Condition,
        ContactState,
        Limits,
        Plan,
        PreviousContact,
        Strip,
        Tolerance,
        TrenchElements,
    )

Mode = Literal[
    "stick",
    "slip_left",
    "slip_right",
    "open",
    "yield",
    "yield_left",
    "yield_right",
    "slip",
    "yield_slip",
    "active",
    "active_left",
    "active_right",
]
"""A contact mode, one of `MODES`: the type of modes in laws of your own."""


class UserStructure(Protocol):
    """A structure of n dofs written in Python: ``dofs``, an int, and these methods.

    If it has them, these are called too: ``damping()`` (n × n), ``load(time)`` (shape (n,), N/m),
    ``active_damping`` and ``active_stiffness`` (flags: the matrix is taken as it is). In plan matrices and loads belong to
    the whole body (kg, N/m, N).

    A nonlinear structure has ``force(u)`` (shape (n,), N/m, beyond K u) and ``tangent(u)`` (n × n)
    of displacements u (shape (n,), m and rad), which change nothing, and if it has them
    ``energy(u)`` (stored and dissipated, J/m), ``commit(u)`` (accepts the end of a step),
    ``save()`` and ``restore(values)`` (internal variables, for checkpoints). Every simulation works
    on a deep copy of it.

    What they raise comes out of the run; the simulation stays at the last accepted step. Only
    ``commit`` is called after a step is accepted: its exception ends the run after the step.
    """

    def base(self) -> Sequence[BaseNode] | Sequence[Sequence[BaseNode]] | BaseFaces:
        """Nodes of the base, from left to right; a list of such lists for several foundations; `BaseFaces` in
        plan. A rigid base needs its two ends, `BaseNode.rigid_base`, or in plan its outline."""

    def mass(self) -> Any:
        """Mass matrix (n × n, dense or of ``scipy.sparse``, kg/m)."""

    def stiffness(self) -> Any:
        """Stiffness matrix (n × n, dense or of ``scipy.sparse``, N/m per metre)."""


class UserGround(Protocol):
    """A ground written in Python, of Q contact elements: ``elements`` and these methods.

    Displacements of the elements at the end of a step are the step compliance times the tractions of this step, which are
    constant over it, plus the effect of all earlier tractions. Both are changes from the static state.

    The traction τ of a step is the traction in its middle. A part that is elastic at once, a spring of stiffness k, therefore
    has the mean displacement (s₀ + s₁)/2 = τ/k, and at the end of the step s₁ = 2 τ/k − s₀: its step compliance is 2/k,
    twice the static one, and ``advance`` returns −s₁ for it. With s₁ = τ/k every step would dissipate energy, and the run
    would converge at first order; a run warns of it. `SpringDashpots` has springs and dashpots in this form. Parts that only
    rates displace (dashpots, waves, creep) have the exact displacement under a constant traction.

    Contact vectors have 2Q numbers: down (pressure is positive in compression) for each element, then to the right; with
    walls the normal into the soil, then along the outline. In plan they have 3Q: down, along x, along y. Numbers are means
    over the elements.

    If it has them, these count too: ``save()`` (internal variables, an array of shape (n,)) and ``restore(values)``, both
    for checkpoints and for runs beyond the expected steps; ``shear_wave_speed`` (m/s), for warnings of coarse steps and elements.

    Every simulation works on a deep copy, which `Simulation.ground` returns. Exceptions of the methods come out of the
    run. ``advance`` is called after the step is accepted: its exception ends the run after that step, and further steps
    are refused until an earlier checkpoint is resumed.
    """

    @property
    def elements(self) -> Strip | Sequence[Strip] | Plan | TrenchElements:
        """The contact elements, from left to right; of a trench along the outline."""

    def static_compliance(self) -> Any:
        """Displacements at rest by unit tractions: array of shape (2Q, 2Q), m/Pa. A rigid settlement may be added to all."""

    def step_compliance(self, time_step: float) -> Any:
        """Displacements at the end of a step of ``time_step`` seconds by unit tractions: array of shape (2Q, 2Q), m/Pa.

        It also clears all earlier tractions: called before the first step, and before ``restore`` if a run goes on. Before
        the first step of a ground without ``shear_wave_speed`` it is also tried with a step 64 times shorter, once
        followed by ``advance``, to find parts of first order; an exception of this trial does not matter.
        """

    def advance(self, traction: NDArray[np.float64]) -> Any:
        """Displacements at the end of the next step by all tractions so far: array of shape (2Q,), m.

        ``traction`` (shape (2Q,), Pa) acted during the step that has ended. Called once after every accepted step.
        """


class UserLaw(Protocol):
    """A law between base and ground in the plane written in Python, by the conditions of each contact mode.

    Most laws need only limits: `UserPlanLaw`. This form is for laws that no limits describe, such as a slip that its speed
    resists. The law stores nothing itself. If it has them, these count too: ``compliance(mode, start)`` (normal and tangential, m/Pa),
    ``state_variables`` (count of the numbers that it remembers of each element),
    ``initial_state_variables(start)`` and ``commit(start, end, mode)`` (which return them),
    ``friction_coefficient`` (for the factor of safety: of a friction that varies the smallest, since with a larger one a
    base slides at a factor above 1), ``check(gravity, time_step)`` (may refuse).
    On a ground in plan it needs the ``limits`` of a `UserPlanLaw`.

    What they raise comes out of the run; the simulation stays at the last accepted step.
    """

    @property
    def modes(self) -> Sequence[str]:
        """The modes that it uses, of `basemat.MODES`; the first is the mode of an element at rest."""

    def conditions(self, mode: Mode, start: PreviousContact) -> Sequence[Condition]:
        """The two conditions that ``mode`` imposes on the end of the step."""

    def next_mode(
        self, mode: Mode, start: PreviousContact, trial: ContactState, tolerance: Tolerance
    ) -> str:
        """The mode to try next, after the ``trial`` with the conditions of ``mode``; ``mode`` itself if the trial is admissible."""


class UserPlanLaw(Protocol):
    """A law between base and ground written in Python, by the limits of the tractions: for any ground, in the plane and in plan.

    In plan slip is along the shear traction. In the plane contact modes and their conditions follow from the limits, unless
    the law is a `UserLaw` too. If it has them, ``state_variables``, ``initial_state_variables``, ``commit``, ``compliance``
    (of the mode "stick"), ``friction_coefficient`` and ``check`` count as for a `UserLaw`.
    """

    def limits(self, start: PreviousContact) -> Limits:
        """Limits of an element's tractions in the step after ``start``; in plan called once per attempted step. While the weight
        comes on without friction, all but friction, attraction and shear strength hold."""


class UserHysteresis(Protocol):
    """A spring with a memory written in Python: for storeys and isolators of a `ShearBuilding`
    and for `WithSprings`.

    It is led straight from the deformation of the last committed step to any other, as often as
    Newton's method wants; only ``commit(deformation)``, called if it is there, accepts one and
    changes internal variables. If it has them, these are called too: ``tangent(deformation)`` (slope of
    the force, N/m per metre; otherwise by differences of ``force``, two more calls),
    ``energy(deformation)`` (stored, and dissipated until then, J/m; otherwise it is taken to unload
    with its first stiffness, and to store all work if it has no ``commit``), ``save()`` and ``restore(values)`` (internal variables, always as many, for checkpoints).

    Every simulation works on a deep copy; `Simulation.hysteresis` gives it back with its
    internal variables. What it raises comes out of the run, as for a `UserStructure`.
    """

    def force(self, deformation: float) -> float:
        """Force at a ``deformation`` (m), N/m, positive against a positive one; changes nothing."""


class UserMaterial(Protocol):
    """A material of solids in plane strain written in Python: for quadrilaterals of a `Mesh`.

    Strains and stresses are arrays of shape (4,) of xx, yy, zz and xy; tension is positive, and the shear strain is the
    engineering strain. The material stores nothing itself: the element stores ``variables``, an array of shape (n,) with the
    internal variables of a point at the end of the last step. Methods belong to the straight path from the strain of that
    step to ``strain``, and may be called for any strain, as often as Newton's method needs. Arrays are copies.

    If it has them, these count too: ``variable_count`` (n; 0 unless given, an int),
    ``initialize(initial_stress)`` (variables at zero strain under a stress; otherwise zeros, and there is no initial stress),
    ``commit(strain, variables)`` (variables after a step that ended with ``strain``),
    ``state(strain, variables)`` (plastic shear strain and mobilised strength, for `Simulation.solid_points`; otherwise zeros) and
    ``symmetric_tangent`` (False if the tangent is not always symmetric). ``density`` and ``elasticity()`` are read once, when an
    element is added. The mid-step remainder of the energy balance is the definition by ``stress`` and ``energy``: the residual
    of the balance does not check them.

    What they raise comes out of the run; the simulation stays at the last accepted step. Only ``commit`` is called after a
    step is accepted: its exception ends the run after the step. Arrays of other shapes, and numbers that are not finite, are
    errors that name the method.

    A call takes about 4 µs beside the method itself, or 9 µs if the method returns a list in place of an array of numpy; a
    material of the package takes less than 1 µs in all. Each iteration of Newton's method calls ``stress`` and ``tangent`` at
    every integration point. `stress_path` tries a material without a mesh.
    """

    @property
    def density(self) -> float:
        """Density, kg/m³; 0 is allowed."""

    def elasticity(self) -> ArrayLike:
        """Elasticity matrix of small strains: array of shape (4, 4), Pa."""

    def stress(self, strain: NDArray[np.float64], variables: NDArray[np.float64]) -> ArrayLike:
        """Stress at a ``strain``: array of shape (4,), Pa."""

    def tangent(self, strain: NDArray[np.float64], variables: NDArray[np.float64]) -> ArrayLike:
        """Derivatives of the stresses (rows) by the strains (columns): array of shape (4, 4), Pa."""

    def energy(self, strain: NDArray[np.float64], variables: NDArray[np.float64]) -> Sequence[float]:
        """Stored energy, and energy dissipated since the start, J/m³."""


class UserUniaxialMaterial(Protocol):
    """A law of fibres written in Python: for a `FiberSection`.

    Strains and stresses are along the bar, tension positive. The law stores nothing itself: the element stores ``variables``, an
    array of shape (n,) with the internal variables of a fibre at the end of the last step. Methods belong to the straight path
    from the strain of that step to ``strain``, and may be called for any strain. Arrays are copies.

    If it has them, these count too: ``variable_count`` (n; 0 unless given, an int), ``initialize()`` (variables of a fibre without
    strain; otherwise zeros) and ``commit(strain, variables)`` (variables after a step that ended with ``strain``). ``modulus`` and
    ``initialize()`` are read once, when a section gets the fibre.

    What they raise comes out of the run; the simulation stays at the last accepted step. Only ``commit`` is called after a
    step is accepted: its exception ends the run after the step. Other numbers of values, and numbers that are not finite, are
    errors that name the method. `fiber_stress_path` tries a law without a mesh.
    """

    @property
    def modulus(self) -> float:
        """Modulus of small strains, Pa."""

    def response(self, strain: float, variables: NDArray[np.float64]) -> Sequence[float]:
        """Stress, and its derivative with respect to the strain, Pa."""

    def energy(self, strain: float, variables: NDArray[np.float64]) -> Sequence[float]:
        """Stored energy, and energy dissipated since the start, J/m³."""
