"""The table of Rust's study `fragility`: friction × width of the base × motions × intensities.

    python examples/fragility.py --short
    python examples/fragility.py --dask 2                      # a cluster of two processes here
    python examples/fragility.py --scheduler tcp://host:8786   # one that is there

A shear building stands on a mat that may uplift and slide. El Centro and near-fault pulses are
scaled to levels of peak ground velocity. The file is Rust's `cases.csv`, byte for byte. Rust fits
the curves:

    python examples/fragility.py --dask 2 --table runs/shard_0_of_1.csv
    cargo study fragility --merge --out runs
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import math
import sys
import time
from pathlib import Path
from typing import Any

import basemat as bm

STEP = 5.0e-3
# Longest part of a record that is run, and time after it, s.
RECORD = 15.0
REST = 3.0
STOREYS = 5
ELEMENTS = 8
# Coefficients of pairs of elements, computed once in a process.
KERNELS = bm.SharedKernels()


def pulse(period: float, oscillations: float, phase: float) -> bm.Record:
    """The acceleration of a near-fault pulse: period 1/f (s), oscillations γ, phase ν (degrees).

    Velocity ½ [1 + cos(2πf(t − t₀)/γ)] cos(2πf(t − t₀) + ν) for |t − t₀| ≤ γ/(2f), zero outside:
    Mavroeidis and Papageorgiou, "A mathematical representation of near-fault ground motions",
    Bulletin of the Seismological Society of America 93 (2003), 1099–1131.
    """
    duration = oscillations * period
    end = math.pi * oscillations

    # By `math`, which takes sine and cosine of the C library as Rust does; numpy may have its own.
    def acceleration(at: float) -> float:
        angle = math.tau * (at - 0.5 * duration) / period
        angle = min(max(angle, -end), end)
        slow, fast = angle / oscillations, angle + math.radians(phase)
        share = math.sin(slow) * math.cos(fast) / oscillations
        return -math.pi / period * (share + (1.0 + math.cos(slow)) * math.sin(fast))

    samples = math.ceil(duration / STEP)
    return bm.Record(STEP, [acceleration(k * STEP) for k in range(samples + 1)])


@functools.lru_cache(maxsize=None)
def motions(short: bool = False) -> dict[str, bm.Record]:
    """The motions by name; fewer if ``short``."""
    record = bm.el_centro_1940()
    found = {}
    for factor in [1.0] if short else [0.7, 1.0, 1.4]:
        name = "" if factor == 1.0 else f", {factor:g} × as long"
        scaled = bm.Record(factor * record.time_step, record.accelerations)
        found[f"El Centro 1940{name}"] = scaled
    shapes = [(1.5, 0.0), (2.0, 90.0)] if short else [(1.3, 0.0), (2.0, 90.0), (3.0, 45.0)]
    for period in [0.6, 1.6] if short else [0.4, 0.6, 1.0, 1.6, 2.5]:
        for oscillations, phase in shapes:
            name = f"pulse {period:g} s, γ {oscillations:g}, ν {phase:g}°"
            found[name] = pulse(period, oscillations, phase)
    return found


@functools.lru_cache(maxsize=None)
def motion_of(name: str) -> bm.Record:
    """A motion by its name."""
    return {**motions(True), **motions(False)}[name]


def grid(short: bool = False) -> dict[str, list[Any]]:
    """Names and values of the parameters, the last the fastest."""
    levels = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0]
    return {
        "friction": [0.2, 0.4] if short else [0.2, 0.3, 0.4],
        "width_m": [8.0] if short else [6.0, 9.0, 12.0],
        "motion": list(motions(short)),
        "peak_velocity_m_per_s": [0.2, 0.5, 1.0, 1.6] if short else levels,
    }


def shake(
    friction: float, width_m: float, motion: str, peak_velocity_m_per_s: float
) -> dict[str, float]:
    """A run: five storeys of 3 m on a mat of this width; the soil's shear wave speed is 250 m/s."""
    storeys = [bm.Storey(3.0, 3.0e3 * width_m, 7.5e6 * width_m)] * STOREYS
    mass = 7.5e3 * width_m
    inertia = mass * width_m * width_m / 12.0
    building = bm.ShearBuilding(width_m, mass, inertia, storeys, damping=0.05)
    soil = bm.Soil.from_shear_wave_speed(250.0, 0.33, 1900.0)
    record = motion_of(motion)
    simulation = bm.Simulation(
        STEP,
        building,
        bm.ElasticGround.under(soil, building, ELEMENTS, kernels=KERNELS),
        bm.Coulomb(friction),
        motion=record.scaled(peak_velocity_m_per_s / record.peak_velocity),
        probes=[
            bm.Probe.displacement(f"drift {storey}", building.drift(storey))
            for storey in range(STOREYS)
        ],
    )
    run = simulation.run(duration=min(record.duration, RECORD) + REST, series=False)
    coefficient = run.shear_coefficient
    return {
        "peak_slip_m": run.mean_slip.magnitude,
        "residual_slip_m": abs(run.residual_slip),
        "largest_gap_m": run.largest_gap.value,
        "uplifted_fraction": run.uplifted_fraction.value,
        "peak_drift_ratio": max(drift.magnitude for drift in run.probes.values()) / 3.0,
        "base_shear_over_weight": math.nan if coefficient is None else coefficient,
        "steps": float(run.steps),
    }


def main(arguments: list[str] | None = None) -> None:
    """The study from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--jobs", type=int, help="threads; 0 for all processors")
    where.add_argument("--dask", type=int, metavar="N", help="Dask, N processes here")
    where.add_argument("--scheduler", metavar="ADDRESS", help="Dask, a cluster that is there")
    parser.add_argument("--short", action="store_true", help="few cases, in seconds")
    parser.add_argument("--table", type=Path, default=Path("target/fragility/cases.csv"))
    options = parser.parse_args(arguments)

    with contextlib.ExitStack() as closed:
        client = None
        if options.dask or options.scheduler:
            from dask.distributed import Client, LocalCluster

            cluster = options.scheduler
            if options.dask:
                cluster = closed.enter_context(LocalCluster(n_workers=options.dask, threads_per_worker=1))
            client = closed.enter_context(Client(cluster))
            # Workers import this file, also those that come later; its motions and kernels stay there.
            client.upload_file(__file__, load=False)
        begin = time.perf_counter()
        table = bm.sweep(
            shake,
            grid(options.short),
            progress=sys.stderr.isatty(),
            file=options.table,
            jobs=options.jobs,
            executor=client,
        )
        elapsed = time.perf_counter() - begin
    failed = len(table[table["error"].notna()])
    print(f"{options.table}: {len(table)} cases, {failed} failed")
    print(f"{elapsed:.2f} s by the clock, {1e3 * elapsed / len(table):.2f} s per thousand runs")


if __name__ == "__main__":
    # Imported by its name, so that functions reach other processes by theirs.
    import fragility

    fragility.main()
