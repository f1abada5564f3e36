//! GOAL: a filled trench moves as the ground without a trench; a trench without depth is a strip; a body on a mat that
//! moves in one plane is a block per metre.
//! SCENE: trenches under waves; strips; blocks on springs; long mats.
//! REFERENCE: the free field; strips and blocks in the plane.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::{Probe, SimulationBuilder};
use basemat::fem::{Direction, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{FreeField, PlaneWave, Record, VerticalIncidence};
use basemat::site::TrenchMotion;
use basemat::soil::SoilProfile;
use basemat::structure::{FemModel, RigidBlock, RigidBody};
use basemat::{Complex, Result, Simulation, Soil, unobserved};
use basemat_problems::dense::largest;
use basemat_problems::random::Random;

use super::compare::largest_difference;
use super::tally::{IdentityTally, scenes};

/// Finite elements of the soil that fill a trench.
struct TrenchFill {
    model: FemModel,
    /// Node in the middle of the surface.
    surface_node: usize,
}

/// Fills a trench with `columns` × `rows` finite elements of the soil.
fn fill_trench(
    half_width: f64,
    depth: f64,
    soil: &Soil,
    columns: usize,
    rows: usize,
) -> Result<TrenchFill> {
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let material = Material::new(young, soil.poisson(), soil.density())?;
    let mut mesh = Mesh::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let x = half_width * (2.0 * column as f64 / columns as f64 - 1.0);
            mesh.add_node(x, depth * (row as f64 / rows as f64 - 1.0))?;
        }
    }
    let row_length = columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            let corners =
                [[0, 0], [0, 1], [1, 1], [1, 0]].map(|[i, j]| (row + i) * row_length + column + j);
            mesh.add(Quad4::new(corners, material, QuadFormulation::default()))?;
        }
    }
    let left_wall_nodes = (1..=rows).rev().map(|row| row * row_length);
    let up = (0..=rows).map(|row| row * row_length + columns);
    let outline: Vec<usize> = left_wall_nodes.chain(0..columns).chain(up).collect();
    let surface_node = rows * row_length + columns / 2;
    Ok(TrenchFill { model: FemModel::in_trench(mesh, &outline)?, surface_node })
}

/// A record of waves of a rate, 1/s.
fn record(rate: f64) -> Result<Record> {
    Record::from_fn(0.05 / rate, 14.0 / rate, |t: f64| {
        let x = rate * t - 6.0;
        (-x * x).exp() * (-6.0 + 24.0 * x * x - 8.0 * x.powi(4))
    })
}

/// Motion of the soil around a trench by waves of a kind.
fn trench_motion(
    ground: &TrenchGround,
    soil: Soil,
    kind: &str,
    angle: f64,
    half_width: f64,
    record: Record,
) -> Result<TrenchMotion> {
    match kind {
        "SV wave" => {
            let wave = PlaneWave::sv(soil, angle)?.field_from_horizontal(&record, -half_width)?;
            TrenchMotion::travelling(ground, &wave, &mut unobserved)
        }
        "P wave" => {
            let wave = PlaneWave::p(soil, angle)?.field_from_vertical(&record, -half_width)?;
            TrenchMotion::travelling(ground, &wave, &mut unobserved)
        }
        _ => {
            let vertical = Some(record.scaled(0.6)?);
            let surface = VerticalIncidence { horizontal: Some(record), vertical };
            TrenchMotion::new(ground, surface, &mut unobserved)
        }
    }
}

/// Steps of a run with a filled trench; convolution weights are computed in blocks of 128 lags.
const FILLED_TRENCH_STEPS: usize = 120;

/// Largest difference of the middle of the filled surface from the free surface, relative to the largest displacement.
fn surface_difference(
    ground: TrenchGround,
    trench_fill: TrenchFill,
    motion: TrenchMotion,
    time_step: f64,
) -> Result<f64> {
    let along = trench_fill.model.row(trench_fill.surface_node, Direction::X)?;
    let up = trench_fill.model.row(trench_fill.surface_node, Direction::Y)?;
    let surface = motion.clone();
    let mut simulation = Simulation::builder(time_step)
        .gravity(0.0)
        .ground(ground)
        .structure(trench_fill.model)
        .interface(Bonded)
        .motion(motion)
        .expected_steps(FILLED_TRENCH_STEPS)
        .probe(Probe::absolute_displacement("along", along))
        .probe(Probe::absolute_displacement("up", up))
        .build()?;
    let mut max_magnitude = 0.0_f64;
    let mut difference = 0.0_f64;
    for _ in 0..FILLED_TRENCH_STEPS {
        let state = simulation.step()?;
        let expected = surface.displacement(0.0, state.time);
        for (computed, expected) in state.probes.iter().zip(expected) {
            max_magnitude = max_magnitude.max(expected.abs());
            difference = difference.max((computed - expected).abs());
        }
    }
    Ok(difference / max_magnitude)
}

/// GOAL: the middle of the filled surface moves as the free surface.
#[test]
fn own_soil_fills_a_trench_without_a_trace() {
    let mut tally = IdentityTally::new("trench: filled with the same soil");
    let mut random = Random(131);
    for number in 0..scenes(1, 40) {
        let half = random.log_within(2.0, 6.0);
        let depth = half * random.within(0.4, 1.0);
        let speed = random.log_within(120.0, 300.0);
        let poisson = random.within(0.1, 0.4);
        let soil = Soil::from_shear_wave_speed(speed, poisson, 1900.0).unwrap();
        let mut profile = SoilProfile::on_half_plane(soil);
        if number % 2 == 0 {
            // A layer that ends below the trench.
            profile = profile.with_layer(soil, depth * random.within(1.1, 2.5)).unwrap();
        }
        let kind = ["vertical waves", "SV wave", "vertical waves", "P wave"][number % 4];
        let layers = if number % 2 == 0 { "layers" } else { "half-plane" };
        tally.scene(&["trench", layers, "quadrilaterals", "bonded", kind]);
        // Periods are some ten travel times from the base of the trench.
        let rate = 1.0 / (depth / speed * random.within(2.5, 5.0));
        let angle = random.within(0.1, 0.3);
        let place = format!("{number}: {kind}, {layers}, half width {half:.2}, depth {depth:.2}");
        let difference = Trench::new(-half..half, depth)
            .and_then(|trench| TrenchGround::new(profile, trench.elements(4, 3)?))
            .and_then(|ground| {
                let motion = trench_motion(&ground, soil, kind, angle, half, record(rate)?)?;
                let trench_fill = fill_trench(half, depth, &soil, 8, 6)?;
                let time_step = 8.0 / rate / FILLED_TRENCH_STEPS as f64;
                surface_difference(ground, trench_fill, motion, time_step)
            });
        match difference {
            Ok(difference) => tally.within(&place, difference, 0.03),
            Err(error) => tally.add_error(format!("{place}: {error}")),
        }
    }
    tally.close(0.7);
}

/// Step compliance of a ground.
fn step_compliance(mut ground: impl Ground, time_step: f64) -> Vec<f64> {
    ground.prepare(time_step, Some(8), &mut unobserved).unwrap();
    let size = 2 * ground.elements().len();
    let mut compliance = vec![0.0; size * size];
    ground.step_compliance(&mut compliance).unwrap();
    compliance
}

/// GOAL: a trench without depth, by finite elements of the soil, is a strip, by wavenumber integrals.
#[test]
fn a_trench_without_depth_is_a_strip() {
    let mut tally = IdentityTally::new("trench: without depth");
    let mut random = Random(132);
    for number in 0..scenes(2, 30) {
        let half = random.log_within(1.0, 5.0);
        let poisson = random.within(0.1, 0.4);
        let soil = Soil::from_shear_wave_speed(200.0, poisson, 1900.0).unwrap();
        let mut profile = SoilProfile::on_half_plane(soil);
        if number % 2 == 1 {
            let soft_soil = Soil::from_shear_wave_speed(120.0, poisson, 1800.0).unwrap();
            profile = profile.with_layer(soft_soil, half * random.within(0.5, 2.0)).unwrap();
        }
        let layers = if number % 2 == 1 { "layers" } else { "half-plane" };
        tally.scene(&["trench", layers, "strip"]);
        let time_step = random.within(0.1, 0.4) * half / 200.0;
        let elements = Trench::new(-half..half, 0.0).unwrap().elements(6, 0).unwrap();
        let trench = TrenchGround::new(profile.clone(), elements).unwrap();
        let strip = Strip::graded(-half..half, 6).unwrap();
        let strip = ElasticGround::new(profile, strip).unwrap();
        let computed = step_compliance(trench.with_stages(Stages::Two), time_step);
        let expected = step_compliance(strip.with_stages(Stages::Two), time_step);
        let difference = largest_difference(&computed, &expected) / largest(&expected);
        tally.within(&format!("{number}: {layers}, half width {half:.2}"), difference, 1e-2);
    }
    tally.close(1.0);
}

/// A block per metre, and a body on a mat, on springs.
struct SpringScene {
    /// Sides and height of the body, m.
    size: [f64; 3],
    density: f64,
    stiffness: f64,
    /// None if bonded.
    friction: Option<f64>,
    record: Record,
}

/// Cells along x of the bed in plan and of the bed in the plane.
const BED_COLUMNS: usize = 6;

impl SpringScene {
    fn builder(&self) -> SimulationBuilder {
        let builder = Simulation::builder(0.005).motion(self.record.clone());
        match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction).unwrap()),
            None => builder.interface(Bonded),
        }
    }

    fn in_plane(&self) -> Result<Simulation> {
        let a = self.size[0];
        let stiffness = self.stiffness;
        let bed = SpringGround::new(-0.5 * a..0.5 * a, BED_COLUMNS, stiffness, 0.6 * stiffness)?;
        let bed = bed.with_dashpots(4e5, 3e5)?;
        self.builder()
            .ground(bed)
            .structure(RigidBlock::new(a, self.size[2], self.density)?)
            .build()
    }

    fn in_plan(&self) -> Result<Simulation> {
        let a = self.size[0];
        let b = self.size[1];
        let mask = vec![true; BED_COLUMNS * 3];
        let cell = [a / BED_COLUMNS as f64, b / 3.0];
        let cells = Plan::masked([-0.5 * a, -0.5 * b], cell, BED_COLUMNS, &mask)?;
        let tangential = 0.6 * self.stiffness;
        let bed = SpringGround::in_plan(cells, [self.stiffness, tangential, tangential])?;
        let bed = bed.with_dashpots(4e5, 3e5)?;
        self.builder()
            .ground(bed)
            .structure(RigidBody::cuboid(self.size, self.density)?)
            .build()
    }
}

/// GOAL: a body on springs that moves in one plane is the block per metre times its depth.
#[test]
fn a_body_in_one_plane_is_a_block_per_metre() {
    let mut tally = IdentityTally::new("wide mat: strip per metre");
    let mut random = Random(133);
    for number in 0..scenes(8, 120) {
        let a = random.within(3.0, 8.0);
        let b = random.within(2.0, 20.0);
        let height = random.within(2.0, 10.0);
        let density = random.within(300.0, 1500.0);
        let stiffness = random.log_within(2e7, 2e8);
        let friction = random.within(0.2, 0.8);
        let friction = (!random.chance(0.3)).then_some(friction);
        tally.scene(&["springs", "rigid body", "block", "three records", "record"]);
        let record = basemat::motion::el_centro_1940().scaled(random.within(0.3, 1.5)).unwrap();
        let scene = SpringScene { size: [a, b, height], density, stiffness, friction, record };
        let mut in_plane = scene.in_plane().unwrap();
        let mut in_plan = scene.in_plan().unwrap();
        let mut max_values = [0.0_f64; 3];
        let mut differences = [0.0_f64; 3];
        for _ in 0..300 {
            let block = in_plane.step().unwrap();
            let body = in_plan.step().unwrap();
            // Rotations of the plane are about −y.
            let pairs = [
                [block.base_shear, body.base_shear / b],
                [block.base_moment, -body.base_moment / b],
                [block.normal_force, body.normal_force / b],
            ];
            for (k, [expected, computed]) in pairs.into_iter().enumerate() {
                max_values[k] = max_values[k].max(expected.abs());
                differences[k] = differences[k].max((expected - computed).abs());
            }
        }
        for (k, name) in ["shear", "moment", "normal"].into_iter().enumerate() {
            let place = format!("{number}: {name}, {a:.2} × {b:.2} m");
            tally.within(&place, differences[k] / max_values[k], 1e-6);
        }
    }
    tally.close(1.0);
}

/// Horizontal and vertical impedance of a mat of width 2 on a half-space of this soil.
fn mat_impedances(soil: Soil, half_length: f64, frequency: f64) -> [Complex; 2] {
    let plan = Plan::rectangle(-1.0..1.0, -half_length..half_length, 5).unwrap();
    let contact = StripContact::Bonded;
    let impedances =
        impedances_in_plan(&soil.into(), &plan, &[frequency], contact, &mut unobserved).unwrap();
    [impedances[0].matrix[0][0], impedances[0].matrix[2][2]]
}

/// GOAL: the middle of a long mat has the impedance of a strip per metre.
#[test]
fn a_long_mat_has_the_impedance_of_a_strip() {
    let mut tally = IdentityTally::new("wide mat: impedance per metre");
    let mut random = Random(134);
    for number in 0..scenes(1, 6) {
        let soil = Soil::new(1.0, random.within(0.1, 0.4), 1.0).unwrap();
        tally.scene(&["half-plane", "mat", "strip"]);
        let frequency = random.within(1.0, 1.5) / std::f64::consts::TAU;
        // In the difference of two lengths the effects of the ends cancel.
        let short_mat = mat_impedances(soil, 2.0, frequency);
        let long_mat = mat_impedances(soil, 4.0, frequency);
        let strip = ElasticGround::new(soil, Strip::graded(-1.0..1.0, 12).unwrap()).unwrap();
        let contact = StripContact::Bonded;
        let expected = strip.impedances(&[frequency], contact, &mut unobserved).unwrap()[0];
        for (k, (name, expected)) in
            [("horizontal", expected.horizontal), ("vertical", expected.vertical)]
                .into_iter()
                .enumerate()
        {
            let per_metre = (long_mat[k] - short_mat[k]) * (1.0 / 4.0);
            let error = (per_metre - expected).abs() / expected.abs();
            tally.within(&format!("{number}: {name}"), error, 0.1);
        }
    }
    tally.close(1.0);
}
