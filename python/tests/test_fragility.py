"""GOAL: records at levels of intensity, and fragility curves of their demands.
SCENE: demands in closed form by the peak of the record; blocks that slide.
REFERENCE: moments by hand, likelihoods maximised by SciPy, runs one by one.
"""

from __future__ import annotations

import concurrent.futures
import logging
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import basemat as bm
from basemat import _normal

pandas = pytest.importorskip("pandas")

FACTORS = {f"record {k}": 0.5 + 0.25 * k for k in range(6)}
"""Each record demands this times its peak, in m."""
SHAPE = [0.0, 1.0, -0.4, 0.2, 0.0]
RECORDS = {name: bm.Record(0.01, [factor * sample for sample in SHAPE]) for name, factor in FACTORS.items()}
LEVELS = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]


def demand_of(record: bm.Record) -> dict[str, float]:
    """A demand that grows with the record's length of path, as its samples do not after scaling to one peak."""
    return {"demand": record.peak_acceleration}


def by_arias(record: bm.Record) -> float:
    return math.sqrt(record.arias_intensity)


def table_of(rows: list[tuple[str, float, float]]) -> object:
    return pandas.DataFrame(rows, columns=["record", "intensity", "demand"])


def capacities_table(capacities: list[float], levels: list[float]) -> object:
    """Demands in proportion to the intensity, 1 at the capacity of each record."""
    return table_of([(f"{k}", level, level / capacity) for k, capacity in enumerate(capacities) for level in levels])


def test_the_normal_distribution_is_scipys() -> None:
    stats = pytest.importorskip("scipy.stats")
    x = np.concatenate([np.linspace(-60.0, 12.0, 1441), [-24.999, -25.0, -25.001]])
    np.testing.assert_allclose(_normal.distribution(x), stats.norm.cdf(x), rtol=1e-12, atol=1e-300)
    np.testing.assert_allclose(_normal.log_distribution(x), stats.norm.logcdf(x), rtol=2e-13)
    np.testing.assert_allclose(_normal.hazard(x), np.exp(stats.norm.logpdf(x) - stats.norm.logcdf(x)), rtol=2e-11)


def test_capacities_have_the_moments_of_their_logarithms() -> None:
    """Without bounds the maximum is in closed form, with standard errors σ/√n and σ/√(2n)."""
    capacities = [0.83, 1.1, 1.27, 1.9, 2.2, 2.75, 3.4]
    fit = bm.fragility(capacities_table(capacities, [1.0, 2.0, 4.0]), "demand", 1.0, method="capacities")
    logs = np.log(capacities)
    assert fit.median == pytest.approx(math.exp(logs.mean()), rel=1e-12)
    assert fit.dispersion == pytest.approx(logs.std(), rel=1e-12)
    assert fit.log_median_error == pytest.approx(logs.std() / math.sqrt(7.0), rel=1e-9)
    assert fit.dispersion_error == pytest.approx(logs.std() / math.sqrt(14.0), rel=1e-9)
    assert fit.intensities == pytest.approx(capacities) and fit.fractions == pytest.approx(np.arange(1, 8) / 7.0)


def maximum(log_likelihood: Callable[[float, float], float]) -> tuple[list[float], list[float]]:
    """Median and dispersion by SciPy, and the errors by differences of the likelihood."""
    optimize = pytest.importorskip("scipy.optimize")
    options = {"xatol": 1e-10, "fatol": 1e-13, "maxiter": 4000}
    found = optimize.minimize(
        lambda x: -log_likelihood(x[0], math.exp(x[1])), [0.5, -0.5], method="Nelder-Mead", options=options
    )
    mean, deviation, size = found.x[0], math.exp(found.x[1]), 1e-3
    steps, hessian = np.eye(2) * size, np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for one in (1.0, -1.0):
                for other in (1.0, -1.0):
                    moved = one * steps[i] + other * steps[j]
                    hessian[i, j] += one * other * log_likelihood(mean + moved[0], deviation + moved[1]) / (4.0 * size**2)
    errors = np.sqrt(np.diag(np.linalg.inv(-hessian)))
    return [math.exp(mean), deviation], errors.tolist()


@pytest.mark.parametrize("limit", [0.8, 1.0, 1.3])
def test_stripes_have_the_maximum_of_the_binomial_likelihood(limit: float) -> None:
    stats = pytest.importorskip("scipy.stats")
    rng = np.random.default_rng(5)
    table = table_of(
        [(f"{k}", level, level / 1.4 * math.exp(0.4 * rng.normal())) for k in range(30) for level in LEVELS]
    )
    fit = bm.fragility(table, "demand", limit)
    exceeding = np.array([np.sum(table["demand"][table["intensity"] == level] > limit) for level in LEVELS])

    def log_likelihood(mean: float, deviation: float) -> float:
        return float(stats.binom.logpmf(exceeding, 30, stats.norm.cdf((np.log(LEVELS) - mean) / deviation)).sum())

    expected, errors = maximum(log_likelihood)
    assert [fit.median, fit.dispersion] == pytest.approx(expected, rel=1e-6)
    assert [fit.log_median_error, fit.dispersion_error] == pytest.approx(errors, rel=1e-4)
    assert fit.fractions == pytest.approx(exceeding / 30.0) and list(fit.intensities) == LEVELS
    # The curve through these points, and back.
    np.testing.assert_allclose(fit.probability([0.0, fit.median]), [0.0, 0.5], atol=1e-15)
    assert fit.probability(fit.intensity_at(0.1)) == pytest.approx(0.1, rel=1e-12)


def test_records_that_never_exceed_bound_the_capacity() -> None:
    stats = pytest.importorskip("scipy.stats")
    capacities = [0.9, 1.2, 1.6, 2.1, 2.9, 3.7, 5.0]
    fit = bm.fragility(capacities_table(capacities, [1.0, 2.0, 3.0]), "demand", 1.0, method="capacities")
    exact = np.log(capacities[:5])

    def log_likelihood(mean: float, deviation: float) -> float:
        bounded = 2.0 * stats.norm.logsf((math.log(3.0) - mean) / deviation)
        return float(stats.norm.logpdf(exact, mean, deviation).sum() + bounded)

    expected, errors = maximum(log_likelihood)
    assert [fit.median, fit.dispersion] == pytest.approx(expected, rel=1e-6)
    assert [fit.log_median_error, fit.dispersion_error] == pytest.approx(errors, rel=1e-4)
    assert fit.fractions[-1] == pytest.approx(5.0 / 7.0)


def test_the_unit_of_the_intensity_scales_the_median_alone() -> None:
    table = capacities_table([0.9, 1.2, 1.6, 2.1, 2.9], [1.0, 1.7, 3.0])
    scaled = table.assign(intensity=1e4 * table["intensity"])
    for method in ("capacities", "stripes"):
        one, other = (bm.fragility(own, "demand", 1.0, method=method) for own in (table, scaled))  # type: ignore[arg-type]
        assert other.median == pytest.approx(1e4 * one.median, rel=1e-10)
        assert other.dispersion == pytest.approx(one.dispersion, rel=1e-9)
        assert other.dispersion_error == pytest.approx(one.dispersion_error, rel=1e-8)


@pytest.mark.parametrize(
    ("rows", "options", "text"),
    [
        ([("a", 1.0, 0.1), ("b", 2.0, 0.2)], {}, "no case exceeds the limit 1: stronger intensities"),
        ([("a", 1.0, 2.0), ("b", 2.0, 2.0)], {}, "all cases exceed the limit 1: weaker"),
        ([("a", 1.0, 0.1), ("a", 2.0, 2.0)], {}, "no dispersion follows"),
        ([("a", 1.0, 0.1), ("a", 2.0, 2.0), ("b", 2.0, 0.1), ("b", 3.0, 2.0)], {}, "no dispersion follows"),
        ([("a", 1.0, 2.0), ("b", 1.0, 2.0), ("a", 2.0, 0.1), ("b", 2.0, 2.0)], {}, "fewer cases exceed"),
        ([("a", 1.0, 0.1), ("a", 2.0, 2.0)], {"method": "capacities"}, "two with different capacities"),
        ([("a", 1.0, 0.1), ("a", 1.0, 2.0)], {"method": "capacities"}, "record 'a' has two cases at one intensity"),
        ([("a", 1.0, -0.1), ("a", 2.0, 2.0)], {}, "'demand' is negative in 1 cases: give its magnitude"),
        ([("a", 1.0, math.nan)], {}, "1 cases without an error have no 'demand'"),
        ([("a", 0.0, 0.1)], {}, "intensities of the table must be positive"),
        ([], {}, "no case with results"),
        ([("a", 1.0, 0.1)], {"method": "moments"}, "method is 'moments'"),
        ([("a", 1.0, 0.1)], {"failed": "ignore"}, "failed is 'ignore'"),
    ],
)
def test_data_that_determine_no_curve_are_refused(rows: list[tuple[str, float, float]], options: dict[str, str], text: str) -> None:
    with pytest.raises(bm.InputError, match=text):
        bm.fragility(table_of(rows), "demand", 1.0, **options)  # type: ignore[arg-type]


def test_failed_cases_are_refused_left_out_or_exceed() -> None:
    table = capacities_table([0.9, 1.2, 1.6, 2.1], [1.0, 2.0, 4.0])
    table["error"] = pandas.Series([None] * 11 + ["StepError: step 7"], dtype=object)
    table.loc[11, "demand"] = math.nan
    with pytest.raises(bm.InputError, match="1 of 12 cases failed, the first with StepError: step 7"):
        bm.fragility(table, "demand", 1.0, method="capacities")
    exceeds = bm.fragility(table, "demand", 1.0, method="capacities", failed="exceeds")
    # Halfway between 2, where it was within the limit, and 4.
    assert exceeds.intensities == pytest.approx([0.9, 1.2, 1.6, 3.0])
    left_out = bm.fragility(table, "demand", 1.0, method="capacities", failed="leave_out")
    assert left_out.intensities == pytest.approx([0.9, 1.2, 1.6]) and left_out.fractions[-1] == 0.75


def test_stripes_scale_each_record_to_each_intensity() -> None:
    table = bm.multiple_stripes(demand_of, RECORDS, LEVELS)
    assert list(table.columns) == ["record", "intensity", "demand", "warnings", "error"]
    assert list(table["record"][:6]) == ["record 0"] * 6 and len(table) == 36
    np.testing.assert_allclose(table["demand"], table["intensity"], rtol=1e-14)
    one, other = (bm.multiple_stripes(demand_of, RECORDS, [2.0], measure=measure) for measure in ("peak_velocity", by_arias))
    factors = [2.0 / record.peak_velocity * record.peak_acceleration for record in RECORDS.values()]
    np.testing.assert_allclose(one["demand"], factors, rtol=1e-12)
    factors = [2.0 / by_arias(record) * record.peak_acceleration for record in RECORDS.values()]
    np.testing.assert_allclose(other["demand"], factors, rtol=1e-12)
    spectral = bm.multiple_stripes(demand_of, RECORDS, [2.0], measure=0.3)
    ratios = [2.0 / record.response_spectrum([0.3], 0.05).pseudo_acceleration[0] for record in RECORDS.values()]
    np.testing.assert_allclose(spectral["demand"], np.multiply(ratios, [own.peak_acceleration for own in RECORDS.values()]))


@pytest.mark.parametrize(
    ("records", "levels", "measure", "text"),
    [
        ({}, [1.0], "peak_acceleration", "records must be a mapping"),
        ([RECORDS["record 0"]], [1.0], "peak_acceleration", "records must be a mapping"),
        ({"a": 3.0}, [1.0], "peak_acceleration", "record 'a' is float, but must be a Record or a dict"),
        ({"a": bm.Record(0.01, [0.0, 0.0])}, [1.0], "peak_acceleration", "record 'a' has the intensity 0"),
        (RECORDS, [2.0, 1.0], "peak_acceleration", "intensities are .*, but must be rising"),
        (RECORDS, [0.0, 1.0], "peak_acceleration", "positive and finite"),
        (RECORDS, [1.0], "pga", "measure is 'pga'"),
    ],
)
def test_records_and_levels_are_checked(records: object, levels: list[float], measure: object, text: str) -> None:
    with pytest.raises(bm.InputError, match=text):
        bm.multiple_stripes(demand_of, records, levels, measure=measure)  # type: ignore[arg-type]


class Softening:
    """A demand that grows from 1 m at the capacity of the record; it may fail or be interrupted at a case."""

    def __init__(self, fail_above: float = math.inf, interrupt_at: int = -1) -> None:
        self.fail_above, self.interrupt_at, self.calls = fail_above, interrupt_at, 0

    def __call__(self, record: bm.Record) -> dict[str, float]:
        self.calls += 1
        if self.calls == self.interrupt_at:
            raise KeyboardInterrupt
        if record.peak_acceleration > self.fail_above:
            raise ValueError("fell over")
        # Records of the same peak differ by their second sample.
        return {"demand": record.peak_acceleration * float(record.accelerations[2])}


RISING = {f"record {k}": bm.Record(0.01, [0.0, 1.0, 0.3 + 0.1 * k, -0.2]) for k in range(5)}


def test_an_incremental_analysis_stops_above_the_limit() -> None:
    make, done = Softening(), []
    table = bm.incremental_dynamic_analysis(
        make, RISING, LEVELS, "demand", 1.0, progress=lambda *numbers: done.append(numbers)
    )
    assert make.calls == len(table) < 30 and done[-1] == (30, 30) and sorted(done) == done
    # 1 = a² c with c = 0.3 to 0.7.
    for k in range(5):
        levels = table["intensity"][table["record"] == f"record {k}"]
        demands = table["demand"][table["record"] == f"record {k}"]
        assert list(levels) == LEVELS[: len(levels)] and (demands[:-1] <= 1.0).all() and demands.iloc[-1] > 1.0
        np.testing.assert_allclose(demands, (0.3 + 0.1 * k) * levels**2, rtol=1e-12)
    stripes = bm.multiple_stripes(Softening(), RISING, LEVELS)
    one, other = (bm.fragility(own, "demand", 1.0, method="capacities") for own in (table, stripes))
    assert one == other


def test_a_record_that_fails_is_not_scaled_further() -> None:
    table = bm.incremental_dynamic_analysis(Softening(fail_above=1.2), RISING, LEVELS, "demand", 1.0)
    assert table["error"].notna().sum() == 5 and table["intensity"].max() == 1.5
    assert set(table["error"].dropna()) == {"ValueError: fell over"}
    with pytest.raises(bm.Error, match="all 5 cases failed, the first of them with ValueError: fell over") as caught:
        bm.incremental_dynamic_analysis(Softening(fail_above=0.1), RISING, LEVELS, "demand", 1.0)
    assert len(caught.value.table) == 5  # type: ignore[attr-defined]
    with pytest.raises(bm.InputError, match="demand is 'drift', but must be one of the results: demand"):
        bm.incremental_dynamic_analysis(Softening(), RISING, LEVELS, "drift", 1.0)


def test_an_interrupted_analysis_goes_on(tmp_path: Path) -> None:
    whole = bm.incremental_dynamic_analysis(Softening(), RISING, LEVELS, "demand", 1.0)
    with pytest.raises(KeyboardInterrupt) as caught:
        bm.incremental_dynamic_analysis(Softening(interrupt_at=8), RISING, LEVELS, "demand", 1.0, folder=tmp_path / "ida")
    rows = caught.value.table  # type: ignore[attr-defined]
    assert rows["demand"].notna().sum() == 7
    make = Softening()
    with pytest.warns(bm.BasematWarning, match="7 of .* cases were read from .*ida and not run again"):
        resumed = bm.incremental_dynamic_analysis(make, RISING, LEVELS, "demand", 1.0, folder=tmp_path / "ida")
    assert make.calls == len(whole) - 7
    pandas.testing.assert_frame_equal(resumed, whole, check_exact=True)


def sliding(record: bm.Record) -> bm.Simulation:
    block = bm.RigidBlock(6.0, 3.0, 1000.0)
    return bm.Simulation(0.01, block, bm.SpringGround.under(block, 4, 1e8, 5e7), bm.Coulomb(0.25), motion=record)


def slip_of(run: bm.Run) -> dict[str, float]:
    return {"slip": run.mean_slip.magnitude}


MOTIONS = {
    f"{factor:g} times as long": bm.Record(factor * 0.02, bm.el_centro_1940().accelerations[:150]) for factor in (0.8, 1.0, 1.3)
}


# Records that are cut off.
@pytest.mark.filterwarnings("ignore::basemat.BasematWarning")
def test_processes_and_dask_have_the_runs_one_by_one(tmp_path: Path) -> None:
    options = {"duration": 3.0, "results": slip_of}
    levels = [1.0, 3.0, 6.0]
    table = bm.multiple_stripes(sliding, MOTIONS, levels, **options)  # type: ignore[arg-type]
    direct = [slip_of(sliding(record.scaled_to_peak(level)).run(duration=3.0)) for record in MOTIONS.values() for level in levels]
    np.testing.assert_allclose(table["slip"], [own["slip"] for own in direct], rtol=1e-9)
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        many = bm.multiple_stripes(sliding, MOTIONS, levels, executor=pool, file=tmp_path / "cases.csv", **options)  # type: ignore[arg-type]
    pandas.testing.assert_frame_equal(table, many, check_exact=True)
    distributed = pytest.importorskip("dask.distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path), silence_logs=logging.CRITICAL
    )
    with cluster, distributed.Client(cluster) as client:
        analysis = bm.incremental_dynamic_analysis(
            sliding, MOTIONS, levels, "slip", 0.01, executor=client, folder=tmp_path / "ida", **options  # type: ignore[arg-type]
        )
    rows = analysis.set_index(["record", "intensity"])["slip"]
    assert (rows == table.set_index(["record", "intensity"])["slip"].reindex(rows.index)).all() and len(rows) <= 9


def test_pictures_have_the_data() -> None:
    pytest.importorskip("matplotlib").use("agg")
    levels = [0.5, 1.0, 1.25, 1.5, 1.75, 2.0]
    table = bm.multiple_stripes(Softening(), RISING, levels)
    fit = bm.fragility(table, "demand", 1.0)
    axes = fit.plot(quantity="peak ground acceleration, m/s²")
    curve, points = axes.lines
    np.testing.assert_allclose(curve.get_ydata(), fit.probability(curve.get_xdata()))
    assert list(points.get_xdata()) == levels and axes.get_xlabel() == "peak ground acceleration, m/s²"
    assert fit.plot(axes, label="other") is axes and len({line.get_color() for line in axes.lines}) == 2
    analysis = bm.incremental_dynamic_analysis(Softening(), RISING, levels, "demand", 1.0)
    for own in (table, analysis):
        panel = bm.plot_demands(own, "demand", limit=1.0, factor=1e3, quantity="demand, mm")
        lines = {line.get_label(): line for line in panel.lines}
        assert {"records", "median", "16 and 84 %", "limit"} <= lines.keys() and len(panel.lines) == 9
        # The third of five records is the median.
        drawn = np.array(lines["median"].get_ydata())
        np.testing.assert_allclose(lines["median"].get_xdata(), 1e3 * 0.5 * drawn**2)
        assert list(lines["limit"].get_xdata()) == [1e3, 1e3]


COMPONENTS = {
    name: {"x": record, "y": bm.Record(0.01, [0.0, 0.6, 0.1, -0.3, 0.0]), "up": record.scaled(3.0)} for name, record in RECORDS.items()
}


def demands_of_components(record: dict[str, bm.Record]) -> dict[str, float]:
    bm.triaxial(**record)
    return {f"demand {name}": component.peak_acceleration for name, component in record.items()}


def test_components_of_a_record_have_one_factor() -> None:
    table = bm.multiple_stripes(demands_of_components, COMPONENTS, LEVELS)
    # The intensity is the geometric mean of both horizontal components.
    means = np.sqrt(table["demand x"] * table["demand y"])
    np.testing.assert_allclose(means, table["intensity"], rtol=1e-13)
    np.testing.assert_allclose(table["demand up"], 3.0 * table["demand x"], rtol=1e-13)
    ratios = table["demand y"] / table["demand x"]
    unscaled = [0.6 / COMPONENTS[name]["x"].peak_acceleration for name in table["record"]]
    np.testing.assert_allclose(ratios, unscaled, rtol=1e-13)
    spectral = bm.multiple_stripes(demands_of_components, COMPONENTS, [2.0], measure=0.3)
    for name, demand in zip(spectral["record"], spectral["demand x"]):
        ordinates = [COMPONENTS[name][axis].response_spectrum([0.3], 0.05).pseudo_acceleration[0] for axis in "xy"]
        peak = COMPONENTS[name]["x"].peak_acceleration
        assert demand == pytest.approx(2.0 * peak / math.sqrt(ordinates[0] * ordinates[1]), rel=1e-12)
    largest = bm.multiple_stripes(
        demands_of_components, COMPONENTS, [2.0], measure=lambda record: max(own.peak_acceleration for own in record.values())
    )
    np.testing.assert_allclose(largest["demand up"], 2.0, rtol=1e-13)
    analysis = bm.incremental_dynamic_analysis(demands_of_components, COMPONENTS, LEVELS, "demand x", 1.2)
    assert len(analysis) < len(table) and (analysis.groupby("record")["demand x"].max() > 1.2).any()
    for records, text in (
        ({"a": {"up": RECORDS["record 0"]}}, "record 'a' has no horizontal component"),
        ({"a": {}}, "record 'a' has no horizontal component"),
        ({"a": {"x": 3.0}}, "component 'x' of record 'a' is float, but must be a Record"),
    ):
        with pytest.raises(bm.InputError, match=text):
            bm.multiple_stripes(demands_of_components, records, [1.0])  # type: ignore[type-var]
