//! Energy balance of random flexible structures that lift off and slide.

use basemat_problems::flexible_scenes::FlexibleSceneTotals;

use crate::AnyError;

/// Number of scenes, fewer for continuous integration.
const SCENE_COUNTS: [usize; 2] = [200, 4];

/// Runs the scenes and returns their table for the documents.
pub(super) fn run(short: bool) -> Result<String, AnyError> {
    let mut outcome = FlexibleSceneTotals::default();
    for number in 0..SCENE_COUNTS[usize::from(short)] {
        outcome.run(number);
        if number % 20 == 19 {
            println!("{} scenes: energy error {:.1e}", number + 1, outcome.residual);
        }
    }
    for reason in &outcome.errors {
        println!("{reason}");
    }
    let FlexibleSceneTotals {
        scenes,
        steps,
        reduced,
        open_steps,
        sliding_steps,
        errors,
        residual,
        returned_energy,
    } = &outcome;
    let text = format!(
        "| random scenes | in other coordinates | not run | steps | with an open cell | with a cell that slides | largest \
         energy error | energy returned by the soil |\n|---|---|---|---|---|---|---|---|\n\
         | {scenes} | {reduced} | {} | {steps} | {open_steps} | {sliding_steps} | {residual:.1e} | {returned_energy:.1e} |",
        errors.len()
    );
    println!("{text}");
    if errors.len() > scenes / 5 {
        return Err(format!("{} of {scenes} random scenes were not run", errors.len()).into());
    }
    Ok(text)
}
