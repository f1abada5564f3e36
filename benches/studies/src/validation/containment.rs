//! The containment of Patel & Spyrakos: peaks of base shear against their printed table.

use basemat::motion::el_centro_1940;
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::containment::case::{ContainmentCase, ContainmentOutcome};
use crate::containment::run_all;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::containment::{
    Containment, PAPER_SHEARS, POUND_FORCE_PER_FOOT, TABLE_1_ROWS,
};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "containment",
    title: "The containment of Patel & Spyrakos",
    reference: "the paper's Table 1; the dimensions are calibrated on its rows bonded and uplift only",
    settings: "10 uniform elements, Δt = 1.31 ms, El Centro",
    run,
};

/// Base shear of the first 12 s, kN/m.
fn shear_curve(outcome: &ContainmentOutcome) -> Result<Vec<(f64, f64)>, AnyError> {
    let shear = outcome.curve("base shear", 1e-3)?.into_iter();
    Ok(shear.take_while(|(time, _)| *time <= 12.0).collect())
}

/// Points of values in thousands over the number of their row.
fn by_row(values: &[f64]) -> Vec<(f64, f64)> {
    values.iter().enumerate().map(|(k, value)| (k as f64, value * 1e-3)).collect()
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let duration = if short { 12.0 } else { el_centro_1940().duration() };
    let computed =
        run_all(&ContainmentCase::list(&[0.4, 0.3, 0.2]), Containment::default(), duration)?;
    let shear: Vec<f64> =
        computed.iter().map(|outcome| outcome.peak_shear / POUND_FORCE_PER_FOOT).collect();
    let energy_balance = computed
        .iter()
        .fold(0.0_f64, |worst, outcome| worse(worst, outcome.run.energy_error));
    let mut checks = vec![
        ValidationCheck::below(
            "bonded: peak base shear, relative (calibrated)",
            (shear[0] / PAPER_SHEARS[0] - 1.0).abs(),
            1e-2,
        ),
        ValidationCheck::below(
            "uplift only: peak base shear, relative (calibrated)",
            (shear[1] / PAPER_SHEARS[1] - 1.0).abs(),
            4e-2,
        ),
    ];
    let ratios = [(2, 0.4, 0.68..=0.74), (3, 0.3, 0.61..=0.67), (4, 0.2, 0.47..=0.52)];
    for (k, friction, range) in ratios {
        let ratio = shear[k] / shear[0];
        let paper = PAPER_SHEARS[k] / PAPER_SHEARS[0];
        let name =
            format!("friction {friction}: shear over bonded (no reference; paper {paper:.3})");
        checks.push(ValidationCheck::within(name, ratio, range));
    }
    checks.push(ValidationCheck::below("energy balance, residual", energy_balance, 1e-9));

    let left = FigurePanel::new("time, s", "base shear, kN/m")
        .room(0.05, 0.3)
        .line("bonded", CURVE_RED, shear_curve(&computed[0])?)
        .line("uplift only", CURVE_BLUE, shear_curve(&computed[1])?);
    let right = FigurePanel::new("interface", "peak base shear, 1000 lb/ft")
        .legend(SeriesLabelPosition::UpperRight)
        .categories(&TABLE_1_ROWS.map(|(name, _)| name))
        .room(0.1, 0.1)
        .crosses("Patel & Spyrakos, Table 1", CURVE_RED, by_row(&PAPER_SHEARS))
        .circles("basemat", CURVE_BLUE, by_row(&shear));
    let title = "Containment on El Centro 1940 NS: base shear above the foundation";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}
