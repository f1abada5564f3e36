//! Rigid bodies that rock on a rigid base, and on a soil that yields without inertia.

use basemat::motion::STANDARD_GRAVITY;

use crate::series::nearest_integer;

/// A rigid body on two corners.
#[derive(Debug, Clone, Copy)]
pub struct Rocker {
    /// Half width of the base, m.
    pub half_width: f64,
    /// Mass, kg/m.
    pub mass: f64,
    /// Height of the centre of gravity, m.
    pub height: f64,
    /// Moment of inertia about the middle of the base, kg m²/m.
    pub inertia: f64,
}

impl Rocker {
    /// Weight, N/m.
    pub fn weight(&self) -> f64 {
        self.mass * STANDARD_GRAVITY
    }

    /// Tilts of Housner's block every `sample_interval` seconds, and the times of its impacts.
    ///
    /// Tilts are small, and `moment` (N m/m) is a function of time. About the corner in contact, I θ″ = M ∓ N(b ∓ hθ). At
    /// an impact the moment of momentum about the new corner is conserved, which multiplies the rate by
    /// η = (I₀ − m b²)/(I₀ + m b²), with the moment of inertia I₀ about the middle of the base.
    pub fn tilts(
        &self,
        moment: impl Fn(f64) -> f64,
        sample_interval: f64,
        duration: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let Self { half_width, mass, height, inertia } = *self;
        let moment_of_inertia = inertia + mass * half_width * half_width;
        let rate_factor = (inertia - mass * half_width * half_width) / moment_of_inertia;
        let restoring_moment = self.weight() * half_width;
        let tilting_stiffness = self.weight() * height;
        let acceleration = |time: f64, tilt: f64, side: f64| {
            (moment(time) - side * restoring_moment + tilting_stiffness * tilt) / moment_of_inertia
        };
        let substeps = 2000;
        let step = sample_interval / f64::from(substeps);
        let mut tilt = 0.0_f64;
        let mut rate = 0.0_f64;
        // +1 on the left corner (tilts counter-clockwise), −1 on the right one, 0 at rest.
        let mut side = 0.0_f64;
        let mut tilts = vec![0.0];
        let mut impacts = Vec::new();
        for n in 0..nearest_integer(duration / sample_interval) {
            for k in 0..substeps {
                let time = n as f64 * sample_interval + f64::from(k) * step;
                if side == 0.0 {
                    if moment(time).abs() <= restoring_moment {
                        continue;
                    }
                    side = moment(time).signum();
                }
                // The step is that of the velocity Verlet method.
                let start_acceleration = acceleration(time, tilt, side);
                let mut next_tilt = tilt + step * (rate + 0.5 * step * start_acceleration);
                let end_acceleration = acceleration(time + step, next_tilt, side);
                rate += 0.5 * step * (start_acceleration + end_acceleration);
                if next_tilt * side < 0.0 {
                    // The tilt is taken as linear within the step: the error of the impact's time is of the order of step².
                    let fraction = tilt / (tilt - next_tilt);
                    impacts.push(time + fraction * step);
                    rate *= rate_factor;
                    side = -side;
                    next_tilt = rate * (1.0 - fraction) * step;
                }
                tilt = next_tilt;
            }
            tilts.push(tilt);
        }
        (tilts, impacts)
    }
}

/// Times at which a sampled tilt changes its sign, by linear interpolation.
pub fn crossings(tilts: &[f64], sample_interval: f64) -> Vec<f64> {
    let pairs = tilts.windows(2).enumerate().filter(|(_, pair)| pair[0] * pair[1] < 0.0);
    pairs
        .map(|(k, pair)| (k as f64 + pair[0] / (pair[0] - pair[1])) * sample_interval)
        .collect()
}

/// Time that a rigid block on a soil without inertia needs from rest at `tilt` until it is upright.
///
/// The moment of a frictionless no-tension strip is N b θ/(2θ_u) up to θ_u, and N b (1 − θ_u/(2θ)) above; the P–Δ moment
/// N h θ reduces it. `rate` is √(N h/I), with I about the corner.
pub fn quarter_period(tilt: f64, lift_off: f64, slenderness: f64, rate: f64) -> f64 {
    let acceleration = |theta: f64| {
        let arm =
            if theta > lift_off { 1.0 - 0.5 * lift_off / theta } else { 0.5 * theta / lift_off };
        -rate * rate * (slenderness * arm - theta)
    };
    let step = 1e-5;
    let mut theta = tilt;
    let mut speed = 0.0;
    let mut time = 0.0;
    loop {
        // Leapfrog.
        speed += 0.5 * step * acceleration(theta);
        let next_tilt = theta + step * speed;
        if next_tilt <= 0.0 {
            return time + step * theta / (theta - next_tilt);
        }
        theta = next_tilt;
        speed += 0.5 * step * acceleration(theta);
        time += step;
    }
}
