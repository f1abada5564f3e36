"""Tables of many cases."""

from __future__ import annotations

import concurrent.futures
import os
import signal
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import basemat as bm

pandas = pytest.importorskip("pandas")


def make(friction: float, peak: float) -> bm.Simulation:
    if friction == 0.25:
        raise ValueError("no such friction")
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    ground = bm.ElasticGround.under(bm.Soil(80.0e6, 0.33, 1900.0), block, 6)
    motion = bm.el_centro_1940().scaled_to_peak(peak)
    return bm.Simulation(0.01, block, ground, bm.Coulomb(friction), motion=motion)


def results(run: bm.Run) -> dict[str, float]:
    return {"shear": run.base_shear.magnitude, "slip": run.residual_slip}


GRID = {"friction": [0.2, 0.25, 0.3], "peak": [1.0, 3.0]}


def test_one_row_per_case_in_order_and_errors_beside_results() -> None:
    table = bm.sweep(make, GRID, steps=300, results=results)
    assert list(table.columns) == ["friction", "peak", "shear", "slip", "warnings", "error"]
    assert list(zip(table["friction"], table["peak"])) == [
        (0.2, 1.0),
        (0.2, 3.0),
        (0.25, 1.0),
        (0.25, 3.0),
        (0.3, 1.0),
        (0.3, 3.0),
    ]
    failed = table["friction"] == 0.25
    assert set(table["error"][failed]) == {"ValueError: no such friction"}
    assert all(error is None for error in table["error"][~failed])
    assert table["shear"][failed].isna().all()
    expected = make(0.3, 3.0).run(300).base_shear.magnitude
    assert table["shear"].iloc[-1] == expected


@pytest.mark.parametrize("jobs", [2, 0])
def test_threads_change_nothing(jobs: int) -> None:
    one = bm.sweep(make, GRID, steps=300)
    told = []
    many = bm.sweep(
        make, GRID, steps=300, jobs=jobs, progress=lambda done, of: told.append((done, of))
    )
    pandas.testing.assert_frame_equal(one, many, check_exact=True)
    assert told == [(k, 6) for k in range(1, 7)]


def test_processes_change_nothing() -> None:
    one = bm.sweep(make, GRID, steps=100, results=results)
    with concurrent.futures.ProcessPoolExecutor(2) as executor:
        many = bm.sweep(make, GRID, steps=100, results=results, executor=executor)
    pandas.testing.assert_frame_equal(one, many, check_exact=True)


def on_a_raft(thickness: float, friction: float) -> bm.Simulation:
    """A mat of shells with a mass on a pole, which bends, lifts and slides."""
    mesh, line, concrete = bm.Mesh.in_space(), np.linspace(-3.0, 3.0, 4), bm.Material(30e9, 0.2, 2500.0)
    x, y = np.meshgrid(line, line)
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, concrete, thickness)
    foot, top = mesh.node_at(1.0, 1.0), mesh.add_node(1.0, 1.0, 8.0)
    mesh.add_space_beams([[foot, top]], concrete, bm.BeamSection(1.0, (0.1, 0.1), 0.15), (1.0, 0.0, 0.0))
    mesh.add_mass(top, 30e3)
    model = bm.FemModel(mesh)
    ground = bm.ElasticGround.under(bm.Soil(80e6, 0.25, 1900.0), model, 4)
    motion = bm.triaxial(x=bm.el_centro_1940(), y=bm.el_centro_1940().scaled(0.6))
    probe = bm.Probe.displacement("top", model.row(top, "x"))
    return bm.Simulation(0.01, model, ground, bm.Coulomb(friction), motion=motion, probes=[probe])


def raft_results(run: bm.Run) -> dict[str, float]:
    return {"top": run.probes["top"].magnitude, "torque": run.extremes("torque").magnitude, "open": run.uplifted_fraction.value}


def test_models_in_space_sweep_in_processes_to_the_same_bits(tmp_path: Path) -> None:
    grid = {"thickness": [0.4, 0.8], "friction": [0.2, 0.5]}
    with concurrent.futures.ProcessPoolExecutor(2) as executor:
        table = bm.sweep(on_a_raft, grid, steps=250, results=raft_results, executor=executor, file=tmp_path / "rafts.csv")
    assert table["error"].isna().all()
    for _, row in table.iterrows():
        own = raft_results(on_a_raft(row["thickness"], row["friction"]).run(250))
        assert {name: row[name] for name in own} == own
    # The cases differ, and the mats lift and turn.
    assert table["top"].nunique() == 4 and (table[["open", "torque"]] > 0.0).all(axis=None)
    pandas.testing.assert_frame_equal(bm.merge(tmp_path / "rafts.csv", grid)[list(own)], table[list(own)], check_exact=True)


def dies(case: int) -> dict[str, int]:
    if case == 2:
        os._exit(1)
    return {"value": case}


def test_a_worker_that_dies_leaves_a_row_with_an_error() -> None:
    with concurrent.futures.ProcessPoolExecutor(1) as executor:
        table = bm.sweep(dies, [{"case": k} for k in range(3)], executor=executor)
    assert len(table) == 3
    assert "BrokenProcessPool" in table["error"].iloc[2]


def sometimes(case: int) -> dict[str, int]:
    if case in (7, 30):
        os._exit(1)
    time.sleep(0.002)
    return {"value": case}


@pytest.mark.parametrize("workers", [1, 3])
def test_a_process_that_dies_costs_one_case(workers: int) -> None:
    told: list[tuple[int, int]] = []
    with concurrent.futures.ProcessPoolExecutor(workers) as executor:
        table = bm.sweep(
            sometimes,
            {"case": range(40)},
            executor=executor,
            progress=lambda done, of: told.append((done, of)),
        )
    assert list(table.index[table["error"].notna()]) == [7, 30]
    assert table["error"].str.contains("BrokenProcessPool")[[7, 30]].all()
    good = table.drop([7, 30])
    assert good["value"].tolist() == good["case"].tolist()
    assert told == [(k, 40) for k in range(1, 41)]


def test_make_may_return_a_run_or_a_mapping() -> None:
    assert list(bm.sweep(lambda a: {"b": a * a}, {"a": [2, 3]})["b"]) == [4, 9]
    table = bm.sweep(lambda friction: make(friction, 2.0).run(50), {"friction": [0.3]})
    assert table["end"].iloc[0] == 0.5
    table = bm.sweep(lambda a: a if a == 2 else {"b": a}, {"a": [2, 3]})
    assert table["error"].iloc[0].startswith("TypeError: make returned int") and table["b"].iloc[1] == 3


def test_warnings_are_a_column() -> None:
    """One of the cases slides further than an element is long; nothing is said beside the table."""

    def shaken(peak: float) -> bm.Simulation:
        return make(0.05, peak)

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = bm.sweep(shaken, {"peak": [0.5, 60.0]}, steps=1000)
    quiet, loud = table["warnings"]
    own = make(0.05, 60.0).run(1000, warn=False)
    assert pandas.isna(quiet) and loud == "; ".join(own.warnings) and "slip" in loud
    with pytest.warns(bm.BasematWarning) as caught:
        make(0.05, 60.0).run(1000)
    assert [str(warning.message) for warning in caught] == own.warnings
    assert {warning.filename for warning in caught} == {__file__}
    with pytest.raises(ValueError, match="'warnings'"):
        bm.sweep(shaken, {"warnings": [1.0]})

    # Also of runs that make runs itself, in any thread.
    for jobs in (1, 2):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = bm.sweep(lambda peak: {"steps": shaken(peak).run(1000).steps}, {"peak": [0.5, 60.0]}, jobs=jobs)
        assert table["warnings"].tolist() == [None, loud]


def test_a_frame_has_a_case_in_each_row() -> None:
    cases = [{"a": 2, "b": "x"}, {"a": 3, "b": "y"}]
    tables = [bm.sweep(lambda a, b: {"c": f"{a}{b}"}, grid) for grid in (cases, pandas.DataFrame(cases))]
    assert tables[0]["c"].tolist() == ["2x", "3y"]
    pandas.testing.assert_frame_equal(*tables)
    with pytest.raises(bm.InputError, match="grid is 'ab', but must be names with lists of values"):
        bm.sweep(lambda a: {"b": a}, "ab")


def test_all_cases_that_fail_are_an_error_with_the_first_of_them() -> None:
    def fails(a: int) -> dict[str, int]:
        if a < 4:
            raise KeyError(f"no {a}")
        return {"b": a}

    with pytest.raises(bm.Error, match=r"all 2 cases failed, the first of them with KeyError: 'no 2'$") as caught:
        bm.sweep(fails, {"a": [2, 3]})
    assert caught.value.table["error"].tolist() == ["KeyError: 'no 2'", "KeyError: 'no 3'"]
    assert bm.sweep(fails, {"a": [2, 4]})["error"].isna().tolist() == [False, True]
    assert len(bm.sweep(fails, [])) == 0


def test_a_parameter_called_error_is_refused_before_anything_runs() -> None:
    made = []
    with pytest.raises(ValueError, match="'error'"):
        bm.sweep(lambda **case: made.append(case), [{"a": 1}, {"error": 2}])
    assert made == []


@pytest.mark.parametrize("value", [1.0, "sand"])
def test_a_parameter_with_a_value_in_place_of_a_list_is_refused(value: object) -> None:
    made: list[object] = []
    with pytest.raises(bm.InputError, match=f"grid: soil is {value!r}, but must be a list of values"):
        bm.sweep(lambda **case: made.append(case), {"soil": value})
    assert made == []


def test_a_result_with_the_name_of_another_column_is_an_error_of_its_row() -> None:
    results = {2: {"a": 0.0, "b": 0.0}, 3: {"b": 5.0}, 4: {"error": "none"}}
    table = bm.sweep(lambda a: results[a], {"a": [2, 3, 4]})
    assert list(table.columns) == ["a", "b", "warnings", "error"] and list(table["a"]) == [2, 3, 4]
    assert table["b"].iloc[1] == 5.0 and table["b"].isna().tolist() == [True, False, True]
    assert "another column, 'a'" in table["error"].iloc[0]
    assert "another column, 'error'" in table["error"].iloc[2]
    assert table["error"].isna().tolist() == [False, True, False]


def area(width: float, soil: str) -> dict[str, object]:
    if width == 6.0 and soil == "clay, soft":
        raise ValueError("no\nsuch case")
    return {"area": width * width / 3.0, "flat": width < 5.0, "none": None}


AREAS = {"width": [4, 6.0], "soil": ["sand", "clay, soft", 'gravel "0/32"']}


def test_files_of_shards_merge_to_the_table(tmp_path: Path) -> None:
    whole = bm.sweep(area, AREAS, file=tmp_path / "whole.csv")
    for index in range(2):
        part = bm.sweep(area, AREAS, shard=(index, 2), file=str(tmp_path / f"{index}.csv"))
        pandas.testing.assert_frame_equal(
            part, whole.iloc[index::2], check_exact=True, check_dtype=False
        )
    merged = bm.merge([tmp_path / "1.csv", tmp_path / "0.csv"], AREAS)
    pandas.testing.assert_frame_equal(merged, bm.merge(tmp_path / "whole.csv", AREAS))
    assert list(merged.columns) == ["width", "soil", "area", "flat", "none", "warnings", "error"]
    assert [error is None for error in merged["error"]] == [True] * 4 + [False, True]
    assert merged["error"][4] == "ValueError: no\nsuch case"
    right = merged.drop(4)
    assert right["area"].tolist() == whole.drop(4)["area"].tolist() and right["none"].isna().all()
    assert right["flat"].tolist() == [1.0, 1.0, 1.0, 0.0, 0.0]
    first, heading, row, *_ = (tmp_path / "whole.csv").read_text("utf-8").splitlines()
    assert heading == "case,width,soil,area,flat,none,error"
    assert first.startswith("# basemat sweep 1 check sum ") and int(first[-16:], 16)
    assert row == "0,4.0,sand,5.333333333333333,1.0,,"
    read = pandas.read_csv(tmp_path / "whole.csv", skiprows=1)
    assert read["area"].dropna().tolist() == right["area"].tolist() and read["soil"].tolist() == merged["soil"].tolist()

    with pytest.raises(bm.FileError, match=r"3 of the sweep's cases missing: .*shard 1/2"):
        bm.merge(tmp_path / "0.csv", AREAS)
    text = (tmp_path / "whole.csv").read_text("utf-8")
    (tmp_path / "whole.csv").write_text(text.replace("5.333333333333333", "5.333333333333334", 1), "utf-8")
    with pytest.raises(bm.FileError, match=r"whole.csv: .*check sum"):
        bm.merge(tmp_path / "whole.csv", AREAS)


def test_a_file_needs_numbers_and_is_refused_before_anything_runs(tmp_path: Path) -> None:
    made: list[object] = []
    for grid in ({"a": [1.0, 1.0]}, {"a": [object()]}, [{"a": 1.0}], {"error": [1.0]}):
        with pytest.raises((bm.InputError, TypeError)):
            bm.sweep(lambda **case: made.append(case), grid, file=tmp_path / "cases.csv")
    with pytest.raises(bm.InputError, match=r"shard is \(2, 2\)"):
        bm.sweep(lambda **case: made.append(case), {"a": [1.0]}, shard=(2, 2))
    assert made == []
    with pytest.raises(bm.InputError, match="real number") as caught:
        bm.sweep(lambda a: {"b": "text"}, {"a": [1.0]}, file=tmp_path / "cases.csv")
    assert caught.value.table["b"].tolist() == ["text"]
    (tmp_path / "folder").write_text("no folder")
    with pytest.raises(bm.FileError, match="cannot be written"):
        bm.sweep(lambda **case: made.append(case), {"a": [1.0]}, file=tmp_path / "folder" / "cases.csv")
    assert made == []


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_ends_all_threads() -> None:
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        bm.sweep(lambda k: make(0.3, 1.0).run(10**6, series=False), {"k": range(8)}, jobs=2)
    assert time.monotonic() - begin < 10.0
