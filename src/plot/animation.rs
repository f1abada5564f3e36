//! A moving picture of the structure and its base: an SVG with SMIL animation, played by browsers.

use std::fmt::Write;

use super::mode_map::{MODES, color};
use super::shape::{bounds, places};
use super::svg::Svg;
use crate::error::{Error, Result, positive};
use crate::results::{Histories, Wireframe};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 620.0;
/// The structure is drawn inside this box: left, top, right, bottom.
const BOX: [f64; 4] = [40.0, 60.0, 700.0, 520.0];
/// More frames than these make files that browsers choke on.
const MOST_FRAMES: usize = 600;

/// The structure in motion, displacements relative to the ground and times `magnification`, with
/// the contact mode of every element below it and a bar of time. One second of the run takes
/// `slowness` seconds.
///
/// Frames of contact are shown if they were kept as often as those of motion.
///
/// # Errors
/// [`Error::Scene`] if fewer than two frames of motion were kept
/// ([`crate::results::Recorder::motion`]); [`Error::Input`] unless magnification and slowness are
/// positive, or for more than 600 frames; [`Error::Index`] if `shape` belongs to another structure.
pub fn animation(
    title: &str,
    shape: &Wireframe,
    histories: &Histories,
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
    let (begin, end) = (frames[0].time, frames[frames.len() - 1].time);
    let moved: Vec<Vec<[f64; 2]>> =
        frames.iter().map(|frame| places(shape, frame, magnification)).collect::<Result<_>>()?;
    let screen = Screen::of(&moved);
    let duration = format!("{:.3}s", (end - begin) * slowness);

    let mut out = head(title, magnification);
    let paths: Vec<String> = moved.iter().map(|places| screen.path(shape, places)).collect();
    let _ = writeln!(
        out,
        "<path fill=\"none\" stroke=\"#1f77b4\" stroke-width=\"1.2\" d=\"{}\">\
         <animate attributeName=\"d\" dur=\"{duration}\" repeatCount=\"indefinite\" values=\"{}\"/>\
         </path>",
        paths[0],
        paths.join(";")
    );
    out += &base(histories, &screen, frames.len(), &duration);
    out += &time_bar(begin, end, &duration);
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
        let all: Vec<[f64; 2]> = moved.iter().flatten().copied().collect();
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
    fn path(&self, shape: &Wireframe, places: &[[f64; 2]]) -> String {
        let mut path = String::new();
        for cell in shape.cells() {
            let corners = Wireframe::corners(cell);
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
}

fn head(title: &str, magnification: f64) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"15\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{}\" y=\"34\" font-size=\"20\" text-anchor=\"middle\">{title}, displacements × \
         {magnification}</text>\n",
        0.5 * WIDTH
    );
    for (k, (mode, name)) in MODES.iter().enumerate() {
        let y = 80.0 + 26.0 * k as f64;
        let _ = writeln!(
            out,
            "<rect x=\"725\" y=\"{:.0}\" width=\"22\" height=\"14\" fill=\"{}\"/>\
             <text x=\"755\" y=\"{y:.0}\">{name}</text>",
            y - 12.0,
            hex(*mode)
        );
    }
    out
}

fn hex(mode: crate::interface::Mode) -> String {
    let c = color(mode);
    format!("#{:02x}{:02x}{:02x}", c.0, c.1, c.2)
}

/// A rectangle for every contact element, coloured by its mode.
fn base(histories: &Histories, screen: &Screen, frames: usize, duration: &str) -> String {
    let contact: Vec<_> = histories.contact_frames().collect();
    let mut out = String::new();
    if contact.len() != frames {
        return out;
    }
    for (e, element) in histories.elements().iter().enumerate() {
        let [left, _] = screen.place([element.left, 0.0]);
        let [right, _] = screen.place([element.right, 0.0]);
        let colors: Vec<String> = contact.iter().map(|frame| hex(frame.modes[e])).collect();
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

fn time_bar(begin: f64, end: f64, duration: &str) -> String {
    let (left, right, y) = (120.0, 780.0, 580.0);
    format!(
        "<rect x=\"{left}\" y=\"{y}\" width=\"{width}\" height=\"8\" fill=\"#ddd\"/>\
         <rect x=\"{left}\" y=\"{y}\" width=\"0\" height=\"8\" fill=\"#444\">\
         <animate attributeName=\"width\" from=\"0\" to=\"{width}\" dur=\"{duration}\" \
         repeatCount=\"indefinite\"/></rect>\n\
         <text x=\"{}\" y=\"590\" text-anchor=\"end\">{begin:.2} s</text>\
         <text x=\"{}\" y=\"590\">{end:.2} s</text>\n",
        left - 10.0,
        right + 10.0,
        width = right - left
    )
}
