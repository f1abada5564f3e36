"""Reads run.npz in a folder with NumPy and compares it with run.csv and contact.csv beside it.

Numbers must be the same to the last bit, an empty cell NaN, contact in long form that of the arrays of
frames and elements. With pandas at hand, its reader of CSV must see the same.
"""

import csv
import pathlib
import sys

import numpy

folder = pathlib.Path(sys.argv[1])
arrays = numpy.load(folder / "run.npz", allow_pickle=False)


def table(name):
    with open(folder / name, newline="", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    return {column: [row[k] for row in rows] for k, column in enumerate(heading)}


def check(name, found, known, close=0.0):
    found, known = numpy.asarray(found), numpy.asarray(known)
    same = found.shape == known.shape
    if same and found.dtype.kind == "f":
        same = numpy.allclose(found, known, rtol=close, atol=0.0, equal_nan=True)
    elif same:
        same = numpy.array_equal(found, known)
    if not same:
        sys.exit(f"{name}: {found} instead of {known}")


def numbers(cells):
    return numpy.array([float(cell) if cell else numpy.nan for cell in cells])


run = table("run.csv")
for column, cells in run.items():
    check(column, arrays[column], numbers(cells))

contact = table("contact.csv")
shape = arrays["contact_gap_m"].shape
for name in ["gap_m", "slip_m", "pressure_pa", "shear_pa"]:
    check(name, arrays[f"contact_{name}"], numbers(contact[name]).reshape(shape))
modes = arrays["contact_mode_words"][arrays["contact_mode"]]
check("mode", modes, numpy.array(contact["mode"]).reshape(shape))
check("time", numpy.repeat(arrays["contact_time_s"], shape[1]), numbers(contact["time_s"]))
check("left", numpy.tile(arrays["element_left_m"], shape[0]), numbers(contact["left_m"]))
check("right", numpy.tile(arrays["element_right_m"], shape[0]), numbers(contact["right_m"]))
frames = len(arrays["motion_time_s"])
for name in ["motion_displacement", "motion_velocity", "motion_free_field_m"]:
    if arrays[name].ndim != 2 or len(arrays[name]) != frames:
        sys.exit(f"{name}: {arrays[name].shape}")

by = "the csv module"
try:
    import pandas
except ImportError:
    pass
else:
    by += " and pandas"
    # Its parser may miss the last bits.
    frame = pandas.read_csv(folder / "run.csv")
    for column in run:
        if frame[column].dtype != float:
            sys.exit(f"{column}: pandas reads {frame[column].dtype}")
        check(column, frame[column], arrays[column], 1e-14)
    long = pandas.read_csv(folder / "contact.csv")
    wide = long.pivot(index="time_s", columns="element", values="pressure_pa")
    check("pivot", wide.to_numpy(), arrays["contact_pressure_pa"], 1e-14)

print(f"{len(arrays.files)} arrays by NumPy {numpy.__version__}, {len(run)} columns by {by}: the same")
