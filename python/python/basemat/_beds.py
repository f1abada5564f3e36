"""Springs and dashpots as parts of a ground written in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class SpringDashpots:
    """Springs parallel to dashpots, one pair for each number of a contact vector: a part of a `UserGround`, or all of it
    once it has ``elements``.

    Per unit of area, traction = stiffness · s + dashpot · ds/dt. The traction of a step is that of its middle, where the
    springs have the mean of both displacements: without dashpots s₁ = 2 τ/k − s₀. Energy of the springs returns.

    Args:
        stiffness: array of shape (2Q,) for Q elements, in plan (3Q,), Pa/m.
        dashpots: array of the same shape, Pa s/m; none unless given.
    """

    def __init__(self, stiffness: ArrayLike, dashpots: ArrayLike | None = None) -> None:
        self.stiffness: NDArray[np.float64] = np.array(stiffness, dtype=float)
        self.dashpots: NDArray[np.float64] = np.zeros_like(self.stiffness)
        if dashpots is not None:
            self.dashpots = np.array(dashpots, dtype=float)
        if self.stiffness.ndim != 1 or self.dashpots.shape != self.stiffness.shape:
            shapes = f"{self.stiffness.shape} and {self.dashpots.shape}"
            raise ValueError(f"stiffness and dashpots of shapes {shapes}, but both must be of shape (n,)")
        if not (np.all(np.isfinite(self.stiffness)) and np.all(self.stiffness > 0.0)):
            raise ValueError(f"stiffness {self.stiffness.min()}, but all must be finite and above zero")
        if not (np.all(np.isfinite(self.dashpots)) and np.all(self.dashpots >= 0.0)):
            raise ValueError(f"dashpots {self.dashpots.min()}, but all must be finite and not below zero")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self.stiffness)} springs and dashpots)"

    def static_compliance(self) -> NDArray[np.float64]:
        """Displacements at rest by unit tractions: a diagonal array of shape (2Q, 2Q), m/Pa."""
        return np.diag(1.0 / self.stiffness)

    def step_compliance(self, time_step: float) -> NDArray[np.float64]:
        """Displacements at the end of a step of ``time_step`` seconds by unit tractions: a diagonal array of shape (2Q, 2Q),
        m/Pa. Clears all earlier tractions.
        """
        self.impedance = 0.5 * self.stiffness + self.dashpots / time_step
        self.displacement = np.zeros_like(self.stiffness)
        return np.diag(1.0 / self.impedance)

    def past(self) -> NDArray[np.float64]:
        """Displacements at the end of the next step by all tractions so far: array of shape (2Q,), m."""
        return (self.impedance - self.stiffness) / self.impedance * self.displacement

    def advance(self, traction: NDArray[np.float64]) -> NDArray[np.float64]:
        """Accepts the ``traction`` (shape (2Q,), Pa) of a step, and returns `past`."""
        self.displacement = self.past() + traction / self.impedance
        return self.past()

    def save(self) -> NDArray[np.float64]:
        """Displacements at the end of the last step: array of shape (2Q,), m."""
        return self.displacement

    def restore(self, values: NDArray[np.float64]) -> None:
        """Goes on from ``values`` that `save` returned."""
        self.displacement = values
