//! A trench filled with its own soil is the ground without a trench; a trench without depth is a strip; a body on a mat
//! that moves in one plane is a block per metre.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::Probe;
use basemat::fem::{Direction, Material, Mesh, Quad4, QuadFormulation};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{FreeField, PlaneWave, Record, VerticalIncidence};
use basemat::site::TrenchMotion;
use basemat::soil::SoilProfile;
use basemat::structure::{FemModel, RigidBlock, RigidBody};
use basemat::{Result, Simulation, Soil, unobserved};
use basemat_problems::random::Random;

use super::tally::{Tally, scenes};

/// The trench of half width `half` and a `depth`, filled with finite elements of `soil`, `counts` along and up.
fn fill(half: f64, depth: f64, soil: &Soil, counts: [usize; 2]) -> Result<(FemModel, usize)> {
    let [columns, rows] = counts;
    let young = 2.0 * soil.shear_modulus() * (1.0 + soil.poisson());
    let material = Material::new(young, soil.poisson(), soil.density())?;
    let mut mesh = Mesh::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let x = half * (2.0 * column as f64 / columns as f64 - 1.0);
            mesh.add_node(x, depth * (row as f64 / rows as f64 - 1.0))?;
        }
    }
    let node = |row: usize, column: usize| row * (columns + 1) + column;
    for row in 0..rows {
        for column in 0..columns {
            let corners = [[0, 0], [0, 1], [1, 1], [1, 0]].map(|[i, j]| node(row + i, column + j));
            mesh.add(Quad4::new(corners, material, QuadFormulation::default()))?;
        }
    }
    let down = (1..=rows).rev().map(|row| node(row, 0));
    let along = (0..columns).map(|column| node(0, column));
    let up = (0..=rows).map(|row| node(row, columns));
    let outline: Vec<usize> = down.chain(along).chain(up).collect();
    Ok((FemModel::in_trench(mesh, &outline)?, node(rows, columns / 2)))
}

/// A record of waves of a period of some ten travel times from the base.
fn record(random: &mut Random, time: f64) -> Result<(Record, f64)> {
    let rate = 1.0 / (time * random.within(2.5, 5.0));
    let shape = move |t: f64| {
        let x = rate * t - 6.0;
        (-x * x).exp() * (-6.0 + 24.0 * x * x - 8.0 * x.powi(4))
    };
    Ok((Record::from_fn(0.05 / rate, 14.0 / rate, shape)?, rate))
}

/// The middle of the filled surface moves as the free surface.
#[test]
fn own_soil_fills_a_trench_without_a_trace() {
    // Convolution weights come in blocks of 128 lags first.
    const STEPS: usize = 120;
    let mut tally = Tally::new("trench: filled with its own soil");
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
        let run = || -> Result<f64> {
            let (record, rate) = record(&mut random, depth / speed)?;
            let elements = Trench::new(-half..half, depth)?.elements(4, 3)?;
            let ground = TrenchGround::new(profile.clone(), elements)?;
            let angle = random.within(0.1, 0.3);
            let motion = match kind {
                "SV wave" => {
                    let wave = PlaneWave::sv(soil, angle)?.field_from_horizontal(&record, -half)?;
                    TrenchMotion::travelling(&ground, &wave, &mut unobserved)?
                }
                "P wave" => {
                    let wave = PlaneWave::p(soil, angle)?.field_from_vertical(&record, -half)?;
                    TrenchMotion::travelling(&ground, &wave, &mut unobserved)?
                }
                _ => {
                    let vertical = Some(record.scaled(0.6)?);
                    let surface = VerticalIncidence { horizontal: Some(record), vertical };
                    TrenchMotion::new(&ground, surface, &mut unobserved)?
                }
            };
            let surface = motion.clone();
            let (filled, top) = fill(half, depth, &soil, [8, 6])?;
            let step = 8.0 / rate / STEPS as f64;
            let rows = [Direction::X, Direction::Y].map(|direction| filled.row(top, direction));
            let [along, up] = rows;
            let mut simulation = Simulation::builder(step)
                .gravity(0.0)
                .ground(ground)
                .structure(filled)
                .interface(Bonded)
                .motion(motion)
                .expected_steps(STEPS)
                .probe(Probe::absolute_displacement("along", along?))
                .probe(Probe::absolute_displacement("up", up?))
                .build()?;
            let [mut largest, mut apart] = [0.0_f64; 2];
            for _ in 0..STEPS {
                let state = simulation.step()?;
                let wanted = surface.displacement(0.0, state.time);
                for (found, wanted) in state.probes.iter().zip(wanted) {
                    largest = largest.max(wanted.abs());
                    apart = apart.max((found - wanted).abs());
                }
            }
            Ok(apart / largest)
        };
        let place = format!("{number}: {kind}, {layers}, half width {half:.2}, depth {depth:.2}");
        let mut run = run;
        match run() {
            Ok(apart) => tally.within(&place, apart, 0.03),
            Err(error) => tally.refuse(format!("{place}: {error}")),
        }
    }
    tally.close(0.7);
}

/// Step compliances of a trench without depth, by finite elements of the soil, and of a strip, by wavenumber integrals.
#[test]
fn a_trench_without_depth_is_a_strip() {
    let mut tally = Tally::new("trench: without depth");
    let mut random = Random(132);
    for number in 0..scenes(2, 30) {
        let half = random.log_within(1.0, 5.0);
        let poisson = random.within(0.1, 0.4);
        let soil = Soil::from_shear_wave_speed(200.0, poisson, 1900.0).unwrap();
        let mut profile = SoilProfile::on_half_plane(soil);
        if number % 2 == 1 {
            let soft = Soil::from_shear_wave_speed(120.0, poisson, 1800.0).unwrap();
            profile = profile.with_layer(soft, half * random.within(0.5, 2.0)).unwrap();
        }
        let layers = if number % 2 == 1 { "layers" } else { "half-plane" };
        tally.scene(&["trench", layers, "strip"]);
        let step = random.within(0.1, 0.4) * half / 200.0;
        let matrix = |mut ground: Box<dyn Ground>| -> Result<Vec<f64>> {
            ground.prepare(step, Some(8), &mut unobserved)?;
            let size = 2 * ground.elements().len();
            let mut found = vec![0.0; size * size];
            ground.step_compliance(&mut found)?;
            Ok(found)
        };
        let both = || -> Result<[Vec<f64>; 2]> {
            let elements = Trench::new(-half..half, 0.0)?.elements(6, 0)?;
            let trench = TrenchGround::new(profile.clone(), elements)?.with_stages(Stages::Two);
            let strip = Strip::graded(-half..half, 6)?;
            let strip = ElasticGround::new(profile.clone(), strip)?.with_stages(Stages::Two);
            Ok([matrix(Box::new(trench))?, matrix(Box::new(strip))?])
        };
        let [one, other] = both().unwrap();
        let scale = other.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
        let pairs = one.iter().zip(&other);
        let apart = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        tally.within(&format!("{number}: {layers}, half width {half:.2}"), apart / scale, 1e-2);
    }
    tally.close(1.0);
}

/// A body on springs that moves in one plane: the block per metre times its depth.
#[test]
fn a_body_in_one_plane_is_a_block_per_metre() {
    let mut tally = Tally::new("wide mat: strip per metre");
    let mut random = Random(133);
    for number in 0..scenes(8, 120) {
        let [a, b] = [random.within(3.0, 8.0), random.within(2.0, 20.0)];
        let height = random.within(2.0, 10.0);
        let density = random.within(300.0, 1500.0);
        let stiffness = random.log_within(2e7, 2e8);
        let friction = random.within(0.2, 0.8);
        let is_bonded = random.chance(0.3);
        tally.scene(&["springs", "rigid body", "block", "three records", "record"]);
        let record = basemat::motion::el_centro_1940().scaled(random.within(0.3, 1.5)).unwrap();
        // Cells of both grounds have the same ends along x.
        let columns = 6;
        let builder = || {
            let builder = Simulation::builder(0.005).motion(record.clone());
            if is_bonded {
                builder.interface(Bonded)
            } else {
                builder.interface(Coulomb::new(friction).unwrap())
            }
        };
        let plane = || -> Result<Simulation> {
            let bed = SpringGround::new(-0.5 * a..0.5 * a, columns, stiffness, 0.6 * stiffness)?;
            let bed = bed.with_dashpots(4e5, 3e5)?;
            builder().ground(bed).structure(RigidBlock::new(a, height, density)?).build()
        };
        let plan = || -> Result<Simulation> {
            let mask = vec![true; columns * 3];
            let corner = [-0.5 * a, -0.5 * b];
            let cells = Plan::masked(corner, [a / columns as f64, b / 3.0], columns, &mask)?;
            let bed = SpringGround::in_plan(cells, [stiffness, 0.6 * stiffness, 0.6 * stiffness])?;
            let bed = bed.with_dashpots(4e5, 3e5)?;
            builder().ground(bed).structure(RigidBody::cuboid([a, b, height], density)?).build()
        };
        let (mut plane, mut plan) = (plane().unwrap(), plan().unwrap());
        let [mut largest, mut apart] = [[0.0_f64; 3]; 2];
        for _ in 0..300 {
            let (one, other) = (plane.step().unwrap(), plan.step().unwrap());
            // Rotations of the plane are about −y.
            let pairs = [
                [one.base_shear, other.base_shear / b],
                [one.base_moment, -other.base_moment / b],
                [one.normal_force, other.normal_force / b],
            ];
            for (k, [one, other]) in pairs.into_iter().enumerate() {
                largest[k] = largest[k].max(one.abs());
                apart[k] = apart[k].max((one - other).abs());
            }
        }
        for k in 0..3 {
            let place =
                format!("{number}: {}, {a:.2} × {b:.2} m", ["shear", "moment", "normal"][k]);
            tally.within(&place, apart[k] / largest[k], 1e-6);
        }
    }
    tally.close(1.0);
}

/// Impedances of the middle of a long mat, per metre, against the strip's.
#[test]
fn a_long_mat_has_the_impedance_of_a_strip() {
    let mut tally = Tally::new("wide mat: impedance per metre");
    let mut random = Random(134);
    for number in 0..scenes(1, 6) {
        let soil = Soil::new(1.0, random.within(0.1, 0.4), 1.0).unwrap();
        tally.scene(&["half-plane", "mat", "strip"]);
        let frequency = random.within(1.0, 1.5) / std::f64::consts::TAU;
        // Two lengths: their difference has no ends.
        let plan = |length: f64| -> Result<[basemat::Complex; 2]> {
            let plan = Plan::rectangle(-1.0..1.0, -length..length, 5)?;
            let found = basemat::bem::plan::impedances_in_plan(
                &soil.into(),
                &plan,
                &[frequency],
                StripContact::Bonded,
                &mut unobserved,
            )?;
            Ok([found[0].matrix[0][0], found[0].matrix[2][2]])
        };
        let [short, long] = [2.0, 4.0].map(|length| plan(length).unwrap());
        let strip = ElasticGround::new(soil, Strip::graded(-1.0..1.0, 12).unwrap()).unwrap();
        let found = strip.impedances(&[frequency], StripContact::Bonded, &mut unobserved).unwrap();
        for (k, wanted) in [found[0].horizontal, found[0].vertical].into_iter().enumerate() {
            let per_metre = (long[k] - short[k]) * (1.0 / 4.0);
            let apart = (per_metre - wanted).abs() / wanted.abs();
            tally.within(&format!("{number}: {}", ["horizontal", "vertical"][k]), apart, 0.1);
        }
    }
    tally.close(1.0);
}
