"""A circular plate on a half-space without friction: settlements of its middle and edge, radial moments, and stiffness;
moment over rotation of a plate that rocks under a rigid wall on its edge.

Ritz solution: the plate (Kirchhoff's theory) moves by Legendre polynomials P_2k of √(1 − r²), which are polynomials of r².
Pressures P_2k/√(1 − r²) cause displacements of the same shape (Popov), so that the soil is exact. Radius 1, G = 1, load 1.
Plates that rock move by derivatives P′_2k+1 of √(1 − r²), times r cos θ.
Limits that it keeps: 4/(1 − ν) of a rigid disc, 8/(3(1 − ν)) as it rocks, π/(1 − ν) of a flexible one under an even load, in
the middle, and Hogg's infinite plate under a force, 3√3 D/l² with l³ = D(1 − ν). Python with numpy: python disc_on_half_space.py
"""

import math

import numpy as np
from numpy.polynomial import legendre

COUNT, POISSON, SOIL_POISSON = 120, 0.2, 1 / 3


def jacobi(n, a, b, x):
    before, own = np.ones_like(x), 0.5 * (a - b + (a + b + 2) * x)
    if n < 0:
        return 0 * x
    if n == 0:
        return before
    for k in range(2, n + 1):
        c = 2 * k + a + b
        after = (c - 1) * (c * (c - 2) * x + a * a - b * b) * own - 2 * (k + a - 1) * (k + b - 1) * c * before
        before, own = own, after / (2 * k * (k + a + b) * (c - 2))
    return own


def shapes(r, order=0):
    """P_2k of √(1 − r²), Jacobi's polynomials of 1 − 2r², or a derivative with respect to r²."""
    x = 1 - 2 * np.asarray(r, float) ** 2
    factor = lambda k: (-1) ** order * math.prod(k + 0.5 + j for j in range(order))
    return np.array([factor(k) * jacobi(k - order, order, order - 0.5, x) if k >= order else 0 * x for k in range(COUNT)])


def curvatures(r):
    """w″ and w′/r."""
    first, second = shapes(r, 1), shapes(r, 2)
    return 2 * first + 4 * r * r * second, 2 * first


# Points of Gauss's rule in r²; each has its part of the even load.
points, weights = legendre.leggauss(2 * COUNT + 6)
RADII, PARTS = np.sqrt(0.5 * (points + 1)), 0.5 * weights


def stiffness(rigidity):
    radial, around = curvatures(RADII)
    area = np.pi * PARTS
    plate = (radial * area) @ radial.T + (around * area) @ around.T
    plate += POISSON * ((radial * area) @ around.T + (around * area) @ radial.T)
    # π C(2k, k)/4^k, without large numbers.
    waves = np.pi * np.cumprod([1.0, *((2 * k - 1) / (2 * k) for k in range(1, COUNT))])
    soil = [2 * np.pi / (4 * k + 1) / ((1 - SOIL_POISSON) / (2 * np.pi) * own**2) for k, own in enumerate(waves)]
    return rigidity * plate + np.diag(soil)


def antisymmetric(r, order=0):
    """P′_2k+1 of √(1 − r²), or a derivative with respect to r²."""
    x = 1 - 2 * np.asarray(r, float) ** 2
    factor = lambda k: (2 * k + 1) * (-1) ** order * math.prod(k + 1.5 + j for j in range(order))
    return np.array([factor(k) * jacobi(k - order, order + 1, order - 0.5, x) for k in range(COUNT)])


def rocking(rigidity):
    """The edge moves and turns as the wall does: moment over rotation, by Lagrange's multipliers."""
    first, second = antisymmetric(RADII, 1), antisymmetric(RADII, 2)
    radial, around = 6 * RADII * first + 4 * RADII**3 * second, 2 * RADII * first
    area = 0.5 * np.pi * PARTS
    plate = (radial * area) @ radial.T + (3 - 2 * POISSON) * (around * area) @ around.T
    plate += POISSON * ((radial * area) @ around.T + (around * area) @ radial.T)
    degrees = 2 * np.arange(COUNT) + 1
    gamma = lambda n: math.lgamma(n / 2)
    moved = [0.5 * (1 - SOIL_POISSON) * math.exp(gamma(n + 2) + gamma(n) - gamma(n + 3) - gamma(n + 1)) for n in degrees]
    soil = np.pi * degrees * (degrees + 1) / (2 * degrees + 1) / np.array(moved)
    edge = antisymmetric(1.0)
    held = np.array([edge, edge + 2 * antisymmetric(1.0, 1)])
    compliance = held @ np.linalg.solve(rigidity * plate + np.diag(soil), held.T)
    return np.linalg.solve(compliance, np.ones(2)).sum()


if __name__ == "__main__":
    for rigidity in [0.002, 0.006, 0.02, 0.06, 0.2, 1, 1e6]:
        print(f"D {rigidity:g}, rocks under a rigid wall: {rocking(rigidity):.5f}")
    middle, edge, even = shapes(0.0), shapes(1.0), shapes(RADII) @ PARTS
    for rigidity in [0.006, 0.02, 0.06, 0.2]:
        own = np.linalg.solve(stiffness(rigidity), edge)
        radial, around = curvatures(np.array([0.0, 0.25, 0.5, 0.75, 0.9]))
        moments = -rigidity * (own @ radial + POISSON * (own @ around))
        print(f"D {rigidity:g}, load on the edge: middle {own @ middle:.5f}, edge {own @ edge:.5f}, moments {moments}")
    for rigidity in [1e-6, 0.002, 0.006, 0.02, 0.06, 0.2, 2, 1e6]:
        found = [1 / (np.linalg.solve(stiffness(rigidity), load) @ middle) for load in (even, middle)]
        hogg = 3 * math.sqrt(3) * rigidity / (rigidity * (1 - SOIL_POISSON)) ** (2 / 3)
        print(f"D {rigidity:g}: even load {found[0]:.4f}, force in the middle {found[1]:.4f}, infinite plate {hogg:.4f}")
