//! Check of flexible bases: whether contact elements are short enough for the base's static shape.
//!
//! The ground receives the mean base displacement of each element. Only the structure resists a shape with zero
//! means; in reality the soil resists it too.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | stiffness of the soil for displacements against the means of the elements |
//! | ρ | smallest φᵀKφ / φᵀSφ of all shapes φ with zero means |
//!
//! Measured error of the settlement of columns relative to the middle of the base. Mat 20 m wide with two columns
//! on the half-plane: a factor of 12 to 21, 136 to 500 %, 2 to 51 % and 0.3 to 0.5 % at ρ = 0.06, 0.5, 3 and 29,
//! depending on the columns' places. Slab 12 m square with one column in the middle: 77, 16, 6 and 2 % at ρ = 0.2,
//! 0.9, 2.4 and 11. Walls 8 m high with a strut between their middles: 9 % near ρ = 6, 3 % with 1.5 to 2 times the
//! elements, by which ρ grows with their cube.

use std::cell::RefCell;
use std::rc::Rc;

use super::at_rest;
use super::unseen_shape::{OnSoil, UnseenShape, faces};
use crate::coupled::base::PlacedBase;
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::run::warning::Warning;
use crate::coupled::statics::compliance::{Compliance, Floating, springs};
use crate::coupled::statics::static_state::StaticState;
use crate::error::{CoarseBaseError, Result};
use crate::geometry::{ContactElement, axis_name, far_ends, min_interval_count};
use crate::linalg::{CompressedMatrix, dot, magnitude};
use crate::structure::{BaseNode, Tangent};

/// Smallest ρ at which elements are short enough.
const MIN_SHAPE_STIFFNESS_RATIO: f64 = 6.0;
/// ρ at which the number named for a wall aims.
const WALL_STIFFNESS_RATIO_GOAL: f64 = 28.0;
/// Relative difference of static shapes with as many and with twice as many elements: limits of a warning for
/// solids, and of an error.
const WARNING_SHAPE_DIFFERENCE: f64 = 0.03;
const ERROR_SHAPE_DIFFERENCE: f64 = 0.3;
/// Increase of ρ when elements are halved, as a power of two: 3 for beams and plates, 0 for solids.
const REFINEMENT_POWER_RANGE: [f64; 2] = [1.0, 3.0];
/// Distance of a node from the line of its face that counts as rounding, relative to an element.
const ON_FACE_TOLERANCE: f64 = 1e-9;
/// Largest order of a matrix with twice the elements.
const MAX_REFINED_ORDER: usize = 3600;
/// Asymmetry of K that counts as rounding.
const STIFFNESS_ASYMMETRY_TOLERANCE: f64 = 1e-9;

/// Warning of a flexible base with too few elements; `None` for enough elements or a rigid base.
///
/// `condensed`: the structure condensed on its base, if it was. `at_rest`: the static state. `shared`: the compliance of
/// the condensed structure, or else of the whole one, in it, if it is known. A rigid base costs nothing.
pub(super) fn check(
    parts: &Parts,
    (assembled, condensed): (&Assembled, Option<&Condensed>),
    at_rest: &StaticState,
    shared: &RefCell<Option<Compliance>>,
) -> Result<Option<Warning>> {
    if !assembled.base.is_flexible() || is_fixed_base(parts.ground.as_ref()) {
        return Ok(None);
    }
    let Some(condensed) = condensed else {
        let finer = |base: &_| finer(parts, base);
        let loads = at_rest::weight_and_load(parts, assembled)?;
        return check_on(parts, (assembled, &loads), at_rest, shared, finer);
    };
    let mut on_base = at_rest.clone();
    on_base.displacement = condensed.on_base(&at_rest.displacement);
    let finer = |base: &_| finer(parts, base).map(|(base, soil)| (condensed.base(&base), soil));
    check_on(parts, (&condensed.assembled, &condensed.loads), &on_base, shared, finer)
}

/// The check of a structure or a condensed one under its weight and loads at t = 0.
///
/// `finer`: the base on twice the elements, four times in plan, and their static compliance.
fn check_on(
    parts: &Parts,
    (assembled, [weight, load]): (&Assembled, &[Vec<f64>; 2]),
    at_rest: &StaticState,
    shared: &RefCell<Option<Compliance>>,
    finer: impl Fn(&PlacedBase) -> Option<(PlacedBase, CompressedMatrix)>,
) -> Result<Option<Warning>> {
    let base = &assembled.base;
    let soil = at_rest::compliance(parts)?;
    let on_soil = (&soil, shared);
    let Some(floating) = floating(parts, assembled, on_soil)? else {
        return Ok(None);
    };
    // The stiffness of the soil follows from neighbouring elements, or from the halves of the only element of a face.
    let has_single_element = faces(base).any(|(.., elements)| elements.len() == 1);
    let halves = if has_single_element { finer(base) } else { None };
    let shape = UnseenShape::softest(assembled, base, on_soil, halves.as_ref())
        .filter(|shape| shape.ratio < MIN_SHAPE_STIFFNESS_RATIO);
    let Some(UnseenShape { ratio, mut face }) = shape else { return Ok(None) };
    let mut power = REFINEMENT_POWER_RANGE[1];
    let mut difference = None;
    if let Some((finer, soil)) = if has_single_element { halves } else { finer(base) } {
        // If no soft shape remains after halving the elements, the refined base is sufficient.
        let compliance = RefCell::new(Some(Compliance::new(floating, &finer, &soil)?));
        let halved = (&soil, &compliance);
        let refined = UnseenShape::softest(assembled, &finer, halved, None);
        power = refined.map_or(REFINEMENT_POWER_RANGE[1], |next| (next.ratio / ratio).log2());
        if parts.builder.is_static() {
            // With a law for each element, the first law is used in both states.
            let law = &parts.builder.laws[..1];
            let under = |assembled: &Assembled, soil| {
                at_rest::under_loads(parts, assembled, soil, law, [weight, load]).ok()
            };
            let with_first = (parts.builder.laws.len() > 1).then(|| under(assembled, on_soil));
            let coarse = with_first.as_ref().map_or(Some(at_rest), Option::as_ref);
            let fine = under(&assembled.on(finer), halved);
            let both = coarse.zip(fine.as_ref());
            difference = both.map(|(coarse, fine)| largest_difference(base, coarse, fine));
        }
    }
    let is_inaccurate = difference.is_some_and(|(_, value)| value > WARNING_SHAPE_DIFFERENCE);
    if let (true, Some((worst, _))) = (is_inaccurate, difference) {
        face = worst;
    }
    // More elements hardly change ρ of a solid, which is stiff enough between elements.
    if power <= REFINEMENT_POWER_RANGE[0] && !is_inaccurate {
        return Ok(None);
    }
    let difference = difference.map(|(_, value)| value);
    let (foundation, axis, elements) = count(base, face);
    let goal =
        if axis == Some('z') { WALL_STIFFNESS_RATIO_GOAL } else { MIN_SHAPE_STIFFNESS_RATIO };
    let power = power.clamp(REFINEMENT_POWER_RANGE[0], REFINEMENT_POWER_RANGE[1]);
    let factor = (goal / ratio).powf(1.0 / power).max(1.25);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let needed = (elements as f64 * factor).ceil() as usize;
    // A soft base with an even pressure has the right shape on few elements. An error therefore needs a comparison with
    // the shape on twice the elements.
    if difference.is_some_and(|value| value > ERROR_SHAPE_DIFFERENCE) {
        return Err(CoarseBaseError { foundation, elements, needed, difference, axis }.into());
    }
    Ok(Some(Warning::CoarseBase { foundation, elements, needed, difference, axis }))
}

/// The factored structure of the compliance on the base's elements; `shared` receives the compliance.
///
/// `None` if its stiffness is not symmetric or cannot be factored.
fn floating(
    parts: &Parts,
    assembled: &Assembled,
    (soil, shared): OnSoil<'_>,
) -> Result<Option<Rc<Floating>>> {
    if assembled.stiffness_at_rest().asymmetry() > STIFFNESS_ASYMMETRY_TOLERANCE {
        return Ok(None);
    }
    if let Some(compliance) = &*shared.borrow() {
        return Ok(Some(Rc::clone(&compliance.floating)));
    }
    let tangent = Tangent::at(parts.structure.as_ref(), &vec![0.0; assembled.dofs()])?.matrix;
    let springs = springs(assembled, soil)?;
    let Ok(floating) = Floating::new(assembled, &tangent, springs) else {
        return Ok(None);
    };
    let floating = Rc::new(floating);
    shared.replace(Some(Compliance::new(Rc::clone(&floating), &assembled.base, soil)?));
    Ok(Some(floating))
}

/// Base on twice the elements, four times in plan, and their static compliance.
///
/// `None` if the compliance is unknown, or too large for a check.
fn finer(parts: &Parts, base: &PlacedBase) -> Option<(PlacedBase, CompressedMatrix)> {
    let patch = base.elements();
    if patch[0].parts().count() * patch.layout().len() > MAX_REFINED_ORDER {
        return None;
    }
    let finer = patch.refined().ok()?;
    let mut soil = parts.ground.finer_compliance().ok()??;
    if soil.len() != finer.layout().square() {
        return None;
    }
    finer.refer_inside(&mut soil);
    Some((PlacedBase::of(parts.structure.as_ref(), &finer).ok()?, CompressedMatrix::dense(soil)))
}

/// The face with the largest difference of its shape between two static states, and the difference.
///
/// Root mean squares over the nodes of displacements into the soil, without the best rigid motions, relative to the
/// largest shape of any face of the foundation in the second state.
fn largest_difference(base: &PlacedBase, one: &StaticState, other: &StaticState) -> (usize, f64) {
    let mut shapes = Vec::new();
    for (foundation, nodes, elements) in faces(base) {
        let element = &base.elements()[elements.start];
        let depth = element.components(element.center())[0];
        let mut on_face: Vec<&BaseNode> = Vec::new();
        for node in nodes {
            let distance = element.components([node.x, node.y, node.z])[0] - depth;
            if distance.abs() <= ON_FACE_TOLERANCE * element.length() {
                on_face.push(node);
            }
        }
        let first = normal_displacements(&on_face, element, one);
        let second = normal_displacements(&on_face, element, other);
        let change = first.iter().zip(&second).map(|(a, b)| a - b).collect();
        shapes.push((foundation, bending_norm(&on_face, change), bending_norm(&on_face, second)));
    }
    let mut worst = (0, 0.0);
    for (face, (foundation, change, _)) in shapes.iter().enumerate() {
        let on_foundation = shapes.iter().filter(|(other, ..)| other == foundation);
        let reference = on_foundation.fold(0.0_f64, |largest, (.., norm)| largest.max(*norm));
        let difference = if reference > 0.0 { change / reference } else { 0.0 };
        if difference > worst.1 {
            worst = (face, difference);
        }
    }
    worst
}

/// Displacements of nodes into the soil under a face, m.
fn normal_displacements(
    nodes: &[&BaseNode],
    element: &ContactElement,
    state: &StaticState,
) -> Vec<f64> {
    let mut displacements = Vec::with_capacity(nodes.len());
    for node in nodes {
        let [right, up, away] = node.rows().map(|row| row.value(&state.displacement));
        displacements.push(element.components([right, away, up])[0]);
    }
    displacements
}

/// Norm of values at the nodes minus their best linear fit; NaN becomes infinite.
fn bending_norm(nodes: &[&BaseNode], values: Vec<f64>) -> f64 {
    let count = nodes.len() as f64;
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
        let initial_norm = magnitude(&column);
        for direction in basis.iter().chain(&basis) {
            let component = dot(direction, &column);
            column.iter_mut().zip(direction).for_each(|(x, unit)| *x -= component * unit);
        }
        norm = magnitude(&column);
        if norm > 1e-12 * initial_norm {
            basis.push(column.iter().map(|x| x / norm).collect());
        } else {
            norm = 0.0;
        }
    }
    if norm.is_nan() { f64::INFINITY } else { norm / count.sqrt() }
}

/// Foundation and number of elements of a face; in plan along its shorter side, with the name of that axis.
fn count(base: &PlacedBase, face: usize) -> (usize, Option<char>, usize) {
    let patch = base.elements();
    let (foundation, _, range) = faces(base).nth(face).unwrap_or((0, &[], 0..0));
    let elements = &patch[range];
    if elements.iter().any(|element| !element.faces_down()) {
        return (foundation, Some('z'), elements.len());
    }
    let sides = patch.layout().axes().map(|axis| {
        let ends: Vec<_> = elements.iter().map(|element| element.ends()[axis]).collect();
        let edges = far_ends(ends.iter().copied());
        (edges[1] - edges[0], min_interval_count(ends), axis)
    });
    let shorter = sides.min_by(|(one, ..), (other, ..)| one.total_cmp(other));
    let (_, count, axis) = shorter.unwrap_or_default();
    (foundation, axis_name(patch.is_plan(), axis), count)
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

    /// Bricks, 16 × 16 × 12, on 3 × 3 elements.
    fn parts() -> Result<Parts> {
        let mut mesh = Mesh::in_space();
        let places: Vec<f64> = (0..17).map(|k| 10.0 * (f64::from(k) / 16.0 - 0.5)).collect();
        let foot = mesh.add_grid(17, 17, |row, column| [places[column], places[row], 0.0])?;
        let heights: Vec<f64> = (1..=12).map(|k| 0.4 * f64::from(k)).collect();
        for (k, brick) in foot.extrude(&mut mesh, &heights)?.into_iter().enumerate() {
            // A stiff column on one side.
            let modulus = if k % 256 == 37 { 3e10 } else { 3e8 };
            mesh.add(Hex8::new(brick, Material::new(modulus, 0.2, 2000.0)?))?;
        }
        let plan = Plan::rectangle(-5.0..5.0, -5.0..5.0, 3)?;
        let ground = ElasticGround::in_plan(Soil::new(3e8, 0.3, 1900.0)?, plan)?;
        let scene = Simulation::builder(0.01).structure(FemModel::on_base(mesh)?).ground(ground);
        Parts::new(scene.interface(Coulomb::new(0.4)?))
    }

    /// REFERENCE: static state and check of the structure in all of its degrees of freedom.
    #[test]
    fn a_condensed_structure_has_the_same_static_state_and_check() -> Result<()> {
        let mut parts = parts()?;
        let (assembled, fixed_factor) = Assembled::new(parts.structure.as_ref(), &parts.elements)?;
        let on_base = FixedBaseResults::new(&parts, &assembled, fixed_factor)?.condensed;
        assert!(on_base.is_some());
        let results = [on_base, None].map(|mut condensed| {
            let shared = RefCell::default();
            let is_condensed = condensed.is_some();
            let at_rest = at_rest::solve(&mut parts, &assembled, &mut condensed, &shared).unwrap();
            assert_eq!(condensed.is_some(), is_condensed);
            match check(&parts, (&assembled, condensed.as_ref()), &at_rest, &shared) {
                Err(Error::CoarseBase(error)) => (error.needed, error.difference.unwrap(), at_rest),
                other => panic!("{other:?}"),
            }
        });
        let [found, whole] = &results;
        assert!(found.0 == whole.0 && found.1 > ERROR_SHAPE_DIFFERENCE);
        assert!((found.1 - whole.1).abs() < 1e-7 * whole.1, "{found:?} for {whole:?}");
        // Without friction, any motion along the ground is a static state.
        let of = |state: &StaticState| {
            let nodes = assembled.base.nodes().iter();
            let heights = nodes.map(|node| node.vertical.value(&state.displacement)).collect();
            [heights, assembled.stiffness.times(&state.displacement), state.traction.clone()]
        };
        for (found, whole) in of(&found.2).iter().zip(of(&whole.2)) {
            let differences: Vec<f64> = found.iter().zip(&whole).map(|(a, b)| a - b).collect();
            assert!(largest(&differences) < 1e-8 * largest(&whole));
        }
        Ok(())
    }
}
