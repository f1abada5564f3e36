//! Largest step and smallest damping with which the paper's scheme reaches the end of the record.
//!
//! The table also states the peaks and differences with this step or damping.

use basemat::contact::ContactSearch;

use super::case::{MarchEnd, MarchOutcome, march};
use super::report::growth_of;
use super::scheme::{ComparedScheme, PaperScene};
use crate::AnyError;
use basemat_problems::containment::{
    Containment, PAPER_SHEARS, POUND_FORCE_PER_FOOT, TABLE_1_ROWS, pounds_per_foot,
};

/// A change of the scheme.
#[derive(Clone, Copy)]
enum SchemeChange {
    /// β = c₁Δt/l.
    Step(f64),
    /// Damping ratio of the structure at 1 and 10 Hz.
    Damping(f64),
    /// Newmark's γ.
    Gamma(f64),
}

impl SchemeChange {
    fn name(self) -> String {
        match self {
            Self::Step(beta) => format!("β = {beta}"),
            Self::Damping(ratio) => format!("damping {ratio}"),
            Self::Gamma(gamma) => format!("γ = {gamma}"),
        }
    }

    fn scene(self, scene: &PaperScene, search: ContactSearch) -> PaperScene {
        let mut changed = PaperScene {
            containment: scene.containment,
            record: scene.record.clone(),
            time_step: scene.time_step,
            free: scene.free,
            subelements: scene.subelements,
            ratio: scene.ratio,
            gamma: scene.gamma,
            search,
        };
        match self {
            Self::Step(beta) => changed.time_step = scene.containment.time_step(beta),
            Self::Damping(ratio) => {
                changed.containment = Containment { damping: ratio, ..scene.containment };
            }
            Self::Gamma(gamma) => changed.gamma = gamma,
        }
        changed
    }
}

/// Root mean square difference from `reference`, relative to the root mean square of `reference`.
///
/// `reference` is interpolated at the times of the outcome.
fn relative_difference(outcome: &MarchOutcome, reference: &MarchOutcome) -> f64 {
    let mut difference = 0.0;
    let mut scale = 0.0;
    for (k, shear) in outcome.shear.iter().enumerate() {
        let position = (k + 1) as f64 * outcome.time_step / reference.time_step - 1.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
        let first = position.max(0.0) as usize;
        let Some([a, b]) = reference.shear.get(first..first + 2) else { break };
        let expected = a + (b - a) * (position - first as f64);
        difference += (shear - expected).powi(2);
        scale += expected * expected;
    }
    (difference / scale).sqrt()
}

fn step_count(scene: &PaperScene, duration: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "zero if not")]
    let steps = (duration / scene.time_step).round() as usize;
    steps
}

/// Prints the table of steps and dampings for the rows with contact.
pub(crate) fn print(scene: &PaperScene, duration: f64, short: bool) -> Result<(), AnyError> {
    let limit = 1e6 * PAPER_SHEARS[0] * POUND_FORCE_PER_FOOT;
    let rows = &TABLE_1_ROWS[1..];
    let mut references = Vec::new();
    for &(_, friction) in rows {
        let steps = step_count(scene, duration);
        references.push(march(|| ComparedScheme::HalfPlane.build(scene, friction), steps, limit)?);
    }
    let mut changes: Vec<SchemeChange> = if short {
        [0.5, 2.0].map(SchemeChange::Step).to_vec()
    } else {
        [0.25, 0.5, 0.6, 0.75, 0.9, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0]
            .map(SchemeChange::Step)
            .to_vec()
    };
    if !short {
        changes.extend([0.02, 0.05, 0.1, 0.2, 0.5, 0.6, 0.7, 0.8, 1.0].map(SchemeChange::Damping));
        changes.extend([0.6, 0.8, 1.0, 1.5].map(SchemeChange::Gamma));
    }
    println!(
        "\nThe paper's scheme with contact: growth per step of its soil; for each row the end (flow \
         chart / robust search), the peak, lb/ft, and the root mean square difference from the \
         half-plane under the same interface at β = ½\n"
    );
    print!("| change | base held | base open |");
    for (name, _) in rows {
        print!(" {name} |");
    }
    println!("\n|---|---|---|---|---|---|---|");
    for change in changes {
        let flow_chart = change.scene(scene, ContactSearch::FlowChart { iterations: 100 });
        let smallest = 1.0 / step_count(&flow_chart, duration) as f64;
        let ground = ComparedScheme::Paper.full_plane(&flow_chart)?;
        // With the base open, and bonded.
        let states = ground.assess(flow_chart.time_step, smallest)?;
        print!("| {} | {} | {} |", change.name(), growth_of(&states[1]), growth_of(&states[0]));
        for (&(_, friction), reference) in rows.iter().zip(&references) {
            let robust = change.scene(scene, ContactSearch::Robust);
            let mut outcomes = Vec::new();
            for scene in [&flow_chart, &robust] {
                let steps = step_count(scene, duration);
                outcomes.push(march(|| ComparedScheme::Paper.build(scene, friction), steps, limit));
            }
            let mut cells = Vec::new();
            for outcome in outcomes {
                cells.push(match outcome {
                    Err(error) => format!("{error}"),
                    Ok(outcome) if outcome.end == MarchEnd::Record => {
                        let peak = pounds_per_foot(outcome.peak(usize::MAX));
                        // A run that grows slowly may still reach the end.
                        if peak > 3.0 * PAPER_SHEARS[0] {
                            "grows".to_owned()
                        } else {
                            format!(
                                "{peak:.0}, {:.0} %",
                                100.0 * relative_difference(&outcome, reference)
                            )
                        }
                    }
                    Ok(outcome) => {
                        let cause = if outcome.end == MarchEnd::Grew { "grows" } else { "cycles" };
                        format!("{cause} to {:.2} s", outcome.time())
                    }
                });
            }
            print!(" {} |", cells.join(" / "));
        }
        println!();
    }
    Ok(())
}
