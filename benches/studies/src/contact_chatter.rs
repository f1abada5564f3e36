//! Contact chatter: which time scheme and which contact activation keep the normal force smooth.
//!
//! A block of 4 m × 8 m rocks and slides on soil under El Centro, twice as strong. For every
//! scheme and three time steps the table shows the content of the normal force and of the top's
//! acceleration above 20 Hz, base shear, slip, uplift, rotation, and the terms of the energy balance.
//!
//! ```text
//! cargo study contact-chatter
//! ```

use basemat::interface::UnilateralCondition;
use basemat_problems::chatter::{ChatterScene, ChatterScheme};

use crate::AnyError;

/// Contact chatter of a rocking and sliding block on soil.
#[derive(Debug, clap::Args)]
pub(crate) struct ContactChatterOptions {
    /// Friction coefficients
    #[arg(long, value_delimiter = ',', default_value = "0.6,0.3")]
    friction: Vec<f64>,
    /// Shear wave speed of the soil, m/s
    #[arg(long, default_value_t = 250.0)]
    shear_speed: f64,
    /// Elements under the base
    #[arg(long, default_value_t = 16)]
    elements: usize,
    /// Coarsest time step, s; halved and quartered too
    #[arg(long, default_value_t = 2e-3)]
    time_step: f64,
    /// Duration, s
    #[arg(long, default_value_t = 10.0)]
    duration: f64,
    /// Height of the block, m
    #[arg(long, default_value_t = 8.0)]
    height: f64,
    /// A flexible block of finite elements with this Young's modulus, Pa, instead of a rigid one
    #[arg(long)]
    young: Option<f64>,
}

pub(crate) fn run(options: &ContactChatterOptions) -> Result<(), AnyError> {
    let rate = UnilateralCondition::Velocity { closed_below: 1e-9 };
    let schemes = [
        ("midpoint, gap", ChatterScheme::Midpoint, UnilateralCondition::Position),
        ("θ = 0.55, gap", ChatterScheme::Theta(0.55), UnilateralCondition::Position),
        ("θ = 0.6, gap", ChatterScheme::Theta(0.6), UnilateralCondition::Position),
        ("dissipative, γ = 0.8", ChatterScheme::Dissipative(0.8), UnilateralCondition::Position),
        ("dissipative, γ = 1", ChatterScheme::Dissipative(1.0), UnilateralCondition::Position),
        ("midpoint, rate", ChatterScheme::Midpoint, rate),
        ("θ = 0.55, rate", ChatterScheme::Theta(0.55), rate),
        ("θ = 0.6, rate", ChatterScheme::Theta(0.6), rate),
    ];
    println!("lengths in mm, content above 20 Hz and energies relative to weight and input");
    for &friction in &options.friction {
        println!(
            "\n| friction {friction} | Δt, ms | rms > 20 Hz, % | peak > 20 Hz, % | alternating, % | \
             acceleration > 20 Hz, g | alternating, g | peak shear / weight | peak slip | \
             residual slip | uplift | peak rotation, mrad | contact | numerical | penetration | \
             energy balance | changes |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
        for (name, scheme, activation) in schemes {
            for halving in 0..3 {
                let scene = ChatterScene {
                    friction,
                    scheme,
                    activation,
                    shear_speed: options.shear_speed,
                    elements: options.elements,
                    time_step: options.time_step / f64::from(1 << halving),
                    duration: options.duration,
                    height: options.height,
                    young: options.young,
                };
                let outcome = scene.run()?;
                println!(
                    "| {name} | {:.3} | {:.3} | {:.2} | {:.3} | {:.4} | {:.4} | {:.4} | {:.3} | {:.3} | \
                     {:.3} | {:.3} | {:.4} | \
                     {:.4} | {:.1e} | {:.0e} | {} |",
                    1e3 * scene.time_step,
                    100.0 * outcome.rms_above,
                    100.0 * outcome.peak_above,
                    100.0 * outcome.alternating,
                    outcome.acceleration_above,
                    outcome.acceleration_alternating,
                    outcome.shear,
                    1e3 * outcome.peak_slip,
                    1e3 * outcome.residual_slip,
                    outcome.uplift,
                    1e3 * outcome.rotation,
                    outcome.contact_energy,
                    outcome.algorithmic_energy,
                    1e3 * outcome.penetration,
                    outcome.energy_error,
                    outcome.mode_changes
                );
            }
        }
    }
    Ok(())
}
