"""Reference for src/bem/full_plane/bessel.rs: python3 bessel_k.py > bessel_k.csv"""
from mpmath import mp, mpf, besselk, expjpi, nstr

mp.dps = 30
print("# Modified Bessel functions K0 and K1 of complex argument, by mpmath at 30 digits.")
print("# Made by bessel_k.py.")
print("re,im,k0_re,k0_im,k1_re,k1_im")
for size in ["1e-8", "1e-3", "0.1", "0.7", "1.5", "1.99", "2.01", "3", "5", "8", "13", "21", "34", "60"]:
    for turn in ["-0.499", "-0.3", "0", "0.1", "0.25", "0.4", "0.49", "0.4999"]:
        z = mpf(size) * expjpi(mpf(turn))
        # The argument as the reader will see it.
        z = mp.mpc(float(z.real), float(z.imag))
        k = [besselk(0, z), besselk(1, z)]
        print(",".join(repr(float(v)) for v in (z.real, z.imag)) + ","
              + ",".join(nstr(v, 18) for w in k for v in (w.real, w.imag)))
