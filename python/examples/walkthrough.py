# %% [markdown]
# # A building that may uplift and slide
#
# A first run, matrices of your own, a layered site, three directions, many cases, fragility, and parts of your own.
# `walkthrough.py` and `walkthrough.ipynb` have the same cells and write pictures to `walkthrough/`. They need
# `pip install './python[pandas,plot]'`.

# %%
from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import basemat as bm

OUT = Path("walkthrough")
OUT.mkdir(exist_ok=True)

# %% [markdown]
# El Centro shakes five storeys on a base 10 m wide, on soil with a shear wave speed of 205 m/s.

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


def simulation(law: bm.InterfaceLaw | bm.UserLaw, motion: bm.Record = record) -> bm.Simulation:
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
# Where the base is open and where it slides, over time:

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
# Floor spectra of the roof, broadened by 15 %:

# %%
periods = bm.log_spaced(0.05, 3.0, 200)
figure, axis = plt.subplots(figsize=(8, 4), layout="constrained")
for name, run in runs.items():
    spectrum = run.floor_spectrum("roof", periods, damping=0.05).broadened(0.15)
    spectrum.plot(axis, label=name, title="roof, 5 % damping")
figure.savefig(OUT / "floor_spectra.png", dpi=120)

# %% [markdown]
# ## Matrices of your own
#
# A structure may be given by mass, stiffness and damping matrices without supports, here those of the building.
# Probes and frames use the names of its degrees of freedom.

# %%
names = ["base_x", "base_y", "base_rotation", *(f"floor_{k}" for k in range(5))]
matrices = building.mass(), building.stiffness(), building.base()
model = bm.MatrixModel(*matrices, damping=building.damping(), dof_names=names)
own = bm.Simulation(
    0.005,
    model,
    bm.ElasticGround.under(soil, model, 16),
    bm.Coulomb(0.25),
    motion=record,
    probes=[bm.Probe.acceleration(name, model.dof(name)) for name in names[3:]],
)
run = own.run(duration=10.0, motion_every=20)
print("largest difference, m:", run.motion_frame().abs().max().round(4).to_dict())
print(run.floor_spectra([0.1, 0.2, 0.5, 1.0]).round(2))

# %% [markdown]
# ## A layered site
#
# Two layers with 4 % of damping lie on rock. El Centro is taken as the motion of the rock's outcrop, and carried to the
# surface through them; they are also the ground under the building. Its convolution weights take a second or so.

# %%
damping = bm.DampingLaw.constant_q(0.04)
layers = [
    bm.SoilLayer(bm.Soil.from_shear_wave_speed(180.0, poisson=0.35, density=1800.0), 5.0, damping),
    bm.SoilLayer(bm.Soil.from_shear_wave_speed(320.0, poisson=0.35, density=1900.0), 8.0, damping),
]
rock = bm.Soil.from_shear_wave_speed(900.0, poisson=0.25, density=2300.0)
site = bm.SoilProfile(layers, rock)
surface = bm.SoilColumn(site).to_surface(record.resampled(0.005).padded(2.0, 5.0))
print(f"peak acceleration: rock {record.peak_acceleration:.2f}, surface {surface.peak_acceleration:.2f} m/s²")
ground = bm.ElasticGround.under(site, building, 8)
layered = bm.Simulation(0.01, building, ground, bm.Coulomb(0.25), motion=surface, probes=probes)
run = layered.run(duration=10.0)
print(f"layered site: uplift {100.0 * run.uplifted_fraction.value:.0f} %, slip {1e3 * run.residual_slip:.1f} mm")

# %% [markdown]
# ## Three directions
#
# A tank on a square mat is shaken along x, along y and up. `RigidBody` stands on a ground in plan: `under` covers its base
# with square cells, here four along a side. It lifts and slides in any direction; forces are those of the whole body, in
# N and N·m.

# %%
tank = bm.RigidBody.cuboid(8.0, 8.0, 10.0, density=400.0)
soil = bm.Soil.from_shear_wave_speed(250.0, poisson=0.33, density=1900.0)
motion = bm.triaxial(x=record, y=record.scaled(0.8), up=record.scaled(0.5))


def in_plan(
    structure: bm.Structure,
    law: bm.InterfaceLaw | bm.UserPlanLaw,
    motion: bm.FreeField = motion,
    probes: Sequence[bm.Probe] = (),
) -> bm.Run:
    """A run on the soil, with four cells along the shorter side."""
    ground = bm.ElasticGround.under(soil, structure, 4)
    return bm.Simulation(0.005, structure, ground, law, motion=motion, probes=probes).run(duration=10.0, contact_every=5)


run = in_plan(tank, bm.Coulomb(0.4))
for name in ("base_shear", "shear_across", "torque", "uplifted_area"):
    print(f"{name}: {np.abs(run[name]).max():.4g} {run.units[name]}")
print(run.contact_frame().groupby("mode", observed=True)[["gap", "slip", "slip_across"]].max())
run.plot()
plt.savefig(OUT / "plan.png", dpi=120)
run.plot_contact_plan()
plt.savefig(OUT / "contact_plan.png", dpi=120)

# %% [markdown]
# Next, the stiffness of the mat in all six motions, and a law of your own: in plan it gives limits of the tractions, and
# slip is along the shear traction. This friction falls with the sliding distance.

# %%
stiffness = bm.ElasticGround.under(soil, tank, 8).impedances([0.0])[0].real
print(f"static stiffness: vertical {stiffness[2, 2]:.3g} N/m, about x {stiffness[3, 3]:.3g} N·m")


class Worn:
    """Friction that falls from 0.4 to 0.2 with the sliding distance of an element (m), its state variable."""

    state_variables = 1

    def limits(self, start: bm.PreviousContact) -> bm.Limits:
        """Limits in this step."""
        return bm.Limits(friction=0.2 + 0.2 * math.exp(-start.state_variables[0] / 0.005))

    def commit(self, start: bm.PreviousContact, end: bm.ContactState, mode: bm.Mode) -> list[float]:
        """Sliding distance so far."""
        way = math.hypot(end.slip - start.slip, end.slip_across - start.slip_across)
        return [start.state_variables[0] + (way if mode == "slip" else 0.0)]


print(f"largest slip: {1e3 * run.largest_slip.value:.1f} mm, worn {1e3 * in_plan(tank, Worn()).largest_slip.value:.1f} mm")

# %% [markdown]
# A staircase moves the centre of stiffness of a building to one end. Under an SH wave that travels obliquely below it, the
# other end drifts most.

# %%
storey = bm.PlanStorey(3.2, 240e3, (20.0, 12.0), (4e8, 3e8, 1.5e10), stiffness_center=(-5.0, 0.0))
frame = bm.StoreyBuilding(bm.RigidBody.cuboid(20.0, 12.0, 1.0, density=2500.0), [storey] * 4)
damped = bm.WithModalDamping(frame, [0.05], fixed_base=True)
drifts = {name: frame.drift(0, place)[1] for name, place in (("left", (-10.0, 0.0)), ("right", (10.0, 0.0)))}
wave = bm.PlaneWave.sh(soil, angle=0.4).field_from_across(record, origin=-12.0, azimuth=0.3)
run = in_plan(damped, bm.Coulomb(0.6), wave, probes=[bm.Probe.displacement(*own) for own in drifts.items()])
print({name: f"{1e3 * own.magnitude:.1f} mm" for name, own in run.probes.items()})

# %% [markdown]
# Where the energy went in the first runs:

# %%
for name, run in runs.items():
    fractions = run.energy_fractions or {}
    print(f"{name:>13}: " + ", ".join(f"{key} {100.0 * own:.1f} %" for key, own in fractions.items()))

# %% [markdown]
# ## Many cases
#
# Four motions at six intensities, on two threads; the table has a row per case.

# %%
motions = {
    "El Centro": record,
    "faster": bm.Record(0.7 * record.time_step, record.accelerations),
    "slower": bm.Record(1.4 * record.time_step, record.accelerations),
    "layered site": surface,
}


def case(name: str, peak: float) -> bm.Simulation:
    """The building under a motion scaled to a peak ground acceleration in g."""
    return simulation(bm.Coulomb(0.25), motions[name].scaled_to_peak(peak * bm.STANDARD_GRAVITY))


grid = {"name": list(motions), "peak": [0.1, 0.15, 0.2, 0.3, 0.4, 0.6]}
table = bm.sweep(case, grid, duration=10.0, jobs=2)
slip = table.pivot(index="peak", columns="name", values="largest_slip").mul(1e3)
print(slip.round(2))

# %% [markdown]
# ## Fragility
#
# A lognormal curve is fitted to the peak accelerations at which the motions make the base slip by 5 mm. A real study takes
# dozens of motions (`fragility.py`); four show the method.

# %%
limit = 5.0
capacity = np.array([np.interp(limit, np.maximum.accumulate(slip[name].abs()), slip.index) for name in slip])
median, dispersion = np.exp(np.log(capacity).mean()), np.log(capacity).std(ddof=1)
print(f"median {median:.2f} g, dispersion {dispersion:.2f}")
peaks = np.linspace(0.02, 0.8, 200)
probability = [0.5 + 0.5 * math.erf(math.log(peak / median) / (dispersion * math.sqrt(2.0))) for peak in peaks]
figure, axis = plt.subplots(figsize=(6, 4), layout="constrained")
axis.plot(peaks, probability)
axis.step([0.0, *np.sort(capacity)], np.linspace(0.0, 1.0, len(capacity) + 1), where="post", linewidth=0.8)
axis.set(xlabel="peak ground acceleration, g", ylabel=f"probability of {limit:.0f} mm of slip", xlim=(0.0, 0.8))
figure.savefig(OUT / "fragility.png", dpi=120)

# %% [markdown]
# ## Parts of your own
#
# This interface law has friction that falls while an element slides. Exceptions that it raises come out of the run.


# %%
class Polished:
    """Friction that falls from 0.3 to 0.2 with the sliding distance of an element (m), its state variable."""

    modes = ("stick", "slip_left", "slip_right", "open")
    state_variables = 1

    def law(self, start: bm.PreviousContact) -> bm.Coulomb:
        """Coulomb's law with the friction of this step."""
        return bm.Coulomb(0.2 + 0.1 * float(np.exp(-start.state_variables[0] / 0.01)))

    def conditions(self, mode: bm.Mode, start: bm.PreviousContact) -> tuple[bm.Condition, bm.Condition]:
        """Conditions of Coulomb's law."""
        return self.law(start).conditions(mode, start)

    def next_mode(
        self, mode: bm.Mode, start: bm.PreviousContact, trial: bm.ContactState, tolerance: bm.Tolerance
    ) -> bm.Mode:
        """Next mode by Coulomb's law."""
        return self.law(start).next_mode(mode, start, trial, tolerance)

    def commit(self, start: bm.PreviousContact, end: bm.ContactState, mode: bm.Mode) -> list[float]:
        """Sliding distance so far."""
        return [start.state_variables[0] + (abs(end.slip - start.slip) if "slip" in mode else 0.0)]


frictions: dict[str, bm.InterfaceLaw | bm.UserLaw] = {
    "0.3": bm.Coulomb(0.3),
    "polished": Polished(),
    "0.2": bm.Coulomb(0.2),
}
for name, law in frictions.items():
    run = simulation(law).run(duration=10.0)
    print(f"friction {name:>8}: residual slip {1e3 * run.residual_slip:.1f} mm, {run.wall:.2f} s")

# %% [markdown]
# These hysteretic columns lose strength with their plastic deformation. The simulation gives its copy back with its
# internal variables.


# %%
class Degrading:
    """Elastic up to a strength (N/m) that falls with the plastic deformation (m)."""

    stiffness, first, loss = 40e6, 250e3, 1e6
    slip, way = 0.0, 0.0

    def force(self, deformation: float) -> float:
        """Force after a change from the last committed deformation."""
        limit = max(0.2 * self.first, self.first - self.loss * self.way)
        return max(-limit, min(limit, self.stiffness * (deformation - self.slip)))

    def commit(self, deformation: float) -> None:
        """Keeps the plastic deformation."""
        slip = deformation - self.force(deformation) / self.stiffness
        self.way += abs(slip - self.slip)
        self.slip = slip


yielding = bm.ShearBuilding(10.0, 50e3, 4e5, storeys, damping=0.05, laws={0: Degrading()})
ground = bm.ElasticGround.under(soil, yielding, 16)
degraded = bm.Simulation(0.005, yielding, ground, bm.Coulomb(0.5), motion=record, probes=probes)
run = degraded.run(duration=10.0)
[columns] = degraded.hysteresis
print(f"drift {1e3 * run.probes['lowest drift'].magnitude:.1f} mm, plastic way {1e3 * columns.way:.1f} mm")
