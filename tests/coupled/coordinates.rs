//! GOAL: modal coordinates and degrees of freedom step the same structure.
//! SCENE: towers, shear buildings and blocks, bonded, sliding, uplifting and pulled; three schemes.
//! REFERENCE: the run in degrees of freedom, to rounding; a typed error where modes do not decouple.

use basemat::Error;
use basemat::coupled::{Coordinates, Midpoint, Newmark, Probe, SimulationBuilder, State, Theta};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::structure::{
    Base, BaseNode, DofCombination, FemModel, RayleighDamping, ShearBuilding, Storey, Structure,
    Triplets,
};

use basemat_problems::needed_from;
use basemat_problems::scenes::{
    Rider, SI_UNITS, apart, block, friction, scene, shake, states, tower,
};
use basemat_problems::wrapped::StructureWithForce;

/// Function that makes a scene, as often as it is called.
type SceneMaker<'a> = &'a dyn Fn() -> SimulationBuilder;

const RUN_STEPS: usize = 300;

/// All states of a run in these coordinates.
fn run_states(builder: SimulationBuilder, coordinates: Coordinates) -> Vec<State> {
    let builder = builder
        .probe(Probe::displacement("u", vec![(0, 1.0), (1, -0.5)]))
        .probe(Probe::velocity("v", vec![(2, 1.0)]))
        .probe(Probe::acceleration("a", vec![(1, 2.0)]));
    states(&mut builder.coordinates(coordinates).build().unwrap(), RUN_STEPS)
}

/// A tower with a harmonic force at its top.
fn pulled(tower: FemModel) -> impl Structure {
    let along = DofCombination::from(tower.dofs() - 2);
    StructureWithForce { structure: tower, along, force: |time: f64| 2e4 * (20.0 * time).sin() }
}

fn damped_tower() -> FemModel {
    tower(SI_UNITS, Some(RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()))
}

fn building() -> ShearBuilding {
    let storeys = [Storey::new(1.5, 3.0e3, 2.0e6); 4];
    ShearBuilding::new(4.0, 5e3, 1e4, &storeys)
        .unwrap()
        .with_stiffness_damping(0.03)
        .unwrap()
}

fn energies(state: &State) -> Vec<f64> {
    let balance = &state.energy_balance;
    vec![
        balance.kinetic,
        balance.strain,
        balance.damping,
        balance.algorithmic,
        balance.soil,
        balance.contact,
        balance.input,
    ]
}

/// Checks that runs in modes and in degrees of freedom agree to rounding.
fn assert_same_run(name: &str, modal: &[State], physical: &[State]) {
    for (a, b) in modal.iter().zip(physical) {
        assert!(a.modes == b.modes, "{name}: modes of contact differ");
    }
    let differences = [
        apart(modal, physical, |s| s.absolute_displacement().to_vec()),
        apart(modal, physical, |s| s.velocity().to_vec()),
        apart(modal, physical, |s| s.acceleration().to_vec()),
        apart(modal, physical, |s| vec![s.probes[0]]),
        apart(modal, physical, |s| vec![s.probes[1]]),
        apart(modal, physical, |s| vec![s.probes[2]]),
        apart(modal, physical, |s| vec![s.base_shear, s.normal_force]),
        // Relative to the ground's displacement: a frictionless base does not rock.
        apart(modal, physical, |s| vec![s.base_rotation, s.free_field[0]]),
        apart(modal, physical, energies),
    ];
    println!("{name}: {differences:?}");
    assert!(differences.iter().all(|value| *value < 1e-9), "{name}: {differences:?}");
}

#[test]
fn modes_and_dofs_agree() {
    let scenes: [(&str, SceneMaker<'_>); 8] = [
        ("bonded", &|| scene(SI_UNITS, 0.6).structure(tower(SI_UNITS, None)).interface(Bonded)),
        ("sliding", &|| {
            scene(SI_UNITS, 0.6).structure(tower(SI_UNITS, None)).interface(friction(0.3))
        }),
        ("uplift", &|| {
            scene(SI_UNITS, 0.6)
                .structure(tower(SI_UNITS, None))
                .interface(friction(f64::INFINITY))
        }),
        ("smooth", &|| scene(SI_UNITS, 0.6).structure(damped_tower()).interface(friction(0.0))),
        ("pulled", &|| {
            scene(SI_UNITS, 0.6).structure(pulled(damped_tower())).interface(friction(0.4))
        }),
        ("block", &|| scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(friction(0.3))),
        ("building", &|| scene(SI_UNITS, 0.6).structure(building()).interface(friction(0.5))),
        ("bonded building", &|| scene(SI_UNITS, 0.6).structure(building()).interface(Bonded)),
    ];
    let set_schemes: [fn(SimulationBuilder) -> SimulationBuilder; 3] = [
        |builder| builder.scheme(Midpoint),
        |builder| builder.scheme(Theta::new(0.6).unwrap()),
        |builder| builder.scheme(Newmark::default()),
    ];
    for (name, make_scene) in scenes {
        for set_scheme in set_schemes {
            let modal = run_states(set_scheme(make_scene()), Coordinates::Modes);
            let physical = run_states(set_scheme(make_scene()), Coordinates::Physical);
            assert_eq!(modal.len(), physical.len());
            assert_same_run(name, &modal, &physical);
        }
    }
}

/// In stiff structures moved by decimetres, K u must be computed without rigid motion.
///
/// K u of a rigid motion cancels to rounding of K times that motion. K u is computed without the translation, and in
/// modes without any rigid motion.
#[test]
fn stiffness_does_not_open_the_energy_balance() {
    for coordinates in [Coordinates::Modes, Coordinates::Physical] {
        for (modulus, strength) in [(2e8, 1.0), (1e13, 1.0), (1e13, 10.0)] {
            let material = Material::new(modulus, 0.2, 1500.0).unwrap();
            let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, material)]).unwrap();
            let model = FemModel::on_base(mesh).unwrap();
            let bonded =
                scene(SI_UNITS, strength).motion(shake(SI_UNITS, strength)).interface(Bonded);
            let builder = bonded.structure(model).coordinates(coordinates);
            let run = builder.build().unwrap().run(RUN_STEPS, |_| {}).unwrap();
            let max_energy_error = run.energy_error;
            let end = run.energy_balance.residual();
            println!(
                "{coordinates:?}, E = {modulus:e}, × {strength}: {max_energy_error:.1e}, {end:.1e}"
            );
            // In degrees of freedom K u contains the rocking; a translation of 1 m would give 1e-8.
            let limit = match coordinates {
                Coordinates::Modes => 1e-12,
                _ => 1e-10 + 1e-22 * modulus,
            };
            assert!(
                max_energy_error < limit,
                "{coordinates:?}, {modulus:e}, × {strength}: {max_energy_error:e}"
            );
        }
    }
}

/// A tower of 286 degrees of freedom on a heavy foundation.
fn large_tower() -> SimulationBuilder {
    let material = Material::new(5e9, 0.2, 1500.0).unwrap();
    let foundation = Layer::new(0.5, 1, Material::new(5e9, 0.3, 8000.0).unwrap());
    let layers = [foundation, Layer::new(7.5, 11, material)];
    let model = FemModel::on_base(Mesh::layered_block(-2.0..2.0, 10, &layers).unwrap());
    scene(SI_UNITS, 0.6).structure(model.unwrap()).interface(friction(0.3))
}

/// Large structures have accurate modes, too.
///
/// The tests above stay below order 128, from which on another algorithm for eigenvectors may be used.
#[test]
fn modes_of_a_large_structure_agree() {
    let modal = run_states(large_tower(), Coordinates::Modes);
    let physical = run_states(large_tower(), Coordinates::Physical);
    let difference = apart(&modal, &physical, |s| s.absolute_displacement().to_vec());
    assert_eq!(modal[0].absolute_displacement().len(), 286);
    assert!(difference < 1e-9, "{difference:e}");
}

/// A tower with a dashpot that couples its modes.
struct TowerWithDashpot(FemModel);

impl Structure for TowerWithDashpot {
    needed_from!(0);

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(0, 40, 1e4);
        Ok(())
    }
}

/// Error of a structure in modal coordinates; `None` if it has them.
fn error_of_modes(structure: impl Structure + 'static) -> Option<Error> {
    let builder = scene(SI_UNITS, 0.1).structure(structure).interface(friction(0.4));
    builder.coordinates(Coordinates::Modes).build().err()
}

/// A structure whose modes are coupled keeps its degrees of freedom; a request for modes is an error.
#[test]
fn modes_are_errors_where_they_do_not_decouple() {
    let with_dashpot = || TowerWithDashpot(tower(SI_UNITS, None));
    for error in [error_of_modes(with_dashpot()), error_of_modes(Rider { block: block(SI_UNITS) })]
    {
        assert!(
            matches!(error, Some(Error::Scene { quantity: "modal coordinates", .. })),
            "{error:?}"
        );
    }
    assert!(error_of_modes(tower(SI_UNITS, None)).is_none());
    let auto = scene(SI_UNITS, 0.1).structure(with_dashpot()).interface(friction(0.4));
    assert!(auto.expected_steps(1_000_000).build().is_ok());
}

/// Two masses joined by a spring, of which the first slides on a base that cannot lift.
struct SlidingMasses;

impl Structure for SlidingMasses {
    fn dofs(&self) -> usize {
        2
    }

    fn base(&self) -> Base {
        [-2.0, 2.0]
            .map(|x| BaseNode { x, horizontal: 0.into(), ..BaseNode::default() })
            .into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        (0..2).for_each(|i| matrix.add(i, i, 5e3));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(0, 1, 2e6);
        Ok(())
    }
}

fn states_of_masses(coordinates: Coordinates) -> Vec<State> {
    let builder = scene(SI_UNITS, 0.6).gravity(0.0).structure(SlidingMasses).interface(Bonded);
    states(&mut builder.coordinates(coordinates).build().unwrap(), RUN_STEPS)
}

/// A base that cannot lift has no rows of vertical motion, in modes as in degrees of freedom.
#[test]
fn modes_of_a_base_that_cannot_lift_agree() {
    let modal = states_of_masses(Coordinates::Modes);
    let physical = states_of_masses(Coordinates::Physical);
    let sway = apart(&modal, &physical, |s| s.displacement().to_vec());
    let shear = apart(&modal, &physical, |s| vec![s.base_shear]);
    assert!(sway < 1e-9 && shear < 1e-9, "{sway:e} {shear:e}");
    assert!(physical.iter().any(|s| s.base_shear.abs() > 1e3));
}
