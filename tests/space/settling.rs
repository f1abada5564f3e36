//! GOAL: a footing that rocks slowly on sand settles in every packet of cycles.
//! SCENE: the footing of a centrifuge test (2.8 m × 0.65 m, 285 kN), turned slowly to the measured rotations, on a
//! half-space at rest under one row of cells.
//! REFERENCE: strips on Love's half-space with the law by bisection; rows of another program (`PROTOTYPE_ROWS`).

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground};
use basemat::coupled::{SimulationBuilder, Theta};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{RigidBody, Structure};
use basemat::{Result, Simulation, Soil};
use basemat_problems::prescribed::PrescribedGround;
use basemat_problems::rocking_footing::{
    BEARING_PRESSURE, CYCLES_PER_PACKET, DEPTH_GRADIENT, ELASTIC_RANGE, FOOTING_SIDES,
    REFERENCE_SETTLEMENT, SAND_DENSITY, VERTICAL_FORCE,
};
use basemat_problems::series::nearest_integer;
use basemat_problems::settling_law::SettlingLaw;
use basemat_problems::settling_strips::{RockingBase, SettlingStrips};

const FOOTING_BASE: RockingBase =
    RockingBase { length: FOOTING_SIDES[0], width: FOOTING_SIDES[1], weight: VERTICAL_FORCE };
const SHEAR_MODULUS: f64 = 30.0e6;
const POISSON_RATIO: f64 = 0.35;
/// Largest measured rotations, one way, of the five packets of three cycles.
const PACKET_ROTATIONS: [f64; 5] = [3.15e-3, 6.65e-3, 14.0e-3, 29.5e-3, 62.9e-3];
/// Stiffness of the spring that prescribes the rotation, N m.
const DRIVE_STIFFNESS: f64 = 1e12;

/// Law of the sand in the slow test.
fn sand_law(reference_settlement: f64, elastic_range: f64, depth_gradient: f64) -> SettlingLaw {
    SettlingLaw {
        initial_capacity: BEARING_PRESSURE,
        depth_gradient,
        reference_settlement,
        elastic_range,
    }
}

/// Prescribed rotations of the footing.
struct RotationPath {
    /// One per step.
    rotations: Vec<f64>,
    /// Last step of each packet.
    ends: Vec<usize>,
}

fn rotation_path(steps_per_leg: usize) -> RotationPath {
    let mut rotations = vec![0.0];
    let mut ends = Vec::new();
    for amplitude in PACKET_ROTATIONS {
        let targets =
            (0..2 * CYCLES_PER_PACKET).map(|k| if k % 2 == 0 { amplitude } else { -amplitude });
        for target in targets.chain([0.0]) {
            let leg_start = rotations[rotations.len() - 1];
            let legs = if leg_start == 0.0 || target == 0.0 { 1 } else { 2 };
            let count = legs * steps_per_leg;
            rotations.extend(
                (1..=count).map(|k| leg_start + (target - leg_start) * k as f64 / count as f64),
            );
        }
        ends.push(rotations.len() - 1);
    }
    RotationPath { rotations, ends }
}

/// Moment over P L/2, mean of both ways, and settlement over L at the end, of each packet.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PacketRow {
    moments: [f64; 5],
    settlements: [f64; 5],
}

/// Moment on the base, N m, and its settlement, m.
struct BaseState {
    moment: f64,
    settlement: f64,
}

/// Row of a base that `turn` rotates step by step.
fn row(steps_per_leg: usize, mut turn: impl FnMut(usize, f64) -> BaseState) -> PacketRow {
    let RotationPath { rotations, ends } = rotation_path(steps_per_leg);
    let mut row = PacketRow { moments: [0.0; 5], settlements: [0.0; 5] };
    let static_settlement = turn(0, 0.0).settlement;
    let mut first_step = 1;
    for (packet, end) in ends.into_iter().enumerate() {
        let mut range = [0.0_f64; 2];
        for step in first_step..=end {
            let BaseState { moment, settlement } = turn(step, rotations[step]);
            range = [range[0].min(moment), range[1].max(moment)];
            row.settlements[packet] = (settlement - static_settlement) / FOOTING_BASE.length;
        }
        row.moments[packet] = (range[1] - range[0]) / (FOOTING_BASE.weight * FOOTING_BASE.length);
        first_step = end + 1;
    }
    row
}

fn strip_row(count: usize, law: SettlingLaw, steps_per_leg: usize) -> PacketRow {
    let mut strips = SettlingStrips::new(FOOTING_BASE, count, SHEAR_MODULUS, POISSON_RATIO, law);
    row(steps_per_leg, |_, rotation| {
        let moment = strips.turn(rotation);
        BaseState { moment, settlement: strips.settlement }
    })
}

/// A footing whose rotation a stiff spring prescribes.
struct TurnedFooting {
    body: RigidBody,
    rotations: Vec<f64>,
}

impl Structure for TurnedFooting {
    fn stiffness(&self, matrix: &mut basemat::structure::Triplets) -> Result<()> {
        matrix.add(4, 4, DRIVE_STIFFNESS);
        Ok(())
    }

    fn dofs(&self) -> usize {
        self.body.dofs()
    }

    fn base(&self) -> basemat::structure::Base {
        self.body.base()
    }

    fn mass(&self, matrix: &mut basemat::structure::Triplets) -> Result<()> {
        self.body.mass(matrix)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        let step = nearest_integer(time);
        let last_index = self.rotations.len() - 1;
        load[4] += DRIVE_STIFFNESS * self.rotations[step.min(last_index)];
        Ok(())
    }
}

/// The half-space at rest, without waves, under cells of the footing.
fn ground_at_rest(columns: usize, rows: usize) -> Result<PrescribedGround> {
    let pitch = [FOOTING_SIDES[0] / columns as f64, FOOTING_SIDES[1] / rows as f64];
    let mask = vec![true; columns * rows];
    let plan = Plan::masked(FOOTING_SIDES.map(|side| -0.5 * side), pitch, columns, &mask)?;
    let soil = Soil::new(SHEAR_MODULUS, POISSON_RATIO, SAND_DENSITY)?;
    let ground = ElasticGround::in_plan(soil, plan)?;
    let mut compliance = vec![0.0; (3 * columns * rows).pow(2)];
    ground.static_compliance(&mut compliance)?;
    Ok(PrescribedGround::new(ground.elements().to_vec(), compliance).0)
}

/// The footing on its ground, turned once per second.
fn scene(
    cells: [usize; 2],
    law: SettlingLaw,
    friction: f64,
    rotations: Vec<f64>,
) -> Result<SimulationBuilder> {
    let [x, y] = FOOTING_SIDES.map(|side| 0.5 * side);
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    let mass = VERTICAL_FORCE / STANDARD_GRAVITY;
    let inertia = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { mass } else { 0.0 }));
    let body = RigidBody::from_mass(outline, mass, inertia, [0.0, 0.0, 1e-3])?;
    Ok(Simulation::builder(1.0)
        .scheme(Theta::new(1.0)?)
        .structure(TurnedFooting { body, rotations })
        .ground(ground_at_rest(cells[0], cells[1])?)
        .interface(law.cyclic_yielding(friction)))
}

/// Row of the footing computed by the crate.
fn simulated_row(
    cells: [usize; 2],
    law: SettlingLaw,
    friction: f64,
    steps_per_leg: usize,
) -> PacketRow {
    let rotations = rotation_path(steps_per_leg).rotations;
    let mut simulation = scene(cells, law, friction, rotations).unwrap().build().unwrap();
    let elements = simulation.ground().elements().to_vec();
    let mut dissipated_energy = 0.0;
    let computed = row(steps_per_leg, |step, _| {
        if step > 0 {
            let energy = simulation.step().unwrap().energy_balance;
            assert!(energy.residual() < 1e-9, "{energy}");
            assert!(
                energy.contact >= dissipated_energy - 1e-12 * energy.largest,
                "{step}: {energy}"
            );
            dissipated_energy = energy.contact;
        }
        let state = simulation.state();
        let moments = state.contact.iter().zip(&elements);
        let moment: f64 = moments.map(|(c, e)| c.pressure * e.area() * e.center()[0]).sum();
        BaseState { moment, settlement: -state.displacement()[2] }
    });
    assert!(dissipated_energy > 0.0);
    computed
}

/// Largest differences of moments and of settlements from another row, relative to that row.
struct RowDifferences {
    moment: f64,
    settlement: f64,
}

fn differences(row: &PacketRow, expected: &PacketRow) -> RowDifferences {
    let largest = |values: [f64; 5], expected: [f64; 5]| {
        let ratios = values.iter().zip(expected).map(|(value, expected)| value / expected - 1.0);
        ratios.fold(0.0_f64, |largest, ratio| largest.max(ratio.abs()))
    };
    RowDifferences {
        moment: largest(row.moments, expected.moments),
        settlement: largest(row.settlements, expected.settlements),
    }
}

fn print_row(name: &str, row: &PacketRow) {
    let moments: Vec<String> = row.moments.iter().map(|m| format!("{m:.3}")).collect();
    let settlements: Vec<String> = row.settlements.iter().map(|s| format!("{s:.4}")).collect();
    println!("{name}: {} | {}", moments.join(" "), settlements.join(" "));
}

/// Rows of a program by another author for the slow test, with this half-space: full memory, and short memory.
const PROTOTYPE_ROWS: [PacketRow; 2] = [
    PacketRow {
        moments: [0.522, 0.626, 0.704, 0.754, 0.777],
        settlements: [0.0014, 0.0023, 0.0039, 0.0073, 0.0149],
    },
    PacketRow {
        moments: [0.507, 0.566, 0.684, 0.750, 0.791],
        settlements: [0.0021, 0.0054, 0.0111, 0.0204, 0.0350],
    },
];

/// Laws of these rows.
fn prototype_laws() -> [SettlingLaw; 2] {
    [sand_law(10e-3, 1.0, 0.0), sand_law(REFERENCE_SETTLEMENT, ELASTIC_RANGE, DEPTH_GRADIENT)]
}

#[test]
fn a_footing_settles_as_strips_on_loves_half_space() {
    for (law, prototype) in prototype_laws().into_iter().zip(PROTOTYPE_ROWS) {
        let strips = strip_row(16, law, 10);
        let computed = simulated_row([16, 1], law, 0.0, 10);
        print_row("prototype", &prototype);
        print_row("strips", &strips);
        print_row("footing", &computed);
        let RowDifferences { moment, settlement } = differences(&computed, &strips);
        println!("from strips {moment:.4} {settlement:.4}");
        assert!(moment < 0.005 && settlement < 0.01, "{law:?}");
        let RowDifferences { moment, settlement } = differences(&computed, &prototype);
        println!("from the prototype {moment:.4} {settlement:.4}");
        assert!(moment < 0.03 && settlement < 0.1, "{law:?}");
    }
}

#[test]
fn rocking_converges_with_the_cells() {
    let [_, law] = prototype_laws();
    let fine_row = simulated_row([32, 1], law, 0.5, 10);
    print_row("32", &fine_row);
    for columns in [8, 16] {
        let coarse_row = simulated_row([columns, 1], law, 0.5, 10);
        print_row(&columns.to_string(), &coarse_row);
        let RowDifferences { moment, settlement } = differences(&coarse_row, &fine_row);
        println!("{moment:.4} {settlement:.4}");
        assert!(moment < 0.03 && settlement < 0.1, "{columns}");
    }
}
