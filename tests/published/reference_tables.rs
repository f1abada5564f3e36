//! GOAL: closed forms against tables.
//! SCENE: Housner's and Newmark's blocks, strips on the half-plane and on springs.
//! REFERENCE: tables computed independently of this crate.

use basemat::Soil;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::reference::{
    NoTensionStrip, RigidStrip, RockingBlock, SlidingBlock, SlidingEvent, WinklerStrip,
};

use basemat_problems::{assert_close, table};

/// Housner 1963: periods and next amplitudes of the block 1 m × 4 m.
#[test]
fn periods_and_peaks_of_housners_block_are_the_tabulated_ones() {
    let block = RockingBlock::new(0.5, 2.0, 9.81).unwrap();
    assert_close("alpha", block.slenderness_angle(), 0.244_978_663_126_864, 1e-15, 0.0);
    assert_close("p", block.frequency_parameter(), 1.889_156_352_028_5, 0.0, 1e-13);
    assert_close("restitution", block.restitution(), 0.911_764_705_882_353, 1e-15, 0.0);
    let alpha = block.slenderness_angle();
    let rows = table("housner_period.csv").rows([
        "theta0_over_alpha",
        "T_exact",
        "T_housner_linear",
        "next_amp_over_alpha_exact",
        "next_amp_over_alpha_housner",
    ]);
    assert_eq!(rows.len(), 19);
    for [ratio, exact, slender, next, next_slender] in rows {
        let amplitude = ratio * alpha;
        assert_close("period", block.period(amplitude).unwrap(), exact, 0.0, 1e-12);
        assert_close(
            "slender period",
            block.period_slender(amplitude).unwrap(),
            slender,
            0.0,
            1e-12,
        );
        assert_close("peak", block.next_peak(amplitude).unwrap() / alpha, next, 0.0, 1e-12);
        let peak = block.next_peak_slender(amplitude).unwrap() / alpha;
        assert_close("slender peak", peak, next_slender, 0.0, 1e-12);
    }
}

/// Housner 1963: 44 impacts after release, and the amplitudes between them.
#[test]
fn impacts_of_housners_block_are_the_tabulated_ones() {
    let block = RockingBlock::new(0.5, 2.0, 9.81).unwrap();
    let start = 0.6 * block.slenderness_angle();
    let table = table("housner_free.csv");
    let words = table.words_after("impact times:");
    let times = block.impact_times(start, words.len()).unwrap();
    assert_eq!(times.len(), 44);
    for (time, word) in times.iter().zip(&words) {
        assert_close("impact time", *time, word.parse().unwrap(), 1e-10, 0.0);
    }
    // the largest tabulated tilt between two impacts is at most half a sample from the peak, where
    // the tilt is below it by p² sin(α) (Δt/2)²/2 at most
    let below = block.frequency_parameter().powi(2) * 0.25 * 0.005_f64.powi(2) / 2.0;
    let rows = table.rows(["t", "theta"]);
    let mut amplitude = start;
    for impacts in times.windows(2).take(20) {
        amplitude = block.next_peak(amplitude).unwrap();
        let between = rows.iter().filter(|row| row[0] > impacts[0] && row[0] < impacts[1]);
        let peak = between.fold(0.0, |largest: f64, row| largest.max(row[1].abs()));
        assert!(peak <= amplitude + 1e-12 && peak >= amplitude - below, "{peak} {amplitude}");
    }
    // rate before the first impact: the tabulated rate is linear there to (p Δt)²
    let before = rows.iter().zip(table.column("omega")).rev().find(|(row, _)| row[0] < times[0]);
    let ([time, _], rate) = before.map(|(row, rate)| (*row, rate)).unwrap();
    let acceleration = block.frequency_parameter().powi(2) * block.slenderness_angle().sin();
    let expected = rate.abs() + acceleration * (times[0] - time);
    assert_close("impact rate", block.impact_rate(start).unwrap(), expected, 1e-6, 0.0);
}

/// Newmark 1965: sine shaking, events and slip against the exact solution for the sine itself.
#[test]
fn slip_of_newmarks_block_under_sines_is_the_tabulated_one() {
    for (file, amplitude, frequency, friction) in [
        ("newmark_sine_A0.3g_f0.5_mu0.25.csv", 0.3, 0.5, 0.25),
        ("newmark_sine_A0.4g_f1.0_mu0.2.csv", 0.4, 1.0, 0.2),
        ("newmark_sine_A0.8g_f2.0_mu0.1.csv", 0.8, 2.0, 0.1),
    ] {
        let step = 1e-4;
        let gravity = 9.81;
        let omega = 2.0 * std::f64::consts::PI * frequency;
        let samples = (0..=104_000)
            .map(|k| amplitude * gravity * (omega * f64::from(k) * step).sin())
            .collect();
        let record = Record::new(step, samples).unwrap();
        let slide = SlidingBlock::new(friction, gravity).unwrap().slide(&record);
        let table = table(file);
        // the table has events after its last row at 10 s, hence 10.4 s;
        // the polygon differs from the sine by A (ω Δt)²/8, 2e-7 of it at 2 Hz; slip velocities
        // and slips then by that over the duration
        for [time, velocity, slip] in table.rows(["t", "v_rel", "d_rel"]) {
            assert_close(file, slide.slip_velocity(time), velocity, 2e-6, 0.0);
            assert_close(file, slide.slip(time), slip, 2e-6, 0.0);
        }
        let words = table.words_after("exact events:");
        assert!(words.len() >= 20 && slide.events().len() >= words.len());
        for (word, event) in words.iter().zip(slide.events()) {
            let (time, kind) = word.split_once(':').unwrap();
            // in the table every zero of the slip velocity is a stop
            let computed = match (*event, kind) {
                (SlidingEvent::Slip { time }, "slip")
                | (SlidingEvent::Stop { time } | SlidingEvent::Reversal { time }, "stop") => time,
                other => panic!("{file}: {other:?} at {time}"),
            };
            assert_close(file, computed, time.parse().unwrap(), 1e-6, 0.0);
        }
    }
}

/// Newmark 1965: slip under El Centro for eight friction coefficients.
#[test]
fn slip_of_newmarks_block_under_el_centro_is_the_tabulated_one() {
    let table = table("sliding_rigid_block.csv");
    let columns = ["mu", "slip_max_m", "slip_min_m", "slip_residual_m", "max_abs_slip_m"];
    let records = table.text("record");
    let rows = table.rows(columns);
    let rows = rows.iter().zip(records).filter(|(_, record)| *record == "peknold");
    let mut count = 0;
    for ([friction, maximum, minimum, residual, largest], _) in rows {
        let block = SlidingBlock::new(*friction, STANDARD_GRAVITY).unwrap();
        let slide = block.slide(&el_centro_1940());
        // the sub-steps of the table leave 2e-6 m
        assert_close("maximum", slide.maximum(), *maximum, 2.5e-6, 0.0);
        assert_close("minimum", slide.minimum(), *minimum, 2.5e-6, 0.0);
        assert_close("residual", slide.residual(), *residual, 2.5e-6, 0.0);
        let computed = slide.maximum().max(-slide.minimum());
        assert_close("largest", computed, *largest, 2.5e-6, 0.0);
        count += 1;
    }
    assert_eq!(count, 8);
}

/// Tilted rigid strip on the half-plane, frictionless and fully sliding, with and without uplift.
#[test]
fn strips_without_tension_on_the_half_plane_have_the_tabulated_contact() {
    let table = table("halfplane_tilted_punch.csv");
    let columns = ["nu", "f", "e", "g", "contact_length", "x_left", "x_right", "theta"];
    let rows = table.rows(columns);
    assert!(rows.len() > 200);
    for [poisson, friction, eccentricity, exponent, length, left, right, theta] in rows {
        let soil = Soil::new(1.0, poisson, 1.0).unwrap();
        let strip = NoTensionStrip::new(soil, 1.0, friction).unwrap();
        assert_close("exponent", strip.exponent(), exponent, 1e-12, 0.0);
        let contact = strip.contact(1.0, eccentricity).unwrap();
        assert_close("length", contact.length(), length, 1e-10, 0.0);
        assert_close("left", contact.left, left, 1e-10, 0.0);
        assert_close("right", contact.right, right, 1e-10, 0.0);
        // the table's theta lowers the right side
        assert_close("tilt", contact.tilt, -theta, 1e-10, 1e-10);
        let moment = strip.moment(1.0, contact.tilt).unwrap();
        assert_close("moment", moment, -eccentricity, 1e-12, 0.0);
    }
}

/// Rigid strip on springs without tension.
#[test]
fn strips_without_tension_on_springs_have_the_tabulated_moments() {
    let stiffness = 3e7;
    let half_width = 2.5;
    let load = 4e5;
    let strip = WinklerStrip::new(stiffness, half_width).unwrap();
    let uplift = strip.uplift_tilt(load).unwrap();
    let rows = table("winkler_static_M_theta.csv").rows([
        "theta_over_thu",
        "M_over_NB",
        "contact_over_2B",
    ]);
    assert!(rows.len() > 50);
    for [ratio, moment, contact] in rows {
        for side in [1.0, -1.0] {
            let tilt = side * ratio * uplift;
            let computed = strip.moment(load, tilt).unwrap() / (load * half_width);
            assert_close("moment", computed, side * moment, 0.0, 1e-11);
            let computed = strip.contact_length(load, tilt).unwrap() / (2.0 * half_width);
            assert_close("contact", computed, contact, 0.0, 1e-11);
        }
    }
}

/// Static and high-frequency limits of the strip against the ends of its impedance tables.
#[test]
fn limits_of_rigid_strips_are_those_of_the_impedance_tables() {
    for (name, poisson) in [("0", 0.0), ("025", 0.25), ("0333", 1.0 / 3.0)] {
        let strip = RigidStrip::new(Soil::new(1.0, poisson, 1.0).unwrap(), 1.0).unwrap();
        let relaxed_table = table(&format!("strip_relaxed_nu{name}_xi00.csv"));
        let bonded = table(&format!("strip_bonded_nu{name}_xi00.csv"));
        for (table, rocking) in [
            (&relaxed_table, strip.smooth_rocking_stiffness()),
            (&bonded, strip.bonded_rocking_stiffness()),
        ] {
            // the difference is in proportion to a₀² ln a₀: below 4e-4 at a₀ = 0.01, and far
            // larger at 0.05
            let compliance = table.column("re_crr");
            assert_close("static rocking", 1.0 / compliance[0], rocking, 0.0, 4e-4);
            let error_at_low_frequency = compliance[0] * rocking - 1.0;
            let error_at_high_frequency = compliance[1] * rocking - 1.0;
            assert!(
                error_at_low_frequency.abs() < error_at_high_frequency.abs() / 12.0,
                "{error_at_low_frequency:e} {error_at_high_frequency:e}"
            );
            let quadrature = strip.quadrature_compliance();
            assert_close("Im c_hh", table.column("im_chh")[0], quadrature, 0.0, 2e-3);
            assert_close("Im c_vv", table.column("im_cvv")[0], quadrature, 0.0, 5e-3);
            // slope over ln(1/a₀) between the first two frequencies
            for column in ["re_chh", "re_cvv"] {
                let values = table.column(column);
                let slope = (values[0] - values[1]) / 5.0_f64.ln();
                assert_close("log slope", slope, strip.logarithmic_compliance(), 0.0, 0.01);
            }
            let last_index = table.len() - 1;
            let frequency = table.column("a0")[last_index];
            for (column, dashpot) in [
                ("im_khh", strip.horizontal_dashpot()),
                ("im_kvv", strip.vertical_dashpot()),
                ("im_krr", strip.rocking_dashpot()),
            ] {
                assert_close(
                    column,
                    table.column(column)[last_index] / frequency,
                    dashpot,
                    0.0,
                    0.03,
                );
            }
        }
        // c_hr/c_rr = −K_hr/K_hh; the table's rotation is clockwise, which changes the sign
        let coupling = bonded.column("re_chr")[0] / bonded.column("re_crr")[0];
        assert_close("coupling", coupling, strip.bonded_coupling_length(), 0.0, 1e-3);
    }
}
