//! Curves with their bands, a panel for each width.

use std::path::Path;

use plotters::prelude::*;

use super::lognormal::FragilityGroup;
use crate::AnyError;
use crate::key::{self, LegendSample, SheetArea};

/// Width and height of a panel, pixels.
const PANEL_SIZE: (u32, u32) = (440, 460);
const FRICTION_COLORS: [RGBColor; 3] =
    [RGBColor(214, 39, 40), RGBColor(31, 119, 180), RGBColor(44, 160, 44)];
const CURVE_POINTS: u32 = 100;

/// Draws all panels.
pub(crate) fn draw(
    path: &Path,
    title: &str,
    groups: &[FragilityGroup],
    widths: &[f64],
) -> Result<(), AnyError> {
    let size = (PANEL_SIZE.0 * u32::try_from(widths.len())? + 150, PANEL_SIZE.1);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE)?;
    let body = root.titled(title, ("sans-serif", 22))?;
    let first = groups.iter().filter(|group| group.width == widths[0]);
    let names = first.zip(FRICTION_COLORS.iter().cycle());
    let entries: Vec<_> = names
        .map(|(group, &color)| (format!("friction {}", group.friction), LegendSample::Line(color)))
        .chain([("fraction of runs".to_owned(), LegendSample::Circle(BLACK))])
        .collect();
    let body = key::draw(&body, 30, &entries)?;
    for (area, &width) in body.split_evenly((1, widths.len())).iter().zip(widths) {
        let shown_groups: Vec<_> = groups.iter().filter(|group| group.width == width).collect();
        draw_panel(area, &shown_groups, width)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(area: &SheetArea, groups: &[&FragilityGroup], width: f64) -> Result<(), AnyError> {
    let levels = groups.iter().flat_map(|group| &group.stripes).map(|stripe| stripe.level);
    let max_level = 1.05 * levels.fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(format!("base {width} m wide"), ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..max_level, 0.0..1.02)?;
    chart
        .configure_mesh()
        .x_desc("peak ground velocity, m/s")
        .y_desc("probability")
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&|x| format!("{x:.1}"))
        .y_label_formatter(&|y| format!("{y:.1}"))
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .light_line_style(WHITE)
        .draw()?;
    let velocities: Vec<f64> = (1..=CURVE_POINTS)
        .map(|k| max_level * f64::from(k) / f64::from(CURVE_POINTS))
        .collect();
    for (group, color) in groups.iter().zip(FRICTION_COLORS.iter().cycle()) {
        let bands: Vec<_> =
            velocities.iter().map(|&x| (x, group.band(|curve| curve.probability(x)))).collect();
        let low = bands.iter().map(|&(x, [low, _])| (x, low));
        let high = bands.iter().rev().map(|&(x, [_, high])| (x, high));
        chart.draw_series([Polygon::new(low.chain(high).collect::<Vec<_>>(), color.mix(0.15))])?;
        if let Some(fit) = group.fit {
            let line = velocities.iter().map(|&x| (x, fit.curve.probability(x)));
            chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
        }
        let stripes = group.stripes.iter().filter(|stripe| stripe.runs > 0.0);
        chart.draw_series(stripes.map(|stripe| {
            Circle::new((stripe.level, stripe.exceeded / stripe.runs), 3, color.filled())
        }))?;
    }
    Ok(())
}
