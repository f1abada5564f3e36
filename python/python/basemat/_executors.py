"""Cases of a sweep one after the other, on threads or on processes."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import (
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from typing import Any

from . import _core
from ._case import Outcome, described, run_case

Ended = Callable[[int, Outcome], None]
"""A function of the index of a case in the list and of its outcome, called when the case ends."""


def run_in_turn(arguments: Sequence[Any], ended: Ended) -> None:
    """Runs cases in this thread."""
    for place, case_arguments in enumerate(arguments):
        ended(place, run_case(*case_arguments))


def run_in_threads(arguments: Sequence[Any], jobs: int, ended: Ended) -> None:
    """Runs cases in threads; Ctrl-C ends their runs."""
    cancelled = threading.Event()
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        try:
            _run(pool, arguments, range(len(arguments)), ended, _run_in_thread, cancelled)
        except BaseException:
            # Ctrl-C reaches the main thread only: tell the others.
            cancelled.set()
            raise


def _run_in_thread(cancelled: threading.Event, *arguments: Any) -> Outcome:
    """A case whose runs end once ``cancelled`` is set."""
    _core._cancel_when(cancelled)
    try:
        return run_case(*arguments)
    finally:
        _core._cancel_when(None)


def run_by(executor: Any, arguments: Sequence[Any], ended: Ended) -> None:
    """Runs cases by an executor; if a process dies, only the case that it ran is lost.

    A process pool is lost with one of its processes. The first cases without an outcome may have
    been running there: each of them runs again by itself, and the others in another pool.
    """
    lost = _run(executor, arguments, range(len(arguments)), ended)
    workers = getattr(executor, "_max_workers", 1)
    while lost and isinstance(executor, ProcessPoolExecutor):
        # A pool hands out one case more than it has processes.
        places = sorted(lost)
        first, others = places[: 2 * workers + 1], places[2 * workers + 1 :]
        for place in first:
            with _like(executor, 1) as pool:
                for dead, error in _run(pool, arguments, [place], ended).items():
                    ended(dead, ({}, None, described(error)))
        with _like(executor, workers) as pool:
            lost = _run(pool, arguments, others, ended)
    for place, error in lost.items():
        ended(place, ({}, None, described(error)))


def _like(executor: ProcessPoolExecutor, workers: int) -> ProcessPoolExecutor:
    """A new pool with the settings of another."""
    options = {name: getattr(executor, f"_{name}") for name in ("mp_context", "initializer", "initargs")}
    return ProcessPoolExecutor(workers, **options)


def _run(
    pool: Any,
    arguments: Sequence[Any],
    places: Sequence[int],
    ended: Ended,
    run: Callable[..., Outcome] = run_case,
    *before: Any,
) -> dict[int, BrokenExecutor]:
    """Runs the cases with these indices, and calls ``ended`` for each; returns the errors of those that a pool lost.

    After an interrupt no further case begins.
    """
    done: queue.SimpleQueue[tuple[int, Future[Outcome]]] = queue.SimpleQueue()
    futures: list[Future[Outcome]] = []
    lost: dict[int, BrokenExecutor] = {}
    try:
        for place in places:
            try:
                future = pool.submit(run, *before, *arguments[place])
            except BrokenExecutor as error:
                lost[place] = error
                continue
            futures.append(future)
            future.add_done_callback(lambda future, place=place: done.put((place, future)))
        for _ in range(len(futures)):
            place, future = _next(done)
            found = _outcome(future)
            if isinstance(found, BrokenExecutor):
                lost[place] = found
            else:
                ended(place, found)
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return lost


def _next(done: queue.SimpleQueue[tuple[int, Future[Outcome]]]) -> tuple[int, Future[Outcome]]:
    """The next case that has ended."""
    while True:
        try:
            # On some systems Ctrl-C does not interrupt a wait without a timeout.
            return done.get(timeout=0.2)
        except queue.Empty:
            pass


def _outcome(future: Future[Outcome]) -> Outcome | BrokenExecutor:
    """Outcome of a case, or the error of a pool one of whose workers died before it could report one."""
    try:
        return future.result()
    except (KeyboardInterrupt, SystemExit):
        raise
    except BrokenExecutor as error:
        return error
    except BaseException as error:  # Cancelled futures of Dask are no Exception.
        return {}, None, described(error)
