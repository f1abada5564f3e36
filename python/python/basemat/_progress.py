"""A line of progress on stderr."""

from __future__ import annotations

import sys
import time


class Line:
    """Writes the share of the steps (or ``items``) made and the time left, always into one line."""

    def __init__(self, items: str = "steps") -> None:
        self._items = items
        self._begin = time.monotonic()
        self._written = 0.0

    def __call__(self, done: int, steps: int) -> None:
        now = time.monotonic()
        if done < steps and now - self._written < 0.2:
            return
        self._written = now
        elapsed = now - self._begin
        left = elapsed * (steps - done) / done if done else 0.0
        share = 100.0 * done / steps if steps else 100.0
        end = "\n" if done >= steps else ""
        sys.stderr.write(
            f"\r{done} of {steps} {self._items} ({share:.0f} %), {left:.0f} s left  {end}"
        )
        sys.stderr.flush()
