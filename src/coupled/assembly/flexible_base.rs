//! Check of flexible bases: whether contact elements are short enough for the base's static shape.
//!
//! The ground receives only the mean displacement of the base over each element. In the model the structure alone resists a
//! shape with zero means. In reality the soil resists such a shape too.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | stiffness of the soil for deviations from the means of the elements |
//! | ρ | smallest φᵀKφ / φᵀSφ over all shapes φ with zero means |
//!
//! Measured errors of the settlement of columns relative to the middle of the base:
//!
//! * mat 20 m wide with two columns on the half-plane: a factor of 12 to 21 at ρ = 0.06, 136 to 500 % at 0.5, 2 to 51 % at
//!   3, and 0.3 to 0.5 % at 29, depending on the positions of the columns;
//! * slab 12 m square with one column in the middle: 77, 16, 6 and 2 % at ρ = 0.2, 0.9, 2.4 and 11;
//! * walls 8 m high with a strut between their middles: 9 % near ρ = 6, 3 % with 1.5 to 2 times as many elements.

use std::cell::RefCell;
use std::rc::Rc;

use super::at_rest;
use super::at_rest::StaticGround;
use super::zero_mean_shape::{RefinedBase, ZeroMeanShape, faces};
use crate::coupled::base::PlacedBase;
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::run::warning::Warning;
use crate::coupled::statics::compliance::{Compliance, ShiftedStiffnessFactor, initial_shift};
use crate::coupled::statics::static_state::StaticState;
use crate::error::{CoarseBaseError, Result};
use crate::geometry::{ContactElement, axis_name, enclosing_interval, min_interval_count};
use crate::linalg::{dot, magnitude_sum};
use crate::structure::{BaseNode, Tangent};

/// Smallest ρ at which elements are short enough.
const MIN_SHAPE_STIFFNESS_RATIO: f64 = 6.0;
/// ρ of the recommended number of elements of a wall.
const WALL_STIFFNESS_RATIO_GOAL: f64 = 28.0;
/// Relative difference of shapes on n and 2n elements that gives a warning.
const WARNING_SHAPE_DIFFERENCE: f64 = 0.03;
/// Relative difference of shapes on n and 2n elements that is an error.
const ERROR_SHAPE_DIFFERENCE: f64 = 0.3;
/// Smallest p in ρ ~ nᵖ at which more elements n help; p is 0 for solids.
const MIN_REFINEMENT_EXPONENT: f64 = 1.0;
/// Largest exponent p in ρ ~ nᵖ, for beams and plates.
const MAX_REFINEMENT_EXPONENT: f64 = 3.0;
/// Smallest recommended increase of the number of elements.
const MIN_REFINEMENT_FACTOR: f64 = 1.25;
/// Norm of a remainder that counts as rounding, relative to the norm before the projection.
const PROJECTION_ROUNDING_TOLERANCE: f64 = 1e-12;
/// Distance from a face's plane that counts as rounding, relative to an element.
const ON_FACE_TOLERANCE: f64 = 1e-9;
/// Relative asymmetry of K that counts as rounding.
const STIFFNESS_ASYMMETRY_TOLERANCE: f64 = 1e-9;

/// Warning of a flexible base with too few elements, if there are too few.
///
/// `condensation` is the structure condensed on its base, if it exists. `shared_compliance` has the compliance of the
/// condensed structure, or else of the whole structure, if it has been computed. A rigid base needs no computation.
pub(super) fn check(
    parts: &Parts,
    (assembled, condensation): (&Assembled, Option<&Condensed>),
    static_state: &StaticState,
    shared_compliance: &RefCell<Option<Compliance>>,
) -> Result<Option<Warning>> {
    if !assembled.base.is_flexible() || is_fixed_base(parts.ground.as_ref()) {
        return Ok(None);
    }
    let Some(condensation) = condensation else {
        let refine = |base: &_| RefinedBase::new(parts, base);
        let [weight, load] = at_rest::weight_and_load(parts, assembled)?;
        let structure = LoadedStructure { assembled, weight: &weight, load: &load };
        return check_structure(parts, structure, static_state, shared_compliance, refine);
    };
    let mut condensed_state = static_state.clone();
    condensed_state.displacement = condensation.base_displacement(&static_state.displacement);
    let refine = |base: &_| {
        let refined = RefinedBase::new(parts, base)?;
        Some(RefinedBase { base: condensation.condensed_base(&refined.base), ..refined })
    };
    let Condensed { assembled, weight, load, .. } = condensation;
    let structure = LoadedStructure { assembled, weight, load };
    check_structure(parts, structure, &condensed_state, shared_compliance, refine)
}

/// A structure with its weight and its other loads at t = 0, N.
#[derive(Clone, Copy)]
struct LoadedStructure<'a> {
    assembled: &'a Assembled,
    weight: &'a [f64],
    load: &'a [f64],
}

/// Checks a structure, whole or condensed on its base, under its weight and loads at t = 0.
fn check_structure(
    parts: &Parts,
    structure: LoadedStructure<'_>,
    static_state: &StaticState,
    shared_compliance: &RefCell<Option<Compliance>>,
    refine: impl Fn(&PlacedBase) -> Option<RefinedBase>,
) -> Result<Option<Warning>> {
    let assembled = structure.assembled;
    let base = &assembled.base;
    let ground_compliance = at_rest::static_compliance(parts, base)?;
    let ground = StaticGround::for_comparison(&ground_compliance, shared_compliance);
    let Some(factor) = shared_factor(parts, assembled, ground)? else {
        return Ok(None);
    };
    // The stiffness of the soil follows from neighbouring elements, or from the halves of the only element of a face.
    let has_single_element = faces(base).any(|(.., elements)| elements.len() == 1);
    let halves = if has_single_element { refine(base) } else { None };
    let shape = ZeroMeanShape::softest(assembled, base, ground, halves.as_ref())
        .filter(|shape| shape.stiffness_ratio < MIN_SHAPE_STIFFNESS_RATIO);
    let Some(shape) = shape else { return Ok(None) };
    let mut face = shape.face;
    let mut exponent = MAX_REFINEMENT_EXPONENT;
    let mut difference = None;
    if let Some(refinement) = if has_single_element { halves } else { refine(base) } {
        let RefinedBase { base: refined_base, ground_compliance } = refinement;
        let compliance = Compliance::new(factor, &refined_base, &ground_compliance)?;
        let shared_compliance = RefCell::new(Some(compliance));
        let refined_ground = StaticGround::for_comparison(&ground_compliance, &shared_compliance);
        // If no soft shape remains after halving the elements, the refined base is sufficient.
        let refined_shape = ZeroMeanShape::softest(assembled, &refined_base, refined_ground, None);
        exponent = refined_shape.map_or(MAX_REFINEMENT_EXPONENT, |refined_shape| {
            (refined_shape.stiffness_ratio / shape.stiffness_ratio).log2()
        });
        if parts.builder.has_static_loads() && parts.joints.is_empty() {
            let refined_assembled = assembled.with_base(refined_base);
            let refined_structure = LoadedStructure { assembled: &refined_assembled, ..structure };
            let structures = [structure, refined_structure];
            let grounds = [ground, refined_ground];
            difference = shape_difference(parts, structures, grounds, static_state);
        }
    }
    let is_inaccurate = difference.is_some_and(|(_, value)| value > WARNING_SHAPE_DIFFERENCE);
    if let (true, Some((worst_face, _))) = (is_inaccurate, difference) {
        face = worst_face;
    }
    // More elements hardly change ρ of a solid, which is stiff enough between elements.
    if exponent <= MIN_REFINEMENT_EXPONENT && !is_inaccurate {
        return Ok(None);
    }
    let difference = difference.map(|(_, value)| value);
    let FaceElements { foundation, axis, count: elements } = FaceElements::new(base, face);
    let needed = needed_elements(elements, axis, shape.stiffness_ratio, exponent);
    // A soft base with an even pressure has the right shape on few elements. An error therefore needs a comparison with
    // the shape on twice the elements.
    if difference.is_some_and(|value| value > ERROR_SHAPE_DIFFERENCE) {
        return Err(CoarseBaseError { foundation, elements, needed, difference, axis }.into());
    }
    Ok(Some(Warning::CoarseBase { foundation, elements, needed, difference, axis }))
}

/// Face whose static shape differs most on the refined base, and the difference.
///
/// With a law for each element, both states have the first law. `None` if one of them has no equilibrium.
fn shape_difference(
    parts: &Parts,
    [loaded, refined]: [LoadedStructure<'_>; 2],
    [ground, refined_ground]: [StaticGround<'_>; 2],
    static_state: &StaticState,
) -> Option<(usize, f64)> {
    let first_law = &parts.builder.laws[..1];
    let state_on = |structure: LoadedStructure<'_>, ground| {
        let forces = [structure.weight, structure.load];
        at_rest::state_under_loads(parts, structure.assembled, ground, first_law, forces).ok()
    };
    let has_many_laws = parts.builder.laws.len() > 1;
    let first_law_state = if has_many_laws { Some(state_on(loaded, ground)) } else { None };
    let coarse_state = first_law_state.as_ref().map_or(Some(static_state), Option::as_ref);
    let refined_state = state_on(refined, refined_ground);
    let states = coarse_state.zip(refined_state.as_ref());
    states.map(|(coarse, fine)| largest_difference(&loaded.assembled.base, coarse, fine))
}

/// Recommended number of elements for a face with this number and this ρ.
fn needed_elements(
    elements: usize,
    axis: Option<char>,
    stiffness_ratio: f64,
    exponent: f64,
) -> usize {
    let goal =
        if axis == Some('z') { WALL_STIFFNESS_RATIO_GOAL } else { MIN_SHAPE_STIFFNESS_RATIO };
    let exponent = exponent.clamp(MIN_REFINEMENT_EXPONENT, MAX_REFINEMENT_EXPONENT);
    let factor = (goal / stiffness_ratio).powf(1.0 / exponent).max(MIN_REFINEMENT_FACTOR);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let needed = (elements as f64 * factor).ceil() as usize;
    needed
}

/// Factored stiffness behind the shared compliance, which the function computes if it is missing.
///
/// `None` if the stiffness is not symmetric or cannot be factored.
fn shared_factor(
    parts: &Parts,
    assembled: &Assembled,
    ground: StaticGround<'_>,
) -> Result<Option<Rc<ShiftedStiffnessFactor>>> {
    if assembled.stiffness_at_rest().asymmetry() > STIFFNESS_ASYMMETRY_TOLERANCE {
        return Ok(None);
    }
    if let Some(compliance) = &*ground.shared_compliance.borrow() {
        return Ok(Some(Rc::clone(&compliance.factor)));
    }
    let tangent = Tangent::at(parts.structure.as_ref(), &vec![0.0; assembled.dofs()])?.matrix;
    let shift = initial_shift(assembled, ground.compliance)?;
    let Ok(factor) = ShiftedStiffnessFactor::new(assembled, &tangent, shift) else {
        return Ok(None);
    };
    let factor = Rc::new(factor);
    let compliance = Compliance::new(Rc::clone(&factor), &assembled.base, ground.compliance)?;
    ground.shared_compliance.replace(Some(compliance));
    Ok(Some(factor))
}

/// Face with the largest difference of its shape between two static states, and the difference.
///
/// Shapes are displacements into the soil minus their best linear fit, with the root of the mean square over the nodes as
/// norm. The difference is relative to the largest norm of all faces of the foundation in the second state.
fn largest_difference(
    base: &PlacedBase,
    first_state: &StaticState,
    second_state: &StaticState,
) -> (usize, f64) {
    let mut shapes = Vec::new();
    for (foundation, nodes, elements) in faces(base) {
        let element = &base.elements()[elements.start];
        let depth = element.components(element.center())[0];
        let mut face_nodes: Vec<&BaseNode> = Vec::new();
        for node in nodes {
            let distance = element.components([node.x, node.y, node.z])[0] - depth;
            if distance.abs() <= ON_FACE_TOLERANCE * element.length() {
                face_nodes.push(node);
            }
        }
        let first_shape = normal_displacements(&face_nodes, element, first_state);
        let second_shape = normal_displacements(&face_nodes, element, second_state);
        let change = first_shape.iter().zip(&second_shape).map(|(a, b)| a - b).collect();
        shapes.push((
            foundation,
            bending_norm(&face_nodes, change),
            bending_norm(&face_nodes, second_shape),
        ));
    }
    let mut worst_face = (0, 0.0);
    for (face, (foundation, change, _)) in shapes.iter().enumerate() {
        let foundation_shapes = shapes.iter().filter(|(other, ..)| other == foundation);
        let reference = foundation_shapes.fold(0.0_f64, |largest, (.., norm)| largest.max(*norm));
        let difference = if reference > 0.0 { change / reference } else { 0.0 };
        if difference > worst_face.1 {
            worst_face = (face, difference);
        }
    }
    worst_face
}

/// Displacements of nodes into the soil along the normal of a face, m.
fn normal_displacements(
    nodes: &[&BaseNode],
    element: &ContactElement,
    state: &StaticState,
) -> Vec<f64> {
    let mut displacements = Vec::with_capacity(nodes.len());
    for node in nodes {
        let [right, up, along_y] = node.rows().map(|row| row.value(&state.displacement));
        displacements.push(element.components([right, along_y, up])[0]);
    }
    displacements
}

/// Norm of values at the nodes minus their best linear fit; infinite instead of NaN.
fn bending_norm(nodes: &[&BaseNode], values: Vec<f64>) -> f64 {
    let node_count = nodes.len() as f64;
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let columns = [
        vec![1.0; nodes.len()],
        nodes.iter().map(|node| node.x).collect(),
        nodes.iter().map(|node| node.y).collect(),
        nodes.iter().map(|node| node.z).collect(),
        values,
    ];
    let mut norm = 0.0;
    for mut column in columns {
        let initial_norm = magnitude_sum(&column);
        for direction in basis.iter().chain(&basis) {
            let component = dot(direction, &column);
            column.iter_mut().zip(direction).for_each(|(x, unit)| *x -= component * unit);
        }
        norm = magnitude_sum(&column);
        if norm > PROJECTION_ROUNDING_TOLERANCE * initial_norm {
            basis.push(column.iter().map(|x| x / norm).collect());
        } else {
            norm = 0.0;
        }
    }
    if norm.is_nan() { f64::INFINITY } else { norm / node_count.sqrt() }
}

/// Elements of a face, for messages.
struct FaceElements {
    /// Number of the foundation.
    foundation: usize,
    /// Axis of the count: z for a wall, in plan that of the shorter side.
    axis: Option<char>,
    /// Number of elements along the axis.
    count: usize,
}

impl FaceElements {
    /// Counts the elements of a face.
    fn new(base: &PlacedBase, face: usize) -> Self {
        let patch = base.elements();
        let (foundation, _, range) = faces(base).nth(face).unwrap_or((0, &[], 0..0));
        let elements = &patch[range];
        if elements.iter().any(|element| !element.faces_down()) {
            return Self { foundation, axis: Some('z'), count: elements.len() };
        }
        let sides = patch.layout().axes().map(|axis| {
            let ends: Vec<_> = elements.iter().map(|element| element.ends()[axis]).collect();
            let edges = enclosing_interval(ends.iter().copied());
            (edges[1] - edges[0], min_interval_count(ends), axis)
        });
        let shorter_side = sides.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let (_, count, axis) = shorter_side.unwrap_or_default();
        Self { foundation, axis: axis_name(patch.is_plan(), axis), count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::ElasticGround;
    use crate::bem::plan::Plan;
    use crate::coupled::assembly::fixed_base_results::FixedBaseResults;
    use crate::error::Error;
    use crate::fem::{Hex8, Material, Mesh};
    use crate::interface::Coulomb;
    use crate::linalg::largest;
    use crate::structure::FemModel;
    use crate::{Simulation, Soil};

    /// A solid of 16 × 16 × 12 hexahedra with a stiff column, on 3 × 3 elements.
    fn parts() -> Result<Parts> {
        let mut mesh = Mesh::in_space();
        let coordinates: Vec<f64> = (0..17).map(|k| 10.0 * (f64::from(k) / 16.0 - 0.5)).collect();
        let foot =
            mesh.add_grid(17, 17, |row, column| [coordinates[column], coordinates[row], 0.0])?;
        let heights: Vec<f64> = (1..=12).map(|k| 0.4 * f64::from(k)).collect();
        for (k, brick) in foot.extrude(&mut mesh, &heights)?.into_iter().enumerate() {
            let modulus = if k % 256 == 37 { 3e10 } else { 3e8 };
            mesh.add(Hex8::new(brick, Material::new(modulus, 0.2, 2000.0)?))?;
        }
        let soil = Soil::new(3e8, 0.3, 1900.0)?;
        let ground = ElasticGround::in_plan(soil, Plan::rectangle(-5.0..5.0, -5.0..5.0, 3)?)?;
        let scene = Simulation::builder(0.01).structure(FemModel::on_base(mesh)?).ground(ground);
        Parts::new(scene.interface(Coulomb::new(0.4)?))
    }

    /// REFERENCE: static state and check of the structure in all of its degrees of freedom.
    #[test]
    fn a_condensed_structure_has_the_same_static_state_and_check() -> Result<()> {
        let mut parts = parts()?;
        let structure = parts.structure.as_ref();
        let (assembled, fixed_factor) = Assembled::new(structure, &parts.elements, &[])?;
        let condensation = FixedBaseResults::new(&parts, &assembled, fixed_factor)?.condensation;
        assert!(condensation.is_some());
        let results = [condensation, None].map(|mut condensation| {
            let shared = RefCell::default();
            let is_condensed = condensation.is_some();
            let state = at_rest::solve(&mut parts, &assembled, &mut condensation, &shared).unwrap();
            assert_eq!(condensation.is_some(), is_condensed);
            match check(&parts, (&assembled, condensation.as_ref()), &state, &shared) {
                Err(Error::CoarseBase(error)) => (error.needed, error.difference.unwrap(), state),
                other => panic!("{other:?}"),
            }
        });
        let [computed, expected] = &results;
        assert!(computed.0 == expected.0 && computed.1 > ERROR_SHAPE_DIFFERENCE);
        assert!(
            (computed.1 - expected.1).abs() < 1e-7 * expected.1,
            "{computed:?} for {expected:?}"
        );
        // Without friction, any motion along the ground is a static state.
        let results_of = |state: &StaticState| {
            let nodes = assembled.base.nodes().iter();
            let heights = nodes.map(|node| node.vertical.value(&state.displacement)).collect();
            [heights, assembled.stiffness.times(&state.displacement), state.traction.clone()]
        };
        for (computed, expected) in results_of(&computed.2).iter().zip(results_of(&expected.2)) {
            let differences: Vec<f64> =
                computed.iter().zip(&expected).map(|(a, b)| a - b).collect();
            assert!(largest(&differences) < 1e-8 * largest(&expected));
        }
        Ok(())
    }
}
