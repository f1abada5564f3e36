"""A circular plate on a half-space without friction: settlements of its middle and edge, and radial moments.

Ritz solution: the plate (Kirchhoff's theory) moves by Legendre polynomials P_2k of √(1 − r²), which are polynomials of r².
Pressures P_2k/√(1 − r²) cause displacements of the same shape (Popov), so that the soil is exact. Radius 1, G = 1, load 1.
Python with numpy: python disc_on_half_space.py
"""

import math

import numpy as np
from numpy.polynomial import legendre, polynomial

COUNT, POISSON, SOIL_POISSON = 12, 0.2, 1 / 3


def in_squares(k):
    """P_2k as a polynomial of r²."""
    terms = legendre.leg2poly(np.eye(2 * k + 1)[2 * k])[::2]
    whole = np.zeros(1)
    for j, term in enumerate(terms):
        whole = polynomial.polyadd(whole, term * polynomial.polypow([1, -1], j))
    return whole


SHAPES = [in_squares(k) for k in range(COUNT)]


def values(r):
    return np.array([polynomial.polyval(r * r, own) for own in SHAPES])


def curvatures(r):
    """w″ and w′/r."""
    first, second = [np.array([polynomial.polyval(r * r, polynomial.polyder(own, k)) for own in SHAPES]) for k in (1, 2)]
    return 2 * first + 4 * r * r * second, 2 * first


def stiffness(rigidity):
    points, weights = legendre.leggauss(2 * COUNT + 6)
    r = 0.5 * (points + 1)
    radial, around = curvatures(r)
    area = np.pi * r * weights
    plate = (radial * area) @ radial.T + (around * area) @ around.T
    plate += POISSON * ((radial * area) @ around.T + (around * area) @ radial.T)
    compliances = [(1 - SOIL_POISSON) / (2 * np.pi) * (np.pi * math.comb(2 * k, k) / 4**k) ** 2 for k in range(COUNT)]
    soil = [2 * np.pi / (4 * k + 1) / own for k, own in enumerate(compliances)]
    return rigidity * plate + np.diag(soil)


if __name__ == "__main__":
    for rigidity in [0.006, 0.02, 0.06, 0.2]:
        own = np.linalg.solve(stiffness(rigidity), values(1.0))
        radial, around = curvatures(np.array([0.0, 0.25, 0.5, 0.75, 0.9]))
        moments = -rigidity * (own @ radial + POISSON * (own @ around))
        print(f"D {rigidity:g}, load on the edge: middle {own @ values(0.0):.5f}, edge {own @ values(1.0):.5f}, moments {moments}")
