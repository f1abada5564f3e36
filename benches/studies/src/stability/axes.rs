//! The sweeps: pairs of parameters, the rest as in [`Scene::default`].

use basemat::history::HistoryMethod;

use super::motions::{MOTIONS, Motion};
use super::run::Verdict;
use super::scene::{Law, Scene, Scheme};

/// Puts the value of a number into a scene.
type SetValue = dyn Fn(usize, &mut Scene) + Sync;

/// A parameter and the values it takes.
pub(crate) struct Axis {
    pub(crate) name: &'static str,
    pub(crate) labels: Vec<String>,
    set: Box<SetValue>,
}

impl Axis {
    fn numbers(name: &'static str, values: &[f64], set: fn(&mut Scene, f64)) -> Self {
        let values = values.to_vec();
        let labels = values.iter().map(|&value| label(value)).collect();
        Self { name, labels, set: Box::new(move |k, scene| set(scene, values[k])) }
    }

    fn motions() -> Self {
        Self {
            name: "motion",
            labels: MOTIONS.iter().map(|(name, _)| (*name).to_owned()).collect(),
            set: Box::new(|k, scene| scene.motion = MOTIONS[k].1),
        }
    }

    fn friction(short: bool) -> Self {
        let mut laws: Vec<(String, Law)> = [0.0, 0.05, 0.2, 0.4, 0.7, 1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .filter(|friction| !short || [0.0, 0.4, 10.0].contains(friction))
            .map(|friction| (label(friction), Law::Coulomb(friction)))
            .collect();
        laws.push(("infinite".into(), Law::Coulomb(f64::INFINITY)));
        laws.push(("bonded".into(), Law::Bonded));
        Self {
            name: "friction",
            labels: laws.iter().map(|(name, _)| name.clone()).collect(),
            set: Box::new(move |k, scene| scene.law = laws[k].1),
        }
    }
}

/// Short text for a value.
fn label(value: f64) -> String {
    if value != 0.0 && !(0.01..1000.0).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A sweep over two parameters.
pub(crate) struct Map {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) schemes: &'static [Scheme],
    pub(crate) base: Scene,
    /// Verdicts other than bounded that cells of the crate's own scheme may have.
    pub(crate) allowed: &'static [Verdict],
    /// Whether it is worth a picture.
    pub(crate) drawn: bool,
}

impl Map {
    /// The scene of a cell.
    pub(crate) fn scene(&self, scheme: Scheme, x: usize, y: usize) -> Scene {
        let mut scene = Scene { scheme, ..self.base };
        (self.x.set)(x, &mut scene);
        (self.y.set)(y, &mut scene);
        scene
    }
}

/// The sweep that compares time schemes.
pub(crate) const SCHEME_MAP: &str = "time_schemes";

const OWN: &[Scheme] = &[Scheme::Own];
const SCHEMES: &[Scheme] = &[Scheme::Own, Scheme::Dissipative, Scheme::Newmark, Scheme::Hht];
const ALL: &[Scheme] = &[Scheme::Own, Scheme::Paper, Scheme::Quadrature];
const BETA: [f64; 11] = [0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0];
const POISSON: [f64; 12] =
    [-0.9, -0.5, 0.0, 0.2, 0.25, 0.333, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999];

/// Every `1/few` of `values` and the last one, in the short form.
fn thin(values: &[f64], short: bool, every: usize) -> Vec<f64> {
    if !short {
        return values.to_vec();
    }
    let last = values.len() - 1;
    values
        .iter()
        .enumerate()
        .filter(|(k, _)| k % every == 0 || *k == last)
        .map(|(_, &v)| v)
        .collect()
}

/// 10^first … 10^last.
fn decades(first: i32, last: i32, short: bool, every: usize) -> Vec<f64> {
    let all: Vec<f64> = (first..=last).map(|k| format!("1e{k}").parse().unwrap_or(1.0)).collect();
    thin(&all, short, every)
}

/// Axes in their full and short forms.
impl Axis {
    fn beta(short: bool, every: usize) -> Self {
        Self::numbers("β = c₁Δt/l", &thin(&BETA, short, every), |s, v| s.beta = v)
    }

    fn stiffness(short: bool) -> Self {
        let values = decades(-8, 8, short, 8);
        Self::numbers("stiffness of structure / of soil", &values, |s, v| s.stiffness = v)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
    fn elements(short: bool, count: usize) -> Self {
        let values = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
        let kept = if short { 5 } else { count };
        Self::numbers("elements", &values[..kept], |s, v| s.elements = v as usize)
    }

    fn layer(short: bool, set: fn(&mut Scene, f64)) -> Self {
        let ratios = thin(&[1.0, 0.3, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6], short, 3);
        Self::numbers("thin-layer ratio", &ratios, set)
    }
}

/// All sweeps.
pub(crate) fn maps(short: bool) -> Vec<Map> {
    let base = Scene { steps: if short { 150 } else { 1000 }, ..Scene::default() };
    let mut list = soil_and_structure(short, base);
    list.extend(mesh_and_contact(short, base));
    list.extend(loads_and_bearing(short, base));
    list.push(schemes(short, base));
    list.push(long_runs(short));
    list
}

fn map(
    name: &'static str,
    title: &'static str,
    [x, y]: [Axis; 2],
    schemes: &'static [Scheme],
    base: Scene,
) -> Map {
    Map { name, title, x, y, schemes, base, allowed: &[], drawn: true }
}

fn soil_and_structure(short: bool, base: Scene) -> Vec<Map> {
    let poisson = Axis::numbers("Poisson's ratio", &thin(&POISSON, short, 4), |s, v| s.poisson = v);
    let mass = Axis::numbers("mass ratio", &decades(-4, 4, short, 4), |s, v| s.mass = v);
    // Very stiff structures stand on their rounding.
    let allowed: &[Verdict] = &[Verdict::Refused];
    vec![
        map(
            "beta_poisson",
            "Time step and Poisson's ratio",
            [Axis::beta(short, 3), poisson],
            ALL,
            base,
        ),
        map(
            "beta_friction",
            "Time step and friction",
            [Axis::beta(short, 3), Axis::friction(short)],
            ALL,
            base,
        ),
        Map {
            allowed,
            ..map(
                "stiffness_mass",
                "Stiffness and mass of a flexible structure",
                [Axis::stiffness(short), mass],
                OWN,
                base,
            )
        },
        Map {
            allowed,
            ..map(
                "beta_stiffness",
                "Time step and stiffness of the structure",
                [Axis::beta(short, 5), Axis::stiffness(short)],
                ALL,
                base,
            )
        },
    ]
}

fn mesh_and_contact(short: bool, base: Scene) -> Vec<Map> {
    let slenderness = Axis::numbers(
        "slenderness h/b",
        &thin(&[0.05, 0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0], short, 5),
        |s, v| s.slenderness = v,
    );
    let grading = Axis::numbers("longest/shortest element", &decades(0, 4, short, 2), |s, v| {
        s.grading = v;
    });
    vec![
        map(
            "friction_slenderness",
            "Friction and slenderness",
            [Axis::friction(short), slenderness],
            OWN,
            base,
        ),
        map(
            "elements_grading",
            "Elements and their grading",
            [Axis::elements(short, 9), grading],
            OWN,
            Scene { steps: base.steps.min(200), ..base },
        ),
        map(
            "beta_elements",
            "Time step and number of elements",
            [Axis::beta(short, 5), Axis::elements(short, 6)],
            ALL,
            Scene { steps: base.steps.min(500), ..base },
        ),
        map(
            "beta_layer",
            "Time step and thickness of interface elements that let go entirely",
            [Axis::beta(short, 5), Axis::layer(short, |s, v| s.law = Law::Layer(v, 0.0))],
            OWN,
            base,
        ),
        Map {
            allowed: &[Verdict::Failed],
            ..map(
                "beta_layer_as_printed",
                "Time step and thickness of interface elements that keep 1/1000 of their stiffness",
                [Axis::beta(short, 5), Axis::layer(short, |s, v| s.law = Law::Layer(v, 1e-3))],
                &[Scheme::Own, Scheme::Paper],
                base,
            )
        },
        map(
            "friction_motion",
            "Friction and ground motion",
            [Axis::friction(short), Axis::motions()],
            ALL,
            base,
        ),
    ]
}

fn loads_and_bearing(short: bool, base: Scene) -> Vec<Map> {
    let push = Axis::numbers(
        "load / weight",
        &thin(&[0.01, 0.1, 0.3, 1.0, 3.0, 10.0], short, 3),
        |s, v| {
            s.push = v;
        },
    );
    let tilt = Axis::numbers(
        "initial tilt / (b/h)",
        &thin(&[1e-6, 1e-3, 0.01, 0.1, 0.3, 0.9], short, 3),
        |s, v| s.tilt = v,
    );
    let bearing = Axis::numbers(
        "bearing pressure / mean pressure",
        &thin(&[1.02, 1.1, 1.5, 2.0, 3.0, 10.0, 100.0], short, 3),
        |s, v| s.law = Law::Yielding(v),
    );
    vec![
        map("beta_load", "Time step and load", [Axis::beta(short, 3), push], OWN, base),
        map("beta_tilt", "Time step and initial tilt", [Axis::beta(short, 3), tilt], OWN, base),
        map(
            "beta_bearing",
            "Time step and bearing pressure",
            [Axis::beta(short, 3), bearing],
            OWN,
            base,
        ),
    ]
}

/// Time schemes on the half-plane, under a base that may open and cannot slide.
fn schemes(short: bool, base: Scene) -> Map {
    let masses = thin(&[0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0], short, 3);
    let mass = Axis::numbers("mass ratio", &masses, |s, v| s.mass = v);
    let base = Scene { law: Law::Coulomb(f64::INFINITY), slenderness: 1.0, ..base };
    let axes = [Axis::beta(short, 3), mass];
    map(SCHEME_MAP, "Time schemes: time step and mass", axes, SCHEMES, base)
}

/// Single runs of many steps.
fn long_runs(short: bool) -> Map {
    type Case = (&'static str, Law, f64, HistoryMethod);
    let cases: [Case; 5] = [
        ("friction 0.4 (β = 5)", Law::Coulomb(0.4), 5.0, HistoryMethod::Exponentials),
        ("uplift only (β = 2)", Law::Coulomb(f64::INFINITY), 2.0, HistoryMethod::Exponentials),
        ("bonded (β = 0.5)", Law::Bonded, 0.5, HistoryMethod::Exponentials),
        ("smooth (β = 0.05)", Law::Coulomb(0.0), 0.05, HistoryMethod::Exponentials),
        ("friction 0.4 (β = 5; transforms)", Law::Coulomb(0.4), 5.0, HistoryMethod::RelaxedFft),
    ];
    let kept = if short { &cases[..1] } else { &cases[..] }.to_vec();
    let labels = kept.iter().map(|case| case.0.to_owned()).collect();
    Map {
        name: "long_noise",
        title: "A million steps of noise",
        x: Axis::numbers("steps of noise", &[if short { 10_000.0 } else { 1e6 }], |s, v| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
            let steps = v as usize;
            s.steps = steps;
        }),
        y: Axis {
            name: "case",
            labels,
            set: Box::new(move |k, scene| {
                (scene.law, scene.beta, scene.history) = (kept[k].1, kept[k].2, kept[k].3);
                if kept[k].3 == HistoryMethod::RelaxedFft {
                    scene.steps /= 10;
                }
            }),
        },
        schemes: OWN,
        base: Scene { motion: Motion::Noise, ..Scene::default() },
        allowed: &[],
        drawn: false,
    }
}
