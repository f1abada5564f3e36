"""The fragility study on a Dask cluster whose workers are killed: the serial table, and Rust's."""

from __future__ import annotations

import importlib
import logging
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CRATE, same_bits

import basemat as bm

pandas = pytest.importorskip("pandas")
distributed = pytest.importorskip("dask.distributed")
dask = pytest.importorskip("dask")

# Before version 3 pandas reads numbers to the last bit only when told to; later it warns if told.
pytestmark = pytest.mark.filterwarnings("ignore:.*float_precision")
sys.path.insert(0, str(CRATE / "examples"))
fragility = importlib.import_module("fragility")

RESULTS = [
    "peak_slip_m",
    "residual_slip_m",
    "largest_gap_m",
    "uplifted_fraction",
    "peak_drift_ratio",
    "base_shear_over_weight",
    "steps",
]
COLUMNS = ["case", *fragility.grid(True), *RESULTS, "error"]
# Cases of the study that runs on Dask: its two frictions, its motions, more levels.
GRID = {**fragility.grid(True), "peak_velocity_m_per_s": [0.05 * k for k in range(1, 31)]}


@pytest.fixture
def client(tmp_path: Path) -> Iterator[Any]:
    """Two processes of one thread each."""
    with (
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            dashboard_address=None,
            local_directory=str(tmp_path / "dask"),
            silence_logs=logging.CRITICAL,
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def serial() -> Any:
    return bm.sweep(fragility.shake, GRID)


def assert_same(one: Any, other: Any) -> None:
    """Two tables are the same to the last bit."""
    pandas.testing.assert_frame_equal(one, other, check_exact=True)
    for name in RESULTS:
        bits = [np.ascontiguousarray(table[name], np.float64) for table in (one, other)]
        assert same_bits(*bits), name


def logged(folder: Path) -> tuple[dict[int, list[str]], dict[int, list[str]]]:
    """Cases begun and cases ended by each process, in their order."""
    files = {int(path.name): path.read_text("utf-8").splitlines() for path in folder.glob("[0-9]*")}
    begun = {
        own: [line[6:] for line in lines if line[:5] == "begin"] for own, lines in files.items()
    }
    ended = {
        own: [line[6:] for line in lines if line[:5] == "ended"] for own, lines in files.items()
    }
    return begun, ended


class Logged:
    """The study's run, with a line in the process's own file when it begins and when it ends.

    Where the file `stop` is, the case `stuck` renames it to `stopped`, with its process's number,
    and makes steps until the process is killed. The next attempt runs as any case.
    """

    def __init__(self, folder: Path, stuck: dict[str, Any]) -> None:
        self.folder = folder
        self.stuck = stuck

    def __call__(self, **case: Any) -> dict[str, float]:
        with open(self.folder / str(os.getpid()), "a", encoding="utf-8") as log:
            print("begin", case, file=log, flush=True)
            if case == self.stuck and (self.folder / "stop").exists():
                (self.folder / "stop").rename(self.folder / "stopping")
                (self.folder / "stopping").write_text(str(os.getpid()))
                (self.folder / "stopping").rename(self.folder / "stopped")
                rocking(10**8)
            results: dict[str, float] = fragility.shake(**case)
            print("ended", case, file=log, flush=True)
        return results


def rocking(steps: int) -> bm.Run:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    ground = bm.ElasticGround.under(bm.Soil(80.0e6, 0.33, 1900.0), block, 6)
    simulation = bm.Simulation(0.01, block, ground, bm.Coulomb(0.4), motion=bm.el_centro_1940())
    return simulation.run(steps, series=False)


def kill_stuck(folder: Path, killed: list[int]) -> None:
    """Kills the process that got stuck, in the middle of its steps."""
    until = time.monotonic() + 60.0
    while not (folder / "stopped").exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.3)
    process = int((folder / "stopped").read_text())
    os.kill(process, signal.SIGKILL)
    killed.append(process)


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
@pytest.mark.parametrize("executor", ["client", "get_executor"])
def test_a_killed_worker_changes_nothing(
    client: Any, serial: Any, tmp_path: Path, executor: str
) -> None:
    cases = serial[list(GRID)].to_dict("records")
    stuck = cases[len(cases) // 3]
    (tmp_path / "stop").touch()
    before = set(client.run(os.getpid).values())
    killed: list[int] = []
    thread = threading.Thread(target=kill_stuck, args=(tmp_path, killed))
    thread.start()
    told: list[tuple[int, int]] = []
    table = bm.sweep(
        Logged(tmp_path, stuck),
        GRID,
        executor=client if executor == "client" else client.get_executor(),
        progress=lambda done, of: told.append((done, of)),
    )
    thread.join()

    assert len(table) == len(cases) == 300
    assert table["error"].isna().all()
    assert_same(table, serial)
    assert told == [(k, 300) for k in range(1, 301)]

    # A worker of this cluster died in the middle of that case, others done, and another ended it.
    [dead] = killed
    assert dead in before
    begun, ended = logged(tmp_path)
    assert begun[dead][-1] == str(stuck)
    assert 10 < len(ended[dead]) == len(begun[dead]) - 1
    assert [own for own, names in ended.items() if str(stuck) in names] not in ([], [dead])
    done = sum(len(names) for names in ended.values())
    assert done >= 300 and {name for names in ended.values() for name in names} == set(
        map(str, cases)
    )


def sometimes(k: int) -> dict[str, float]:
    """Raises for 3, and kills its process for 20."""
    if k == 3:
        raise ValueError("no such case")
    if k == 20:
        os.kill(os.getpid(), signal.SIGKILL)
    return {"value": 2.0 * k}


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
@pytest.mark.parametrize("allowed", [0, 2])
def test_a_case_that_raises_or_kills_is_a_row_and_no_other_suffers(
    tmp_path: Path, allowed: int, request: pytest.FixtureRequest
) -> None:
    with dask.config.set({"distributed.scheduler.allowed-failures": allowed}):
        client = request.getfixturevalue("client")
        told: list[int] = []
        table = bm.sweep(
            sometimes,
            {"k": range(40)},
            executor=client,
            progress=lambda done, of: told.append(done),
        )
    assert list(table["k"]) == list(range(40))
    assert told == list(range(1, 41))
    assert table["error"][3] == "ValueError: no such case"
    assert re.search(
        rf"KilledWorker: .* on {allowed + 1} different workers, but all those workers died",
        table["error"][20],
    )
    good = table.drop([3, 20])
    assert good["error"].isna().all()
    assert list(good["value"]) == [2.0 * k for k in good["k"]]
    assert table["value"][[3, 20]].isna().all()


def test_a_cluster_that_is_gone_leaves_rows_that_say_so() -> None:
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
    ) as cluster:
        client = distributed.Client(cluster, timeout="2s")

        def close(done: int, of: int) -> None:
            if done == 3:
                cluster.close()

        table = bm.sweep(fragility.shake, GRID, executor=client, progress=close)
        client.close()
    assert len(table) == 300
    assert table["error"].isna().sum() >= 3
    assert table["error"].iloc[-1]


def test_the_examples_command_gives_the_serial_file(tmp_path: Path) -> None:
    fragility.main(["--short", "--table", str(tmp_path / "serial.csv")])
    command = [sys.executable, fragility.__file__, "--short", "--dask", "2", "--table", "dask.csv"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=300)
    assert (tmp_path / "dask.csv").read_bytes() == (tmp_path / "serial.csv").read_bytes()


@pytest.fixture(scope="session")
def rust() -> list[str]:
    """The command of Rust's study."""
    if shutil.which("cargo") is None:
        pytest.skip("no cargo: the table cannot be compared with Rust's")
    return ["cargo", "run", "--quiet", "--release", "--package", "basemat-studies", "--", "fragility"]


def read(path: Path) -> Any:
    # Rust writes 8.0 as 8, which is read as an integer unless told.
    numbers = dict.fromkeys(["friction", "width_m", "peak_velocity_m_per_s", *RESULTS], np.float64)
    # The first line has the check sum.
    return pandas.read_csv(path, comment="#", float_precision="round_trip", dtype=numbers)


def test_the_table_is_rusts(rust: list[str], tmp_path: Path) -> None:
    path = tmp_path / "python" / "shard_0_of_1.csv"
    fragility.main(["--short", "--table", str(path)])
    table = read(path)
    assert list(table.columns) == COLUMNS
    assert len(table) == 40 and table["error"].isna().all()
    # It slid and opened: a table of zeros would be equal, too.
    assert (table["residual_slip_m"] > 0.05).any() and (table["uplifted_fraction"] > 0.2).any()

    command = [*rust, "--short", "--out"]
    subprocess.run([*command, str(tmp_path / "rust")], cwd=CRATE.parent, check=True)
    assert path.read_bytes() == (tmp_path / "rust" / "cases.csv").read_bytes()
    # And Rust fits curves to Python's rows.
    subprocess.run([*command, str(path.parent), "--merge"], cwd=CRATE.parent, check=True)
    for file in ("cases.csv", "curves.csv"):
        assert (path.parent / file).read_bytes() == (tmp_path / "rust" / file).read_bytes()


def test_the_readmes_program_runs(tmp_path: Path) -> None:
    readme = (CRATE / "README.md").read_text("utf-8")
    [program] = re.findall(r"## On Dask\n.*?```python\n(.*?)```", readme, re.S)
    (tmp_path / "study.py").write_text(program, "utf-8")
    subprocess.run([sys.executable, "study.py"], cwd=tmp_path, check=True, timeout=300)
    table = read(tmp_path / "cases.csv")
    assert len(table) == 40 and table["error"].isna().all()
