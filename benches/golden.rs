//! Every digit of some forty scenes, to compare two versions of the crate.
//!
//! ```text
//! cargo bench --bench golden -- target/golden.csv
//! ```
//!
//! A row is a scene, its coordinates, a step and the numbers of its state, printed with all digits, so that
//! they can be read back exactly. `.ci/golden REVISION` runs the program of two commits and compares: physical
//! coordinates must agree to the last bit, modal and reduced ones to 1e-12 of the largest value of a column.

use std::fmt::Write as _;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::coupled::{
    Coordinates, GravityStage, HhtAlpha, Load, Newmark, Probe, SimulationBuilder, Theta,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::HistoryMethod;
use basemat::interface::{
    Bonded, Cohesive, Coulomb, CyclicYielding, ThinLayer, VariableFriction, Yielding,
};
use basemat::motion::{PlaneWave, Record, Triaxial, VerticalIncidence, el_centro_1940};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{
    Bilinear, BoucWen, FemModel, PlanStorey, RayleighDamping, RigidBlock, RigidBody, ShearBuilding,
    Storey, StoreyBuilding, Structure, StructureGroup,
};
use basemat::{Result, Simulation, Soil};

const STEP_COUNT: usize = 300;
/// States between those that are printed.
const PRINT_INTERVAL: usize = 20;
const TIME_STEP: f64 = 4.0e-3;

type BuildScene = fn() -> Result<SimulationBuilder>;

/// A record that causes uplift and sliding from the first second on.
fn strong_record() -> Record {
    let record = el_centro_1940();
    let accelerations = record.accelerations().iter().skip(70).map(|a| 3.0 * a).collect();
    Record::new(record.time_step(), accelerations).expect("a part of a record")
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

/// A structure in the plane, shaken horizontally.
fn in_plane(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
) -> SimulationBuilder {
    Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ground)
        .motion(strong_record())
}

fn half_plane_under(structure: &dyn Structure) -> Result<ElasticGround> {
    ElasticGround::under(soil()?, structure, 8)
}

/// A block that uplifts and slides on a half-plane with one kind of history.
fn block_with_history(method: HistoryMethod, grading: Grading) -> Result<SimulationBuilder> {
    let strip = Strip::new(-2.0..2.0, 8, grading)?;
    let ground = ElasticGround::new(soil()?, strip)?.with_history(method)?;
    Ok(in_plane(block()?, ground).interface(Coulomb::new(0.4)?))
}

fn block_with_law(
    law: impl basemat::interface::InterfaceLaw + 'static,
) -> Result<SimulationBuilder> {
    let block = block()?;
    let ground = half_plane_under(&block)?;
    Ok(in_plane(block, ground).interface(law))
}

fn tower_in_coordinates(coordinates: Coordinates) -> Result<SimulationBuilder> {
    let tower = tower()?.with_rayleigh(damping()?);
    let top = tower.mesh().node_at(2.0, 6.0)?;
    let top_displacement = tower.row(top, basemat::fem::Direction::X)?;
    let ground = half_plane_under(&tower)?;
    let probes = [
        Probe::acceleration("top", top_displacement.clone()),
        Probe::displacement("drift", top_displacement),
    ];
    Ok(in_plane(tower, ground)
        .interface(Coulomb::new(0.3)?)
        .probes(probes)
        .coordinates(coordinates))
}

fn constant_damping(ratio: f64) -> Result<GeneralizedMaxwell> {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0)
}

fn layer_on_rock() -> Result<SoilProfile> {
    let rock = Soil::from_shear_wave_speed(800.0, 0.25, 2300.0)?;
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0)?;
    let profile = SoilProfile::on_half_plane(rock).with_bedrock_damping(constant_damping(0.01)?);
    Ok(profile.with_layer(layer, 6.0)?.with_damping(constant_damping(0.05)?))
}

fn block_on_profile(profile: SoilProfile) -> Result<SimulationBuilder> {
    let block = block()?;
    let ground = ElasticGround::under(profile, &block, 6)?;
    Ok(in_plane(block, ground).interface(Coulomb::new(0.4)?))
}

fn group() -> Result<StructureGroup> {
    StructureGroup::new().with(building()?, -6.0)?.with(block()?, 5.0)
}

fn body() -> Result<RigidBody> {
    RigidBody::cuboid([4.0, 3.0, 6.0], 1500.0)
}

/// A structure in space, shaken in all directions.
fn in_space(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
) -> SimulationBuilder {
    let scaled_motion = |factor| strong_record().scaled(factor).ok();
    let motion = Triaxial { x: scaled_motion(1.0), y: scaled_motion(0.7), up: scaled_motion(0.4) };
    Simulation::builder(TIME_STEP).structure(structure).ground(ground).motion(motion)
}

fn body_with_law(
    law: impl basemat::interface::InterfaceLaw + 'static,
) -> Result<SimulationBuilder> {
    let ground = ElasticGround::under(soil()?, &body()?, 4)?;
    Ok(in_space(body()?, ground).interface(law))
}

fn building_in_space() -> Result<StoreyBuilding> {
    let storey = PlanStorey::new(3.0, 18.0e3, [4.0, 3.0], [18.0e6, 12.0e6, 40.0e6]);
    StoreyBuilding::new(RigidBody::cuboid([4.0, 3.0, 1.0], 2400.0)?, &[storey; 3])
}

/// Soil that settles in every cycle, with a growing bearing pressure.
fn settling_soil() -> Result<CyclicYielding> {
    CyclicYielding::new(2.5e5, 5.0e-3, 0.5)?
        .with_elastic_range(0.1)?
        .with_depth_gradient(1.0e6)
}

const GOLDEN_SCENES: [(&str, BuildScene); 44] = [
    ("block, direct", || block_with_history(HistoryMethod::Direct, Grading::Cosine)),
    ("block, relaxed transforms on pairs", || {
        block_with_history(HistoryMethod::RelaxedFft, Grading::Cosine)
    }),
    ("block, relaxed transforms on a lattice", || {
        block_with_history(HistoryMethod::RelaxedFft, Grading::Uniform)
    }),
    ("block, exponentials", || {
        block_with_history(HistoryMethod::Exponentials, Grading::Uniform)
    }),
    ("block, history by choice", || block_with_history(HistoryMethod::Auto, Grading::Uniform)),
    ("block, bonded", || block_with_law(Bonded)),
    ("block, uplift only", || block_with_law(Coulomb::uplift_only())),
    ("block, frictionless", || block_with_law(Coulomb::new(0.0)?)),
    ("block, thin layer", || block_with_law(ThinLayer::new(soil()?, 1.0, 0.4)?)),
    ("block, cohesive", || block_with_law(Cohesive::new(2.0e4, 5.0e4, 0.5)?)),
    ("block, bearing pressure", || block_with_law(Yielding::new(2.5e5, 0.5)?)),
    ("block, settling in every cycle", || block_with_law(settling_soil()?)),
    ("block, friction of speed", || {
        block_with_law(VariableFriction::new(|start| {
            0.2 + 0.2 * (-start.slip_rate.abs() / 0.05).exp()
        }))
    }),
    ("block, P-delta", || {
        Ok(in_plane(block()?.with_p_delta(9.81)?, half_plane_under(&block()?)?)
            .interface(Coulomb::new(0.6)?))
    }),
    ("block, springs", || {
        let bed = SpringGround::new(-2.0..2.0, 8, 2.0e7, 1.0e7)?.with_dashpots(4.0e5, 2.0e5)?;
        Ok(in_plane(block()?, bed).interface(Coulomb::new(0.4)?))
    }),
    ("block, layers on a half-plane", || block_on_profile(layer_on_rock()?)),
    ("block, layer on a rigid base", || {
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil()?, 5.0)?;
        block_on_profile(profile.with_damping(constant_damping(0.05)?))
    }),
    ("block, no layers", || block_on_profile(SoilProfile::on_half_plane(soil()?))),
    ("block, inclined wave", || {
        let wave = PlaneWave::sv(soil()?, 0.3)?;
        Ok(block_with_law(Coulomb::new(0.4)?)?
            .motion(wave.field_from_horizontal(&strong_record(), -2.0)?))
    }),
    ("block, vertical motion", || {
        Ok(block_with_law(Coulomb::new(0.4)?)?.motion(VerticalIncidence {
            vertical: Some(strong_record()),
            ..VerticalIncidence::default()
        }))
    }),
    ("block, tilted and loaded", || {
        let block = block()?;
        let load = Load::new(block.horizontal_at(5.0), |t| 4.0e4 * (9.0 * t).sin());
        Ok(block_with_law(Coulomb::new(0.4)?)?
            .load(load)
            .gravity_stage(GravityStage::Frictional))
    }),
    ("block, without weight", || Ok(block_with_law(Bonded)?.gravity(0.0))),
    ("tower, physical", || tower_in_coordinates(Coordinates::Physical)),
    ("tower, modal", || tower_in_coordinates(Coordinates::Modes)),
    ("tower, reduced", || tower_in_coordinates(Coordinates::Reduced { tolerance: 1.0e-6 })),
    ("tower, theta", || {
        Ok(tower_in_coordinates(Coordinates::Physical)?.scheme(Theta::new(0.6)?))
    }),
    ("tower, Newmark", || {
        Ok(tower_in_coordinates(Coordinates::Physical)?.scheme(Newmark::default()))
    }),
    (
        "tower, HHT",
        || Ok(tower_in_coordinates(Coordinates::Modes)?.scheme(HhtAlpha::new(-0.1)?)),
    ),
    ("building", || {
        Ok(in_plane(building()?, half_plane_under(&building()?)?).interface(Coulomb::new(0.4)?))
    }),
    ("building, yielding", || {
        Ok(in_plane(yielding_building()?, half_plane_under(&building()?)?)
            .interface(Coulomb::new(0.4)?))
    }),
    ("building, isolated", || {
        let isolated = building()?.with_law(0, BoucWen::new(6.0e6, 6.0e4, 0.1)?)?;
        Ok(in_plane(isolated, half_plane_under(&building()?)?).interface(Coulomb::new(0.4)?))
    }),
    ("group", || {
        Ok(in_plane(group()?, half_plane_under(&group()?)?).interface(Coulomb::new(0.4)?))
    }),
    ("group, without energy balance", || {
        Ok(in_plane(group()?, half_plane_under(&group()?)?)
            .interface(Coulomb::new(0.3)?)
            .without_energy_balance())
    }),
    ("plan, friction", || body_with_law(Coulomb::new(0.4)?)),
    ("plan, bonded", || body_with_law(Bonded)),
    ("plan, bearing pressure", || body_with_law(Yielding::new(2.5e5, 0.5)?)),
    ("plan, settling in every cycle", || body_with_law(settling_soil()?)),
    ("plan, cohesive", || body_with_law(Cohesive::new(2.0e4, 5.0e4, 0.5)?)),
    ("plan, thin layer", || {
        body_with_law(ThinLayer::new(soil()?, 1.0, 0.4)?.with_debonded_ratio(0.0)?)
    }),
    ("plan, disc", || {
        let disc = Plan::disc([0.0; 2], 2.0, 6)?;
        let cylinder = RigidBody::cylinder(2.0, 5.0, 1500.0)?;
        Ok(in_space(cylinder, ElasticGround::in_plan(soil()?, disc)?).interface(Coulomb::new(0.5)?))
    }),
    ("plan, springs", || {
        let bed = SpringGround::under(&body()?, 4, 2.0e7, 1.0e7)?.with_dashpots(4.0e5, 2.0e5)?;
        Ok(in_space(body()?, bed).interface(Coulomb::new(0.4)?))
    }),
    ("plan, layers on a half-space", || {
        let ground = ElasticGround::under(layer_on_rock()?, &body()?, 3)?;
        Ok(in_space(body()?, ground).interface(Coulomb::new(0.4)?))
    }),
    ("plan, storeys", || {
        let ground = ElasticGround::under(soil()?, &building_in_space()?, 4)?;
        Ok(in_space(building_in_space()?, ground).interface(Coulomb::new(0.4)?))
    }),
    ("group in plan", || {
        let pair = StructureGroup::new().with(body()?, -4.0)?.with(building_in_space()?, 4.0)?;
        let ground = ElasticGround::under(soil()?, &pair, 3)?;
        Ok(in_space(pair, ground).interface(Coulomb::new(0.4)?))
    }),
];

/// Coordinates of a scene, as its rows name them.
fn scene_coordinates(name: &str) -> &'static str {
    match name {
        name if name.ends_with("modal") || name.ends_with("HHT") || name.starts_with("group") => {
            "modal"
        }
        name if name.ends_with("reduced") => "reduced",
        _ => "physical",
    }
}

/// Adds rows with the numbers of the scene's states in a fixed order.
fn write_rows(name: &str, build_scene: BuildScene, text: &mut String) -> Result<()> {
    let mut builder = build_scene()?.expected_steps(STEP_COUNT);
    if scene_coordinates(name) == "physical" {
        builder = builder.coordinates(Coordinates::Physical);
    }
    let mut simulation = builder.build()?;
    for step in 0..=STEP_COUNT {
        let state = if step == 0 { simulation.state() } else { simulation.step()? };
        if step % PRINT_INTERVAL != 0 {
            continue;
        }
        let mut values = vec![state.time, state.base_shear, state.base_moment, state.normal_force];
        values.extend([state.uplifted_fraction, state.mean_slip, state.base_rotation]);
        values.extend(
            state
                .contact
                .iter()
                .flat_map(|element| [element.gap, element.slip, element.pressure, element.shear]),
        );
        values.extend(&state.probes);
        values.extend(state.displacement());
        values.extend(state.velocity());
        values.extend(state.acceleration());
        let energy = &state.energy_balance;
        values.extend([energy.kinetic, energy.strain, energy.hysteresis, energy.damping]);
        values.extend([energy.soil, energy.contact, energy.input]);
        write!(text, "{name}\t{}\t{step}", scene_coordinates(name)).expect("writing to a string");
        for value in values {
            write!(text, "\t{value:?}").expect("writing to a string");
        }
        text.push('\n');
    }
    Ok(())
}

fn main() {
    let path = std::env::args().skip(1).find(|argument| argument != "--bench");
    let mut text = String::new();
    for (name, build_scene) in GOLDEN_SCENES {
        if let Err(error) = write_rows(name, build_scene, &mut text) {
            writeln!(text, "{name}\t{}\tfailed\t{error}", scene_coordinates(name))
                .expect("writing to a string");
        }
    }
    match path {
        Some(path) => std::fs::write(&path, text).expect("a file that can be written"),
        None => print!("{text}"),
    }
}
