"""A square plate on a half-space without friction: settlements and moments, and their errors on equal cells.

Ritz solution: the plate (Kirchhoff's theory) moves by Legendre polynomials, the soil receives means over cells and has
constant pressures on them (Galerkin). The reference stands on cells graded towards the edges. Sides 1, G = 1, load 1.
Python with numpy: python plate_on_half_space.py
"""

import numpy as np
from numpy.polynomial import legendre

DEGREE, POISSON, SOIL_POISSON = 24, 0.2, 1 / 3
COUNT = DEGREE // 2 + 1


def potential(x, y):
    """Four-fold integral of 1/r, twice over x and twice over y."""
    x, y = np.abs(x), np.abs(y)
    terms = 0.5 * x * x * y * np.arcsinh(y / np.where(x > 0, x, np.inf))
    return terms + 0.5 * x * y * y * np.arcsinh(x / np.where(y > 0, y, np.inf)) - np.hypot(x, y) ** 3 / 6


def soil_stiffness(ends):
    """Forces on the cells of a quarter by their mean displacements, for all four quarters."""
    half = (len(ends) - 1) // 2
    distances = ends[half:, None] - ends[None, :]
    matrix = np.zeros((half * half, half * half))
    for i in range(half):
        part = potential(distances[i : i + 2, :, None, None], distances[None, None])
        part = part[1] - part[0]
        part = part[:-1] - part[1:]
        part = part[:, 1:] - part[:, :-1]
        part = part[:, :, :-1] - part[:, :, 1:]
        part = part[half:] + part[:half][::-1]
        part = part[:, :, half:] + part[:, :, :half][:, :, ::-1]
        matrix[i * half : (i + 1) * half] = part.transpose(1, 0, 2).reshape(half, -1)
    areas = np.outer(*[np.diff(ends[half:])] * 2).ravel()
    compliance = matrix * (1 - SOIL_POISSON) / (2 * np.pi) / areas[:, None]
    stiffness = 4 * areas[:, None] * np.linalg.inv(compliance)
    return 0.5 * (stiffness + stiffness.T)


def shape(k):
    return np.eye(DEGREE + 1)[2 * k]


def values(x, times=0):
    """Values of the even polynomials, or of their derivatives, at points of [-0.5, 0.5]."""
    return np.array([legendre.legval(2 * np.asarray(x), legendre.legder(shape(k), times)) * 2**times for k in range(COUNT)])


def means(ends):
    sums = np.array([legendre.legval(2 * ends, legendre.legint(shape(k))) / 2 for k in range(COUNT)])
    return (np.diff(sums) / np.diff(ends)).T


def plate_stiffness():
    points, weights = legendre.leggauss(DEGREE + 2)
    at = [values(points / 2, times) for times in range(3)]
    product = lambda i, j: (at[i] * weights / 2) @ at[j].T
    mixed = product(0, 2)
    bending = np.kron(product(2, 2), product(0, 0)) + np.kron(product(0, 0), product(2, 2))
    both = np.kron(mixed.T, mixed) + np.kron(mixed, mixed.T)
    return bending + POISSON * both + 2 * (1 - POISSON) * np.kron(product(1, 1), product(1, 1))


def square(half):
    return np.kron(*[means(np.array([-half, half]))[0]] * 2)


def loads():
    even, edge = means(np.array([-0.5, 0.5]))[0], values(0.5)
    walls = (0.64 * square(0.4) - 0.49 * square(0.35)) / 0.15
    strip = (square(0.5) - 0.81 * square(0.45)) / 0.19
    line = 0.5 * (np.kron(even, edge) + np.kron(edge, even))
    return {"strip at the edges": strip, "walls": walls, "even": square(0.5), "edges": line, "middle": square(1 / 16)}


def solve(ends, rigidity):
    """Settlements of middle, side and corner, and moments m_x in (0, 0), m_y in (1/2, 0), m_x in (1/4, 1/4)."""
    rows = means(ends[(len(ends) - 1) // 2 :])
    rows = np.kron(rows, rows)
    matrix = rigidity * plate_stiffness() + rows.T @ soil_stiffness(ends) @ rows
    for name, load in loads().items():
        own = np.linalg.solve(matrix, load)
        at = lambda x, y, i=0, j=0: np.kron(values(x, i), values(y, j)) @ own
        moment = lambda x, y: -rigidity * (at(x, y, 2, 0) + POISSON * at(x, y, 0, 2))
        yield name, np.array([at(0, 0), at(0.5, 0), at(0.5, 0.5), moment(0, 0), moment(0, 0.5), moment(0.25, 0.25)])


def errors(found, exact):
    settlements, moments = np.abs(found - exact).reshape(2, 3)
    return settlements.max() / np.abs(exact[:3]).max(), moments.max() / np.abs(exact[3:]).max()


if __name__ == "__main__":
    graded = 0.5 * np.sin(0.5 * np.pi * np.linspace(-1, 1, 57))
    for rigidity in [1e-4, 1e-3, 1e-2, 2.5e-2, 1e-1]:
        exact = dict(solve(graded, rigidity))
        for name, own in exact.items():
            print(f"D {rigidity:g}, {name}: {own}")
        for cells in (8, 16):
            x = cells * rigidity ** (1 / 3)
            for overhang in (0.015 * round(7 * x * x / (1 + x * x)), 0.0):
                ends = (np.arange(cells + 1) - cells / 2) / (cells - 2 * overhang)
                for name, own in solve(ends, rigidity):
                    percents = [f"{100 * error:.1f}" for error in errors(own, exact[name])]
                    print(f"D {rigidity:g}, {cells} cells, x {x:.1f}, overhang {overhang:.3f}, {name}: {'; '.join(percents)} %")
