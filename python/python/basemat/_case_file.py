"""A file of a sweep's cases, into which one process at a time writes."""

from __future__ import annotations

import math
import os
import time
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, Optional

from . import _core
from ._case import Outcome
from ._errors import BasematWarning, FileError

Rows = tuple[list[str], list[tuple[int, Optional[list[float]], Optional[str], Optional[str]]]]
"""Columns of results, and the rows: number of the case, results, warnings, error."""

_PAUSE = 0.1
"""Seconds between two attempts to take the lock of another process."""

_LOCKS: set[int] = set()
"""Descriptors of the locks that this process has."""


def outcomes_of(rows: Rows) -> dict[int, Outcome]:
    """Outcomes of cases by their numbers."""
    columns, found = rows
    return {case: (dict(zip(columns, results or ())), warned, error) for case, results, warned, error in found}


def append(file: _core._CaseFile, case: int, outcome: Outcome) -> None:
    """Adds the row of a case."""
    results, warned, error = outcome
    numbers = [math.nan if value is None else value for value in results.values()]
    file.append(case, list(map(str, results)), numbers, warned, error)


@contextmanager
def alone(path: str | os.PathLike[str]) -> Iterator[None]:
    """Waits until no other process writes to the file of cases at ``path``, and locks it.

    The lock is a file beside it that the system releases with the process, however that ends. Where a folder has no
    locks, nothing is kept out.
    """
    lock = _taken(f"{os.fspath(path)}.lock")
    try:
        yield
    finally:
        if lock is not None:
            _LOCKS.discard(lock)
            # Removed while it is locked: who waits for it finds that it is another file, and opens the next.
            with suppress(OSError):
                os.remove(f"{os.fspath(path)}.lock")
            os.close(lock)


def _taken(name: str) -> int | None:
    """Descriptor of the locked file, or None where there are no locks."""
    with suppress(OSError):
        os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
    has_told = False
    while True:
        try:
            lock = os.open(name, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            raise FileError(f"{_of(name)} cannot be written: {error.strerror}") from error
        try:
            _lock(lock)
        except BlockingIOError:
            os.close(lock)
        except OSError:
            # No locks here, as on some network drives.
            os.close(lock)
            with suppress(OSError):
                os.remove(name)
            return None
        else:
            with suppress(OSError):
                if os.path.samestat(os.fstat(lock), os.stat(name)):
                    _LOCKS.add(lock)
                    return lock
            os.close(lock)
            continue
        if not has_told:
            has_told = True
            warnings.warn(
                f"{_of(name)}: another process runs this sweep; waiting for it",
                BasematWarning,
                stacklevel=5,
            )
        time.sleep(_PAUSE)


def _of(lock: str) -> str:
    """Path of the file of cases that a lock belongs to."""
    return lock[: -len(".lock")]


def _lock(file: int) -> None:
    """Locks a file, or raises `BlockingIOError` if another process has locked it."""
    try:
        import fcntl
    except ImportError:
        import msvcrt

        windows: Any = msvcrt
        try:
            windows.locking(file, windows.LK_NBLCK, 1)
        except OSError as error:
            raise BlockingIOError from error
    else:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _forget(locks: Iterable[int] = _LOCKS) -> None:
    """Closes what a fork inherited: it would keep the lock after its parent has died."""
    for lock in [*locks]:
        os.close(lock)
    _LOCKS.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
