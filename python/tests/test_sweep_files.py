"""GOAL: a sweep that ends before its last case loses no case that has ended, and computes none of them again.
SCENE: cases by a formula or a block that slides, ended by an exception, Ctrl-C or SIGKILL in the middle; several processes
with one file; files that are cut or changed.
REFERENCE: the sweep that was not ended, bit for bit; the list of cases that were made, which every case extends.
"""

from __future__ import annotations

import multiprocessing
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

import basemat as bm

pandas = pytest.importorskip("pandas")

GRID = {"a": [1.0, 2.0, 3.0, 4.0], "name": ["x", "y, z"]}
RESUMED = pytest.mark.filterwarnings("ignore:.*were read from:basemat.BasematWarning")


def formula(a: float, name: str) -> dict[str, float]:
    if a == 2.0:
        raise ValueError("no\n2")
    return {"b": a / 3.0, "c": float(len(name))}


class Made:
    """The formula, which writes each case into a file before it computes it, and ends at one of them."""

    def __init__(self, folder: Path, end: Any = None, at: int = -1) -> None:
        self.log, self.end, self.at = folder / "made", end, at

    def __call__(self, a: float, name: str) -> dict[str, float]:
        with self.log.open("a", encoding="utf-8") as log:
            log.write(f"{a} {name}\n")
        if len(self.cases()) == self.at:
            self.end()
        # Longer than a row is written.
        time.sleep(0.05)
        return formula(a, name)

    def cases(self) -> list[str]:
        return self.log.read_text("utf-8").splitlines()


def raises(error: type[BaseException]) -> Any:
    def end() -> None:
        raise error

    return end


def same(one: Any, other: Any) -> None:
    pandas.testing.assert_frame_equal(one, other, check_exact=True)


@pytest.fixture
def whole(tmp_path: Path) -> Any:
    return bm.sweep(formula, GRID, file=tmp_path / "whole" / "cases.csv")


@RESUMED
@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
def test_the_same_call_goes_on_after_an_interrupt(tmp_path: Path, whole: Any, error: type[BaseException]) -> None:
    path = tmp_path / "cases.csv"
    with pytest.raises(error) as caught:
        bm.sweep(Made(tmp_path, raises(error), 6), GRID, file=path)
    so_far = caught.value.table
    assert so_far["b"].notna().tolist() == [True, True, False, False, True, False, False, False]
    assert so_far["error"].notna().tolist() == [False, False, True, True, False, False, False, False]
    assert not path.exists() and path.with_name("cases.csv.part").exists()
    table = bm.sweep(Made(tmp_path), GRID, file=path)
    same(table, whole)
    # The case that did not end runs twice.
    made = Made(tmp_path).cases()
    assert len(made) == 9 and made[5] == made[6] and len(set(made)) == 8
    assert path.read_bytes() == (tmp_path / "whole" / "cases.csv").read_bytes()
    assert sorted(own.name for own in tmp_path.glob("cases*")) == ["cases.csv"]
    with pytest.warns(bm.BasematWarning, match=r"8 of 8 cases were read from .*cases.csv and not run again: delete"):
        same(bm.sweep(Made(tmp_path), GRID, file=path), whole)
    assert len(Made(tmp_path).cases()) == 9
    same(bm.merge(path, GRID), whole)


@RESUMED
def test_an_exception_of_the_caller_loses_nothing(tmp_path: Path, whole: Any) -> None:
    def told(done: int, of: int) -> None:
        assert of == 8
        if done == 3:
            raise RuntimeError

    with pytest.raises(RuntimeError) as caught:
        bm.sweep(Made(tmp_path), GRID, jobs=2, progress=told, file=tmp_path / "cases.csv")
    assert caught.value.table["error"].notna().sum() + caught.value.table["b"].notna().sum() == 3
    counts: list[int] = []
    table = bm.sweep(Made(tmp_path), GRID, jobs=2, progress=lambda done, of: counts.append(done), file=tmp_path / "cases.csv")
    same(table, whole)
    assert counts == [4, 5, 6, 7, 8]


PROGRAM = """
import os, signal, sys
sys.path.insert(0, {tests!r})
from pathlib import Path
import basemat as bm
from test_sweep_files import GRID, Made
folder = Path({folder!r})
bm.sweep(Made(folder, lambda: os.kill(os.getpid(), signal.SIGKILL), 5), GRID, file=folder / "cases.csv", jobs={jobs})
"""


@RESUMED
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_killed_process_loses_the_cases_that_ran(tmp_path: Path, whole: Any, jobs: int) -> None:
    program = PROGRAM.format(tests=str(Path(__file__).parent), folder=str(tmp_path), jobs=jobs)
    killed = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=120)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    same(bm.sweep(Made(tmp_path), GRID, file=tmp_path / "cases.csv"), whole)
    made = Made(tmp_path).cases()
    # In threads also cases that end at that moment.
    assert len(set(made)) == 8 and 8 < len(made) <= (9 if jobs == 1 else 12)


def asleep(folder: str, a: float) -> dict[str, float]:
    if a == 3.0 and not os.path.exists(f"{folder}/process"):
        Path(folder, "process").write_text(str(os.getpid()))
        time.sleep(60.0)
    return {"b": a}


@RESUMED
@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_workers_that_outlive_their_parent_hold_no_lock(tmp_path: Path) -> None:
    program = f"""
import multiprocessing, sys
from concurrent.futures import ProcessPoolExecutor
sys.path.insert(0, {str(Path(__file__).parent)!r})
import basemat as bm
from functools import partial
from test_sweep_files import asleep
with ProcessPoolExecutor(1, multiprocessing.get_context("fork")) as pool:
    bm.sweep(partial(asleep, {str(tmp_path)!r}), {{"a": [1.0, 2.0, 3.0, 4.0]}}, executor=pool, file={str(tmp_path / "cases.csv")!r})
"""
    parent = subprocess.Popen([sys.executable, "-c", program])
    process = tmp_path / "process"
    until = time.monotonic() + 60.0
    while not (process.exists() and process.read_text()) and time.monotonic() < until:
        time.sleep(0.05)
    # Time for the rows of the first two cases.
    time.sleep(0.5)
    parent.kill()
    parent.wait()
    try:
        begin = time.monotonic()
        made: list[float] = []

        def case(a: float) -> dict[str, float]:
            made.append(a)
            return {"b": a}

        table = bm.sweep(case, {"a": [1.0, 2.0, 3.0, 4.0]}, file=tmp_path / "cases.csv")
        assert time.monotonic() - begin < 10.0
        assert made == [3.0, 4.0] and table["b"].tolist() == [1.0, 2.0, 3.0, 4.0]
    finally:
        os.kill(int(process.read_text()), signal.SIGKILL)


MANY = {"a": [float(k) for k in range(60)], "name": ["x", "y"]}


def shifted(folder: str, shift: int) -> None:
    """Runs several sweeps whose files other processes write, too."""
    for number in range(6):
        bm.sweep(lambda a, name: {"b": a + shift}, MANY, file=f"{folder}/{number}.csv")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_forked_processes_with_one_file_do_not_mix(tmp_path: Path) -> None:
    context = multiprocessing.get_context("fork")
    workers = [context.Process(target=shifted, args=(str(tmp_path), shift)) for shift in range(3)]
    for worker in workers:
        worker.start()
    good = 0
    while any(worker.is_alive() for worker in workers):
        for path in tmp_path.glob("?.csv"):
            table = bm.merge(path, MANY)
            assert len(table) == 120 and (table["b"] - table["a"]).nunique() == 1
            good += 1
    assert [worker.exitcode for worker in workers] == [0, 0, 0]
    assert good > 10
    assert sorted(os.listdir(tmp_path)) == [f"{number}.csv" for number in range(6)]


def slides(friction: float) -> bm.Simulation:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    ground = bm.ElasticGround.under(bm.Soil(80.0e6, 0.33, 1900.0), block, 2)
    return bm.Simulation(0.05, block, ground, bm.Coulomb(friction), motion=bm.el_centro_1940())


def test_warnings_stay_in_files_and_in_the_table_of_all_shards(tmp_path: Path) -> None:
    grid = {"friction": [0.3, 40.0, 50.0, 0.2]}

    def slip(run: bm.Run) -> dict[str, float]:
        return {"slip": run.residual_slip}

    table = bm.sweep(slides, grid, steps=100, results=slip)
    expected = ["; ".join(slides(own).run(100, warn=False).warnings) or None for own in grid["friction"]]
    assert table["warnings"].tolist() == expected and any(expected)
    paths = [tmp_path / f"{k}.csv" for k in range(2)]
    for k, path in enumerate(paths):
        same(bm.sweep(slides, grid, steps=100, results=slip, shard=(k, 2), file=path), table.iloc[k::2])
    same(bm.merge(paths, grid), table)
    assert pandas.read_csv(paths[0], skiprows=1)["warnings"].dropna().tolist() == [own for own in expected[::2] if own]


@RESUMED
def test_results_that_only_some_cases_have_are_columns(tmp_path: Path) -> None:
    def some(a: float) -> dict[str, float]:
        if a == 1.0:
            raise ValueError
        return {"b": a} if a < 4.0 else {"c": a, "b": 2.0 * a}

    grid = {"a": [1.0, 2.0, 3.0, 4.0, 5.0]}
    table = bm.sweep(some, grid, file=tmp_path / "cases.csv")
    assert table["b"].tolist()[1:] == [2.0, 3.0, 8.0, 10.0] and table["c"].tolist()[3:] == [4.0, 5.0]
    assert table[["b", "c"]].isna().to_numpy().tolist() == [[True, True], [False, True], [False, True], [False] * 2, [False] * 2]
    same(bm.sweep(some, grid, file=tmp_path / "cases.csv"), table)
    same(bm.merge(tmp_path / "cases.csv", grid), table)


def test_shards_of_which_one_has_only_failed_merge(tmp_path: Path) -> None:
    grid = {"a": [2.0, 4.0, 3.0, 5.0], "name": ["x"]}
    paths = [tmp_path / f"{k}.csv" for k in range(2)]

    def even(a: float, name: str) -> dict[str, float]:
        if a < 4.0:
            raise ValueError("below 4")
        return {"b": a}

    with pytest.raises(bm.Error, match=r"all 2 cases failed, .* ValueError: below 4; delete .*0.csv") as caught:
        bm.sweep(even, grid, shard=(0, 2), file=paths[0])
    assert len(caught.value.table) == 2
    bm.sweep(even, grid, shard=(1, 2), file=paths[1])
    for order in (paths, paths[::-1]):
        same(bm.merge(order, grid), bm.sweep(even, grid))


@RESUMED
def test_a_row_that_was_cut_is_made_again_and_a_changed_one_refused(tmp_path: Path, whole: Any) -> None:
    path, part = tmp_path / "cases.csv", tmp_path / "cases.csv.part"
    with pytest.raises(KeyboardInterrupt):
        bm.sweep(Made(tmp_path, raises(KeyboardInterrupt), 7), GRID, file=path)
    content = part.read_bytes()
    part.write_bytes(content + b"6,4.0,x,1.33")
    same(bm.sweep(formula, GRID, file=path), whole)
    path.unlink()
    place = content.index(b"0.333333333333333")
    part.write_bytes(content[: place + 5] + b"4" + content[place + 6 :])
    made: list[float] = []
    with pytest.raises(bm.FileError, match=r"cases.csv.part: .*check sum"):
        bm.sweep(lambda a, name: made.append(a), GRID, file=path)
    assert made == []


def test_no_damage_of_a_file_gives_another_table(tmp_path: Path) -> None:
    grid = {"a": [1.0, 2.0], "name": ["=cmd|calc", "a,b", 'q"uo', "new\nline", "é", "  sp ", "nan", "\r", "#x"]}

    def odd(a: float, name: str) -> dict[str, float]:
        return {"r": 2.0 * a, "x,y": float("nan"), 'quo"te': float("-inf")}

    path = tmp_path / "cases.csv"
    table = bm.sweep(odd, grid, file=path)
    same(bm.merge(path, grid), table)
    raw, rng, accepted = path.read_bytes(), random.Random(1), 0
    for _ in range(1500):
        data = bytearray(raw)
        for _ in range(rng.choice([1, 1, 3])):
            place, kind = rng.randrange(len(data)), rng.randrange(4)
            if kind == 0:
                data[place] ^= 1 << rng.randrange(8)
            elif kind == 1:
                del data[place : place + rng.randrange(1, 30)]
            elif kind == 2:
                data[place:place] = data[place : place + rng.randrange(1, 40)]
            else:
                data[place] = rng.choice(b'0123456789",\n\r')
        path.write_bytes(bytes(data) or b"x")
        try:
            found = bm.merge(path, grid)
        except (bm.FileError, bm.InputError):
            continue
        accepted += 1
        same(found, table)
    assert accepted < 150
