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
use crate::coupled::base::held::holds;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::run::warning::Warning;
use crate::coupled::statics::compliance::{Compliance, Floating, springs};
use crate::coupled::statics::static_state::StaticState;
use crate::error::{CoarseBaseError, Result};
use crate::geometry::{axis_name, far_ends, in_a_row};
use crate::linalg::{CompressedMatrix, dot, magnitude};
use crate::structure::{BaseNode, Tangent};

/// Smallest ρ at which elements are short enough.
const STIFF: f64 = 6.0;
/// ρ at which the number named for a wall aims.
const OF_WALLS: f64 = 28.0;
/// Relative difference of static shapes with as many and with twice as many elements: limits of a warning for
/// solids, and of an error.
const DIFFERENCE: f64 = 0.03;
const ANOTHER: f64 = 0.3;
/// Increase of ρ when elements are halved, as a power of two: 3 for beams and plates, 0 for solids.
const POWERS: [f64; 2] = [1.0, 3.0];
/// Distance of a node from the line of its face that counts as rounding, relative to an element.
const LINE: f64 = 1e-9;
/// Largest order of a matrix with twice the elements.
const MOST: usize = 3600;
/// Asymmetry of K that counts as rounding.
const ROUNDING: f64 = 1e-9;

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
    if !assembled.base.is_flexible() || holds(parts.ground.as_ref()) {
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
    let own_soil = at_rest::compliance(parts)?;
    let own = (&own_soil, shared);
    let Some(floating) = floating(parts, assembled, own)? else { return Ok(None) };
    // The only element of a face has no neighbour that shows how stiff its soil is: its halves do.
    let alone = faces(base).any(|(.., own)| own.len() == 1);
    let halves = if alone { finer(base) } else { None };
    let shape = UnseenShape::softest(assembled, base, own, halves.as_ref())
        .filter(|shape| shape.ratio < STIFF);
    let Some(UnseenShape { ratio, mut face }) = shape else { return Ok(None) };
    let (mut power, mut difference) = (POWERS[1], None);
    if let Some((finer, soil)) = if alone { halves } else { finer(base) } {
        // If twice the elements leave no such shape, they are enough.
        let compliance = RefCell::new(Some(Compliance::new(floating, &finer, &soil)?));
        let halved = (&soil, &compliance);
        let next = UnseenShape::softest(assembled, &finer, halved, None);
        power = next.map_or(POWERS[1], |next| (next.ratio / ratio).log2());
        if parts.given.is_static() {
            // With a law for each element, the first law is used in both states.
            let law = &parts.given.laws[..1];
            let under = |assembled: &Assembled, soil| {
                at_rest::under_loads(parts, assembled, soil, law, [weight, load]).ok()
            };
            let with_first = (parts.given.laws.len() > 1).then(|| under(assembled, own));
            let coarse = with_first.as_ref().map_or(Some(at_rest), Option::as_ref);
            let fine = under(&assembled.on(finer), halved);
            let both = coarse.zip(fine.as_ref());
            difference = both.map(|(coarse, fine)| largest_difference(base, coarse, fine));
        }
    }
    let is_off = difference.is_some_and(|(_, own)| own > DIFFERENCE);
    if let (true, Some((worst, _))) = (is_off, difference) {
        face = worst;
    }
    // Solids, which more elements hardly stiffen, are stiff enough between elements.
    if power <= POWERS[0] && !is_off {
        return Ok(None);
    }
    let difference = difference.map(|(_, own)| own);
    let (foundation, axis, elements) = count(base, face);
    let aim = if axis == Some('z') { OF_WALLS } else { STIFF };
    let factor = (aim / ratio).powf(1.0 / power.clamp(POWERS[0], POWERS[1])).max(1.25);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let needed = (elements as f64 * factor).ceil() as usize;
    // A soft base with an even pressure has the right shape on few elements: without the shape on twice as many, the
    // elements may be too few.
    if difference.is_some_and(|own| own > ANOTHER) {
        return Err(CoarseBaseError { foundation, elements, needed, difference, axis }.into());
    }
    Ok(Some(Warning::CoarseBase { foundation, elements, needed, difference, axis }))
}

/// The factored structure of the compliance on its own elements, which becomes known.
///
/// `None` if its stiffness is not symmetric or cannot be factored.
fn floating(
    parts: &Parts,
    assembled: &Assembled,
    (soil, shared): OnSoil<'_>,
) -> Result<Option<Rc<Floating>>> {
    if assembled.stiffness_at_rest().asymmetry() > ROUNDING {
        return Ok(None);
    }
    if let Some(known) = &*shared.borrow() {
        return Ok(Some(Rc::clone(&known.floating)));
    }
    let tangent = Tangent::at(parts.structure.as_ref(), &vec![0.0; assembled.dofs()])?.matrix;
    let springs = springs(assembled, soil)?;
    let Ok(floating) = Floating::new(assembled, &tangent, springs) else { return Ok(None) };
    let floating = Rc::new(floating);
    shared.replace(Some(Compliance::new(Rc::clone(&floating), &assembled.base, soil)?));
    Ok(Some(floating))
}

/// Base on twice the elements, four times in plan, and their static compliance.
///
/// `None` if the compliance is unknown, or too large for a check.
fn finer(parts: &Parts, base: &PlacedBase) -> Option<(PlacedBase, CompressedMatrix)> {
    let patch = base.elements();
    if patch[0].parts().count() * patch.layout().len() > MOST {
        return None;
    }
    let finer = patch.finer().ok()?;
    let mut soil = parts.ground.finer_compliance().ok()??;
    if soil.len() != finer.layout().square() {
        return None;
    }
    finer.refer_inside(&mut soil);
    Some((PlacedBase::of(parts.structure.as_ref(), &finer).ok()?, CompressedMatrix::full(soil)))
}

/// The face with the largest difference of its shape between two static states, and the difference.
///
/// Root mean squares over the nodes of displacements into the soil, without the best rigid motions, relative to the
/// largest shape of any face of the foundation in the second state.
fn largest_difference(base: &PlacedBase, one: &StaticState, other: &StaticState) -> (usize, f64) {
    let shapes = faces(base).map(|(foundation, nodes, own)| {
        let element = &base.elements()[own.start];
        let into = |vector: [f64; 3]| element.components(vector)[0];
        let depth = into(element.center());
        let is_on = |node: &&BaseNode| {
            (into([node.x, node.y, node.z]) - depth).abs() <= LINE * element.length()
        };
        let nodes: Vec<&BaseNode> = nodes.iter().filter(is_on).collect();
        let shape = |state: &StaticState| -> Vec<f64> {
            let moved = |node: &&BaseNode| {
                let [right, up, away] = node.rows().map(|row| row.value(&state.displacement));
                into([right, away, up])
            };
            nodes.iter().map(moved).collect()
        };
        let [one, other] = [one, other].map(shape);
        let apart = one.iter().zip(&other).map(|(a, b)| a - b).collect();
        (foundation, [apart, other].map(|values| bent(&nodes, values)))
    });
    let shapes: Vec<_> = shapes.collect();
    let differences = shapes.iter().map(|(foundation, [apart, _])| {
        let own = shapes.iter().filter(|(other, _)| other == foundation);
        let whole = own.fold(0.0_f64, |most, (_, [_, whole])| most.max(*whole));
        if whole > 0.0 { apart / whole } else { 0.0 }
    });
    let worst = |most: (usize, f64), own: (usize, f64)| if own.1 > most.1 { own } else { most };
    differences.enumerate().fold((0, 0.0), worst)
}

/// Norm of values at the nodes minus their best linear fit; NaN becomes infinite.
fn bent(nodes: &[&BaseNode], values: Vec<f64>) -> f64 {
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
        let whole = magnitude(&column);
        for known in basis.iter().chain(&basis) {
            let share = dot(known, &column);
            column.iter_mut().zip(known).for_each(|(x, known)| *x -= share * known);
        }
        norm = magnitude(&column);
        if norm > 1e-12 * whole {
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
    let (foundation, _, own) = faces(base).nth(face).unwrap_or((0, &[], 0..0));
    if patch[own.clone()].iter().any(|own| !own.faces_down()) {
        return (foundation, Some('z'), own.len());
    }
    let along = |axis: usize| {
        let ends: Vec<_> = patch[own.clone()].iter().map(|own| own.ends()[axis]).collect();
        let [least, most] = far_ends(ends.iter().copied());
        (most - least, in_a_row(ends))
    };
    let sides: Vec<_> = patch.layout().axes().map(|axis| (along(axis), axis)).collect();
    let shorter = sides.into_iter().min_by(|((one, _), _), ((other, _), _)| one.total_cmp(other));
    let ((_, count), axis) = shorter.unwrap_or_default();
    (foundation, axis_name(patch.is_plan(), axis), count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::ElasticGround;
    use crate::bem::plan::Plan;
    use crate::coupled::assembly::held_responses::OfHeldBase;
    use crate::error::Error;
    use crate::fem::{Hex8, Material, Mesh};
    use crate::interface::Coulomb;
    use crate::linalg::largest;
    use crate::structure::FemModel;
    use crate::{Simulation, Soil};

    /// Bricks, 16 × 16 × 12, on 3 × 3 elements.
    fn parts() -> Result<Parts> {
        let mut mesh = Mesh::in_space();
        let line = |k: usize| 10.0 * (k as f64 / 16.0 - 0.5);
        let foot = mesh.add_grid(17, 17, |row, column| [line(column), line(row), 0.0])?;
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
        let (assembled, held) = Assembled::new(parts.structure.as_ref(), &parts.elements)?;
        let own = OfHeldBase::new(&parts, &assembled, held)?.condensed;
        assert!(own.is_some());
        let [own, whole] = [own, None].map(|mut condensed| {
            let shared = RefCell::default();
            let is_condensed = condensed.is_some();
            let at_rest = at_rest::solve(&mut parts, &assembled, &mut condensed, &shared).unwrap();
            assert_eq!(condensed.is_some(), is_condensed);
            match check(&parts, (&assembled, condensed.as_ref()), &at_rest, &shared) {
                Err(Error::CoarseBase(own)) => (own.needed, own.difference.unwrap(), at_rest),
                other => panic!("{other:?}"),
            }
        });
        assert!(own.0 == whole.0 && own.1 > ANOTHER);
        assert!((own.1 - whole.1).abs() < 1e-7 * whole.1, "{own:?} for {whole:?}");
        // Without friction, any motion along the ground is a static state.
        let of = |state: &StaticState| {
            let up = |node: &BaseNode| node.vertical.value(&state.displacement);
            let heights: Vec<f64> = assembled.base.nodes().iter().map(up).collect();
            [heights, assembled.stiffness.times(&state.displacement), state.traction.clone()]
        };
        for (own, whole) in of(&own.2).iter().zip(of(&whole.2)) {
            let apart: Vec<f64> = own.iter().zip(&whole).map(|(a, b)| a - b).collect();
            assert!(largest(&apart) < 1e-8 * largest(&whole));
        }
        Ok(())
    }
}
