//! One case: the scene, its run, and what is kept of it.

use basemat::Simulation;
use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{Probe, Run};
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::motion::Record;
use basemat::structure::Structure;
use basemat::sweep::SweepCase;

use super::AnyError;
use super::containment::FOOT;
use super::options::Options;

/// What the interface does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Bonded,
    Coulomb(f64),
}

/// One row of the table.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) kind: Kind,
}

impl Case {
    /// Bonded, uplift only, then one case per friction coefficient.
    pub(crate) fn list(friction: &[f64]) -> Vec<Self> {
        let mut cases = vec![
            Self { name: "bonded".into(), kind: Kind::Bonded },
            Self { name: "uplift only".into(), kind: Kind::Coulomb(f64::INFINITY) },
        ];
        cases.extend(
            friction
                .iter()
                .map(|&f| Self { name: format!("friction {f}"), kind: Kind::Coulomb(f) }),
        );
        cases
    }
}

/// Histories at every step.
#[derive(Debug, Default)]
pub(crate) struct Histories {
    pub(crate) time: Vec<f64>,
    /// Absolute displacement at A, a roof corner, m.
    pub(crate) roof: Vec<[f64; 2]>,
    /// Horizontal force of the superstructure on the foundation, N/m.
    pub(crate) shear: Vec<f64>,
    /// The same if the superstructure moved as the foundation's top does, N/m.
    pub(crate) rigid_shear: Vec<f64>,
    /// Horizontal force of the base on the soil, N/m.
    pub(crate) contact_shear: Vec<f64>,
    pub(crate) base_moment: Vec<f64>,
    pub(crate) normal_force: Vec<f64>,
    pub(crate) uplifted_fraction: Vec<f64>,
    pub(crate) mean_slip: Vec<f64>,
    pub(crate) modes: Vec<Vec<Mode>>,
}

/// A case that has run.
pub(crate) struct Outcome {
    pub(crate) case: Case,
    pub(crate) run: Run,
    pub(crate) histories: Histories,
    /// Largest base shear at the foundation–superstructure interface, N/m.
    pub(crate) peak_shear: f64,
    /// Largest displacement of the roof corner relative to the free field's start, m.
    pub(crate) peak_roof: f64,
    /// Largest rise of the roof corner, m.
    pub(crate) peak_lift: f64,
    /// Largest horizontal displacement of the roof corner against the base, m.
    pub(crate) peak_sway: f64,
    /// Contact length, m.
    pub(crate) width: f64,
}

/// Builds the scene of `case` and runs it.
pub(crate) fn run(
    case: &Case,
    options: &Options,
    record: &Record,
    steps: usize,
    now: &SweepCase<'_>,
) -> Result<Outcome, AnyError> {
    let scene = options.containment();
    let model = scene.structure()?;
    let [left, roof] = scene.corner();
    let corner = model.node_at(left, roof)?;
    let base_shear = scene.base_shear(&model)?;
    let roof_x = model.row(corner, basemat::fem::Direction::X)?;
    let roof_y = model.row(corner, basemat::fem::Direction::Y)?;

    let top = scene.foundation_top(&model)?;
    let base_nodes: Vec<_> =
        model.contact_nodes().iter().flat_map(|node| node.horizontal.terms().to_vec()).collect();
    let share = 1.0 / base_nodes.len() as f64;
    let base: Vec<_> = base_nodes.into_iter().map(|(unknown, w)| (unknown, -share * w)).collect();
    let mut sway = roof_x.terms().to_vec();
    sway.extend(base);

    let builder = Simulation::builder(options.time_step_s())
        .structure(model)
        // Equal elements, as in the paper.
        .ground(ElasticGround::new(scene.soil()?, Strip::uniform(scene.base(), scene.elements)?)?)
        .motion(record.clone())
        .expected_steps(steps)
        .probe(Probe::absolute_displacement("roof x", roof_x))
        .probe(Probe::absolute_displacement("roof y", roof_y))
        .probe(base_shear)
        .probe(Probe::acceleration("foundation", top))
        .probe(Probe::displacement("sway", sway))
        .serviceability(options.limits()?);
    let mut simulation = match case.kind {
        Kind::Bonded => builder.interface(Bonded),
        Kind::Coulomb(friction) => builder.interface(Coulomb::new(friction)?),
    }
    .build()?;

    let mut kept = Histories::default();
    let run = simulation.run(steps, |state| {
        kept.time.push(state.time);
        kept.roof.push([state.probes[0], state.probes[1]]);
        kept.shear.push(state.probes[2]);
        kept.rigid_shear.push(-scene.superstructure_mass() * state.probes[3]);
        kept.contact_shear.push(state.base_shear);
        kept.base_moment.push(state.base_moment);
        kept.normal_force.push(state.normal_force);
        kept.uplifted_fraction.push(state.uplifted_fraction);
        kept.mean_slip.push(state.mean_slip);
        kept.modes.push(state.modes.clone());
        if state.step % 256 == 0 {
            now.report(state.step as f64 / steps as f64);
        }
    })?;
    Ok(Outcome {
        case: case.clone(),
        peak_shear: run.probe("base shear")?.magnitude(),
        peak_roof: run.probe("roof x")?.magnitude(),
        peak_lift: run.probe("roof y")?.highest.value,
        peak_sway: run.probe("sway")?.magnitude(),
        run,
        histories: kept,
        width: scene.width * FOOT,
    })
}
