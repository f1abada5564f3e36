//! GOAL: bearing capacities follow EN 1997-1, Annex D, and their moment makes a footing rock.
//! SCENE: drained and undrained soil under strips, rectangles and circles, with inclined and eccentric loads.
//! REFERENCE: stress characteristics integrated here, tables, a worked example, statics of a pressed edge.

use std::f64::consts::{FRAC_PI_2, PI};

use basemat::Result;
use basemat::soil::{BearingFactors, FootingLoad, ShallowFooting, SoilStrength};

use basemat_problems::assert_close;
use basemat_problems::rocking_footing::{
    BEARING_PRESSURE, FOOTING_SIDES, SAND_DENSITY, VERTICAL_FORCE,
};

fn strength(degrees: f64) -> SoilStrength {
    SoilStrength::new(f64::to_radians(degrees)).unwrap()
}

/// Pressure under a strip on weightless soil between the passive zone beside it and the active zone below it.
///
/// The mean stress grows through the fan by ds/dψ = 2 (s tan φ + c) while the principal directions turn by a right angle
/// (Prandtl 1920, Reissner 1924); fourth-order Runge–Kutta.
fn pressure_by_characteristics(friction_angle: f64, cohesion: f64, surcharge: f64) -> f64 {
    let sine = friction_angle.sin();
    let radius_by_cohesion = cohesion * friction_angle.cos();
    // The surcharge is the smaller principal stress of the passive zone.
    let mut mean = (surcharge + radius_by_cohesion) / (1.0 - sine);
    let slope = |mean: f64| 2.0 * (mean * friction_angle.tan() + cohesion);
    let steps = 2000;
    let step = FRAC_PI_2 / f64::from(steps);
    for _ in 0..steps {
        let first = slope(mean);
        let second = slope(mean + 0.5 * step * first);
        let third = slope(mean + 0.5 * step * second);
        let fourth = slope(mean + step * third);
        mean += step * (first + 2.0 * second + 2.0 * third + fourth) / 6.0;
    }
    mean * (1.0 + sine) + radius_by_cohesion
}

#[test]
fn factors_are_those_of_stress_characteristics() {
    for degrees in [0.0_f64, 1e-6, 0.01, 1.0, 10.0, 20.0, 30.0, 35.0, 40.0, 45.0] {
        let angle = degrees.to_radians();
        let factors = BearingFactors::new(angle).unwrap();
        let cohesion = pressure_by_characteristics(angle, 1.0, 0.0);
        let surcharge = pressure_by_characteristics(angle, 0.0, 1.0);
        assert_close("N_c", factors.cohesion, cohesion, 0.0, 1e-10);
        assert_close("N_q", factors.surcharge, surcharge, 0.0, 1e-10);
    }
    assert_close("N_c", BearingFactors::new(0.0).unwrap().cohesion, PI + 2.0, 0.0, 1e-15);
}

/// N_c and N_q as in textbooks (Das, *Principles of Foundation Engineering*); N_γ at 30° and 36° from a spreadsheet
/// for Annex D (scribd.com/document/383761215).
#[test]
fn factors_are_those_of_tables() {
    let table = [
        (0.0, 5.14, 1.00),
        (10.0, 8.34, 2.47),
        (20.0, 14.83, 6.40),
        (30.0, 30.14, 18.40),
        (35.0, 46.12, 33.30),
        (36.0, 50.59, 37.75),
        (40.0, 75.31, 64.20),
    ];
    for (degrees, cohesion, surcharge) in table {
        let factors = BearingFactors::new(f64::to_radians(degrees)).unwrap();
        assert_close("N_c", factors.cohesion, cohesion, 6e-3, 0.0);
        assert_close("N_q", factors.surcharge, surcharge, 6e-3, 0.0);
    }
    for (degrees, unit_weight) in [(0.0, 0.0), (30.0, 20.09), (36.0, 53.40)] {
        let factors = BearingFactors::new(f64::to_radians(degrees)).unwrap();
        assert_close("N_γ", factors.unit_weight, unit_weight, 6e-3, 0.0);
    }
}

/// The spreadsheet's base of 1 m × 6 m, 0.75 m deep in soil of 10 kN/m³.
///
/// The load is 200 kN down, 60 kN across and 30 kN along the base.
///
/// It prints s_q = 1.07, s_γ = 0.96, i_q = 0.493631, i_γ = 0.328062, i_c = 0.464531 and a pressure of 95 kPa.
#[test]
fn inclined_and_eccentric_loads_follow_a_worked_example() -> Result<()> {
    let load = FootingLoad { vertical: 200.0e3, horizontal: [60.0e3, -30.0e3] };
    let soil = strength(30.0);
    let base = ShallowFooting::rectangle([1.0, 6.0])?
        .with_eccentricity([0.15, -0.44])?
        .with_load(load)?;
    assert_close("width", base.effective_sides()[0], 0.7, 1e-12, 0.0);
    assert_close("area", base.effective_area(), 3.584, 1e-12, 0.0);
    let deep_base = base.with_surcharge(7.5e3)?;
    assert_close("pressure", deep_base.drained_pressure(&soil, 10.0e3)?, 95.0e3, 0.5e3, 0.0);
    // The terms of the pressure one by one, with N_q = 18.40 and N_γ = 20.09.
    let by_surcharge = deep_base.drained_pressure(&soil, 0.0)?;
    let shape = 1.0 + 0.7 / 5.12 * 0.5;
    assert_close("i_q", by_surcharge / (7.5e3 * 18.4011 * shape), 0.493_631, 0.0, 1e-5);
    let by_weight = base.drained_pressure(&soil, 10.0e3)?;
    let shape = 1.0 - 0.3 * 0.7 / 5.12;
    assert_close("i_γ", by_weight / (0.5 * 10.0e3 * 0.7 * 20.0931 * shape), 0.328_062, 0.0, 1e-5);
    // The same base turned by a right angle.
    let turned_base = ShallowFooting::rectangle([6.0, 1.0])?
        .with_eccentricity([0.44, 0.15])?
        .with_load(FootingLoad { horizontal: [30.0e3, 60.0e3], ..load })?
        .with_surcharge(7.5e3)?;
    let pressures =
        [deep_base, turned_base].map(|base| base.drained_pressure(&soil, 10.0e3).unwrap());
    assert_close("turned", pressures[1], pressures[0], 0.0, 1e-14);
    // A cohesion so small that it adds nothing to V.
    let pressure_by_cohesion = base.drained_pressure(&soil.with_cohesion(1e-3)?, 0.0)?;
    let shape = (18.4011 * (1.0 + 0.7 / 5.12 * 0.5) - 1.0) / 17.4011;
    assert_close("i_c", pressure_by_cohesion / (1e-3 * 30.1396 * shape), 0.464_531, 0.0, 2e-5);
    Ok(())
}

#[test]
fn shape_load_and_tilt_factors_follow_annex_d() -> Result<()> {
    // c_u = 50 kPa under 20 kPa of soil: (π + 2) c_u (1, 1.1, 1.2, 1.2) + q.
    let footings = [
        (ShallowFooting::strip(2.0)?, 1.0),
        (ShallowFooting::rectangle([4.0, 2.0])?, 1.1),
        (ShallowFooting::square(2.0)?, 1.2),
        (ShallowFooting::circle(2.0)?, 1.2),
    ];
    for (footing, shape) in footings {
        let pressure = footing.with_surcharge(20.0e3)?.undrained_pressure(50.0e3)?;
        assert_close("undrained", pressure, 20.0e3 + 257.08e3 * shape, 5.0, 0.0);
    }
    // A quarter of the strength of a square of 4 m² is mobilised: i_c = (1 + √¾)/2.
    let load = FootingLoad { vertical: 1e6, horizontal: [0.0, 50.0e3] };
    let pressure = ShallowFooting::square(2.0)?.with_load(load)?.undrained_pressure(50.0e3)?;
    assert_close("i_c", pressure / (1.2 * 257.08e3), 0.933_013, 1e-4, 0.0);
    let tilted_strip = ShallowFooting::strip(2.0)?.with_base_tilt(0.1)?;
    assert_close("b_c", tilted_strip.undrained_pressure(50.0e3)?, (257.08 - 10.0) * 1e3, 5.0, 0.0);
    // (1 − 0.1 tan 30°)² of the terms of surcharge and weight.
    let level = ShallowFooting::strip(2.0)?.with_surcharge(10.0e3)?;
    let tilted_strip = level.with_base_tilt(0.1)?;
    let soil = strength(30.0);
    let ratio =
        tilted_strip.drained_pressure(&soil, 18.0e3)? / level.drained_pressure(&soil, 18.0e3)?;
    assert_close("b_q", ratio, 0.887_863, 1e-6, 0.0);
    // A circle and a square: s_q = 1 + sin φ, s_γ = 0.7.
    for footing in [ShallowFooting::square(2.0)?, ShallowFooting::circle(2.0)?] {
        let pressure = footing.with_surcharge(10.0e3)?.drained_pressure(&soil, 18.0e3)?;
        assert_close("square", pressure, 10.0e3 * 18.4011 * 1.5 + 18.0e3 * 20.0931 * 0.7, 5.0, 0.0);
    }
    Ok(())
}

/// The bearing capacity of the test is 814 kPa; the growth with depth is γ N_q = 1.39 MPa/m for a strip.
#[test]
fn the_bearing_pressure_of_a_centrifuge_test_is_within_ten_percent() -> Result<()> {
    let sand = strength(42.0);
    let unit_weight = SAND_DENSITY * 9.81;
    let footing = ShallowFooting::rectangle(FOOTING_SIDES)?;
    let pressure = footing.drained_pressure(&sand, unit_weight)?;
    assert_close("bearing pressure", pressure, BEARING_PRESSURE, 0.0, 0.1);
    // The soil beside the base is 1 mm higher.
    let deeper_footing = footing.with_surcharge(1e-3 * unit_weight)?;
    let growth = (deeper_footing.drained_pressure(&sand, unit_weight)? - pressure) / 1e-3;
    assert_close("growth", footing.pressure_growth(&sand, unit_weight)?, growth, 0.0, 1e-9);
    let strip = ShallowFooting::strip(FOOTING_SIDES[1])?.pressure_growth(&sand, unit_weight)?;
    assert_close("growth of a strip", strip, 1.39e6, 0.0, 2e-3);
    Ok(())
}

/// Moment of a uniform `pressure` on the edge of a base whose force is `vertical`, by the midpoint rule.
fn moment_of_pressed_edge(
    width_at: impl Fn(f64) -> f64,
    half: f64,
    pressure: f64,
    vertical: f64,
) -> f64 {
    let count = 2_000_000;
    let step = 2.0 * half / f64::from(count);
    let mut force = 0.0;
    let mut moment = 0.0;
    for k in 0..count {
        let x = half - (f64::from(k) + 0.5) * step;
        let slice_force = pressure * width_at(x) * step;
        // Only a part of the last slice is pressed.
        let slice_force = slice_force.min(vertical - force);
        force += slice_force;
        moment += slice_force * x;
        if force >= vertical {
            break;
        }
    }
    moment
}

#[test]
fn rocking_moments_are_those_of_a_pressed_edge() -> Result<()> {
    let vertical = 100.0e3;
    for ratio in [0.01, 0.2, 0.5, 0.9] {
        let footing = ShallowFooting::rectangle([3.0, 2.0])?;
        let pressure = vertical / (6.0 * ratio);
        let capacity = footing.rocking_capacity(vertical, pressure)?;
        assert_close("A_c/A", capacity.contact_ratio, ratio, 0.0, 1e-14);
        for (moment, [half, width]) in capacity.moments.into_iter().zip([[1.5, 2.0], [1.0, 3.0]]) {
            let expected = moment_of_pressed_edge(|_| width, half, pressure, vertical);
            assert_close("rectangle", moment, expected, 0.0, 1e-6);
        }
        let strip = ShallowFooting::strip(3.0)?.rocking_capacity(vertical, 2.0 * pressure)?;
        assert_close("strip", strip.moments[0], capacity.moments[0], 0.0, 1e-14);
        assert_eq!(strip.moments[1], f64::INFINITY);
        let radius = 1.5;
        let pressure = vertical / (PI * radius * radius * ratio);
        let circle = ShallowFooting::circle(2.0 * radius)?.rocking_capacity(vertical, pressure)?;
        let chord = |x: f64| 2.0 * (radius * radius - x * x).sqrt();
        let expected = moment_of_pressed_edge(chord, radius, pressure, vertical);
        assert_close("circle", circle.moments[0], expected, 0.0, 1e-5);
    }
    // The whole base is pressed.
    for footing in [
        ShallowFooting::rectangle([3.0, 2.0])?,
        ShallowFooting::strip(3.0)?,
        ShallowFooting::circle(2.0)?,
    ] {
        let capacity = footing.rocking_capacity(footing.effective_area() * 1e5, 1e5)?;
        assert!(capacity.moments.into_iter().all(|moment| moment.abs() < 1e-6), "{capacity:?}");
    }
    // The test's footing: 0.81 of P L/2.
    let footing = ShallowFooting::rectangle(FOOTING_SIDES)?;
    let capacity = footing.rocking_capacity(VERTICAL_FORCE, BEARING_PRESSURE)?;
    assert_close("capacity", capacity.moments[0] / (VERTICAL_FORCE * 1.4), 0.8076, 1e-4, 0.0);
    Ok(())
}
