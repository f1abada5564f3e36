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
use basemat_problems::scenes::{Rider, SI, apart, block, friction, scene, shake, states, tower};
use basemat_problems::wrapped::Pulled;

/// Makes a scene, as often as it is called.
type Make<'a> = &'a dyn Fn() -> SimulationBuilder;

const STEPS: usize = 300;

fn march(builder: SimulationBuilder, coordinates: Coordinates) -> Vec<State> {
    let builder = builder
        .probe(Probe::displacement("u", vec![(0, 1.0), (1, -0.5)]))
        .probe(Probe::velocity("v", vec![(2, 1.0)]))
        .probe(Probe::acceleration("a", vec![(1, 2.0)]));
    states(&mut builder.coordinates(coordinates).build().unwrap(), STEPS)
}

/// Somebody pulls it at the top.
fn pulled(tower: FemModel) -> impl Structure {
    let along = DofCombination::from(tower.dofs() - 2);
    Pulled { structure: tower, along, force: |time: f64| 2e4 * (20.0 * time).sin() }
}

#[test]
fn modes_and_dofs_agree() {
    let damped = || tower(SI, Some(RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()));
    let building = || {
        let storeys = [Storey::new(1.5, 3.0e3, 2.0e6); 4];
        ShearBuilding::new(4.0, 5e3, 1e4, &storeys).unwrap().with_stiffness_damping(0.03).unwrap()
    };
    let base = || scene(SI, 0.6);
    let scenes: [(&str, Make<'_>); 8] = [
        ("bonded", &|| base().structure(tower(SI, None)).interface(Bonded)),
        ("sliding", &|| base().structure(tower(SI, None)).interface(friction(0.3))),
        ("uplift", &|| base().structure(tower(SI, None)).interface(friction(f64::INFINITY))),
        ("smooth", &|| base().structure(damped()).interface(friction(0.0))),
        ("pulled", &|| base().structure(pulled(damped())).interface(friction(0.4))),
        ("block", &|| base().structure(block(SI)).interface(friction(0.3))),
        ("building", &|| base().structure(building()).interface(friction(0.5))),
        ("bonded building", &|| base().structure(building()).interface(Bonded)),
    ];
    for (name, make) in scenes {
        for scheme in 0..3 {
            let scheme = |builder: SimulationBuilder| match scheme {
                0 => builder.scheme(Midpoint),
                1 => builder.scheme(Theta::new(0.6).unwrap()),
                _ => builder.scheme(Newmark::default()),
            };
            let modes = march(scheme(make()), Coordinates::Modes);
            let dofs = march(scheme(make()), Coordinates::Physical);
            let all_modes =
                |states: &[State]| -> Vec<_> { states.iter().map(|s| s.modes.clone()).collect() };
            assert!(all_modes(&modes) == all_modes(&dofs), "{name}: modes of contact differ");
            let energy_balance = |s: &State| {
                let l = &s.energy_balance;
                vec![l.kinetic, l.strain, l.damping, l.algorithmic, l.soil, l.contact, l.input]
            };
            let differences = [
                apart(&modes, &dofs, |s| s.absolute_displacement().to_vec()),
                apart(&modes, &dofs, |s| s.velocity().to_vec()),
                apart(&modes, &dofs, |s| s.acceleration().to_vec()),
                apart(&modes, &dofs, |s| vec![s.probes[0]]),
                apart(&modes, &dofs, |s| vec![s.probes[1]]),
                apart(&modes, &dofs, |s| vec![s.probes[2]]),
                apart(&modes, &dofs, |s| vec![s.base_shear, s.normal_force]),
                // Relative to the ground's displacement: a frictionless base does not rock.
                apart(&modes, &dofs, |s| vec![s.base_rotation, s.free_field[0]]),
                apart(&modes, &dofs, energy_balance),
            ];
            println!("{name}: {differences:?}");
            assert!(differences.iter().all(|d| *d < 1e-9), "{name}: {differences:?}");
        }
    }
}

/// K u of a rigid motion of decimetres cancels to rounding of K times that motion, which in a stiff structure is large.
/// K u is computed without the translation, and in modes without any rigid motion.
#[test]
fn stiffness_does_not_open_the_energy_balance() {
    for coordinates in [Coordinates::Modes, Coordinates::Physical] {
        for (modulus, strength) in [(2e8, 1.0), (1e13, 1.0), (1e13, 10.0)] {
            let material = Material::new(modulus, 0.2, 1500.0).unwrap();
            let mesh = Mesh::layered_block(-2.0..2.0, 6, &[Layer::new(6.0, 6, material)]).unwrap();
            let model = FemModel::on_base(mesh).unwrap();
            let bonded = scene(SI, strength).motion(shake(SI, strength)).interface(Bonded);
            let builder = bonded.structure(model).coordinates(coordinates);
            let run = builder.build().unwrap().run(STEPS, |_| {}).unwrap();
            let (largest, end) = (run.energy_error, run.energy_balance.residual());
            println!("{coordinates:?}, E = {modulus:e}, × {strength}: {largest:.1e}, {end:.1e}");
            // In degrees of freedom rocking is left in K u; a translation of 1 m would give 1e-8.
            let limit = match coordinates {
                Coordinates::Modes => 1e-12,
                _ => 1e-10 + 1e-22 * modulus,
            };
            assert!(largest < limit, "{coordinates:?}, {modulus:e}, × {strength}: {largest:e}");
        }
    }
}

/// Large structures have accurate modes as well: the tests above stay below order 128, from which
/// on another algorithm for eigenvectors may be used.
#[test]
fn modes_of_a_large_structure_agree() {
    let make = || {
        let material = Material::new(5e9, 0.2, 1500.0).unwrap();
        let foundation = Layer::new(0.5, 1, Material::new(5e9, 0.3, 8000.0).unwrap());
        let layers = [foundation, Layer::new(7.5, 11, material)];
        let model = FemModel::on_base(Mesh::layered_block(-2.0..2.0, 10, &layers).unwrap());
        scene(SI, 0.6).structure(model.unwrap()).interface(friction(0.3))
    };
    let (modes, dofs) = (march(make(), Coordinates::Modes), march(make(), Coordinates::Physical));
    let difference = apart(&modes, &dofs, |s| s.absolute_displacement().to_vec());
    assert!(modes[0].absolute_displacement().len() == 286 && difference < 1e-9, "{difference:e}");
}

/// A structure that modes cannot decouple keeps its degrees of freedom; a request for modes is an error.
#[test]
fn modes_are_refused_where_they_do_not_decouple() {
    struct Dashpot(FemModel);
    impl Structure for Dashpot {
        needed_from!(0);
        fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
            matrix.add_spring(0, 40, 1e4);
            Ok(())
        }
    }
    let insist = |builder: SimulationBuilder| {
        builder.interface(friction(0.4)).coordinates(Coordinates::Modes).build().err()
    };
    let refused = |error| matches!(error, Some(Error::Scene { quantity: "modal coordinates", .. }));
    assert!(refused(insist(scene(SI, 0.1).structure(Dashpot(tower(SI, None))))));
    assert!(refused(insist(scene(SI, 0.1).structure(Rider { block: block(SI) }))));
    assert!(insist(scene(SI, 0.1).structure(tower(SI, None))).is_none());
    let auto = scene(SI, 0.1).structure(Dashpot(tower(SI, None))).interface(friction(0.4));
    assert!(auto.expected_steps(1_000_000).build().is_ok());
}

/// A base that cannot lift has no normal rows, and modes none of other rows in their place.
#[test]
fn modes_know_a_base_that_cannot_lift() {
    struct Slider;
    impl Structure for Slider {
        fn dofs(&self) -> usize {
            2
        }
        fn base(&self) -> Base {
            let node = |x| BaseNode { x, horizontal: 0.into(), ..BaseNode::default() };
            [node(-2.0), node(2.0)].into()
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
    let run = |coordinates| {
        let builder = scene(SI, 0.6).gravity(0.0).structure(Slider).interface(Bonded);
        states(&mut builder.coordinates(coordinates).build().unwrap(), STEPS)
    };
    let (modes, dofs) = (run(Coordinates::Modes), run(Coordinates::Physical));
    let sway = apart(&modes, &dofs, |s| s.displacement().to_vec());
    let shear = apart(&modes, &dofs, |s| vec![s.base_shear]);
    assert!(sway < 1e-9 && shear < 1e-9, "{sway:e} {shear:e}");
    assert!(dofs.iter().any(|s| s.base_shear.abs() > 1e3));
}
