//! Largest step and least damping with which the paper's scheme lasts the record with contact,
//! and what that costs.

use basemat::contact::ContactSearch;

use super::case::{End, Outcome, march};
use super::report::growth_of;
use super::scheme::{Scene, Scheme};
use crate::AnyError;
use basemat_problems::containment::{
    Containment, PAPER_SHEARS, POUND_FORCE_PER_FOOT, ROWS, pounds_per_foot,
};

/// A change of the scheme.
#[derive(Clone, Copy)]
enum Change {
    /// β = c₁Δt/l.
    Step(f64),
    /// Damping ratio of the structure at 1 and 10 Hz.
    Damping(f64),
    /// Newmark's γ.
    Gamma(f64),
}

impl Change {
    fn name(self) -> String {
        match self {
            Self::Step(beta) => format!("β = {beta}"),
            Self::Damping(ratio) => format!("damping {ratio}"),
            Self::Gamma(gamma) => format!("γ = {gamma}"),
        }
    }

    fn scene(self, scene: &Scene, search: ContactSearch) -> Scene {
        let mut changed = Scene {
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

/// Root mean square difference from `other`, relative to the root mean square of `other`, at its
/// times.
fn apart(outcome: &Outcome, other: &Outcome) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (k, shear) in outcome.shear.iter().enumerate() {
        let place = (k + 1) as f64 * outcome.time_step / other.time_step - 1.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
        let first = place.max(0.0) as usize;
        let (Some(a), Some(b)) = (other.shear.get(first), other.shear.get(first + 1)) else {
            break;
        };
        let known = a + (b - a) * (place - first as f64);
        difference += (shear - known).powi(2);
        size += known * known;
    }
    (difference / size).sqrt()
}

/// Table of steps and dampings, rows with contact.
pub(crate) fn print(scene: &Scene, duration: f64, short: bool) -> Result<(), AnyError> {
    let limit = 1e6 * PAPER_SHEARS[0] * POUND_FORCE_PER_FOOT;
    let steps = |scene: &Scene| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "zero if not")]
        let steps = (duration / scene.time_step).round() as usize;
        steps
    };
    let rows = || ROWS.into_iter().skip(1);
    let reference: Vec<Outcome> = rows()
        .map(|(_, friction)| {
            march(|| Scheme::HalfPlane.build(scene, friction), steps(scene), limit)
        })
        .collect::<Result<_, _>>()?;
    let mut changes: Vec<Change> = if short {
        [0.5, 2.0].map(Change::Step).to_vec()
    } else {
        [0.25, 0.5, 0.6, 0.75, 0.9, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0].map(Change::Step).to_vec()
    };
    if !short {
        changes.extend([0.02, 0.05, 0.1, 0.2, 0.5, 0.6, 0.7, 0.8, 1.0].map(Change::Damping));
        changes.extend([0.6, 0.8, 1.0, 1.5].map(Change::Gamma));
    }
    println!(
        "\nThe paper's scheme with contact: growth per step of its soil; for each row the end (flow \
         chart / robust search), the peak, lb/ft, and the root mean square difference from the \
         half-plane under the same interface at β = ½\n"
    );
    print!("| change | base held | base open |");
    rows().for_each(|(name, _)| print!(" {name} |"));
    println!("\n|---|---|---|---|---|---|---|");
    for change in changes {
        let flow_chart = change.scene(scene, ContactSearch::FlowChart { iterations: 100 });
        let smallest = 1.0 / steps(&flow_chart) as f64;
        let ground = Scheme::Paper.full_plane(&flow_chart)?;
        let [open, held] = ground.assess(flow_chart.time_step, smallest)?;
        let growth = [&held, &open].map(growth_of);
        print!("| {} | {} | {} |", change.name(), growth[0], growth[1]);
        for ((_, friction), reference) in rows().zip(&reference) {
            let robust = change.scene(scene, ContactSearch::Robust);
            let mut outcomes = Vec::new();
            for scene in [&flow_chart, &robust] {
                outcomes.push(march(|| Scheme::Paper.build(scene, friction), steps(scene), limit));
            }
            let mut cells = Vec::new();
            for outcome in outcomes {
                cells.push(match outcome {
                    Err(error) => format!("{error}"),
                    Ok(outcome) if outcome.end == End::Record => {
                        let peak = pounds_per_foot(outcome.peak(usize::MAX));
                        // A run that grows slowly may still reach the end.
                        if peak > 3.0 * PAPER_SHEARS[0] {
                            "grows".to_owned()
                        } else {
                            format!("{peak:.0}, {:.0} %", 100.0 * apart(&outcome, reference))
                        }
                    }
                    Ok(outcome) => {
                        let why = if outcome.end == End::Grew { "grows" } else { "cycles" };
                        format!("{why} to {:.2} s", outcome.time())
                    }
                });
            }
            print!(" {} |", cells.join(" / "));
        }
        println!();
    }
    Ok(())
}
