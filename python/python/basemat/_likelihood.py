"""Mean and standard deviation of a normal variable by maximum likelihood, of values and of bounds on them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ._errors import Error
from ._normal import hazard, log_distribution

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MAX_ITERATIONS = 200
"""Newton's method with halved steps takes some ten on a concave function."""
_STEP_TOLERANCE = 1e-10
"""Change of the parameters, over their size, that ends the iteration."""
_MAX_HALVINGS = 60
"""More would be below the rounding of the parameters."""


class NormalFit(NamedTuple):
    """Moments with the largest likelihood, and the standard errors of both by the observed information."""

    mean: float
    deviation: float | None
    """None if the likelihood only rises as the probability falls with the value."""
    errors: tuple[float, float]


class _Data(NamedTuple):
    """Exact values, and bounds: a positive sign is for values below the point, a negative one for values above it."""

    values: NDArray[np.float64]
    points: NDArray[np.float64]
    signs: NDArray[np.float64]
    weights: NDArray[np.float64]


def fitted_normal(
    values: NDArray[np.float64],
    points: NDArray[np.float64],
    signs: NDArray[np.float64],
    weights: NDArray[np.float64],
) -> NormalFit:
    """Fit to ``values``, arrays of shape (n,), and to as many variables as ``weights`` below or above the ``points`` (m,).

    With g = mean/deviation and h = 1/deviation the logarithm of the likelihood,

        n ln h − ½ Σ (h yᵢ − g)² + Σ wⱼ ln Φ(sⱼ (h zⱼ − g)),

    is concave: Olsen, "Note on the uniqueness of the maximum likelihood estimator for the Tobit model", Econometrica 46
    (1978), 1211–1215. The data must determine a maximum.
    """
    everything = np.concatenate([values, points])
    center, size = float(everything.mean()), float(np.ptp(everything)) or 1.0
    data = _Data((values - center) / size, (points - center) / size, signs, weights)
    parameters = np.array([0.0, 2.0])
    for _ in range(_MAX_ITERATIONS):
        gradient, hessian = _derivatives(data, parameters)
        step = np.asarray(np.linalg.solve(hessian, -gradient), dtype=np.float64)
        parameters = _risen(data, parameters, step)
        if np.abs(step).max() <= _STEP_TOLERANCE * np.abs(parameters).max():
            break
    else:
        raise Error(f"no maximum of the likelihood was found in {_MAX_ITERATIONS} iterations")
    g, h = parameters.tolist()
    if h <= 0.0:
        return NormalFit(math.nan, None, (math.nan, math.nan))
    covariance = np.linalg.inv(-_derivatives(data, parameters)[1])
    mean_gradient, deviation_gradient = np.array([1.0 / h, -g / h**2]), np.array([0.0, -1.0 / h**2])
    variances = [float(direction @ covariance @ direction) for direction in (mean_gradient, deviation_gradient)]
    errors = size * math.sqrt(variances[0]), size * math.sqrt(variances[1])
    return NormalFit(center + size * g / h, size / h, errors)


def _log_likelihood(data: _Data, parameters: NDArray[np.float64]) -> float:
    """Logarithm of the likelihood; minus infinity where it is not defined."""
    g, h = parameters.tolist()
    if len(data.values) and h <= 0.0:
        return -math.inf
    exact = len(data.values) * math.log(h) if len(data.values) else 0.0
    bounded = data.weights @ log_distribution(data.signs * (h * data.points - g))
    return float(exact - 0.5 * np.sum((h * data.values - g) ** 2) + bounded)


def _derivatives(data: _Data, parameters: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """First (2,) and second (2, 2) derivatives of the logarithm of the likelihood by g and h."""
    g, h = parameters.tolist()
    count, residuals = len(data.values), h * data.values - g
    arguments = data.signs * (h * data.points - g)
    slopes = hazard(arguments)
    forces = data.weights * data.signs * slopes
    curvatures = data.weights * slopes * (slopes + arguments)
    by_h = count / h if count else 0.0
    gradient = np.array([residuals.sum() - forces.sum(), by_h - data.values @ residuals + forces @ data.points])
    mixed = data.values.sum() + curvatures @ data.points
    by_g2 = -count - curvatures.sum()
    by_h2 = -by_h / h - data.values @ data.values - curvatures @ data.points**2
    return gradient, np.array([[by_g2, mixed], [mixed, by_h2]])


def _risen(data: _Data, parameters: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
    """Parameters after the largest half, quarter, … of a step that does not lower the likelihood."""
    before = _log_likelihood(data, parameters)
    for _ in range(_MAX_HALVINGS):
        moved = parameters + step
        # Rounding of sums near the maximum.
        if _log_likelihood(data, moved) >= before - 1e-12 * abs(before):
            return moved
        step = 0.5 * step
    return parameters
