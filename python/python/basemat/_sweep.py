"""Many cases of one scene: a row of a table for each."""

from __future__ import annotations

import itertools
import math
import os
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import (
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from typing import TYPE_CHECKING, Any

from . import _core, _dask
from ._case import Outcome, described, run_case
from ._core import Run
from ._errors import InputError
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
    """The cases of a grid: of parameters all combinations, the last name fastest; a list as it is."""
    if parameters is None:
        return [dict(case) for case in grid]
    names = [name for name, _ in parameters]
    values = [values for _, values in parameters]
    return [dict(zip(names, combination)) for combination in itertools.product(*values)]


def _run_in_thread(cancelled: threading.Event, *arguments: Any) -> Outcome:
    """A case whose runs end once ``cancelled`` is set."""
    _core._cancel_when(cancelled)
    try:
        return run_case(*arguments)
    finally:
        _core._cancel_when(None)


def _outcome(future: Future[Any]) -> Outcome | BrokenExecutor:
    """Outcome of a case, or the error of a pool one of whose workers died before it could report one."""
    # A wait without end would not hear Ctrl-C everywhere.
    while not wait([future], timeout=0.2).done:
        pass
    try:
        outcome: Outcome = future.result()
        return outcome
    except (KeyboardInterrupt, SystemExit):
        raise
    except BrokenExecutor as error:
        return error
    except BaseException as error:  # Cancelled futures of Dask are no Exception.
        return {}, None, described(error)


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
            combinations are made, the last name fastest; or a list of cases, each a mapping. No
            parameter is called "warnings" or "error".
        steps, duration: how long to run a simulation (s); the record's length unless given.
        results: columns of a row, from its run; `Run.summary` unless given.
        jobs: threads (the GIL is released while steps are made); one unless given, all processors
            for 0.
        executor: instead, any executor of ``concurrent.futures``, or a ``Client`` of Dask; ``make`` and
            what it returns must pickle. Cases of a process that dies run again in others.
        progress: True for a line on stderr, or a function ``(cases done, cases in all)``.
        shard: ``(index, of)``: only case ``index`` and every ``of``-th one after it, from 0; the
            frame's index has the numbers of the cases. All cases unless given.
        file: path of a file of comma-separated values that is written when all cases are done, as
            Rust's sweeps write it: `merge` and Rust read it, and pandas below its first line, a check
            sum: ``read_csv(file, skiprows=1)``. The grid must be a mapping to numbers or texts, and
            results must be numbers. If it cannot be written, the frame is the attribute ``table`` of
            the error. None unless given.

    Returns:
        Frame with the columns of the parameters, of the results, ``warnings`` (missing, or the texts of
        `Run.warnings`) and ``error`` (missing, or its text), rows in the order of the cases; ``isna()`` finds the
        missing ones.
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
    cases = [cases[number] for number in numbers]
    parameters = list(dict.fromkeys(name for case in cases for name in case))
    for name in _OWN:
        if name in parameters:
            raise InputError(f"a parameter is called {name!r}, as a column of every table")
    tell = _teller(progress, len(cases))
    arguments = [(make, case, steps, duration, results) for case in cases]
    if _dask.is_client(executor):
        outcomes = _dask.outcomes(executor, make, cases, (steps, duration, results), tell)
    elif executor is not None:
        outcomes = _submitted(executor, arguments, tell)
    elif jobs is None or jobs == 1:
        outcomes = []
        for own in arguments:
            outcomes.append(run_case(*own))
            tell(len(outcomes))
    else:
        outcomes = _in_threads(arguments, jobs or os.cpu_count() or 1, tell)
    taken = {*parameters, *_OWN}
    outcomes = [_distinct(own, taken) for own in outcomes]
    table = _frame(_table(cases, parameters, outcomes), numbers)
    if file is not None and given is not None:
        try:
            _save(file, given, shard, outcomes)
        except Exception as error:
            error.table = table  # type: ignore[attr-defined]
            raise
    return table


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
        Frame with the columns of the parameters, of the results and ``error`` (None, or its text),
        rows in the order of the cases. A file that was cut off or changed, and cases that are there
        twice or not at all, raise a `FileError`.
    """
    paths = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    parameters = parameters_of(grid)
    if parameters is None:
        raise InputError("grid is a list, but must be a mapping of names to values")
    columns, outcomes = _core._merge_cases(paths, parameters)
    found: list[Outcome] = [
        (dict(zip(columns, results or ())), None, error) for results, error in outcomes
    ]
    names = [name for name, _ in parameters]
    table = _table(cases_of(grid, parameters), names, found)
    del table["warnings"]
    return _frame(table, range(len(found)))


def _frame(table: dict[str, list[Any]], index: range) -> Any:
    """The frame of a table. Its errors are objects: a column of texts of pandas 3 makes NaN of None."""
    frame = pandas().DataFrame(table, index=index)
    frame["error"] = pandas().Series(table["error"], index=index, dtype=object)
    return frame


def _shard(numbers: range, shard: tuple[int, int] | None) -> range:
    """Numbers of the cases of a shard."""
    if shard is None:
        return numbers
    index, of = shard
    if not 0 <= index < of:
        raise InputError(f"shard is {shard}, but must be (index, of) with 0 ≤ index < of")
    return numbers[index::of]


def _save(
    file: str | os.PathLike[str],
    grid: Grid,
    shard: tuple[int, int] | None,
    outcomes: Sequence[Outcome],
) -> None:
    columns = list(dict.fromkeys(name for results, *_ in outcomes for name in results))
    rows = [
        [math.nan if results.get(name) is None else results[name] for name in columns]
        if error is None
        else error
        for results, _, error in outcomes
    ]
    _core._save_cases(file, grid, shard, columns, rows)


def _teller(progress: bool | Callable[[int, int], Any], count: int) -> Callable[[int], Any]:
    if callable(progress):
        return lambda done: progress(done, count)
    if progress:
        line = Line("cases")
        return lambda done: line(done, count)
    return lambda done: None


def _submitted(executor: Any, arguments: list[Any], tell: Callable[[int], Any]) -> list[Outcome]:
    """Outcomes by an executor; a process that dies costs the case that it ran, and no other.

    A process pool is lost with one of its processes. The first cases without an outcome may have
    been running there: each of them runs again by itself, and the others in another pool.
    """
    found: dict[int, Any] = {}

    def run(pool: Any, numbers: Sequence[int]) -> list[int]:
        """Runs these cases; returns those that a pool lost."""
        try:
            futures = [pool.submit(run_case, *arguments[number]) for number in numbers]
        except BrokenExecutor as error:
            own: list[Any] = [error] * len(numbers)
        else:
            own = _collect(futures, tell, sum(isinstance(one, tuple) for one in found.values()))
        found.update(zip(numbers, own))
        return [number for number in numbers if isinstance(found[number], BrokenExecutor)]

    lost = run(executor, range(len(arguments)))
    workers = getattr(executor, "_max_workers", 1)
    while lost and isinstance(executor, ProcessPoolExecutor):
        # A pool hands out one case more than it has processes.
        first, others = lost[: 2 * workers + 1], lost[2 * workers + 1 :]
        for number in first:
            with _like(executor, 1) as pool:
                for dead in run(pool, [number]):
                    found[dead] = {}, None, described(found[dead])
                    tell(sum(isinstance(one, tuple) for one in found.values()))
        with _like(executor, workers) as pool:
            lost = run(pool, others)
    for number in lost:
        found[number] = {}, None, described(found[number])
    return [found[number] for number in range(len(arguments))]


def _like(executor: ProcessPoolExecutor, workers: int) -> ProcessPoolExecutor:
    """A new pool with the settings of another."""
    options = {name: getattr(executor, f"_{name}") for name in ("mp_context", "initializer", "initargs")}
    return ProcessPoolExecutor(workers, **options)


def _collect(
    futures: Sequence[Future[Any]], tell: Callable[[int], Any], before: int = 0
) -> list[Any]:
    """Outcomes in the order of the cases; on an interrupt what has not begun is not begun."""
    outcomes = []
    try:
        for future in futures:
            outcomes.append(_outcome(future))
            if isinstance(outcomes[-1], tuple):
                before += 1
                tell(before)
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return outcomes


def _in_threads(arguments: list[Any], jobs: int, tell: Callable[[int], Any]) -> list[Any]:
    cancelled = threading.Event()
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        try:
            futures = [pool.submit(_run_in_thread, cancelled, *own) for own in arguments]
            return _collect(futures, tell)
        except BaseException:
            # Ctrl-C reaches the main thread only: tell the others.
            cancelled.set()
            raise


def _distinct(outcome: Outcome, taken: set[str]) -> Outcome:
    """The outcome, or an error if one of its results has the name of another column."""
    clash = next((name for name in outcome[0] if name in taken), None)
    if clash is None:
        return outcome
    return {}, None, described(ValueError(f"a result has the name of another column, {clash!r}"))


def _table(
    cases: Sequence[Mapping[str, Any]], parameters: Sequence[str], outcomes: Sequence[Outcome]
) -> dict[str, list[Any]]:
    """Columns: parameters, results, error; what a row lacks is None."""
    table: dict[str, list[Any]] = {name: [case.get(name) for case in cases] for name in parameters}
    for name in dict.fromkeys(name for results, *_ in outcomes for name in results):
        table[name] = [results.get(name) for results, *_ in outcomes]
    table["warnings"] = [warnings for _, warnings, _ in outcomes]
    table["error"] = [error for *_, error in outcomes]
    return table
