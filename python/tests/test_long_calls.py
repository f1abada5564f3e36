"""Long calls say how far they are, and hear Ctrl-C."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest

import basemat as bm
from basemat._progress import Line

SOIL = bm.Soil(60e6, 0.3, 1900.0)
PROFILE = bm.SoilProfile([bm.SoilLayer(SOIL, 6.0)], bm.Soil(600e6, 0.3, 2200.0))
BLOCK = bm.RigidBlock(10.0, 8.0, 1500.0)


def simulation(time_step: float = 0.01, elements: int = 4, **keywords: object) -> bm.Simulation:
    ground = bm.ElasticGround.under(PROFILE, BLOCK, elements)
    motion = bm.el_centro_1940()
    return bm.Simulation(time_step, BLOCK, ground, bm.Coulomb(0.4), motion=motion, **keywords)  # type: ignore[arg-type]


def test_a_line_for_coefficients_and_one_for_steps(capsys: pytest.CaptureFixture[str]) -> None:
    simulation(2e-4, 12).run(3000, progress=True)
    coefficients, steps = capsys.readouterr().err.strip().split("\n")
    assert coefficients.split("\r")[-1].strip().endswith("parts of the ground's coefficients (100 %), 0 s left")
    assert "3000 of 3000 steps (100 %)" in steps and "coefficients" not in steps


def test_a_line_that_is_told_its_end_twice_ends_once(capsys: pytest.CaptureFixture[str]) -> None:
    line = Line("parts")
    for done in (0, 3, 3):
        line(done, 3)
    assert capsys.readouterr().err.count("\n") == 1


def test_expected_steps_are_made_ready_under_eyes() -> None:
    told: list[tuple[int, int]] = []
    made = simulation(2e-4, 12, solver=bm.SolverOptions(expected_steps=3000), progress=lambda *own: told.append(own))
    assert told and told[-1][0] == told[-1][1]
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    assert made.run(200).base_shear == simulation(2e-4, 12).run(200).base_shear


def interrupted(call: object) -> float:
    """Seconds from Ctrl-C to the end of a call."""
    sent: list[float] = []

    def send() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.4, send)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()  # type: ignore[operator]
    return time.monotonic() - sent[0]


@pytest.mark.skipif(sys.platform == "win32", reason="no process sends itself Ctrl-C there")
@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_is_heard() -> None:
    run = simulation(2e-5, 24)
    assert interrupted(lambda: run.run(50_000)) < 2.0
    # As if nothing had been asked.
    assert run.state.step == 0
    record = bm.el_centro_1940()
    assert interrupted(lambda: record.response_spectrum(bm.log_spaced(1e-3, 10.0, 20_000))) < 2.0
    ground = bm.ElasticGround.under(PROFILE, BLOCK, 48)
    assert interrupted(lambda: ground.impedances(bm.log_spaced(1.0, 200.0, 20_000))) < 2.0


LAYERS = 50
SAMPLES = 28_000


def soft_column() -> bm.SoilColumn:
    layers = [
        bm.SoilLayer(bm.Soil.from_shear_wave_speed(180.0 + 6.0 * k, 0.4, 1800.0), 1.2, bm.DampingLaw.constant_q(0.05))
        for k in range(LAYERS)
    ]
    return bm.SoilColumn(bm.SoilProfile(layers, bm.Soil.from_shear_wave_speed(760.0, 0.25, 2200.0)))


def long_record() -> bm.Record:
    record = bm.el_centro_1940()
    return bm.Record(0.005, np.interp(0.005 * np.arange(SAMPLES), record.times, record.accelerations))


def site_calls() -> dict[str, Callable[[], object]]:
    column, record = soft_column(), long_record()
    profile, curves = column_profile(), [bm.StrainCurves.vucetic_dobry(30.0)] * LAYERS
    wave = bm.InclinedWave.sv(profile, 0.2)

    def again(call: Callable[[], object]) -> Callable[[], object]:
        return lambda: [call() for _ in range(200)]

    return {
        "equivalent_linear": again(lambda: column.equivalent_linear(record, curves)),
        "to_surface": again(lambda: column.to_surface(record)),
        "from_surface": again(lambda: column.from_surface(record)),
        "transfer": again(lambda: column.transfer(np.linspace(0.0, 100.0, 200_000))),
        "field": again(lambda: wave.field(record, 0.0)),
    }


def column_profile() -> bm.SoilProfile:
    layers = [bm.SoilLayer(bm.Soil.from_shear_wave_speed(200.0, 0.4, 1800.0), 1.2) for _ in range(LAYERS)]
    return bm.SoilProfile(layers, bm.Soil.from_shear_wave_speed(760.0, 0.25, 2200.0))


@pytest.mark.skipif(sys.platform == "win32", reason="no process sends itself Ctrl-C there")
@pytest.mark.usefixtures("interruptible")
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["equivalent_linear", "to_surface", "from_surface", "transfer", "field"])
def test_site_response_hears_ctrl_c_and_lets_threads_run(name: str) -> None:
    call = site_calls()[name]
    turns, done = [0], threading.Event()

    def count() -> None:
        while not done.wait(0.005):
            turns[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    try:
        assert interrupted(call) < 1.0
    finally:
        done.set()
        thread.join()
    # 0.4 s until Ctrl-C: 80 turns on an idle machine, none under the interpreter's lock.
    assert turns[0] > 10
