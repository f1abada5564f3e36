"""Records scaled to levels of an intensity measure: multiple stripes and incremental dynamic analysis."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Literal, TypeVar, Union

import numpy as np

from ._core import Record, Run
from ._errors import BasematWarning, InputError
from ._frames import pandas
from ._sweep import raise_if_all_failed, sweep, swept, teller

if TYPE_CHECKING:
    from pandas import DataFrame

Motion = TypeVar("Motion", Record, Dict[str, Record])
"""A record, or a dict of the components of one by their names."""
Measure = Union[Literal["peak_acceleration", "peak_velocity"], float, Callable[[Motion], float]]
"""Intensity measure of a record: a peak by its name, the period of a spectral acceleration, or a function."""
_UPWARDS = ("up", "vertical")
"""Names of components that do not count for the intensity, as `triaxial` and `vertical_incidence` call them."""
_DAMPING = 0.05
"""Damping ratio of spectral accelerations, as hazard maps have them."""
_COLUMNS = ("record", "intensity", "warnings", "error")
"""Columns that every table has."""


class ScaledRecords:
    """Function of a record's name and an intensity that makes the simulation of a case; it pickles."""

    def __init__(self, make: Callable[[Any], Any], records: Mapping[str, Any], measure: Measure[Any]) -> None:
        self.make, self.records = make, dict(records)
        self.record_intensities = {name: intensity_of(record, measure, name) for name, record in self.records.items()}

    def __call__(self, record: str, intensity: float) -> Any:
        """What ``make`` returns for the scaled record, whose components have one factor."""
        motion, factor = self.records[record], intensity / self.record_intensities[record]
        if isinstance(motion, Record):
            return self.make(motion.scaled(factor))
        return self.make({name: component.scaled(factor) for name, component in motion.items()})


def intensity_of(record: Any, measure: Measure[Any], name: str) -> float:
    """Intensity of a record as it is, which must be positive."""
    components = record if isinstance(record, Mapping) else {None: record}
    for key, component in components.items():
        if not isinstance(component, Record):
            place = f"record '{name}'" if key is None else f"component '{key}' of record '{name}'"
            needed = "a Record or a dict of Records" if key is None else "a Record"
            raise InputError(f"{place} is {type(component).__name__}, but must be {needed}")
    if callable(measure):
        intensity = float(measure(record))
    else:
        horizontal = [component for key, component in components.items() if key not in _UPWARDS]
        if not horizontal:
            raise InputError(f"record '{name}' has no horizontal component: its intensity needs a function as the measure")
        intensities = [component_intensity(component, measure) for component in horizontal]
        # The geometric mean, which grows with the factor of all components.
        intensity = float(np.prod(intensities)) ** (1.0 / len(intensities))
    if not (math.isfinite(intensity) and intensity > 0.0):
        raise InputError(f"record '{name}' has the intensity {intensity:g}, but must have a positive one to be scaled")
    return intensity


def component_intensity(record: Record, measure: Union[str, float]) -> float:
    """Peak or spectral acceleration of one component."""
    if measure == "peak_acceleration":
        return record.peak_acceleration
    if measure == "peak_velocity":
        return record.peak_velocity
    if isinstance(measure, str):
        raise InputError(f"measure is '{measure}', but must be peak_acceleration, peak_velocity, a period (s) or a function")
    return float(record.response_spectrum([float(measure)], _DAMPING).pseudo_acceleration[0])


def checked_levels(records: Mapping[str, Any], intensities: Sequence[float]) -> list[float]:
    """Intensities in rising order; errors for what is no set of records or levels."""
    if not isinstance(records, Mapping) or not records:
        raise InputError("records must be a mapping of names to records, with one record at least")
    for name in records:
        if not isinstance(name, str):
            raise InputError(f"a record has the name {name!r}, but must have a text")
    levels = [float(intensity) for intensity in intensities]
    if not levels or sorted(set(levels)) != levels:
        raise InputError(f"intensities are {levels}, but must be rising numbers, one at least")
    if not (levels[0] > 0.0 and math.isfinite(levels[-1])):
        raise InputError(f"intensities are from {levels[0]:g} to {levels[-1]:g}, but must be positive and finite")
    return levels


def multiple_stripes(
    make: Callable[[Motion], Any],
    records: Mapping[str, Motion],
    intensities: Sequence[float],
    *,
    measure: Measure[Motion] = "peak_acceleration",
    duration: float | None = None,
    results: Callable[[Run], Mapping[str, Any]] | None = None,
    jobs: int | None = None,
    executor: Any = None,
    progress: bool | Callable[[int, int], Any] = False,
    file: str | os.PathLike[str] | None = None,
) -> DataFrame:
    """Runs a scene under all records, each scaled to all intensities; a pandas frame with one row per case.

    Args:
        make: ``make(record)`` returns a `Simulation` under the scaled record, or what else `sweep` takes.
        records: names and their `Record`, or of each the components: a dict of `Record`, such as ``{"x": …, "y": …, "up": …}``,
            which are scaled with one factor and come to ``make`` as such a dict, for ``triaxial(**record)``.
        intensities: levels of the intensity measure, rising, in its unit.
        measure: intensity measure of a record, which grows with the record's factor: "peak_acceleration" (m/s²; by
            default), "peak_velocity" (m/s), a number for the pseudo-acceleration at this period (s) at 5 % of damping
            (m/s²), or a function of a `Record` or of a dict of components. Without a function it is the geometric mean of the
            components but those called "up" or "vertical".
        duration: how long to run (s); the record's length unless given.
        results: columns of a row, from its run; `Run.summary` unless given.
        jobs: threads; one unless given, all processors for 0.
        executor: instead, any executor of ``concurrent.futures`` or a ``Client`` of Dask, as for `sweep`; none unless given.
        progress: True for a line on stderr, or a function ``(cases done, cases in all)``; False by default.
        file: path of a file that stores each case, from which the same call goes on, as for `sweep`; none unless given. It
            does not store the records: delete it after a change of these.

    Returns:
        Frame as `sweep` returns it, with the parameters "record" and "intensity", for `fragility` and `plot_demands`.
    """
    levels = checked_levels(records, intensities)
    grid = {"record": list(records), "intensity": levels}
    scaled = ScaledRecords(make, records, measure)
    return sweep(
        scaled, grid, duration=duration, results=results, jobs=jobs, executor=executor, progress=progress, file=file
    )


def incremental_dynamic_analysis(
    make: Callable[[Motion], Any],
    records: Mapping[str, Motion],
    intensities: Sequence[float],
    demand: str,
    limit: float,
    *,
    measure: Measure[Motion] = "peak_acceleration",
    duration: float | None = None,
    results: Callable[[Run], Mapping[str, Any]] | None = None,
    jobs: int | None = None,
    executor: Any = None,
    progress: bool | Callable[[int, int], Any] = False,
    folder: str | os.PathLike[str] | None = None,
) -> DataFrame:
    """Runs a scene under each record at rising intensities until a demand exceeds its limit; a pandas frame.

    A record whose case fails is not scaled further. The cases of one intensity run together.

    Args:
        make: ``make(record)`` returns a `Simulation` under the scaled record, or what else `sweep` takes.
        records: names and their `Record`, or a dict of the components of each, as for `multiple_stripes`.
        intensities: levels of the intensity measure, rising, in its unit.
        demand: name of the result that is compared with the limit, such as "slip" of ``results``.
        limit: positive limit of the demand, in its unit. A record is not scaled further once its demand is above.
        measure: intensity measure, "peak_acceleration" (m/s²) by default, as for `multiple_stripes`.
        duration: how long to run (s); the record's length unless given.
        results: columns of a row, from its run; `Run.summary` unless given.
        jobs: threads; one unless given, all processors for 0.
        executor: instead, any executor of ``concurrent.futures`` or a ``Client`` of Dask, as for `sweep`; none unless given.
        progress: True for a line on stderr, or a function ``(cases done, cases in all)``; False by default. Cases that
            need not run count as done.
        folder: path of a folder with a file for each intensity, from which the same call goes on after an interrupt; none
            unless given. Delete it after a change of ``make`` or the records.

    Returns:
        Frame with the columns "record", "intensity", those of the results, ``warnings`` and ``error``, in the order of the
        intensities, for `fragility` with ``method="capacities"`` and `plot_demands`. An exception that ends the analysis
        has the rows so far as its attribute ``table``.
    """
    levels = checked_levels(records, intensities)
    if not limit > 0.0:
        raise InputError(f"limit is {limit}, but must be positive")
    scaled, active = ScaledRecords(make, records, measure), list(records)
    tell = teller(progress, len(records) * len(levels))
    tables: list[DataFrame] = []
    read_cases = 0
    for number, level in enumerate(levels):
        if not active:
            break
        done_before = number * len(records) + len(records) - len(active)
        tell_level = _shifted(tell, done_before)
        file = None if folder is None else Path(folder, f"intensity_{level:g}.csv")
        grid = {"record": active, "intensity": [level]}
        options = (None, duration, results)
        try:
            table, read = swept(scaled, grid, options, jobs, executor, tell_level, None, file)
        except BaseException as error:
            error.table = _joined([*tables, getattr(error, "table", None)])  # type: ignore[attr-defined]
            raise
        tables.append(table)
        read_cases += read
        if number == 0:
            raise_if_all_failed(table, "" if folder is None else f"; delete the folder {os.fspath(folder)} to run them again")
        active = _records_within_limit(table, demand, limit)
    tell(len(records) * len(levels))
    joined = _joined(tables)
    if read_cases:
        text = f"{read_cases} of {len(joined)} cases were read from {os.fspath(folder or '')} and not run again"
        warnings.warn(f"{text}: delete the folder after a change of the model", BasematWarning, stacklevel=2)
    return joined


def _shifted(tell: Callable[[int], Any], done_before: int) -> Callable[[int, int], Any]:
    """The progress of one level, of which ``done_before`` cases of all levels are done before."""
    return lambda done, _: tell(done_before + done)


def _records_within_limit(table: DataFrame, demand: str, limit: float) -> list[str]:
    """Records of a table whose case ran and stayed within the limit."""
    runs = table[table["error"].isna()]
    if len(runs) and demand not in runs:
        names = ", ".join(name for name in runs if name not in _COLUMNS)
        raise InputError(f"demand is '{demand}', but must be one of the results: {names}")
    return [str(name) for name, value in zip(runs["record"], runs.get(demand, ())) if not value > limit]


def _joined(tables: Sequence[Any]) -> Any:
    """One frame of all levels, with ``warnings`` and ``error`` last."""
    rows = [row for table in tables if table is not None for row in table.to_dict("records")]
    names = list(dict.fromkeys(name for row in rows for name in row if name not in _COLUMNS))
    columns = [*_COLUMNS[:2], *names]
    frame = pandas().DataFrame({name: [row.get(name) for row in rows] for name in columns})
    for name in _COLUMNS[2:]:
        frame[name] = pandas().Series([row.get(name) for row in rows], dtype=object)
    return frame
