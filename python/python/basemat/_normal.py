"""The normal distribution and its logarithm, without SciPy."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TAIL = -25.0
"""Below this the distribution is by its asymptotic series, as ``erfc`` loses digits and then vanishes."""
_SERIES_TERMS = 8
"""Terms of the series; at -25 the ninth is 1e-17 of the first."""


def distribution(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Probability of a standard normal variable below ``x``: array of the same shape."""
    flat = [0.5 * math.erfc(-value / math.sqrt(2.0)) for value in np.ravel(x).tolist()]
    return np.array(flat).reshape(np.shape(x))


def log_distribution(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithm of the distribution, exact to rounding in both tails: array of shape (n,)."""
    return np.array([_log_distribution(value) for value in x.tolist()])


def hazard(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Density over distribution, the derivative of `log_distribution`: array of shape (n,)."""
    return np.exp(-0.5 * x**2 - 0.5 * math.log(2.0 * math.pi) - log_distribution(x))


def _log_distribution(x: float) -> float:
    """Logarithm of the distribution at one place."""
    if x > 0.0:
        return math.log1p(-0.5 * math.erfc(x / math.sqrt(2.0)))
    if x > _TAIL:
        return math.log(0.5 * math.erfc(-x / math.sqrt(2.0)))
    # Φ(x) = φ(x)/|x| (1 − 1/x² + 3/x⁴ − …): Abramowitz and Stegun, equation 26.2.12.
    term, series = 1.0, 1.0
    for number in range(1, _SERIES_TERMS + 1):
        term *= -(2 * number - 1) / (x * x)
        series += term
    return -0.5 * x * x - 0.5 * math.log(2.0 * math.pi) - math.log(-x) + math.log(series)
