//! Integration of a quadrilateral's material: forces with internal variables, and stiffness of small strains.

use std::ops::Range;

use super::inelastic_force::{InelasticForce, SolidPoint};
use super::internal_energy::InternalEnergy;
use super::solid::{SharedMaterial, SolidMaterial, StrainPath};
use super::stress_at_rest::StressAtRest;
use crate::error::{Result, all_finite, same_length};

/// Difference of stresses that counts as rounding, relative to the stress at rest.
const STRESS_ROUNDING: f64 = 1e-14;

/// Integration point of a quadrilateral with N degrees of freedom.
pub(super) struct IntegrationPoint<const N: usize> {
    /// Index among the points of the element.
    pub(super) index: usize,
    /// Natural coordinates (ξ, η).
    pub(super) natural_point: [f64; 2],
    /// Area of the point, m²: the weight of the rule times the Jacobian.
    pub(super) area: f64,
    /// Strains `[xx, yy, zz, xy]` due to a unit displacement of each degree of freedom, 1/m.
    pub(super) strains: [[f64; 4]; N],
    /// Whether the strains of each node are the derivatives of its shape function: `[x, 0, 0, y]` and `[0, y, 0, x]`.
    pub(super) has_derivatives: bool,
}

impl<const N: usize> IntegrationPoint<N> {
    /// Strain at the point due to the displacements of the nodes, m.
    fn strain(&self, displacement: &[f64]) -> [f64; 4] {
        let mut strain = [0.0; 4];
        for (column, u) in self.strains.iter().zip(displacement) {
            for (sum, entry) in strain.iter_mut().zip(column) {
                *sum += entry * u;
            }
        }
        strain
    }

    /// Adds the nodal forces of a stress, Pa, to `force`.
    fn add_force(&self, stress: [f64; 4], force: &mut [f64]) {
        for (nodal_force, column) in force.iter_mut().zip(&self.strains) {
            *nodal_force += self.area * inner_product(column, &stress);
        }
    }

    /// Adds the stiffness of a tangent ∂stress/∂strain, Pa, to a row-major `matrix`.
    fn add_stiffness(&self, tangent: &[[f64; 4]; 4], matrix: &mut [f64]) {
        if self.has_derivatives {
            return self.add_stiffness_of_derivatives(tangent, matrix);
        }
        // Stress components by each degree of freedom, component after component, so that the inner loop is over
        // neighbouring numbers.
        let stresses =
            tangent.map(|row| self.strains.map(|column| self.area * inner_product(&row, &column)));
        for (matrix_row, strains) in matrix.as_chunks_mut::<N>().0.iter_mut().zip(&self.strains) {
            for j in 0..N {
                matrix_row[j] += strains[0] * stresses[0][j]
                    + strains[1] * stresses[1][j]
                    + strains[2] * stresses[2][j]
                    + strains[3] * stresses[3][j];
            }
        }
    }
}

impl<const N: usize> IntegrationPoint<N> {
    /// Adds the same stiffness without the products with zero strains.
    fn add_stiffness_of_derivatives(&self, tangent: &[[f64; 4]; 4], matrix: &mut [f64]) {
        // Stress components by each degree of freedom, component after component.
        let stresses = tangent.map(|row| {
            let mut component = [0.0; N];
            let pairs = component.as_chunks_mut::<2>().0.iter_mut();
            for (pair, column) in pairs.zip(self.strains.iter().step_by(2)) {
                let x = column[0];
                let y = column[3];
                *pair =
                    [self.area * (row[0] * x + row[3] * y), self.area * (row[1] * y + row[3] * x)];
            }
            component
        });
        let row_pairs = matrix.as_chunks_mut::<N>().0.as_chunks_mut::<2>().0.iter_mut();
        for ([x_row, y_row], column) in row_pairs.zip(self.strains.iter().step_by(2)) {
            let x = column[0];
            let y = column[3];
            for j in 0..N {
                x_row[j] += x * stresses[0][j] + y * stresses[3][j];
                y_row[j] += y * stresses[1][j] + x * stresses[3][j];
            }
        }
    }
}

/// Difference of a stress from that at rest, Pa, without rounding.
///
/// Soil at rest then has no force at all, which a search for an equilibrium would otherwise balance.
fn change_from_rest(stress: [f64; 4], stress_at_rest: [f64; 4]) -> [f64; 4] {
    let rounding = STRESS_ROUNDING * stress_at_rest.iter().fold(0.0_f64, |max, s| max.max(s.abs()));
    std::array::from_fn(|i| {
        let change = stress[i] - stress_at_rest[i];
        if change.abs() <= rounding { 0.0 } else { change }
    })
}

fn inner_product(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Integration rule of a quadrilateral with N degrees of freedom.
pub(super) trait IntegrationRule<const N: usize>: Copy + Send + Sync {
    /// Number of integration points.
    fn point_count(self) -> usize;

    /// Calls `visit` at every integration point; ends at its first error.
    ///
    /// `coordinates` has the [x, y, z] of the N/2 nodes.
    fn visit_points(
        self,
        coordinates: &[[f64; 3]],
        visit: impl FnMut(&IntegrationPoint<N>) -> Result<()>,
    ) -> Result<()>;

    /// Shape functions of the N/2 nodes at natural coordinates (ξ, η), for the position of a point.
    fn node_weights(self, natural_point: [f64; 2]) -> impl IntoIterator<Item = f64>;
}

/// Material of a quadrilateral with N degrees of freedom, its stress at rest, and its integration rule.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct QuadSolid<R, const N: usize> {
    pub(super) material: SharedMaterial,
    pub(super) rule: R,
    initial_stress: InitialStress,
}

/// Stress of an undeformed element.
#[derive(Debug, Clone, PartialEq)]
enum InitialStress {
    /// Equal stresses `[xx, yy, zz, xy]` in the element, Pa, whose nodal forces act at zero displacement.
    Uniform([f64; 4]),
    /// Stresses of soil at rest, in equilibrium with its weight: no forces at zero displacement.
    AtRest(StressAtRest),
}

impl<R: IntegrationRule<N>, const N: usize> QuadSolid<R, N> {
    pub(super) fn new(material: SharedMaterial, rule: R) -> Self {
        Self { material, rule, initial_stress: InitialStress::Uniform([0.0; 4]) }
    }

    /// Replaces the stress of the undeformed element, Pa.
    pub(super) fn with_initial_stress(self, initial_stress: [f64; 4]) -> Self {
        Self { initial_stress: InitialStress::Uniform(initial_stress), ..self }
    }

    /// Soil at rest with these stresses.
    pub(super) fn with_stress_at_rest(self, stress: &StressAtRest) -> Self {
        Self { initial_stress: InitialStress::AtRest(stress.clone()), ..self }
    }

    /// Whether this is soil at rest.
    pub(super) fn is_at_rest(&self) -> bool {
        matches!(self.initial_stress, InitialStress::AtRest(_))
    }

    /// Position [x, y] of a point, m.
    fn position(&self, point: &IntegrationPoint<N>, coordinates: &[[f64; 3]]) -> [f64; 2] {
        let mut position = [0.0; 2];
        for (weight, node) in
            self.rule.node_weights(point.natural_point).into_iter().zip(coordinates)
        {
            position[0] += weight * node[0];
            position[1] += weight * node[1];
        }
        position
    }

    /// Stress of soil at rest at a point, Pa; zero for other elements.
    fn stress_at_rest(&self, point: &IntegrationPoint<N>, coordinates: &[[f64; 3]]) -> [f64; 4] {
        match &self.initial_stress {
            InitialStress::Uniform(_) => [0.0; 4],
            InitialStress::AtRest(stress) => stress.at(self.position(point, coordinates)),
        }
    }

    /// Stress of the undeformed element at a point, Pa.
    fn initial_stress(&self, point: &IntegrationPoint<N>, coordinates: &[[f64; 3]]) -> [f64; 4] {
        match self.initial_stress {
            InitialStress::Uniform(stress) => stress,
            InitialStress::AtRest(_) => self.stress_at_rest(point, coordinates),
        }
    }

    pub(super) fn with_rule(self, rule: R) -> Self {
        Self { rule, ..self }
    }

    /// The force with internal variables; `None` for a linear elastic material.
    pub(super) fn inelastic(&self) -> Option<&dyn InelasticForce> {
        self.material.inelastic().map(|_| self as &dyn InelasticForce)
    }

    /// Adds the stiffness of small strains to a row-major `matrix`.
    pub(super) fn add_small_strain_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let elasticity = self.law().elasticity();
        let visit = |point: &IntegrationPoint<N>| {
            point.add_stiffness(&elasticity, matrix);
            Ok(())
        };
        // The visit returns no error.
        let _ = self.rule.visit_points(coordinates, visit);
    }

    /// Returns an error for an initial stress that the material cannot have.
    ///
    /// Linear elastic soil at rest has no stress.
    pub(super) fn check_initial_stress(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        let mut variables = vec![0.0; self.law().variable_count()];
        match self.initial_stress {
            InitialStress::Uniform(stress) => {
                all_finite("initial stress of a quadrilateral", &stress)?;
                self.law().initialize(stress, &mut variables)
            }
            InitialStress::AtRest(_) if self.material.elastic().is_some() => Ok(()),
            InitialStress::AtRest(_) => self.rule.visit_points(coordinates, |point| {
                let stress = self.stress_at_rest(point, coordinates);
                self.law().initialize(stress, &mut variables).map_err(|fault| {
                    let depth = -self.position(point, coordinates)[1];
                    fault.within(format!("soil at rest at a depth of {depth:.3} m"))
                })
            }),
        }
    }

    fn law(&self) -> &dyn SolidMaterial {
        self.material.law()
    }

    /// Range of a point's internal variables among those of the element.
    fn variable_range(&self, point_index: usize) -> Range<usize> {
        let count = self.law().variable_count();
        point_index * count..(point_index + 1) * count
    }

    /// Returns an error unless every list has the length that the element needs.
    fn check_lengths(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<()> {
        same_length("coordinates of a quadrilateral", coordinates.len(), N / 2)?;
        same_length("displacement of a quadrilateral", displacement.len(), N)?;
        let variable_count = self.variable_count();
        same_length("internal variables of a quadrilateral", variables.len(), variable_count)
    }
}

impl<R: IntegrationRule<N>, const N: usize> InelasticForce for QuadSolid<R, N> {
    fn variable_count(&self) -> usize {
        self.rule.point_count() * self.law().variable_count()
    }

    fn initialize(&self, coordinates: &[[f64; 3]], variables: &mut [f64]) -> Result<()> {
        let variable_count = self.variable_count();
        same_length("internal variables of a quadrilateral", variables.len(), variable_count)?;
        same_length("coordinates of a quadrilateral", coordinates.len(), N / 2)?;
        self.rule.visit_points(coordinates, |point| {
            let range = self.variable_range(point.index);
            let stress = self.initial_stress(point, coordinates);
            self.law().initialize(stress, &mut variables[range])
        })
    }

    fn force(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        force: &mut [f64],
    ) -> Result<()> {
        self.check_lengths(coordinates, displacement, variables)?;
        self.rule.visit_points(coordinates, |point| {
            let point_variables = &variables[self.variable_range(point.index)];
            let mut stress = self.law().stress(point.strain(displacement), point_variables)?;
            if self.is_at_rest() {
                let stress_at_rest = self.stress_at_rest(point, coordinates);
                stress = change_from_rest(stress, stress_at_rest);
            }
            point.add_force(stress, force);
            Ok(())
        })
    }

    fn tangent(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
        matrix: &mut [f64],
    ) -> Result<()> {
        self.check_lengths(coordinates, displacement, variables)?;
        self.rule.visit_points(coordinates, |point| {
            let point_variables = &variables[self.variable_range(point.index)];
            let tangent = self.law().tangent(point.strain(displacement), point_variables)?;
            point.add_stiffness(&tangent, matrix);
            Ok(())
        })
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.law().has_symmetric_tangent()
    }

    fn energy(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        self.check_lengths(coordinates, displacement, variables)?;
        let mut sum = InternalEnergy::default();
        self.rule.visit_points(coordinates, |point| {
            let point_variables = &variables[self.variable_range(point.index)];
            let strain = point.strain(displacement);
            let energy_density = self.law().energy(strain, point_variables)?;
            sum.stored += point.area * energy_density.stored;
            if self.is_at_rest() {
                // The weight of the soil and the pressures at rest around it do the work −σ₀ : ε.
                let stress_at_rest = self.stress_at_rest(point, coordinates);
                sum.stored -= point.area * inner_product(&stress_at_rest, &strain);
            }
            sum.dissipated += point.area * energy_density.dissipated;
            Ok(())
        })?;
        Ok(sum)
    }

    fn remainder(
        &self,
        coordinates: &[[f64; 3]],
        displacements: [&[f64]; 3],
        variables: &[f64],
    ) -> Result<f64> {
        for displacement in displacements {
            self.check_lengths(coordinates, displacement, variables)?;
        }
        let mut sum = 0.0;
        self.rule.visit_points(coordinates, |point| {
            let point_variables = &variables[self.variable_range(point.index)];
            let path = StrainPath {
                start: point.strain(displacements[0]),
                midstep: point.strain(displacements[1]),
                end: point.strain(displacements[2]),
            };
            sum += point.area * self.law().remainder(&path, point_variables)?;
            Ok(())
        })?;
        Ok(sum)
    }

    /// Changes nothing if a list does not have the length that the element needs.
    fn commit(&self, coordinates: &[[f64; 3]], displacement: &[f64], variables: &mut [f64]) {
        if self.check_lengths(coordinates, displacement, variables).is_err() {
            return;
        }
        let visit = |point: &IntegrationPoint<N>| {
            let range = self.variable_range(point.index);
            self.law().commit(point.strain(displacement), &mut variables[range]);
            Ok(())
        };
        // The visit returns no error.
        let _ = self.rule.visit_points(coordinates, visit);
    }

    fn points(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        variables: &[f64],
    ) -> Result<Vec<SolidPoint>> {
        self.check_lengths(coordinates, displacement, variables)?;
        let mut points = Vec::with_capacity(self.rule.point_count());
        self.rule.visit_points(coordinates, |point| {
            let point_variables = &variables[self.variable_range(point.index)];
            let strain = point.strain(displacement);
            points.push(SolidPoint {
                position: self.position(point, coordinates),
                area: point.area,
                strain,
                stress: self.law().stress(strain, point_variables)?,
                state: self.law().state(strain, point_variables),
            });
            Ok(())
        })?;
        Ok(points)
    }
}

#[cfg(test)]
mod tests;
