#!/usr/bin/env python3
"""Runs the scene of scene.json in OpenSees and in the crate, one after the other, and compares.

    python3 -m venv target/opensees-env
    target/opensees-env/bin/pip install -r benches/studies/src/opensees/requirements.txt
    target/opensees-env/bin/python benches/studies/src/opensees/compare.py --docs docs

openseespy needs the system's BLAS and LAPACK (Debian: libopenblas0 liblapack3). Prints Markdown;
--docs puts it between the markers of benches/studies/tables/opensees.md and draws the picture beside it. Every run is a
process of its own: the system tells its processor time, itself its peak resident memory.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[3]
CRATE = ROOT / (os.environ.get("CARGO_TARGET_DIR") or "target") / "release" / "studies"
NAMES = ["time", "roof", "acceleration", "rotation", "vertical", "slip", "left_gap", "right_gap"]
CASES = ("bonded", "friction")
# Elements under the base: (size, m; time step, s), for the bonded base and for contact.
BOXES = {"bonded": [(1.25, 2.5e-3), (0.625, 1.25e-3), (0.3125, 6.25e-4)],
         "friction": [(2.5, 1e-3), (1.25, 5e-4), (0.625, 2.5e-4)]}
# The coarse mesh again with the finest step, because contact asks for short steps.
SHORT_STEP = (2.5, 2.5e-4)
MESHES = [(8, 4e-3), (16, 2e-3), (32, 1e-3)]
# The reference and the mesh that says how far it has converged.
FINEST = [(64, 5e-4), (128, 2.5e-4)]
# A run shorter than this is made three times, and the least time counts.
ONCE = 10.0
MARKERS = ("<!-- opensees: begin -->", "<!-- opensees: end -->")


def measured(name, command, folder, reuse):
    """Runs a command; gives its time series, processor seconds, peak MB and what it reports."""
    series, notes = folder / f"{name}.csv", folder / f"{name}.json"
    if not (reuse and notes.exists()):
        best = None
        while best is None or (best["seconds"] < ONCE and best["runs"] < 3):
            with open(series, "w") as out, open(folder / f"{name}.log", "w") as log:
                environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
                process = subprocess.Popen(command, stdout=out, stderr=log, env=environment)
                _, status, usage = os.wait4(process.pid, 0)
            log = (folder / f"{name}.log").read_text()
            if status != 0:
                sys.exit(f"{name}: {log}")
            report = [json.loads(line) for line in log.splitlines() if line.startswith("{")]
            # Not ru_maxrss: it starts from this process's own.
            seconds = usage.ru_utime + usage.ru_stime
            best = {
                "seconds": min(seconds, best["seconds"] if best else seconds),
                "runs": best["runs"] + 1 if best else 1,
                **(report[0] if report else {}),
            }
        notes.write_text(json.dumps(best))
        print(name, best, file=sys.stderr)
    rows = np.loadtxt(series, delimiter=",", skiprows=1)
    return {**json.loads(notes.read_text()), **dict(zip(NAMES, rows.T))}


def of_opensees(case, size, step, folder, reuse, half_width=None, depth=None):
    command = [sys.executable, str(HERE / "soil_box.py"), "--size", str(size), "--step", str(step)]
    name = f"opensees_{case}_{size}"
    if case == "friction":
        command.append("--friction")
    if half_width:
        command += ["--half-width", str(half_width), "--depth", str(depth)]
        name += "_large"
    if case == "friction" and (size, step) == SHORT_STEP:
        name += "_short_step"
    return measured(name, command, folder, reuse)


def of_crate(case, elements, step, folder, reuse):
    command = [str(CRATE), "opensees", "--elements", str(elements), "--step", str(step)]
    if case == "friction":
        command.append("--friction")
    run = measured(f"crate_{case}_{elements}", command, folder, reuse)
    # The midpoint rule's acceleration is the mean over the step.
    run["acceleration"] = np.interp(
        run["time"], run["time"] - 0.5 * step, run["acceleration"], right=run["acceleration"][-1]
    )
    return run


def at(run, name, times):
    return np.interp(times, run["time"], run[name])


def distance(run, reference, name):
    """Relative root mean square of the difference, per cent of the reference's."""
    wanted = at(reference, name, run["time"])
    return 100.0 * np.sqrt(np.mean((run[name] - wanted) ** 2) / np.mean(wanted**2))


def peak(run, reference, name):
    wanted = np.abs(reference[name]).max()
    return 100.0 * (np.abs(run[name]).max() / wanted - 1.0)


def extrapolated(runs):
    """What meshes of elements h and h/2 tend to where the error is proportional to h.

    It is with tractions that are singular at the edges of a base. The second answer is by how much
    less the last halving changes the run than the one before, name by name: 2 where that holds.
    """
    times, ratios = runs[0]["time"], {}
    limit = {"time": times}
    for name in NAMES[1:]:
        coarse, middle, fine = (at(run, name, times) for run in runs)
        limit[name] = 2.0 * fine - middle
        last = np.linalg.norm(fine - middle)
        ratios[name] = np.linalg.norm(middle - coarse) / last if last > 0.0 else np.nan
    return limit, ratios


def digits(value, sign=""):
    """Two digits, never as a power of ten."""
    return f"{value:{sign}.0f}" if abs(value) >= 10.0 else f"{value:{sign}.2g}"


def row(label, dofs, step, run, reference, case):
    cells = [label, dofs, f"{1e3 * step:g}" if step else "",
             digits(distance(run, reference, "roof")), digits(peak(run, reference, "roof"), "+"),
             digits(distance(run, reference, "rotation")),
             digits(peak(run, reference, "rotation"), "+"),
             digits(distance(run, reference, "acceleration"))]
    if case == "friction":
        cells += [f"{1e3 * run['left_gap'].max():.1f}", f"{1e3 * run['slip'][-1]:.2f}"]
    if "seconds" in run:
        cells += [digits(run["seconds"]), f"{run['megabytes']:.0f}"]
    else:
        cells += ["", ""]
    return "| " + " | ".join(cells) + " |\n"


def table(case, boxes, meshes, extra, reference, finer):
    heads = ["", "dofs", "Δt, ms", "roof, %", "its peak, %", "rotation, %", "its peak, %",
             "acceleration, %"]
    if case == "friction":
        heads += ["largest gap, mm", "slip left, mm"]
    heads += ["processor, s", "MB"]
    text = "| " + " | ".join(heads) + " |\n|" + "---|" * len(heads) + "\n"
    for (size, step), run in zip(BOXES[case], boxes):
        text += row(f"OpenSees, {size:g} m", str(run["dofs"]), step, run, reference, case)
    if case == "friction":
        size, step = SHORT_STEP
        text += row(f"OpenSees, {size:g} m, short steps", str(extra["dofs"]), step, extra,
                    reference, case)
    else:
        limit, ratios = extrapolated(boxes)
        text += row("OpenSees, extrapolated", "", 0.0, limit, reference, case)
    for (elements, step), run in zip(MESHES, meshes):
        text += row(f"basemat, {elements} elements", str(2 * elements + 3), step, run, reference, case)
    text += row(f"basemat, {FINEST[0][0]} elements", str(2 * FINEST[0][0] + 3), FINEST[0][1],
                finer, reference, case)
    if case == "friction":
        text += (f"\nReference: largest gap {1e3 * reference['left_gap'].max():.1f} mm, slip left "
                 f"{1e3 * reference['slip'][-1]:.2f} mm.")
    else:
        middle = boxes[1]
        text += (f"\nOpenSees' second halving changes the roof {ratios['roof']:.2f} times less than "
                 f"its first, the rotation {ratios['rotation']:.2f} times. A box twice as wide "
                 f"and deep changes the second mesh by "
                 f"{distance(middle, extra, 'roof'):.2g} % (roof) and "
                 f"{distance(middle, extra, 'rotation'):.2g} % (rotation).")
    return text + "\n"


def picture(path, results):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "basemat", "font.size": 10})
    shades = ["#c6dbef", "#6baed6", "#2171b5"]
    figure, axes = plt.subplots(2, 2, figsize=(11, 6.4), width_ratios=[2, 1])
    for line, case in zip(axes, CASES):
        boxes, meshes, _, reference, _ = results[case]
        times = np.arange(0.3, reference["time"][-1], 5e-3)
        for run, (size, _), shade in zip(boxes, BOXES[case], shades):
            line[0].plot(times, 1e3 * at(run, "rotation", times), color=shade,
                         label=f"OpenSees, {size:g} m")
        line[0].plot(times, 1e3 * at(meshes[0], "rotation", times), color="#d62728",
                     linestyle=(0, (4, 3)), label=f"basemat, {MESHES[0][0]} elements")
        line[0].plot(times, 1e3 * at(reference, "rotation", times), color="#282828", linewidth=1.0,
                     label="reference")
        line[0].set_ylabel("rotation, mrad")
        title = "bonded" if case == "bonded" else "weight, uplift and friction"
        line[0].set_title(title, loc="left", fontsize=10)
        for runs, color, name, mark in ((boxes, "#2171b5", "OpenSees", "o"),
                                        (meshes, "#d62728", "basemat", "s")):
            line[1].loglog([run["seconds"] for run in runs],
                           [distance(run, reference, "rotation") for run in runs],
                           color=color, marker=mark, label=name)
        line[1].set_ylabel("error of the rotation, %")
        for axis in line:
            axis.grid(True, color="#e0e0e0", linewidth=0.6)
            axis.spines[["top", "right"]].set_visible(False)
    axes[0, 0].legend(frameon=False, ncols=2, fontsize=9, loc="lower right")
    axes[0, 1].legend(frameon=False, fontsize=9)
    axes[1, 0].set_xlabel("time, s")
    axes[1, 1].set_xlabel("processor time, s")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def machine():
    """What everything was measured on and with."""
    def tell(*command):
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        return done.stdout.strip() or "unknown"

    name = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                 if line.startswith("model name")), platform.machine())
    return (f"{name}, one thread each; openseespy {version('openseespy')}, Python "
            f"{platform.python_version()}; {tell('rustc', '--version')}, sources "
            f"{tell('git', 'describe', '--always', '--dirty', '--tags')}.")


def short(folder, reuse):
    """Fails unless both programs agree on the coarsest box as the table of the documents has it: 10 % of the roof."""
    box, mesh = of_opensees("bonded", *BOXES["bonded"][0], folder, reuse), of_crate("bonded", *MESHES[0], folder, reuse)
    error = distance(box, mesh, "roof")
    print(f"roof, OpenSees beside the crate: {digits(error)} %; {digits(box['seconds'])} s, {digits(mesh['seconds'])} s")
    sys.exit(error > 15.0)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--docs", type=Path, help="folder of the documentation, written to")
    options.add_argument("--out", type=Path, default=ROOT / "target" / "opensees")
    options.add_argument("--reuse", action="store_true", help="take runs that are in --out already")
    options.add_argument("--only", choices=CASES, help="run this case and stop")
    options.add_argument("--short", action="store_true", help="check the bonded case on the coarsest mesh and stop")
    options = options.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    build = ["cargo", "build", "--quiet", "--release", "--package", "basemat-studies"]
    subprocess.run(build, cwd=ROOT, check=True)
    where = (options.out, options.reuse)
    if options.short:
        return short(*where)
    results, text = {}, machine() + "\n"
    for case in [options.only] if options.only else CASES:
        boxes, meshes = [], []
        # In turn, so that both programs find the machine in the same state.
        for box, mesh in zip(BOXES[case], MESHES):
            meshes.append(of_crate(case, *mesh, *where))
            boxes.append(of_opensees(case, *box, *where))
        finer, reference = (of_crate(case, *mesh, *where) for mesh in FINEST)
        if case == "bonded":
            extra = of_opensees(case, *BOXES[case][1], *where, half_width=320.0, depth=160.0)
        else:
            extra = of_opensees(case, *SHORT_STEP, *where)
        results[case] = (boxes, meshes, extra, reference, finer)
        title = "Bonded" if case == "bonded" else "Weight, uplift and friction"
        text += f"\n### {title}\n\n{table(case, boxes, meshes, extra, reference, finer)}"
    print(text)
    if options.docs and not options.only:
        path = Path(__file__).parents[2] / "tables" / "opensees.md"
        before, rest = path.read_text().split(MARKERS[0])
        after = rest.split(MARKERS[1])[1]
        path.write_text(f"{before}{MARKERS[0]}\n\n{text.strip()}\n\n{MARKERS[1]}{after}")
        picture(options.docs / "images" / "opensees.svg", results)


main()
