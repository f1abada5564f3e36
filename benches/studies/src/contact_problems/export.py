#!/usr/bin/env python3
"""Writes frictional contact problems of FCLIB and of the tests of Siconos as plain text for `cargo study contact-problems`.

    python3 -m venv target/fclib-env
    target/fclib-env/bin/pip install numpy h5py
    git clone https://github.com/siconos/siconos target/siconos          # Apache 2.0
    target/fclib-env/bin/python benches/studies/src/contact_problems/export.py \
        target/siconos/numerics/src/FrictionContact/test/data target/published_problems
    cargo study contact-problems --published target/published_problems --docs docs

Read are HDF5 files of FCLIB, local (W, q, mu) and global (M, H, f, w, mu: W = H' M^-1 H, q = H' M^-1 f + w), and text files of
Siconos with a dense matrix or one of blocks. The problem is u = W r + q with r in Coulomb's cone.

A file that is written has the dimension, the number of contacts, and the least over the greatest eigenvalue of W; then the
friction of each contact, q, and the rows of W: first all normal components, then all along x, in space all along y.
"""

import sys
from pathlib import Path

import h5py
import numpy as np

# Larger problems are left out: their text would have 2 million numbers and more.
MOST = 1400


def dense_or_blocks(words):
    """Matrix of a text file."""
    kind, rows, columns = (int(next(words)) for _ in range(3))
    if kind == 0:
        next(words), next(words)
        return np.array([float(next(words)) for _ in range(rows * columns)]).reshape(rows, columns)
    if kind != 1:
        raise ValueError(f"storage {kind} is not read")
    blocks, *lines = (int(next(words)) for _ in range(3))
    ends = [[0] + [int(next(words)) for _ in range(count)] for count in lines]
    counts = [int(next(words)) for _ in range(2)]
    begins, block_columns = ([int(next(words)) for _ in range(count)] for count in counts)
    matrix = np.zeros((rows, columns))
    for number in range(blocks):
        if int(next(words)) != number:
            raise ValueError("blocks are not in order")
        row = next(r for r in range(len(begins) - 1) if begins[r] <= number < begins[r + 1])
        ranges = [slice(*ends[k][place : place + 2]) for k, place in enumerate((row, block_columns[number]))]
        shape = tuple(own.stop - own.start for own in ranges)
        values = [float(next(words)) for _ in range(shape[0] * shape[1])]
        matrix[tuple(ranges)] = np.array(values).reshape(shape, order="F")
    return matrix


def of_text(path):
    """Dimension, W, q and friction of a text file of Siconos."""
    words = iter(path.read_text().split())
    dimension, contacts = int(next(words)), int(next(words))
    matrix = dense_or_blocks(words)
    velocity = np.array([float(next(words)) for _ in range(dimension * contacts)])
    return dimension, matrix, velocity, np.array([float(next(words)) for _ in range(contacts)])


def sparse(group):
    """Matrix of a group of FCLIB: triplets, or columns (nz = -1) or rows (nz = -2) one after the other."""
    kind = int(group["nz"][0])
    matrix = np.zeros((int(group["m"][0]), int(group["n"][0])))
    inner, outer, values = group["i"][:], group["p"][:], group["x"][:]
    if kind < 0:
        outer = np.repeat(np.arange(len(outer) - 1), np.diff(outer))
    rows, columns = (outer, inner) if kind == -2 else (inner, outer)
    count = kind if kind >= 0 else len(outer)
    np.add.at(matrix, (rows[:count], columns[:count]), values[:count])
    return matrix


def of_fclib(path):
    """Dimension, W, q and friction of a file of FCLIB."""
    with h5py.File(path) as file:
        if "fclib_local" in file:
            group = file["fclib_local"]
            matrix, velocity = sparse(group["W"]), group["vectors/q"][:]
        else:
            group = file["fclib_global"]
            mass, lever = sparse(group["M"]), sparse(group["H"])
            answer = np.linalg.solve(mass, np.column_stack([lever, group["vectors/f"][:]]))
            matrix = lever.T @ answer[:, :-1]
            velocity = lever.T @ answer[:, -1] + group["vectors/w"][:]
        return int(group["spacedim"][0]), matrix, velocity, group["vectors/mu"][:]


def main():
    source, target = (Path(name) for name in sys.argv[1:3])
    target.mkdir(parents=True, exist_ok=True)
    written = set()
    for path in sorted(source.iterdir()):
        # Text files of global problems have another layout.
        if path.name.lower().startswith("gfc") and "condensed" not in path.name:
            continue
        try:
            dimension, matrix, velocity, friction = (of_fclib if path.suffix == ".hdf5" else of_text)(path)
        except (ValueError, StopIteration) as error:
            print(f"{path.name}: left out ({error or 'another format'})")
            continue
        if len(velocity) > MOST or len(velocity) != len(matrix):
            print(f"{path.name}: left out ({len(velocity)} components, matrix of {len(matrix)})")
            continue
        eigenvalues = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
        order = np.arange(len(velocity)).reshape(-1, dimension).T.ravel()
        lines = [f"{dimension} {len(friction)} {float(eigenvalues[0] / eigenvalues[-1])!r}", friction, velocity[order]]
        lines += list(matrix[np.ix_(order, order)])
        text = [line if isinstance(line, str) else " ".join(repr(float(value)) for value in line) for line in lines]
        text = "\n".join(text) + "\n"
        # Some are there twice, with blocks and without.
        if text in written:
            continue
        written.add(text)
        name = path.name.removesuffix(".dat").removesuffix(".hdf5")
        (target / f"{name}.txt").write_text(text)
    print(f"problems in {target}")


if __name__ == "__main__":
    main()
