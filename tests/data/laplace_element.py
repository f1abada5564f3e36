"""Reference for tests/convolution_quadrature.rs: python3 laplace_element.py > laplace_element.csv

Element integrals of the Laplace-domain full-plane solution, by mpmath at 36 digits:
U from K0 and K1 as they stand (no regularisation), tractions from Hooke's law on central
differences of U, composite Gauss quadrature halved towards the foot of the collocation point.
"""
from mpmath import mp, mpf, mpc, besselk, pi, sqrt
from numpy.polynomial.legendre import leggauss

mp.dps = 36
RHO, MU, C2, C1 = mpf(1), mpf(1), mpf(1), mpf(2)  # nu = 1/3
LAME = C1**2 - 2


def u(s, x, z):
    r = sqrt(x * x + z * z)
    z1, z2 = s * r / C1, s * r / C2
    k01, k11, k02, k12 = besselk(0, z1), besselk(1, z1), besselk(0, z2), besselk(1, z2)
    f1 = (k12 / z2) / C2**2 - (k11 / z1) / C1**2
    chi = (k02 + 2 * k12 / z2) / C2**2 - (k01 + 2 * k11 / z1) / C1**2
    e = (x / r, z / r)
    psi = k02 / C2**2 + f1
    return [[(psi * (i == j) - chi * e[i] * e[j]) / (2 * pi * RHO) for j in (0, 1)] for i in (0, 1)]


def t(s, x, z, n):
    h = mpf("1e-8")
    dx = [[(a - b) / (2 * h) for a, b in zip(p, m)] for p, m in zip(u(s, x + h, z), u(s, x - h, z))]
    dz = [[(a - b) / (2 * h) for a, b in zip(p, m)] for p, m in zip(u(s, x, z + h), u(s, x, z - h))]
    out = [[0, 0], [0, 0]]
    for load in (0, 1):
        grad = [[dx[c][load], dz[c][load]] for c in (0, 1)]
        div = grad[0][0] + grad[1][1]
        for i in (0, 1):
            out[i][load] = sum(MU * (grad[i][k] + grad[k][i]) * n[k] for k in (0, 1)) + LAME * div * n[i]
    return out


# Gauss-Legendre rule of 20 points, good to the last place of a double.
RULE = [(mpf(x), mpf(w)) for x, w in zip(*leggauss(20))]

# Two elements each: the point is the first one's midpoint; integrals over both.
VIEWS = {
    "own": ((0, 0), (1, 0), (0, 0), (1, 0)),
    "next": ((0, 0), (1, 0), (1, 0), (2, 0)),
    "far": ((0, 0), (1, 0), (19, 0), (20, 0)),
    "corner": ((0, 0), (1, 0), (1, 0), (1, mpf("1.5"))),
    "near": ((0, 0), (1, 0), (mpf("0.3"), mpf("-0.01")), (mpf("0.9"), mpf("-0.02"))),
    "skew": ((0, 0), (mpf("0.6"), mpf("0.8")), (3, mpf("-0.5")), (4, 1)),
    "ownskew": ((0, 0), (mpf("0.6"), mpf("0.8")), (0, 0), (mpf("0.6"), mpf("0.8"))),
}
S = [mpc("0.001", "0.002"), mpc("0.4", "0"), mpc("0.05", "3"), mpc("2", "-1"), mpc("0.5", "50"), mpc("30", "40")]

# Which values of S each view is evaluated at.
AT = {"own": [0, 2, 5], "next": [1], "far": [2], "corner": [2], "near": [2], "skew": [5], "ownskew": [2]}

print("# Element integrals of the transformed full-plane kernels, nu = 1/3, mu = rho = c2 = 1.")
print("# Collocation at the midpoint of a; integrals over b; z down. h without the free term.")
print("# Made by laplace_element.py (mpmath, 36 digits).")
names = [f"{k}_{a}{b}_{p}" for k in "gh" for a in "xz" for b in "xz" for p in ("re", "im")]
print("view,a0,a1,a2,a3,b0,b1,b2,b3,s_re,s_im," + ",".join(names))
for name, (a, b, p, q) in VIEWS.items():
    c = [(mpf(a[k]) + b[k]) / 2 for k in (0, 1)]
    l = sqrt((mpf(q[0]) - p[0])**2 + (mpf(q[1]) - p[1])**2)
    d = [(mpf(q[k]) - p[k]) / l for k in (0, 1)]
    n = (d[1], -d[0])
    off = [mpf(p[k]) - c[k] for k in (0, 1)]
    foot = -(off[0] * d[0] + off[1] * d[1])
    own = name.startswith("own")
    cuts = [mpf(0), l] if not (0 < foot < l) else [mpf(0), foot, l]
    for s in (S[k] for k in AT[name]):
        panels = []
        for lo, hi in zip(cuts, cuts[1:]):
            if own or name == "near":
                # Halved towards the foot.
                far, near = (hi, lo) if abs(lo - foot) < abs(hi - foot) else (lo, hi)
                levels = 36 if own else 9
                marks = [near + (far - near) * mpf(2)**(-k) for k in range(levels)] + [near]
                parts = list(zip(marks, marks[1:]))
            else:
                parts = [(lo, (lo + hi) / 2), ((lo + hi) / 2, hi)]
            for c0, c1 in parts:
                m = max(1, int(abs(s) * abs(c1 - c0) / 5) + 1)
                panels += [tuple(sorted((c0 + (c1 - c0) * k / m, c0 + (c1 - c0) * (k + 1) / m))) for k in range(m)]
        row = [mpc(0)] * 8
        for c0, c1 in panels:
            for node, weight in RULE:
                v, w = (c0 + c1) / 2 + (c1 - c0) / 2 * node, weight * (c1 - c0) / 2
                x, z = off[0] + v * d[0], off[1] + v * d[1]
                uu = u(s, x, z)
                tt = [[0, 0], [0, 0]] if own else t(s, x, z, n)
                for i in (0, 1):
                    for j in (0, 1):
                        row[2 * i + j] += w * uu[i][j]
                        row[4 + 2 * i + j] += w * tt[j][i]
        nums = [a[0], a[1], b[0], b[1], p[0], p[1], q[0], q[1], s.real, s.imag]
        print(name + "," + ",".join(mp.nstr(mpf(v), 17) for v in nums) + ","
              + ",".join(mp.nstr(v.real, 17) + "," + mp.nstr(v.imag, 17) for v in row), flush=True)
