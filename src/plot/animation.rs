//! Animation of structure and base: an SVG with SMIL, which browsers play.

use std::fmt::Write;

use super::deformed::{OPACITY, SOIL, SURFACE, bounds, check_dimension, places};
use super::marks::{self, ASIDE, hex};
use super::shown::shown;
use super::svg::{Svg, changes, escaped, polygon};
use super::text_width::{fitted, short, width};
use super::trench;
use super::view::View;
use crate::error::{Result, positive, require, require_part};
use crate::geometry::far_ends;
use crate::results::{DeformedShape, TimeSeries};

const WIDTH: f64 = 940.0;
const HEIGHT: f64 = 640.0;
/// Box of the structure, pixels: left, top, right, bottom.
const BOX: [f64; 4] = [40.0, 60.0, 690.0, 520.0];
/// Largest number of frames: browsers cannot play larger files smoothly.
const MOST_FRAMES: usize = 600;
/// Largest number of changes of the clock.
const MOST_TIMES: usize = 150;
/// Width of the soil drawn beside a trench, over the width of the trench.
const ROOM: f64 = 0.15;

/// The structure in motion with the contact modes of its base, as an animation.
///
/// Displacements are relative to the ground and multiplied by `magnification`. The picture contains the surface of the
/// soil, the contact mode of every element below it or behind walls, a clock, and a bar with the scales of lengths and of displacements.
/// One second of the run takes `slowness` seconds.
///
/// In plan the view is from the front, the right and above, with one scale for all lengths. Shells and sides of solids
/// hide most of what lies behind them. The elements are drawn below the structure, and again in a small plan at the side.
///
/// Frames of contact are shown if there are as many as frames of motion.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if fewer than two frames of motion were kept
/// ([`crate::results::Recorder::motion`]); [`Error::Input`](crate::Error::Input) unless
/// magnification and slowness are positive, or for more than 600 frames; [`Error::Index`](crate::Error::Index) if
/// `shape` belongs to another structure, [`Error::Scene`](crate::Error::Scene) if to one of another dimension.
pub fn animation(
    title: &str,
    shape: &DeformedShape,
    time_series: &TimeSeries,
    magnification: f64,
    slowness: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    positive("slowness", slowness)?;
    let frames: Vec<_> = time_series.motion_frames().collect();
    require_part("animation", frames.len() > 1, "tell the recorder to keep the motion, and run")?;
    let needed = "600 or fewer: keep fewer of them";
    require("frames of an animation", frames.len() as f64, frames.len() <= MOST_FRAMES, needed)?;
    check_dimension(shape, time_series)?;
    let times: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
    let view = View::whole(time_series.up());
    let seen = |frame| Ok(view.all(&places(shape, frame, magnification)?));
    let moved: Vec<Vec<[f64; 2]>> = frames.iter().map(seen).collect::<Result<_>>()?;
    let duration = format!("{:.3}s", (times[times.len() - 1] - times[0]) * slowness);

    let mut out = head(title);
    let screen = match view {
        View::Slanted => {
            let floor = Floor::new(time_series);
            let screen = Screen::around(&moved, &view.all(&floor.corners(floor.margin)));
            out += &floor.draw(time_series, &screen, frames.len(), &duration);
            screen
        }
        View::AlongX | View::AlongY => {
            let trench = trench::outline(time_series.elements());
            let mut others = vec![[moved[0][0][0], 0.0]];
            if let Some([first, .., last]) = trench {
                // Room for marks.
                let side = ROOM * (last[0] - first[0]);
                others.extend([[first[0] - side, 0.0], [last[0] + side, 0.0]]);
            }
            let screen = Screen::around(&moved, &others);
            out += &screen.ground(trench);
            out += &marks::base(
                time_series,
                (screen.scale, |own| screen.place(own)),
                BOX[3],
                (frames.len(), &duration),
            );
            screen
        }
    };
    out += &screen.structure(&view.far_to_near(shape), shape.has_faces(), &moved, &duration);
    out += &screen.bar(magnification);
    out += &clock(&times, &duration);
    Ok(Svg::new(out + "</svg>\n"))
}

/// Scale and origin of metres on the screen.
struct Screen {
    scale: f64,
    left: f64,
    bottom: f64,
    origin: [f64; 2],
}

impl Screen {
    /// Screen that contains these places and the `others`.
    fn around(moved: &[Vec<[f64; 2]>], others: &[[f64; 2]]) -> Self {
        let mut all: Vec<[f64; 2]> = moved.iter().flatten().copied().collect();
        all.extend(others);
        let bounds = bounds(&all);
        let sides = bounds.map(|[low, high]| (high - low).max(1e-6));
        let [left, top, right, bottom] = BOX;
        let scale = ((right - left) / sides[0]).min((bottom - top) / sides[1]);
        let left = left + 0.5 * (right - left - scale * sides[0]);
        Self { scale, left, bottom, origin: bounds.map(|[low, _]| low) }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + self.scale * (x - self.origin[0]),
            self.bottom - self.scale * (y - self.origin[1]),
        ]
    }

    /// The cells at all instants; those that are faces hide what was drawn before.
    fn structure(
        &self,
        cells: &[&[usize]],
        are_faces: bool,
        moved: &[Vec<[f64; 2]>],
        duration: &str,
    ) -> String {
        let (at_once, fill) = if are_faces { (1, "#fff") } else { (cells.len().max(1), "none") };
        let mut out = format!(
            "<g fill=\"{fill}\" fill-opacity=\"{OPACITY}\" stroke=\"#1f77b4\" stroke-width=\"1.2\" \
             stroke-linejoin=\"round\">\n"
        );
        for cells in cells.chunks(at_once) {
            let paths: Vec<String> = moved.iter().map(|places| self.path(cells, places)).collect();
            let _ = writeln!(
                out,
                "<path d=\"{}\"><animate attributeName=\"d\" dur=\"{duration}\" \
                 repeatCount=\"indefinite\" values=\"{}\"/></path>",
                paths[0],
                paths.join(";")
            );
        }
        out + "</g>\n"
    }

    /// Outlines of the cells as an SVG path, with the same commands for every frame.
    fn path(&self, cells: &[&[usize]], places: &[[f64; 2]]) -> String {
        let mut path = String::new();
        for corners in cells {
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

    /// The soil and its surface, with the outline of a trench.
    fn ground(&self, trench: Option<[[f64; 2]; 4]>) -> String {
        let [left, _, right, bottom] = BOX;
        let [_, surface] = self.place([0.0; 2]);
        let mut cut = String::new();
        for [x, y] in trench.iter().flatten().map(|own| self.place(*own)) {
            let _ = write!(cut, "L{x:.1} {y:.1}");
        }
        format!(
            "<rect x=\"{left}\" y=\"{surface:.1}\" width=\"{}\" height=\"{:.1}\" fill=\"{}\"/>\n\
             <path stroke=\"{}\" stroke-width=\"1.5\" fill=\"#fff\" d=\"M{left} {surface:.1}{cut}H{right}\"/>\n",
            right - left,
            bottom + 30.0 - surface,
            hex(SOIL),
            hex(SURFACE)
        )
    }

    /// A bar with its length in metres, for the structure and for its displacements.
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

/// Rounds down to 1, 2 or 5 times a power of ten.
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
    // Font sizes here are SVG sizes; sizes in plotters are 1.24 times as large.
    let title = fitted(title, 25, WIDTH - 40.0);
    let title = escaped(&title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{}\" y=\"34\" font-size=\"20\" text-anchor=\"middle\">{title}</text>\n",
        0.5 * WIDTH
    )
}

/// The surface around a base in plan.
struct Floor {
    /// Ends of the base along x and y, m.
    ends: [[f64; 2]; 2],
    /// Width of the soil drawn around the base, m.
    margin: f64,
}

/// Box of the plan at the side, pixels: left, top, right, bottom.
const SIDE: [f64; 4] = [ASIDE, 440.0, 915.0, 585.0];

impl Floor {
    fn new(time_series: &TimeSeries) -> Self {
        let along = far_ends(time_series.elements().iter().map(|own| own.ends()[0]));
        let across = far_ends(time_series.elements().iter().map(|own| own.ends()[1]));
        let side = (along[1] - along[0]).max(across[1] - across[0]);
        Self { ends: [along, across], margin: 0.15 * side }
    }

    /// Corners (x, height, y) at a distance `margin` outside the base.
    fn corners(&self, margin: f64) -> [[f64; 3]; 4] {
        let [[left, right], [front, back]] =
            self.ends.map(|[low, high]| [low - margin, high + margin]);
        [[left, front], [right, front], [right, back], [left, back]].map(|[x, y]| [x, 0.0, y])
    }

    /// Draws soil, axes, and the elements, coloured by their modes, below the structure and at the side.
    fn draw(
        &self,
        time_series: &TimeSeries,
        screen: &Screen,
        frames: usize,
        duration: &str,
    ) -> String {
        let seen = |place: [f64; 3]| screen.place(View::Slanted.project(place));
        let soil = polygon(&self.corners(self.margin).map(seen));
        let mut out =
            format!("<path d=\"{soil}\" fill=\"{}\" stroke=\"{}\"/>\n", hex(SOIL), hex(SURFACE));
        self.draw_axes(screen, &mut out);
        let [[left, _], [_, back]] = self.ends;
        let contact: Vec<_> = time_series.contact_frames().collect();
        if contact.len() != frames {
            return out;
        }
        let (shown, modes) = shown(&contact, true);
        out += &marks::key(modes);
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" font-size=\"12\">contact from above, x to the right</text>",
            SIDE[0],
            SIDE[1] - 8.0
        );
        let [wide, high] = self.ends.map(|[low, high]| high - low);
        let scale = ((SIDE[2] - SIDE[0]) / wide).min((SIDE[3] - SIDE[1]) / high);
        let plan =
            |[x, _, y]: [f64; 3]| [SIDE[0] + scale * (x - left), SIDE[1] + scale * (back - y)];
        for (e, element) in time_series.elements().iter().enumerate() {
            let corners = Self { ends: element.ends(), margin: 0.0 }.corners(0.0);
            let colors: Vec<String> = shown.iter().map(|modes| hex(modes[e].color())).collect();
            let change = changes("fill", &colors, duration);
            for cell in [polygon(&corners.map(seen)), polygon(&corners.map(plan))] {
                let _ = writeln!(
                    out,
                    "<path d=\"{cell}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.6\">{change}</path>",
                    colors[0]
                );
            }
        }
        out
    }

    /// Draws the axes x and y beside the soil.
    fn draw_axes(&self, screen: &Screen, out: &mut String) {
        let [[left, right], [front, back]] = self.ends;
        let away = 0.6 * self.margin;
        for (name, from, to) in [
            ("x", [left, 0.0, front - away], [right, 0.0, front - away]),
            ("y", [right + away, 0.0, front], [right + away, 0.0, back]),
        ] {
            let [[x, y], [to_x, to_y]] =
                [from, to].map(|place| screen.place(View::Slanted.project(place)));
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\" stroke=\"{}\"/>\
                 <circle cx=\"{to_x:.1}\" cy=\"{to_y:.1}\" r=\"3\" fill=\"{}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{name}</text>",
                hex(SURFACE),
                hex(SURFACE),
                to_x + 7.0,
                to_y + 5.0
            );
        }
    }
}

/// The running time: a bar, and a sequence of texts, because SMIL cannot count.
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
    // The last frame has no duration, so texts begin at the other frames.
    let every = (times.len() - 1).div_ceil(MOST_TIMES);
    let shown: Vec<f64> = times[..times.len() - 1].iter().copied().step_by(every).collect();
    let share = |time: f64| ((time - begin) / (end - begin)).clamp(0.0, 1.0);
    for (k, &time) in shown.iter().enumerate() {
        let from = share(time);
        let until = shown.get(k + 1).map_or(1.0, |&next| share(next));
        // Visible from the start, or from the text's own time.
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
