//! A custom structure: a five-storey shear building, written from scratch.
//!
//! ```text
//! cargo run --release --example your_own_structure
//! ```
//!
//! The example does not use the crate's `ShearBuilding`. A [`Structure`] returns the number of its degrees of freedom,
//! the points of its base, and its matrices; the crate adds ground, contact, time steps and energy balance. Four
//! methods are required; the fifth, `damping`, is optional.

use basemat::prelude::*;

const FLOOR_COUNT: usize = 5;

/// Degrees of freedom: `[u_x, u_y, θ]` of the rigid base, then the absolute horizontal displacement of each floor.
/// Masses, stiffness and dashpot are per metre of thickness.
struct Building {
    /// Width of the base, m.
    width: f64,
    /// kg/m.
    base_mass: f64,
    /// kg/m.
    floor_mass: f64,
    /// m.
    storey_height: f64,
    /// N/m².
    storey_stiffness: f64,
    /// N·s/m².
    storey_dashpot: f64,
}

// Degrees of freedom of the base.
const BASE_SWAY: usize = 0;
const BASE_HEAVE: usize = 1;
const BASE_ROTATION: usize = 2;

impl Building {
    /// Drift of a storey as (degree of freedom, weight) pairs: `u_j − u_(j−1) + h θ`.
    ///
    /// The sign of h θ is positive, since a base that rotates counter-clockwise moves the points above it to the left.
    fn drift(&self, storey: usize) -> [(usize, f64); 3] {
        let below = if storey == 0 { BASE_SWAY } else { storey + 2 };
        [(storey + 3, 1.0), (below, -1.0), (BASE_ROTATION, self.storey_height)]
    }
}

impl Structure for Building {
    fn dofs(&self) -> usize {
        3 + FLOOR_COUNT
    }

    // A rigid base needs only its two ends.
    fn base(&self) -> Base {
        let dofs = [BASE_SWAY, BASE_HEAVE, BASE_ROTATION];
        BaseNode::rigid_base(-0.5 * self.width, 0.5 * self.width, dofs).into()
    }

    // `Triplets` sums entries with the same row and column.
    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        let total = self.base_mass + FLOOR_COUNT as f64 * self.floor_mass;
        matrix.add(BASE_SWAY, BASE_SWAY, self.base_mass);
        matrix.add(BASE_HEAVE, BASE_HEAVE, total);
        matrix.add(BASE_ROTATION, BASE_ROTATION, total * self.width.powi(2) / 12.0);
        for floor in 0..FLOOR_COUNT {
            matrix.add(floor + 3, floor + 3, self.floor_mass);
        }
        Ok(())
    }

    // A spring of stiffness k with the deformation l·u has the matrix k lᵀl. The matrix contains no supports, since the
    // ground supports the building: rigid motions must cause no forces.
    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for storey in 0..FLOOR_COUNT {
            matrix.add_outer(self.drift(storey), self.storey_stiffness);
        }
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for storey in 0..FLOOR_COUNT {
            matrix.add_outer(self.drift(storey), self.storey_dashpot);
        }
        Ok(())
    }
}

fn main() -> basemat::Result<()> {
    let building = Building {
        width: 10.0,
        base_mass: 50.0e3,
        floor_mass: 20.0e3,
        storey_height: 3.0,
        storey_stiffness: 40.0e6,
        storey_dashpot: 0.2e6,
    };
    let drift = building.drift(0).to_vec();
    let roof = FLOOR_COUNT + 2;

    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &building, 10)?)
        .structure(building)
        .interface(Coulomb::new(0.4)?)
        .motion(el_centro_1940())
        .probe(Probe::displacement("first drift", drift))
        .probe(Probe::acceleration("roof acceleration", roof))
        .build()?;

    // The observer receives the state of every step; it could return `ControlFlow::Break`.
    let run = simulation.run(2400, |state| {
        if state.step % 400 == 0 {
            println!(
                "t = {:5.2} s: roof {:8.2} mm from the ground, {:3.0} % of the base open",
                state.time,
                1e3 * (state.absolute_displacement()[roof] - state.free_field[0]),
                100.0 * state.uplifted_fraction
            );
        }
    })?;
    println!("{run}");
    Ok(())
}
