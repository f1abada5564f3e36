"""Files that another program reads, too: gmprocess and ObsPy for records, meshio for meshes.

GOAL: a layout is understood as others understand it.
SCENE: the small files of ``tests/data``, in the layouts of their agencies.
REFERENCE: what the other program reads from the same file; a program that is not installed skips its tests.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basemat as bm

DATA = Path(__file__).parents[2] / "tests" / "data"
RECORDS = DATA / "records"

pytestmark = pytest.mark.skipif(not RECORDS.is_dir(), reason="the files of the crate's tests are not here")


@pytest.mark.parametrize(
    ("format", "name", "reader"),
    [
        ("cosmos", "cosmos.v2c", "cosmos"),
        ("cosmos", "csmip.v2", "dmg"),
        ("k_net", "k_net.ns", "knet"),
        ("k_net", "kik_net.ew2", "knet"),
        ("esm", "esm_hne.asc", "esm"),
        ("afad", "afad_three.txt", "nsmn"),
        ("smc", "smc.smc", "smc"),
        ("geonet", "geonet.v2a", "geonet"),
    ],
)
def test_gmprocess_reads_the_same_record(format: Any, name: str, reader: str) -> None:
    pytest.importorskip("gmprocess", reason="gmprocess is not installed")
    module = import_module(f"gmprocess.io.{reader}.core")
    [stream] = getattr(module, f"read_{reader}")(str(RECORDS / name))
    # Of COSMOS it takes velocity for a component.
    traces = list(stream)
    if name == "cosmos.v2c":
        traces = [traces[0], traces[2]]
    records = list(bm.Record.read_all(RECORDS / name, format=format).values())
    assert len(records) == len(traces)
    for record, trace in zip(records, traces, strict=True):
        assert record.time_step == pytest.approx(trace.stats.delta, rel=1e-12)
        np.testing.assert_allclose(record.accelerations, 0.01 * trace.data, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("name", ["k_net.ns", "kik_net.ew2"])
def test_obspy_reads_the_same_record(name: str) -> None:
    obspy = pytest.importorskip("obspy", reason="ObsPy is not installed")
    [trace] = obspy.read(str(RECORDS / name), format="KNET", apply_calib=True)
    record = bm.Record.read(RECORDS / name, format="k_net")
    assert record.time_step == pytest.approx(trace.stats.delta, rel=1e-12)
    np.testing.assert_allclose(record.accelerations, trace.data, rtol=1e-12)


def test_meshio_reads_the_same_base() -> None:
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    path = DATA / "gmsh" / "base_line_in_two_groups.msh"
    mesh = meshio.read(path)
    ours = bm.GmshMesh(path)
    for name, count in [("base", 7), ("left half", 3)]:
        lines = [
            block.data[cells]
            for block, cells in zip(mesh.cells, mesh.cell_sets[name], strict=True)
            if block.type == "line" and len(cells) > 0
        ]
        theirs = np.unique(mesh.points[np.unique(np.concatenate(lines))][:, 0])
        assert len(ours.line(name)) == len(theirs) == count
