//! Rigid discs and rectangles on the half-space beside formulas and tables that are known by name.

use std::f64::consts::TAU;

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::reference::pais_kausel_impedances;
use basemat::soil::SoilProfile;
use basemat::{Complex, Soil, unobserved};

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GRAY, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "named_mats",
    title: "Discs and rectangles by name",
    reference: "Veletsos & Verbic 1973; Pais & Kausel 1988; boundary elements of SASSI-EDU (polar meshes, Lamb's kernels, extrapolated)",
    settings: "ν = 1/3; disc of 32 cells across without friction, ωR/c_S = 0.5, 1, 1.5; welded rectangles of 12 cells, ωb/c_S = 0.5, 1",
    run,
};

const POISSON_RATIO: f64 = 1.0 / 3.0;
const MOTION_NAMES: [&str; 4] = ["sideways", "vertical", "rocking", "torsion"];
/// Static stiffness of a disc without friction over μR and μR³.
const STATIC_STIFFNESS: [f64; 4] = [4.8, 6.0, 4.0, 16.0 / 3.0];
/// `VP11_BEM` of SASSI-EDU (github.com/mohammedbala/sassi-edu, commit 70fae46): ωR/c_S, then spring and dashpot over the
/// static stiffness of each motion. No formula of it is used here.
const BOUNDARY_ELEMENTS: [(f64, [[f64; 2]; 4]); 3] = [
    (0.5, [[0.9899, 0.5853], [0.9689, 0.7931], [0.9381, 0.0501], [0.9557, 0.0310]]),
    (1.0, [[0.9652, 0.5991], [0.8826, 0.8239], [0.8253, 0.1353], [0.8667, 0.0913]]),
    (1.5, [[0.9410, 0.6170], [0.7645, 0.8722], [0.7243, 0.2005], [0.7825, 0.1440]]),
];

/// Impedances of a rigid disc without friction, ν = 1/3, over μR and μR³: sideways, vertical, rocking; `a0` = ωR/c_S.
///
/// Veletsos and Verbic, Earthquake Engineering and Structural Dynamics 2 (1973), 87–102. The coefficients were read in
/// the verification notes of the program SASSI-EDU, which take them from a report of 1980 (Shye and Robinson, SRS 484);
/// the paper was not available. They are of one ν and up to 11 % off, so that `basemat::reference` does not have them.
/// At high frequency they are within 4 % of plane waves.
fn veletsos_verbic(a0: f64) -> [Complex; 3] {
    [
        Complex::new(1.0, 0.65 * a0) * 4.8,
        fitted_impedance(a0, [0.35, 0.8, 0.75]) * 6.0,
        fitted_impedance(a0, [0.8, 0.5, 0.0]) * 4.0,
    ]
}

/// Veletsos and Verbic's formula with coefficients of spring, rate and dashpot.
fn fitted_impedance(a0: f64, [spring, rate, dashpot]: [f64; 3]) -> Complex {
    let square = (rate * a0).powi(2);
    let part = spring * square / (1.0 + square);
    Complex::new(1.0 - part, a0 * (dashpot + rate * part))
}

/// Impedances over μb and μb³ at frequencies ωb/c_S: sideways along y and x, vertical, rocking about y, torsion.
fn computed(plan: &Plan, a0: &[f64], contact: StripContact) -> Result<Vec<[Complex; 5]>, AnyError> {
    let profile = SoilProfile::on_half_plane(Soil::new(1.0, POISSON_RATIO, 1.0)?);
    let frequencies: Vec<f64> = a0.iter().map(|a0| a0 / TAU).collect();
    let impedances = impedances_in_plan(&profile, plan, &frequencies, contact, &mut unobserved)?;
    let diagonals =
        impedances.iter().map(|impedance| [1, 0, 2, 4, 5].map(|k| impedance.matrix[k][k]));
    Ok(diagonals.collect())
}

/// Relative difference of two complex numbers.
fn relative_difference(computed: Complex, reference: Complex) -> f64 {
    (computed - reference).abs() / reference.abs()
}

/// Spring or dashpot of an impedance at ωR/c_S.
type ImpedancePart = fn(Complex, f64) -> f64;

/// Curve of Veletsos and Verbic's formulas for a motion.
fn fitted_curve(motion: usize, part: ImpedancePart) -> Vec<(f64, f64)> {
    let frequencies = (1..=60).map(|n| 0.025 * f64::from(n));
    frequencies
        .map(|a0| (a0, part(veletsos_verbic(a0)[motion], a0) / STATIC_STIFFNESS[motion]))
        .collect()
}

/// Checks and panels of the disc.
fn disc(short: bool) -> Result<(Vec<ValidationCheck>, Vec<FigurePanel>), AnyError> {
    let frequencies = BOUNDARY_ELEMENTS.map(|(a0, _)| a0);
    let plan = Plan::disc([0.0; 2], 1.0, if short { 16 } else { 32 })?;
    let impedances = computed(&plan, &frequencies, StripContact::Relaxed)?;
    let computed: Vec<[Complex; 4]> =
        impedances.iter().map(|impedance| [0, 2, 3, 4].map(|k| impedance[k])).collect();
    let mut checks = Vec::new();
    for (k, name) in MOTION_NAMES.into_iter().enumerate() {
        let errors = computed.iter().zip(BOUNDARY_ELEMENTS).map(|(computed, (a0, values))| {
            let reference = Complex::new(values[k][0], a0 * values[k][1]) * STATIC_STIFFNESS[k];
            relative_difference(computed[k], reference)
        });
        let limit = if short { 2e-2 } else { [3e-3, 3e-3, 7e-3, 4e-3][k] };
        let label = format!("disc, {name}: from SASSI-EDU's boundary elements, relative");
        checks.push(ValidationCheck::below(label, errors.fold(0.0, worse), limit));
    }
    // The formulas are fits with errors of 5 to 11 %.
    for (k, limits) in [0.045..=0.075, 0.03..=0.06, 0.09..=0.13].into_iter().enumerate() {
        let errors = computed
            .iter()
            .zip(frequencies)
            .map(|(computed, a0)| relative_difference(veletsos_verbic(a0)[k], computed[k]));
        let error = errors.fold(0.0, worse);
        let label = format!("disc, {}: Veletsos and Verbic, relative", MOTION_NAMES[k]);
        checks.push(ValidationCheck::within(label, error, limits));
    }
    let dashpot = veletsos_verbic(0.5)[2].im / computed[0][2].im;
    let name = "disc, rocking, ωR/c_S = 0.5: dashpot of Veletsos and Verbic over basemat's";
    checks.push(ValidationCheck::within(name, dashpot, 0.44..=0.5));

    let parts: [(&str, ImpedancePart); 2] = [
        ("spring over the static one", |impedance, _| impedance.re),
        ("dashpot × c_S/R over the static spring", |impedance, a0| impedance.im / a0),
    ];
    let panels = parts.into_iter().enumerate().map(|(column, (label, part))| {
        let mut panel = FigurePanel::new("ωR/c_S", label).room(0.05, 0.9);
        for (k, color) in [CURVE_BLUE, CURVE_GREEN, CURVE_RED].into_iter().enumerate() {
            let points = frequencies
                .into_iter()
                .zip(&computed)
                .map(|(a0, impedance)| (a0, part(impedance[k], a0) / STATIC_STIFFNESS[k]));
            let table =
                BOUNDARY_ELEMENTS.iter().map(|(a0, values)| (*a0, values[k][column])).collect();
            panel = panel
                .line(
                    &format!("{}, Veletsos and Verbic", MOTION_NAMES[k]),
                    color,
                    fitted_curve(k, part),
                )
                .crosses(
                    if k == 0 { "boundary elements of SASSI-EDU" } else { "" },
                    CURVE_GRAY,
                    table,
                )
                .circles(&format!("{}, basemat", MOTION_NAMES[k]), color, points.collect());
        }
        panel
    });
    Ok((checks, panels.collect()))
}

/// Checks of welded rectangles beside Pais and Kausel, whose values are divided by computed values.
fn rectangles(short: bool) -> Result<Vec<ValidationCheck>, AnyError> {
    let frequencies = [0.5, 1.0];
    let mut checks = Vec::new();
    // Largest difference sideways along the shorter and the longer side and of rocking; dashpots at each frequency.
    let limits = [
        (
            1.0,
            "square",
            [0.02..=0.04, 0.02..=0.04, 0.05..=0.08],
            [[1.21..=1.26, 0.73..=0.78], [1.18..=1.23, 0.85..=0.9]],
        ),
        (
            2.0,
            "2 : 1",
            [0.04..=0.065, 0.04..=0.065, 0.08..=0.11],
            [[1.15..=1.2, 0.44..=0.49], [1.11..=1.16, 0.63..=0.68]],
        ),
    ];
    for (aspect, name, limits, dashpots) in &limits[..if short { 1 } else { 2 }] {
        let plan = Plan::rectangle(-1.0..1.0, -*aspect..*aspect, if short { 8 } else { 12 })?;
        let computed = computed(&plan, &frequencies, StripContact::Bonded)?;
        let soil = Soil::new(1.0, POISSON_RATIO, 1.0)?;
        let formulas = frequencies
            .map(|a0| pais_kausel_impedances(soil, [2.0, 2.0 * aspect], a0 / TAU))
            .into_iter()
            .collect::<Result<Vec<_>, _>>()?;
        // Along x is along the shorter side.
        let motions =
            ["sideways along the shorter side", "sideways along the longer side", "rocking"];
        for ((motion, limits), [k, computed_k]) in
            motions.into_iter().zip(limits).zip([[0, 1], [1, 0], [3, 3]])
        {
            let errors = formulas
                .iter()
                .zip(&computed)
                .map(|(formula, computed)| relative_difference(formula[k], computed[computed_k]));
            let label = format!("{name}, {motion}: Pais and Kausel, relative");
            checks.push(ValidationCheck::within(label, errors.fold(0.0, worse), limits.clone()));
        }
        for (n, a0) in frequencies.into_iter().enumerate() {
            for (motion, k, limits) in
                [("vertical", 2, &dashpots[n][0]), ("rocking", 3, &dashpots[n][1])]
            {
                let label = format!(
                    "{name}, {motion}, ωb/c_S = {a0}: dashpot of Pais and Kausel over basemat's"
                );
                let ratio = formulas[n][k].im / computed[n][k].im;
                checks.push(ValidationCheck::within(label, ratio, limits.clone()));
            }
        }
    }
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, if short { 8 } else { 12 })?;
    let at_rest = computed(&plan, &[0.0], StripContact::Bonded)?[0];
    // A mat lifts at N L/4.4 (case `uplift_law`), two springs at ±a at N a.
    let spring_distance = (at_rest[3].re / at_rest[2].re).sqrt();
    let name =
        "square: distance a over b of two springs that have its vertical and its rocking stiffness";
    checks.push(ValidationCheck::within(name, spring_distance, 0.94..=0.97));
    Ok(checks)
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let (mut checks, panels) = disc(short)?;
    checks.extend(rectangles(short)?);
    let title = "Rigid disc without friction on the half-space, ν = 1/3";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels) })
}
