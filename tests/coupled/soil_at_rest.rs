//! GOAL: soil in a trench that begins at rest does not move under its weight, and carries the weight of what stands on it.
//! SCENE: boxes of elastic soil, clay and sand in two layers, alone and under a welded block, whole and reduced.
//! REFERENCE: rest; the weight of the block; the same box of elastic soil; the identity of the energies.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::{GravityStage, SimulationBuilder};
use basemat::fem::{
    Direction, DruckerPrager, Iwan, MassKind, Material, Mesh, Quad4, QuadFormulation,
    SharedMaterial, Spring, StressAtRest,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::soil::SoilProfile;
use basemat::structure::{CraigBampton, FemModel, RayleighDamping, Structure};
use basemat::{Simulation, Soil, unobserved};

use basemat_problems::soil_box::SoilBox;
use basemat_problems::yielding_blocks::grid_lines;

/// Half width and depth of the box, m.
const HALF_WIDTH: f64 = 4.0;
const BOX_DEPTH: f64 = 3.0;
/// Depth of the boundary between two soils, within an element, m.
const LAYER_DEPTH: f64 = 1.3;
/// Shear modulus (Pa) and Poisson's ratio of the elements.
const SHEAR_MODULUS: f64 = 60.0e6;
const POISSON_RATIO: f64 = 0.3;
const SOIL_DENSITY: f64 = 1900.0;
/// K₀: horizontal over vertical pressure at rest.
const PRESSURE_RATIO: f64 = 0.6;

fn profile() -> SoilProfile {
    let lower = Soil::new(SHEAR_MODULUS, POISSON_RATIO, SOIL_DENSITY).unwrap();
    let upper = Soil::new(0.7 * SHEAR_MODULUS, 0.35, 1600.0).unwrap();
    SoilProfile::on_half_plane(lower).with_layer(upper, LAYER_DEPTH).unwrap()
}

fn elastic() -> Material {
    Material::new(2.0 * (1.0 + POISSON_RATIO) * SHEAR_MODULUS, POISSON_RATIO, SOIL_DENSITY).unwrap()
}

/// Clay with a strength, Pa.
fn clay(strength: f64) -> Iwan {
    let limit_strain = 200.0 * strength / SHEAR_MODULUS;
    Iwan::hyperbolic(SHEAR_MODULUS, strength, limit_strain, POISSON_RATIO, SOIL_DENSITY).unwrap()
}

/// Soil of the profile at rest, with this ratio K₀.
fn stress(ratio: f64) -> StressAtRest {
    profile().stress_at_rest(STANDARD_GRAVITY, Some(ratio)).unwrap()
}

fn soil_box(material: impl Into<SharedMaterial>) -> SoilBox {
    let material = material.into();
    let x = grid_lines(-HALF_WIDTH, 2.0 * HALF_WIDTH, 4);
    let y = grid_lines(-BOX_DEPTH, BOX_DEPTH, 3);
    SoilBox::new(&x, &y, &material, &stress(PRESSURE_RATIO)).unwrap()
}

/// Box of four-node quadrilaterals of clay.
fn quad4_box() -> SoilBox {
    let mut mesh = Mesh::new();
    for y in grid_lines(-BOX_DEPTH, BOX_DEPTH, 3) {
        for x in grid_lines(-HALF_WIDTH, 2.0 * HALF_WIDTH, 8) {
            mesh.add_node(x, y).unwrap();
        }
    }
    for row in 0..3 {
        for column in 0..8 {
            let corner = 9 * row + column;
            let nodes = [corner, corner + 1, corner + 10, corner + 9];
            mesh.add(Quad4::new(nodes, clay(60.0e3), QuadFormulation::MeanDilatation)).unwrap();
        }
    }
    let mesh = mesh.with_stress_at_rest(&stress(PRESSURE_RATIO)).unwrap();
    SoilBox { mesh }
}

fn ground() -> TrenchGround {
    let trench = Trench::new(-HALF_WIDTH..HALF_WIDTH, BOX_DEPTH).unwrap();
    TrenchGround::new(profile(), trench.elements(6, 3).unwrap()).unwrap()
}

fn scene() -> SimulationBuilder {
    Simulation::builder(0.02).ground(ground()).interface(Bonded).expected_steps(4)
}

/// Largest magnitude in a list.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// Checks the stresses of an element of the model in a simulation.
fn assert_stresses_at_rest(simulation: &Simulation, tolerance: f64) {
    let structure: &dyn std::any::Any = simulation.structure();
    let model: &FemModel = structure.downcast_ref().unwrap();
    for point in model.solid_points(1).unwrap() {
        let depth = -point.position[1];
        let mass = 1600.0 * depth.min(LAYER_DEPTH) + SOIL_DENSITY * (depth - LAYER_DEPTH).max(0.0);
        let vertical = -STANDARD_GRAVITY * mass;
        let expected = [PRESSURE_RATIO * vertical, vertical, PRESSURE_RATIO * vertical, 0.0];
        for (computed, expected) in point.stress.iter().zip(expected) {
            assert!((computed - expected).abs() < tolerance, "{computed} {expected}");
        }
    }
}

/// GOAL: there are neither displacements nor tractions in two soils whose boundary lies within elements.
#[test]
fn soil_at_rest_does_not_move_under_its_weight() {
    let sand = DruckerPrager::new(elastic(), 1.0e3, 0.6, 0.3).unwrap();
    let boxes = [
        ("elastic", soil_box(elastic())),
        ("clay", soil_box(clay(60.0e3))),
        ("sand", soil_box(sand)),
        ("clay of Quad4", quad4_box()),
    ];
    let weight = STANDARD_GRAVITY * SOIL_DENSITY * BOX_DEPTH;
    // Settlement of a column of this height under its weight.
    let settlement = 0.5 * weight * BOX_DEPTH / SHEAR_MODULUS;
    for (name, soil_box) in boxes {
        for kind in [MassKind::Consistent, MassKind::Lumped] {
            let model = soil_box.model().with_mass(kind);
            let is_elastic = model.solid_points(0).is_err();
            let mut simulation = scene().structure(model).build().unwrap();
            let mut motion = largest(simulation.static_displacement());
            let mut traction = 0.0_f64;
            for _ in 0..4 {
                let state = simulation.step().unwrap();
                motion = motion.max(largest(state.displacement()));
                for element in &state.contact {
                    traction = traction.max(element.pressure.abs()).max(element.shear.abs());
                }
            }
            println!("{name}, {kind:?}: {:.1e} {:.1e}", motion / settlement, traction / weight);
            assert!(motion < 1e-10 * settlement, "{name}: {motion:e} m");
            assert!(traction < 1e-10 * weight, "{name}: {traction:e} Pa");
            if !is_elastic {
                assert_stresses_at_rest(&simulation, 1e-10 * weight);
            }
        }
    }
}

/// Density of a block 4 m wide and 2 m high, kg/m³.
const BLOCK_DENSITY: f64 = 2000.0;

/// A block on the soil, welded to it.
fn with_block(soil: SoilBox) -> SoilBox {
    let concrete = Material::new(20.0e9, 0.2, BLOCK_DENSITY).unwrap();
    soil.with_block(&[-2.0, 0.0, 2.0], &[0.0, 1.0, 2.0], &concrete.into()).unwrap()
}

/// GOAL: the trench carries the block alone; strong clay and reduced soil settle as elastic soil, in every gravity stage.
#[test]
fn soil_at_rest_carries_the_weight_of_a_block() {
    let weight = STANDARD_GRAVITY * BLOCK_DENSITY * 8.0;
    let elastic_model = with_block(soil_box(elastic())).model();
    let strong_model = with_block(soil_box(clay(1.0e9))).model();
    let top = elastic_model.mesh().node_at(0.0, 2.0).unwrap();
    let row = elastic_model.row(top, Direction::Y).unwrap();
    let reduced_structure = CraigBampton::new(30).reduce(elastic_model.clone()).unwrap();
    let reduced_row = reduced_structure.recovery().row(row.clone()).unwrap();
    let models: [(&str, Box<dyn Structure>, _, GravityStage); 5] = [
        ("elastic", Box::new(elastic_model.clone()), row.clone(), GravityStage::Frictionless),
        ("strong clay", Box::new(strong_model), row.clone(), GravityStage::Frictionless),
        ("reduced", Box::new(reduced_structure), reduced_row, GravityStage::Frictionless),
        ("frictional", Box::new(elastic_model.clone()), row.clone(), GravityStage::Frictional),
        ("wished", Box::new(elastic_model), row, GravityStage::WishedInPlace),
    ];
    let mut settlements = Vec::new();
    for (name, structure, row, stage) in models {
        let simulation = scene().structure(structure).gravity_stage(stage).build().unwrap();
        let normal_force = simulation.state().normal_force;
        assert!((normal_force / weight - 1.0).abs() < 1e-9, "{name}: {normal_force} N/m");
        let displacement = simulation.static_displacement();
        let settlement: f64 = row.iter().map(|(dof, factor)| factor * displacement[*dof]).sum();
        println!("{name}: {settlement:.6e} m");
        settlements.push(settlement);
    }
    assert!(settlements[0] < -1e-4, "{settlements:?}");
    for (index, settlement) in settlements.iter().enumerate() {
        // The modes of the reduction contain only a part of the deformation of the block by its weight.
        let limit = if index == 2 { 2e-4 } else { 1e-9 };
        assert!((settlement / settlements[0] - 1.0).abs() < limit, "{settlements:?}");
    }
}

/// GOAL: the energies close without weight and pressures of the soil, whose works −σ₀ : ε cancel.
#[test]
fn the_balance_closes_around_soil_at_rest_that_yields() {
    let sand = DruckerPrager::new(elastic(), 4.0e3, 0.6, 0.6).unwrap();
    for (name, material) in
        [("clay", SharedMaterial::from(clay(60.0e3))), ("sand", SharedMaterial::from(sand))]
    {
        let model = with_block(soil_box(material))
            .model()
            .with_rayleigh(RayleighDamping::new(0.0, 1e-3).unwrap());
        let ground = ground();
        let record = el_centro_1940().scaled(1.5).unwrap().padded(0.1, 0.0).unwrap();
        let surface = VerticalIncidence::from(record);
        let motion = TrenchMotion::new(&ground, surface, &mut unobserved).unwrap();
        let mut simulation = Simulation::builder(0.02)
            .ground(ground)
            .structure(model)
            .interface(Bonded)
            .motion(motion)
            .expected_steps(128)
            .build()
            .unwrap();
        let run = simulation.run(128, |_| {}).unwrap();
        println!("{name}: open by {:.1e}\n{}", run.energy_error, run.energy_balance);
        assert!(run.energy_error < 1e-9, "{name}: {:e}", run.energy_error);
        assert!(run.energy_balance.hysteresis > 1e-3 * run.energy_balance.largest, "{name}");
    }
}

/// Text of the error of a result.
fn error_text<T>(result: basemat::Result<T>) -> String {
    result.err().expect("an error").to_string()
}

/// GOAL: impossible initial states are errors with place, value and need.
#[test]
fn soil_at_rest_that_would_be_wrong_is_an_error() {
    // |s| = √(2/3) σ_v (1 − K₀) = √2 τ_n.
    let lines = [-1.0, 0.0, 1.0];
    let result_for_strength = |strength: f64| {
        Mesh::quad8_block(&lines, &[-3.0, -1.5, 0.0], |_, _| clay(strength))
            .unwrap()
            .with_stress_at_rest(&StressAtRest::new(10.0, 2000.0, 0.4).unwrap())
    };
    // The lowest points of the mesh are at −(1.5 + 0.75 (1 + 1/√3)) m.
    let depth = 1.5 + 0.75 * (1.0 + 1.0 / 3.0_f64.sqrt());
    let needed = 20.0e3 * depth * 0.6 / 3.0_f64.sqrt();
    assert!(result_for_strength(1.001 * needed).is_ok());
    let text = error_text(result_for_strength(0.999 * needed));
    assert!(text.contains("element 0") && text.contains("depth of 2.683 m"), "{text}");

    let soil = soil_box(elastic());
    let above = Mesh::quad8_block(&lines, &[-1.0, 1.0], |_, _| elastic()).unwrap();
    let text = error_text(above.with_stress_at_rest(&stress(PRESSURE_RATIO)));
    assert!(text.contains("height of a node"), "{text}");
    let mut with_spring = soil.mesh.clone();
    with_spring.add(Spring::new([0, 1], Direction::X, 1.0).unwrap()).unwrap();
    let text = error_text(with_spring.with_stress_at_rest(&stress(PRESSURE_RATIO)));
    assert!(text.contains("quadrilaterals"), "{text}");

    // The soil has no ground at its walls.
    let base = soil.mesh.nodes_at_height(-BOX_DEPTH, 1e-9).unwrap();
    let text = error_text(FemModel::in_trench(soil.mesh.clone(), &base));
    assert!(text.contains("side") && text.contains("pressure at rest"), "{text}");
    let on_surface = FemModel::on_base(soil.mesh.clone()).unwrap();
    let text = error_text(on_surface.mass_at_rest());
    assert!(text.contains("pressure at rest"), "{text}");

    let text = error_text(soil.model().with_p_delta(9.81));
    assert!(text.contains("soil at rest"), "{text}");
    let friction = scene().structure(soil.model()).interface(Coulomb::new(0.5).unwrap());
    let text = error_text(friction.build());
    assert!(text.contains("interface law of soil at rest"), "{text}");
    let unloaded_scene = scene().structure(soil.model()).gravity_stage(GravityStage::Unloaded);
    assert!(error_text(unloaded_scene.build()).contains("gravity stage"));
    for (depth, density, ratio) in [(0.0, 1900.0, 0.5), (2.0, -1.0, 0.5), (2.0, 1900.0, f64::NAN)] {
        let fault = stress(PRESSURE_RATIO).with_soil_below(depth, density, ratio);
        assert!(fault.is_err(), "{depth} {density} {ratio}");
    }
    assert!(StressAtRest::new(0.0, 1900.0, 0.5).is_err());
}
