"""Cases on the workers of a Dask cluster, some of which may die."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from ._case import Outcome, described, run_case
from ._executors import Ended


_START_TIME = 2.0
"""Seconds before the first case of a worker process."""
_STARTED = threading.Event()
"""Whether this process has waited so long."""


def is_client(executor: Any) -> bool:
    """Whether this is a client of Dask; without importing it."""
    return type(executor).__module__.partition(".")[0] == "distributed" and hasattr(
        executor, "scheduler_info"
    )


def run(
    client: Any,
    make: Callable[..., Any],
    cases: Sequence[dict[str, Any]],
    options: tuple[Any, ...],
    ended: Ended,
) -> None:
    """Runs cases on any workers, and calls ``ended`` once for each.

    Dask runs the cases of a worker that died on another one. It counts a death against every case
    assigned to the worker, and gives up a case with more than ``allowed-failures`` deaths: also one
    that only waited behind the case that kills. Such cases therefore run again one by one, where no
    other case can be the reason.
    """
    from distributed import KilledWorker, as_completed

    def some(places: Sequence[int]) -> dict[int, BaseException]:
        """Runs these cases; returns the errors of those that the scheduler gave up."""
        # In one group the scheduler hands cases out as workers come free, and not all at once.
        futures = client.map(_run, [cases[place] for place in places], make=make, options=options, pure=False)
        place_of = dict(zip(futures, places))
        given_up: dict[int, BaseException] = {}
        try:
            for future in as_completed(futures):
                place = place_of[future]
                try:
                    found = future.result()
                except (KeyboardInterrupt, SystemExit):
                    raise
                except BaseException as error:  # Cancelled futures are no Exception.
                    if isinstance(error, KilledWorker):
                        given_up[place] = error
                        continue
                    found = {}, None, described(error)
                ended(place, found)
        except BaseException:
            client.cancel(futures)
            raise
        return given_up

    for place in sorted(some(range(len(cases)))):
        for dead, error in some([place]).items():
            ended(dead, ({}, None, described(error)))


def _run(case: dict[str, Any], make: Callable[..., Any], options: tuple[Any, ...]) -> Outcome:
    from distributed import get_worker

    if get_worker().nanny:
        _finish_start()
    return run_case(make, case, *options)


def _finish_start() -> None:
    """Waits, once in a worker process, until its nanny has recorded the start.

    A worker takes cases before that. If a case then kills the process, the nanny does not start another one; a case that
    kills one worker after another would leave a cluster without workers, on which the other cases wait for ever.
    """
    if not _STARTED.is_set():
        time.sleep(_START_TIME)
        _STARTED.set()
