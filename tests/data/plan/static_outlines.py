"""Static stiffness of rigid mats without friction on a half-space: vertical and rocking, times (1 - nu)/G.

Galerkin sums over triangles that fit the outline. The potential of a triangle is exact, its mean over another one is
Gauss's rule of twelve points; three meshes are extrapolated. Python with numpy: python static_outlines.py
"""

import itertools

import numpy as np

ORBITS = [(0.501426509658179, 0.249286745170910, 0.116786275726379), (0.873821971016996, 0.063089014491502, 0.050844906370207)]
LAST = (0.053145049844817, 0.310352451033784, 0.636502499121399)
POINTS = [(p, w) for a, b, w in ORBITS for p in ((a, b, b), (b, a, b), (b, b, a))]
POINTS += [(p, 0.082851075618374) for p in itertools.permutations(LAST)]


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def divided(triangle, m):
    a, b, c = np.array(triangle, float)
    at = lambda i, j: a + (b - a) * i / m + (c - a) * j / m
    for i in range(m):
        for j in range(m - i):
            yield at(i, j), at(i + 1, j), at(i, j + 1)
            if i + j < m - 1:
                yield at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)


def stiffness(triangles, m):
    t = np.array([small for triangle in triangles for small in divided(triangle, m)])
    turned = cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    t[turned < 0] = t[turned < 0][:, [0, 2, 1]]
    compliance = np.zeros((len(t), len(t)))
    for point, weight in POINTS:
        x = np.einsum("k,nkd->nd", point, t)
        for k in range(3):
            a, b = t[:, k], t[:, (k + 1) % 3]
            length = np.hypot(*(b - a).T)
            along = (b - a) / length[:, None]
            r = a - x[:, None]
            d, u = cross(r, along), np.einsum("ijk,jk->ij", r, along)
            near = np.maximum(abs(d), 1e-300)
            compliance += weight * d * (np.arcsinh((u + length) / near) - np.arcsinh(u / near))
    compliance /= 0.5 * abs(turned)
    compliance = (compliance + compliance.T) / (4.0 * np.pi)
    motions = np.column_stack([np.ones(len(t)), t.mean(1)[:, 1]])
    return np.diag(motions.T @ np.linalg.solve(compliance, motions))


def polygon(n):
    corners = [(np.cos(2 * np.pi * k / n), np.sin(2 * np.pi * k / n)) for k in range(n)]
    return [((0, 0), corners[k - 1], corners[k]) for k in range(n)]


def rectangle(x, y):
    p, q, r, s = (x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])
    return [(p, q, r), (p, r, s)]


ELL = rectangle((-1, 0.1), (-1, 0)) + rectangle((0.1, 1), (-1, 0)) + rectangle((-1, 0.1), (0, 1))
SHAPES = {"square": rectangle((-1, 1), (-1, 1)), "hexagon": polygon(6), "octagon": polygon(8), "L": ELL}

for name, triangles in SHAPES.items():
    meshes = np.array([4.0, 8.0, 12.0])
    values = [stiffness(triangles, int(m)) for m in meshes]
    print(name, np.linalg.solve(np.column_stack([meshes**0, 1 / meshes, meshes**-2]), values)[0])
