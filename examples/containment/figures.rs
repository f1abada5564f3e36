//! The paper's Figs. 4, 5 and 6 as it draws them, slip of the base, and Table 1 as a curve.

use std::path::Path;

use plotters::prelude::*;

use super::AnyError;
use super::case::{Kind, Outcome};
use super::chart::key::{self, Sample};
use super::chart::{self, SIZE};
use super::containment::{PAPER_SHEARS, POUND_FORCE_PER_FOOT};

/// A quantity of a case at a step, as drawn.
type Value = fn(&Outcome, usize) -> f64;

/// Uplift only and friction 0.4 in one picture each.
pub(crate) fn draw(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    let kinds = [Kind::Coulomb(f64::INFINITY), Kind::Coulomb(0.4)];
    let figures: [(&str, &str, &str, Value); 4] = [
        (
            "figure_4",
            "Fig. 4: absolute horizontal displacement at A",
            "displacement, mm",
            |o, k| 1e3 * o.histories.roof[k][0],
        ),
        ("figure_5", "Fig. 5: vertical displacement at A", "displacement, mm", |o, k| {
            1e3 * o.histories.roof[k][1]
        }),
        ("figure_6", "Fig. 6: base shear", "shear, kN/m", |o, k| 1e-3 * o.histories.shear[k]),
        ("base_slip", "Displacement of the base relative to the soil", "slip, mm", |o, k| {
            1e3 * o.histories.mean_slip[k]
        }),
    ];
    for (name, title, unit, value) in figures {
        let both = results.iter().filter(|outcome| kinds.contains(&outcome.case.kind));
        let curve = |outcome: &Outcome| {
            let time = outcome.histories.time.iter().enumerate();
            (outcome.case.name.clone(), time.map(|(k, &t)| (t, value(outcome, k))).collect())
        };
        chart::draw(&folder.join(format!("{name}.svg")), title, unit, both.map(curve).collect())?;
    }
    Ok(())
}

/// Peak base shear over friction, with uplift only as a level, and the paper's rows as points.
pub(crate) fn draw_sweep(
    folder: &Path,
    peaks: &[(f64, f64)],
    uplift_only: f64,
) -> Result<(), AnyError> {
    let paper: Vec<(f64, f64)> = [0.4, 0.3, 0.2]
        .into_iter()
        .zip(&PAPER_SHEARS[2..])
        .map(|(friction, shear)| (friction, 1e-3 * shear * POUND_FORCE_PER_FOOT))
        .collect();
    let paper_uplift = 1e-3 * PAPER_SHEARS[1] * POUND_FORCE_PER_FOOT;
    let here: Vec<(f64, f64)> = peaks.iter().map(|(x, y)| (*x, 1e-3 * y)).collect();
    let end = here.iter().fold(0.5_f64, |m, p| m.max(p.0));
    let level = 1e-3 * uplift_only;
    let top = here.iter().fold(level.max(paper_uplift), |m, p| m.max(p.1));

    let path = folder.join("friction_sweep.svg");
    let root = SVGBackend::new(&path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (blue, red) = (RGBColor(31, 119, 180), RGBColor(214, 39, 40));
    let entries = [
        ("here".to_owned(), Sample::Line(blue)),
        ("here, uplift only".to_owned(), Sample::Line(RGBColor(165, 201, 225))),
        ("Table 1 (line: uplift only)".to_owned(), Sample::Line(red)),
    ];
    let area = key::draw(&root, 64, &entries)?;
    let mut chart = ChartBuilder::on(&area)
        .caption("Peak base shear over friction", ("sans-serif", 24))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(0.0..end, 0.0..1.05 * top)?;
    chart
        .configure_mesh()
        .x_desc("friction coefficient")
        .y_desc("shear, kN/m")
        .x_label_formatter(&|x| format!("{x:.1}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .label_style(("sans-serif", 16))
        .axis_desc_style(("sans-serif", 18))
        .light_line_style(WHITE)
        .draw()?;
    let flat = |y: f64| [(0.0, y), (end, y)];
    chart.draw_series(LineSeries::new(here, blue.stroke_width(2)))?;
    chart.draw_series(LineSeries::new(flat(level), RGBColor(165, 201, 225).stroke_width(1)))?;
    chart.draw_series(LineSeries::new(flat(paper_uplift), red.stroke_width(1)))?;
    chart.draw_series(paper.iter().map(|point| Circle::new(*point, 6, red.filled())))?;
    root.present()?;
    Ok(())
}
