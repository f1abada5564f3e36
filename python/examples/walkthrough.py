# %% [markdown]
# # A building that may uplift and slide
#
# Cells of a notebook (VS Code, Spyder, Jupytext); run as a program it writes its pictures to
# `walkthrough/`. Needs `pip install './python[pandas,plot]'`.

# %%
from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import basemat as bm

OUT = Path("walkthrough")
OUT.mkdir(exist_ok=True)

# %% [markdown]
# Five storeys on a base 10 m wide, soil with a shear wave speed of 205 m/s, El Centro.

# %%
storeys = [bm.Storey(height=3.0, mass=20e3, stiffness=40e6)] * 5
building = bm.ShearBuilding(10.0, base_mass=50e3, base_inertia=4e5, storeys=storeys, damping=0.05)
soil = bm.Soil(shear_modulus=80e6, poisson=0.33, density=1900.0)
record = bm.el_centro_1940()
probes = [
    bm.Probe.acceleration("roof", building.roof),
    bm.Probe.acceleration("first floor", building.floor(0)),
    bm.Probe.displacement("lowest drift", building.drift(0)),
]


def simulation(law: bm.InterfaceLaw, motion: bm.Record = record) -> bm.Simulation:
    """The building with a law between base and soil."""
    ground = bm.ElasticGround.under(soil, building, 16)
    return bm.Simulation(0.005, building, ground, law, motion=motion, probes=probes)


laws = {
    "bonded": bm.Bonded(),
    "uplift": bm.Coulomb(np.inf),
    "uplift, slip": bm.Coulomb(0.25),
}
runs = {name: simulation(law).run(duration=20.0, contact_every=4) for name, law in laws.items()}
print(runs["uplift, slip"])

# %% [markdown]
# Time series are arrays; `to_frame()` makes a pandas frame of all of them.

# %%
figure, axes = plt.subplots(3, 1, sharex=True, figsize=(8, 7), layout="constrained")
for name, run in runs.items():
    axes[0].plot(run.time, 1e-3 * run["base_shear"], label=name, linewidth=0.8)
    axes[1].plot(run.time, 100.0 * run["uplifted_fraction"], linewidth=0.8)
    axes[2].plot(run.time, 1e3 * run["mean_slip"], linewidth=0.8)
for axis, label in zip(axes, ("base shear, kN/m", "open part of the base, %", "slip, mm")):
    axis.set_ylabel(label)
axes[0].legend(loc="upper right")
axes[2].set_xlabel("time, s")
figure.savefig(OUT / "time_series.png", dpi=120)
print(runs["uplift, slip"].to_frame().agg(["min", "max"]).T)

# %% [markdown]
# The base over time: where it is open, where it slides.

# %%
run = runs["uplift, slip"]
contact = run.contact
edges = np.append(run.envelope["left"], run.envelope["right"][-1])
figure, axis = plt.subplots(figsize=(8, 3), layout="constrained")
state = np.select(
    [contact["mode"] == bm.MODES.index("open"), contact["mode"] != bm.MODES.index("stick")],
    [2, 1],
    0,
)
times = np.append(contact["time"], contact["time"][-1] + 0.02)
axis.pcolormesh(times, edges, state.T, cmap="Blues", vmin=0, vmax=3)
axis.set(xlabel="time, s", ylabel="x, m", title="dark: open; light: sliding", xlim=(0.0, 10.0))
figure.savefig(OUT / "contact.png", dpi=120)

# %% [markdown]
# Floor spectra, broadened by 15 %.

# %%
periods = bm.log_spaced(0.05, 3.0, 200)
figure, axis = plt.subplots(figsize=(8, 4), layout="constrained")
for name, run in runs.items():
    spectrum = run.floor_spectrum("roof", periods, damping=0.05).broadened(0.15)
    axis.semilogx(spectrum.period, spectrum.acceleration / bm.STANDARD_GRAVITY, label=name)
axis.set(xlabel="period, s", ylabel="acceleration, g", title="roof, 5 % damping")
axis.legend()
figure.savefig(OUT / "floor_spectra.png", dpi=120)

# %% [markdown]
# Where the energy went.

# %%
for name, run in runs.items():
    shares = run.energy_shares or {}
    print(f"{name:>13}: " + ", ".join(f"{key} {100.0 * own:.1f} %" for key, own in shares.items()))

# %% [markdown]
# Many cases: friction by intensity, on two threads; one row per case.


# %%
def case(friction: float, peak: float) -> bm.Simulation:
    """The building at a peak ground acceleration in g."""
    return simulation(bm.Coulomb(friction), record.scaled_to_peak(peak * bm.STANDARD_GRAVITY))


grid = {"friction": [0.2, 0.3, 0.5], "peak": [0.1, 0.2, 0.3, 0.4]}
table = bm.sweep(case, grid, duration=10.0, jobs=2)
print(table.pivot(index="peak", columns="friction", values="mean_slip").mul(1e3).round(2))

# %% [markdown]
# A law of one's own: friction that falls while an element slides. What it raises comes out of the
# run.


# %%
class Polished:
    """Friction from 0.3 to 0.2 with the way that an element has slid (m), which it remembers."""

    modes = ("stick", "slip left", "slip right", "open")
    memory = 1

    def law(self, start: bm.PreviousContact) -> bm.Coulomb:
        """Coulomb's law with the friction of this step."""
        return bm.Coulomb(0.2 + 0.1 * float(np.exp(-start.memory[0] / 0.01)))

    def conditions(self, mode, start):
        """Coulomb's."""
        return self.law(start).conditions(mode, start)

    def next_mode(self, mode, start, trial, tolerance):
        """Coulomb's."""
        return self.law(start).next_mode(mode, start, trial, tolerance)

    def commit(self, start, end, mode):
        """The way slid so far."""
        return [start.memory[0] + (abs(end.slip - start.slip) if "slip" in mode else 0.0)]


for name, law in {"0.3": bm.Coulomb(0.3), "polished": Polished(), "0.2": bm.Coulomb(0.2)}.items():
    run = simulation(law).run(duration=10.0)
    print(f"friction {name:>8}: residual slip {1e3 * run.residual_slip:.1f} mm, {run.wall:.2f} s")
