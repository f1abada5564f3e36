"""The scene in OpenSees: a box of quadrilaterals with absorbing sides and base, a rigid block on it.

One run in this process, so that its processor time and memory are those of the run; compare.py
starts it. Prints time series of the block, and on standard error what the run took.

Plane strain, SI units per metre of thickness, x to the right, y up, the surface at y = 0, the middle
of the base at x = 0.

Soil: SSPquad, of the given size near the block, growing to FAR metres (or FAR_SIZES sizes, if those
are longer). Rim: dashpots of Lysmer and Kuhlemeyer, and the velocities and stresses of the vertical
SV wave as nodal forces, exact at every node. Block: a mass on stiff beams. Contact: from node to
node with penalty stiffnesses (zeroLengthContactASDimplex). The weight comes on with the rim held;
the reactions then take the place of the supports.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import openseespy.opensees as ops

SCENE = json.loads((Path(__file__).parent / "scene.json").read_text())

# Half the width of the fine mesh and its depth, m; the way on which elements double, m.
FINE = (7.5, 5.0)
GROWTH = 5.0
# Longest and highest element, m and in sizes of the fine mesh, whichever is longer.
FAR = (5.0, 2.5)
FAR_SIZES = (4.0, 2.0)
# Young's modulus of the block's beams, and stiffness of a contact element per metre of thickness,
# both over Young's modulus of the soil.
STIFF = 1.0e4
PENALTY = 10.0
# Unbalanced force at which a step of the contact is accepted, over the weight.
TOLERANCE = 1.0e-6
# Numerical damping where there is contact; 1 is none.
HHT_ALPHA = 0.9


def pulse(time):
    """Displacement and velocity of the free surface: a Ricker pulse."""
    sigma = SCENE["sigma"]
    amplitude = SCENE["peak_acceleration"] * sigma**2 / 6.0
    a = (time - SCENE["center"]) / sigma
    bell = amplitude * math.exp(-a * a)
    displacement = bell * (1.0 - 2.0 * a * a)
    velocity = bell / sigma * (4.0 * a**3 - 6.0 * a)
    return displacement, velocity


def wave(depth, time):
    """Horizontal velocity and the stress over μ/c (both m/s) of the free field at a depth."""
    delay = depth / SCENE["shear_wave_speed"]
    up, down = pulse(time + delay)[1], pulse(time - delay)[1]
    # u = (f(t + z/c) + f(t − z/c))/2 with z down; τ = μ ∂u/∂y = −μ ∂u/∂z.
    return 0.5 * (up + down), -0.5 * (up - down)


def line(axis, end, h):
    """Coordinates from 0 to `end`: steps of h at first, then growing. The last steps are stretched."""
    fine, largest = FINE[axis], max(FAR_SIZES[axis], FAR[axis] / h)
    points = [k * h for k in range(round(fine / h) + 1)]
    while points[-1] < end - 1e-9:
        points.append(points[-1] + h * min(largest, 1.0 + (points[-1] - fine) / GROWTH))
    stretch = (end - fine) / (points[-1] - fine)
    return [x if x <= fine + 1e-9 else fine + (x - fine) * stretch for x in points]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--size", type=float, required=True, help="element at the block, m")
    options.add_argument("--step", type=float, required=True, help="time step, s")
    options.add_argument("--friction", action="store_true", help="weight, uplift and friction")
    options.add_argument("--half-width", type=float, default=160.0, help="of the box, m")
    options.add_argument("--depth", type=float, default=80.0, help="of the box, m")
    options.add_argument("--system", help="solver instead of the fastest that was found")
    options = options.parse_args()
    h, dt = options.size, options.step

    width, height = SCENE["width"], SCENE["height"]
    rho, speed, nu = SCENE["soil_density"], SCENE["shear_wave_speed"], SCENE["poisson"]
    shear_modulus = rho * speed**2
    young = 2.0 * (1.0 + nu) * shear_modulus
    p_speed = speed * math.sqrt((2.0 - 2.0 * nu) / (1.0 - 2.0 * nu))
    mass = width * height * SCENE["block_density"]
    inertia = mass * (width**2 + height**2) / 12.0

    right = line(0, options.half_width, h)
    xs = [-x for x in reversed(right[1:])] + right
    zs = line(1, options.depth, h)
    columns, rows = len(xs), len(zs)

    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 2)

    def tag(i, j):
        return 1 + i + j * columns

    for j, z in enumerate(zs):
        for i, x in enumerate(xs):
            ops.node(tag(i, j), x, -z)
    ops.nDMaterial("ElasticIsotropic", 1, young, nu, rho)
    element = 0
    for j in range(rows - 1):
        for i in range(columns - 1):
            element += 1
            corners = [tag(i, j + 1), tag(i + 1, j + 1), tag(i + 1, j), tag(i, j)]
            ops.element("SSPquad", element, *corners, 1, "PlaneStrain", 1.0)

    # The block: base nodes on a stiff beam, a stiff mast to the centre of gravity.
    base = [i for i, x in enumerate(xs) if abs(x) <= 0.5 * width + 1e-9]
    middle = next(i for i in base if abs(xs[i]) < 1e-9)
    beam = 1 + columns * rows
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for i in base:
        ops.node(beam + i, xs[i], 0.0)
    center = beam + columns
    ops.node(center, 0.0, 0.5 * height)
    ops.mass(center, mass, mass, inertia)
    ops.geomTransf("Linear", 1)
    stiffness = STIFF * young
    links = [(beam + i, beam + i + 1) for i in base[:-1]] + [(beam + middle, center)]
    for first, second in links:
        element += 1
        ops.element("elasticBeamColumn", element, first, second, width, stiffness, width**3 / 12.0, 1)
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    if options.friction:
        twin = center + 1
        penalty = PENALTY * young
        for i in base:
            ops.node(twin + i, xs[i], 0.0)
            ops.equalDOF(beam + i, twin + i, 1, 2)
            element += 1
            # The axis points from the soil to the block; -intType 1 is the IMPL-EX scheme.
            ops.element("zeroLengthContactASDimplex", element, tag(i, 0), twin + i, penalty,
                        penalty, SCENE["friction"], "-orient", 0.0, 1.0, 0.0, "-intType", 1)
    else:
        for i in base:
            ops.equalDOF(beam + i, tag(i, 0), 1, 2)

    # Rim: lengths, and the impedance of the dashpots.
    def tributary(points, k):
        low, high = points[max(k - 1, 0)], points[min(k + 1, len(points) - 1)]
        return 0.5 * (high - low)

    rim = {}  # node: [impedance x, impedance y, depth, length of the side (sign), of the base]
    for j, z in enumerate(zs):
        for i, sign in ((0, -1.0), (columns - 1, 1.0)):
            length = tributary(zs, j)
            rim[tag(i, j)] = [rho * p_speed * length, rho * speed * length, z, sign * length, 0.0]
    for i in range(columns):
        length = tributary(xs, i)
        entry = rim.setdefault(tag(i, rows - 1), [0.0, 0.0, zs[-1], 0.0, 0.0])
        entry[0] += rho * speed * length
        entry[1] += rho * p_speed * length
        entry[4] = length

    # Weight, with the rim held.
    def analysis():
        ops.constraints("Transformation")
        ops.numberer("RCM")
        if options.friction:
            ops.system(options.system or "UmfPack")
            ops.test("NormUnbalance", TOLERANCE * weight, 50, 0)
            ops.algorithm("Newton")
        else:
            ops.system(options.system or "SuperLU")
            ops.algorithm("Linear", "-factorOnce")

    weight = mass * SCENE["gravity"]
    bottom = {tag(i, rows - 1) for i in range(columns)}
    if options.friction:
        for node in rim:
            ops.fix(node, 1, 1 if node in bottom else 0)
        ops.timeSeries("Constant", 1)
        ops.pattern("Plain", 1, 1)
        ops.load(center, 0.0, -weight, 0.0)
        analysis()
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        if ops.analyze(1) != 0:
            sys.exit("the static state was not found")
        ops.reactions()
        reactions = {node: ops.nodeReaction(node) for node in rim}
        for node in rim:
            ops.remove("sp", node, 1)
            if node in bottom:
                ops.remove("sp", node, 2)
        ops.wipeAnalysis()
    steps_before = math.ceil(options.depth / speed / dt - 1e-9)
    begin = -steps_before * dt
    steps = steps_before + round(SCENE["duration"] / dt)
    ops.loadConst("-time", begin)
    if options.friction:
        # Only now: loadConst freezes the factor that a pattern was last applied with.
        ops.pattern("Plain", 2, 1)
        for node, force in reactions.items():
            ops.load(node, *force)

    # Dashpots.
    materials = {}
    twin = center + 1 + columns
    for k, (node, entry) in enumerate(rim.items()):
        ops.node(twin + k, *ops.nodeCoord(node))
        ops.fix(twin + k, 1, 1)
        for impedance in entry[:2]:
            if impedance not in materials:
                materials[impedance] = 10 + len(materials)
                ops.uniaxialMaterial("Viscous", materials[impedance], impedance, 1.0)
        element += 1
        ops.element("zeroLength", element, twin + k, node, "-mat",
                    *(materials[impedance] for impedance in entry[:2]), "-dir", 1, 2)

    # Forces of the free field, the same series for all nodes of a depth.
    depths = {}
    for node, entry in rim.items():
        depths.setdefault(entry[2], []).append((node, entry))
    times = [begin + k * dt for k in range(steps + 1)]
    for k, (depth, nodes) in enumerate(depths.items()):
        series = [wave(depth, time) for time in times]
        for which in range(2):
            number = 10 + 2 * k + which
            ops.timeSeries("Path", number, "-dt", dt, "-startTime", begin,
                           "-values", *(value[which] for value in series))
            ops.pattern("Plain", number, number)
            for node, (x, _, _, side_length, base_length) in nodes:
                stress = shear_modulus / speed
                if which == 0:
                    ops.load(node, x, 0.0)
                else:
                    # Traction of the outside: τ n_y on the base in x, τ n_x on a side in y.
                    ops.load(node, -stress * base_length, stress * side_length)

    analysis()
    if options.friction:
        ops.integrator("HHT", HHT_ALPHA)
    else:
        ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")

    # At the end of each step: time, roof (displacement, acceleration), rotation, vertical
    # displacement of the base's middle, mean slip, gap at both edges.
    lengths = [tributary([xs[i] for i in base], k) for k in range(len(base))]
    start = None
    iterations = 0
    print("time,roof,acceleration,rotation,vertical,slip,left_gap,right_gap")
    for step in range(steps + 1):
        if step > 0:
            if ops.analyze(1, dt) != 0:
                sys.exit(f"step {step} failed")
            iterations += ops.testIter() if options.friction else 1
        time = begin + step * dt
        u, a = ops.nodeDisp(center), ops.nodeAccel(center)
        base_x, base_y = u[0] + 0.5 * height * u[2], u[1]
        row = [u[0] - 0.5 * height * u[2], 0.0, u[2], base_y, 0.0, 0.0, 0.0]
        if options.friction:
            soil = [ops.nodeDisp(tag(i, 0)) for i in base]
            slip = sum(l * (base_x - s[0]) for l, s in zip(lengths, soil)) / width
            gaps = [base_y + xs[i] * u[2] - ops.nodeDisp(tag(i, 0), 2) for i in (base[0], base[-1])]
            row[4:] = [slip, *gaps]
        if start is None:
            start = row
        row = [now - then for now, then in zip(row, start)]
        row[0] -= pulse(time)[0]
        row[1] = a[0] - 0.5 * height * a[2]
        if time > -0.5 * dt:
            print(",".join(f"{value:.9e}" for value in [time, *row]))
    status = Path("/proc/self/status").read_text()
    kilobytes = next(int(line.split()[1]) for line in status.splitlines() if "VmHWM" in line)
    report = {"megabytes": 1.024e-3 * kilobytes, "dofs": 2 * columns * rows, "steps": steps,
              "solves": iterations}
    print(json.dumps(report), file=sys.stderr)


main()
