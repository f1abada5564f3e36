"""What takes too much memory is an error, before or in a run, and no abort."""

from __future__ import annotations

import subprocess
import sys

import pytest

import basemat as bm


def test_sizes_beyond_memory_are_refused_with_what_they_take() -> None:
    assert bm.memory_limit() == 8 * 2**30
    with pytest.raises(bm.InputError, match="contact elements: 10000 would take about 40.0 GB"):
        bm.Strip(-5.0, 5.0, 10_000)
    with pytest.warns(DeprecationWarning, match="does nothing"):
        bm.set_memory_limit(2**36)
    assert bm.memory_limit() == 8 * 2**30


def test_time_series_beyond_memory_are_refused(rocking) -> None:
    simulation = rocking()
    with pytest.raises(bm.InputError, match=r"steps with time series and snapshots: 1000000000 would take .*`series=False`"):
        simulation.run(10**9)
    assert simulation.state.step == 0
    # With an observer that ends it such a run is one of few steps.
    run = simulation.run(10**9, observe=lambda state: state.step == 20, motion_every=1)
    assert run.steps == 20 and run.motion["displacement"].shape == (21, 3)


@pytest.mark.skipif(sys.platform != "linux", reason="limits of a process")
def test_too_little_memory_is_an_error_and_no_abort() -> None:
    """Snapshots of 1200 degrees of freedom, in a process that may have 40 MB more than it has."""
    program = """
import resource
import numpy as np
import basemat as bm

free = 1200
masses, springs = np.full(3 + free, 1e3), np.zeros((3 + free, 3 + free))
masses[:3] = 5e4, 5e4, 2e5
for k in range(free):
    springs[np.ix_([0, 3 + k], [0, 3 + k])] += 1e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
model = bm.MatrixModel(np.diag(masses), springs, bm.BaseNode.rigid_base(-3.0, 3.0, [0, 1, 2]))
ground = bm.SpringGround.under(model, 4, 1e8, 1e8)
simulation = bm.Simulation(0.01, model, ground, bm.Bonded(), motion=bm.el_centro_1940())
simulation.run(2)
taken = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (taken + 40_000_000, resource.RLIM_INFINITY))
for observe in (None, lambda state: False):
    try:
        simulation.run(54_000, motion_every=1, observe=observe)
    except bm.InputError as error:
        assert "the system gives no more" in str(error), error
print("told")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=300)
    assert done.stdout == "told\n", done.stderr
