//! Impedances of a rigid massless strip, from its marched response to pulses.

use basemat::bem::Grading;
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::impedance::{ForceSampling, impedances};
use basemat_problems::rigid_strip::DrivenStrip;
use basemat_problems::series::RelativeError;
use basemat_problems::table;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "strip_impedance",
    title: "Rigid strip impedances",
    reference: "frequency-domain tables (problems of Luco & Westmann, Karasudhi, Keer & Lee)",
    settings: "16 cosine-graded elements, Δt = 0.05 b/c_S, 0.1 ≤ ωb/c_S ≤ 4",
    run,
};

const TIME_STEP: f64 = 0.05;

/// Real and imaginary parts of the impedances `[hh, vv, rr, hr]` over a₀, tabled and computed.
struct StripCurves {
    frequencies: Vec<f64>,
    tabled: Vec<[[f64; 2]; 4]>,
    computed: Vec<[[f64; 2]; 4]>,
}

fn curves(name: &str, poisson: f64, bonded: bool) -> StripCurves {
    let kind = if bonded { "bonded" } else { "relaxed" };
    let columns =
        ["a0", "re_khh", "im_khh", "re_kvv", "im_kvv", "re_krr", "im_krr", "re_khr", "im_khr"];
    let rows = table(&format!("strip_{kind}_nu{name}_xi00.csv")).rows(columns).into_iter();
    let rows: Vec<_> = rows.filter(|row| (0.0999..4.0001).contains(&row[0])).collect();
    let frequencies: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let strip = |contact| DrivenStrip::new(poisson, Grading::Cosine, 16, TIME_STEP, contact);
    let computed = impedances(strip, TIME_STEP, ForceSampling::Mean, bonded, &frequencies);
    let tabled = rows
        .iter()
        .map(|row| std::array::from_fn(|k| [row[2 * k + 1], row[2 * k + 2]]))
        .collect();
    StripCurves { frequencies, tabled, computed }
}

impl StripCurves {
    /// Root mean square of the error, relative to the root mean square of the modulus.
    fn errors(&self) -> [f64; 4] {
        std::array::from_fn(|k| {
            let mut error = RelativeError::default();
            for (computed, tabled) in self.computed.iter().zip(&self.tabled) {
                (0..2).for_each(|part| error.add(computed[k][part], tabled[k][part]));
            }
            error.relative()
        })
    }

    /// Real part (stiffness) or imaginary part over a₀ (dashpot) of component k.
    fn points(&self, list: &[[[f64; 2]; 4]], k: usize, part: usize) -> Vec<(f64, f64)> {
        let impedances = self.frequencies.iter().zip(list);
        impedances
            .map(|(a0, z)| (*a0, if part == 0 { z[k][0] } else { z[k][1] / a0 }))
            .collect()
    }
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let list = [("0333", 1.0 / 3.0), ("025", 0.25), ("0", 0.0)];
    let list = if short { &list[..1] } else { &list[..] };
    let mut checks = Vec::new();
    let mut shown_curves = None;
    let names = ["horizontal", "vertical", "rocking", "coupling"];
    let limits = [3.5e-3, 3.2e-3, 9e-3, 6e-3];
    for bonded in [true, false] {
        let mut max_errors = [0.0_f64; 4];
        for (name, poisson) in list {
            let curves = curves(name, *poisson, bonded);
            for (max_errors, error) in max_errors.iter_mut().zip(curves.errors()) {
                *max_errors = worse(*max_errors, error);
            }
            shown_curves.get_or_insert(curves);
        }
        // Without friction, horizontal and vertical motions are not coupled.
        let kind = if bonded { "bonded" } else { "relaxed" };
        let count = if bonded { 4 } else { 3 };
        let names = names.map(|name| format!("{kind}, {name}"));
        let errors = names.into_iter().zip(max_errors).zip(limits).take(count);
        checks.extend(
            errors.map(|((name, error), limit)| ValidationCheck::below(name, error, limit)),
        );
    }
    let curves = shown_curves.ok_or("no table")?;
    let titles =
        ["horizontal: K_hh/μ", "vertical: K_vv/μ", "rocking: K_rr/(μb²)", "coupling: K_hr/(μb)"];
    let panels = titles.iter().enumerate().map(|(k, title)| {
        let mut panel = FigurePanel::new("a₀ = ωb/c_S", title).room(0.05, 0.85);
        panel = panel.legend(SeriesLabelPosition::UpperMiddle);
        for (part, name, color) in [(0, "Re K", CURVE_BLUE), (1, "Im K / a₀", CURVE_RED)] {
            let tabled = curves.points(&curves.tabled, k, part);
            let computed = curves.points(&curves.computed, k, part);
            panel = panel.reference(&format!("{name}, table"), color, tabled);
            panel = panel.line(&format!("{name}, basemat"), color, computed);
        }
        panel
    });
    let title =
        "Bonded rigid strip of half width b, ν = 1/3: impedances (rotation lowers the right side)";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 2, panels.collect()) })
}
