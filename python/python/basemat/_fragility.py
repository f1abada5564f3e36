"""Fragility curves: lognormal distributions of capacities, by maximum likelihood, and their pictures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ._errors import InputError
from ._figures import axes_for, color_for, key, label_axes, results_in
from ._likelihood import fitted_normal
from ._normal import distribution

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray
    from pandas import DataFrame


@dataclass(frozen=True)
class Fragility:
    """Lognormal fragility curve: the probability that a demand exceeds its limit, over the intensity.

    `fragility` fits it to a table; ``Fragility(median, dispersion)`` is a curve by its numbers.

    Args:
        median: intensity at which the probability is 1/2, in the unit of the intensity measure.
        dispersion: standard deviation of the natural logarithm of the capacity, a number.
        log_median_error: standard error of the logarithm of the median, a number; NaN by default.
        dispersion_error: standard error of the dispersion, a number; NaN by default. Both by the observed information.
        intensities: intensities of the data, rising, in the same unit; empty by default.
        fractions: at these the fraction of the cases that exceed the limit; empty by default.
    """

    median: float
    dispersion: float
    log_median_error: float = math.nan
    dispersion_error: float = math.nan
    intensities: tuple[float, ...] = field(default=(), repr=False)
    fractions: tuple[float, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        for name in ("median", "dispersion"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value}, but must be positive and finite")

    def probability(self, intensity: ArrayLike) -> NDArray[np.float64]:
        """Probability that the demand exceeds its limit: array of the shape of ``intensity``, a number of 0 to 1.

        ``intensity``: numbers in the unit of the median, not negative.
        """
        values = np.asarray(intensity, dtype=float)
        if not (values >= 0.0).all():
            raise InputError("intensity must not be negative or NaN")
        with np.errstate(divide="ignore"):
            return distribution((np.log(values) - math.log(self.median)) / self.dispersion)

    def intensity_at(self, probability: float) -> float:
        """Intensity at which the ``probability``, between 0 and 1, is reached, in the unit of the median."""
        if not 0.0 < probability < 1.0:
            raise InputError(f"probability is {probability}, but must be between 0 and 1")
        return self.median * math.exp(self.dispersion * NormalDist().inv_cdf(probability))

    def plot(
        self,
        axes: Axes | None = None,
        *,
        quantity: str = "intensity",
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the curve over the intensity, with the fractions of the data as points; returns the axes.

        ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. ``quantity``: text of the
        intensity with its unit, such as "peak ground acceleration, m/s²". For several curves in the same axes: ``label``, a
        name of the curve, its median and dispersion unless given, and ``color``. ``title`` stands above the picture;
        None for none.
        """
        [panel] = axes_for(axes, 1, title, figsize=(7.0, 4.0))
        shown = color_for(color, results_in(panel))
        longest = max([self.intensity_at(0.99), *self.intensities])
        levels = np.linspace(0.0, longest, 400)
        name = f"median {self.median:.3g}, dispersion {self.dispersion:.2f}" if label is None else label
        panel.plot(levels, self.probability(levels), color=shown, label=name)
        if self.intensities:
            panel.plot(self.intensities, self.fractions, "o", color=shown, markersize=4.0)
        label_axes(panel, quantity, "probability of exceedance")
        panel.set_ylim(0.0, 1.02)
        panel.set_xlim(0.0, max(panel.get_xlim()[1], longest))
        key(panel)
        return panel


class Cases(NamedTuple):
    """Intensities, demands and records of the cases of a table."""

    intensities: NDArray[np.float64]
    demands: NDArray[np.float64]
    """Infinite for a failed case that counts as exceeding."""
    records: NDArray[Any]


def fragility(
    table: DataFrame,
    demand: str,
    limit: float,
    *,
    method: Literal["stripes", "capacities"] = "stripes",
    failed: Literal["refuse", "exceeds", "leave_out"] = "refuse",
) -> Fragility:
    """Fits a lognormal fragility curve to cases of records at intensities, by maximum likelihood.

    With "stripes" the number of cases that exceed the limit at each intensity is binomial; with "capacities" the
    intensity at which each record first exceeds the limit is lognormal, and records that never do have a capacity above
    their strongest case: Baker, "Efficient analytical fragility function fitting using dynamic structural analysis",
    Earthquake Spectra 31 (2015), 579–599, equations 11 and 8.

    Args:
        table: frame with the columns "record", "intensity" and the demand, as `multiple_stripes` and
            `incremental_dynamic_analysis` return it. Of several soils or frictions take the rows of one.
        demand: name of the column with the demands, not negative.
        limit: positive limit of the demand, in its unit.
        method: "stripes" by default, for which all records run at the same intensities; "capacities" for an incremental
            dynamic analysis. A capacity lies on the straight line between the two cases about the limit, the first of
            which may be zero at no intensity.
        failed: what a case with an error is: "refuse" raises an `InputError` (by default), "exceeds" counts it as above the
            limit, its capacity halfway to the case before, "leave_out" drops it.

    Returns:
        `Fragility`. Data that determine no dispersion raise an `InputError` that says which intensities are needed.
    """
    if not (math.isfinite(limit) and limit > 0.0):
        raise InputError(f"limit is {limit}, but must be positive and finite")
    cases = _cases(table, demand, failed)
    if method == "stripes":
        return _of_stripes(cases, limit)
    if method == "capacities":
        return _of_capacities(cases, limit)
    raise InputError(f"method is '{method}', but must be 'stripes' or 'capacities'")


def _cases(table: DataFrame, demand: str, failed: str) -> Cases:
    """Cases of a table without those that are left out."""
    for name in ("record", "intensity"):
        if name not in table:
            raise InputError(f"the table has no column '{name}': take one of multiple_stripes")
    if demand not in table:
        raise InputError(f"demand is '{demand}', but must be a column of the table: {', '.join(map(str, table.columns))}")
    if failed not in ("refuse", "exceeds", "leave_out"):
        raise InputError(f"failed is '{failed}', but must be 'refuse', 'exceeds' or 'leave_out'")
    has_failed = table["error"].notna().to_numpy() if "error" in table else np.zeros(len(table), dtype=bool)
    if has_failed.any() and failed == "refuse":
        raise InputError(
            f"{has_failed.sum()} of {len(table)} cases failed, the first with {table['error'][has_failed].iloc[0]}: mend them, "
            "or give failed='exceeds' or 'leave_out'"
        )
    demands = table[demand].to_numpy(dtype=float, copy=True)
    demands[has_failed] = math.inf
    intensities, records = table["intensity"].to_numpy(dtype=float), table["record"].to_numpy()
    if failed == "leave_out":
        kept = ~has_failed
        intensities, demands, records = intensities[kept], demands[kept], records[kept]
    if not len(demands):
        raise InputError("the table has no case with results")
    if np.isnan(demands).any():
        raise InputError(f"{np.isnan(demands).sum()} cases without an error have no '{demand}'")
    if (demands < 0.0).any():
        raise InputError(f"'{demand}' is negative in {(demands < 0.0).sum()} cases: give its magnitude")
    if not (np.isfinite(intensities) & (intensities > 0.0)).all():
        raise InputError("intensities of the table must be positive and finite")
    return Cases(intensities, demands, records)


def _of_stripes(cases: Cases, limit: float) -> Fragility:
    """Fit of the fractions at each intensity."""
    levels, places = np.unique(cases.intensities, return_inverse=True)
    counts = np.bincount(places, minlength=len(levels))
    exceeding = np.bincount(places, cases.demands > limit, minlength=len(levels))
    with_excess, without = levels[exceeding > 0], levels[exceeding < counts]
    if not len(with_excess) or not len(without):
        which = "no case exceeds" if not len(with_excess) else "all cases exceed"
        side = "stronger" if not len(with_excess) else "weaker"
        raise InputError(f"{which} the limit {limit:g}: {side} intensities are needed")
    if with_excess[0] >= without[-1]:
        raise InputError(
            f"all cases below the intensity {with_excess[0]:g} are within the limit {limit:g}, and all above "
            f"{without[-1]:g} exceed it: no dispersion follows. More intensities are needed between them, or more records"
        )
    falls = f"fewer cases exceed the limit {limit:g} at stronger intensities: no lognormal curve rises so"
    if with_excess[-1] <= without[0]:
        raise InputError(falls)
    logs = np.log(levels)
    points, signs = np.concatenate([logs, logs]), np.repeat([1.0, -1.0], len(logs))
    fit = fitted_normal(np.empty(0), points, signs, np.concatenate([exceeding, counts - exceeding]))
    if fit.deviation is None:
        raise InputError(falls)
    return _fragility(fit.mean, fit.deviation, fit.errors, levels, exceeding / counts)


def _of_capacities(cases: Cases, limit: float) -> Fragility:
    """Fit of the capacities of the records."""
    capacities, bounds = [], []
    for record in dict.fromkeys(cases.records.tolist()):
        chosen = cases.records == record
        order = np.argsort(cases.intensities[chosen], kind="stable")
        levels, demands = cases.intensities[chosen][order], cases.demands[chosen][order]
        if (np.diff(levels) == 0.0).any():
            raise InputError(f"record '{record}' has two cases at one intensity: take the rows of one scene")
        above = np.flatnonzero(demands > limit)
        if not len(above):
            bounds.append(float(levels[-1]))
            continue
        first = int(above[0])
        before, demand_before = (levels[first - 1], demands[first - 1]) if first else (0.0, 0.0)
        rise = demands[first] - demand_before
        fraction = (limit - demand_before) / rise if math.isfinite(rise) else 0.5
        capacities.append(float(before + fraction * (levels[first] - before)))
    if len(set(capacities)) < 2:
        raise InputError(
            f"{len(capacities)} of {len(capacities) + len(bounds)} records exceed the limit {limit:g}, but two with different "
            "capacities are needed: scale the records to stronger intensities"
        )
    log_bounds = np.log(bounds)
    fit = fitted_normal(np.log(capacities), log_bounds, np.full(len(bounds), -1.0), np.ones(len(bounds)))
    assert fit.deviation is not None
    capacities.sort()
    fractions = np.arange(1, len(capacities) + 1) / (len(capacities) + len(bounds))
    return _fragility(fit.mean, fit.deviation, fit.errors, np.array(capacities), fractions)


def _fragility(
    mean: float, deviation: float, errors: tuple[float, float], levels: NDArray[np.float64], fractions: NDArray[np.float64]
) -> Fragility:
    """Curve by the moments of the logarithm."""
    return Fragility(math.exp(mean), deviation, *errors, tuple(levels.tolist()), tuple(fractions.tolist()))


def plot_demands(
    table: DataFrame,
    demand: str,
    *,
    limit: float | None = None,
    factor: float = 1.0,
    quantity: str | None = None,
    intensity: str = "intensity",
    axes: Axes | None = None,
    title: str | None = None,
) -> Axes:
    """Draws the intensity over the demand for each record, and the median and 16 and 84 % of all; returns the axes.

    Args:
        table: frame of `multiple_stripes` or `incremental_dynamic_analysis`; failed cases are left out.
        demand: name of the column with the demands.
        limit: limit of the demand, in its unit, drawn as a line; none unless given.
        factor: factor on the demand in the picture, such as 1000 for mm; 1 by default.
        quantity: text of the demand with its unit in the picture; its name unless given.
        intensity: text of the intensity with its unit; "intensity" by default.
        axes: axes of matplotlib to draw into; unless given, axes of a new figure.
        title: text above the picture; none unless given.

    A record without a case at an intensity, as its demand was above the limit before, counts as above all others there.
    """
    cases = _cases(table, demand, "leave_out")
    [panel] = axes_for(axes, 1, title, figsize=(6.5, 4.5))
    names = dict.fromkeys(cases.records.tolist())
    for number, record in enumerate(names):
        chosen = cases.records == record
        order = np.argsort(cases.intensities[chosen], kind="stable")
        label = None if number else "records"
        line: dict[str, Any] = {"color": "#b0b0b0", "linewidth": 0.7, "marker": ".", "markersize": 3.0, "label": label}
        panel.plot(factor * cases.demands[chosen][order], cases.intensities[chosen][order], **line)
    levels = np.unique(cases.intensities)
    for fraction, style, text in ((0.16, ":", "16 and 84 %"), (0.5, "-", "median"), (0.84, ":", None)):
        path = _fractile(cases, levels, len(names), fraction)
        shown = np.isfinite(path)
        panel.plot(factor * path[shown], levels[shown], style, color="C0", label=text)
    if limit is not None:
        panel.axvline(factor * limit, color="C3", linewidth=0.8, linestyle="--", label="limit")
    label_axes(panel, demand if quantity is None else quantity, intensity)
    panel.set_xlim(left=0.0)
    panel.set_ylim(bottom=0.0)
    key(panel)
    return panel


def _fractile(cases: Cases, levels: NDArray[np.float64], count: int, fraction: float) -> NDArray[np.float64]:
    """Demand that a fraction of ``count`` records does not exceed at each level; infinite where these are too few."""
    found = []
    for level in levels:
        demands = np.sort(cases.demands[cases.intensities == level])
        # The inverse of the empirical distribution takes no mean with an infinite demand.
        place = max(math.ceil(fraction * count), 1) - 1
        found.append(float(demands[place]) if place < len(demands) else math.inf)
    return np.array(found)
