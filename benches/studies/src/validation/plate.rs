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

use super::outcome::{Case, Check, Outcome};
use crate::AnyError;
use crate::figure::{BLUE, Figure, GRAY, GREEN, Panel, RED};

pub(crate) const CASE: Case = Case {
    name: "plate",
    title: "Flexible plates on springs and on a half-space",
    reference: "Hertz's infinite plate on springs under a force, P/(8√(kD)); Boussinesq's settlement under an even load; discs: Ritz solution in Legendre polynomials on the exact half-space",
    settings: "square plates of 8 × 8, 16 × 16 and 24 × 24 shells, each on its own cell; discs of 8 rings of 24 shells, 16 cells across, ν = 1/3, without friction or mass",
    run,
};

const YOUNG: f64 = 30.0e9;
const POISSON: f64 = 0.2;
const DENSITY: f64 = 2400.0;

/// Plate of `count` × `count` shells, and its node at a place counted in shells.
fn plate(side: f64, thickness: f64, count: usize) -> Result<(FemModel, Vec<usize>), AnyError> {
    let material = Material::new(YOUNG, POISSON, DENSITY)?;
    let mut mesh = Mesh::in_space();
    let place = |k: usize| side * (k as f64 / count as f64 - 0.5);
    let mut nodes = Vec::new();
    for i in 0..=count {
        for j in 0..=count {
            nodes.push(mesh.add_node_at([place(i), place(j), 0.0])?);
        }
    }
    for i in 0..count {
        for j in 0..count {
            let at = |i: usize, j: usize| nodes[i * (count + 1) + j];
            let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.add(Shell::new(corners, material, thickness)?)?;
        }
    }
    Ok((FemModel::on_base(mesh)?, nodes))
}

/// Settlements (m) of the nodes along the middle line, from the middle out, under downward forces at nodes.
fn settlements(
    mut builder: SimulationBuilder,
    (model, nodes): (&FemModel, &[usize]),
    forces: &[(usize, f64)],
    count: usize,
) -> Result<Vec<f64>, AnyError> {
    for &(node, force) in forces {
        builder = builder.load(Load::constant(model.row(node, Direction::Z)?, -force));
    }
    let simulation = builder.structure(model.clone()).build()?;
    let displacement = simulation.static_displacement();
    let middle = count / 2 * (count + 1) + count / 2;
    let line = nodes[middle..=middle + count / 2].iter();
    let dof =
        |&node: &usize| model.dof(node, Direction::Z).map_or(f64::NAN, |dof| -displacement[dof]);
    Ok(line.map(dof).collect())
}

/// Side of Hertz's plate and its thickness over the radius of relative stiffness l = ⁴√(D/k), m.
const RADIUS: f64 = 4.0;
const SIDE: f64 = 9.0 * RADIUS;
const THICKNESS: f64 = 0.05 * RADIUS;

/// Settlement under a force in the middle over P/(8√(kD)), and settlements from there to the side.
fn hertz(count: usize) -> Result<Vec<f64>, AnyError> {
    let stiffness = YOUNG * THICKNESS.powi(3) / (12.0 * (1.0 - POISSON * POISSON));
    let bed = stiffness / RADIUS.powi(4);
    let (model, nodes) = plate(SIDE, THICKNESS, count)?;
    let half = 0.5 * SIDE;
    let plan = Plan::rectangle(-half..half, -half..half, count)?;
    let force = 1e3;
    let middle = nodes[count / 2 * (count + 1) + count / 2];
    let ground = SpringGround::in_plan(plan, [bed, 1e-3 * bed, 1e-3 * bed])?;
    let known = hertz_plate_settlement(force, stiffness, bed)?;
    let builder = Simulation::builder(0.01).ground(ground).interface(Bonded).gravity(1e-9);
    let found = settlements(builder, (&model, &nodes), &[(middle, force)], count)?;
    Ok(found.into_iter().map(|settled| settled / known).collect())
}

/// Settlements of a soft plate under its own weight, frictionless, over Boussinesq's in the middle; and Boussinesq's own.
fn even(count: usize) -> Result<[Vec<f64>; 2], AnyError> {
    let soil = Soil::new(30.0e6, 0.3, 1900.0)?;
    let side = 10.0_f64;
    let half = 0.5 * side;
    // D/(G B³) = 1e-6
    let stiffness = 1e-6 * 30.0e6 * half.powi(3);
    let thickness = (12.0 * (1.0 - POISSON * POISSON) * stiffness / YOUNG).cbrt();
    let (model, nodes) = plate(side, thickness, count)?;
    let plan = Plan::rectangle(-half..half, -half..half, count)?.without_overhang()?;
    let ground = ElasticGround::in_plan(soil, plan)?;
    let builder = Simulation::builder(0.01).ground(ground).interface(Coulomb::new(0.0)?);
    let found = settlements(builder, (&model, &nodes), &[], count)?;
    let pressure = DENSITY * thickness * STANDARD_GRAVITY;
    let exact = |k: usize| {
        let point = [0.0, half * k as f64 / (count / 2) as f64];
        loaded_rectangle_settlement(soil, pressure, [side; 2], point)
    };
    let exact: Vec<f64> = (0..found.len()).map(exact).collect::<Result<_, _>>()?;
    let middle = exact[0];
    Ok([found, exact].map(|list| list.into_iter().map(|settled| settled / middle).collect()))
}

/// D/(G R³), the stiffness over G R under an even load and under a force in the middle, both by the settlement of the
/// middle, and limits of their errors. Stiffnesses are printed by tests/data/plan/disc_on_half_space.py. Rigid: 4/(1 − ν); flexible, even load: π/(1 − ν).
const DISCS: [(f64, [f64; 2], [f64; 2]); 5] = [
    (0.006, [4.7028, 1.2356], [4e-3, 5e-2]),
    (0.02, [4.7660, 1.8193], [4e-3, 2e-2]),
    (0.06, [4.9989, 2.5501], [4e-3, 6e-3]),
    (0.2, [5.4176, 3.6736], [4e-3, 3e-3]),
    (2.0, [5.9096, 5.5314], [4e-3, 3e-3]),
];
const RINGS: usize = 8;
const SECTORS: usize = 24;

/// Stiffnesses of a disc of this D/(G R³), as in [`DISCS`].
fn disc(rigidity: f64, cells: usize) -> Result<[f64; 2], AnyError> {
    let soil = Soil::new(30.0e6, 1.0 / 3.0, 1900.0)?;
    let (radius, thickness) = (5.0_f64, 0.1_f64);
    let stiffness = rigidity * soil.shear_modulus() * radius.powi(3);
    let young = 12.0 * (1.0 - POISSON * POISSON) * stiffness / thickness.powi(3);
    // A polygon of the circle's area.
    let half = std::f64::consts::PI / SECTORS as f64;
    let outer = radius * (half / (half.sin() * half.cos())).sqrt();
    let step = 1.0 / RINGS as f64;
    let meridian: Vec<[f64; 2]> = (0..=RINGS).map(|k| [outer * k as f64 * step, 0.0]).collect();
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, SECTORS)?;
    for shell in surface.shells(Material::new(young, POISSON, DENSITY)?, |_| thickness)? {
        mesh.add(shell)?;
    }
    let model = FemModel::on_base(mesh)?;
    let middle = surface.row(0)[0];
    // Each ring's part of an even load, from displacements that are linear between rings.
    let part = |k: usize| match k {
        0 => step * step / 3.0,
        RINGS => step - step * step / 3.0,
        _ => 2.0 * step * step * k as f64,
    };
    let total = 1e4;
    let even = (0..=RINGS).flat_map(|k| {
        let ring = surface.row(k);
        ring.iter().map(move |&node| (node, total * part(k) / ring.len() as f64))
    });
    let mut found = [0.0; 2];
    for (own, forces) in found.iter_mut().zip([even.collect(), vec![(middle, total)]]) {
        // It is pulled where it lifts.
        let law = Coulomb::new(0.0)?.with_tensile_strength(1e9)?;
        let ground = ElasticGround::under(soil, &model, cells)?;
        let builder = Simulation::builder(0.01).ground(ground).interface(law).gravity(1e-6);
        let nodes = [middle];
        let settled = settlements(builder, (&model, &nodes), &forces, 0)?[0];
        *own = total / (settled * soil.shear_modulus() * radius);
    }
    Ok(found)
}

/// Checks and panel of the discs.
fn discs(short: bool) -> Result<(Vec<Check>, Panel), AnyError> {
    let mut checks = Vec::new();
    let names = ["even load", "force in the middle"];
    let mut discs =
        Panel::new("D/(G R³) of a disc", "load over G R times the settlement of the middle")
            .double_logarithmic()
            .legend(SeriesLabelPosition::LowerRight);
    let list = if short { &DISCS[2..3] } else { &DISCS[..] };
    let mut own = [const { Vec::new() }; 2];
    for &(rigidity, wanted, limits) in list {
        let found = disc(rigidity, if short { 8 } else { 16 })?;
        for k in 0..2 {
            let label = format!("disc of D/(G R³) = {rigidity}, {}: stiffness, relative", names[k]);
            checks.push(Check::below(label, (found[k] / wanted[k] - 1.0).abs(), limits[k]));
            own[k].push((rigidity, found[k]));
        }
    }
    for ((k, color), own) in [BLUE, GREEN].into_iter().enumerate().zip(own) {
        let wanted = DISCS.iter().map(|(rigidity, wanted, _)| (*rigidity, wanted[k])).collect();
        discs = discs.line(&format!("Ritz solution, {}", names[k]), color, wanted).circles(
            &format!("basemat, {}", names[k]),
            color,
            own,
        );
    }
    let limits = [("rigid", 4.0), ("flexible, even load", std::f64::consts::PI)];
    for (name, limit) in limits {
        discs = discs.dashed(name, GRAY, vec![(6e-3, 1.5 * limit), (2.0, 1.5 * limit)]);
    }
    Ok((checks, discs))
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let mut checks = Vec::new();
    let along = |values: &[f64]| {
        let last = (values.len() - 1) as f64;
        let each = values.iter().enumerate();
        each.map(|(k, value)| (k as f64 / last, -value)).collect::<Vec<_>>()
    };
    let mut left = Panel::new(
        "distance from the middle over half the side",
        "settlement over P/(8√(kD)), downwards",
    )
    .legend(SeriesLabelPosition::LowerRight)
    .crosses("Hertz, under the force", RED, vec![(0.0, -1.0)]);
    let mut right = Panel::new(
        "distance from the middle over half the side",
        "settlement over that of the middle, downwards",
    )
    .legend(SeriesLabelPosition::LowerRight);
    let counts: &[usize] = if short { &[8, 16] } else { &[8, 16, 24] };
    let limits = [[4e-2, 1.2e-2], [6e-3, 2e-3], [6e-3, 1e-3]];
    for (&count, limits) in counts.iter().zip(limits) {
        let found = hertz(count)?;
        let name =
            format!("{count} × {count}: Hertz's plate, settlement under the force, relative");
        checks.push(Check::below(name, (found[0] - 1.0).abs(), limits[0]));
        let [own, exact] = even(count)?;
        let name = format!("{count} × {count}: soft plate, settlement in the middle, relative");
        checks.push(Check::below(name, (own[0] / exact[0] - 1.0).abs(), limits[1]));
        if count == 16 {
            left = left.line("basemat, 16 × 16", BLUE, along(&found));
            right = right.reference("Boussinesq", RED, along(&exact)).circles(
                "basemat, 16 × 16",
                BLUE,
                along(&own),
            );
        }
    }
    let (own, discs) = discs(short)?;
    checks.extend(own);
    let title = "Plate of side 9⁴√(D/k) on springs under a force; soft plate under its own weight; discs on a half-space";
    Ok(Outcome { checks, figure: Figure::new(title, 3, vec![left, right, discs]) })
}
