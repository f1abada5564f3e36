//! The sweeps: pairs of parameters, with all others as in [`StabilityScene::default`].

use basemat::history::HistoryMethod;

use super::motions::{SHAKING_MOTIONS, ShakingMotion};
use super::run::Verdict;
use super::scene::{StabilityLaw, StabilityScene, StabilityScheme};

/// Sets the value with this number in a scene.
type SetValue = dyn Fn(usize, &mut StabilityScene) + Sync;

/// A parameter and its values.
pub(crate) struct MapAxis {
    pub(crate) name: &'static str,
    pub(crate) labels: Vec<String>,
    set: Box<SetValue>,
}

impl MapAxis {
    fn numbers(name: &'static str, values: &[f64], set: fn(&mut StabilityScene, f64)) -> Self {
        let values = values.to_vec();
        let labels = values.iter().map(|&value| label(value)).collect();
        Self { name, labels, set: Box::new(move |k, scene| set(scene, values[k])) }
    }

    fn motions() -> Self {
        Self {
            name: "motion",
            labels: SHAKING_MOTIONS.iter().map(|(name, _)| (*name).to_owned()).collect(),
            set: Box::new(|k, scene| scene.motion = SHAKING_MOTIONS[k].1),
        }
    }

    fn friction(short: bool) -> Self {
        let mut laws: Vec<(String, StabilityLaw)> = [0.0, 0.05, 0.2, 0.4, 0.7, 1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .filter(|friction| !short || [0.0, 0.4, 10.0].contains(friction))
            .map(|friction| (label(friction), StabilityLaw::Coulomb(friction)))
            .collect();
        laws.push(("infinite".into(), StabilityLaw::Coulomb(f64::INFINITY)));
        laws.push(("bonded".into(), StabilityLaw::Bonded));
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
pub(crate) struct StabilityMap {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) x: MapAxis,
    pub(crate) y: MapAxis,
    pub(crate) schemes: &'static [StabilityScheme],
    pub(crate) base: StabilityScene,
    /// Verdicts other than bounded that cells of the crate's scheme may have.
    pub(crate) allowed: &'static [Verdict],
    /// Whether it has a picture.
    pub(crate) drawn: bool,
}

impl StabilityMap {
    /// The scene of a cell.
    pub(crate) fn scene(&self, scheme: StabilityScheme, x: usize, y: usize) -> StabilityScene {
        let mut scene = StabilityScene { scheme, ..self.base };
        (self.x.set)(x, &mut scene);
        (self.y.set)(y, &mut scene);
        scene
    }
}

/// The sweep that compares time schemes.
pub(crate) const SCHEME_MAP: &str = "time_schemes";

const CRATE_SCHEME: &[StabilityScheme] = &[StabilityScheme::Basemat];
const TIME_SCHEMES: &[StabilityScheme] = &[
    StabilityScheme::Basemat,
    StabilityScheme::Dissipative,
    StabilityScheme::Newmark,
    StabilityScheme::Hht,
];
const SOIL_SCHEMES: &[StabilityScheme] =
    &[StabilityScheme::Basemat, StabilityScheme::Paper, StabilityScheme::Quadrature];
const STEP_BETAS: [f64; 11] = [0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0];
const POISSON_RATIOS: [f64; 12] =
    [-0.9, -0.5, 0.0, 0.2, 0.25, 0.333, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999];

/// All values, or in the short form every `every`-th value and the last one.
fn thin(values: &[f64], short: bool, every: usize) -> Vec<f64> {
    if !short {
        return values.to_vec();
    }
    let last_index = values.len() - 1;
    values
        .iter()
        .enumerate()
        .filter(|(k, _)| k % every == 0 || *k == last_index)
        .map(|(_, &value)| value)
        .collect()
}

/// 10^first … 10^last.
fn decades(first: i32, last: i32, short: bool, every: usize) -> Vec<f64> {
    let all: Vec<f64> = (first..=last).map(|k| format!("1e{k}").parse().unwrap_or(1.0)).collect();
    thin(&all, short, every)
}

/// Axes in their full and short forms.
impl MapAxis {
    fn beta(short: bool, every: usize) -> Self {
        Self::numbers("β = c₁Δt/l", &thin(&STEP_BETAS, short, every), |scene, value| {
            scene.beta = value;
        })
    }

    fn stiffness(short: bool) -> Self {
        let values = decades(-8, 8, short, 8);
        Self::numbers("stiffness of structure / of soil", &values, |scene, value| {
            scene.stiffness = value;
        })
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
    fn elements(short: bool, count: usize) -> Self {
        let values = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
        let count = if short { 5 } else { count };
        Self::numbers("elements", &values[..count], |scene, value| {
            scene.elements = value as usize;
        })
    }

    fn layer(short: bool, set: fn(&mut StabilityScene, f64)) -> Self {
        let ratios = thin(&[1.0, 0.3, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6], short, 3);
        Self::numbers("thin-layer ratio", &ratios, set)
    }
}

/// All sweeps.
pub(crate) fn maps(short: bool) -> Vec<StabilityMap> {
    let base =
        StabilityScene { steps: if short { 150 } else { 1000 }, ..StabilityScene::default() };
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
    [x, y]: [MapAxis; 2],
    schemes: &'static [StabilityScheme],
    base: StabilityScene,
) -> StabilityMap {
    StabilityMap { name, title, x, y, schemes, base, allowed: &[], drawn: true }
}

fn soil_and_structure(short: bool, base: StabilityScene) -> Vec<StabilityMap> {
    let poisson =
        MapAxis::numbers("Poisson's ratio", &thin(&POISSON_RATIOS, short, 4), |scene, value| {
            scene.poisson = value;
        });
    let mass = MapAxis::numbers("mass ratio", &decades(-4, 4, short, 4), |scene, value| {
        scene.mass = value;
    });
    // Rounding decides the static state of very stiff structures.
    let allowed: &[Verdict] = &[Verdict::Refused];
    vec![
        map(
            "beta_poisson",
            "Time step and Poisson's ratio",
            [MapAxis::beta(short, 3), poisson],
            SOIL_SCHEMES,
            base,
        ),
        map(
            "beta_friction",
            "Time step and friction",
            [MapAxis::beta(short, 3), MapAxis::friction(short)],
            SOIL_SCHEMES,
            base,
        ),
        StabilityMap {
            allowed,
            ..map(
                "stiffness_mass",
                "Stiffness and mass of a flexible structure",
                [MapAxis::stiffness(short), mass],
                CRATE_SCHEME,
                base,
            )
        },
        StabilityMap {
            allowed,
            ..map(
                "beta_stiffness",
                "Time step and stiffness of the structure",
                [MapAxis::beta(short, 5), MapAxis::stiffness(short)],
                SOIL_SCHEMES,
                base,
            )
        },
    ]
}

fn mesh_and_contact(short: bool, base: StabilityScene) -> Vec<StabilityMap> {
    let slenderness = MapAxis::numbers(
        "slenderness h/b",
        &thin(&[0.05, 0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0], short, 5),
        |scene, value| scene.slenderness = value,
    );
    let grading =
        MapAxis::numbers("longest/shortest element", &decades(0, 4, short, 2), |scene, value| {
            scene.grading = value;
        });
    vec![
        map(
            "friction_slenderness",
            "Friction and slenderness",
            [MapAxis::friction(short), slenderness],
            CRATE_SCHEME,
            base,
        ),
        map(
            "elements_grading",
            "Elements and their grading",
            [MapAxis::elements(short, 9), grading],
            CRATE_SCHEME,
            StabilityScene { steps: base.steps.min(200), ..base },
        ),
        map(
            "beta_elements",
            "Time step and number of elements",
            [MapAxis::beta(short, 5), MapAxis::elements(short, 6)],
            SOIL_SCHEMES,
            StabilityScene { steps: base.steps.min(500), ..base },
        ),
        map(
            "beta_layer",
            "Time step and thickness of interface elements that let go entirely",
            [
                MapAxis::beta(short, 5),
                MapAxis::layer(short, |scene, ratio| scene.law = StabilityLaw::Layer(ratio, 0.0)),
            ],
            CRATE_SCHEME,
            base,
        ),
        StabilityMap {
            allowed: &[Verdict::Failed],
            ..map(
                "beta_layer_as_printed",
                "Time step and thickness of interface elements that keep 1/1000 of their stiffness",
                [
                    MapAxis::beta(short, 5),
                    MapAxis::layer(short, |scene, ratio| {
                        scene.law = StabilityLaw::Layer(ratio, 1e-3);
                    }),
                ],
                &[StabilityScheme::Basemat, StabilityScheme::Paper],
                base,
            )
        },
        map(
            "friction_motion",
            "Friction and ground motion",
            [MapAxis::friction(short), MapAxis::motions()],
            SOIL_SCHEMES,
            base,
        ),
    ]
}

fn loads_and_bearing(short: bool, base: StabilityScene) -> Vec<StabilityMap> {
    let push = MapAxis::numbers(
        "load / weight",
        &thin(&[0.01, 0.1, 0.3, 1.0, 3.0, 10.0], short, 3),
        |scene, value| scene.push = value,
    );
    let tilt = MapAxis::numbers(
        "initial tilt / (b/h)",
        &thin(&[1e-6, 1e-3, 0.01, 0.1, 0.3, 0.9], short, 3),
        |scene, value| scene.tilt = value,
    );
    let bearing = MapAxis::numbers(
        "bearing pressure / mean pressure",
        &thin(&[1.02, 1.1, 1.5, 2.0, 3.0, 10.0, 100.0], short, 3),
        |scene, ratio| scene.law = StabilityLaw::Yielding(ratio),
    );
    vec![
        map("beta_load", "Time step and load", [MapAxis::beta(short, 3), push], CRATE_SCHEME, base),
        map(
            "beta_tilt",
            "Time step and initial tilt",
            [MapAxis::beta(short, 3), tilt],
            CRATE_SCHEME,
            base,
        ),
        map(
            "beta_bearing",
            "Time step and bearing pressure",
            [MapAxis::beta(short, 3), bearing],
            CRATE_SCHEME,
            base,
        ),
    ]
}

/// Time schemes on the half-plane, under a base that may open and cannot slide.
fn schemes(short: bool, base: StabilityScene) -> StabilityMap {
    let masses = thin(&[0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0], short, 3);
    let mass = MapAxis::numbers("mass ratio", &masses, |scene, value| scene.mass = value);
    let base =
        StabilityScene { law: StabilityLaw::Coulomb(f64::INFINITY), slenderness: 1.0, ..base };
    let axes = [MapAxis::beta(short, 3), mass];
    map(SCHEME_MAP, "Time schemes: time step and mass", axes, TIME_SCHEMES, base)
}

/// Single runs of many steps.
fn long_runs(short: bool) -> StabilityMap {
    /// Name, law, β and history.
    type LongCase = (&'static str, StabilityLaw, f64, HistoryMethod);
    let cases: [LongCase; 5] = [
        ("friction 0.4 (β = 5)", StabilityLaw::Coulomb(0.4), 5.0, HistoryMethod::Exponentials),
        (
            "uplift only (β = 2)",
            StabilityLaw::Coulomb(f64::INFINITY),
            2.0,
            HistoryMethod::Exponentials,
        ),
        ("bonded (β = 0.5)", StabilityLaw::Bonded, 0.5, HistoryMethod::Exponentials),
        ("smooth (β = 0.05)", StabilityLaw::Coulomb(0.0), 0.05, HistoryMethod::Exponentials),
        (
            "friction 0.4 (β = 5; transforms)",
            StabilityLaw::Coulomb(0.4),
            5.0,
            HistoryMethod::RelaxedFft,
        ),
    ];
    let cases = if short { &cases[..1] } else { &cases[..] }.to_vec();
    let labels = cases.iter().map(|case| case.0.to_owned()).collect();
    StabilityMap {
        name: "long_noise",
        title: "A million steps of noise",
        x: MapAxis::numbers(
            "steps of noise",
            &[if short { 10_000.0 } else { 1e6 }],
            |scene, value| {
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a count"
                )]
                let steps = value as usize;
                scene.steps = steps;
            },
        ),
        y: MapAxis {
            name: "case",
            labels,
            set: Box::new(move |k, scene| {
                let case = &cases[k];
                scene.law = case.1;
                scene.beta = case.2;
                scene.history = case.3;
                if case.3 == HistoryMethod::RelaxedFft {
                    scene.steps /= 10;
                }
            }),
        },
        schemes: CRATE_SCHEME,
        base: StabilityScene { motion: ShakingMotion::Noise, ..StabilityScene::default() },
        allowed: &[],
        drawn: false,
    }
}
