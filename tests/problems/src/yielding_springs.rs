//! Springs that yield in parallel components: Iwan's model of one deformation, written for the tests.

use basemat::structure::{Base, InternalEnergy, NonlinearForce, RigidBlock, Structure, Triplets};

use crate::{needed_from, own_force};

/// Elastic–perfectly plastic component of a spring.
#[derive(Debug, Clone, Copy)]
pub struct Component {
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Force at which the component yields, N.
    pub strength: f64,
}

impl Component {
    /// Force at a deformation, and the plastic deformation there.
    fn respond(&self, deformation: f64, plastic: f64) -> (f64, f64) {
        let trial = self.stiffness * (deformation - plastic);
        let force = trial.clamp(-self.strength, self.strength);
        // Without yielding, the plastic deformation keeps all its bits.
        if force == trial {
            (force, plastic)
        } else {
            (force, deformation - force / self.stiffness)
        }
    }
}

/// Components of a hyperbola with twelve corners, from an initial stiffness and a strength.
pub fn hyperbolic(stiffness: f64, strength: f64) -> Vec<Component> {
    let reference_deformation = strength / stiffness;
    let last_deformation = 200.0 * reference_deformation;
    let limit = 1.0 / (1.0 / strength - 1.0 / (last_deformation * stiffness));
    let deformations: Vec<f64> = (0..12)
        .map(|j| 0.02 * reference_deformation * 1e4_f64.powf(f64::from(j) / 11.0))
        .collect();
    let force = |j: usize| {
        let linear = stiffness * deformations[j];
        if j == 0 { linear } else { linear / (1.0 + linear / limit) }
    };
    let slope = |j: usize| match j {
        0 => stiffness,
        12 => 0.0,
        _ => (force(j) - force(j - 1)) / (deformations[j] - deformations[j - 1]),
    };
    (0..12)
        .map(|j| {
            let stiffness = slope(j) - slope(j + 1);
            Component { stiffness, strength: stiffness * deformations[j] }
        })
        .collect()
}

/// Spring with the deformation Σ weight · displacement.
#[derive(Debug, Clone)]
pub struct YieldingSpring {
    /// (degree of freedom, weight) terms.
    pub row: Vec<(usize, f64)>,
    pub components: Vec<Component>,
}

impl YieldingSpring {
    fn deformation(&self, displacement: &[f64]) -> f64 {
        self.row.iter().map(|&(dof, weight)| weight * displacement[dof]).sum()
    }
}

/// A structure with yielding springs.
#[derive(Debug, Clone)]
pub struct WithYieldingSprings<S> {
    structure: S,
    springs: Vec<YieldingSpring>,
    /// Plastic deformations of all components, then the dissipated energy.
    variables: Vec<f64>,
    /// Committed deformation of each spring.
    deformations: Vec<f64>,
    /// Whether `remainder` returns a value.
    has_remainder: bool,
    /// Factor of the remainder: 1, or another value for an error on purpose.
    pub remainder_factor: f64,
}

impl<S> WithYieldingSprings<S> {
    pub fn new(structure: S, springs: Vec<YieldingSpring>) -> Self {
        let count: usize = springs.iter().map(|spring| spring.components.len()).sum();
        let variables = vec![0.0; count + 1];
        let deformations = vec![0.0; springs.len()];
        Self {
            structure,
            springs,
            variables,
            deformations,
            has_remainder: true,
            remainder_factor: 1.0,
        }
    }

    /// The same without a remainder.
    #[must_use]
    pub fn without_remainder(self) -> Self {
        Self { has_remainder: false, ..self }
    }

    /// Each spring with the plastic deformations of its components.
    fn springs_with_plastic(&self) -> impl Iterator<Item = (&YieldingSpring, &[f64])> {
        let mut plastic = &self.variables[..];
        self.springs.iter().map(move |spring| {
            let (components, remaining) = plastic.split_at(spring.components.len());
            plastic = remaining;
            (spring, components)
        })
    }

    /// Largest plastic deformation of a component, m.
    pub fn largest_plastic_deformation(&self) -> f64 {
        let (_, plastic) = self.variables.split_last().unwrap();
        plastic.iter().fold(0.0_f64, |largest, p| largest.max(p.abs()))
    }
}

impl<S: Structure> Structure for WithYieldingSprings<S> {
    needed_from!(structure);

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.structure.damping(matrix)
    }

    own_force!();
}

impl<S: Structure> NonlinearForce for WithYieldingSprings<S> {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        for (spring, plastic) in self.springs_with_plastic() {
            let deformation = spring.deformation(displacement);
            let components = spring.components.iter().zip(plastic);
            let sum: f64 = components.map(|(c, p)| c.respond(deformation, *p).0).sum();
            spring.row.iter().for_each(|&(dof, weight)| force[dof] += weight * sum);
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        for (spring, plastic) in self.springs_with_plastic() {
            let deformation = spring.deformation(displacement);
            let components = spring.components.iter().zip(plastic);
            let elastic = components.filter(|(c, p)| c.respond(deformation, **p).1 == **p);
            matrix.add_outer(&spring.row, elastic.map(|(c, _)| c.stiffness).sum());
        }
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        let mut energy = InternalEnergy { stored: 0.0, dissipated: *self.variables.last()? };
        for (spring, plastic) in self.springs_with_plastic() {
            let deformation = spring.deformation(displacement);
            for (component, p) in spring.components.iter().zip(plastic) {
                let (force, end) = component.respond(deformation, *p);
                energy.stored += 0.5 * force * force / component.stiffness;
                energy.dissipated += force * (end - p);
            }
        }
        Some(energy)
    }

    /// Σ (s_m − s₁) Δe + (s₁ − s₀)²/(2k) over the components.
    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        if !self.has_remainder {
            return None;
        }
        let mut remainder = 0.0;
        for ((spring, plastic), &first) in self.springs_with_plastic().zip(&self.deformations) {
            let [middle, last] = [midstep, end].map(|u| spring.deformation(u));
            for (component, p) in spring.components.iter().zip(plastic) {
                let [s_m, s_1, s_0] = [middle, last, first].map(|e| component.respond(e, *p).0);
                remainder +=
                    (s_m - s_1) * (last - first) + 0.5 * (s_1 - s_0).powi(2) / component.stiffness;
            }
        }
        Some(self.remainder_factor * remainder)
    }

    fn describe_state(&self, displacement: &[f64], dofs: &[usize]) -> Option<String> {
        let mut springs = self.springs.iter().enumerate();
        let (k, spring) =
            springs.find(|(_, spring)| spring.row.iter().any(|(dof, _)| dofs.contains(dof)))?;
        Some(format!("spring {k} with a deformation of {:.2e}", spring.deformation(displacement)))
    }

    fn commit(&mut self, displacement: &[f64]) {
        if let (Some(energy), Some(last)) = (self.energy(displacement), self.variables.last_mut()) {
            *last = energy.dissipated;
        }
        let mut variables = self.variables.iter_mut();
        for (spring, committed) in self.springs.iter().zip(&mut self.deformations) {
            let deformation = spring.deformation(displacement);
            *committed = deformation;
            for (component, p) in spring.components.iter().zip(variables.by_ref()) {
                *p = component.respond(deformation, *p).1;
            }
        }
    }

    fn save(&self) -> basemat::Result<Vec<f64>> {
        Ok([&self.variables[..], &self.deformations].concat())
    }

    fn restore(&mut self, values: &[f64]) -> basemat::Result<()> {
        let count = self.variables.len();
        if values.len() != count + self.deformations.len() {
            return Err(basemat::Error::part("yielding springs", "other number of variables"));
        }
        self.variables.copy_from_slice(&values[..count]);
        self.deformations.copy_from_slice(&values[count..]);
        Ok(())
    }
}

/// A rigid block that carries masses with a horizontal degree of freedom each.
#[derive(Debug, Clone)]
pub struct Masses {
    pub block: RigidBlock,
    pub count: usize,
    /// Mass of each, kg.
    pub mass: f64,
}

impl Structure for Masses {
    fn dofs(&self) -> usize {
        self.block.dofs() + self.count
    }

    fn base(&self) -> Base {
        self.block.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for dof in self.block.dofs()..self.dofs() {
            matrix.add(dof, dof, self.mass);
        }
        self.block.mass(matrix)
    }

    fn stiffness(&self, _: &mut Triplets) -> basemat::Result<()> {
        Ok(())
    }
}

/// Column of soil on a block 4 m wide: cells of 0.5 m, G = 45.6 MPa, strength 40 kPa, 1900 kg/m³.
pub fn spring_column(count: usize) -> WithYieldingSprings<Masses> {
    let [width, height] = [4.0, 0.5];
    let block = RigidBlock::new(width, 1.0, 1900.0).unwrap();
    let first_dof = block.dofs();
    let masses = Masses { block, count, mass: 1900.0 * width * height };
    let springs = (0..count).map(|k| {
        let below = if k == 0 { 0 } else { first_dof + k - 1 };
        YieldingSpring {
            row: vec![(below, -1.0), (first_dof + k, 1.0)],
            components: hyperbolic(45.6e6 * width / height, 40e3 * width),
        }
    });
    let springs = springs.collect();
    WithYieldingSprings::new(masses, springs)
}
