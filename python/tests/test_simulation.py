"""Stepping, watching, stopping, saving, failing."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm


def test_time_series_have_a_value_per_step_and_agree_with_the_summary(rocking) -> None:
    run = rocking().run(500, contact_every=10, motion_every=100)
    assert run.steps == 500
    assert run.time.shape == (501,)
    np.testing.assert_allclose(run.time, 0.01 * np.arange(501), rtol=1e-14)
    for key, extremes in (("base_shear", run.base_shear), ("roof", run.probes["roof"])):
        series = run[key]
        assert series.dtype == np.float64
        assert (extremes.lowest.value, extremes.highest.value) == (series.min(), series.max())
        assert extremes.highest.time == run.time[series.argmax()]
    contact = run.contact
    assert contact["gap"].shape == contact["mode"].shape == (51, 8)
    assert run.motion["displacement"].shape == (6, 3)
    # No tension, Coulomb's limit, no pressure on what is open.
    pressure, shear = contact["pressure"], contact["shear"]
    assert pressure.min() > -1e-6 * pressure.max()
    assert np.all(np.abs(shear) <= 0.4 * pressure + 1e-6 * pressure.max())
    opened = contact["mode"] == bm.MODES.index("open")
    assert opened.any()
    assert np.abs(pressure[opened]).max() < 1e-6 * pressure.max()
    # Pressure times length is the normal force.
    lengths = np.diff(
        bm.ElasticGround.under(
            bm.Soil(80e6, 0.33, 1900.0), bm.RigidBlock(6.0, 9.0, 1000.0), 8
        ).elements
    )
    np.testing.assert_allclose(pressure @ lengths[:, 0], run["normal_force"][::10], rtol=1e-12)
    envelope = run.envelope
    assert envelope["gap"].max() == run.largest_gap.value
    assert run.energy_balances["residual"].max() < 1e-9


def test_frames(rocking) -> None:
    pandas = pytest.importorskip("pandas")
    run = rocking().run(100)
    frame = run.to_frame()
    assert isinstance(frame, pandas.DataFrame)
    assert frame.index.name == "time"
    assert same_bits(frame["roof"].to_numpy(), run["roof"])
    run = rocking().run(100, contact_every=20)
    contact = run.contact_frame()
    assert list(contact.columns) == "time element x gap slip pressure shear mode".split()
    assert len(contact) == 6 * 8
    row = contact.iloc[3 * 8 + 2]
    assert (row["time"], row["element"]) == (run.contact["time"][3], 2)
    assert row["pressure"] == run.contact["pressure"][3, 2]
    envelope = run.envelope
    assert row["x"] == 0.5 * (envelope["left"][2] + envelope["right"][2])
    assert row["mode"] == bm.MODES[run.contact["mode"][3, 2]]
    spectrum = run.floor_spectrum("roof", bm.log_spaced(0.1, 1.0, 5))
    assert list(spectrum.to_frame().index) == list(spectrum.period)
    assert np.all(spectrum.broadened(0.15).acceleration >= spectrum.acceleration)


def test_run_lasts_as_long_as_the_record(rocking) -> None:
    short = bm.Record(0.02, np.sin(np.arange(101)))
    assert rocking(motion=short).run().end == 2.0
    assert rocking().run(duration=0.255).steps == 26
    with pytest.raises(bm.InputError, match="steps or a duration"):
        rocking(motion=None).run()
    with pytest.raises(bm.InputError, match="not both"):
        rocking().run(10, duration=1.0)


def test_a_run_ends_with_the_motion_and_says_when_it_is_over(rocking) -> None:
    short = bm.Record(0.02, np.sin(np.arange(101)))
    simulation = rocking(motion=short)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # The step is long for this motion, which is another warning.
        warnings.filterwarnings("ignore", message="steps of ")
        # So is the end of the first run, before that of its record.
        warnings.filterwarnings("ignore", message="run ends at 0.50 s")
        simulation.run(50)
        rest = simulation.run()
        assert (rest.start, rest.end, rest.steps) == (0.5, 2.0, 150)
        simulation.run(10)
        simulation.run(duration=0.1)
    for again in (simulation.run, lambda: list(simulation.steps())):
        with pytest.warns(bm.BasematWarning, match=r"ended at 2 s, before these 200 steps.*reset\(\)") as found:
            again()
        # Rounding of the ground at rest is no motion that steps could miss.
        assert len(found) == 1
    assert simulation.state.step == 50 + 150 + 10 + 10 + 2 * 200


def test_reset_goes_back_to_the_first_bit(rocking) -> None:
    simulation = rocking(initial=bm.InitialConditions(velocity=[0.0, 0.0, 0.01]))
    first = simulation.run(200)
    simulation.reset()
    assert (simulation.state.step, simulation.state.time) == (0, 0.0)
    again = simulation.run(200)
    for name, series in first.series.items():
        assert same_bits(again[name], series), name
    assert again.summary() == first.summary()

    class Unsaved:
        """Takes steps over and does not say what it took."""

        dofs = 3
        block = bm.RigidBlock(6.0, 9.0, 1000.0)
        base, mass, stiffness = block.base, block.mass, block.stiffness

        def __deepcopy__(self, memo: dict) -> "Unsaved":
            return self

        def force(self, u):
            return np.zeros(3)

        def tangent(self, u):
            return np.zeros((3, 3))

        def commit(self, u):
            pass

    simulation = rocking(structure=Unsaved())
    simulation.run(5)
    with pytest.raises(bm.CheckpointError, match="structure"):
        simulation.reset()
    assert simulation.state.step == 5


@pytest.mark.parametrize("duration", [-1.0, float("nan"), float("inf")])
def test_a_duration_is_finite_and_not_negative(rocking, duration: float) -> None:
    simulation = rocking()
    for call in (
        lambda: simulation.run(duration=duration),
        lambda: simulation.steps(duration=duration),
        lambda: simulation.steps_for(duration),
    ):
        with pytest.raises(bm.InputError, match="duration is"):
            call()
    assert simulation.state.step == 0 == simulation.steps_for(0.0)


def test_observer_sees_every_step_and_may_stop(rocking) -> None:
    seen = []
    simulation = rocking()

    def observe(state: bm.State) -> bool:
        seen.append((state.step, state.base_shear))
        return state.step == 70

    run = simulation.run(200, observe=observe)
    assert [step for step, _ in seen] == list(range(1, 71))
    assert run.steps == 70
    assert [shear for _, shear in seen] == list(run["base_shear"][1:])

    def fail(state: bm.State) -> None:
        raise LookupError(f"at {state.step}")

    with pytest.raises(LookupError, match="at 80"):
        simulation.run(200, observe=fail, observe_every=10)
    assert simulation.state.step == 80


def test_a_simulation_cannot_be_used_while_it_runs(rocking) -> None:
    simulation = rocking()
    with pytest.raises(bm.Error, match="is running"):
        simulation.run(10, observe=lambda state: simulation.step())
    assert simulation.state.step == 1


def test_a_simulation_says_that_a_panic_has_left_it_unusable(rocking) -> None:
    simulation = rocking()
    with pytest.raises(bm.InputError):
        bm.Coulomb(-1.0)
    # The class of Rust's panics: raised by a function that the core calls, it is a panic there.
    panics = [own for own in BaseException.__subclasses__() if own.__name__ == "PanicException"]
    for panic in panics:

        def fail(state: bm.State, panic: type[BaseException] = panic) -> None:
            raise panic("the test's own")

        with pytest.raises(BaseException, match="the test's own"):
            simulation.run(10, observe=fail)
        with pytest.raises(bm.Error, match="ended in a panic"):
            simulation.step()
        assert repr(simulation) == "Simulation(unusable)"
        simulation = rocking()
    assert panics


@pytest.mark.parametrize("name", ["time", "base_shear", "overturning_safety"])
def test_a_probe_does_not_hide_another_time_series(rocking, name: str) -> None:
    with pytest.raises(bm.InputError, match=f"a probe is called '{name}'"):
        rocking(probes=[bm.Probe.displacement(name, 0)])


def test_checkpoints_pickle_and_go_on_to_the_same_bits(rocking) -> None:
    simulation = rocking(solver=bm.SolverOptions(expected_steps=300))
    simulation.run(150)
    saved = pickle.loads(pickle.dumps(simulation.checkpoint()))
    assert saved == simulation.checkpoint()
    assert saved.steps == 150
    expected = simulation.run(150)["roof"]
    other = rocking(solver=bm.SolverOptions(expected_steps=300))
    other.resume(saved)
    assert same_bits(other.run(150)["roof"], expected)
    with pytest.raises(
        bm.CheckpointError, match="time step|structure|probes|ground|contact elements"
    ):
        block = bm.RigidBlock(5.0, 9.0, 1000.0)
        rocking(
            structure=block, ground=bm.ElasticGround.under(bm.Soil(80e6, 0.33, 1900.0), block, 8)
        ).resume(saved)
    with pytest.raises(bm.InputError, match="these bytes are not a checkpoint"):
        bm.Checkpoint(b"\xff" * 5)


def test_no_damaged_checkpoint_resumes_with_other_numbers() -> None:
    block = bm.RigidBlock(4.0, 3.0, 2000.0)
    ground = bm.SpringGround(bm.Strip(-2.0, 2.0, 2, grading="uniform"), 5e7, 4e7)
    simulation = bm.Simulation(0.01, block, ground, bm.Coulomb(0.3), motion=bm.el_centro_1940())
    simulation.run(9)
    saved = simulation.checkpoint()
    data = saved.to_bytes()
    refused = 0
    for place in range(len(data)):
        for bit in range(8):
            damaged = bytearray(data)
            damaged[place] ^= 1 << bit
            try:
                checkpoint = bm.Checkpoint(bytes(damaged))
                simulation.resume(checkpoint)
            except (bm.InputError, bm.CheckpointError):
                refused += 1
            else:
                assert checkpoint == saved, (place, bit)
    assert refused > 7.9 * len(data)
    simulation.resume(saved)


@pytest.mark.parametrize("value", [bm.Soil(80e6, 0.33, 1900.0), bm.DofCombination([(3, 1.5), (0, -1.0)])])
def test_descriptions_pickle(value: object) -> None:
    assert repr(pickle.loads(pickle.dumps(value))) == repr(value)


def test_records_pickle() -> None:
    record = bm.el_centro_1940().scaled(1.7)
    copy = pickle.loads(pickle.dumps(record))
    assert same_bits(copy.accelerations, record.accelerations)
    assert same_bits(copy.displacements, record.displacements)


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_is_heard(rocking) -> None:
    steps = 1_000_000
    simulation = rocking(solver=bm.SolverOptions(expected_steps=steps))
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    begin = time.monotonic()
    timer.start()
    with warnings.catch_warnings(), pytest.raises(KeyboardInterrupt):
        warnings.simplefilter("error")
        simulation.run(steps, series=False)
    assert time.monotonic() - begin < 5.0
    reached = simulation.state.step
    assert 0 < reached < steps
    assert simulation.step().step == reached + 1


@pytest.mark.skipif(os.name == "nt", reason="no shell that ignores a signal")
def test_a_run_says_that_nobody_hears_ctrl_c() -> None:
    """As in a job that a script starts in the background."""
    program = """if True:
        import time, warnings
        import basemat as bm
        block = bm.RigidBlock(6.0, 9.0, 1000.0)
        ground = bm.SpringGround.under(block, 4, 1e8, 1e8)
        simulation = bm.Simulation(0.01, block, ground, bm.Bonded())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            simulation.run(10, observe=lambda state: time.sleep(0.02))
        print([str(own.message)[:28] for own in caught if own.category is bm.BasematWarning])
    """
    for trap, expected in (("trap '' INT;", "['Ctrl-C does not end this run']"), ("", "[]")):
        command = f'{trap} exec "$@"'
        # A child of a job in the background starts with SIGINT ignored and must not here.
        done = subprocess.run(
            ["sh", "-c", command, "sh", sys.executable, "-c", program],
            capture_output=True,
            text=True,
            check=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        assert done.stdout.strip() == expected


def test_progress_is_told_and_other_threads_run(rocking) -> None:
    told = []
    counted = [0]
    stop = threading.Event()

    def count() -> None:
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    simulation = rocking(solver=bm.SolverOptions(expected_steps=60_000))
    before = counted[0]
    simulation.run(60_000, progress=lambda done, steps: told.append((done, steps)), series=False)
    during = counted[0] - before
    stop.set()
    thread.join()
    assert told[-1] == (60_000, 60_000)
    assert all(first < second for first, second in zip(told, told[1:]))
    assert during > 10, "the GIL was held"


def test_progress_writes_a_line(rocking, capsys) -> None:
    rocking().run(50, progress=True)
    assert "50 of 50 steps (100 %)" in capsys.readouterr().err


def test_errors_have_classes_and_the_full_text(soil, rocking, tmp_path) -> None:
    with pytest.raises(bm.InputError, match="shear modulus of the soil is -1, but must be"):
        bm.Soil(-1.0, 0.3, 1900.0)
    with pytest.raises(ValueError, match="friction coefficient is NaN"):
        bm.Coulomb(float("nan"))
    with pytest.raises(bm.FileError, match="nowhere.AT2"):
        bm.Record.read(tmp_path / "nowhere.AT2", format="peer")
    bad = tmp_path / "bad.csv"
    bad.write_text("0.00 0.1\n0.01 0.2\n0.03 0.3\n")
    with pytest.raises(bm.FileError, match="bad.csv, line 3: time step is 0.02 s"):
        bm.Record.read(bad, unit="g")
    with pytest.raises(bm.InputError, match="more than one probe is called 'a'"):
        rocking(probes=[bm.Probe.displacement("a", 0), bm.Probe.displacement("a", 1)])
    with pytest.raises(bm.InputError, match="square"):
        bm.MatrixModel(np.ones((2, 3)), np.ones((2, 2)), [])
    with pytest.raises(bm.InputError, match="positive semi-definite"):
        bm.MatrixModel(
            -np.eye(3), np.zeros((3, 3)), bm.BaseNode.rigid_base(-1.0, 1.0, [0, 1, 2])
        )
    with pytest.raises(KeyError, match="roof"):
        rocking().run(3)["ruf"]
    for wrong in ({"structure": 3.0}, {"interface": 3.0}, {"motion": 3.0}):
        with pytest.raises(bm.InputError, match="float is no"):
            rocking(**wrong)
    assert issubclass(bm.InputError, bm.Error) and issubclass(bm.StepError, RuntimeError)


def test_a_step_that_fails_leaves_the_simulation_where_it_was(rocking) -> None:
    simulation = rocking(solver=bm.SolverOptions(flow_chart_iterations=1))
    with pytest.raises(bm.StepError) as raised:
        simulation.run(1000)
    assert raised.value.step == simulation.state.step + 1
    assert raised.value.time == pytest.approx(0.01 * raised.value.step)
    assert str(raised.value).startswith(f"step {raised.value.step} (t = ")
