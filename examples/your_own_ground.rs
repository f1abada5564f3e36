//! A custom ground: independent elastic columns, in which all waves travel straight down.
//!
//! ```text
//! cargo run --release --example your_own_ground
//! ```
//!
//! Under each contact element is an infinitely deep column of soil. A pressure p moves its top down at the velocity
//! p/(ρ c_P), and a shear traction τ moves it sideways at the velocity τ/(ρ c_S). The only state of a column is the
//! displacement of its top. A column is a dashpot without static stiffness. A spring of `spring_stiffness` Pa/m
//! therefore acts in parallel, so that the ground can carry the weight.
//!
//! The traction of a step is the traction at the middle of the step, where the spring has the mean of the displacements
//! at both ends of the step. A spring without dashpot therefore has the step compliance 2/k and the history −s₀, where
//! s₀ is the displacement at the start. With s = τ/k at the end of the step instead, it would have numerical damping of
//! first order in the time step.

use basemat::bem::{ContactElement, Ground, Strip};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::structure::RigidBlock;
use basemat::{Observer, Result, Simulation, Soil};

/// Columns of soil under the contact elements, with parallel springs.
struct Columns {
    elements: Vec<ContactElement>,
    /// ρ c_P and ρ c_S, Pa·s/m.
    impedance: [f64; 2],
    /// Stiffness of springs parallel to the dashpots, Pa/m.
    spring_stiffness: f64,
    time_step: f64,
    /// Displacements at the end of the last accepted step, m: normal components (down), then tangential components.
    displacement: Vec<f64>,
}

/// Factors of a step of length Δt: new displacement = `previous` · old displacement + `traction` · traction.
struct StepFactors {
    previous_displacement: f64,
    traction: f64,
}

impl Columns {
    fn new(
        soil: Soil,
        range: std::ops::Range<f64>,
        count: usize,
        spring_stiffness: f64,
    ) -> Result<Self> {
        let wave_speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        Ok(Self {
            elements: Strip::uniform(range, count)?.elements(),
            impedance: wave_speeds.map(|speed| soil.density() * speed),
            spring_stiffness,
            time_step: 0.0,
            displacement: vec![0.0; 2 * count],
        })
    }

    /// Factors of the next step for a component of the displacement.
    ///
    /// They follow from the midpoint rule for `z ds/dt + k s = traction`. `SpringGround::of_elements` in this crate is
    /// a ready ground of such springs and dashpots.
    fn step_factors(&self, component: usize) -> StepFactors {
        let z = self.impedance[usize::from(component >= self.elements.len())] / self.time_step;
        let k = 0.5 * self.spring_stiffness;
        StepFactors { previous_displacement: (z - k) / (z + k), traction: 1.0 / (z + k) }
    }
}

impl Ground for Columns {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        time_step: f64,
        _steps: Option<usize>,
        _observer: &mut Observer<'_>,
    ) -> Result<()> {
        self.time_step = time_step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let component_count = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..component_count {
            matrix[i * component_count + i] = self.step_factors(i).traction;
        }
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (i, history) in displacement.iter_mut().enumerate() {
            *history = self.step_factors(i).previous_displacement * self.displacement[i];
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for (i, traction) in traction.iter().enumerate() {
            let factors = self.step_factors(i);
            self.displacement[i] =
                factors.previous_displacement * self.displacement[i] + factors.traction * traction;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let component_count = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..component_count {
            matrix[i * component_count + i] = 1.0 / self.spring_stiffness;
        }
        Ok(())
    }
}

fn main() -> Result<()> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    let run = Simulation::builder(5.0e-3)
        .structure(RigidBlock::new(6.0, 8.0, 1000.0)?)
        .ground(Columns::new(soil, -3.0..3.0, 12, 20.0e6)?)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .build()?
        .run(2000, |_| {})?;
    println!("{run}");
    Ok(())
}
