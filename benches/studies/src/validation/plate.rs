//! Flexible plates: Hertz's on springs, Boussinesq's even load, a disc from flexible to rigid.

use basemat::Simulation;
use basemat::Soil;
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, SpringGround};
use basemat::coupled::{Load, SimulationBuilder};
use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::STANDARD_GRAVITY;
use basemat::reference::{hertz_plate_settlement, loaded_rectangle_settlement};
use basemat::structure::FemModel;
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "plate",
    title: "Flexible plates on springs and on a half-space",
    reference: "Hertz's infinite plate on springs under a force, P/(8√(kD)); Boussinesq's settlement under an even load; discs: Ritz solution in Legendre polynomials on the exact half-space",
    settings: "square plates of 8 × 8, 16 × 16 and 24 × 24 shells, one cell each; discs of 8 rings of 24 shells, 16 cells across, ν = 1/3, without friction or mass",
    run,
};

const YOUNG_MODULUS: f64 = 30.0e9;
const POISSON_RATIO: f64 = 0.2;
const MASS_DENSITY: f64 = 2400.0;

/// A plate, and the nodes of its settlements.
struct Plate {
    model: FemModel,
    nodes: Vec<usize>,
}

/// Plate of `count` × `count` shells.
fn plate(side: f64, thickness: f64, count: usize) -> Result<Plate, AnyError> {
    let material = Material::new(YOUNG_MODULUS, POISSON_RATIO, MASS_DENSITY)?;
    let mut mesh = Mesh::in_space();
    let coordinates: Vec<f64> =
        (0..=count).map(|k| side * (k as f64 / count as f64 - 0.5)).collect();
    let mut nodes = Vec::new();
    for &x in &coordinates {
        for &y in &coordinates {
            nodes.push(mesh.add_node_at([x, y, 0.0])?);
        }
    }
    for i in 0..count {
        for j in 0..count {
            let first = i * (count + 1) + j;
            let next_node = first + count + 1;
            let corners = [nodes[first], nodes[next_node], nodes[next_node + 1], nodes[first + 1]];
            mesh.add(Shell::new(corners, material, thickness)?)?;
        }
    }
    Ok(Plate { model: FemModel::on_base(mesh)?, nodes })
}

/// Settlements (m) of the nodes along the middle line, from the middle out, under downward forces at nodes.
fn settlements(
    mut builder: SimulationBuilder,
    plate: &Plate,
    forces: &[(usize, f64)],
    count: usize,
) -> Result<Vec<f64>, AnyError> {
    for &(node, force) in forces {
        builder = builder.load(Load::constant(plate.model.row(node, Direction::Z)?, -force));
    }
    let simulation = builder.structure(plate.model.clone()).build()?;
    let displacement = simulation.static_displacement();
    let middle = count / 2 * (count + 1) + count / 2;
    let mut settlements = Vec::new();
    for &node in &plate.nodes[middle..=middle + count / 2] {
        let dof = plate.model.dof(node, Direction::Z);
        settlements.push(dof.map_or(f64::NAN, |dof| -displacement[dof]));
    }
    Ok(settlements)
}

/// Side of Hertz's plate and its thickness over the radius of relative stiffness l = ⁴√(D/k), m.
const STIFFNESS_RADIUS: f64 = 4.0;
const HERTZ_SIDE: f64 = 9.0 * STIFFNESS_RADIUS;
const HERTZ_THICKNESS: f64 = 0.05 * STIFFNESS_RADIUS;

/// Settlement under a force in the middle over P/(8√(kD)), and settlements from there to the side.
fn hertz(count: usize) -> Result<Vec<f64>, AnyError> {
    let stiffness =
        YOUNG_MODULUS * HERTZ_THICKNESS.powi(3) / (12.0 * (1.0 - POISSON_RATIO * POISSON_RATIO));
    let bed = stiffness / STIFFNESS_RADIUS.powi(4);
    let plate = plate(HERTZ_SIDE, HERTZ_THICKNESS, count)?;
    let half_side = 0.5 * HERTZ_SIDE;
    let plan = Plan::rectangle(-half_side..half_side, -half_side..half_side, count)?;
    let force = 1e3;
    let middle = plate.nodes[count / 2 * (count + 1) + count / 2];
    let ground = SpringGround::in_plan(plan, [bed, 1e-3 * bed, 1e-3 * bed])?;
    let reference = hertz_plate_settlement(force, stiffness, bed)?;
    let builder = Simulation::builder(0.01).ground(ground).interface(Bonded).gravity(1e-9);
    let settlements = settlements(builder, &plate, &[(middle, force)], count)?;
    Ok(settlements.into_iter().map(|settlement| settlement / reference).collect())
}

/// Settlements of a soft plate under its weight, frictionless, and Boussinesq's; over Boussinesq's in the middle.
fn even_load(count: usize) -> Result<[Vec<f64>; 2], AnyError> {
    let soil = Soil::new(30.0e6, 0.3, 1900.0)?;
    let side = 10.0_f64;
    let half_side = 0.5 * side;
    // D/(G B³) = 1e-6
    let stiffness = 1e-6 * 30.0e6 * half_side.powi(3);
    let thickness =
        (12.0 * (1.0 - POISSON_RATIO * POISSON_RATIO) * stiffness / YOUNG_MODULUS).cbrt();
    let plate = plate(side, thickness, count)?;
    let plan =
        Plan::rectangle(-half_side..half_side, -half_side..half_side, count)?.without_overhang()?;
    let ground = ElasticGround::in_plan(soil, plan)?;
    let builder = Simulation::builder(0.01).ground(ground).interface(Coulomb::new(0.0)?);
    let computed = settlements(builder, &plate, &[], count)?;
    let pressure = MASS_DENSITY * thickness * STANDARD_GRAVITY;
    let mut expected = Vec::new();
    for k in 0..computed.len() {
        let point = [0.0, half_side * k as f64 / (count / 2) as f64];
        expected.push(loaded_rectangle_settlement(soil, pressure, [side; 2], point)?);
    }
    let middle = expected[0];
    Ok([computed, expected].map(|list| list.into_iter().map(|value| value / middle).collect()))
}

/// D/(G R³), the stiffness over G R under an even load and under a force in the middle, both by the settlement of the
/// middle, and limits of their errors. Stiffnesses are printed by tests/data/plan/disc_on_half_space.py.
///
/// Rigid: 4/(1 − ν); flexible, even load: π/(1 − ν).
const DISC_CASES: [(f64, [f64; 2], [f64; 2]); 5] = [
    (0.006, [4.7028, 1.2356], [4e-3, 5e-2]),
    (0.02, [4.7660, 1.8193], [4e-3, 2e-2]),
    (0.06, [4.9989, 2.5501], [4e-3, 6e-3]),
    (0.2, [5.4176, 3.6736], [4e-3, 3e-3]),
    (2.0, [5.9096, 5.5314], [4e-3, 3e-3]),
];
const RING_COUNT: usize = 8;
const SECTOR_COUNT: usize = 24;

/// Stiffnesses of a disc of this D/(G R³), as in [`DISC_CASES`].
fn disc(rigidity: f64, cells: usize) -> Result<[f64; 2], AnyError> {
    let soil = Soil::new(30.0e6, 1.0 / 3.0, 1900.0)?;
    let radius = 5.0_f64;
    let thickness = 0.1_f64;
    let stiffness = rigidity * soil.shear_modulus() * radius.powi(3);
    let young = 12.0 * (1.0 - POISSON_RATIO * POISSON_RATIO) * stiffness / thickness.powi(3);
    // A polygon with the area of the circle.
    let half_sector = std::f64::consts::PI / SECTOR_COUNT as f64;
    let outer_radius = radius * (half_sector / (half_sector.sin() * half_sector.cos())).sqrt();
    let step = 1.0 / RING_COUNT as f64;
    let meridian: Vec<[f64; 2]> =
        (0..=RING_COUNT).map(|k| [outer_radius * k as f64 * step, 0.0]).collect();
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, SECTOR_COUNT)?;
    for shell in
        surface.shells(Material::new(young, POISSON_RATIO, MASS_DENSITY)?, |_| thickness)?
    {
        mesh.add(shell)?;
    }
    let model = FemModel::on_base(mesh)?;
    let middle = surface.row(0)[0];
    // Each ring's part of an even load, from displacements that are linear between rings.
    let total = 1e4;
    let mut even_load = Vec::new();
    for k in 0..=RING_COUNT {
        let part = match k {
            0 => step * step / 3.0,
            RING_COUNT => step - step * step / 3.0,
            _ => 2.0 * step * step * k as f64,
        };
        let ring = surface.row(k);
        even_load.extend(ring.iter().map(|&node| (node, total * part / ring.len() as f64)));
    }
    let plate = Plate { model, nodes: vec![middle] };
    let mut stiffnesses = [0.0; 2];
    for (computed, forces) in stiffnesses.iter_mut().zip([even_load, vec![(middle, total)]]) {
        // The interface transmits tension, so that the disc does not lift off.
        let law = Coulomb::new(0.0)?.with_tensile_strength(1e9)?;
        let ground = ElasticGround::under(soil, &plate.model, cells)?;
        let builder = Simulation::builder(0.01).ground(ground).interface(law).gravity(1e-6);
        let settlement = settlements(builder, &plate, &forces, 0)?[0];
        *computed = total / (settlement * soil.shear_modulus() * radius);
    }
    Ok(stiffnesses)
}

/// Checks and panel of the discs.
fn discs(short: bool) -> Result<(Vec<ValidationCheck>, FigurePanel), AnyError> {
    let mut checks = Vec::new();
    let names = ["even load", "force in the middle"];
    let mut discs =
        FigurePanel::new("D/(G R³) of a disc", "load over G R times the settlement of the middle")
            .double_logarithmic()
            .legend(SeriesLabelPosition::LowerRight);
    let list = if short { &DISC_CASES[2..3] } else { &DISC_CASES[..] };
    let mut points = [const { Vec::new() }; 2];
    for &(rigidity, references, limits) in list {
        let computed = disc(rigidity, if short { 8 } else { 16 })?;
        for k in 0..2 {
            let label = format!("disc of D/(G R³) = {rigidity}, {}: stiffness, relative", names[k]);
            checks.push(ValidationCheck::below(
                label,
                (computed[k] / references[k] - 1.0).abs(),
                limits[k],
            ));
            points[k].push((rigidity, computed[k]));
        }
    }
    for ((k, color), points) in [CURVE_BLUE, CURVE_GREEN].into_iter().enumerate().zip(points) {
        let references = DISC_CASES
            .iter()
            .map(|(rigidity, references, _)| (*rigidity, references[k]))
            .collect();
        discs = discs.line(&format!("Ritz solution, {}", names[k]), color, references).circles(
            &format!("basemat, {}", names[k]),
            color,
            points,
        );
    }
    let limits = [("rigid", 4.0), ("flexible, even load", std::f64::consts::PI)];
    for (name, limit) in limits {
        discs = discs.dashed(name, CURVE_GRAY, vec![(6e-3, 1.5 * limit), (2.0, 1.5 * limit)]);
    }
    Ok((checks, discs))
}

/// Curve of downward values along half the side.
fn along_half_side(values: &[f64]) -> Vec<(f64, f64)> {
    let last_index = (values.len() - 1) as f64;
    values.iter().enumerate().map(|(k, value)| (k as f64 / last_index, -value)).collect()
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut checks = Vec::new();
    let mut left = FigurePanel::new(
        "distance from the middle over half the side",
        "settlement over P/(8√(kD)), downwards",
    )
    .legend(SeriesLabelPosition::LowerRight)
    .crosses("Hertz, under the force", CURVE_RED, vec![(0.0, -1.0)]);
    let mut right = FigurePanel::new(
        "distance from the middle over half the side",
        "settlement over that of the middle, downwards",
    )
    .legend(SeriesLabelPosition::LowerRight);
    let counts: &[usize] = if short { &[8, 16] } else { &[8, 16, 24] };
    let limits = [[4e-2, 1.2e-2], [6e-3, 2e-3], [6e-3, 1e-3]];
    for (&count, limits) in counts.iter().zip(limits) {
        let on_springs = hertz(count)?;
        let name =
            format!("{count} × {count}: Hertz's plate, settlement under the force, relative");
        checks.push(ValidationCheck::below(name, (on_springs[0] - 1.0).abs(), limits[0]));
        let [computed, expected] = even_load(count)?;
        let name = format!("{count} × {count}: soft plate, settlement in the middle, relative");
        checks.push(ValidationCheck::below(
            name,
            (computed[0] / expected[0] - 1.0).abs(),
            limits[1],
        ));
        if count == 16 {
            left = left.line("basemat, 16 × 16", CURVE_BLUE, along_half_side(&on_springs));
            right = right.reference("Boussinesq", CURVE_RED, along_half_side(&expected)).circles(
                "basemat, 16 × 16",
                CURVE_BLUE,
                along_half_side(&computed),
            );
        }
    }
    let (disc_checks, discs) = discs(short)?;
    checks.extend(disc_checks);
    let title = "Plate of side 9⁴√(D/k) on springs under a force; soft plate under its weight; discs on a half-space";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 3, vec![left, right, discs]) })
}
