//! A flexible cantilever of finite elements on a rigid base, under a vertically incident SV pulse.

use basemat::coupled::State;

use super::outcome::{Case, Outcome};
use super::transient::{Quantity, base_motion, checks, histories, moment, panel, rotation, shear};
use crate::AnyError;
use crate::figure::Figure;
use basemat_problems::tabled_structures::Cantilever;

pub(crate) const CASE: Case = Case {
    name: "cantilever",
    title: "Cantilever on the strip",
    reference: "exact beam functions in the frequency domain",
    settings: "8 beams, 16 cosine-graded elements, Δt = 0.05 b/c_S, bonded, ν = 1/3",
    run,
};

fn run(_short: bool) -> Result<Outcome, AnyError> {
    let cantilever = Cantilever::new(8);
    let top = cantilever.top();
    let tip = move |state: &State| state.absolute_displacement()[top];
    // What the base of mass 1 does not take itself.
    let beam_shear = |state: &State| -state.base_shear - state.acceleration()[0];
    let (found, ledger) = histories(
        "td_EBcantilever_SV_nu0333.csv",
        cantilever,
        1.0 / 3.0,
        &[
            Quantity::at_end("u_base", "base displacement", &base_motion, 3.6e-3),
            Quantity::at_end("theta", "rotation", &rotation, 6.5e-3),
            Quantity::at_end("u_top", "top displacement", &tip, 5.7e-3),
            Quantity::mean("V_beam", "shear at the beam's foot", &beam_shear, 3.4e-3),
            Quantity::mean("V", "base shear", &shear, 3e-3),
            Quantity::mean("M", "base moment", &moment, 1.25e-2),
        ],
    )?;
    let units = [" / A", " b / A", " / A", " / (μ A)", " / (μ A)", " / (μ A b)"];
    let panels = [0, 2, 3, 5].map(|k| panel(&found[k], units[k]));
    let title = "Euler–Bernoulli cantilever of height 4b on a massive rigid base, ν = 1/3";
    let figure = Figure::new(title, 2, panels.into());
    Ok(Outcome { checks: checks(&found, ledger), figure })
}
