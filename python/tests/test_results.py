"""Results travel, are saved, become frames and pictures; nothing of a simulation is lost."""

from __future__ import annotations

import concurrent.futures
import pickle
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

PERIODS = bm.log_spaced(0.05, 2.0, 12)


@pytest.fixture
def run(rocking) -> bm.Run:
    probe = bm.Probe.displacement("way", 0)
    roof = bm.Probe.acceleration("roof", 2)
    simulation = rocking(0.3, probes=[roof, probe], service_limits=bm.ServiceLimits(slip=1e-3))
    return simulation.run(500, contact_every=5, motion_every=10)


def numbers(value: object) -> list[object]:
    """All that a result says of itself."""
    names = [
        name for name, own in vars(type(value)).items() if not name.startswith("_") and not callable(own)
    ]
    return [(name, getattr(value, name)) for name in names]


def same(one: object, other: object) -> bool:
    if isinstance(one, np.ndarray):
        kind = np.uint64 if one.dtype == float else np.uint8
        return np.array_equal(np.ascontiguousarray(one).view(kind), np.ascontiguousarray(other).view(kind))
    if isinstance(one, dict):
        return list(one) == list(other) and all(same(one[key], other[key]) for key in one)  # type: ignore[call-overload, index]
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))  # type: ignore[arg-type]
    if type(one).__module__ == "basemat":
        return type(one) is type(other) and all(map(same, numbers(one), numbers(other)))
    return one == other or (one != one and other != other)


def test_results_pickle_to_the_same_bits(run: bm.Run, rocking) -> None:
    spectrum = run.floor_spectrum("roof", PERIODS)
    ground = bm.ElasticGround(bm.Soil(80e6, 0.33, 1900.0), bm.Strip(-3.0, 3.0, 6))
    refinement = bm.refine(2, 0.1, lambda n, step: 1.0 + step**2 + n**-2.0)
    assert run.contact["gap"].any() and run.motion["velocity"].any()
    for value in (
        run,
        rocking().run(20, series=False),
        run.energy_balance,
        run.base_shear,
        run.uplifted_fraction,
        run.foundations[0],
        run.serviceability[0],
        spectrum,
        ground.impedances([1.0, 2.0]),
        refinement,
    ):
        copy = pickle.loads(pickle.dumps(value))
        assert type(copy) is type(value) and repr(copy) == repr(value)
        if value is run or not isinstance(value, bm.Run):
            assert same(copy, value), value
    state = rocking().state.foundations[0]
    assert same(pickle.loads(pickle.dumps(state)), state)
    copy = pickle.loads(pickle.dumps(run))
    assert str(copy) == str(run) and copy.summary() == run.summary()
    assert same_bits(copy.floor_spectrum("roof", PERIODS).acceleration, spectrum.acceleration)


def made(friction: float) -> bm.Run:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    ground = bm.ElasticGround.under(bm.Soil(80.0e6, 0.33, 1900.0), block, 4)
    return bm.Simulation(0.01, block, ground, bm.Coulomb(friction), motion=bm.el_centro_1940()).run(200)


def test_runs_come_back_from_other_processes() -> None:
    with concurrent.futures.ProcessPoolExecutor(1) as executor:
        [run] = executor.map(made, [0.3])
    assert same_bits(run["base_shear"], made(0.3)["base_shear"])


def test_a_run_is_saved_and_loaded(run: bm.Run, tmp_path: Path) -> None:
    path = tmp_path / "shaken.run"
    run.save(path)
    assert same(bm.load(str(path)), run)
    data = path.read_bytes()
    heading, _, rest = data.partition(b"\n")
    for damaged, reason in (
        (data[:-1], "damaged"),
        (data[:200] + bytes([data[200] ^ 1]) + data[201:], "damaged"),
        (data.replace(b"basemat ", b"basemat 9", 1), "is of version 9"),
        (b"nothing\n" + rest, "no file of a run"),
        (b"", "no file of a run"),
    ):
        path.write_bytes(damaged)
        with pytest.raises(bm.FileError, match=reason):
            bm.load(path)
    with pytest.raises(bm.FileError, match="cannot be read"):
        bm.load(tmp_path / "none")
    with pytest.raises(bm.FileError, match="cannot be written"):
        run.save(tmp_path / "none" / "run")


def test_damaged_bytes_are_refused_or_a_result() -> None:
    """Nothing that a pickle holds makes the package panic."""
    run = made(0.3)
    _, (kind, data) = run.__reduce__()  # type: ignore[misc]
    rng = np.random.default_rng(1)
    refused = 0
    for _ in range(300):
        damaged = bytearray(data)
        damaged[rng.integers(len(damaged))] ^= 1 << rng.integers(8)
        cut = bytes(damaged[: rng.integers(len(damaged))] if rng.random() < 0.3 else damaged)
        try:
            found = bm._core._restored(kind, cut)
            found.summary(), found.envelope, str(found), found.series, found.energy_balances
        except bm.InputError:
            refused += 1
    assert 50 < refused < 300
    with pytest.raises(bm.InputError, match="kind is 'Mesh'"):
        bm._core._restored("Mesh", b"")


def test_a_run_is_the_summary_of_its_base(rocking) -> None:
    run = rocking().run(300)
    [foundation] = run.foundations
    assert isinstance(run, bm.Summary) and not isinstance(foundation, bm.Run)
    for name in set(run.series) - {"time"} - set(run.probes):
        values, found = run[name], run.extremes(name)
        if not np.isnan(values).all():
            assert [found.lowest.value, found.highest.value] == [np.nanmin(values), np.nanmax(values)], name
    for own in (run, foundation):
        assert own.extremes("mean_slip") == own.mean_slip and own.ends == run.ends
        assert own.slip_path == run.slip_path > 0.0
    with pytest.raises(bm.InputError, match="no quantity 'shear'"):
        run.extremes("shear")
    with pytest.raises(bm.InputError, match="'twist' in this run, only base_shear, .*overturning_safety$"):
        run.extremes("twist")  # of a run in plan
    for ask in (lambda: run.floor_spectrum("rof", [0.1]), lambda: run.acceleration_record("rof")):
        with pytest.raises(bm.InputError, match="no probe 'rof', only roof"):
            ask()


def test_arrays_and_grids_for_other_programs(run: bm.Run, block: bm.RigidBlock, tmp_path: Path) -> None:
    run.save_npz(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as arrays:
        assert same(arrays["base_shear_n_per_m"], run["base_shear"]) and same(arrays["roof_m_per_s2"], run["roof"])
        assert same(arrays["contact_gap_m"], run.contact["gap"])
        assert list(arrays["contact_mode_words"]) == bm.MODES
    assert run.save_paraview(tmp_path, "base") == 101
    assert run.save_paraview(tmp_path, "block", block, height=9.0) == 101 + 51
    assert len(list(tmp_path.glob("block_base_*.vtu"))) == 101
    grid = ElementTree.parse(tmp_path / "base_base_0060.vtu")
    cells = {own.get("Name"): own.text for own in grid.iterfind(".//CellData/DataArray")}
    assert [float(own) for own in (cells["pressure"] or "").split()] == run.contact["pressure"][60].tolist()
    with pytest.raises(bm.InputError, match="give the height of the box"):
        run.save_paraview(tmp_path, "block", block)
    with pytest.raises(bm.InputError, match="base: give `contact_every` to `run`"):
        ground = bm.SpringGround.under(block, 4, 1e8, 5e7)
        bm.Simulation(0.01, block, ground, bm.Bonded()).run(2).save_paraview(tmp_path, "x")


@pytest.mark.parametrize("kind", ["frame", "building", "plan"])
def test_structures_have_shapes(kind: str, tmp_path: Path) -> None:
    springs = (1e9, 5e8)
    if kind == "frame":
        mesh = bm.Mesh.layered_block(-2.0, 2.0, 4, [bm.Layer(6.0, 3, bm.Material(30e9, 0.2, 2400.0))])
        structure: bm.Structure = bm.FemModel(mesh)
        points = 5 * 4
    elif kind == "building":
        structure, points = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 40e6)] * 3), 2 * 4
    else:
        mat = bm.RigidBody.cuboid(8.0, 6.0, 1.0, 2400.0)
        structure = bm.StoreyBuilding(mat, [bm.PlanStorey(3.0, 2e4, (8.0, 6.0), (4e7, 4e7, 1e9))])
        points = 2 * 4
    ground = bm.SpringGround.under(structure, 4, *springs)
    run = bm.Simulation(0.01, structure, ground, bm.Bonded()).run(4, motion_every=2, warn=False)
    assert run.save_paraview(tmp_path, kind, structure) == 3
    piece = ElementTree.parse(tmp_path / f"{kind}_0002.vtu").find(".//Piece")
    assert piece is not None and piece.get("NumberOfPoints") == str(points)


def test_frames_have_units(run: bm.Run) -> None:
    pytest.importorskip("pandas")
    frame = run.to_frame()
    assert frame.attrs["units"] == {name: run.units[name] for name in ["time", *frame.columns]}
    assert frame.attrs["units"]["roof"] == "m/s²" and frame.attrs["units"]["base_moment"] == "N·m/m"
    contact = run.contact_frame()
    assert contact.attrs["units"]["pressure"] == "Pa" and contact.attrs["units"]["mode"] == ""
    envelope = run.envelope_frame()
    assert len(envelope) == 8 and envelope.attrs["units"]["open"] == "s"
    assert same(envelope["gap"].to_numpy(), run.envelope["gap"])
    assert envelope["gap_time"].max() <= run.end and envelope.attrs["units"]["gap_time"] == "s"
    foundations = run.foundation_frame()
    assert foundations["base_shear"][0] == run.foundations[0].base_shear.largest.value
    assert foundations["sliding_safety"][0] == run.foundations[0].least_sliding_safety.value
    scalars = [name for name in run.series if name not in ("time", *run.probes)]
    assert [name for name in foundations if name in scalars] == scalars
    energies = run.energy_frame()
    assert same(energies["soil"].to_numpy(), run.energy_balances["soil"])
    assert energies.attrs["units"]["soil"] == "J/m" and energies.attrs["units"]["residual"] == ""
    spectra = run.floor_spectra(PERIODS, 0.02)
    assert list(spectra.columns) == ["roof"] and spectra.attrs["units"]["roof"] == "m/s²"
    assert same(spectra["roof"].to_numpy(), run.floor_spectrum("roof", PERIODS, 0.02).acceleration)
    assert run.floor_spectra([0.5, 1.0], probes=["roof"]).index.tolist() == [0.5, 1.0]
    ground = bm.ElasticGround(bm.Soil(80e6, 0.33, 1900.0), bm.Strip(-3.0, 3.0, 6))
    impedances = ground.impedances([1.0, 2.0])
    frame = impedances.to_frame()
    assert same(frame["rocking"].to_numpy(), impedances.rocking)
    assert frame.attrs["units"] == {
        "frequency": "Hz", "horizontal": "N/m²", "vertical": "N/m²", "rocking": "N", "coupling": "N/m"
    }  # fmt: skip


class Counting:
    """A block in Python with a force of its own, zero, that counts what it commits."""

    dofs = 3

    def __init__(self, block: bm.RigidBlock) -> None:
        self.mass, self.stiffness = block.mass, block.stiffness
        self.base = block.base
        self.committed = 0.0

    def force(self, u):
        return np.zeros(3)

    def tangent(self, u):
        return np.zeros((3, 3))

    def commit(self, u) -> None:
        self.committed += 1.0

    def save(self):
        return [self.committed]

    def restore(self, values) -> None:
        [self.committed] = values


def test_the_structure_keeps_its_state(rocking, block: bm.RigidBlock) -> None:
    own = Counting(block)
    simulation = rocking(0.3, structure=own, probes=[])
    # The static state.
    assert simulation.structure is not own and type(simulation.structure) is Counting
    assert simulation.structure.committed == 1.0
    simulation.run(50)
    assert own.committed == 0.0 and simulation.structure.committed == 51.0
    simulation.reset()
    assert simulation.structure.committed == 1.0
    assert rocking().structure is block


def test_pictures_have_labels_and_units(run: bm.Run) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    shear, modes, energy = run.plot()
    assert shear.get_ylabel() == "base shear, kN/m" and energy.get_xlabel() == "time, s"
    [line] = shear.get_lines()
    assert same(np.asarray(line.get_ydata()), 1e-3 * run["base_shear"])
    [mesh] = modes.collections
    assert np.array_equal(mesh.get_array(), run.contact["mode"].T)
    found = {text.get_text() for text in modes.get_legend().get_texts()}
    assert found == {bm.MODES[mode] for mode in np.unique(run.contact["mode"])}
    labels = {text.get_text() for text in energy.get_legend().get_texts()}
    assert {"input", "soil", "kinetic"} <= labels
    assert len(made(0.3).plot()) == 2
    assert run.plot_modes(pyplot.subplots()[1]).get_ylabel() == "x, m"
    with pytest.raises(ValueError, match="axes are 2, but must be 3"):
        run.plot([shear, energy])
    pair = bm.StructureGroup([(bm.RigidBlock(2.0, 3.0, 1000.0), x) for x in (-4.0, 4.0)])
    ground = bm.SpringGround.under(pair, 2, 1e8, 5e7)
    own = bm.Simulation(0.01, pair, ground, bm.Coulomb(0.3)).run(4, contact_every=1)
    [drawn] = own.plot_modes().collections
    assert np.isnan(np.ma.filled(drawn.get_array(), np.nan)).all(axis=1).tolist() == [0, 0, 1, 0, 0]
    moving = run.animate()
    moving._draw_was_started = True
    for frame in (0, 40, 100):
        gap, slip, pressure, _, clock = moving._func(frame)
    for line, factor, name in ((gap, 1e3, "gap"), (slip, 1e3, "slip"), (pressure, 1e-3, "pressure")):
        np.testing.assert_allclose(line.get_ydata()[::3], factor * run.contact[name][100], rtol=1e-12)
    assert clock.get_text() == f"{run.contact['time'][100]:.2f} s"
    axes = run.floor_spectrum("roof", PERIODS).plot()
    assert axes.get_xlabel() == "period, s" and "m/s²" in axes.get_ylabel()
    # A second result in the same axes has a colour of its own, and room.
    higher = bm.el_centro_1940().scaled(20.0).response_spectrum(PERIODS, 0.05)
    higher.plot(axes, label="higher", title="two")
    first, _, second, _ = axes.get_lines()
    assert first.get_color() != second.get_color() and axes.get_title(loc="left") == "two"
    assert axes.get_ylim()[1] > higher.acceleration.max() and axes.get_ylim()[0] == 0.0
    soft, hard = bm.Soil(30e6, 0.33, 1900.0), bm.Soil(800e6, 0.3, 2000.0)
    profile = bm.SoilProfile([bm.SoilLayer(soft, 4.0), bm.SoilLayer(hard, 6.0)], hard)
    [line] = profile.plot().get_lines()
    speeds = [soft.shear_wave_speed] * 2 + [hard.shear_wave_speed] * 4
    assert list(line.get_xdata()) == speeds
    assert list(line.get_ydata()) == [0.0, 4.0, 4.0, 10.0, 10.0, 12.0] and line.axes.get_ylim() == (12.0, 0.0)
    assert [layer.thickness for layer in profile.layers] == [4.0, 6.0]
    assert profile.layers[0].soil == soft and profile.bedrock == hard
    rigid = bm.SoilProfile([bm.SoilLayer(soft, 4.0)])
    assert rigid.bedrock is None and rigid.plot().get_legend() is not None
    ground = bm.ElasticGround(soft, bm.Strip(-3.0, 3.0, 6))
    axes = ground.impedances([1.0, 2.0, 3.0]).plot()
    assert [own.get_ylabel() for own in axes] == [
        "horizontal, N/m²", "vertical, N/m²", "rocking, N", "coupling, N/m"
    ]  # fmt: skip
    pyplot.close("all")
    for value in (run, profile, run.energy_balance):
        html = value._repr_html_()
        assert html.startswith("<") and "<" not in re_text(html)


def test_every_energy_term_is_an_attribute(run: bm.Run) -> None:
    terms = run.energy_balance.to_dict()
    assert terms["input"] > 0.0
    for name, value in terms.items():
        assert same(getattr(run.energy_balance, name), value), name


def re_text(html: str) -> str:
    """A page without its tags."""
    import re

    return re.sub(r"<[^<>]*>", "", html)


def test_without_matplotlib_pictures_say_what_they_need(monkeypatch, run: bm.Run) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match="need matplotlib: pip install matplotlib$"):
        run.plot()
