"""Fixtures and helpers of several tests."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest

import basemat as bm

CRATE = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def reference() -> Path:
    """The Rust program that computes the same scenes, built here."""
    if shutil.which("cargo") is None:
        pytest.skip("no cargo: results cannot be compared with Rust's")
    command = ["cargo", "build", "--release", "--example", "reference", "--message-format=json"]
    built = subprocess.run(command, cwd=CRATE, check=True, capture_output=True, text=True)
    messages = [json.loads(line) for line in built.stdout.splitlines()]
    [program] = [own["executable"] for own in messages if own.get("executable")]
    return Path(program)


@pytest.fixture
def soil() -> bm.Soil:
    return bm.Soil(80.0e6, 0.33, 1900.0)


@pytest.fixture
def block() -> bm.RigidBlock:
    return bm.RigidBlock(6.0, 9.0, 1000.0)


@pytest.fixture
def rocking(soil: bm.Soil, block: bm.RigidBlock):
    """Makes a block that uplifts and slides under El Centro, with whatever is asked for instead."""

    def make(friction: float = 0.4, **others: object) -> bm.Simulation:
        parts = {
            "structure": block,
            "ground": bm.ElasticGround.under(soil, block, 8),
            "interface": bm.Coulomb(friction),
            "motion": bm.el_centro_1940(),
            "probes": [bm.Probe.acceleration("roof", block.horizontal_at(9.0))],
        }
        return bm.Simulation(time_step=0.01, **{**parts, **others})

    return make


@pytest.fixture
def interruptible():
    """Ctrl-C raises, also where the tests were started with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def same_bits(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two arrays are the same to the last bit, NaN included."""
    return one.shape == other.shape and bool(np.all(one.view(np.uint64) == other.view(np.uint64)))
