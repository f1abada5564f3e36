"""Surface compliances of stiff layers over soft ground: python3 contrasts_C_ks.py > contrasts_C_ks.csv

State vectors (u sin kx, w cos kx, their stresses) are carried through the layers by matrix exponentials in 120 digits; nothing
is shared with the waves of src/bem/layered/compliance.rs. Columns as in kernel_C_ks.csv.
"""
from mpmath import mp, mpf, mpc, matrix, sqrt, expm, nstr

mp.dps = 120


def half_plane(k, s, soil):
    rho, mu, nu, _ = soil
    q2 = rho * s * s / mu
    a2 = (1 - 2 * nu) / (2 * (1 - nu))
    alpha, beta = sqrt(k * k + a2 * q2), sqrt(k * k + q2)
    u = matrix([[k, beta], [alpha, k]])
    t = matrix([[-2 * mu * k * alpha, -mu * (2 * k * k + q2)], [-mu * (2 * k * k + q2), -2 * mu * k * beta]])
    return t * u**-1


def compliance(k, s, layers, rigid):
    # u' = k w + x/mu; w' = -(1-2a2) k u + a2/mu z; x' = (4 mu (1-a2) k2 + rho s2) u + (1-2a2) k z; z' = rho s2 w - k x
    if rigid:
        state, above = matrix([[0, 0], [0, 0], [1, 0], [0, 1]]), layers
    else:
        z = half_plane(k, s, layers[-1])
        state, above = matrix([[1, 0], [0, 1], [z[0, 0], z[0, 1]], [z[1, 0], z[1, 1]]]), layers[:-1]
    for rho, mu, nu, h in reversed(above):
        a2 = (1 - 2 * nu) / (2 * (1 - nu))
        b = 1 - 2 * a2
        p = rho * s * s
        rate = matrix([[0, k, 1 / mu, 0], [-b * k, 0, 0, a2 / mu], [4 * mu * (1 - a2) * k * k + p, 0, 0, b * k], [0, p, -k, 0]])
        state = expm(-rate * h) * state
    u = matrix([[state[0, 0], state[0, 1]], [state[1, 0], state[1, 1]]])
    t = matrix([[state[2, 0], state[2, 1]], [state[3, 0], state[3, 1]]])
    return -u * t**-1


def soil(rho, mu, nu, h):
    return tuple(mpf(v) for v in (rho, mu, nu, h))


print("# surface compliances of stiff layers over soft ground, 120-digit arithmetic; columns of kernel_C_ks.csv")
print("# made by contrasts_C_ks.py")
print("k,re_s,im_s,rigid,re_Cxx,im_Cxx,re_Czz,im_Czz,re_Cxz,im_Cxz,layers(rho:re_mu:im_mu:nu:h|...)")
soft = (1500.0, 4e7, 0.33)
for contrast in (1e2, 1e5, 1e8):
    stiff = (2400.0, 4e7 * contrast, 0.2)
    for layers, rigid in (
        ((stiff + (0.5,), soft + (0.0,)), 0),
        ((stiff + (0.5,), soft + (6.0,)), 1),
        ((soft + (1.0,), stiff + (0.5,), soft + (2.0,), stiff + (0.0,)), 0),
        ((stiff + (0.001,), stiff + (0.3,), soft + (0.001,), soft + (0.0,)), 0),
    ):
        for k in (1e-7, 1e-4, 0.01, 0.2, 0.6, 1.5):
            for s in ((0.0, 0.0), (0.5, 30.0)):
                # Nothing here differs from s = 0 in the digits that are written.
                at = mpc(*s) if s != (0.0, 0.0) else mpf("1e-50")
                c = compliance(mpf(k), at, [soil(*layer) for layer in layers], rigid)
                numbers = [v for z in (c[0, 0], c[1, 1], c[0, 1]) for v in (mpc(z).real, mpc(z).imag)]
                shown = ",".join(nstr(v, 17) for v in numbers)
                text = "|".join(f"{rho}:{mu!r}:0:{nu}:{h}" for rho, mu, nu, h in layers)
                print(f"{k!r},{s[0]},{s[1]},{rigid},{shown},{text}")
