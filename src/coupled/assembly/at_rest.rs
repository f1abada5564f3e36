//! The static state of a scene: in stages, with walls after backfilling or in place of the soil.

use std::cell::RefCell;

use super::backfilled;
use super::static_stages::{loaded, placed};
use crate::coupled::base::fixed_base::is_fixed_base;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::bed_compliance;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::model::condensed::Condensed;
use crate::coupled::parts::Parts;
use crate::coupled::statics::buckling::{self, Grounded};
use crate::coupled::statics::compliance::Compliance;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Result, all_finite, finite};
use crate::interface::InterfaceLaw;
use crate::linalg::{CompressedMatrix, dense_multiply_add};
use crate::structure::nonlinear_state;

/// The state under weight and the loads at t = 0; trivial without gravity.
///
/// Commits the structure's internal variables to it. `shared` receives the compliance of a linear structure, or of the
/// condensed one. Where this one has no static state, it becomes `None`: the whole structure decides. A structure with P–Δ
/// that buckles on its ground is an error, whatever the stage: without weight or unloaded it would fall in the run.
pub(crate) fn solve(
    parts: &mut Parts,
    assembled: &Assembled,
    condensed: &mut Option<Condensed>,
    shared: &RefCell<Option<Compliance>>,
) -> Result<StaticState> {
    let mut state = StaticState::weightless(parts.elements.layout(), assembled.dofs());
    let has_p_delta = buckling::has_p_delta(parts.structure.as_ref());
    let mut soil = CompressedMatrix::dense(Vec::new());
    if parts.builder.is_static() {
        soil = compliance(parts)?;
        let loads = loads(parts, assembled)?;
        let weight = &loads.weight;
        let load = &loads.load;
        let laws = &parts.builder.laws;
        let on_soil = (&soil, shared);
        let on_base = condensed.as_ref().and_then(|condensed| {
            let loads = condensed.loads.each_ref().map(Vec::as_slice);
            let mut base = under_loads(parts, &condensed.assembled, on_soil, laws, loads).ok()?;
            let mut force: Vec<f64> = weight.iter().zip(load).map(|(w, f)| w + f).collect();
            assembled.base.add_forces(-1.0, &base.traction, &mut force);
            base.displacement = condensed.expanded(assembled, &base.displacement, &force);
            Some(base)
        });
        if on_base.is_none() {
            (*condensed, *shared.borrow_mut()) = (None, None);
        }
        state = match on_base {
            Some(state) => state,
            None => under_loads(parts, assembled, on_soil, laws, [weight, load])?,
        };
        state.load = loads.of_structure;
    } else if has_p_delta {
        soil = compliance(parts)?;
    }
    // The build has checked a fixed base before.
    if has_p_delta && !is_fixed_base(parts.ground.as_ref()) {
        let structure = parts.structure.as_ref();
        let laws = &parts.builder.laws;
        let grounded = Grounded { assembled, structure, soil: &soil, laws };
        let on_base = condensed.as_ref().map(|condensed| &condensed.assembled);
        buckling::check(grounded, on_base, &state)?;
    }
    if parts.builder.is_static()
        && let Some(force) = parts.structure.nonlinear_mut()
    {
        force.commit(&state.displacement);
    }
    let structure = &parts.structure;
    (state.force, state.energy) = nonlinear_state(structure.as_ref(), &state.displacement)?;
    all_finite("nonlinear force at t = 0", &state.force)?;
    if let Some(energy) = &state.energy {
        finite("energy that the nonlinear force stores at t = 0", energy.stored)?;
        finite("energy that the nonlinear force has dissipated at t = 0", energy.dissipated)?;
    }
    Ok(state)
}

/// Static compliance of the ground, for tractions inside the outline; a diagonal where the step compliance is one.
pub(crate) fn compliance(parts: &Parts) -> Result<CompressedMatrix> {
    if parts.soil.as_diagonal().is_some()
        && let Some(compliance) = parts.ground.diagonal_compliance()?
    {
        let quantity = "diagonal static compliance of the ground";
        let diagonal = bed_compliance::inside(quantity, compliance.at_rest, &parts.elements)?;
        return Ok(CompressedMatrix::of_diagonal(diagonal));
    }
    let mut soil = vec![0.0; parts.elements.layout().square()];
    parts.ground.static_compliance(&mut soil)?;
    parts.elements.refer_inside(&mut soil);
    Ok(CompressedMatrix::dense(soil))
}

/// Weight and loads at t = 0; empty without a static state.
pub(crate) fn weight_and_load(parts: &Parts, assembled: &Assembled) -> Result<[Vec<f64>; 2]> {
    if !parts.builder.is_static() {
        return Ok([vec![], vec![]]);
    }
    loads(parts, assembled).map(|loads| [loads.weight, loads.load])
}

/// Forces on the degrees of freedom at t = 0, N.
struct Loads {
    /// Load that the structure brings.
    of_structure: Vec<f64>,
    /// Weight with the loads that come on with it.
    weight: Vec<f64>,
    /// All other loads.
    load: Vec<f64>,
}

/// The forces at t = 0.
fn loads(parts: &Parts, assembled: &Assembled) -> Result<Loads> {
    let Parts { structure, builder, .. } = parts;
    let n = assembled.dofs();
    let mut of_structure = vec![0.0; n];
    structure.load(0.0, &mut of_structure)?;
    all_finite("load of the structure at t = 0", &of_structure)?;
    let mut load = of_structure.clone();
    let mut weight = vec![0.0; n];
    let up = assembled.influence.of(UPWARD_DIRECTION, n);
    assembled.mass.multiply_add(-builder.gravity, &up, &mut weight);
    for external in &builder.loads {
        let force = external.value(0.0);
        let total = if external.is_weight() { &mut weight } else { &mut load };
        external.row().iter().for_each(|&(i, factor)| total[i] += force * factor);
    }
    all_finite("weight", &weight)?;
    all_finite("load at t = 0", &load)?;
    Ok(Loads { of_structure, weight, load })
}

/// The state under weight and loads at t = 0 on elements of this static compliance, with these laws.
///
/// The structure's internal variables stay unchanged. `shared`: the structure's compliance on them, if it is known.
pub(crate) fn under_loads(
    parts: &Parts,
    assembled: &Assembled,
    (soil, shared): (&CompressedMatrix, &RefCell<Option<Compliance>>),
    laws: &[Box<dyn InterfaceLaw>],
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let Parts { structure, builder, .. } = parts;
    let stage = Standing {
        assembled,
        structure: structure.as_ref(),
        soil,
        frictionless: false,
        offset: &[],
        shared,
    };
    let walls = parts.elements.has_walls() && !is_fixed_base(parts.ground.as_ref());
    if walls && builder.gravity_stage != GravityStage::WishedInPlace {
        backfilled::state(parts, &stage, laws, [weight, load])
    } else {
        let mut offset = vec![];
        if walls {
            // Jumps are zero under the tractions of the soil at rest.
            let traction = backfilled::at_rest(parts, assembled.base.elements(), true)?;
            offset = vec![0.0; traction.len()];
            dense_multiply_add(soil, -1.0, &traction, &mut offset);
        }
        let stage = Standing { offset: &offset, ..stage };
        let placed = placed(&stage, laws, builder.gravity_stage, weight)?;
        loaded(&stage, laws, placed, [weight, load])
    }
}
