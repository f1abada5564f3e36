//! GOAL: axial forces from the weight, and their effect on statics, buckling loads and frequencies.
//! SCENE: cantilevers, portals and braced columns under their weight and masses.
//! REFERENCE: Greenhill 1881, Euler, Kleinlogel, power series of 40 digits.

use basemat::Error;
use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Beam, Direction, Element, LumpedMass, MassKind, Mesh, Truss};
use basemat::interface::Coulomb;
use basemat::structure::StructureError;
use basemat::structure::{FemModel, RayleighDamping, Structure};
use basemat::{Simulation, Soil};
use basemat_problems::dense::{
    damping, eigenvalues, form, largest, mass, multiply, stiffness, submatrix,
};

const YOUNG_MODULUS: f64 = 30.0e9;
const SECTION_AREA: f64 = 0.4;
const SECOND_MOMENT: f64 = 0.02;
const MASS_DENSITY: f64 = 2400.0;
const COLUMN_LENGTH: f64 = 8.0;
const BENDING_STIFFNESS: f64 = YOUNG_MODULUS * SECOND_MOMENT;
/// Greenhill 1881: q L³/EI of the uniform cantilever that buckles under its weight q per length.
const GREENHILL_FACTOR: f64 = 7.837_347_438_943_484;

/// A column and its degrees of freedom above the basemat.
struct CantileverColumn {
    model: FemModel,
    free: Vec<usize>,
}

/// A cantilever column of `elements` beams on a rigid basemat 2 m wide, with a mass at its tip or none.
fn cantilever(elements: usize, density: f64, tip: f64) -> CantileverColumn {
    let mut mesh = Mesh::new();
    for k in 0..=elements {
        mesh.add_node(0.0, COLUMN_LENGTH * k as f64 / elements as f64).unwrap();
    }
    for k in 0..elements {
        mesh.add(
            Beam::new([k, k + 1], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, density).unwrap(),
        )
        .unwrap();
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
    let free = (3..model.dofs()).collect();
    CantileverColumn { model, free }
}

fn compressions(model: &FemModel) -> Vec<f64> {
    model.mesh().elements().filter_map(basemat::fem::Element::compression).collect()
}

/// Lowest circular frequency squared with the degrees of freedom below `free` fixed.
fn lowest(model: &FemModel, free: &[usize]) -> f64 {
    eigenvalues(&submatrix(&stiffness(model), free), &submatrix(&mass(model), free))[0]
}

/// PROBLEM: Greenhill's column. RESULT: the axial force is the weight above the middle of each beam,
/// the buckling factor tends to the closed form from above with the fourth power of the beams' length,
/// above the closed form the column is an error.
#[test]
fn a_column_buckles_under_its_weight_as_greenhill_says() {
    let critical = GREENHILL_FACTOR * BENDING_STIFFNESS
        / COLUMN_LENGTH.powi(3)
        / (MASS_DENSITY * SECTION_AREA);
    let errors = [4, 8, 16].map(|elements| {
        let model = cantilever(elements, MASS_DENSITY, 0.0).model;
        let model = model.with_p_delta(0.3 * critical).unwrap();
        for (k, found) in compressions(&model).into_iter().enumerate() {
            let above = (1.0 - (k as f64 + 0.5) / elements as f64) * COLUMN_LENGTH;
            let expected = MASS_DENSITY * SECTION_AREA * 0.3 * critical * above;
            assert!((found / expected - 1.0).abs() < 1e-9, "{k}: {found} {expected}");
        }
        0.3 * model.buckling_factor().unwrap() - 1.0
    });
    println!("{errors:?}");
    assert!(errors[2] > 0.0 && errors[2] < 1e-6, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 16.0).abs() < 2.0, "{errors:?}");
    }
    for (factor, stands) in [(0.9999, true), (1.0001, false)] {
        let model = cantilever(16, MASS_DENSITY, 0.0).model;
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
    const EXACT_SQUARES: [f64; 4] = [
        12.362_363_368_326_19,
        9.281_520_763_530_467,
        6.194_481_561_640_118,
        3.100_805_439_912_750_6,
    ];
    let critical = GREENHILL_FACTOR * BENDING_STIFFNESS
        / COLUMN_LENGTH.powi(3)
        / (MASS_DENSITY * SECTION_AREA);
    let unit = BENDING_STIFFNESS / (MASS_DENSITY * SECTION_AREA * COLUMN_LENGTH.powi(4));
    for (quarters, exact) in EXACT_SQUARES.into_iter().enumerate() {
        let weight_ratio = quarters as f64 / 4.0;
        let CantileverColumn { model, free } = cantilever(20, MASS_DENSITY, 0.0);
        let loaded_model = model.with_p_delta(weight_ratio * critical).unwrap();
        let computed = lowest(&loaded_model, &free) / unit;
        assert!((computed / exact - 1.0).abs() < 2e-6, "{weight_ratio}: {computed} {exact}");
        let linear_square = EXACT_SQUARES[0] * (1.0 - weight_ratio);
        assert!((computed / linear_square - 1.0).abs() < 5e-3, "{weight_ratio}: {computed}");
    }
}

/// PROBLEM: a mass on the tip of a light cantilever. RESULT: Euler's load π²EI/(4L²), and
/// ω² = P/(m (tan κL/κ − L)), κ² = P/EI, nearly 1 − P/P_cr.
#[test]
fn a_mass_on_a_cantilever_buckles_it_as_euler_says() {
    let euler =
        std::f64::consts::PI.powi(2) * BENDING_STIFFNESS / (4.0 * COLUMN_LENGTH * COLUMN_LENGTH);
    let tip = 1.0e5;
    for ratio in [0.1, 0.5, 0.9] {
        let CantileverColumn { model, free } = cantilever(8, 0.0, tip);
        let model = model.with_p_delta(ratio * euler / tip).unwrap();
        let factor = model.buckling_factor().unwrap();
        assert!((factor * ratio - 1.0).abs() < 1e-5, "{factor} {ratio}");
        // Static condensation: the tip's flexibility.
        let free_stiffness = submatrix(&stiffness(&model), &free);
        let at = model.dof(8, Direction::X).unwrap() - free[0];
        let mut load = vec![0.0; free_stiffness.len()];
        load[at] = 1.0;
        let flexibility = basemat_problems::dense::solve(&free_stiffness, &load)[at];
        let computed = 1.0 / flexibility / tip;
        let force = ratio * euler;
        let k = (ratio * euler / BENDING_STIFFNESS).sqrt();
        let expected = force / (tip * ((k * COLUMN_LENGTH).tan() / k - COLUMN_LENGTH));
        let tolerance = 1e-5 / (1.0 - ratio);
        assert!((computed / expected - 1.0).abs() < tolerance, "{ratio}: {computed} {expected}");
        let linear_value = 3.0 * BENDING_STIFFNESS / (tip * COLUMN_LENGTH.powi(3)) * (1.0 - ratio);
        assert!((computed / linear_value - 1.0).abs() < 0.02, "{ratio}: {computed} {linear_value}");
    }
    let model = cantilever(8, 0.0, tip).model;
    let buckled_result = model.with_p_delta(1.25 * euler / tip);
    assert!(
        matches!(buckled_result, Err(Error::Structure(StructureError::Buckling { factor })) if (factor - 0.8).abs() < 1e-5)
    );
}

const PORTAL_SPAN: f64 = 6.0;
const PORTAL_HEIGHT: f64 = 4.0;

/// Portal on hinged feet, each member of four beams, with a mass (kg) at a quarter of its girder. The
/// area is such that members hardly shorten.
fn portal(load: f64, change: impl Fn(usize, Beam) -> Beam) -> FemModel {
    let mut mesh = Mesh::new();
    let mut path: Vec<[f64; 2]> =
        (0..=4).map(|k| [0.0, PORTAL_HEIGHT * f64::from(k) / 4.0]).collect();
    path.extend((1..=4).map(|k| [PORTAL_SPAN * f64::from(k) / 4.0, PORTAL_HEIGHT]));
    path.extend((1..=4).map(|k| [PORTAL_SPAN, PORTAL_HEIGHT * f64::from(4 - k) / 4.0]));
    for [x, y] in path {
        mesh.add_node(x, y).unwrap();
    }
    for k in 0..12 {
        let beam = Beam::new([k, k + 1], YOUNG_MODULUS, 4.0e4, SECOND_MOMENT, 0.02).unwrap();
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
    let computed = compressions(&model);
    let w = 4.0e4 * 0.02 * gravity;
    let weight = load * gravity;
    let quarter = PORTAL_HEIGHT / 4.0;
    for k in 0..4 {
        let column = w * (PORTAL_HEIGHT - (k as f64 + 0.5) * quarter);
        let left = column + 0.5 * w * PORTAL_SPAN + 0.75 * weight;
        let right = column + 0.5 * w * PORTAL_SPAN + 0.25 * weight;
        assert!((computed[k] / left - 1.0).abs() < 1e-6, "{k}: {} {left}", computed[k]);
        assert!((computed[11 - k] / right - 1.0).abs() < 1e-6, "{k}: {} {right}", computed[11 - k]);
    }
    let k = PORTAL_HEIGHT / PORTAL_SPAN;
    let a = 0.25 * PORTAL_SPAN;
    let b = 0.75 * PORTAL_SPAN;
    let thrust = w * PORTAL_SPAN * PORTAL_SPAN / (4.0 * PORTAL_HEIGHT * (2.0 * k + 3.0))
        + 3.0 * weight * a * b / (2.0 * PORTAL_HEIGHT * PORTAL_SPAN * (2.0 * k + 3.0));
    for (place, girder) in computed[4..8].iter().enumerate() {
        assert!((girder / thrust - 1.0).abs() < 1e-5, "{place}: {girder} {thrust}");
    }
    // Forces are computed anew and do not add up; without weight there are none.
    let heavier_model = model.with_p_delta(2.0 * gravity).unwrap();
    for (a, b) in compressions(&heavier_model).iter().zip(&computed) {
        assert!((a / b - 2.0).abs() < 1e-12);
    }
    let model_without_p_delta = heavier_model.with_p_delta(0.0).unwrap();
    assert!(compressions(&model_without_p_delta).iter().all(|force| *force == 0.0));
    assert_eq!(stiffness(&model_without_p_delta), stiffness(&portal(load, |_, beam| beam)));
    assert_eq!(model_without_p_delta.buckling_factor(), Ok(f64::INFINITY));
}

/// Beams of the portal; the feet have compressions that a user prescribes.
fn with_given_feet(k: usize, beam: Beam) -> Beam {
    match k {
        0 => beam.with_compression(123.0).unwrap(),
        11 => beam.with_compression(0.0).unwrap(),
        _ => beam,
    }
}

#[test]
fn forces_given_by_hand_stay() {
    let computed = compressions(&portal(5.0e3, with_given_feet).with_p_delta(10.0).unwrap());
    let all_forces = compressions(&portal(5.0e3, |_, beam| beam).with_p_delta(10.0).unwrap());
    assert_eq!((computed[0], computed[11]), (123.0, 0.0));
    assert_eq!(computed[1..11], all_forces[1..11]);
    // Compressions beyond the buckling load that a user prescribes are errors as well.
    let model = portal(5.0e3, |_, beam| beam.with_compression(1.0e10).unwrap());
    let factor = model.buckling_factor().unwrap();
    assert!(factor > 0.0 && factor < 1.0, "{factor}");
    assert_eq!(
        model.with_p_delta(0.0).unwrap_err(),
        Error::Structure(StructureError::Buckling { factor })
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
    let max_stiffness = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
    for direction in [Direction::X, Direction::Y] {
        let shift = model.rigid_motion(direction, [0.0; 3]);
        assert!(largest(&multiply(&matrix, &shift)) < 1e-14 * max_stiffness);
    }
    let turn = model.rigid_motion(Direction::Rotation, [0.0; 3]);
    let moment = form(&turn, &matrix, &turn);
    let w = 4.0e4 * 0.02 * 10.0;
    let weight = 5.0e3 * 10.0;
    let expected = -(2.0 * w * PORTAL_HEIGHT * 0.5 * PORTAL_HEIGHT
        + (w * PORTAL_SPAN + weight) * PORTAL_HEIGHT);
    assert!((moment / expected - 1.0).abs() < 1e-4, "{moment} {expected}");
    // The force on each node above the base is that of its weight.
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
    let linear_model = portal(5.0e3, |_, beam| beam)
        .with_rayleigh(RayleighDamping::from_ratios([1.0, 5.0], [0.05; 2]).unwrap());
    assert_eq!(damping(&model), damping(&linear_model));
    // A simulation of the frame on soft ground, in which no node is fixed, can be built.
    let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
    let result = Simulation::builder(0.01)
        .structure(model)
        .ground(ElasticGround::new(soil, Strip::uniform(0.0..PORTAL_SPAN, 6).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .gravity(10.0)
        .build();
    assert!(result.is_ok(), "{:?}", result.err());
}

/// Rigid links change the path of the forces, which are computed anew in either order of the calls.
#[test]
fn links_after_p_delta_find_the_forces_anew() {
    let after = portal(5.0e3, |_, beam| beam).with_p_delta(10.0).unwrap();
    let before = portal(5.0e3, |_, beam| beam).with_rigid_link(6, &[4, 5, 7, 8]).unwrap();
    let after = after.with_rigid_link(6, &[4, 5, 7, 8]).unwrap();
    let before = before.with_p_delta(10.0).unwrap();
    assert_eq!(compressions(&after), compressions(&before));
    assert_eq!(stiffness(&after), stiffness(&before));
}

const BRACED_HEIGHT: f64 = 3.0;
const COLUMN_STIFFNESS: f64 = 2.0e8;
const BRACE_STIFFNESS: f64 = 1.0e7;

/// A hinged column with a mass on its top and a diagonal.
fn braced_column(load: f64) -> FemModel {
    let mut mesh = Mesh::new();
    let places = [[0.0, 0.0], [0.0, BRACED_HEIGHT], [BRACED_HEIGHT, 0.0]];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    mesh.add(Truss::new([nodes[0], nodes[1]], COLUMN_STIFFNESS, 1.0, 0.0).unwrap())
        .unwrap();
    mesh.add(Truss::new([nodes[1], nodes[2]], BRACE_STIFFNESS, 1.0, 0.0).unwrap())
        .unwrap();
    mesh.add(LumpedMass::new(nodes[1], load).unwrap()).unwrap();
    FemModel::new(mesh, &[nodes[0], nodes[2]]).unwrap()
}

/// PROBLEM: a hinged column with a mass on its top, leaning on a weightless diagonal of stiffness k_b at
/// 45°. RESULT: the diagonal carries nothing, and it buckles at P/h = ½ k_b k_c/(½ k_b + k_c).
#[test]
fn a_leaning_column_needs_its_brace() {
    let load = 1.0e4;
    let kc = COLUMN_STIFFNESS / BRACED_HEIGHT;
    let kb = 0.5 * BRACE_STIFFNESS / (BRACED_HEIGHT * 2.0_f64.sqrt());
    let critical = BRACED_HEIGHT * kb * kc / (kb + kc);
    let model = braced_column(load).with_p_delta(10.0).unwrap();
    let computed = compressions(&model);
    assert!(
        (computed[0] / (load * 10.0) - 1.0).abs() < 1e-12 && computed[1].abs() < 1e-9 * computed[0]
    );
    let factor = model.buckling_factor().unwrap();
    assert!((factor * computed[0] / critical - 1.0).abs() < 1e-8, "{factor}");
    let buckled_result = braced_column(load).with_p_delta(1.01 * critical / load);
    assert!(matches!(buckled_result, Err(Error::Structure(StructureError::Buckling { .. }))));
}

#[test]
fn what_has_no_p_delta_is_an_error() {
    for invalid_value in [f64::NAN, f64::INFINITY, -9.81] {
        assert!(matches!(
            portal(1.0, |_, b| b).with_p_delta(invalid_value),
            Err(Error::Input { quantity: "acceleration of gravity", .. })
        ));
    }
    // A column hinged on the ground, beside a separate foot: a mechanism.
    let mut mesh = Mesh::new();
    let nodes = [[0.0, 0.0], [0.0, 3.0], [1.0, 0.0]].map(|[x, y]| mesh.add_node(x, y).unwrap());
    let column =
        Beam::new([nodes[0], nodes[1]], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY);
    mesh.add(column.unwrap()).unwrap();
    mesh.add(LumpedMass::new(nodes[2], 1.0).unwrap()).unwrap();
    let model = FemModel::new(mesh, &[nodes[0], nodes[2]]).unwrap();
    let result = model.with_p_delta(9.81);
    assert!(
        matches!(
            result,
            Err(Error::Singular { .. } | Error::Structure(StructureError::Buckling { .. }))
        ),
        "{:?}",
        result.err()
    );
}

/// A rod whose nodes change in the static state.
struct MovingRod {
    nodes: [usize; 2],
    directions: &'static [Direction],
}

impl Element for MovingRod {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }
    fn directions(&self) -> &[Direction] {
        self.directions
    }
    fn stiffness(&self, _: &[[f64; 3]], _: &mut [f64]) {}
    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
    fn in_static_state(&self, _: &[[f64; 3]], _: &[f64], _: f64) -> Option<Box<dyn Element>> {
        let moved_nodes = if self.nodes[1] == 1 { [0, 999] } else { self.nodes };
        Some(Box::new(Self { nodes: moved_nodes, directions: &[Direction::Y] }))
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
        mesh.add(MovingRod { nodes: ends, directions }).unwrap();
        let fault = FemModel::on_base(mesh).unwrap().with_p_delta(9.81).unwrap_err();
        assert!(matches!(fault, Error::Scene { quantity, .. } if quantity.contains("static")));
    }
}
