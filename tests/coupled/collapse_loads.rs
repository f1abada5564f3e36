//! GOAL: static push-over by displacement: collapse loads of frames of fibres, cycles, uplift and slip.
//! SCENE: cantilever, propped beam and portal on bonded footings, steel without hardening; columns that may lift off.
//! REFERENCE: plastic hinges in closed form; the push-over by forces; elastic unloading.

use basemat::analyses::{PushControl, PushOver, push_over, push_over_by_displacement};
use basemat::bem::SpringGround;
use basemat::coupled::{Load, SimulationBuilder};
use basemat::fem::{
    Beam, BeamFormulation, BeamQuadrature, BilinearSteel, Direction, FiberBeam, FiberSection,
    LumpedMass, Mesh, Truss,
};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{DofCombination, FemModel, RigidBlock};
use basemat::{Error, Result, Simulation};

const ALL_FORMULATIONS: [BeamFormulation; 2] =
    [BeamFormulation::DisplacementBased, BeamFormulation::ForceBased];
const YIELD_STRESS: f64 = 400.0e6;
const SECTION_DEPTH: f64 = 0.2;
const SECTION_WIDTH: f64 = 0.1;
/// Plastic moment of 40 layers of fibres, N m: f_y A |y| of each.
const PLASTIC_MOMENT: f64 = YIELD_STRESS * SECTION_WIDTH * SECTION_DEPTH * SECTION_DEPTH / 4.0;
const HARDENING_RATIO: f64 = 1e-9;
/// Largest difference of a collapse load from its closed form.
const LOAD_TOLERANCE: f64 = 1e-3;

fn section() -> FiberSection {
    let steel = BilinearSteel::new(YIELD_STRESS, 210.0e9, HARDENING_RATIO).unwrap();
    FiberSection::new()
        .with_rectangle(
            [
                [-0.5 * SECTION_DEPTH, -0.5 * SECTION_WIDTH],
                [0.5 * SECTION_DEPTH, 0.5 * SECTION_WIDTH],
            ],
            [40, 1],
            steel,
        )
        .unwrap()
}

/// A model under construction.
struct Frame {
    mesh: Mesh,
    lines: Vec<Vec<usize>>,
    section: FiberSection,
    formulation: BeamFormulation,
    /// Ends of the first elements of a member by displacements, m.
    distances: [f64; 6],
}

impl Frame {
    fn new(formulation: BeamFormulation) -> Self {
        Self {
            mesh: Mesh::new(),
            lines: Vec::new(),
            section: section(),
            formulation,
            distances: [0.004, 0.012, 0.03, 0.1, 0.3, 1.0],
        }
    }

    /// Adds a footing 2 m wide; returns its middle.
    fn add_footing(&mut self, x: f64) -> Result<usize> {
        let mut nodes = Vec::new();
        for distance in [-1.0, 0.0, 1.0] {
            nodes.push(self.mesh.add_node(x + distance, 0.0)?);
        }
        let foot = nodes[1];
        for ends in nodes.windows(2) {
            self.mesh.add(Beam::new([ends[0], ends[1]], 30.0e9, 1.0, 0.1, 2500.0)?)?;
        }
        self.lines.push(nodes);
        Ok(foot)
    }

    fn add_node(&mut self, x: f64, y: f64) -> Result<usize> {
        let node = self.mesh.add_node(x, y)?;
        self.mesh.add(LumpedMass::new(node, 1.0e3)?)?;
        Ok(node)
    }

    /// Adds a member of fibres; by displacements it is divided where hinges form.
    fn add_member(&mut self, [start, end]: [usize; 2]) -> Result<()> {
        let [a, b] = [start, end].map(|node| self.mesh.nodes()[node]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut stations = vec![0.0, 1.0];
        if self.formulation == BeamFormulation::DisplacementBased {
            for distance in self.distances {
                stations.extend([distance / length, 1.0 - distance / length]);
            }
        }
        stations.sort_by(f64::total_cmp);
        let mut previous_node = start;
        for &s in &stations[1..] {
            let next_node = if s == 1.0 {
                end
            } else {
                self.mesh.add_node(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]))?
            };
            let beam = FiberBeam::new(
                [previous_node, next_node],
                &self.section,
                BeamQuadrature::Lobatto(5),
                100.0,
            )?;
            self.mesh.add(beam.with_formulation(self.formulation))?;
            previous_node = next_node;
        }
        Ok(())
    }

    fn model(self) -> Result<FemModel> {
        FemModel::on_foundations(self.mesh, &self.lines)
    }
}

/// The model bonded to stiff springs, without weight.
fn bonded(model: FemModel) -> Result<SimulationBuilder> {
    let ground = SpringGround::under(&model, 4, 1.0e10, 1.0e10)?;
    Ok(Simulation::builder(0.01)
        .ground(ground)
        .structure(model)
        .interface(Bonded)
        .gravity(0.0))
}

/// Pushes to displacements of one degree of freedom, along its pattern.
fn pushed(builder: SimulationBuilder, pattern: &DofCombination, displacements: &[f64]) -> PushOver {
    let curve = push_over_by_displacement(builder, pattern, pattern, displacements).unwrap();
    assert!(curve.cause.is_none(), "{:?} after {} points", curve.cause, curve.points.len());
    assert_eq!(curve.points.len(), displacements.len() + 1);
    for (point, target) in curve.points[1..].iter().zip(displacements) {
        assert!((point.displacement - target).abs() < 1e-9 * target.abs().max(1e-3), "{point:?}");
    }
    curve
}

/// Plastic moment of the section beside an axial force: M_p (1 − (N/N_p)²) of a rectangle.
fn moment_beside(axial_force: f64) -> f64 {
    let axial_strength = YIELD_STRESS * SECTION_WIDTH * SECTION_DEPTH;
    PLASTIC_MOMENT * (1.0 - (axial_force / axial_strength).powi(2))
}

/// Checks that a curve ends at a collapse load.
fn check_collapse(name: &str, curve: &PushOver, expected: f64) {
    let force = curve.points[curve.points.len() - 1].force;
    println!("{name}: {:.2e}", force / expected - 1.0);
    assert!((force / expected - 1.0).abs() < LOAD_TOLERANCE, "{name}: {force} {expected}");
}

fn cantilever(formulation: BeamFormulation) -> Result<(FemModel, DofCombination)> {
    let mut frame = Frame::new(formulation);
    let foot = frame.add_footing(0.0)?;
    let top = frame.add_node(0.0, 3.0)?;
    frame.add_member([foot, top])?;
    let model = frame.model()?;
    let row = model.row(top, Direction::X)?;
    Ok((model, row))
}

/// The collapse load is M_p/L; unloading is elastic, and the opposite collapse load has the same size.
#[test]
fn a_cantilever_collapses_at_its_plastic_moment() {
    for formulation in ALL_FORMULATIONS {
        let (model, row) = cantilever(formulation).unwrap();
        let displacements = [0.01, 0.02, 0.05, 0.1, 0.3, 0.299, 0.1, 0.0, -0.3];
        let curve = pushed(bonded(model).unwrap(), &row, &displacements);
        let expected = PLASTIC_MOMENT / 3.0;
        let points = &curve.points;
        check_collapse(&format!("cantilever, {formulation:?}"), &curve, -expected);
        assert!((points[5].force / expected - 1.0).abs() < LOAD_TOLERANCE, "{points:?}");
        let stiffness = points[1].force / points[1].displacement;
        let unloading = (points[5].force - points[6].force) / 0.001;
        assert!((unloading / stiffness - 1.0).abs() < 1e-6, "{unloading} {stiffness}");
        // The soil carries the whole force.
        assert!((points[5].base_shear / points[5].force - 1.0).abs() < 1e-5, "{points:?}");
        let moment = points[5].base_moment.abs();
        assert!((moment / PLASTIC_MOMENT - 1.0).abs() < 2e-3, "{moment}");
    }
}

/// A beam that is clamped at one end and propped at the other carries 6 M_p/L in its middle.
#[test]
fn a_propped_beam_collapses_by_two_hinges() {
    for formulation in ALL_FORMULATIONS {
        let mut frame = Frame::new(formulation);
        frame.distances = [0.006, 0.02, 0.05, 0.1, 0.3, 1.0];
        let feet = [frame.add_footing(0.0).unwrap(), frame.add_footing(6.0).unwrap()];
        let [left, middle, right] = [0.0, 3.0, 6.0].map(|x| frame.add_node(x, 2.0).unwrap());
        frame
            .mesh
            .add(Beam::new([feet[0], left], 210.0e9, 0.5, 0.1, 100.0).unwrap())
            .unwrap();
        frame.mesh.add(Truss::new([feet[1], right], 210.0e9, 0.5, 100.0).unwrap()).unwrap();
        frame.add_member([left, middle]).unwrap();
        frame.add_member([middle, right]).unwrap();
        let model = frame.model().unwrap();
        let row = -model.row(middle, Direction::Y).unwrap();
        let curve = pushed(bonded(model).unwrap(), &row, &[0.02, 0.05, 0.1, 0.2, 0.3]);
        check_collapse(
            &format!("propped beam, {formulation:?}"),
            &curve,
            6.0 * PLASTIC_MOMENT / 6.0,
        );
    }
}

/// A portal sways at H = 4 M_p/h, with a strong beam or an equal one.
#[test]
fn a_portal_collapses_by_sway() {
    let height = 3.0;
    for formulation in ALL_FORMULATIONS {
        for has_strong_beam in [true, false] {
            let mut frame = Frame::new(formulation);
            let feet = [0.0, 6.0].map(|x| frame.add_footing(x).unwrap());
            let tops = [0.0, 6.0].map(|x| frame.add_node(x, height).unwrap());
            for (foot, top) in feet.into_iter().zip(tops) {
                frame.add_member([foot, top]).unwrap();
            }
            if has_strong_beam {
                frame.mesh.add(Beam::new(tops, 210.0e9, 0.5, 0.1, 100.0).unwrap()).unwrap();
            } else {
                frame.add_member(tops).unwrap();
            }
            let model = frame.model().unwrap();
            let row = model.row(tops[0], Direction::X).unwrap();
            // Hinges of beams by forces are longer: their inner fibres yield at a larger rotation.
            let displacements: &[f64] = match formulation {
                BeamFormulation::ForceBased => &[0.02, 0.05, 0.1, 0.2, 0.5],
                _ => &[0.02, 0.05, 0.1, 0.2],
            };
            let curve = pushed(bonded(model).unwrap(), &row, displacements);
            // Axial forces of the columns, and of a beam that yields, lower the plastic moments.
            let foot_moment = moment_beside(2.0 * PLASTIC_MOMENT / 6.0);
            let top_moment = if has_strong_beam {
                foot_moment
            } else {
                moment_beside(2.0 * PLASTIC_MOMENT / height)
            };
            check_collapse(
                &format!("portal, {formulation:?}, strong beam {has_strong_beam}"),
                &curve,
                2.0 * (foot_moment + top_moment) / height,
            );
        }
    }
}

/// A strong column overturns its footing: the force tends to W b/2 over its height, at which the edge carries the whole
/// weight.
#[test]
fn a_strong_column_lifts_its_footing() {
    let (model, row) = cantilever(BeamFormulation::ForceBased).unwrap();
    let weight = 9.81 * (2.0 * 2500.0 + 3.0 * 100.0 + 1.0e3);
    let ground = SpringGround::under(&model, 40, 5.0e8, 5.0e8).unwrap();
    let builder = Simulation::builder(0.01)
        .ground(ground)
        .structure(model)
        .interface(Coulomb::new(5.0).unwrap())
        .gravity(9.81);
    let curve = pushed(builder, &row, &[0.001, 0.003, 0.01, 0.03]);
    let last_point = &curve.points[4];
    let expected = weight / 3.0 * (1.0 - 1.0 / 40.0);
    assert!(
        last_point.force < expected && last_point.force > 0.95 * expected,
        "{last_point:?} {expected}"
    );
    assert!(
        last_point.uplifted_fraction > 0.85 && last_point.base_rotation < 0.0,
        "{last_point:?}"
    );
}

/// A block on springs has the curve of the push-over by forces, and slides at μ W.
#[test]
fn a_block_has_the_curve_of_the_push_over_by_forces() {
    let block = RigidBlock::new(5.0, 8.0, 2000.0).unwrap();
    let scene = |friction: f64| {
        Simulation::builder(0.01)
            .ground(SpringGround::under(&block, 20, 3.0e7, 3.0e7).unwrap())
            .structure(block.clone())
            .interface(Coulomb::new(friction).unwrap())
    };
    let top = block.horizontal_at(8.0);
    let displacements = [0.01, 0.03, 0.1, 0.3];
    let curve = pushed(scene(5.0), &top, &displacements);
    let forces = curve.points[1..].iter().map(|point| point.force).collect();
    let by_forces = push_over(&top, &PushControl::Forces(forces), |force| {
        scene(5.0).load(Load::constant(top.clone(), force)).build()
    })
    .unwrap();
    assert_eq!(by_forces.points.len(), 5);
    for (point, expected) in curve.points.iter().zip(&by_forces.points).skip(1) {
        let error = (point.displacement / expected.displacement - 1.0).abs();
        assert!(error < 1e-5, "{error}: {point:?} {expected:?}");
        assert!((point.uplifted_fraction - expected.uplifted_fraction).abs() < 1e-12);
        assert!((point.base_moment / expected.base_moment - 1.0).abs() < 1e-6);
        assert!((point.base_rotation / expected.base_rotation - 1.0).abs() < 1e-5);
    }
    let near_base = block.horizontal_at(0.8);
    let curve = pushed(scene(0.3), &near_base, &[0.01, 0.05, 0.2, 1.0]);
    let resistance = 0.3 * 80.0e3 * 9.80665;
    check_collapse("sliding block", &curve, resistance);
    assert!(curve.points[4].sliding_fraction == 1.0, "{:?}", curve.points[4]);
}

/// A pattern over the height with the roof's displacement as control.
#[test]
fn the_pattern_may_differ_from_the_control() {
    let height = 3.0;
    let (model, tops) = two_storeys(BeamFormulation::ForceBased, height);
    let floors = tops.map(|node| model.row(node, Direction::X).unwrap());
    let pattern = 1.0 / 3.0 * floors[0].clone() + 2.0 / 3.0 * floors[1].clone();
    let curve = push_over_by_displacement(
        bonded(model).unwrap(),
        &pattern,
        &floors[1],
        &[0.05, 0.1, 0.2, 0.4],
    )
    .unwrap();
    let last_point = &curve.points[4];
    assert!((last_point.displacement - 0.4).abs() < 1e-9);
    assert!((last_point.base_shear / last_point.force - 1.0).abs() < 1e-5, "{last_point:?}");
    // Strong beams: the lower storey sways at 4 M_p/h before the upper one.
    check_collapse("two storeys", &curve, 4.0 * PLASTIC_MOMENT / height);
}

/// Portal of two storeys with strong beams, and the left ends of its floors.
fn two_storeys(formulation: BeamFormulation, height: f64) -> (FemModel, [usize; 2]) {
    let mut frame = Frame::new(formulation);
    // Far apart, so that the columns' axial forces take little of the plastic moment.
    let mut column_feet = [0.0, 20.0].map(|x| frame.add_footing(x).unwrap());
    let mut tops = [0; 2];
    for (storey, top) in tops.iter_mut().enumerate() {
        let y = height * (storey + 1) as f64;
        let floor = [0.0, 20.0].map(|x| frame.add_node(x, y).unwrap());
        for (below, above) in column_feet.into_iter().zip(floor) {
            frame.add_member([below, above]).unwrap();
        }
        frame.mesh.add(Beam::new(floor, 210.0e9, 0.5, 1.0, 100.0).unwrap()).unwrap();
        *top = floor[0];
        column_feet = floor;
    }
    (frame.model().unwrap(), tops)
}

#[test]
fn wrong_pushes_are_errors() {
    let row = cantilever(BeamFormulation::ForceBased).unwrap().1;
    let builder = || bonded(cantilever(BeamFormulation::ForceBased).unwrap().0).unwrap();
    let result = push_over_by_displacement(builder(), &row, &row, &[]);
    assert!(matches!(result, Err(Error::Size { .. })), "{result:?}");
    let result = push_over_by_displacement(builder(), &row, &row, &[f64::NAN]);
    assert!(matches!(result, Err(Error::NotFinite { .. })), "{result:?}");
    let result = push_over_by_displacement(builder(), &DofCombination::default(), &row, &[0.1]);
    assert!(matches!(result, Err(Error::Size { .. })), "{result:?}");
    let result = push_over_by_displacement(builder(), &row, &DofCombination::from(999), &[0.1]);
    assert!(matches!(result, Err(Error::Index { .. })), "{result:?}");
}
