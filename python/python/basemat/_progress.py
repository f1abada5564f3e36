"""A line of progress on stderr."""

from __future__ import annotations

import sys
import time


class Line:
    """Writes the fraction of the steps (or ``items``) done and the remaining time, always into one line.

    The time left follows from what has been made since the first call, which comes when work has begun.
    """

    def __init__(self, items: str = "steps") -> None:
        self._items = items
        self._begin: tuple[float, int] | None = None
        self._written = 0.0
        self._ended = False

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if self._begin is None:
            self._begin = (now, done)
        if self._ended or (done < total and now - self._written < 0.2):
            return
        # The end may be told twice.
        self._written, self._ended = now, done >= total
        begin, before = self._begin
        made = done - before
        left = f", {(now - begin) * (total - done) / made:.0f} s left" if made else ""
        share = 100.0 * done / total if total else 100.0
        end = "\n" if done >= total else ""
        sys.stderr.write(f"\r{done} of {total} {self._items} ({share:.0f} %){left}   {end}")
        sys.stderr.flush()
