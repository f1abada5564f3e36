//! GOAL: axial forces from the weight, and their effect on statics, buckling loads and frequencies.
//! SCENE: cantilevers, portals and braced columns under their own weight and masses.
//! REFERENCE: Greenhill 1881, Euler, Kleinlogel, power series of 40 digits.

use basemat::Error;
use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Beam, Direction, Element, LumpedMass, MassKind, Mesh, Truss};
use basemat::interface::Coulomb;
use basemat::structure::StructureError;
use basemat::structure::{FemModel, RayleighDamping, Structure};
use basemat::{Simulation, Soil};
use basemat_problems::dense::{
    damping, eigenvalues, form, largest, mass, multiply, part, stiffness,
};

const E: f64 = 30.0e9;
const AREA: f64 = 0.4;
const INERTIA: f64 = 0.02;
const DENSITY: f64 = 2400.0;
const LENGTH: f64 = 8.0;
const BENDING: f64 = E * INERTIA;
/// Greenhill 1881: q L³/EI of the uniform cantilever that buckles under its own weight q per length.
const GREENHILL: f64 = 7.837_347_438_943_484;

/// Cantilever of so many beams on a rigid basemat 2 m wide, with a mass at its tip or none, and the
/// degrees of freedom above the basemat.
fn cantilever(elements: usize, density: f64, tip: f64) -> (FemModel, Vec<usize>) {
    let mut mesh = Mesh::new();
    for k in 0..=elements {
        mesh.add_node(0.0, LENGTH * k as f64 / elements as f64).unwrap();
    }
    for k in 0..elements {
        mesh.add(Beam::new([k, k + 1], E, AREA, INERTIA, density).unwrap()).unwrap();
    }
    if tip > 0.0 {
        mesh.add(LumpedMass::new(elements, tip).unwrap()).unwrap();
    }
    let ends = [-1.0, 1.0].map(|x| {
        let end = mesh.add_node(x, 0.0).unwrap();
        mesh.add(LumpedMass::new(end, 1.0).unwrap()).unwrap();
        end
    });
    let model = FemModel::new(mesh, &ends).unwrap().with_rigid_link(0, &ends).unwrap();
    let above = (3..model.dofs()).collect();
    (model, above)
}

fn compressions(model: &FemModel) -> Vec<f64> {
    model.mesh().elements().filter_map(basemat::fem::Element::compression).collect()
}

/// Lowest circular frequency squared with the degrees of freedom below `free` held.
fn lowest(model: &FemModel, free: &[usize]) -> f64 {
    eigenvalues(&part(&stiffness(model), free), &part(&mass(model), free))[0]
}

/// PROBLEM: Greenhill's column. RESULT: the axial force is the weight above the middle of each beam,
/// the buckling factor tends to the closed form from above with the fourth power of the beams' length,
/// and what stands below it and what does not is told apart.
#[test]
fn a_column_buckles_under_its_own_weight_as_greenhill_says() {
    let critical = GREENHILL * BENDING / LENGTH.powi(3) / (DENSITY * AREA);
    let errors = [4, 8, 16].map(|elements| {
        let (model, _) = cantilever(elements, DENSITY, 0.0);
        let model = model.with_p_delta(0.3 * critical).unwrap();
        for (k, found) in compressions(&model).into_iter().enumerate() {
            let above = (1.0 - (k as f64 + 0.5) / elements as f64) * LENGTH;
            let exact = DENSITY * AREA * 0.3 * critical * above;
            assert!((found / exact - 1.0).abs() < 1e-9, "{k}: {found} {exact}");
        }
        0.3 * model.buckling_factor().unwrap() - 1.0
    });
    println!("{errors:?}");
    assert!(errors[2] > 0.0 && errors[2] < 1e-6, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 16.0).abs() < 2.0, "{errors:?}");
    }
    for (factor, stands) in [(0.9999, true), (1.0001, false)] {
        let (model, _) = cantilever(16, DENSITY, 0.0);
        match model.with_p_delta(factor * critical) {
            Ok(_) => assert!(stands, "{factor}"),
            Err(Error::Structure(StructureError::Buckling { factor: found })) => {
                assert!(!stands && (found * factor - 1.0).abs() < 1e-5, "{factor} {found}");
            }
            Err(other) => panic!("{other}"),
        }
    }
}

/// PROBLEM: the same column's first frequency, of which w⁗ + q ((1−x) w′)′ = ω² w by its power series in
/// 40 digits gives ω² at 0, ¼, ½ and ¾ of Greenhill's weight: 1 − q/q_cr within 0.3 %.
#[test]
fn frequencies_of_a_heavy_column_drop_with_its_weight() {
    const EXACT: [f64; 4] = [
        12.362_363_368_326_19,
        9.281_520_763_530_467,
        6.194_481_561_640_118,
        3.100_805_439_912_750_6,
    ];
    let critical = GREENHILL * BENDING / LENGTH.powi(3) / (DENSITY * AREA);
    let unit = BENDING / (DENSITY * AREA * LENGTH.powi(4));
    for (quarters, exact) in EXACT.into_iter().enumerate() {
        let share = quarters as f64 / 4.0;
        let (model, above) = cantilever(20, DENSITY, 0.0);
        let found = lowest(&model.with_p_delta(share * critical).unwrap(), &above) / unit;
        assert!((found / exact - 1.0).abs() < 2e-6, "{share}: {found} {exact}");
        assert!((found / (EXACT[0] * (1.0 - share)) - 1.0).abs() < 5e-3, "{share}: {found}");
    }
}

/// PROBLEM: a mass on the tip of a light cantilever. RESULT: Euler's load π²EI/(4L²), and
/// ω² = P/(m (tan κL/κ − L)), κ² = P/EI, nearly 1 − P/P_cr.
#[test]
fn a_mass_on_a_cantilever_buckles_it_as_euler_says() {
    let euler = std::f64::consts::PI.powi(2) * BENDING / (4.0 * LENGTH * LENGTH);
    let tip = 1.0e5;
    let gravity = |share: f64| share * euler / tip;
    for share in [0.1, 0.5, 0.9] {
        let (model, above) = cantilever(8, 0.0, tip);
        let model = model.with_p_delta(gravity(share)).unwrap();
        let factor = model.buckling_factor().unwrap();
        assert!((factor * share - 1.0).abs() < 1e-5, "{factor} {share}");
        // Statical condensation: the tip's flexibility.
        let free = part(&stiffness(&model), &above);
        let at = model.dof(8, Direction::X).unwrap() - above[0];
        let mut load = vec![0.0; free.len()];
        load[at] = 1.0;
        let found = 1.0 / basemat_problems::dense::solve(&free, &load)[at] / tip;
        let (force, k) = (share * euler, (share * euler / BENDING).sqrt());
        let exact = force / (tip * ((k * LENGTH).tan() / k - LENGTH));
        assert!((found / exact - 1.0).abs() < 1e-5 / (1.0 - share), "{share}: {found} {exact}");
        let straight = 3.0 * BENDING / (tip * LENGTH.powi(3)) * (1.0 - share);
        assert!((found / straight - 1.0).abs() < 0.02, "{share}: {found} {straight}");
    }
    let (model, _) = cantilever(8, 0.0, tip);
    let fallen = model.with_p_delta(gravity(1.25));
    assert!(
        matches!(fallen, Err(Error::Structure(StructureError::Buckling { factor })) if (factor - 0.8).abs() < 1e-5)
    );
}

const SPAN: f64 = 6.0;
const HEIGHT: f64 = 4.0;

/// Portal on hinged feet, each member of four beams, with a mass (kg) at a quarter of its girder. The
/// area is such that members hardly shorten.
fn portal(load: f64, change: impl Fn(usize, Beam) -> Beam) -> FemModel {
    let mut mesh = Mesh::new();
    let mut path: Vec<[f64; 2]> = (0..=4).map(|k| [0.0, HEIGHT * f64::from(k) / 4.0]).collect();
    path.extend((1..=4).map(|k| [SPAN * f64::from(k) / 4.0, HEIGHT]));
    path.extend((1..=4).map(|k| [SPAN, HEIGHT * f64::from(4 - k) / 4.0]));
    for [x, y] in path {
        mesh.add_node(x, y).unwrap();
    }
    for k in 0..12 {
        let beam = Beam::new([k, k + 1], E, 4.0e4, INERTIA, 0.02).unwrap();
        mesh.add(change(k, beam)).unwrap();
    }
    mesh.add(LumpedMass::new(5, load).unwrap()).unwrap();
    FemModel::new(mesh, &[0, 12]).unwrap()
}

/// PROBLEM: portal with hinged feet, weight w per length everywhere and W at a quarter of the girder.
/// RESULT: columns by statics; thrust in the girder w l²/(4 h (2k+3)) + 3 W a b/(2 h l (2k+3)), with
/// k = h/l for equal sections (Kleinlogel, Rahmenformeln).
#[test]
fn axial_forces_of_a_portal_are_those_of_statics() {
    let gravity = 10.0;
    let load = 5.0e3;
    let model = portal(load, |_, beam| beam).with_p_delta(gravity).unwrap();
    let found = compressions(&model);
    let (w, weight) = (4.0e4 * 0.02 * gravity, load * gravity);
    let quarter = HEIGHT / 4.0;
    for k in 0..4 {
        let column = w * (HEIGHT - (k as f64 + 0.5) * quarter);
        let left = column + 0.5 * w * SPAN + 0.75 * weight;
        let right = column + 0.5 * w * SPAN + 0.25 * weight;
        assert!((found[k] / left - 1.0).abs() < 1e-6, "{k}: {} {left}", found[k]);
        assert!((found[11 - k] / right - 1.0).abs() < 1e-6, "{k}: {} {right}", found[11 - k]);
    }
    let (k, a, b) = (HEIGHT / SPAN, 0.25 * SPAN, 0.75 * SPAN);
    let thrust = w * SPAN * SPAN / (4.0 * HEIGHT * (2.0 * k + 3.0))
        + 3.0 * weight * a * b / (2.0 * HEIGHT * SPAN * (2.0 * k + 3.0));
    for (place, girder) in found[4..8].iter().enumerate() {
        assert!((girder / thrust - 1.0).abs() < 1e-5, "{place}: {girder} {thrust}");
    }
    // Found anew, not added up; with no weight there is none.
    let heavier = model.with_p_delta(2.0 * gravity).unwrap();
    for (a, b) in compressions(&heavier).iter().zip(&found) {
        assert!((a / b - 2.0).abs() < 1e-12);
    }
    let without = heavier.with_p_delta(0.0).unwrap();
    assert!(compressions(&without).iter().all(|force| *force == 0.0));
    assert_eq!(stiffness(&without), stiffness(&portal(load, |_, beam| beam)));
    assert_eq!(without.buckling_factor(), Ok(f64::INFINITY));
}

#[test]
fn forces_given_by_hand_stay() {
    let by_hand = |k: usize, beam: Beam| match k {
        0 => beam.with_compression(123.0).unwrap(),
        11 => beam.with_compression(0.0).unwrap(),
        _ => beam,
    };
    let found = compressions(&portal(5.0e3, by_hand).with_p_delta(10.0).unwrap());
    let all = compressions(&portal(5.0e3, |_, beam| beam).with_p_delta(10.0).unwrap());
    assert_eq!((found[0], found[11]), (123.0, 0.0));
    assert_eq!(found[1..11], all[1..11]);
    // Too much by hand is found as well.
    let heavy = |_, beam: Beam| beam.with_compression(1.0e10).unwrap();
    let model = portal(5.0e3, heavy);
    let share = model.buckling_factor().unwrap();
    assert!(share > 0.0 && share < 1.0, "{share}");
    assert_eq!(
        model.with_p_delta(0.0).unwrap_err(),
        Error::Structure(StructureError::Buckling { factor: share })
    );
}

/// A translation meets no force and no damping; a turn ψ the moment −Σ W y ψ of the weights, but no damping.
///
/// With the thrust of the portal as a dead load of the ground it would be −Σ P L ψ, 10 % more.
#[test]
fn p_delta_overturns_but_does_not_hold() {
    let model = portal(5.0e3, |_, beam| beam).with_p_delta(10.0).unwrap();
    let model = model.with_rayleigh(RayleighDamping::from_ratios([1.0, 5.0], [0.05; 2]).unwrap());
    let matrix = stiffness(&model);
    let stiffest = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
    for direction in [Direction::X, Direction::Y] {
        let shift = model.rigid_motion(direction, [0.0; 3]);
        assert!(largest(&multiply(&matrix, &shift)) < 1e-14 * stiffest);
    }
    let turn = model.rigid_motion(Direction::Rotation, [0.0; 3]);
    let moment = form(&turn, &matrix, &turn);
    let (w, weight) = (4.0e4 * 0.02 * 10.0, 5.0e3 * 10.0);
    let exact = -(2.0 * w * HEIGHT * 0.5 * HEIGHT + (w * SPAN + weight) * HEIGHT);
    assert!((moment / exact - 1.0).abs() < 1e-4, "{moment} {exact}");
    // Each weight acts on its node, and the base on the ground.
    let mut force = multiply(&matrix, &turn);
    let mass = mass(&model);
    let right = model.rigid_motion(Direction::X, [0.0; 3]);
    for (force, inertia) in force.iter_mut().zip(multiply(&mass, &right)) {
        *force -= 10.0 * inertia;
    }
    for node in 1..12 {
        let dof = model.dof(node, Direction::X).unwrap();
        assert!(force[dof].abs() < 1e-4 * weight, "{node} {}", force[dof]);
    }
    let undamped = portal(5.0e3, |_, beam| beam)
        .with_rayleigh(RayleighDamping::from_ratios([1.0, 5.0], [0.05; 2]).unwrap());
    assert_eq!(damping(&model), damping(&undamped));
    // Nothing is held: it marches, and leans by its own weight where the ground is soft.
    let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
    let built = Simulation::builder(0.01)
        .structure(model)
        .ground(ElasticGround::new(soil, Strip::uniform(0.0..SPAN, 6).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .gravity(10.0)
        .build();
    assert!(built.is_ok(), "{:?}", built.err());
}

/// Rigid links change the way of the forces: they are found anew, in whichever order.
#[test]
fn links_after_p_delta_find_the_forces_anew() {
    let after = portal(5.0e3, |_, beam| beam).with_p_delta(10.0).unwrap();
    let before = portal(5.0e3, |_, beam| beam).with_rigid_link(6, &[4, 5, 7, 8]).unwrap();
    let after = after.with_rigid_link(6, &[4, 5, 7, 8]).unwrap();
    let before = before.with_p_delta(10.0).unwrap();
    assert_eq!(compressions(&after), compressions(&before));
    assert_eq!(stiffness(&after), stiffness(&before));
}

/// PROBLEM: a hinged column with a mass on its top, leaning on a weightless diagonal of stiffness k_b at
/// 45°. RESULT: the diagonal carries nothing, and it buckles at P/h = ½ k_b k_c/(½ k_b + k_c).
#[test]
fn a_leaning_column_needs_its_brace() {
    let (height, load) = (3.0, 1.0e4);
    let [column, brace] = [2.0e8, 1.0e7];
    let leaning = || {
        let mut mesh = Mesh::new();
        let [foot, top, other] =
            [[0.0, 0.0], [0.0, height], [height, 0.0]].map(|[x, y]| mesh.add_node(x, y).unwrap());
        mesh.add(Truss::new([foot, top], column, 1.0, 0.0).unwrap()).unwrap();
        mesh.add(Truss::new([top, other], brace, 1.0, 0.0).unwrap()).unwrap();
        mesh.add(LumpedMass::new(top, load).unwrap()).unwrap();
        FemModel::new(mesh, &[foot, other]).unwrap()
    };
    let [kc, kb] = [column / height, 0.5 * brace / (height * 2.0_f64.sqrt())];
    let critical = height * kb * kc / (kb + kc);
    let model = leaning().with_p_delta(10.0).unwrap();
    let found = compressions(&model);
    assert!((found[0] / (load * 10.0) - 1.0).abs() < 1e-12 && found[1].abs() < 1e-9 * found[0]);
    let factor = model.buckling_factor().unwrap();
    assert!((factor * found[0] / critical - 1.0).abs() < 1e-8, "{factor}");
    let fallen = leaning().with_p_delta(1.01 * critical / load);
    assert!(matches!(fallen, Err(Error::Structure(StructureError::Buckling { .. }))));
}

#[test]
fn what_has_no_p_delta_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, -9.81] {
        assert!(matches!(
            portal(1.0, |_, b| b).with_p_delta(bad),
            Err(Error::Input { quantity: "acceleration of gravity", .. })
        ));
    }
    // A column hinged on the ground, beside a foot of its own: a mechanism.
    let mut mesh = Mesh::new();
    let [foot, top, other] =
        [[0.0, 0.0], [0.0, 3.0], [1.0, 0.0]].map(|[x, y]| mesh.add_node(x, y).unwrap());
    mesh.add(Beam::new([foot, top], E, AREA, INERTIA, DENSITY).unwrap()).unwrap();
    mesh.add(LumpedMass::new(other, 1.0).unwrap()).unwrap();
    let model = FemModel::new(mesh, &[foot, other]).unwrap();
    let refused = model.with_p_delta(9.81);
    assert!(
        matches!(
            refused,
            Err(Error::Singular { .. } | Error::Structure(StructureError::Buckling { .. }))
        ),
        "{:?}",
        refused.err()
    );
}

/// A rod that takes the static state as a reason to go elsewhere.
struct Deserter {
    nodes: [usize; 2],
    directions: &'static [Direction],
}

impl Element for Deserter {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }
    fn directions(&self) -> &[Direction] {
        self.directions
    }
    fn stiffness(&self, _: &[[f64; 3]], _: &mut [f64]) {}
    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
    fn in_static_state(&self, _: &[[f64; 3]], _: &[f64], _: f64) -> Option<Box<dyn Element>> {
        let elsewhere = if self.nodes[1] == 1 { [0, 999] } else { self.nodes };
        Some(Box::new(Self { nodes: elsewhere, directions: &[Direction::Y] }))
    }
}

#[test]
fn elements_stay_where_they_are_in_the_static_state() {
    for (ends, directions) in [([0, 1], &[Direction::Y][..]), ([1, 2], &[Direction::X][..])] {
        let mut mesh = Mesh::new();
        let nodes = [[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]];
        for [x, y] in nodes {
            mesh.add_node(x, y).unwrap();
        }
        mesh.add(Beam::new([0, 1], 1e9, 0.1, 1e-2, 100.0).unwrap()).unwrap();
        mesh.add(Beam::new([0, 2], 1e9, 0.1, 1e-2, 100.0).unwrap()).unwrap();
        mesh.add(Deserter { nodes: ends, directions }).unwrap();
        let fault = FemModel::on_base(mesh).unwrap().with_p_delta(9.81).unwrap_err();
        assert!(matches!(fault, Error::Scene { quantity, .. } if quantity.contains("static")));
    }
}
