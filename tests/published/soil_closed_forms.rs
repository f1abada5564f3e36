//! GOAL: closed forms of loads on soil and on plates satisfy their equations and return errors for invalid input.
//! SCENE: line loads, point loads in the full plane, rectangles, plates on springs.
//! REFERENCE: statics, differential equations, sums of point loads and of waves.

use basemat::Soil;
use basemat::reference::{
    flamant_horizontal_displacement, flamant_radial_stress, flamant_relative_settlement,
    hertz_plate_settlement, kelvin_relative_displacement, loaded_rectangle_settlement,
    pais_kausel_impedances,
};

use super::reference::{INVALID_NUMBERS, assert_is_error, soil};
use basemat_problems::assert_close;

#[test]
fn invalid_inputs_of_line_loads_and_point_loads_are_errors() {
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(flamant_relative_settlement(soil(), 1.0, invalid_value, 1.0));
        assert_is_error(flamant_relative_settlement(soil(), 1.0, 1.0, invalid_value));
        assert_is_error(flamant_radial_stress(1.0, invalid_value, 0.0));
        assert_is_error(kelvin_relative_displacement(
            soil(),
            [1.0, 0.0],
            [1.0, 0.0],
            invalid_value,
        ));
    }
    for invalid_value in &INVALID_NUMBERS[2..] {
        assert_is_error(flamant_relative_settlement(soil(), *invalid_value, 1.0, 2.0));
        assert_is_error(flamant_horizontal_displacement(soil(), *invalid_value, 1.0));
        assert_is_error(flamant_horizontal_displacement(soil(), 1.0, *invalid_value));
        assert_is_error(flamant_radial_stress(*invalid_value, 1.0, 0.0));
        assert_is_error(flamant_radial_stress(1.0, 1.0, *invalid_value));
        assert_is_error(kelvin_relative_displacement(
            soil(),
            [*invalid_value, 0.0],
            [1.0, 0.0],
            1.0,
        ));
        assert_is_error(kelvin_relative_displacement(
            soil(),
            [0.0, *invalid_value],
            [1.0, 0.0],
            1.0,
        ));
        assert_is_error(kelvin_relative_displacement(
            soil(),
            [1.0, 0.0],
            [*invalid_value, 0.0],
            1.0,
        ));
    }
    assert_is_error(kelvin_relative_displacement(soil(), [1.0, 0.0], [0.0, 0.0], 1.0));
}

/// Flamant's radial stress balances the load, and the surface slope is in proportion to it.
#[test]
fn line_loads_satisfy_equilibrium() {
    // Radial stress over a half circle balances the load.
    let count = 1000;
    let radius = 0.7;
    let load = 3.0;
    let step = std::f64::consts::PI / f64::from(count);
    let carried: f64 = (0..count)
        .map(|k| {
            let angle = (f64::from(k) + 0.5) * step - std::f64::consts::FRAC_PI_2;
            let stress = flamant_radial_stress(load, radius, angle).unwrap();
            -stress * angle.cos() * radius * step
        })
        .sum();
    assert_close("load", carried, load, 1e-12, 0.0);
    // slope of the surface (1−ν)P/(πμr), stress under the load −2P/(πr)
    let settlement = flamant_relative_settlement(soil(), load, 1.0, 1.0 + 1e-6).unwrap();
    let slope = -(1.0 - 0.3) / (2.0 * 3.0) * flamant_radial_stress(load, 1.0, 0.0).unwrap();
    assert_close("slope", settlement / 1e-6, slope, 0.0, 1e-6);
    assert_eq!(flamant_horizontal_displacement(soil(), 1.0, 0.0).unwrap(), 0.0);
}

/// Settlement at `point` beside the middle of a rectangle 2 m × 3 m under 5 N/m².
fn rectangle_settlement(point: [f64; 2]) -> f64 {
    loaded_rectangle_settlement(soil(), 5.0, [2.0, 3.0], point).unwrap()
}

/// One over the distance of the point from a cell of the rectangle's lattice of `count` × `count` cells.
fn inverse_distance([x, y]: [f64; 2], i: i32, j: i32, count: i32) -> f64 {
    let along = 2.0 * (f64::from(i) + 0.5) / f64::from(count) - 1.0;
    let distance_along_y = 3.0 * (f64::from(j) + 0.5) / f64::from(count) - 1.5;
    1.0 / (along - x).hypot(distance_along_y - y)
}

/// The settlement under a loaded rectangle is a sum of point loads, integrated along rays from a point inside and over
/// cells outside.
#[test]
fn loaded_rectangles_settle_as_point_loads_do() {
    let unit = (1.0 - 0.3) / (2.0 * std::f64::consts::PI * 3.0);
    for [x, y] in [[0.0, 0.0], [0.3, -1.1], [-0.9, 1.4]] {
        // ∫ dA/r is the mean length of the rays to the outline, times 2π.
        let count = 400_000;
        let rays: f64 = (0..count)
            .map(|k| {
                let angle = std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(count);
                let (sine, cosine) = angle.sin_cos();
                ((1.0_f64.copysign(cosine) - x) / cosine).min((1.5_f64.copysign(sine) - y) / sine)
            })
            .sum();
        let expected = 5.0 * unit * rays * std::f64::consts::TAU / f64::from(count);
        assert_close("inside", rectangle_settlement([x, y]), expected, 0.0, 1e-9);
    }
    for point in [[2.0, 0.0], [1.5, -3.0], [0.2, 2.5]] {
        let count = 400;
        let sum: f64 = (0..count)
            .flat_map(|i| (0..count).map(move |j| inverse_distance(point, i, j, count)))
            .sum();
        let expected = 5.0 * unit * sum * 6.0 / f64::from(count * count);
        assert_close("outside", rectangle_settlement(point), expected, 0.0, 1e-5);
    }
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(loaded_rectangle_settlement(soil(), 1.0, [1.0, invalid_value], [0.0; 2]));
        if !invalid_value.is_finite() {
            assert_is_error(loaded_rectangle_settlement(soil(), invalid_value, [1.0; 2], [0.0; 2]));
            assert_is_error(loaded_rectangle_settlement(
                soil(),
                1.0,
                [1.0; 2],
                [0.0, invalid_value],
            ));
        }
    }
}

/// Displacement of a point due to a force at the origin, relative to a point at unit distance.
fn kelvin_displacement(force: [f64; 2], point: [f64; 2]) -> [f64; 2] {
    kelvin_relative_displacement(soil(), force, point, 1.0).unwrap()
}

/// Second derivatives of both components from the values beside a point and at it.
fn second_derivatives(neighbours: [[f64; 2]; 2], middle: [f64; 2], h: f64) -> [f64; 2] {
    [0, 1].map(|i| (neighbours[0][i] - 2.0 * middle[i] + neighbours[1][i]) / (h * h))
}

/// Kelvin's solution satisfies Navier's equation (by differences) and reciprocity.
#[test]
fn kelvins_solution_satisfies_naviers_equation() {
    let h = 1e-3;
    let u = |x: f64, y: f64| kelvin_displacement([1.0, 2.0], [x, y]);
    let x = 0.8;
    let y = -0.5;
    let middle = u(x, y);
    let xx = second_derivatives([u(x + h, y), u(x - h, y)], middle, h);
    let yy = second_derivatives([u(x, y + h), u(x, y - h)], middle, h);
    let xy: [f64; 2] = std::array::from_fn(|i| {
        (u(x + h, y + h)[i] - u(x + h, y - h)[i] - u(x - h, y + h)[i] + u(x - h, y - h)[i])
            / (4.0 * h * h)
    });
    // ∇²u + ∇(∇·u)/(1−2ν) = 0
    let factor = 1.0 / (1.0 - 0.6);
    let along_x = xx[0] + yy[0] + factor * (xx[0] + xy[1]);
    let along_y = xx[1] + yy[1] + factor * (yy[1] + xy[0]);
    assert!(along_x.abs() < 1e-5 && along_y.abs() < 1e-5, "{along_x:e} {along_y:e}");
    let by_horizontal = kelvin_displacement([1.0, 0.0], [x, y]);
    let by_vertical = kelvin_displacement([0.0, 1.0], [x, y]);
    assert_eq!(by_horizontal[1], by_vertical[0]);
}

/// Integral over the waves on an infinite plate on springs: ∫ P κ dκ/(2π (D κ⁴ + k)), with κ = l⁻¹ tan φ, l⁴ = D/k.
#[test]
fn hertz_settlements_are_integrals_over_waves() {
    for (force, rigidity, bed) in [(3.0, 2.0, 5.0), (-1.0, 1e9, 2e7)] {
        let per_length = f64::powf(bed / rigidity, 0.25);
        let count = 20_000;
        let sum: f64 = (0..count)
            .map(|n| {
                let angle = 0.5 * std::f64::consts::PI * (f64::from(n) + 0.5) / f64::from(count);
                let wave = per_length * angle.tan();
                wave / (rigidity * wave.powi(4) + bed) * per_length / angle.cos().powi(2)
            })
            .sum();
        let expected = force * sum / (4.0 * f64::from(count));
        assert_close(
            "plate",
            hertz_plate_settlement(force, rigidity, bed).unwrap(),
            expected,
            0.0,
            1e-7,
        );
    }
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(hertz_plate_settlement(1.0, invalid_value, 1.0));
        assert_is_error(hertz_plate_settlement(1.0, 1.0, invalid_value));
    }
    assert_is_error(hertz_plate_settlement(f64::NAN, 1.0, 1.0));
}

/// At high frequency a rigid base radiates plane waves, with dashpots ρ c per area.
///
/// The rocking springs fall, and all impedances grow with the sides.
#[test]
fn impedances_of_pais_and_kausel_are_plane_wave_dashpots_at_high_frequency() {
    let frequency = 1e4;
    for ([width, length], poisson) in [([2.0, 2.0], 0.25), ([3.0, 7.5], 0.1), ([1.0, 4.0], 0.45)] {
        let soil = Soil::new(3.0, poisson, 1.7).unwrap();
        let computed = pais_kausel_impedances(soil, [width, length], frequency).unwrap();
        let at_rest = pais_kausel_impedances(soil, [width, length], 0.0).unwrap();
        let waves = std::f64::consts::TAU * frequency * soil.density();
        let shear = soil.shear_wave_speed();
        // Lysmer's and Gazetas' limit for nearly incompressible soil.
        let pressure = soil.pressure_wave_speed().min(2.5 * shear);
        let dashpots = [width * length * shear, width * length * shear, width * length * pressure];
        for (impedance, dashpot) in computed.iter().zip(dashpots) {
            assert_close("dashpot", impedance.im, waves * dashpot, 0.0, 1e-12);
        }
        let second = length * width.powi(3) / 12.0;
        assert_close("rocking", computed[3].im, waves * second * pressure, 0.0, 1e-6);
        assert!(computed[3].re < 0.5 * at_rest[3].re);
        assert!(at_rest.iter().all(|impedance| impedance.im == 0.0));
        // The mat is stiffer along its shorter side, and softer than n squares beside each other.
        let square = pais_kausel_impedances(soil, [width, width], 0.0).unwrap();
        let count = length / width;
        assert!(at_rest[0].re >= at_rest[1].re);
        for (stiffness, square) in at_rest.iter().zip(square) {
            let range = square.re..=count * square.re;
            assert!(range.contains(&stiffness.re), "{stiffness:?} {square:?}");
        }
    }
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(pais_kausel_impedances(soil(), [invalid_value, 1.0], 1.0));
        assert_is_error(pais_kausel_impedances(soil(), [1.0, invalid_value], 1.0));
    }
    assert_is_error(pais_kausel_impedances(soil(), [2.0, 1.9], 1.0));
    assert_is_error(pais_kausel_impedances(soil(), [1.0, 2.0], -1.0));
    assert_is_error(pais_kausel_impedances(soil(), [1.0, 2.0], f64::NAN));
}
