"""Reference for the convolution weights G of two boundary elements, in 60 digits.

G = U(n dt) - U((n-1) dt), U(t) from the twice-integrated surface kernel
J(x,t) = x^2 F/2 + x t Q - t^2 W/2 (F, Q, W: integrals of the Lamb kernel with weights 1, 1/tau,
1/tau^2 in closed form by partial fractions over the roots of the Rayleigh polynomial; the odd
kernel by tanh-sinh quadrature). Writes CSV to stdout; mu = c_S = 1, c_S = 1.
"""
import sys
from mpmath import mp, mpf, sqrt, acosh, atan, log, pi, polyroots, quad, re, im, fabs, sin, cos, asin

mp.dps = 60


class Kernel:
    def __init__(self, nu):
        nu = mpf(nu)
        self.a2 = (1 - 2 * nu) / (2 * (1 - nu))
        self.a = sqrt(self.a2)
        a2 = self.a2
        c = [16 * (a2 - 1), 24 - 16 * a2, mpf(-8), mpf(1)]
        if nu == 0:
            self.y = [mpf(1) / 2, (12 - sqrt(mpf(80))) / 16, (12 + sqrt(mpf(80))) / 16]
        else:
            self.y = polyroots(c, maxsteps=500, extraprec=400)
        self.dp = [(3 * c[0] * y + 2 * c[1]) * y + c[2] for y in self.y]
        self.yr = max(re(y) for y in self.y)
        self.tr = sqrt(self.yr)
        sa, sb = sqrt(self.yr - a2), sqrt(self.yr - 1)
        t = self.tr
        # R(tau) = (1-2y)^2 - 4 y Sa Sb
        dr = (-8 * t * (1 - 2 * self.yr) - 8 * t * sa * sb
              - 4 * self.yr * (t * sb / sa + t * sa / sb))
        self.d = pi * t * (1 - 2 * self.yr + 2 * sa * sb) / dr
        h = 1 - a2
        self.h = h
        self.cache = {}
        self.total = [self.partial_zx(m, mpf(1)) for m in (0, 1, 2)]
        self.wtot = self.even_partial(mpf(10) ** 40)
        self.q0 = [pi * self.a / 2, pi / 2]

    def p(self, z):
        """Rayleigh polynomial at y = a^2 + z, precise for small z."""
        a2 = self.a2
        c1 = ((48 * a2 - 80) * a2 + 48) * a2 - 8
        return ((-16 * self.h * z + (48 * a2 - 64) * a2 + 24) * z + c1) * z + (1 - 2 * a2) ** 4

    def partial_zx(self, m, tau):
        """int_a^tau f_zx / eta^m, regular part."""
        if tau <= self.a:
            return mpf(0)
        top = asin(min(mpf(1), sqrt((tau * tau - self.a2) / self.h)))

        def g(th):
            z = self.h * sin(th) ** 2
            y = self.a2 + z
            if z == 0:
                return mpf(0)
            return -2 * (self.h * sin(th) * cos(th)) ** 2 * (1 - 2 * y) / self.p(z) / y ** (mpf(m) / 2)
        pts = [mpf(0)]
        for e in (-16, -12, -8, -6, -4, -3, -2, -1):
            if mpf(10) ** e < top:
                pts.append(mpf(10) ** e)
        return quad(g, pts + [top])

    def int3(self, tau, k2, y):
        k = sqrt(k2)
        s = sqrt(tau * tau - k2)
        ac = acosh(tau / k)
        m2 = k2 - y
        v = s / tau
        if m2 == 0:
            lq, at = mpf(0), mpf(0)
        elif im(y) == 0 and re(m2) < 0:
            nn, sq = sqrt(-m2), sqrt(re(y))
            lq = -log(fabs((nn + v * sq) / (nn - v * sq))) / (2 * nn * sq)
            at = nn / 2 * log(fabs((nn + s) / (nn - s)))
        else:
            m, sq = sqrt(m2 + mpf(0)), sqrt(y + mpf(0))
            lq = atan(v * sq / m) / (m * sq)
            at = m * atan(s / m)
        k0 = ac - m2 * lq
        k1 = (k * atan(s / k) - at) / y
        k2_ = (v - m2 * lq) / y
        return k0, k1, k2_

    def even_partial(self, tau):
        """int_0^tau of f_zz, f_xx with weights 1, 1/eta, 1/eta^2."""
        zz, xx = [mpf(0)] * 3, [mpf(0)] * 3
        for y, d in zip(self.y, self.dp):
            if tau > self.a:
                i = self.int3(tau, self.a2, y)
                for m in range(3):
                    zz[m] -= re((1 - 2 * y) ** 2 / d * i[m])
                    xx[m] -= re(4 * y * (y - 1) / d * i[m])
            if tau > 1:
                i = self.int3(tau, mpf(1), y)
                for m in range(3):
                    zz[m] -= re(4 * y * (y - self.a2) / d * i[m])
                    xx[m] -= re((1 - 2 * y) ** 2 / d * i[m])
        return zz, xx

    def j(self, x, t):
        """J_zz, J_xx, J_zx at signed x."""
        if x == 0 or t == 0:
            return [mpf(0)] * 3
        key = (x, t)
        if key in self.cache:
            return self.cache[key]
        r = fabs(x)
        tau = t / r
        zz, xx = self.even_partial(tau)
        out = []
        for comp, part in enumerate((zz, xx)):
            f, q, w = part[0], self.q0[comp] - part[1], self.wtot[comp][2] - part[2]
            out.append(r * r * f / 2 + r * t * q - t * t * w / 2)
        part = self.total if tau >= 1 else [self.partial_zx(m, tau) for m in range(3)]
        on = 1 if tau >= self.tr else 0
        f = part[0] + on * self.d
        q = self.total[1] - part[1] + (1 - on) * self.d / self.tr
        w = self.total[2] - part[2] + (1 - on) * self.d / self.tr ** 2
        v = r * r * f / 2 + r * t * q - t * t * w / 2
        out.append(v if x > 0 else -v)
        self.cache[key] = out
        return out

    def u(self, ap, bp, aq, bq, t):
        s = [mpf(0)] * 3
        for x, sign in ((bp - aq, 1), (ap - aq, -1), (bp - bq, -1), (ap - bq, 1)):
            v = self.j(x, t)
            for c in range(3):
                s[c] += sign * v[c]
        return [v / (pi * (bp - ap)) for v in s]

    def g(self, el, dt, n):
        ap, bp, aq, bq = el
        gap = max(aq - bp, ap - bq, mpf(0))
        u1 = self.u(ap, bp, aq, bq, n * dt) if n * dt > gap * self.a else [mpf(0)] * 3
        u0 = self.u(ap, bp, aq, bq, (n - 1) * dt) if (n - 1) * dt > gap * self.a else [mpf(0)] * 3
        return [p - q for p, q in zip(u1, u0)]


def main():
    print("# Convolution weights G^n of two elements (mean displacement of receiver [ap,bp] per unit traction")
    print("# on source [aq,bq] held from (n-1)dt to n dt before), mu = c_S = 1, x right, z down.")
    print("# From the closed-form twice-integrated Lamb kernel in 60 digits: influence_reference.py")
    print("# gself: zz of the receiver on itself, same lag; all doubles are exact inputs.")
    print("nu,dt,ap,bp,aq,bq,n,zz,xx,zx,gself")
    nus = sys.argv[1].split(",")
    for nus_ in nus:
        nu = float(nus_)
        k = Kernel(nu)
        a = k.a
        pairs = [(0.0, 1.0, 0.0, 1.0), (1.0, 2.0, 0.0, 1.0), (0.0, 1.0, 9.0, 10.0),
                 (19.0, 20.0, 0.0, 1.0), (199.0, 200.0, 0.0, 1.0),
                 (0.0, 0.0009765625, 0.0009765625, 8.0), (-3.0, -1.0, 0.5, 0.75)]
        for el in pairs:
            ap, bp, aq, bq = [mpf(v) for v in el]
            dist = fabs((ap + bp) - (aq + bq)) / 2
            for beta in (0.02, 0.5, 5.0, 50.0):
                dt = float(beta * a)          # c1 dt / 1
                lags = {1, 2, 1000, 1000000}
                for speed in (a, mpf(1), k.tr):
                    m = int(dist * speed / dt)
                    lags |= {m, m + 1} if (speed != a) else {m + 1}
                m = int(dist * 2 / dt)
                lags |= {m + 1}
                for n in sorted(v for v in lags if v >= 1):
                    g = k.g((ap, bp, aq, bq), mpf(dt), n)
                    s = k.g((ap, bp, ap, bp), mpf(dt), n)
                    print(",".join([nus_, repr(dt)] + [repr(v) for v in el] + [str(n)]
                                   + [mp.nstr(v, 18) for v in g] + [mp.nstr(s[0], 18)]))
        sys.stdout.flush()


main()
