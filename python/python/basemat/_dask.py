"""Cases on the workers of a Dask cluster, some of which may die."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ._case import Outcome, described, run_case


def is_client(executor: Any) -> bool:
    """Whether this is a client of Dask; without importing it."""
    return type(executor).__module__.partition(".")[0] == "distributed" and hasattr(
        executor, "scheduler_info"
    )


def outcomes(
    client: Any,
    make: Callable[..., Any],
    cases: Sequence[dict[str, Any]],
    options: tuple[Any, ...],
    tell: Callable[[int], Any],
) -> list[Outcome]:
    """Outcomes in the order of the cases, whichever worker they ran on and however often.

    Dask runs the cases of a worker that died on another one. It counts a death against every case
    that the worker had been given, and gives up one with more than ``allowed-failures``: also one
    that only waited behind the case that kills. Such cases are therefore run again one by one,
    where no other can be the reason.
    """
    from distributed import KilledWorker, as_completed

    found: list[Outcome] = [({}, None, "was not run")] * len(cases)
    done = 0

    def run(numbers: Sequence[int]) -> list[int]:
        """Runs these cases; returns those that the scheduler gave up."""
        nonlocal done
        # In one group the scheduler hands cases out as workers come free, and not all at once.
        futures = client.map(
            _run, [cases[number] for number in numbers], make=make, options=options, pure=False
        )
        number_of = dict(zip(futures, numbers))
        given_up = []
        try:
            for future in as_completed(futures):
                number = number_of[future]
                try:
                    found[number] = future.result()
                except (KeyboardInterrupt, SystemExit):
                    raise
                except BaseException as error:  # Cancelled futures are no Exception.
                    found[number] = {}, None, described(error)
                    if isinstance(error, KilledWorker):
                        given_up.append(number)
                        continue
                done += 1
                tell(done)
        except BaseException:
            client.cancel(futures)
            raise
        return given_up

    for number in sorted(run(range(len(cases)))):
        if run([number]):
            done += 1
            tell(done)
    return found


def _run(case: dict[str, Any], make: Callable[..., Any], options: tuple[Any, ...]) -> Outcome:
    return run_case(make, case, *options)
