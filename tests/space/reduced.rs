//! Reduced coordinates of bricks on many cells, beside their degrees of freedom: the base bends, lifts off and slides.
//!
//! The structure is damped in proportion to mass and stiffness, to mass alone, or not at all.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{Coordinates, Probe, State};
use basemat::fem::{Direction, Hex8, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::Quantity;
use basemat::structure::{FemModel, RayleighDamping, Structure};
use basemat::{Error, Simulation};
use basemat_problems::scenes::{apart, states};

const BRICKS_PER_SIDE: usize = 7;
const BRICK_LAYERS: usize = 6;

/// Young's modulus of a soft block, Pa.
const SOFT_MODULUS: f64 = 1.5e8;

/// Young's modulus of concrete, Pa.
const CONCRETE_MODULUS: f64 = 3.0e10;

/// Damping of 5 % at 2 and 15 Hz, in proportion to mass and stiffness.
fn rayleigh() -> RayleighDamping {
    RayleighDamping::from_ratios([2.0, 15.0], [0.05; 2]).unwrap()
}

/// A block of 8 m × 8 m × 9 m.
fn block(young_modulus: f64, damping: Option<RayleighDamping>) -> FemModel {
    layered_block(BRICK_LAYERS, young_modulus, damping)
}

/// A block of layers of bricks.
fn layered_block(layers: usize, young_modulus: f64, damping: Option<RayleighDamping>) -> FemModel {
    let material = Material::new(young_modulus, 0.2, 1800.0).unwrap();
    let mut mesh = Mesh::in_space();
    let lines: Vec<f64> = (0..=BRICKS_PER_SIDE)
        .map(|k| 8.0 * k as f64 / BRICKS_PER_SIDE as f64 - 4.0)
        .collect();
    let base_grid = mesh
        .add_grid(lines.len(), lines.len(), |row, column| [lines[column], lines[row], 0.0])
        .unwrap();
    let heights: Vec<f64> = (1..=layers).map(|k| 9.0 * k as f64 / layers as f64).collect();
    for brick in base_grid.extrude(&mut mesh, &heights).unwrap() {
        mesh.add(Hex8::new(brick, material)).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    damping.into_iter().fold(model, FemModel::with_rayleigh)
}

/// States on 6 × 6 cells, which receive 108 tractions.
fn march(model: FemModel, coordinates: Coordinates) -> Vec<State> {
    assert_eq!(model.dofs(), 1344);
    states(&mut build(model, coordinates).unwrap(), 150)
}

fn build(model: FemModel, coordinates: Coordinates) -> basemat::Result<Simulation> {
    let corner = model.mesh().node_at_point([4.0, 4.0, 9.0]).unwrap();
    let roof = model.row(corner, Direction::X).unwrap();
    let section = model.section_in_space(4.5, [0.0; 2]).unwrap();
    let plan = Plan::rectangle(-4.0..4.0, -4.0..4.0, 6).unwrap();
    let springs = SpringGround::in_plan(plan, [4.0e7, 2.0e7, 2.0e7]).unwrap();
    let record = el_centro_1940().scaled(1.5).unwrap();
    let y = Some(record.padded(0.3, 0.0).unwrap());
    let motion = Triaxial { x: Some(record.clone()), y, up: Some(record.scaled(0.5).unwrap()) };
    Simulation::builder(0.01)
        .structure(model)
        .ground(springs.with_dashpots(6.0e5, 3.0e5).unwrap())
        .interface(Coulomb::new(0.3).unwrap())
        .motion(motion)
        .probe(Probe::displacement("roof", roof))
        .probe(Probe::section("shear", &section.shear[0]))
        .probe(Probe::section("moment", &section.moments[1]))
        .coordinates(coordinates)
        .build()
}

/// Relative difference of the time series of a probe.
fn probe_error(full_states: &[State], reduced_states: &[State], probe: usize) -> f64 {
    apart(full_states, reduced_states, |state| vec![state.probes[probe]])
}

fn pressures(state: &State) -> Vec<f64> {
    state.contact.iter().map(|contact| contact.pressure).collect()
}

#[test]
fn reduced_coordinates_on_many_cells_keep_the_tolerance() {
    let mass_proportional = RayleighDamping::new(0.6, 0.0).unwrap();
    for damping in [Some(rayleigh()), Some(mass_proportional), None] {
        let full_states = march(block(SOFT_MODULUS, damping), Coordinates::Physical);
        let max_uplift =
            full_states.iter().map(|state| state.uplifted_fraction).fold(0.0, f64::max);
        let slips = full_states.iter().map(|state| state.value(Quantity::LargestSlip));
        let max_slip = slips.fold(0.0, f64::max);
        assert!(max_uplift > 0.1 && max_slip > 1e-3, "{max_uplift} {max_slip}");
        let tolerance = 1e-3;
        let reduced_states =
            march(block(SOFT_MODULUS, damping), Coordinates::Reduced { tolerance });
        assert!(reduced_states.iter().all(|state| state.energy_balance.residual() < 1e-9));
        let errors = [
            apart(&full_states, &reduced_states, |state| vec![state.base_shear]),
            apart(&full_states, &reduced_states, |state| state.absolute_displacement().to_vec()),
            probe_error(&full_states, &reduced_states, 0),
            apart(&full_states, &reduced_states, pressures),
        ];
        println!("{damping:?}: {errors:?}, {max_uplift} {max_slip}");
        let section_errors = [1, 2].map(|probe| probe_error(&full_states, &reduced_states, probe));
        assert!(section_errors.iter().all(|error| *error < tolerance), "{section_errors:?}");
        // With all coordinates the errors would be rounding.
        assert!(errors.iter().all(|error| (1e-12..tolerance).contains(error)), "{errors:?}");
    }
}

/// Forces at half the height of a block of concrete.
///
/// Omitting directions shorter than the root of the tolerance is not enough: errors of 1.7e-4 and 8.3e-4.
#[test]
fn section_forces_keep_the_tolerance() {
    let model = block(CONCRETE_MODULUS, Some(rayleigh()));
    let full_states = march(model.clone(), Coordinates::Physical);
    assert!(full_states.iter().any(|state| state.uplifted_fraction > 0.1));
    // The second tolerance needs more Ritz vectors than are allowed, so that all modes are stepped.
    for tolerance in [1e-4, 1e-6] {
        let reduced_states = march(model.clone(), Coordinates::Reduced { tolerance });
        let errors = [0, 1, 2].map(|probe| probe_error(&full_states, &reduced_states, probe));
        println!("{tolerance:e}: roof, section shear and moment {errors:?}");
        assert!(errors.iter().all(|error| *error < tolerance), "{errors:?}");
    }
}

/// A model with too many degrees of freedom for all its modes: the error names the cause and the remedies.
#[test]
fn a_tolerance_beyond_the_vectors_is_an_error_with_its_cause() {
    let model = layered_block(14, CONCRETE_MODULUS, Some(rayleigh()));
    assert_eq!(model.dofs(), 2880);
    match build(model, Coordinates::Reduced { tolerance: 1e-6 }).map(|_| ()) {
        Err(Error::Accuracy { remedy, tolerance, .. }) => {
            assert!((tolerance / 1e-6 - 1.0).abs() < 1e-9);
            assert!(remedy.contains("108 forces; with more than 99"), "{remedy}");
            assert!(remedy.contains("use a tolerance of 1e-4, omit such probes"), "{remedy}");
        }
        other => panic!("{other:?}"),
    }
}

/// Rayleigh damping without the P–Δ stiffness couples the modes.
#[test]
fn rayleigh_damping_with_p_delta_is_reduced_on_many_cells() {
    let model = block(SOFT_MODULUS, Some(rayleigh())).with_p_delta(9.81).unwrap();
    let full_states = march(model.clone(), Coordinates::Physical);
    let tolerance = 1e-3;
    let reduced_states = march(model, Coordinates::Reduced { tolerance });
    assert!(reduced_states.iter().all(|state| state.energy_balance.residual() < 1e-9));
    let mut errors = vec![apart(&full_states, &reduced_states, |state| vec![state.base_shear])];
    errors.extend([0, 1, 2].map(|probe| probe_error(&full_states, &reduced_states, probe)));
    println!("{errors:?}");
    assert!(errors.iter().all(|error| (1e-12..tolerance).contains(error)), "{errors:?}");
}
