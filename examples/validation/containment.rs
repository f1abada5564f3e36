//! The containment of Patel & Spyrakos: peaks of base shear against their printed table.

use basemat::Sweep;
use clap::Parser;
use plotters::prelude::SeriesLabelPosition;

use super::AnyError;
use super::chart::{BLUE, Figure, Panel, RED};
use super::outcome::{Case as Validation, Check, Outcome, worse};
use super::paper::case::{self, Case, Outcome as Computed};
use super::paper::containment::{PAPER_SHEARS as PAPER, POUND_FORCE_PER_FOOT};
use super::paper::options::Options;

pub(crate) const CASE: Validation = Validation {
    name: "containment",
    title: "The containment of Patel & Spyrakos",
    reference: "the paper's Table 1; the dimensions are calibrated on its rows bonded and uplift only",
    settings: "10 uniform elements, Δt = 1.31 ms, El Centro",
    run,
};

fn run(short: bool) -> Result<Outcome, AnyError> {
    let duration: &[&str] = if short { &["--duration", "12"] } else { &[] };
    let options = Options::try_parse_from([&["containment"], duration].concat())?;
    let record = options.record()?;
    let steps = options.steps(&record);
    let cases = Case::list(&options.friction);
    let mut results: Vec<_> = cases.iter().map(|_| None).collect();
    Sweep::new(cases.len()).run(
        |now| case::run(&cases[now.index()], &options, &record, steps, now),
        |k, outcome| results[k] = Some(outcome),
    );
    let mut computed = Vec::new();
    for result in results {
        computed.push(result.ok_or("a run did not end")??);
    }
    let shear: Vec<f64> =
        computed.iter().map(|outcome| outcome.peak_shear / POUND_FORCE_PER_FOOT).collect();
    let ledger = computed.iter().fold(0.0_f64, |m, outcome| worse(m, outcome.run.ledger_residual));
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
    checks.push(Check::below("energy ledger, residual", ledger, 1e-9));

    let points = |outcome: &Computed| {
        let each = outcome.histories.time.iter().zip(&outcome.histories.shear);
        let each = each.take_while(|(time, _)| **time <= 12.0);
        each.map(|(time, shear)| (*time, 1e-3 * shear)).collect::<Vec<_>>()
    };
    let left = Panel::new("time, s", "base shear, kN/m")
        .room(0.05, 0.3)
        .line("bonded", RED, points(&computed[0]))
        .line("uplift only", BLUE, points(&computed[1]));
    let numbered = |values: &[f64]| {
        values.iter().enumerate().map(|(k, v)| (k as f64, v * 1e-3)).collect::<Vec<_>>()
    };
    let right = Panel::new("interface", "peak base shear, 1000 lb/ft")
        .legend(SeriesLabelPosition::UpperRight)
        .categories(&["bonded", "uplift only", "friction 0.4", "friction 0.3", "friction 0.2"])
        .room(0.1, 0.1)
        .crosses("Patel & Spyrakos, Table 1", RED, numbered(&PAPER))
        .circles("basemat", BLUE, numbered(&shear));
    let title = "Containment on El Centro 1940 NS: base shear above the foundation";
    Ok(Outcome { checks, figure: Figure::new(title, 2, vec![left, right]) })
}
