//! Advice on mesh and time step for a wanted accuracy.

use std::f64::consts::{PI, TAU};
use std::fmt;

use super::response_estimate::{Sketch, Steps, StiffnessError};
use crate::Soil;
use crate::bem::{Grading, HalfPlaneGround, Strip};
use crate::error::{Error, Result, damping_ratio, not_negative, positive};
use crate::history::History;
use crate::motion::FrequencyContent;

/// Error of the strip's stiffnesses on Q cosine-graded elements is this over Q²: root mean square
/// over 0.1 ≤ a₀ ≤ 4, horizontal and rocking, from the impedances of bonded strips of 8 and 16
/// elements (`docs/validation.md`; on Q uniform elements it is 0.22/Q and 0.77/Q).
const HORIZONTAL: f64 = 0.65;
const ROCKING: f64 = 1.85;

/// Share of the tolerance that mesh, step and peak have each. Errors of mesh and step add up to more than
/// the root of their squares, and estimates are off by a fifth, one standard deviation.
const SHARE: f64 = 0.6;

/// Fewest elements advised, and most.
const ELEMENTS: [usize; 2] = [4, 1000];

/// a₀ up to which the errors of the stiffnesses were measured.
const MEASURED: f64 = 4.0;

/// A structure as advice sees it: the rectangle that it resembles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "OutlineForm"))]
pub struct Outline {
    width: f64,
    height: f64,
    mass: f64,
    sway: Option<[f64; 2]>,
}

validated! {
    Outline as OutlineForm {
        width: f64,
        height: f64,
        mass: f64,
        #[serde(default)]
        sway: Option<[f64; 2]>,
    }
    => {
        let outline = Outline::new(width, height, mass)?;
        sway.map_or(Ok(outline), |[frequency, ratio]| outline.with_frequency(frequency, ratio))
    }
}

impl Outline {
    /// Homogeneous rigid rectangle: width of the base and height (m), mass (kg per metre).
    ///
    /// For a structure whose centre of gravity is not at half its height, give twice the height of
    /// that centre.
    ///
    /// # Errors
    /// [`Error::Input`] unless all are finite and above zero.
    pub fn new(width: f64, height: f64, mass: f64) -> Result<Self> {
        positive("width of the outline", width)?;
        positive("height of the outline", height)?;
        positive("mass of the outline", mass)?;
        Ok(Self { width, height, mass, sway: None })
    }

    /// The same, 70 % of the mass swaying at 70 % of the height with this frequency (Hz) on a fixed
    /// base, and this damping ratio.
    ///
    /// # Errors
    /// [`Error::Input`] unless the frequency is finite and above zero and the ratio from 0 to
    /// below 1.
    pub fn with_frequency(self, frequency: f64, ratio: f64) -> Result<Self> {
        positive("frequency of the outline", frequency)?;
        damping_ratio("damping ratio of the outline", ratio)?;
        Ok(Self { sway: Some([frequency, ratio]), ..self })
    }
}

/// Mesh and time step for a wanted accuracy of the base shear, see [`advise`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Advice {
    /// Elements under the base.
    pub elements: usize,
    /// Their grading.
    pub grading: Grading,
    /// Time step, s, of two digits.
    pub time_step: f64,
    /// Expected relative error of the strip's horizontal stiffness, and of that in rocking, with so
    /// many elements: root mean square over `0.1 ≤ a₀ ≤ 4`.
    pub stiffness_error: StiffnessError,
    /// Kind of history.
    pub history: History,
    /// The tolerance that was asked for.
    pub tolerance: f64,
    /// Expected relative L2 error of the base shear's history due to the mesh.
    pub mesh_error: f64,
    /// Expected relative L2 error of the base shear's history due to the step.
    pub step_error: f64,
    /// Expected relative loss of the base shear's peak, which falls within a step and is averaged
    /// over it; at worst twice this.
    pub peak_error: f64,
    /// Root-mean-square frequency of the estimated base shear, Hz.
    pub frequency: f64,
    /// Share of the base shear's energy at frequencies above `4 c_S/B`, B half the width: beyond,
    /// errors have not been measured.
    pub beyond_measured: f64,
    /// Steps in which a P wave crosses the shortest element. Not a criterion: the soil operator is
    /// stable and accurate for any value.
    pub steps_per_crossing: f64,
}

impl Advice {
    /// Half-plane with the advised strip over `range` (m) and history.
    ///
    /// # Errors
    /// As for [`HalfPlaneGround::new`].
    pub fn ground(&self, soil: Soil, range: std::ops::Range<f64>) -> Result<HalfPlaneGround> {
        let strip = Strip::new(range, self.elements, self.grading)?;
        Ok(HalfPlaneGround::new(soil, &[strip])?.with_history_kind(self.history))
    }
}

/// One line of the estimated spectrum.
struct Line {
    /// ωB/c_S.
    a: f64,
    /// |u_ff|², up to a factor common to all lines.
    motion: f64,
}

/// Elements, grading and time step for a base shear within `tolerance` (relative, 10⁻⁴ to ½).
///
/// Nothing is computed in time. The base shear of the outline on a rigid strip under a motion of
/// this `content` is estimated in the frequency domain, once as it is, once with the strip's
/// stiffnesses in error as much as Q elements make them, once as steps of Δt make it: frequency warped,
/// forces averaged, and the soil damped by tractions that are constant over a step. Q is the smallest
/// and Δt the largest with which
///
/// * the change by the mesh, in the root-mean-square sense over the record's duration,
/// * the change by the step, in the same sense,
/// * the loss of a peak that is averaged over a step and falls anywhere in it, (ωΔt)²/12 with
///   ω² = ∫ω⁴|V|²/∫ω²|V|², the frequency of the peaks of the base shear V,
///
/// each stay within 0.6 of the tolerance. The first two include how a lightly damped response amplifies
/// errors; they grow until it has decayed, or the record ends. A flat content has no end.
///
/// # What is assumed
///
/// A bonded base, as good as rigid; one mode of sway at most; the energy of the response below
/// `4 c_S/B` (see [`Advice::beyond_measured`]); soil as deep as the half-plane; a structure that is
/// itself well meshed. The tolerance is that of the **base shear**: rotations come out about twice,
/// a slender structure's base moment up to six times as far off. With uplift and sliding errors
/// are erratic, and were measured in one scene only; there the advice is where to begin, and a second
/// run with half of Δt and twice the elements is what tells
/// ([measurements](https://github.com/basemat/basemat/blob/main/docs/validation.md)).
///
/// ```
/// use basemat::Soil;
/// use basemat::coupled::{Outline, advise};
/// use basemat::motion::{FrequencyContent, el_centro_1940};
///
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let content = FrequencyContent::of(&el_centro_1940())?;
/// // 10 m wide, 15 m high, 150 t/m, 2 Hz with 5 % of damping
/// let outline = Outline::new(10.0, 15.0, 150.0e3)?.with_frequency(2.0, 0.05)?;
/// let advice = advise(soil, &outline, &content, 0.01)?;
/// println!("{advice}");
/// assert!((8..40).contains(&advice.elements));
/// assert!(advice.time_step > 1.0e-3 && advice.time_step < 2.0e-2);
/// let ground = advice.ground(soil, -5.0..5.0)?;
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`] for a tolerance out of range or one that would take more than a thousand
/// elements, and when outline and soil are so far apart that numbers overflow.
pub fn advise(
    soil: Soil,
    outline: &Outline,
    content: &FrequencyContent,
    tolerance: f64,
) -> Result<Advice> {
    if !(1e-4..=0.5).contains(&tolerance) {
        let needed = "from 0.0001 to 0.5";
        return Err(Error::Input { quantity: "tolerance", value: tolerance, needed });
    }
    let half = 0.5 * outline.width;
    // Time unit: B/c_S.
    let unit =
        positive("time in which an S wave crosses the base", half / soil.shear_wave_speed())?;
    let mass = positive("mass of the outline", outline.mass / (soil.density() * half * half))?;
    let height = positive("height of the outline", outline.height / half)?;
    let sway = outline.sway.map(|[frequency, damping]| [TAU * frequency * unit, damping]);
    let duration = content.duration().map(|duration| duration / unit);
    let estimate = Estimate {
        sketch: Sketch::new(soil, mass, height, sway, duration),
        lines: content
            .lines()
            .map(|(frequency, energy)| {
                let a = TAU * frequency * unit;
                Line { a, motion: energy / a.powi(4) }
            })
            .collect(),
    };
    let Moments { norm, square, fourth, beyond } = estimate.moments();
    let norm = positive("estimated energy of the base shear", norm)?;
    let rate = positive("estimated frequency of the base shear", (square / norm).sqrt())?;
    let sharp = positive("estimated frequency of its peaks", (fourth / square).sqrt())?;
    let allowed = SHARE * tolerance;

    let mesh = |elements: usize| estimate.mesh_error(elements, norm);
    let [mut few, mut enough] = ELEMENTS;
    if not_negative("expected error", mesh(enough))? > allowed {
        let needed = "larger, or more than 1000 elements";
        return Err(Error::Input { quantity: "tolerance", value: tolerance, needed });
    }
    while few < enough {
        let middle = usize::midpoint(few, enough);
        if mesh(middle) <= allowed { enough = middle } else { few = middle + 1 }
    }

    let peak = |step: f64| (sharp * step).powi(2) / 12.0;
    // The largest step by its peaks; then down by what two digits resolve.
    let mut step = largest_step(unit * (12.0 * allowed).sqrt() / sharp)? / unit;
    let step_error = |step: f64| estimate.step_error(step, enough, norm);
    loop {
        let error = not_negative("expected error", step_error(step))?;
        if error <= allowed {
            break;
        }
        // Errors fall with the square of the step or slower: this does not overshoot.
        let factor = (allowed / error).sqrt().clamp(0.7, 1.0);
        step = largest_step(0.98 * factor * step * unit)? / unit;
    }
    let crossing = half * edge(enough) / soil.pressure_wave_speed();
    Ok(Advice {
        elements: enough,
        grading: Grading::Cosine,
        time_step: step * unit,
        stiffness_error: stiffness_error(enough),
        history: History::Auto,
        tolerance,
        mesh_error: mesh(enough),
        step_error: step_error(step),
        peak_error: peak(step),
        frequency: rate / (TAU * unit),
        beyond_measured: beyond / norm,
        steps_per_crossing: crossing / (step * unit),
    })
}

/// The largest time step of two significant digits that is not above `value` (s).
fn largest_step(value: f64) -> Result<f64> {
    let scale = 10.0_f64.powf(value.log10().floor() - 1.0);
    positive("advised time step", (value / scale * (1.0 + 1e-12)).floor() * scale)
}

/// Errors of the strip's horizontal and rocking stiffness on so many graded elements.
fn stiffness_error(elements: usize) -> StiffnessError {
    let [horizontal, rocking] = [HORIZONTAL, ROCKING].map(|f| f / (elements as f64).powi(2));
    StiffnessError { horizontal, rocking }
}

/// Length of the shortest of so many graded elements, which is at the edge, over half the width.
fn edge(elements: usize) -> f64 {
    1.0 - (PI / elements as f64).cos()
}

/// Sums over the lines.
#[derive(Default)]
struct Moments {
    /// Of |V|².
    norm: f64,
    /// Of a₀² |V|².
    square: f64,
    /// Of a₀⁴ |V|².
    fourth: f64,
    /// Of |V|² where a₀ is beyond what was measured.
    beyond: f64,
}

struct Estimate {
    sketch: Sketch,
    lines: Vec<Line>,
}

impl Estimate {
    fn moments(&self) -> Moments {
        let mut sums = Moments::default();
        for line in &self.lines {
            let energy =
                line.motion * self.sketch.shear(line.a, StiffnessError::default()).norm_sqr();
            let square = line.a * line.a;
            sums.norm += energy;
            sums.square += square * energy;
            sums.fourth += square * square * energy;
            sums.beyond += if line.a > MEASURED { energy } else { 0.0 };
        }
        sums
    }

    /// Relative change of V by the errors of stiffness that Q elements bring.
    fn mesh_error(&self, elements: usize, norm: f64) -> f64 {
        let error = stiffness_error(elements);
        self.change(norm, |a| {
            self.sketch.shear(a, error) - self.sketch.shear(a, StiffnessError::default())
        })
    }

    /// Relative change of V by steps (in units of B/c_S) on so many elements, compared with its mean
    /// over each step.
    fn step_error(&self, step: f64, elements: usize, norm: f64) -> f64 {
        let steps = Steps { step, edge: edge(elements) };
        self.change(norm, |a| {
            let phase = (0.5 * a * step).min(1.5);
            let exact = self.sketch.shear(a, StiffnessError::default());
            self.sketch.stepped_shear(a, steps) - exact * (phase.sin() / phase)
        })
    }

    fn change(&self, norm: f64, change: impl Fn(f64) -> realfft::num_complex::Complex<f64>) -> f64 {
        let sum: f64 = self.lines.iter().map(|line| line.motion * change(line.a).norm_sqr()).sum();
        (sum / norm).sqrt()
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let grading = match self.grading {
            Grading::Uniform => "equal",
            Grading::Cosine => "cosine-graded",
        };
        writeln!(
            f,
            "{} {grading} elements, time step {:.2e} s for a base shear within {} %",
            self.elements,
            self.time_step,
            100.0 * self.tolerance
        )?;
        writeln!(
            f,
            "expected: {:.1e} by the mesh, {:.1e} by the step, {:.1e} of the peak; \
             base shear around {:.2} Hz, {:.0} steps a period",
            self.mesh_error,
            self.step_error,
            self.peak_error,
            self.frequency,
            1.0 / (self.frequency * self.time_step)
        )?;
        write!(
            f,
            "assumed: bonded rigid base, one mode of sway at most, {:.1} % of the energy beyond \
             what was measured; with uplift or sliding, compare with half the step and twice the \
             elements",
            100.0 * self.beyond_measured
        )
    }
}
