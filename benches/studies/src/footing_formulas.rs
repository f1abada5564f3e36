//! Approximate impedances of rigid footings on a half-space, by the names under which engineers know them.

use basemat::Complex;

/// Impedances of a rigid disc without friction, ν = 1/3, over μR and μR³: sideways, vertical, rocking; `a0` = ωR/c_S.
///
/// Veletsos and Verbic, Earthquake Engineering and Structural Dynamics 2 (1973), 87–102. The coefficients were read in the
/// verification notes of the program SASSI-EDU, which take them from a report of 1980 (Shye and Robinson, SRS 484); the paper
/// was not at hand. At high frequency they are within 4 % of plane waves.
pub(crate) fn veletsos_verbic(a0: f64) -> [Complex; 3] {
    let bent = |[spring, rate, dashpot]: [f64; 3]| {
        let square = (rate * a0).powi(2);
        let part = spring * square / (1.0 + square);
        Complex::new(1.0 - part, a0 * (dashpot + rate * part))
    };
    [Complex::new(1.0, 0.65 * a0) * 4.8, bent([0.35, 0.8, 0.75]) * 6.0, bent([0.8, 0.5, 0.0]) * 4.0]
}

/// Impedances of a rigid rectangle of 2b × 2b · `aspect` over μb and μb³: sideways along the shorter and the longer side,
/// vertical, rocking about the longer axis; `a0` = ωb/c_S.
///
/// Pais and Kausel, "Approximate formulas for dynamic stiffnesses of rigid foundations", Soil Dynamics and Earthquake
/// Engineering 7 (1988), 213–227, as the package geofound and the notes of SASSI-EDU have them from NIST GCR 12-917-21; the
/// paper was not at hand. The two differ in the frequency dependence of the vertical spring, which is left out here, and of
/// rocking about the shorter axis.
pub(crate) fn pais_kausel(poisson: f64, aspect: f64, a0: f64) -> [Complex; 4] {
    let speeds = (2.0 * (1.0 - poisson) / (1.0 - 2.0 * poisson)).sqrt().min(2.5);
    let sway = 6.8 * aspect.powf(0.65);
    let square = a0 * a0;
    let fall = 0.55 + 0.01 * (aspect - 1.0).sqrt();
    let rocking = 1.0 - fall * square / (2.4 - 0.4 / aspect.powi(3) + square);
    let dashpot = square / (2.2 - 0.4 / aspect.powi(3) + square);
    [
        Complex::new((sway + 0.8 * aspect + 1.6) / (2.0 - poisson), 4.0 * aspect * a0),
        Complex::new((sway + 2.4) / (2.0 - poisson), 4.0 * aspect * a0),
        Complex::new((3.1 * aspect.powf(0.75) + 1.6) / (1.0 - poisson), 4.0 * speeds * aspect * a0),
        Complex::new(
            (3.2 * aspect + 0.8) / (1.0 - poisson) * rocking,
            4.0 / 3.0 * speeds * aspect * a0 * dashpot,
        ),
    ]
}
