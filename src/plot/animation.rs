//! The deformed shape, and a moving picture of structure and base: an SVG with SMIL animation, played by browsers.

use std::fmt::Write;

use super::axes::{Axis, chart, draw_curve, drawable};
use super::drawing::{Key, Sample, Stroke, fitted, short, width};
use super::shown::shown;
use super::svg::{Sheet, Svg};
use crate::error::{Error, Result, finite, positive};
use crate::results::{DeformedShape, MotionFrame, TimeSeries};
use plotters::prelude::*;
use plotters::style::RGBColor;

const WIDTH: f64 = 940.0;
const HEIGHT: f64 = 640.0;
/// The structure is drawn inside this box: left, top, right, bottom.
const BOX: [f64; 4] = [40.0, 60.0, 690.0, 520.0];
/// Left end of the key, the scale and the clock.
const ASIDE: f64 = 725.0;
/// More frames than these make files that browsers choke on.
const MOST_FRAMES: usize = 600;
/// Changes of the clock.
const MOST_TIMES: usize = 150;

/// The structure in motion, displacements relative to the ground and times `magnification`, with
/// the surface of the soil, the contact mode of every element below it, a clock, and a bar for the
/// scale of lengths and of displacements. One second of the run takes `slowness` seconds.
///
/// Frames of contact are shown if they were kept as often as those of motion.
///
/// # Errors
/// [`Error::Scene`] if fewer than two frames of motion were kept
/// ([`crate::results::Recorder::motion`]); [`Error::Input`] unless magnification and slowness are
/// positive, or for more than 600 frames; [`Error::Index`] if `shape` belongs to another structure.
pub fn animation(
    title: &str,
    shape: &DeformedShape,
    histories: &TimeSeries,
    magnification: f64,
    slowness: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    positive("slowness", slowness)?;
    let frames: Vec<_> = histories.motion_frames().collect();
    if frames.len() < 2 {
        let needed = "tell the recorder to keep the motion, and run";
        return Err(Error::Scene { quantity: "animation", needed });
    }
    if frames.len() > MOST_FRAMES {
        let (quantity, needed) = ("frames of an animation", "600 or fewer: keep fewer of them");
        return Err(Error::Input { quantity, value: frames.len() as f64, needed });
    }
    let times: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
    let moved: Vec<Vec<[f64; 2]>> =
        frames.iter().map(|frame| places(shape, frame, magnification)).collect::<Result<_>>()?;
    let screen = Screen::of(&moved);
    let duration = format!("{:.3}s", (times[times.len() - 1] - times[0]) * slowness);

    let mut out = head(title);
    out += &screen.ground();
    out += &base(histories, &screen, frames.len(), &duration);
    let paths: Vec<String> = moved.iter().map(|places| screen.path(shape, places)).collect();
    let _ = writeln!(
        out,
        "<path fill=\"none\" stroke=\"#1f77b4\" stroke-width=\"1.2\" d=\"{}\">\
         <animate attributeName=\"d\" dur=\"{duration}\" repeatCount=\"indefinite\" values=\"{}\"/>\
         </path>",
        paths[0],
        paths.join(";")
    );
    out += &screen.bar(magnification);
    out += &clock(&times, &duration);
    Ok(Svg::new(out + "</svg>\n"))
}

/// Where metres are on the screen.
struct Screen {
    scale: f64,
    left: f64,
    bottom: f64,
    origin: [f64; 2],
}

impl Screen {
    fn of(moved: &[Vec<[f64; 2]>]) -> Self {
        let mut all: Vec<[f64; 2]> = moved.iter().flatten().copied().collect();
        all.push([all[0][0], 0.0]);
        let [low, high] = bounds(&all);
        let span = [0, 1].map(|k| (high[k] - low[k]).max(1e-6));
        let [left, top, right, bottom] = BOX;
        let scale = ((right - left) / span[0]).min((bottom - top) / span[1]);
        let left = left + 0.5 * (right - left - scale * span[0]);
        Self { scale, left, bottom, origin: low }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + self.scale * (x - self.origin[0]),
            self.bottom - self.scale * (y - self.origin[1]),
        ]
    }

    /// Outlines of the cells as an SVG path: the same commands for every frame.
    fn path(&self, shape: &DeformedShape, places: &[[f64; 2]]) -> String {
        let mut path = String::new();
        for cell in shape.cells() {
            let corners = DeformedShape::corners(cell);
            for (k, &corner) in corners.iter().enumerate() {
                let [x, y] = self.place(places[corner]);
                let _ = write!(path, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
            }
            if corners.len() > 2 {
                path.push('Z');
            }
        }
        path
    }

    /// The soil and its surface.
    fn ground(&self) -> String {
        let [left, _, right, bottom] = BOX;
        let [_, surface] = self.place([0.0; 2]);
        format!(
            "<rect x=\"{left}\" y=\"{surface:.1}\" width=\"{}\" height=\"{:.1}\" fill=\"{}\"/>\n\
             <path stroke=\"{}\" stroke-width=\"1.5\" d=\"M{left} {surface:.1}H{right}\"/>\n",
            right - left,
            bottom + 30.0 - surface,
            hex(SOIL),
            hex(SURFACE)
        )
    }

    /// A bar, and how many metres it is of the structure and of its displacements.
    fn bar(&self, magnification: f64) -> String {
        let length = round_below(150.0 / self.scale);
        let (end, y) = (ASIDE + self.scale * length, 300.0);
        format!(
            "<path fill=\"none\" stroke=\"#444\" stroke-width=\"2\" \
             d=\"M{ASIDE} {}v10M{ASIDE} {y}H{end:.1}M{end:.1} {}v10\"/>\n\
             <text x=\"{ASIDE}\" y=\"{}\">structure: {}</text>\n\
             <text x=\"{ASIDE}\" y=\"{}\">displacements: {}</text>\n\
             <text x=\"{ASIDE}\" y=\"{}\">(magnified × {})</text>\n",
            y - 5.0,
            y - 5.0,
            y + 24.0,
            metres(length),
            y + 44.0,
            metres(length / magnification),
            y + 64.0,
            short(magnification)
        )
    }
}

/// 1, 2 or 5 times a power of ten.
fn round_below(most: f64) -> f64 {
    let power = 10.0_f64.powf(most.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * power <= most);
    factor.unwrap_or(1.0) * power
}

/// A length in m or mm.
fn metres(length: f64) -> String {
    if length < 0.5 {
        format!("{} mm", short(1e3 * length))
    } else {
        format!("{} m", short(length))
    }
}

fn head(title: &str) -> String {
    // Sizes of fonts are those of SVG here, plotters' are 1.24 times as large.
    let title = fitted(title, 25, WIDTH - 40.0);
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{}\" y=\"34\" font-size=\"20\" text-anchor=\"middle\">{title}</text>\n",
        0.5 * WIDTH
    )
}

fn hex(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A rectangle for every contact element, coloured by its mode, and the key to the colours.
fn base(histories: &TimeSeries, screen: &Screen, frames: usize, duration: &str) -> String {
    let contact: Vec<_> = histories.contact_frames().collect();
    let mut out = String::new();
    if contact.len() != frames {
        return out;
    }
    let (shown, key) = shown(&contact);
    for (k, what) in key.into_iter().enumerate() {
        let y = 80.0 + 26.0 * k as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{ASIDE}\" y=\"{:.0}\" width=\"22\" height=\"14\" fill=\"{}\"/>\
             <text x=\"{}\" y=\"{y:.0}\">{}</text>",
            y - 12.0,
            hex(what.color()),
            ASIDE + 30.0,
            what.name()
        );
    }
    for (e, element) in histories.elements().iter().enumerate() {
        let [left, _] = screen.place([element.left, 0.0]);
        let [right, _] = screen.place([element.right, 0.0]);
        let colors: Vec<String> = shown.iter().map(|modes| hex(modes[e].color())).collect();
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{}\" width=\"{:.1}\" height=\"14\" fill=\"{}\">\
             <animate attributeName=\"fill\" calcMode=\"discrete\" dur=\"{duration}\" \
             repeatCount=\"indefinite\" values=\"{}\"/></rect>",
            left + 0.5,
            BOX[3] + 12.0,
            (right - left - 1.0).max(0.5),
            colors[0],
            colors.join(";")
        );
    }
    out
}

/// The running time: a bar, and one text after the other, for SMIL cannot count.
fn clock(times: &[f64], duration: &str) -> String {
    let (begin, end) = (times[0], times[times.len() - 1]);
    let (first, last) = (format!("{begin:.2} s"), format!("{end:.2} s"));
    let room = 30.0 + width(&first, 18).max(width(&last, 18));
    let (left, length, y) = (room, WIDTH - 2.0 * room, 600.0);
    let mut out = format!(
        "<rect x=\"{left:.1}\" y=\"{y}\" width=\"{length:.1}\" height=\"8\" fill=\"#ddd\"/>\
         <rect x=\"{left:.1}\" y=\"{y}\" width=\"0\" height=\"8\" fill=\"#444\">\
         <animate attributeName=\"width\" from=\"0\" to=\"{length:.1}\" dur=\"{duration}\" \
         repeatCount=\"indefinite\"/></rect>\n\
         <text x=\"{:.1}\" y=\"{}\" text-anchor=\"end\">{first}</text>\
         <text x=\"{:.1}\" y=\"{}\">{last}</text>\n",
        left - 10.0,
        y + 9.0,
        left + length + 10.0,
        y + 9.0
    );
    // The last frame has no duration: what is shown begins at the others.
    let every = (times.len() - 1).div_ceil(MOST_TIMES);
    let shown: Vec<f64> = times[..times.len() - 1].iter().copied().step_by(every).collect();
    let share = |time: f64| ((time - begin) / (end - begin)).clamp(0.0, 1.0);
    for (k, &time) in shown.iter().enumerate() {
        let from = share(time);
        let until = shown.get(k + 1).map_or(1.0, |&next| share(next));
        // Visible from the first instant on, or from its own.
        let (still, states, moments) = if k == 0 {
            ("visible", "visible;hidden", format!("0;{until:.5}"))
        } else {
            ("hidden", "hidden;visible;hidden", format!("0;{from:.5};{until:.5}"))
        };
        let _ = writeln!(
            out,
            "<text x=\"{ASIDE}\" y=\"400\" font-size=\"20\" visibility=\"{still}\">t = {time:.2} s\
             <animate attributeName=\"visibility\" calcMode=\"discrete\" dur=\"{duration}\" \
             repeatCount=\"indefinite\" values=\"{states}\" keyTimes=\"{moments}\"/></text>"
        );
    }
    out
}

// The structure at some instants.

/// Places of the points, m: displacements relative to the free field, magnified.
pub(super) fn places(
    shape: &DeformedShape,
    frame: &MotionFrame<'_>,
    magnification: f64,
) -> Result<Vec<[f64; 2]>> {
    let moved = shape.displacements(frame.displacement)?;
    let place = |(point, u): (&crate::results::ShapePoint, [f64; 2])| {
        [0, 1].map(|k| point.position[k] + magnification * u[k])
    };
    let places: Vec<[f64; 2]> = shape.points().iter().zip(moved).map(place).collect();
    match places.iter().flatten().find(|value| !drawable(**value)) {
        None => Ok(places),
        Some(&value) => {
            let (quantity, needed) = ("magnified coordinate", "below 1e60 m");
            Err(Error::Input { quantity, value, needed })
        }
    }
}

/// The soil below its surface, which is y = 0, and the surface itself.
pub(super) const SOIL: RGBColor = RGBColor(238, 229, 214);
pub(super) const SURFACE: RGBColor = RGBColor(125, 98, 62);

/// Least and largest coordinates [x, y].
pub(super) fn bounds(places: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for place in places {
        for k in 0..2 {
            bounds[0][k] = bounds[0][k].min(place[k]);
            bounds[1][k] = bounds[1][k].max(place[k]);
        }
    }
    bounds
}

/// Outlines of a deformed shape's cells at these places, end to end, broken by NaN.
fn outlines(shape: &DeformedShape, places: &[[f64; 2]]) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for cell in shape.cells() {
        let corners = DeformedShape::corners(cell);
        points.extend(corners.iter().map(|&k| (places[k][0], places[k][1])));
        if corners.len() > 2 {
            points.push((places[corners[0]][0], places[corners[0]][1]));
        }
        points.push((f64::NAN, f64::NAN));
    }
    points
}

/// The structure at rest and at the kept instants nearest to `times` (s), displacements relative to
/// the ground and times `magnification`, at one scale in both directions.
///
/// # Errors
/// [`Error::Scene`] if no motion was kept ([`crate::results::Recorder::motion`]), [`Error::Size`]
/// without times, [`Error::Input`] unless times are finite and the magnification positive,
/// [`Error::Index`] if `shape` belongs to another structure.
pub fn deformed_shapes(
    title: &str,
    shape: &DeformedShape,
    histories: &TimeSeries,
    times: &[f64],
    magnification: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    if times.is_empty() {
        return Err(Error::Size { quantity: "times of deformed shapes", found: 0, needed: 1 });
    }
    let rest: Vec<[f64; 2]> = shape.points().iter().map(|point| point.position).collect();
    let mut drawn = vec![("at rest".to_owned(), rest)];
    for &time in times {
        finite("time of a deformed shape", time)?;
        let away = |frame: &MotionFrame<'_>| (frame.time - time).abs();
        let nearest = histories.motion_frames().min_by(|a, b| away(a).total_cmp(&away(b)));
        let frame = nearest.ok_or(Error::Scene {
            quantity: "deformed shape",
            needed: "tell the recorder to keep the motion",
        })?;
        let name = format!("t = {:.2} s", frame.time);
        drawn.push((name, places(shape, &frame, magnification)?));
    }
    let mut all: Vec<[f64; 2]> = drawn.iter().flat_map(|(_, places)| places.clone()).collect();
    all.push([all[0][0], 0.0]);
    let stroke = |k: usize| match k.checked_sub(1) {
        None => Stroke::plain(RGBColor(170, 170, 170)),
        Some(k) => Stroke::nth(k),
    };
    let lines = (0..drawn.len()).map(|k| (drawn[k].0.as_str(), Sample::Line(stroke(k))));
    let scale = format!("displacements × {}", short(magnification));
    let rest = [("soil", Sample::Area(SOIL)), (&scale, Sample::Nothing)];
    let sheet = Sheet::new(title, Key::of(lines.chain(rest)));
    let [x, y] = ranges(bounds(&all), sheet.room());
    sheet.picture(|area| {
        let axes = (Axis::linear(x.clone(), "x, m"), Axis::linear(y.clone(), "y, m"));
        let mut chart = chart(area, &axes.0, &axes.1, false)?;
        let soil = Rectangle::new([(x.start, y.start), (x.end, 0.0)], SOIL.filled());
        chart.draw_series([soil])?;
        draw_curve(&mut chart, &[(x.start, 0.0), (x.end, 0.0)], Stroke::plain(SURFACE), 2)?;
        for (k, (_, places)) in drawn.iter().enumerate() {
            draw_curve(&mut chart, &outlines(shape, places), stroke(k), 1)?;
        }
        Ok(())
    })
}

/// Ranges of both axes at one scale, in a room of [width, height] pixels.
fn ranges([low, high]: [[f64; 2]; 2], [width, height]: [f64; 2]) -> [std::ops::Range<f64>; 2] {
    let span = [0, 1].map(|k| (high[k] - low[k]).max(1e-6) * 1.1);
    let scale = (span[0] / width).max(span[1] / height);
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let half = [0.5 * scale * width, 0.5 * scale * height];
    let range = |k: usize| middle[k] - half[k]..middle[k] + half[k];
    [range(0), range(1)]
}
