//! GOAL: contact on the half-plane: partial uplift, sliding, rocking.
//! SCENE: tilted strip, sliding and rocking rigid blocks.
//! REFERENCE: Muskhelishvili 1953, Newmark 1965, Housner 1963.

use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::reference::{NoTensionStrip, SlidingBlock};
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use std::f64::consts::PI;

use basemat_problems::rocking::quarter_period;
use basemat_problems::series::{RelativeError, assert_within, nearest_integer};
use basemat_problems::table;
use basemat_problems::wrapped::StructureWithForce;

/// Rigid block with a moment (counter-clockwise, about the middle of the base) that varies in time.
fn pushed_block<F>(block: RigidBlock, moment: F) -> StructureWithForce<RigidBlock, F> {
    StructureWithForce { structure: block, along: RigidBlock::ROTATION_DOF.into(), force: moment }
}

fn half_plane(soil: Soil, half_width: f64, elements: usize, grading: Grading) -> ElasticGround {
    let strip = Strip::new(-half_width..half_width, elements, grading).unwrap();
    ElasticGround::new(soil, strip).unwrap()
}

/// Static state of a tilted strip.
struct TiltedStrip {
    /// Tilt in radians, counter-clockwise.
    tilt: f64,
    /// Length of contact of a strip of half width 1.
    contact_length: f64,
}

/// Strip of half width 1 under a unit load.
fn punch(poisson: f64, eccentricity: f64, elements: usize, grading: Grading) -> TiltedStrip {
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let block = RigidBlock::new(2.0, 1.0, 0.5).unwrap();
    let simulation = Simulation::builder(0.1)
        .structure(pushed_block(block, move |_| -eccentricity))
        .ground(half_plane(soil, 1.0, elements, grading))
        .interface(Coulomb::new(0.0).unwrap())
        .gravity(1.0)
        .build()
        .unwrap();
    let state = simulation.state();
    assert!((state.normal_force - 1.0).abs() < 1e-9, "normal force {}", state.normal_force);
    assert!((state.base_moment + eccentricity).abs() < 1e-9, "moment {}", state.base_moment);
    TiltedStrip {
        tilt: simulation.static_displacement()[2],
        contact_length: 2.0 * (1.0 - state.uplifted_fraction),
    }
}

/// Limits of the tilt's relative error with 10, 20 and 40 elements.
fn punch_error_limits(grading: Grading, eccentricity: f64) -> [f64; 3] {
    match (grading, eccentricity) {
        (Grading::Uniform, 0.3) => [6.6e-2, 3.1e-2, 1.5e-2],
        (Grading::Uniform, 0.6) => [8.4e-2, 4e-2, 1.9e-2],
        (Grading::Uniform, 0.75) => [1.5e-1, 6.6e-2, 3.1e-2],
        (Grading::Uniform, _) => [5e-1, 1.9e-1, 8.4e-2],
        (_, 0.3) => [1.6e-2, 4e-3, 1e-3],
        (_, 0.6) => [2.4e-2, 5.5e-3, 1.3e-3],
        (_, 0.75) => [4.7e-2, 1.1e-2, 2.6e-3],
        (_, _) => [1.5e-1, 3.3e-2, 7.6e-3],
    }
}

/// GOAL: static contact with partial uplift: tilt, contact length, and the tilt's order.
/// SCENE: frictionless rigid strip under a load at eccentricity e, by the static state.
/// REFERENCE: inclined punch (Muskhelishvili 1953): contact over 4(b − e), M/(Pb) = 1 − θ_u/(2θ).
#[test]
fn a_tilted_punch_has_the_contact_of_muskhelishvili_1953() {
    for poisson in [0.0, 1.0 / 3.0] {
        let strip = NoTensionStrip::new(Soil::new(1.0, poisson, 1.0).unwrap(), 1.0, 0.0).unwrap();
        let lift_off = (1.0 - poisson) / PI;
        for e in [0.3, 0.6, 0.75, 0.9] {
            let expected = strip.contact(1.0, e).unwrap();
            for grading in [Grading::Uniform, Grading::Cosine] {
                let errors = [10, 20, 40].map(|elements| {
                    let TiltedStrip { tilt, contact_length } = punch(poisson, e, elements, grading);
                    let max_element = match grading {
                        Grading::Uniform => 2.0 / elements as f64,
                        _ => PI / elements as f64,
                    };
                    // The edge of contact is one of the nodes next to the exact place.
                    let edge_error = (contact_length - expected.length()).abs();
                    assert!(edge_error <= max_element, "contact over {contact_length}");
                    let theta = -tilt;
                    let moment = if theta > lift_off {
                        1.0 - lift_off / (2.0 * theta)
                    } else {
                        theta / (2.0 * lift_off)
                    };
                    // d(moment)/dθ: the error of the moment is at most half that of the tilt.
                    let error = (tilt / expected.tilt - 1.0).abs();
                    assert!((moment - e).abs() <= 0.5 * error, "M/(Pb) {moment}, e {e}");
                    error
                });
                let scene = format!("punch nu {poisson:.2} e {e} {grading:?}");
                assert_within(
                    &scene,
                    &["10", "20", "40"],
                    &errors,
                    &punch_error_limits(grading, e),
                );
                let order = (errors[1] / errors[2]).log2();
                let range = if grading == Grading::Uniform { 1.0..1.25 } else { 1.9..2.2 };
                assert!(range.contains(&order), "{scene}: order {order:.2}");
            }
        }
    }
}

/// Slip of a block under El Centro.
struct BlockSlide {
    /// Relative error of the time series.
    series_error: f64,
    /// Largest magnitude, m.
    largest_slip: f64,
    /// At the end, m.
    residual_slip: f64,
}

/// Slides a low block up to `duration` (s) on soil of this wave speed (m/s).
fn sliding(shear_wave_speed: f64, friction: f64, time_step: f64, duration: f64) -> BlockSlide {
    let soil = Soil::from_wave_speeds(shear_wave_speed, 2.0 * shear_wave_speed, 2000.0).unwrap();
    let record = el_centro_1940();
    let expected = SlidingBlock::new(friction, STANDARD_GRAVITY).unwrap().slide(&record);
    let block = RigidBlock::new(4.0, 0.4, 2000.0).unwrap();
    let weight = block.total_mass() * STANDARD_GRAVITY;
    let mut simulation = Simulation::builder(time_step)
        .structure(block)
        .ground(half_plane(soil, 2.0, 4, Grading::Uniform))
        .interface(Coulomb::new(friction).unwrap())
        .motion(record)
        .gravity(STANDARD_GRAVITY)
        .build()
        .unwrap();
    let at_rest = simulation.state().normal_force;
    assert!((at_rest / weight - 1.0).abs() < 1e-9, "normal force {at_rest}, weight {weight}");
    let mut error = RelativeError::default();
    let mut max_magnitude = 0.0_f64;
    let run = simulation
        .run(nearest_integer(duration / time_step), |state| {
            error.add(state.mean_slip, expected.slip(state.time));
            max_magnitude = max_magnitude.max(state.mean_slip.abs());
        })
        .unwrap();
    assert_eq!(run.whole.uplifted_fraction.largest().value, 0.0);
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    assert!(run.energy_balance.contact > 0.0, "friction dissipates energy");
    BlockSlide {
        series_error: error.relative(),
        largest_slip: max_magnitude,
        residual_slip: run.whole.residual_slip,
    }
}

/// GOAL: friction under a real record.
/// SCENE: low block (4 m × 0.4 m) on soil of increasing stiffness under El Centro, friction 0.1 and 0.2.
/// REFERENCE: Newmark 1965 on rigid ground, event by event, and `sliding_rigid_block.csv`.
///
/// On soft soil block and ground move differently. On stiff soil the error of the time step remains: starts, stops and
/// reversals fall on steps, so that the speed after one of them has an error of up to friction·g·Δt. The error is of first
/// order, and not smooth in Δt.
#[test]
fn a_block_on_stiff_soil_slides_as_newmarks_1965() {
    let table = table("sliding_rigid_block.csv");
    for (friction, limits, tolerance) in [
        (0.1, [1.5e-2, 3.5e-2, 4.5e-2, 2.7e-2, 3.6e-3], [8e-6, 4e-4]),
        (0.2, [5.3e-1, 6.8e-2, 4.3e-1, 6.7e-3, 7.2e-3], [1.2e-6, 1.2e-5]),
    ] {
        let runs =
            [(100.0, 0.0025), (400.0, 0.0025), (1600.0, 0.01), (1600.0, 0.0025), (1600.0, 0.00125)];
        let errors = runs.map(|(speed, step)| sliding(speed, friction, step, 7.0).series_error);
        let names = ["100 m/s", "400 m/s", "1600 m/s: 10 ms", "2.5 ms", "1.25 ms"];
        assert_within(&format!("sliding, friction {friction}"), &names, &errors, &limits);

        let mut rows = table.rows(["mu", "max_abs_slip_m", "slip_residual_m"]).into_iter();
        let records = table.text("record");
        let row = records.iter().find_map(|record| {
            rows.next().filter(|row| *record == "peknold" && row[0] == friction)
        });
        let expected = row.unwrap();
        let computed = sliding(1600.0, friction, 0.0025, 31.18);
        let errors = [
            (computed.largest_slip - expected[1]).abs(),
            (computed.residual_slip - expected[2]).abs(),
        ];
        let scene = format!("sliding, friction {friction}, table");
        assert_within(&scene, &["largest (m)", "residual (m)"], &errors, &tolerance);
    }
}

/// Quarter periods of free rocking, s.
struct QuarterPeriods {
    computed: f64,
    /// Quarter period on Housner's rigid base.
    rigid_base: f64,
    /// Quarter period on soil that deforms under the corner.
    deformable_soil: f64,
}

/// Pushes a block over, and lets it rock freely.
fn rocking(shear_wave_speed: f64, elements: usize) -> QuarterPeriods {
    let b = 0.5;
    let h = 2.0;
    let gravity = STANDARD_GRAVITY;
    let poisson = 1.0 / 3.0;
    let soil = Soil::from_wave_speeds(shear_wave_speed, 2.0 * shear_wave_speed, 2000.0).unwrap();
    let block = RigidBlock::new(2.0 * b, 2.0 * h, 2500.0).unwrap().with_p_delta(gravity).unwrap();
    let weight = block.total_mass() * gravity;
    let inertia = block.base_inertia() + block.total_mass() * b * b;
    let push_duration = 0.5;
    let time_step = 0.0025;
    let ground = half_plane(soil, b, elements, Grading::Cosine);
    let edge = ground.elements()[0].length();
    let mut simulation = Simulation::builder(time_step)
        .structure(pushed_block(block, move |t: f64| {
            if t < push_duration {
                1.6 * weight * b * (PI * t / push_duration).sin()
            } else {
                0.0
            }
        }))
        .ground(ground)
        .interface(Coulomb::uplift_only())
        .gravity(gravity)
        .build()
        .unwrap();
    let at_rest = simulation.state().normal_force;
    assert!((at_rest / weight - 1.0).abs() < 1e-9, "normal force {at_rest}, weight {weight}");
    let mut tilts = vec![0.0];
    let run = simulation
        .run(nearest_integer(1.5 / time_step), |s| tilts.push(s.absolute_displacement()[2]))
        .unwrap();
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    assert!(run.energy_balance.soil > 0.0, "energy radiated: {:e}", run.energy_balance.soil);
    let peak = (nearest_integer(push_duration / time_step)..tilts.len() - 1)
        .find(|&k| tilts[k + 1] < tilts[k])
        .unwrap();
    let before = tilts[peak - 1];
    let tilt = tilts[peak];
    let after = tilts[peak + 1];
    let peak_sample = peak as f64 + 0.5 * (before - after) / (before - 2.0 * tilt + after);
    let last_sample_before = (peak..tilts.len() - 1).find(|&k| tilts[k + 1] < 0.0).unwrap();
    let upright_sample = last_sample_before as f64
        + tilts[last_sample_before] / (tilts[last_sample_before] - tilts[last_sample_before + 1]);
    // Pressure on the last element acts at its middle: the block rotates about that point.
    let slenderness = (b - 0.5 * edge) / h;
    let rate = (weight * h / inertia).sqrt();
    let housner = (1.0 / (1.0 - tilt * h / b)).acosh() / rate;
    let lift_off = (1.0 - poisson) * weight / (PI * soil.shear_modulus() * b);
    let quarter_on_soil = quarter_period(tilt, lift_off, slenderness, rate);
    QuarterPeriods {
        computed: (upright_sample - peak_sample) * time_step,
        rigid_base: housner,
        deformable_soil: quarter_on_soil,
    }
}

/// GOAL: free rocking, by uplift alone.
/// SCENE: block 1 m × 4 m with its P–Δ effect, pushed over for half a second, then released.
/// REFERENCE: Housner 1963, quarter period (1/p) arcosh(1/(1 − θ₀/α)) with the constants of small
/// rotations (p² = N h/I, α = b/h); and the same motion on a quasi-static half-plane.
///
/// The block rocks more slowly than Housner's: the soil deforms under the corner, and pressure acts
/// at the middle of the last element, not at its end. Both are in the second reference.
#[test]
fn quarter_periods_on_stiff_soil_are_close_to_housner_1963() {
    for (speed, elements, housner, yielding) in [
        (100.0, 16, 2.1e-2, 6.2e-3),
        (200.0, 16, 8.5e-3, 6e-3),
        (400.0, 16, 7.5e-3, 2.4e-3),
        (400.0, 32, 2.4e-3, 1.7e-3),
        (800.0, 16, 7.5e-3, 9e-4),
    ] {
        let QuarterPeriods { computed, rigid_base, deformable_soil } = rocking(speed, elements);
        let errors = [computed / rigid_base - 1.0, (computed / deformable_soil - 1.0).abs()];
        assert!(errors[0] > 0.0, "faster than on a rigid base: {:e}", errors[0]);
        let scene = format!("rocking, {speed} m/s, cosine {elements}");
        assert_within(&scene, &["Housner", "deformable soil"], &errors, &[housner, yielding]);
    }
}
