//! The table on the screen, and the CSV files.

use std::path::Path;

use super::AnyError;
use super::case::{Kind, Outcome};
use super::conclusions::rigid_difference;
use super::containment::{PAPER_SHEARS, pounds_per_foot};

/// Peak base shear of the paper's Table 1, lb/ft, for the cases it has.
fn paper_shear(kind: Kind) -> Option<f64> {
    let row = match kind {
        Kind::Bonded => 0,
        Kind::Coulomb(f64::INFINITY) => 1,
        Kind::Coulomb(0.4) => 2,
        Kind::Coulomb(0.3) => 3,
        Kind::Coulomb(0.2) => 4,
        Kind::Coulomb(_) => return None,
    };
    Some(PAPER_SHEARS[row])
}

/// Prints the table of all cases beside the paper's ratios.
pub(crate) fn print_table(results: &[Outcome]) {
    let bonded = results.first().map_or(1.0, |outcome| outcome.peak_shear);
    println!(
        "\n{:<14}{:>22}{:>12}{:>16}{:>9}{:>10}{:>10}{:>10}{:>10}{:>9}{:>9}",
        "",
        "shear at foundation",
        "under base",
        "ratio  (paper)",
        "uplift",
        "slip",
        "residual",
        "roof",
        "ledger",
        "run",
        "step"
    );
    println!(
        "{:<14}{:>11}{:>11}{:>12}{:>7}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}{:>9}{:>9}",
        "case", "kN/m", "lb/ft", "kN/m", "", "", "%", "mm", "mm", "mm", "", "s", "µs"
    );
    for outcome in results {
        let run = &outcome.run;
        let paper = paper_shear(outcome.case.kind)
            .map_or_else(|| "–".to_owned(), |shear| format!("({:.3})", shear / PAPER_SHEARS[0]));
        println!(
            "{:<14}{:>11.1}{:>11.0}{:>12.1}{:>8.3}{:>8}{:>9.0}{:>10.3}{:>10.3}{:>10.2}{:>10.1e}{:>9.1}{:>9.1}",
            outcome.case.name,
            1e-3 * outcome.peak_shear,
            pounds_per_foot(outcome.peak_shear),
            1e-3 * run.whole.base_shear.magnitude(),
            outcome.peak_shear / bonded,
            paper,
            100.0 * run.whole.uplifted_fraction.largest().value,
            1e3 * run.whole.largest_slip.magnitude(),
            1e3 * run.whole.residual_slip + 0.0,
            1e3 * outcome.peak_roof,
            run.ledger_residual,
            run.wall.as_secs_f64(),
            1e6 * run.wall.as_secs_f64() / run.steps.max(1) as f64,
        );
    }
    println!(
        "ratio: shear at the foundation over that of the bonded case; (paper): the same ratio of the \
         printed Table 1. The default length and height are calibrated on its bonded and uplift-only \
         rows: only the sliding rows can be judged by it"
    );
    for outcome in results {
        for warning in &outcome.run.warnings {
            println!("{}: {warning}", outcome.case.name);
        }
    }
}

/// Writes `summary.csv`, a row per case.
pub(crate) fn write_summary(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    let bonded = results.first().map_or(1.0, |outcome| outcome.peak_shear);
    let mut writer = csv::Writer::from_path(folder.join("summary.csv"))?;
    writer.write_record([
        "case",
        "friction",
        "peak_base_shear_n_per_m",
        "peak_contact_shear_n_per_m",
        "ratio_to_bonded",
        "max_uplift_fraction",
        "max_slip_m",
        "residual_slip_m",
        "peak_roof_displacement_m",
        "ledger_residual",
        "steps",
        "wall_s",
        "peak_roof_rise_m",
        "peak_mean_slip_m",
        "peak_roof_over_base_m",
        "rigid_superstructure_rms_difference",
    ])?;
    for outcome in results {
        let run = &outcome.run;
        let friction = match outcome.case.kind {
            Kind::Bonded => String::new(),
            Kind::Coulomb(friction) => friction.to_string(),
        };
        writer.write_record([
            outcome.case.name.clone(),
            friction,
            outcome.peak_shear.to_string(),
            run.whole.base_shear.magnitude().to_string(),
            (outcome.peak_shear / bonded).to_string(),
            run.whole.uplifted_fraction.largest().value.to_string(),
            run.whole.largest_slip.magnitude().to_string(),
            run.whole.residual_slip.to_string(),
            outcome.peak_roof.to_string(),
            run.ledger_residual.to_string(),
            run.steps.to_string(),
            run.wall.as_secs_f64().to_string(),
            outcome.peak_lift.to_string(),
            run.whole.mean_slip.magnitude().to_string(),
            outcome.peak_sway.to_string(),
            rigid_difference(outcome).to_string(),
        ])?;
    }
    writer.flush()?;
    Ok(())
}

/// Writes `serviceability.csv`, a row per case and criterion.
pub(crate) fn write_serviceability(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    let mut writer = csv::Writer::from_path(folder.join("serviceability.csv"))?;
    writer.write_record(["case", "criterion", "largest", "limit", "margin", "first_excess_s"])?;
    for outcome in results {
        for check in &outcome.run.serviceability {
            writer.write_record([
                outcome.case.name.clone(),
                check.criterion.name().to_owned(),
                check.largest.value.to_string(),
                check.limit.to_string(),
                check.margin().to_string(),
                check.first_excess.map_or_else(String::new, |time| time.to_string()),
            ])?;
        }
    }
    writer.flush()?;
    Ok(())
}

/// File name of a case.
pub(crate) fn file_stem(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect()
}

/// Writes one CSV of histories per case.
pub(crate) fn write_histories(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    for outcome in results {
        let kept = &outcome.histories;
        let path = folder.join(format!("{}.csv", file_stem(&outcome.case.name)));
        let mut writer = csv::Writer::from_path(path)?;
        writer.write_record([
            "time_s",
            "roof_x_m",
            "roof_y_m",
            "base_shear_n_per_m",
            "contact_shear_n_per_m",
            "base_moment_n_m_per_m",
            "normal_force_n_per_m",
            "uplifted_fraction",
            "mean_slip_m",
        ])?;
        for k in 0..kept.time.len() {
            writer.write_record(
                [
                    kept.time[k],
                    kept.roof[k][0],
                    kept.roof[k][1],
                    kept.shear[k],
                    kept.contact_shear[k],
                    kept.base_moment[k],
                    kept.normal_force[k],
                    kept.uplifted_fraction[k],
                    kept.mean_slip[k],
                ]
                .map(|value| format!("{value:.9e}")),
            )?;
        }
        writer.flush()?;
    }
    Ok(())
}
