//! A rocking block on a soil that yields without inertia.

/// Time that a rigid block on a soil without inertia needs from rest at `tilt` until it is upright.
///
/// Its moment is the one of a smooth no-tension strip: N b θ/(2θ_u) up to θ_u, N b (1 − θ_u/(2θ))
/// above, less N h θ; `rate` is √(N h/I), I about the corner.
pub fn quarter_period(tilt: f64, lift_off: f64, slenderness: f64, rate: f64) -> f64 {
    let acceleration = |theta: f64| {
        let arm =
            if theta > lift_off { 1.0 - 0.5 * lift_off / theta } else { 0.5 * theta / lift_off };
        -rate * rate * (slenderness * arm - theta)
    };
    let (mut theta, mut speed, mut time) = (tilt, 0.0, 0.0);
    let step = 1e-5;
    loop {
        // Leapfrog.
        speed += 0.5 * step * acceleration(theta);
        let next = theta + step * speed;
        if next <= 0.0 {
            return time + step * theta / (theta - next);
        }
        theta = next;
        speed += 0.5 * step * acceleration(theta);
        time += step;
    }
}
