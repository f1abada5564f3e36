"""Compares equivalent-linear responses with pystrata's, or writes the table that `cargo test` compares with.

    equivalent_linear.py target/tmp/equivalent_linear.csv            fails if anything differs by more than its limit
    equivalent_linear.py target/tmp/equivalent_linear.csv TABLE      writes pystrata's results

The first file, by the test `equivalent_linear`, has the motion (m/s², peak 1 g), the sites and the crate's results.
Response spectra of both are those of acceleration that is linear between samples.
"""

import csv
import sys

import numpy as np
import pystrata
from pystrata.motion import GRAVITY
from scipy.signal import cont2discrete, lfilter

# The complex modulus G (1 + 2i xi), as in SHAKE; read each time a modulus is asked for.
pystrata.site.COMP_MODULUS_MODEL = "seed"
STRAINS = [3e-7, 2e-6, 2.2e-5, 1e-4, 2.3e-4, 7e-4, 2.5e-3, 1e-2]
# Largest relative difference of moduli, damping ratios, strains, accelerations and spectra.
LIMIT = 1e-3


def soil_type(density, name, *numbers):
    weight, numbers = density * GRAVITY * 1e-3, [float(number) for number in numbers]
    published = lambda *names: pystrata.site.SoilType.from_published("", weight, *names)  # noqa: E731
    if name == "linear":
        return pystrata.site.SoilType("", weight, None, numbers[0])
    if name == "seed_idriss_mean":
        return published("Seed & Idriss, Sand Mean")
    if name == "seed_idriss_upper":
        return published("Seed & Idriss, Sand Upper", "Seed & Idriss, Sand Lower")
    if name == "vucetic_dobry":
        return published(f"Vucetic & Dobry (91), PI={numbers[0]:.0f}")
    if name == "epri":
        bounds = [0, 20, 50, 120, 250, 500, 1000]
        below = next(k for k, bound in enumerate(bounds[1:]) if numbers[0] <= 0.3048 * bound)
        return published(f"EPRI (93), {bounds[below]}-{bounds[below + 1]} ft")
    index, ratio, stress, frequency, cycles = numbers
    # Its formula at so many strains that nothing depends on the interpolation between them.
    strains = np.logspace(-7.5, -1.4, 6001)
    return pystrata.site.DarendeliSoilType(weight, index, ratio, 1e-3 * stress, frequency, cycles, strains=strains)


def spectrum(accelerations, step, periods):
    """Pseudo-acceleration, 5 % of damping; exact for linear segments, peaks looked for at a twentieth of the step."""
    fine = step / 20
    times = np.arange(0, step * (len(accelerations) - 1), fine)
    motion = np.interp(times, step * np.arange(len(accelerations)), accelerations)
    found = []
    for period in periods:
        omega = 2 * np.pi / period
        above, below, _ = cont2discrete(([-1.0], [1.0, 0.1 * omega, omega**2]), fine, method="foh")
        found.append(omega**2 * np.max(abs(lfilter(np.ravel(above), below, motion))))
    return found


def response(case, step, accelerations, periods):
    layers = [pystrata.site.Layer(soil_type(float(n[2]), *n[3:]), float(n[0]), float(n[1])) for n in case["layers"]]
    speed, density, damping = case["rock"]
    rock = pystrata.site.SoilType("", density * GRAVITY * 1e-3, None, damping)
    profile = pystrata.site.Profile([*layers, pystrata.site.Layer(rock, 0.0, speed)])
    motion = pystrata.motion.TimeSeriesMotion("", "", step, float(case["peak"]) * accelerations / GRAVITY)
    calculator = pystrata.propagation.EquivalentLinearCalculator(0.65, 1e-6, 1000, None)
    outcrop = profile.location("outcrop", index=-1)
    calculator(motion, profile, outcrop)
    moved = lambda place: GRAVITY * motion.calc_time_series(calculator.calc_accel_tf(outcrop, place))  # noqa: E731
    layers = []
    for k, layer in enumerate(profile[:-1]):
        top = pystrata.site.Location(k, layer, "within", 0.0)
        peak = np.max(abs(moved(top)))
        layers.append([layer.shear_mod / layer.initial_shear_mod, layer.damping, layer.strain_max, peak])
    surface = moved(profile.location("outcrop", index=0))[: len(accelerations)]
    return np.array(layers, float), np.array(spectrum(surface, step, periods))


def main(source, table=None):
    cases, curves = [], []
    for kind, *fields in csv.reader(open(source)):
        if kind == "motion":
            step, *samples = (float(field) for field in fields)
            accelerations = np.array(samples)
        elif kind == "periods":
            periods = [float(field) for field in fields]
        elif kind == "curve":
            curves.append(fields)
        elif kind == "case":
            cases.append({"site": fields[0], "peak": fields[1], "layers": [], "computed": []})
        elif kind == "layer":
            cases[-1]["layers"].append(fields)
        else:
            numbers = [float(field) for field in fields]
            if kind == "computed":
                cases[-1]["computed"].append(numbers)
            else:
                cases[-1][kind] = numbers
    lines, worst = [], np.zeros(5)
    for fields in curves:
        soil = soil_type(1900.0, *fields)
        for strain in STRAINS:
            values = [float(soil.mod_reduc(strain)), float(soil.damping(strain))]
            lines.append(f"curve,{'/'.join(fields)},{strain:g},{values[0]:.8g},{values[1]:.8g}")
    for case in cases:
        expected, spectral = response(case, step, accelerations, periods)
        layer_errors = np.max(abs(np.array(case["computed"]) / expected - 1), axis=0)
        errors = [*layer_errors, np.max(abs(case["spectrum"] / spectral - 1))]
        worst = np.maximum(worst, errors)
        text = ", ".join(f"{error:.1e}" for error in errors)
        print(f"{case['site']:>10} {case['peak']:>5} g: {text}")
        start = f"{case['site']},{case['peak']}"
        lines += [f"layer,{start}," + ",".join(f"{value:.6g}" for value in row) for row in expected]
        lines.append(f"spectrum,{start}," + ",".join(f"{value:.6g}" for value in spectral))
    if table:
        open(table, "w").write("\n".join(lines) + "\n")
        return 0
    print("largest differences of modulus, damping, strain, acceleration, spectrum:", worst)
    return 0 if len(cases) == 9 and np.all(worst < LIMIT) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
