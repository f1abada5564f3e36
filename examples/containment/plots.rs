//! Plots that correspond to the paper's Figs. 4, 5 and 6, and a map of contact modes.

use std::path::Path;

use basemat::interface::Mode;
use plotters::prelude::*;

use super::AnyError;
use super::case::{Kind, Outcome};
use super::chart::{self, SIZE};
use super::report::file_stem;

/// Draws everything into `folder`.
pub(crate) fn draw_all(folder: &Path, results: &[Outcome]) -> Result<(), AnyError> {
    curves(
        &folder.join("roof_horizontal.svg"),
        "Horizontal motion at A, a roof corner (absolute)",
        "displacement, mm",
        results,
        |outcome, k| 1e3 * outcome.histories.roof[k][0],
    )?;
    curves(
        &folder.join("roof_vertical.svg"),
        "Vertical motion at A, a roof corner (absolute) (up)",
        "displacement, mm",
        results,
        |outcome, k| 1e3 * outcome.histories.roof[k][1],
    )?;
    curves(
        &folder.join("base_shear.svg"),
        "Base shear at the foundation–superstructure interface",
        "shear, kN/m",
        results,
        |outcome, k| 1e-3 * outcome.histories.shear[k],
    )?;
    for outcome in results.iter().filter(|outcome| outcome.case.kind != Kind::Bonded) {
        let path = folder.join(format!("modes_{}.svg", file_stem(&outcome.case.name)));
        mode_map(&path, outcome)?;
    }
    Ok(())
}

/// One curve per case.
fn curves(
    path: &Path,
    title: &str,
    unit: &str,
    results: &[Outcome],
    value: impl Fn(&Outcome, usize) -> f64,
) -> Result<(), AnyError> {
    let curve = |outcome: &Outcome| {
        let time = outcome.histories.time.iter().enumerate();
        (outcome.case.name.clone(), time.map(|(k, &t)| (t, value(outcome, k))).collect())
    };
    chart::draw(path, title, unit, results.iter().map(curve).collect())
}

fn color(mode: Mode) -> RGBColor {
    match mode {
        Mode::Stick => RGBColor(222, 230, 236),
        Mode::SlipLeft => RGBColor(255, 166, 43),
        Mode::SlipRight => RGBColor(214, 39, 40),
        Mode::Open => RGBColor(22, 72, 120),
    }
}

/// Contact modes over base and time; where steps share a column, the rarest mode shows.
fn mode_map(path: &Path, outcome: &Outcome) -> Result<(), AnyError> {
    let kept = &outcome.histories;
    let (Some(first), Some(&end)) = (kept.modes.first(), kept.time.last()) else { return Ok(()) };
    let count = first.len();
    let half = 0.5 * outcome.width;
    let length = outcome.width / count as f64;
    let every = kept.modes.len().div_ceil(1000).max(1);
    let rank = |mode: Mode| match mode {
        Mode::Stick => 0,
        Mode::Open => 1,
        Mode::SlipLeft => 2,
        Mode::SlipRight => 3,
    };

    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Contact modes, {}", outcome.case.name);
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 24))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(0.0..end, -half..1.7 * half)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("time, s")
        .y_desc("place along the base, m (right is up)")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| if *y > half { String::new() } else { format!("{y:.0}") })
        .label_style(("sans-serif", 16))
        .axis_desc_style(("sans-serif", 18))
        .draw()?;
    for element in 0..count {
        let mut begin = 0.0;
        let mut shown: Option<Mode> = None;
        let row = element as f64 * length - half;
        let columns: Vec<(f64, Mode)> = kept
            .modes
            .chunks(every)
            .zip(kept.time.chunks(every))
            .filter_map(|(modes, time)| {
                let mode = modes.iter().map(|m| m[element]).max_by_key(|m| rank(*m))?;
                Some((*time.last()?, mode))
            })
            .collect();
        // One rectangle per stretch of equal mode keeps the file small.
        for (k, &(time, mode)) in columns.iter().enumerate() {
            let next = columns.get(k + 1).map(|c| c.1);
            shown.get_or_insert(mode);
            if next != Some(mode) {
                let area = [(begin, row + 0.04 * length), (time, row + 0.96 * length)];
                chart.draw_series([Rectangle::new(area, color(mode).filled())])?;
                begin = time;
                shown = None;
            }
        }
    }
    for (mode, name) in [
        (Mode::Stick, "stick"),
        (Mode::SlipLeft, "slip to the left"),
        (Mode::SlipRight, "slip to the right"),
        (Mode::Open, "open"),
    ] {
        chart
            .draw_series(std::iter::once(Rectangle::new([(0.0, -half); 2], color(mode).filled())))?
            .label(name)
            .legend(move |(x, y)| {
                Rectangle::new([(x, y - 6), (x + 24, y + 6)], color(mode).filled())
            });
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 16))
        .draw()?;
    root.present()?;
    Ok(())
}
