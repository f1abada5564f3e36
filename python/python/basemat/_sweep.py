"""Many cases of one scene: a row of a table for each."""

from __future__ import annotations

import itertools
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from . import _case_file, _core, _dask
from ._case import Outcome, described
from ._core import Run
from ._errors import BasematWarning, Error, InputError
from ._executors import Ended, run_by, run_in_threads, run_in_turn
from ._frames import pandas
from ._progress import Line

if TYPE_CHECKING:
    from pandas import DataFrame

_OWN = ("warnings", "error")
"""Columns that every table has."""

Grid = list[tuple[str, list[Any]]]
"""Names and values of parameters."""


def parameters_of(grid: Any) -> Grid | None:
    """Names and values of a grid that is a mapping."""
    if not isinstance(grid, Mapping):
        return None
    for name, values in grid.items():
        # A text by itself would be a case for each letter.
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise InputError(f"grid: {name} is {values!r}, but must be a list of values")
    return [(name, list(values)) for name, values in grid.items()]


def cases_of(grid: Any, parameters: Grid | None) -> list[dict[str, Any]]:
    """The cases of a grid: of parameters all combinations, the last name fastest; of a frame its rows; a list as it is."""
    if parameters is None:
        grid = grid.to_dict("records") if isinstance(grid, pandas().DataFrame) else grid
        if isinstance(grid, str) or not all(isinstance(case, Mapping) for case in grid):
            raise InputError(f"grid is {grid!r}, but must be names with lists of values, or a list of cases, each a mapping")
        return [dict(case) for case in grid]
    names = [name for name, _ in parameters]
    values = [values for _, values in parameters]
    return [dict(zip(names, combination)) for combination in itertools.product(*values)]


def sweep(
    make: Callable[..., Any],
    grid: Any,
    *,
    steps: int | None = None,
    duration: float | None = None,
    results: Callable[[Run], Mapping[str, Any]] | None = None,
    jobs: int | None = None,
    executor: Any = None,
    progress: bool | Callable[[int, int], Any] = False,
    shard: tuple[int, int] | None = None,
    file: str | os.PathLike[str] | None = None,
) -> DataFrame:
    """Runs a scene for every case of a grid; a pandas frame with one row per case.

    Args:
        make: ``make(**case)`` returns a `Simulation` (which is then run), a `Run`, or
            a mapping of results. What it raises goes into the row's ``error``, as does a result
            with the name of a parameter, "warnings" or "error"; others go on.
        grid: names and values, ``{"friction": [0.2, 0.3], "peak": [1.0, 2.0]}``, of which all
            combinations are made, the last name fastest; or a list of cases, each a mapping; or a frame with a row
            for each case. No parameter is called "warnings" or "error".
        steps, duration: how long to run a simulation (s); the record's length unless given.
        results: columns of a row, from its run; `Run.summary` unless given.
        jobs: threads (the GIL is released while steps are made); one unless given, all processors
            for 0.
        executor: instead, any executor of ``concurrent.futures``, or a ``Client`` of Dask; ``make`` and
            what it returns must pickle. Cases of a process that dies run again in others.
        progress: True for a line on stderr, or a function ``(cases done, cases in all)``; cases that were read from
            ``file`` count as done.
        shard: ``(index, of)``: only case ``index`` and every ``of``-th one after it, from 0; the
            frame's index has the numbers of the cases. All cases unless given.
        file: path of a file of comma-separated values to which each case is added when it ends, in "cases.csv.part" until
            all are there. After an interrupt or a crash the same call reads the cases that are there, failed ones
            too, with a `BasematWarning`, and runs the others; delete both files after a change of ``make``. Processes that
            write the same file wait for each other. `merge` and Rust's sweeps read it, and pandas below its first line,
            a check sum: ``read_csv(file, skiprows=1)``. The grid must be a mapping to numbers or texts, and results must be
            numbers. None unless given.

    Returns:
        Frame with the columns of the parameters, of the results, ``warnings`` (missing, or the texts of
        `Run.warnings`) and ``error`` (missing, or its text), rows in the order of the cases; ``isna()`` finds the
        missing ones.

    Raises an `Error` with the text of the first case's error if all cases failed. It and every other exception that ends a
    sweep, Ctrl-C included, have the rows so far as their attribute ``table``.
    """
    table, read = swept(make, grid, (steps, duration, results), jobs, executor, progress, shard, file)
    if read:
        text = f"{read} of {len(table)} cases were read from {os.fspath(file or '')} and not run again"
        warnings.warn(f"{text}: delete the file after a change of the model", BasematWarning, stacklevel=2)
    stored = "" if file is None else f"; delete {os.fspath(file)}, which has their rows, to run them again"
    raise_if_all_failed(table, stored)
    return table


def raise_if_all_failed(table: DataFrame, advice: str) -> None:
    """Raises an `Error` with the first case's error and the ``table`` if no case of it has results."""
    if len(table) and table["error"].notna().all():
        error = Error(f"all {len(table)} cases failed, the first of them with {table['error'].iloc[0]}{advice}")
        error.table = table  # type: ignore[attr-defined]
        raise error


def swept(
    make: Callable[..., Any],
    grid: Any,
    options: tuple[Any, ...],
    jobs: int | None,
    executor: Any,
    progress: bool | Callable[[int, int], Any],
    shard: tuple[int, int] | None,
    file: str | os.PathLike[str] | None,
) -> tuple[DataFrame, int]:
    """Frame of a sweep, and the number of its rows that were read from the file; all cases may have failed.

    ``options``: steps, duration and results of `sweep`. An exception that ends the sweep has the rows so far.
    """
    pandas()
    given = parameters_of(grid)
    cases = cases_of(grid, given)
    numbers = _shard(range(len(cases)), shard)
    if file is not None:
        # Before anything runs.
        if given is None:
            raise InputError("file: the grid is a list, but must be a mapping of names to values")
        _core._case_numbers(given, shard)
    parameters = list(dict.fromkeys(name for number in numbers for name in cases[number]))
    for name in _OWN:
        if name in parameters:
            raise InputError(f"a parameter is called {name!r}, as a column of every table")
    found: dict[int, Outcome] = {}
    with ExitStack() as stack:
        stored = None
        if file is not None and given is not None:
            stack.enter_context(_case_file.alone(file))
            stored = _core._CaseFile(file, given, shard)
            found.update(_case_file.outcomes_of(stored.rows()))
        read = len(found)
        missing = [number for number in numbers if number not in found]
        tell = teller(progress, len(numbers))
        taken = {*parameters, *_OWN}

        def ended(place: int, outcome: Outcome) -> None:
            number = missing[place]
            found[number] = _distinct(outcome, taken)
            if stored is not None:
                _case_file.append(stored, number, found[number])
            tell(len(found))

        try:
            _run([cases[number] for number in missing], make, options, jobs, executor, ended)
            if stored is not None:
                found = _case_file.outcomes_of(stored.finish())
        except BaseException as error:
            error.table = _frame(cases, parameters, found, numbers)  # type: ignore[attr-defined]
            raise
    return _frame(cases, parameters, found, numbers), read


def _run(
    cases: Sequence[dict[str, Any]],
    make: Callable[..., Any],
    options: tuple[Any, ...],
    jobs: int | None,
    executor: Any,
    ended: Ended,
) -> None:
    """Runs cases in this thread, on threads, or by the caller's executor."""
    arguments = [(make, case, *options) for case in cases]
    if _dask.is_client(executor):
        _dask.run(executor, make, cases, options, ended)
    elif executor is not None:
        run_by(executor, arguments, ended)
    elif jobs is None or jobs == 1:
        run_in_turn(arguments, ended)
    else:
        run_in_threads(arguments, jobs or os.cpu_count() or 1, ended)


def merge(
    files: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    grid: Mapping[str, Any],
) -> DataFrame:
    """Puts the files of a sweep's shards together; a pandas frame with one row per case.

    Args:
        files: path of a file that `sweep` or a sweep in Rust wrote, or a list of such paths,
            which hold every case of the grid once.
        grid: names and values of the whole sweep, a mapping as for `sweep`.

    Returns:
        Frame as `sweep` returns it: columns of the parameters, of the results, ``warnings`` and ``error``,
        rows in the order of the cases. A file that was cut off or changed, and cases that are there
        twice or not at all, raise a `FileError`.
    """
    paths = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    parameters = parameters_of(grid)
    if parameters is None:
        raise InputError("grid is a list, but must be a mapping of names to values")
    found = _case_file.outcomes_of(_core._merge_cases(paths, parameters))
    return _frame(cases_of(grid, parameters), [name for name, _ in parameters], found, range(len(found)))


def _shard(numbers: range, shard: tuple[int, int] | None) -> range:
    """Numbers of the cases of a shard."""
    if shard is None:
        return numbers
    index, of = shard
    if not 0 <= index < of:
        raise InputError(f"shard is {shard}, but must be (index, of) with 0 ≤ index < of")
    return numbers[index::of]


def teller(progress: bool | Callable[[int, int], Any], count: int) -> Callable[[int], Any]:
    """Function of the number of cases done, for the ``progress`` of a sweep of ``count`` cases."""
    if callable(progress):
        return lambda done: progress(done, count)
    if progress:
        line = Line("cases")
        return lambda done: line(done, count)
    return lambda done: None


def _distinct(outcome: Outcome, taken: set[str]) -> Outcome:
    """The outcome, or an error if one of its results has the name of another column."""
    clash = next((name for name in outcome[0] if name in taken), None)
    if clash is None:
        return outcome
    return {}, None, described(ValueError(f"a result has the name of another column, {clash!r}"))


def _frame(
    cases: Sequence[Mapping[str, Any]], parameters: Sequence[str], found: Mapping[int, Outcome], numbers: range
) -> Any:
    """Frame of the cases with these numbers: parameters, results, warnings, error; what a row lacks is None."""
    outcomes: list[Outcome] = [found.get(number, ({}, None, None)) for number in numbers]
    table: dict[str, list[Any]] = {name: [cases[number].get(name) for number in numbers] for name in parameters}
    for name in dict.fromkeys(name for results, *_ in outcomes for name in results):
        table[name] = [results.get(name) for results, *_ in outcomes]
    frame = pandas().DataFrame(table, index=numbers)
    # Texts are objects: a column of texts of pandas 3 makes NaN of None.
    for place, name in enumerate(_OWN, 1):
        frame[name] = pandas().Series([outcome[place] for outcome in outcomes], index=numbers, dtype=object)
    return frame
