//! One picture and one table to read settings from.

use std::fmt::Write as _;
use std::path::Path;

use basemat::bem::Grading;
use basemat::coupled::Coordinates;
use plotters::prelude::*;

use super::front::{Family, Line, Point};
use crate::AnyError;
use crate::key::{self, Sample};

const SIZE: (u32, u32) = (1200, 720);

const COLORS: [RGBColor; 13] = [
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

/// Error downwards from left to right, processor time upwards, a line a family.
pub(crate) fn draw(path: &Path, lines: &[Line]) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = "Which settings for which error: points are elements, time step in ms";
    let body = root.titled(title, ("sans-serif", 24))?;
    let colors = || COLORS.into_iter().cycle();
    let entries: Vec<_> = lines
        .iter()
        .zip(colors())
        .map(|(line, color)| (line.family.name.to_owned(), Sample::Line(color)))
        .collect();
    let body = key::draw(&body, 30, &entries)?;
    let points = || lines.iter().flat_map(|line| &line.points);
    let most = |value: fn(&Point) -> f64| points().map(value).fold(0.0, f64::max);
    let least = |value: fn(&Point) -> f64| points().map(value).fold(f64::INFINITY, f64::min);
    let errors = 1.6 * most(|p| p.error)..0.5 * least(|p| p.error);
    let times = 0.6 * least(|p| p.seconds)..2.0 * most(|p| p.seconds);
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
    for (line, color) in lines.iter().zip(colors()) {
        let places = || line.points.iter().map(|p| (p.error, p.seconds));
        chart.draw_series(LineSeries::new(places(), color.stroke_width(2)))?;
        chart.draw_series(places().map(|at| Circle::new(at, 4, color.filled())))?;
        let style = ("sans-serif", 12).into_font().color(&color);
        chart.draw_series(line.points.iter().map(|p| {
            let label = format!("{}, {}", p.elements, 1e3 * p.time_step);
            EmptyElement::at((p.error, p.seconds)) + Text::new(label, (5, -12), style.clone())
        }))?;
    }
    root.present()?;
    Ok(())
}

/// The fastest settings of each scene within 5, 1 and 0.3 %.
pub(crate) fn table(lines: &[Line]) -> Result<String, AnyError> {
    let tolerances = [0.05, 0.01, 0.003];
    let mut text = "| scene: graded elements, Δt, coordinates: time | 5 % | 1 % | 0.3 % |\n|---|---|---|---|\n".to_owned();
    let mut groups: Vec<&str> = lines.iter().map(|line| line.family.group).collect();
    groups.dedup();
    for group in groups {
        write!(text, "| {group} |")?;
        for tolerance in tolerances {
            let of_group = lines.iter().filter(|line| line.family.group == group);
            let points = of_group.flat_map(|line| line.points.iter().map(|p| (&line.family, p)));
            let best = points
                .filter(|(_, point)| point.error <= tolerance)
                .min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
            match best {
                Some((family, point)) => write!(text, " {} |", cell(family, point))?,
                None => text.push_str(" not reached |"),
            }
        }
        text.push('\n');
    }
    Ok(text)
}

fn cell(family: &Family, point: &Point) -> String {
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
    let (elements, step, seconds) = (point.elements, 1e3 * point.time_step, point.seconds);
    format!("{elements}{grading}, {step} ms, {coordinates}: {seconds:.2} s")
}
