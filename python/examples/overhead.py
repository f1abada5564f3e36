"""Time of 54 000 steps of the containment with time series: Python by Rust.

    python examples/overhead.py

builds the Rust program of the same scene, runs both in turn and prints the least time of each.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from pathlib import Path

from basemat import containment

CRATE = Path(__file__).parents[1]


def program() -> str:
    """The Rust program, built."""
    command = ["cargo", "build", "--release", "--example", "reference", "--message-format=json"]
    built = subprocess.run(command, cwd=CRATE, check=True, capture_output=True, text=True)
    messages = [json.loads(line) for line in built.stdout.splitlines()]
    return next(str(message["executable"]) for message in messages if message.get("executable"))


def rust(executable: str, steps: int) -> float:
    """Seconds of a run in Rust."""
    command = [executable, "time", "0.4", str(steps)]
    words = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(words[0])


def python(steps: int) -> float:
    """Seconds of a run in Python, until its time series are arrays."""
    simulation = containment.scene(0.4, steps=steps).simulation
    begin = time.perf_counter()
    run = simulation.run(steps)
    series = run.series
    elapsed = time.perf_counter() - begin
    assert series["base_shear"].shape == (steps + 1,)
    return elapsed


def main() -> None:
    """Prints both times and their ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=54_000)
    parser.add_argument("--repeats", type=int, default=9)
    options = parser.parse_args()
    executable = program()
    pairs = [
        (rust(executable, options.steps), python(options.steps)) for _ in range(options.repeats)
    ]
    least_rust, least_python = (min(times) for times in zip(*pairs))
    print(
        f"Rust {least_rust:.4f} s, Python {least_python:.4f} s, ratio {least_python / least_rust:.3f}"
    )


if __name__ == "__main__":
    main()
