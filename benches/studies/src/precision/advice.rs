//! What [`basemat::coupled::advise`] proposes, and the error that it gives.

use basemat::coupled::{Advice, Outline, advise};
use basemat::motion::{FrequencyContent, Record, el_centro_1940};
use indicatif::ProgressBar;

use super::catalogue::{CONTAINMENT_STEP, TABLES, building, containment};
use super::force::{Errors, Force};
use super::scene::Scene;
use super::settings::{Past, Settings};
use crate::AnyError;
use basemat::bem::Grading;

/// Seconds of El Centro.
const CUT: f64 = 5.0;

/// A tolerance, the advice for it, and what came of it.
pub(crate) struct Checked {
    pub(crate) scene: &'static str,
    pub(crate) advice: Advice,
    pub(crate) errors: Errors,
    /// Processor time, s.
    pub(crate) seconds: f64,
}

/// A scene with its reference, outline and content.
struct Case {
    scene: Scene,
    reference: Force,
    outline: Outline,
    content: FrequencyContent,
    tolerances: &'static [f64],
}

/// Advice on scenes with references, none of which it was tuned on.
pub(crate) fn check(short: bool, bar: &ProgressBar) -> Result<Vec<Checked>, AnyError> {
    let mut cases = Vec::new();
    let tolerances: &[f64] = if short { &[0.1, 0.03] } else { &[0.1, 0.03, 0.01, 0.003, 0.001] };
    for table in &TABLES {
        let (scene, reference) = table.open()?;
        let (outline, content) = (table.outline()?, ricker_content()?);
        cases.push(Case { scene, reference, outline, content, tolerances });
    }
    if !short {
        cases.extend(records()?);
    }
    bar.inc_length(cases.iter().map(|case| case.tolerances.len() as u64).sum());
    let mut list = Vec::new();
    for case in cases {
        for &tolerance in case.tolerances {
            let advice = advise(case.scene.soil, &case.outline, &case.content, tolerance)?;
            let history = Past::of(advice.history);
            let settings = Settings::new(advice.elements, advice.grading, advice.time_step);
            let settings = Settings { history, ..settings };
            let outcome = case.scene.run(&settings)?;
            let errors = outcome.force.errors(&case.reference);
            let seconds = outcome.seconds;
            list.push(Checked { scene: case.scene.name, advice, errors, seconds });
            bar.inc(1);
        }
    }
    Ok(list)
}

/// Scenes under the first seconds of El Centro. References are runs fine enough by the advice's
/// own model, with a quarter of the error of the strictest tolerance or less.
fn records() -> Result<Vec<Case>, AnyError> {
    let record = el_centro_1940();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let samples = (CUT / record.time_step()).round() as usize + 1;
    let cut = Record::new(record.time_step(), record.accelerations()[..samples].to_vec())?;
    let content = FrequencyContent::of(&cut)?;
    let case = |scene: Scene, outline, fine: (usize, f64)| {
        let reference = scene.run(&Settings::new(fine.0, Grading::Cosine, fine.1))?.force;
        let (content, tolerances) = (content.clone(), &[0.1, 0.03, 0.01][..]);
        Ok::<_, AnyError>(Case { scene, reference, outline, content, tolerances })
    };
    // Mass of the containment, and twice the height of its centre of gravity.
    let containment_outline = Outline::new(4.572, 8.28, 19.6e3)?;
    let fine = (64, 0.5 * CONTAINMENT_STEP);
    Ok(vec![
        case(
            building(CUT)?,
            Outline::new(10.0, 15.0, 150.0e3)?.with_frequency(2.026, 0.05)?,
            (64, 5e-4),
        )?,
        case(containment("containment, bonded", None, CUT)?, containment_outline, fine)?,
        case(containment("containment, friction 0.4", Some(0.4), CUT)?, containment_outline, fine)?,
    ])
}

/// Content of the tables' pulse u = (1 − 2q) e^(−q), q = (t − 5)².
fn ricker_content() -> basemat::Result<FrequencyContent> {
    let step = 0.02;
    let samples = (0..=500).map(|k| {
        let q = (f64::from(k) * step - 5.0).powi(2);
        (-8.0 * q * q + 24.0 * q - 6.0) * (-q).exp()
    });
    FrequencyContent::of(&Record::new(step, samples.collect())?)
}
