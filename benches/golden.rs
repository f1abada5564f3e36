//! Every digit of some forty scenes, to compare a rebuilt crate with what it was before.
//!
//! ```text
//! cargo bench --bench golden -- target/golden.csv
//! ```
//!
//! A row is a scene, its coordinates, a step and the numbers of its state, printed so that they read back as
//! the same bits. `.ci/golden REVISION` runs the program of two commits and compares: physical
//! coordinates must agree to the last bit, modal and reduced ones to 1e-12 of the largest value of a column.

use std::fmt::Write as _;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::coupled::{
    Coordinates, GravityStage, HhtAlpha, Load, Newmark, Probe, SimulationBuilder, Theta,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::HistoryMethod;
use basemat::interface::{Bonded, Cohesive, Coulomb, ThinLayer, VariableFriction, Yielding};
use basemat::motion::{PlaneWave, Record, Triaxial, VerticalIncidence, el_centro_1940};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{
    Bilinear, BoucWen, FemModel, PlanStorey, RayleighDamping, RigidBlock, RigidBody, ShearBuilding,
    Storey, StoreyBuilding, Structure, StructureGroup,
};
use basemat::{Result, Simulation, Soil};

const STEPS: usize = 300;
/// States between those that are printed.
const STRIDE: usize = 20;
const TIME_STEP: f64 = 4.0e-3;

type Make = fn() -> Result<SimulationBuilder>;

/// Strong enough for uplift and sliding from the first second on.
fn shaking() -> Record {
    let record = el_centro_1940();
    let strong = record.accelerations().iter().skip(70).map(|a| 3.0 * a).collect();
    Record::new(record.time_step(), strong).expect("a part of a record")
}

fn soil() -> Result<Soil> {
    Soil::new(60.0e6, 0.3, 1900.0)
}

fn block() -> Result<RigidBlock> {
    RigidBlock::new(4.0, 6.0, 1500.0)
}

fn damping() -> Result<RayleighDamping> {
    RayleighDamping::from_ratios([12.0, 120.0], [0.05; 2])
}

fn tower() -> Result<FemModel> {
    let layers = [Layer::new(6.0, 6, Material::new(2.0e8, 0.2, 1500.0)?)];
    FemModel::on_base(Mesh::layered_block(-2.0..2.0, 6, &layers)?)
}

fn building() -> Result<ShearBuilding> {
    let storeys = [Storey::new(3.0, 12.0e3, 18.0e6); 4];
    ShearBuilding::new(6.0, 30.0e3, 9.0e4, &storeys)?.with_stiffness_damping(0.05)
}

fn yielding_building() -> Result<ShearBuilding> {
    building()?.with_law(0, Bilinear::new(18.0e6, 1.0e5, 0.05)?)
}

fn on(structure: impl Structure + 'static, ground: impl Ground + 'static) -> SimulationBuilder {
    Simulation::builder(TIME_STEP).structure(structure).ground(ground).motion(shaking())
}

fn half_plane(structure: &dyn Structure) -> Result<ElasticGround> {
    ElasticGround::under(soil()?, structure, 8)
}

/// A block that uplifts and slides on a half-plane with one kind of history.
fn by_history(kind: HistoryMethod, grading: Grading) -> Result<SimulationBuilder> {
    let strip = Strip::new(-2.0..2.0, 8, grading)?;
    let ground = ElasticGround::new(soil()?, strip)?.with_history(kind)?;
    Ok(on(block()?, ground).interface(Coulomb::new(0.4)?))
}

fn block_under(law: impl basemat::interface::InterfaceLaw + 'static) -> Result<SimulationBuilder> {
    let block = block()?;
    let ground = half_plane(&block)?;
    Ok(on(block, ground).interface(law))
}

fn tower_in(coordinates: Coordinates) -> Result<SimulationBuilder> {
    let tower = tower()?.with_rayleigh(damping()?);
    let top = tower.mesh().node_at(2.0, 6.0)?;
    let row = tower.row(top, basemat::fem::Direction::X)?;
    let ground = half_plane(&tower)?;
    let probes = [Probe::acceleration("top", row.clone()), Probe::displacement("drift", row)];
    Ok(on(tower, ground).interface(Coulomb::new(0.3)?).probes(probes).coordinates(coordinates))
}

fn profile() -> Result<SoilProfile> {
    let damped = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0);
    SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?)
        .with_bedrock_damping(damped(0.01)?)
        .with_layer(Soil::from_shear_wave_speed(200.0, 0.3, 1900.0)?, 6.0)
        .and_then(|profile| Ok(profile.with_damping(damped(0.05)?)))
}

fn layered(profile: SoilProfile) -> Result<SimulationBuilder> {
    let block = block()?;
    let ground = ElasticGround::under(profile, &block, 6)?;
    Ok(on(block, ground).interface(Coulomb::new(0.4)?))
}

fn group() -> Result<StructureGroup> {
    StructureGroup::new().with(building()?, -6.0)?.with(block()?, 5.0)
}

fn body() -> Result<RigidBody> {
    RigidBody::cuboid([4.0, 3.0, 6.0], 1500.0)
}

/// A structure in plan, shaken in all directions.
fn in_plan(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
) -> SimulationBuilder {
    let shake = |factor| shaking().scaled(factor).ok();
    let motion = Triaxial { x: shake(1.0), y: shake(0.7), up: shake(0.4) };
    Simulation::builder(TIME_STEP).structure(structure).ground(ground).motion(motion)
}

fn body_under(law: impl basemat::interface::InterfaceLaw + 'static) -> Result<SimulationBuilder> {
    let ground = ElasticGround::under(soil()?, &body()?, 4)?;
    Ok(in_plan(body()?, ground).interface(law))
}

fn storeys() -> Result<StoreyBuilding> {
    let storey = PlanStorey::new(3.0, 18.0e3, [4.0, 3.0], [18.0e6, 12.0e6, 40.0e6]);
    StoreyBuilding::new(RigidBody::cuboid([4.0, 3.0, 1.0], 2400.0)?, &[storey; 3])
}

const SCENES: [(&str, Make); 42] = [
    ("block, direct", || by_history(HistoryMethod::Direct, Grading::Cosine)),
    ("block, relaxed transforms on pairs", || {
        by_history(HistoryMethod::RelaxedFft, Grading::Cosine)
    }),
    ("block, relaxed transforms on a lattice", || {
        by_history(HistoryMethod::RelaxedFft, Grading::Uniform)
    }),
    ("block, exponentials", || by_history(HistoryMethod::Exponentials, Grading::Uniform)),
    ("block, history by choice", || by_history(HistoryMethod::Auto, Grading::Uniform)),
    ("block, bonded", || block_under(Bonded)),
    ("block, uplift only", || block_under(Coulomb::uplift_only())),
    ("block, frictionless", || block_under(Coulomb::new(0.0)?)),
    ("block, thin layer", || block_under(ThinLayer::new(soil()?, 1.0, 0.4)?)),
    ("block, cohesive", || block_under(Cohesive::new(2.0e4, 5.0e4, 0.5)?)),
    ("block, bearing pressure", || block_under(Yielding::new(2.5e5, 0.5)?)),
    ("block, friction of speed", || {
        block_under(VariableFriction::new(|start| {
            0.2 + 0.2 * (-start.slip_rate.abs() / 0.05).exp()
        }))
    }),
    ("block, P-delta", || {
        Ok(on(block()?.with_p_delta(9.81)?, half_plane(&block()?)?).interface(Coulomb::new(0.6)?))
    }),
    ("block, springs", || {
        let bed = SpringGround::new(-2.0..2.0, 8, 2.0e7, 1.0e7)?.with_dashpots(4.0e5, 2.0e5)?;
        Ok(on(block()?, bed).interface(Coulomb::new(0.4)?))
    }),
    ("block, layers on a half-plane", || layered(profile()?)),
    ("block, layer on a rigid base", || {
        layered(
            SoilProfile::on_rigid_bedrock()
                .with_layer(soil()?, 5.0)?
                .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0)?),
        )
    }),
    ("block, no layers", || layered(SoilProfile::on_half_plane(soil()?))),
    ("block, inclined wave", || {
        let wave = PlaneWave::sv(soil()?, 0.3)?;
        Ok(block_under(Coulomb::new(0.4)?)?.motion(wave.field_from_horizontal(&shaking(), -2.0)?))
    }),
    ("block, vertical motion", || {
        Ok(block_under(Coulomb::new(0.4)?)?.motion(VerticalIncidence {
            vertical: Some(shaking()),
            ..VerticalIncidence::default()
        }))
    }),
    ("block, tilted and loaded", || {
        let block = block()?;
        let load = Load::new(block.horizontal_at(5.0), |t| 4.0e4 * (9.0 * t).sin());
        Ok(block_under(Coulomb::new(0.4)?)?.load(load).gravity_stage(GravityStage::Frictional))
    }),
    ("block, without weight", || Ok(block_under(Bonded)?.gravity(0.0))),
    ("tower, physical", || tower_in(Coordinates::Physical)),
    ("tower, modal", || tower_in(Coordinates::Modes)),
    ("tower, reduced", || tower_in(Coordinates::Reduced { tolerance: 1.0e-6 })),
    ("tower, theta", || Ok(tower_in(Coordinates::Physical)?.scheme(Theta::new(0.6)?))),
    ("tower, Newmark", || Ok(tower_in(Coordinates::Physical)?.scheme(Newmark::default()))),
    ("tower, HHT", || Ok(tower_in(Coordinates::Modes)?.scheme(HhtAlpha::new(-0.1)?))),
    ("building", || Ok(on(building()?, half_plane(&building()?)?).interface(Coulomb::new(0.4)?))),
    ("building, yielding", || {
        Ok(on(yielding_building()?, half_plane(&building()?)?).interface(Coulomb::new(0.4)?))
    }),
    ("building, isolated", || {
        let isolated = building()?.with_law(0, BoucWen::new(6.0e6, 6.0e4, 0.1)?)?;
        Ok(on(isolated, half_plane(&building()?)?).interface(Coulomb::new(0.4)?))
    }),
    ("group", || Ok(on(group()?, half_plane(&group()?)?).interface(Coulomb::new(0.4)?))),
    ("group, without energy balance", || {
        Ok(on(group()?, half_plane(&group()?)?)
            .interface(Coulomb::new(0.3)?)
            .without_energy_balance())
    }),
    ("plan, friction", || body_under(Coulomb::new(0.4)?)),
    ("plan, bonded", || body_under(Bonded)),
    ("plan, bearing pressure", || body_under(Yielding::new(2.5e5, 0.5)?)),
    ("plan, cohesive", || body_under(Cohesive::new(2.0e4, 5.0e4, 0.5)?)),
    ("plan, thin layer", || {
        body_under(ThinLayer::new(soil()?, 1.0, 0.4)?.with_debonded_ratio(0.0)?)
    }),
    ("plan, disc", || {
        let disc = Plan::disc([0.0; 2], 2.0, 6)?;
        let cylinder = RigidBody::cylinder(2.0, 5.0, 1500.0)?;
        Ok(in_plan(cylinder, ElasticGround::in_plan(soil()?, disc)?).interface(Coulomb::new(0.5)?))
    }),
    ("plan, springs", || {
        let bed = SpringGround::under(&body()?, 4, 2.0e7, 1.0e7)?.with_dashpots(4.0e5, 2.0e5)?;
        Ok(in_plan(body()?, bed).interface(Coulomb::new(0.4)?))
    }),
    ("plan, layers on a half-space", || {
        let ground = ElasticGround::under(profile()?, &body()?, 3)?;
        Ok(in_plan(body()?, ground).interface(Coulomb::new(0.4)?))
    }),
    ("plan, storeys", || {
        let ground = ElasticGround::under(soil()?, &storeys()?, 4)?;
        Ok(in_plan(storeys()?, ground).interface(Coulomb::new(0.4)?))
    }),
    ("group in plan", || {
        let pair = StructureGroup::new().with(body()?, -4.0)?.with(storeys()?, 4.0)?;
        let ground = ElasticGround::under(soil()?, &pair, 3)?;
        Ok(in_plan(pair, ground).interface(Coulomb::new(0.4)?))
    }),
];

fn coordinates(name: &str) -> &'static str {
    match name {
        name if name.ends_with("modal") || name.ends_with("HHT") || name.starts_with("group") => {
            "modal"
        }
        name if name.ends_with("reduced") => "reduced",
        _ => "physical",
    }
}

/// Numbers of a state in a fixed order.
fn rows(name: &str, out: &mut String) -> Result<()> {
    let (_, make) = SCENES.iter().find(|(own, _)| *own == name).expect("a name of the table");
    let mut builder = make()?.expected_steps(STEPS);
    if coordinates(name) == "physical" {
        builder = builder.coordinates(Coordinates::Physical);
    }
    let mut simulation = builder.build()?;
    for step in 0..=STEPS {
        let state = if step == 0 { simulation.state() } else { simulation.step()? };
        if step % STRIDE != 0 {
            continue;
        }
        let mut values = vec![state.time, state.base_shear, state.base_moment, state.normal_force];
        values.extend([state.uplifted_fraction, state.mean_slip, state.base_rotation]);
        values.extend(state.contact.iter().flat_map(|c| [c.gap, c.slip, c.pressure, c.shear]));
        values.extend(&state.probes);
        values.extend(state.displacement());
        values.extend(state.velocity());
        values.extend(state.acceleration());
        let e = &state.energy_balance;
        values.extend([e.kinetic, e.strain, e.hysteresis, e.damping, e.soil, e.contact, e.input]);
        write!(out, "{name}\t{}\t{step}", coordinates(name)).expect("strings take all");
        for value in values {
            write!(out, "\t{value:?}").expect("strings take all");
        }
        out.push('\n');
    }
    Ok(())
}

fn main() {
    let path = std::env::args().skip(1).find(|argument| argument != "--bench");
    let mut out = String::new();
    for (name, _) in SCENES {
        if let Err(error) = rows(name, &mut out) {
            writeln!(out, "{name}\t{}\tfailed\t{error}", coordinates(name))
                .expect("strings take all");
        }
    }
    match path {
        Some(path) => std::fs::write(&path, out).expect("a file that can be written"),
        None => print!("{out}"),
    }
}
