//! Picture and table of settings and their errors.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use basemat::bem::Grading;
use basemat::coupled::Coordinates;
use plotters::prelude::*;

use super::front::{FrontLine, FrontPoint, LineFamily};
use crate::AnyError;
use crate::key::{self, LegendSample};

/// Width and height, pixels.
const PICTURE_SIZE: (u32, u32) = (1200, 720);

const LINE_COLORS: [RGBColor; 13] = [
    RGBColor(44, 160, 44),
    RGBColor(188, 189, 34),
    RGBColor(0, 100, 0),
    RGBColor(31, 119, 180),
    RGBColor(148, 190, 233),
    RGBColor(0, 0, 0),
    RGBColor(120, 120, 120),
    RGBColor(255, 140, 0),
    RGBColor(148, 103, 189),
    RGBColor(227, 119, 194),
    RGBColor(140, 86, 75),
    RGBColor(214, 39, 40),
    RGBColor(255, 120, 120),
];

/// Smallest and largest value of all points.
fn range(lines: &[FrontLine], value: impl Fn(&FrontPoint) -> f64) -> Range<f64> {
    let values = lines.iter().flat_map(|line| &line.points).map(value);
    let empty_range = f64::INFINITY..0.0_f64;
    values.fold(empty_range, |range, value| range.start.min(value)..range.end.max(value))
}

/// Draws processor time upwards over error, which decreases from left to right; a line for each family.
pub(crate) fn draw(path: &Path, lines: &[FrontLine]) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, PICTURE_SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = "Which settings for which error: points are elements, time step in ms";
    let body = root.titled(title, ("sans-serif", 24))?;
    let colors = LINE_COLORS.into_iter().cycle();
    let entries: Vec<_> = lines
        .iter()
        .zip(colors.clone())
        .map(|(line, color)| (line.family.name.to_owned(), LegendSample::Line(color)))
        .collect();
    let body = key::draw(&body, 30, &entries)?;
    let error_range = range(lines, |point| point.error);
    let time_range = range(lines, |point| point.seconds);
    let errors = 1.6 * error_range.end..0.5 * error_range.start;
    let times = 0.6 * time_range.start..2.0 * time_range.end;
    let mut chart = ChartBuilder::on(&body)
        .margin(14)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(errors.log_scale(), times.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("error of the base shear: the larger of history and peak")
        .y_desc("processor time, build included, s")
        .x_label_formatter(&|x| format!("{} %", 100.0 * x))
        .y_label_formatter(&|y| format!("{y}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .light_line_style(WHITE)
        .draw()?;
    for (line, color) in lines.iter().zip(colors) {
        let positions = line.points.iter().map(|point| (point.error, point.seconds));
        chart.draw_series(LineSeries::new(positions.clone(), color.stroke_width(2)))?;
        chart.draw_series(positions.map(|at| Circle::new(at, 4, color.filled())))?;
        let style = ("sans-serif", 12).into_font().color(&color);
        chart.draw_series(line.points.iter().map(|point| {
            let label = format!("{}, {}", point.elements, 1e3 * point.time_step);
            EmptyElement::at((point.error, point.seconds))
                + Text::new(label, (5, -12), style.clone())
        }))?;
    }
    root.present()?;
    Ok(())
}

/// The fastest settings of each scene within 5, 1 and 0.3 %.
pub(crate) fn table(lines: &[FrontLine]) -> Result<String, AnyError> {
    let tolerances = [0.05, 0.01, 0.003];
    let mut text = "| scene: graded elements, Δt, coordinates: time | 5 % | 1 % | 0.3 % |\n|---|---|---|---|\n".to_owned();
    let mut groups: Vec<&str> = lines.iter().map(|line| line.family.group).collect();
    groups.dedup();
    for group in groups {
        write!(text, "| {group} |")?;
        for tolerance in tolerances {
            let group_lines = lines.iter().filter(|line| line.family.group == group);
            let points =
                group_lines.flat_map(|line| line.points.iter().map(|point| (&line.family, point)));
            let best_points = points
                .filter(|(_, point)| point.error <= tolerance)
                .min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
            match best_points {
                Some((family, point)) => write!(text, " {} |", cell(family, point))?,
                None => text.push_str(" not reached |"),
            }
        }
        text.push('\n');
    }
    Ok(text)
}

fn cell(family: &LineFamily, point: &FrontPoint) -> String {
    let grading = match family.grading {
        Grading::Uniform => " equal",
        _ => "",
    };
    let coordinates = match family.coordinates {
        Coordinates::Physical => "dofs".to_owned(),
        Coordinates::Modes => "modes".to_owned(),
        Coordinates::Reduced { tolerance } => format!("reduced {tolerance:.0e}"),
        _ => "automatic".to_owned(),
    };
    let elements = point.elements;
    let step = 1e3 * point.time_step;
    let seconds = point.seconds;
    format!("{elements}{grading}, {step} ms, {coordinates}: {seconds:.2} s")
}
