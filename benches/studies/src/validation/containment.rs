//! The containment of Patel & Spyrakos: peaks of base shear against their printed table.

use basemat::motion::el_centro_1940;
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case as Validation, Check, Outcome, worse};
use crate::AnyError;
use crate::containment::case::{Case, Outcome as Computed};
use crate::containment::run_all;
use crate::figure::{BLUE, Figure, Panel, RED};
use basemat_problems::containment::{
    Containment, PAPER_SHEARS as PAPER, POUND_FORCE_PER_FOOT, ROWS,
};

pub(crate) const CASE: Validation = Validation {
    name: "containment",
    title: "The containment of Patel & Spyrakos",
    reference: "the paper's Table 1; the dimensions are calibrated on its rows bonded and uplift only",
    settings: "10 uniform elements, Δt = 1.31 ms, El Centro",
    run,
};

fn run(short: bool) -> Result<Outcome, AnyError> {
    let duration = if short { 12.0 } else { el_centro_1940().duration() };
    let computed = run_all(&Case::list(&[0.4, 0.3, 0.2]), Containment::default(), duration)?;
    let shear: Vec<f64> =
        computed.iter().map(|outcome| outcome.peak_shear / POUND_FORCE_PER_FOOT).collect();
    let energy_balance =
        computed.iter().fold(0.0_f64, |m, outcome| worse(m, outcome.run.energy_error));
    let mut checks = vec![
        Check::below(
            "bonded: peak base shear, relative (calibrated)",
            (shear[0] / PAPER[0] - 1.0).abs(),
            1e-2,
        ),
        Check::below(
            "uplift only: peak base shear, relative (calibrated)",
            (shear[1] / PAPER[1] - 1.0).abs(),
            4e-2,
        ),
    ];
    let ratios = [(2, 0.4, 0.68..=0.74), (3, 0.3, 0.61..=0.67), (4, 0.2, 0.47..=0.52)];
    for (k, friction, range) in ratios {
        let ratio = shear[k] / shear[0];
        let paper = PAPER[k] / PAPER[0];
        let name =
            format!("friction {friction}: shear over bonded (no reference; paper {paper:.3})");
        checks.push(Check::within(name, ratio, range));
    }
    checks.push(Check::below("energy balance, residual", energy_balance, 1e-9));

    let points = |outcome: &Computed| -> Result<Vec<_>, AnyError> {
        let shear = outcome.curve("base shear", 1e-3)?.into_iter();
        Ok(shear.take_while(|(time, _)| *time <= 12.0).collect())
    };
    let left = Panel::new("time, s", "base shear, kN/m")
        .room(0.05, 0.3)
        .line("bonded", RED, points(&computed[0])?)
        .line("uplift only", BLUE, points(&computed[1])?);
    let numbered = |values: &[f64]| {
        values.iter().enumerate().map(|(k, v)| (k as f64, v * 1e-3)).collect::<Vec<_>>()
    };
    let right = Panel::new("interface", "peak base shear, 1000 lb/ft")
        .legend(SeriesLabelPosition::UpperRight)
        .categories(&ROWS.map(|(name, _)| name))
        .room(0.1, 0.1)
        .crosses("Patel & Spyrakos, Table 1", RED, numbered(&PAPER))
        .circles("basemat", BLUE, numbered(&shear));
    let title = "Containment on El Centro 1940 NS: base shear above the foundation";
    Ok(Outcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}
