"""Records, waves and their files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import basemat as bm

SOIL = bm.Soil(80.0e6, 0.25, 1900.0)


def test_units_and_integrals() -> None:
    time = np.arange(0.0, 2.0, 0.01)
    values = np.sin(np.pi * time)
    record = bm.Record(0.01, values)
    np.testing.assert_allclose(record.velocities, (1.0 - np.cos(np.pi * time)) / np.pi, atol=1e-4)
    np.testing.assert_allclose(
        record.displacements, (time - np.sin(np.pi * time) / np.pi) / np.pi, atol=1e-4
    )
    for unit, factor in {"g": 9.80665, "gal": 0.01, "ft/s²": 0.3048, "mm/s²": 1e-3}.items():
        scaled = bm.Record(0.01, values, unit=unit)
        np.testing.assert_allclose(scaled.accelerations, factor * values, rtol=1e-15)
    assert bm.Record(1, [0, 1, 0]).duration == 2.0
    with pytest.raises(bm.InputError, match="no unit of acceleration 'yd'"):
        bm.Record(0.01, values, unit="yd")


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "columns.csv"
    path.write_text("t,a\n0.00,0.0\n0.01,0.1\n0.02,-0.2\n")
    record = bm.Record.read(path, unit="g")
    np.testing.assert_allclose(record.accelerations, [0.0, 0.980665, -1.96133], rtol=1e-15)
    assert record.time_step == 0.01
    np.testing.assert_allclose(
        bm.Record.read(str(path), unit="m/s²", columns=(1, 2)).accelerations, [0.0, 0.1, -0.2]
    )
    (tmp_path / "one.txt").write_text("1.0\n2.0\n3.0\n")
    one = bm.Record.read(tmp_path / "one.txt", unit="gal", time_step=0.02)
    np.testing.assert_allclose(one.accelerations, [0.01, 0.02, 0.03], rtol=1e-15)
    peer = tmp_path / "record.AT2"
    peer.write_text(
        "PEER NGA\nSomewhere\nACCELERATION TIME SERIES IN UNITS OF G\n"
        "NPTS=   4, DT=   .0050 SEC\n 0.0 0.1\n 0.2 -0.1\n"
    )
    read = bm.Record.read(peer, format="peer")
    np.testing.assert_allclose(read.accelerations / 9.80665, [0.0, 0.1, 0.2, -0.1], rtol=1e-15)
    assert read.time_step == 0.005


def test_files_of_agencies(tmp_path: Path) -> None:
    knet = tmp_path / "knet.csv"
    knet.write_text(
        "#Station Code,XXX001\n#Sampling Freq(Hz),100\n#Time,NS,EW,UD\n"
        "23:59:59.99,0.10,0.20,0.30\n00:00:00.00,0.11,0.21,0.31\n00:00:00.01,0.12,0.22,0.32\n"
    )
    record = bm.Record.read(knet, format="k_net_csv", channel=2)
    np.testing.assert_allclose(record.accelerations, [0.002, 0.0021, 0.0022], rtol=1e-15)
    assert record.time_step == 0.01
    station = bm.Record.read_all(knet, format="k_net_csv")
    assert list(station) == ["NS", "EW", "UD"]
    np.testing.assert_array_equal(station["EW"].accelerations, record.accelerations)
    by_columns = bm.Record.read(knet, unit="gal")
    np.testing.assert_array_equal(by_columns.accelerations, station["NS"].accelerations)

    three = tmp_path / "three.txt"
    three.write_text("Station 7\nPGA 0.32\n0.1 0.2 0.3\n0.11 0.21 0.31\n0.12 0.22 0.32\n")
    # The default pair, given: the second column is that of the acceleration.
    for column in [2, 3]:
        read = bm.Record.read(three, unit="g", time_step=0.01, columns=(1, column), header_lines=2)
        wanted = 9.80665 * (np.array([0.0, 0.01, 0.02]) + 0.1 * column)
        np.testing.assert_allclose(read.accelerations, wanted, rtol=1e-14)
    everything = bm.Record.read_all(three, unit="g", time_step=0.01, header_lines=2)
    assert list(everything) == ["column 1", "column 2", "column 3"]
    with pytest.raises(bm.FileError, match="more than one line of header, give their number"):
        bm.Record.read(three, unit="g", time_step=0.01, columns=(1, 2))
    with pytest.raises(bm.FileError, match="number of columns is 3, but must be 1"):
        bm.Record.read(three, unit="g", time_step=0.01, header_lines=2)

    for options, message in [
        ({"format": "peer", "unit": "m/s²"}, "files of the format 'peer' are in g"),
        ({"format": "esm", "channel": 2}, "take no `channel`"),
        ({"format": "afad", "columns": (1, 2)}, "take no `columns`"),
        ({"format": "smc", "time_step": 0.01}, "take no `time_step`"),
        ({"unit": "g", "channel": 2}, "give `columns`"),
        ({"format": "miniseed"}, "must be 'columns', 'along_lines', 'peer'"),
    ]:
        with pytest.raises(bm.InputError, match=message):
            bm.Record.read(three, **options)  # type: ignore[arg-type]


def test_values_along_lines(tmp_path: Path) -> None:
    values = np.round(np.sin(0.3 * np.arange(43)) + 0.1 * np.cos(np.arange(43)), 6)
    lines = [values[k : k + 8] for k in range(0, 43, 8)]
    path = tmp_path / "series.txt"
    path.write_text("\n".join(" ".join(f"{value:.6f}" for value in line) for line in lines))
    with pytest.raises(bm.FileError, match="along_lines"):
        bm.Record.read(path, unit="g", time_step=0.01)
    with pytest.raises(bm.FileError, match="line 6: number of columns is 3, but must be 8"):
        bm.Record.read(path, unit="g", time_step=0.01, columns=(1, 1))
    full = tmp_path / "full.txt"
    full.write_text("\n".join(path.read_text().splitlines()[:5]))
    with pytest.raises(bm.FileError, match="8 numbers a line, which may be one series"):
        bm.Record.read(full, unit="g", time_step=0.01, columns=(1, 1))
    assert len(bm.Record.read(full, unit="g", time_step=0.01, columns=(1, 1), samples=5)) == 5
    record = bm.Record.read(path, format="along_lines", unit="m/s²", time_step=0.01)
    np.testing.assert_array_equal(record.accelerations, values)

    cards = tmp_path / "cards.txt"
    rows = ["".join(f"{value:9.6f}" for value in line).ljust(72) + f"{k:8d}" for k, line in enumerate(lines, 1)]
    cards.write_text("\n".join(rows))
    options = {"format": "along_lines", "unit": "m/s²", "time_step": 0.01}
    with pytest.raises(bm.FileError):
        bm.Record.read(cards, **options)  # type: ignore[arg-type]
    read = bm.Record.read(cards, layout="8F9.6", samples=43, **options)  # type: ignore[arg-type]
    np.testing.assert_array_equal(read.accelerations, values)
    slist = tmp_path / "slist.txt"
    head = "TIMESERIES XX_A_00_HNE_D, 43 samples, 50 sps, 2020-01-01T00:00:00.000000, SLIST, FLOAT, M/S**2\n"
    slist.write_text(head + path.read_text())
    read = bm.Record.read(slist, format="slist")
    np.testing.assert_array_equal(read.accelerations, values)
    assert read.time_step == 0.02
    for options, message in [
        ({"format": "along_lines", "unit": "g"}, "give `time_step`"),
        ({"format": "along_lines", "time_step": 0.01}, "give `unit`"),
        ({"format": "along_lines", "unit": "g", "time_step": 0.01, "columns": (1, 1)}, "have no `columns`"),
        ({"unit": "g", "layout": "8F9.6"}, "takes no `layout`"),
        ({"format": "peer", "samples": 3}, "take no `samples`"),
        ({"format": "along_lines", "unit": "g", "time_step": 0.01, "layout": "8X"}, "Fortran format"),
    ]:
        with pytest.raises(bm.InputError, match=message):
            bm.Record.read(path, **options)  # type: ignore[arg-type]


def test_treatments() -> None:
    record = bm.el_centro_1940()
    assert len(record) == 1560
    assert record.scaled(2.0).peak_acceleration == 2.0 * record.peak_acceleration
    assert record.scaled_to_peak(5.0).peak_acceleration == pytest.approx(5.0, rel=1e-15)
    assert record.resampled(0.005).time_step == 0.005
    rest = record.with_baseline("rest_to_rest", degree=5)
    assert abs(rest.velocities[-1]) < 1e-10 and abs(rest.displacements[-1]) < 1e-9
    assert record.padded(1.0, 2.0).duration == pytest.approx(record.duration + 3.0)
    begin, end = record.significant_times()
    assert 0.0 < begin < end < record.duration
    tapered = record.tapered(1.0, 1.0)
    assert tapered.accelerations[0] == 0.0
    spectrum = record.response_spectrum([0.5], damping=0.05)
    assert spectrum.pseudo_acceleration[0] / 9.80665 == pytest.approx(0.9187, abs=1e-4)
    with pytest.raises(bm.InputError, match="no baseline treatment 'straight', only none"):
        record.with_baseline("straight")


def test_free_fields() -> None:
    record = bm.el_centro_1940()
    both = bm.vertical_incidence(record, record.scaled(0.5))
    right, up = both.displacement(0.0, 3.0)
    assert up == pytest.approx(0.5 * right) and right != 0.0
    assert bm.vertical_incidence(vertical=record).displacement(0.0, 3.0)[0] == 0.0
    wave = bm.travelling_wave(record, 800.0, -5.0)
    assert wave.displacement(3.0, 2.01)[0] == pytest.approx(wave.displacement(-5.0, 2.0)[0])
    pulse = bm.ricker(0.1, 0.05, 0.5)
    assert pulse.displacement(0.0, 0.5) == [0.1, 0.0]
    assert bm.ricker(0.1, 0.05, 0.5, vertical=True).displacement(0.0, 0.5) == [0.0, 0.1]
    sv = bm.PlaneWave.sv(SOIL, np.radians(20.0))
    assert sv.apparent_velocity == pytest.approx(SOIL.shear_wave_speed / np.sin(np.radians(20.0)))
    right, up = sv.field_from_horizontal(record, -10.0).displacement(-10.0, 5.0)
    assert up / right == pytest.approx(-0.41535, abs=1e-5)
    assert sv.reversed().apparent_velocity == -sv.apparent_velocity
    # The Rayleigh wave of a quarter's Poisson ratio runs with 0.9194 of the shear wave's speed.
    ratio = bm.PlaneWave.rayleigh(SOIL).apparent_velocity / SOIL.shear_wave_speed
    assert ratio == pytest.approx(0.91940, abs=1e-5)


def test_inclined_waves_without_layers_are_plane_waves() -> None:
    profile = bm.SoilProfile([], SOIL)
    wave = bm.InclinedWave.sv(profile, np.radians(20.0))
    record = bm.el_centro_1940()
    field = wave.field(record, -5.0)
    plane = bm.PlaneWave.sv(SOIL, np.radians(20.0)).field_from_horizontal(record, -5.0)
    for time in (1.0, 2.5, 6.0):
        expected = plane.displacement(2.0, time)
        assert field.displacement(2.0, time) == pytest.approx(expected, rel=1e-3, abs=1e-5)


def test_there_and_back_through_a_site() -> None:
    layers = [bm.SoilLayer(bm.Soil.from_shear_wave_speed(200.0, 0.35, 1900.0), 15.0)]
    rock = bm.Soil.from_shear_wave_speed(1000.0, 0.25, 2300.0)
    column = bm.SoilColumn(bm.SoilProfile(layers, rock))
    random = np.random.default_rng(23)
    pulse = np.zeros(301)
    pulse[150:180] = 1.0
    for samples in (random.uniform(-1.0, 1.0, 777), pulse, [1.0, 0.0]):
        bare = bm.Record(0.01, samples)
        with pytest.warns(UserWarning, match="is cut off: up to .* % of its peak before .* give the record quiet time"):
            column.to_surface(bare)
        # Without damping the layer rings long.
        record = bare.padded(25.0, 120.0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            back = column.from_surface(column.to_surface(record))
        error = np.abs(back.accelerations - record.accelerations).max()
        assert error < 1e-9 * record.peak_acceleration


def test_a_motion_that_runs_turns_a_long_base(rocking) -> None:
    record = bm.vertical_incidence(vertical=bm.el_centro_1940().scaled(0.3))
    still = rocking(interface=bm.Bonded(), motion=record).run(300)
    running = rocking(interface=bm.Bonded(), motion=bm.travelling_wave(record, 300.0, -3.0)).run(
        300
    )
    assert still.base_rotation.magnitude < 1e-9 < 1e-5 < running.base_rotation.magnitude
    # A function of x and time does the same.
    own = rocking(interface=bm.Bonded(), motion=bm.free_field(displacement=record.displacement))
    np.testing.assert_allclose(own.run(300)["normal_force"], still["normal_force"], rtol=1e-12)


def shaking(time: float) -> float:
    """A sine of 2 Hz that begins and ends gently, m/s²."""
    return 3.0 * np.sin(4.0 * np.pi * time) * np.sin(np.pi * time / 4.0) ** 2


def test_functions_say_whether_they_return_displacement_or_acceleration(rocking) -> None:
    """A function alone is refused; the same motion, given as either, shakes alike."""
    for refused in (
        lambda: rocking(motion=lambda x, time: (shaking(time), 0.0)),
        lambda: bm.travelling_wave(lambda x, time: (0.0, 0.0), 300.0, 0.0),
    ):
        with pytest.raises(bm.InputError, match=r"free_field\(displacement=function\)"):
            refused()
    record = bm.Record(0.01, [shaking(time) for time in 0.01 * np.arange(401)])
    field = bm.free_field(acceleration=shaking, time_step=0.01, duration=4.0)
    for time in (0.0, 0.013, 1.0, 4.0, 7.5):
        assert field.displacement(3.0, time) == record.displacement(3.0, time)
        assert field.velocity(3.0, time) == record.velocity(3.0, time)
    expected = rocking(motion=record).run()
    found = rocking(motion=field).run()
    assert found.end == expected.end == 4.0
    assert (found["base_shear"] == expected["base_shear"]).all()
    # Twice integrated by hand: the sine's product is three cosines.
    numbers = [(1.5, 4.0 * np.pi), (-0.75, 4.5 * np.pi), (-0.75, 3.5 * np.pi)]

    def moved(x: float, time: float) -> float:
        return sum(a * (time / w - np.sin(w * time) / w**2) for a, w in numbers)

    for time in (0.5, 1.7, 3.9):
        assert moved(0.0, time) == pytest.approx(record.displacement(0.0, time)[0], rel=2e-3)
    own = rocking(motion=bm.free_field(displacement=moved)).run(400)
    scale = expected.base_shear.magnitude
    np.testing.assert_allclose(own["base_shear"], expected["base_shear"], atol=0.02 * scale)


def test_functions_of_both_directions_and_their_mistakes() -> None:
    both = bm.free_field(
        acceleration=lambda time: np.array([shaking(time), 0.5 * shaking(time)]),
        time_step=0.01,
        duration=4.0,
    )
    right, up = both.displacement(0.0, 3.0)
    assert up == pytest.approx(0.5 * right, rel=1e-12) and right != 0.0
    assert bm.free_field(displacement=lambda x, t: 2.0 * x).displacement(3.0, 1.0) == [6.0, 0.0]
    sampled = {"time_step": 0.01, "duration": 1.0}
    for text, arguments in {
        "one of them": {},
        "one of them ": {"displacement": shaking, "acceleration": shaking},
        "give its time_step and duration": {"acceleration": shaking},
        "are those of an acceleration": {"displacement": shaking, "duration": 1.0},
        "displacement is of the type float": {"displacement": 3.0},
        "acceleration returned 'a', but must": {"acceleration": lambda time: "a", **sampled},
        "acceleration returned \\(0.0, 0.0, 0.0\\)": {
            "acceleration": lambda time: (0.0,) * 3,
            **sampled,
        },
        "time step of the record is 0": {"acceleration": shaking, "time_step": 0, "duration": 1.0},
        "acceleration of the record is not finite: entry 0 is NaN": {"acceleration": lambda t: np.nan, **sampled},
    }.items():
        with pytest.raises(bm.InputError, match=text.strip()):
            bm.free_field(**arguments)
    with pytest.raises(ZeroDivisionError):
        bm.free_field(acceleration=lambda time: 1 / 0, **sampled)
    with pytest.raises(bm.InputError, match="motion's displacement returned None"):
        bm.free_field(displacement=lambda x, time: None).displacement(0.0, 1.0)


def test_a_filter_adds_the_quiet_time_that_its_text_says() -> None:
    record = bm.el_centro_1940()
    filtered = record.high_pass(0.2)
    assert filtered.duration == pytest.approx(record.duration + 2.0 * 1.5 * 4.0 / 0.2, abs=0.05)
    assert "1.5 ``order / corner`` s is added before and after" in " ".join(bm.Record.high_pass.__doc__.split())
