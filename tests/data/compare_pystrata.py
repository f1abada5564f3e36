"""Compares the table of the example `site_amplification` with pystrata's linear elastic calculation.

Fails if a transfer function differs by more than 1e-9 of itself.
"""

import csv
import sys

import numpy as np
import pystrata
from pystrata.motion import GRAVITY

# The complex modulus G (1 + 2i xi), as in SHAKE; read each time a modulus is asked for.
pystrata.site.COMP_MODULUS_MODEL = "seed"

layers, rows = [], []
for kind, *fields in csv.reader(open(sys.argv[1])):
    if kind == "layer":
        thickness, speed, density, ratio = (float(field or 0.0) for field in fields)
        soil = pystrata.site.SoilType("", density * GRAVITY * 1e-3, None, ratio)
        layers.append(pystrata.site.Layer(soil, thickness, speed))
    else:
        rows.append([float(field) for field in fields])
table = np.array(rows)

profile = pystrata.site.Profile(layers)
motion = pystrata.motion.Motion(table[:, 0])
calculator = pystrata.propagation.LinearElasticCalculator()
calculator(motion, profile, profile.location("outcrop", index=-1))
surface = profile.location("outcrop", index=0)

worst = 0.0
for column, field in ((1, "outcrop"), (3, "within")):
    rock = profile.location(field, index=-1)
    wanted = calculator.calc_accel_tf(rock, surface)
    found = table[:, column] + 1j * table[:, column + 1]
    worst = max(worst, np.max(abs(found - wanted) / abs(wanted)))
print(f"{len(table)} frequencies, {len(layers)} layers: largest difference {worst:.1e} of the transfer function")
sys.exit(0 if len(table) > 100 and worst < 1e-9 else 1)
