//! GOAL: on separate spring beds several structures move as if each were alone.
//! SCENE: a tower and a block on spring beds, in degrees of freedom and in modes.
//! REFERENCE: each structure alone.

use basemat::Result;
use basemat::bem::{ContactElement, Ground, SpringGround};
use basemat::coupled::Coordinates;
use basemat::structure::StructureGroup;

use super::group::{base_scene, block, states, tower, traction_difference};

/// Bed of a foundation of this width.
fn spring_bed(center: f64, width: f64) -> SpringGround {
    let range = center - 0.5 * width..center + 0.5 * width;
    SpringGround::new(range, 6, 60.0e6, 40.0e6)
        .unwrap()
        .with_dashpots(3.0e5, 2.0e5)
        .unwrap()
}

/// GOAL: on separate spring beds two structures move as in two single runs: modes, weight, uplift,
/// sliding.
/// CONFIG: spring beds, in degrees of freedom and in modes.
#[test]
fn structures_on_springs_move_as_if_alone() {
    for coordinates in [Coordinates::Physical, Coordinates::Modes] {
        // The first bed is from −2 to 2, the second from 3 to 6.
        let first =
            base_scene().structure(tower()).ground(spring_bed(0.0, 4.0)).coordinates(coordinates);
        let first = states(first.build().unwrap(), 2000);
        let moved_block = block().centered_at(4.5).unwrap();
        let second = base_scene()
            .structure(moved_block)
            .ground(spring_bed(4.5, 3.0))
            .coordinates(coordinates);
        let second = states(second.build().unwrap(), 2000);
        let beds = [spring_bed(0.0, 4.0), spring_bed(4.5, 3.0)];
        let two_beds = TwoBeds { beds, elements: Vec::new() };
        let group = StructureGroup::new().with(tower(), 0.0).unwrap().with(block(), 4.5).unwrap();
        let group_states =
            base_scene().structure(group).ground(two_beds.joined()).coordinates(coordinates);
        let group_states = states(group_states.build().unwrap(), 2000);
        for (alone, from, which) in [(&first, 0, 0), (&second, 6, 1)] {
            let difference = traction_difference(&group_states, alone, from);
            assert!(difference < 1e-7, "{coordinates:?}: {difference:e}");
            let lifts_off = alone.iter().any(|state| state.uplifted_fraction > 0.3);
            assert!(lifts_off || which == 0);
            let foundation = &group_states[1999].foundations[which];
            let expected = &alone[1999];
            let scale = expected.normal_force;
            assert!((foundation.base_shear - expected.base_shear).abs() < 1e-6 * scale);
            assert!((foundation.base_moment - expected.base_moment).abs() < 1e-6 * scale);
            assert!((foundation.normal_force - expected.normal_force).abs() < 1e-6 * scale);
            assert!((foundation.base_rotation - expected.base_rotation).abs() < 1e-9);
            assert!((foundation.mean_slip - expected.mean_slip).abs() < 1e-9);
            assert_eq!(foundation.uplifted_fraction, expected.uplifted_fraction);
        }
        assert!(group_states.iter().all(|state| state.energy_balance.residual() < 1e-9));
    }
}

/// Two spring beds as one ground.
struct TwoBeds {
    beds: [SpringGround; 2],
    elements: Vec<ContactElement>,
}

impl TwoBeds {
    fn joined(mut self) -> Self {
        self.elements = self.beds.iter().flat_map(|bed| bed.elements().to_vec()).collect();
        self
    }

    /// Contact components of bed `k` of 2, six elements each.
    fn components(k: usize) -> impl Iterator<Item = usize> {
        (6 * k..6 * k + 6).chain(12 + 6 * k..18 + 6 * k)
    }

    fn spread(matrix: &mut [f64], blocks: impl Fn(usize, &mut [f64]) -> Result<()>) -> Result<()> {
        matrix.fill(0.0);
        for k in 0..2 {
            let mut block = [0.0; 144];
            blocks(k, &mut block)?;
            for (a, row) in Self::components(k).enumerate() {
                for (b, column) in Self::components(k).enumerate() {
                    matrix[row * 24 + column] = block[a * 12 + b];
                }
            }
        }
        Ok(())
    }
}

impl Ground for TwoBeds {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut basemat::Observer<'_>,
    ) -> Result<()> {
        self.beds.iter_mut().try_for_each(|bed| bed.prepare(time_step, steps, observer))
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::spread(matrix, |k, block| self.beds[k].step_compliance(block))
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for k in 0..2 {
            let mut block = [0.0; 12];
            self.beds[k].history(&mut block)?;
            Self::components(k).zip(block).for_each(|(i, value)| displacement[i] = value);
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        for k in 0..2 {
            let block: Vec<f64> = Self::components(k).map(|i| traction[i]).collect();
            self.beds[k].commit(&block);
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        Self::spread(matrix, |k, block| self.beds[k].static_compliance(block))
    }
}
