//! GOAL: a beam of fibres in space is the beam of the plane there, the same at any angle and from its other end.
//! SCENE: single beams of steel and of concrete with bars along random paths.
//! REFERENCE: the beam in the plane; the beam as it stands.

use basemat::Result;
use basemat::fem::{
    BeamFormulation, BeamQuadrature, BilinearSteel, Concrete, FiberBeam, FiberSection,
    MenegottoPinto, SpaceFiberBeam,
};
use basemat_problems::random::Random;

use super::compare::relative_difference;
use super::tally::{IdentityTally, scenes};
use super::yielding_elements::{PathResults, follow};

/// Steps of a path.
const PATH_STEPS: usize = 10;
/// Mass per length of the beams, kg/m.
const MASS_PER_LENGTH: f64 = 200.0;

/// Orthonormal axes in space, as rows.
type Axes = [[f64; 3]; 3];

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn inner(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let norm = inner(a, a).sqrt();
    a.map(|component| component / norm)
}

fn random_vector(random: &mut Random) -> [f64; 3] {
    [0; 3].map(|_| random.within(-1.0, 1.0))
}

/// Right-handed axes of any direction.
fn random_axes(random: &mut Random) -> Axes {
    let x = unit(random_vector(random));
    let z = unit(cross(x, random_vector(random)));
    [x, cross(z, x), z]
}

/// A vector of these components along axes.
fn along(axes: &Axes, components: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| (0..3).map(|axis| components[axis] * axes[axis][k]).sum())
}

/// Components of vectors, three values each, along axes.
fn components(axes: &Axes, values: &[f64]) -> Vec<f64> {
    let vectors = values.chunks(3).map(|vector| [vector[0], vector[1], vector[2]]);
    vectors.flat_map(|vector| axes.map(|axis| inner(axis, vector))).collect()
}

/// A random section without symmetry along y.
#[derive(Debug, Clone, Copy)]
struct RandomSection {
    is_concrete: bool,
    depth: f64,
    width: f64,
    /// Offset of the section from the line of the nodes along y and z.
    offset: [f64; 2],
    formulation: BeamFormulation,
    quadrature: BeamQuadrature,
}

impl RandomSection {
    fn draw(random: &mut Random) -> Self {
        let depth = random.within(0.3, 0.6);
        let point_count = random.pick(&[3, 4, 5]);
        Self {
            is_concrete: random.chance(0.5),
            depth,
            width: random.within(0.2, 0.5),
            offset: [random.within(-0.2, 0.2) * depth, random.within(-0.1, 0.1)],
            formulation: random
                .pick(&[BeamFormulation::DisplacementBased, BeamFormulation::ForceBased]),
            quadrature: random.pick(&[
                BeamQuadrature::Lobatto(point_count),
                BeamQuadrature::Legendre(point_count),
            ]),
        }
    }

    /// The section with all z times a factor, of 1 or −1.
    fn fibers(self, z_factor: f64) -> Result<FiberSection> {
        let y = self.offset[0];
        let z = self.offset[1];
        let half_depth = 0.5 * self.depth;
        let half_width = 0.5 * self.width;
        let place = |a: f64, b: f64| [y + a * half_depth, z_factor * (z + b * half_width)];
        let corners = [place(-1.0, -1.0), place(1.0, 1.0)];
        let section = if self.is_concrete {
            let concrete = Concrete::new(30.0e6, 0.002, 10.0e6, 0.008)?;
            let bars = MenegottoPinto::new(500.0e6, 200.0e9, 0.01)?;
            FiberSection::new()
                .with_rectangle(corners, [6, 4], concrete)?
                .with_bars([place(-0.8, -0.8), place(-0.8, 0.8)], 3, 5e-4, bars)?
                .with_bars([place(0.8, -0.8), place(0.8, 0.8)], 2, 5e-4, bars)?
        } else {
            let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.02)?;
            FiberSection::new().with_rectangle(corners, [6, 4], steel)?
        };
        section.with_torsional_stiffness(3.0e7)
    }

    fn space_beam(self, z_factor: f64, orientation: [f64; 3]) -> Result<SpaceFiberBeam> {
        let section = self.fibers(z_factor)?;
        let beam =
            SpaceFiberBeam::new([0, 1], &section, self.quadrature, MASS_PER_LENGTH, orientation)?;
        Ok(beam.with_formulation(self.formulation))
    }

    fn plane_beam(self) -> Result<FiberBeam> {
        let section = self.fibers(1.0)?;
        let beam = FiberBeam::new([0, 1], &section, self.quadrature, MASS_PER_LENGTH)?;
        Ok(beam.with_formulation(self.formulation))
    }

    /// Largest relative difference by rounding: that of iterations inside the element, or of sums.
    fn limit(self) -> f64 {
        if self.formulation == BeamFormulation::ForceBased { 1e-9 } else { 1e-11 }
    }

    fn words(self) -> [&'static str; 2] {
        let material = if self.is_concrete { "concrete" } else { "steel" };
        let formulation = match self.formulation {
            BeamFormulation::ForceBased => "by forces",
            _ => "by displacements",
        };
        [material, formulation]
    }
}

/// Random displacements of both nodes: `count` displacements and as many rotations at each node.
fn random_path(random: &mut Random, counts: [usize; 2]) -> Vec<Vec<f64>> {
    let node_dofs = counts[0] + counts[1];
    let mut path = vec![vec![0.0; 2 * node_dofs]];
    for _ in 0..PATH_STEPS {
        let last_displacement = &path[path.len() - 1];
        let next_displacement = last_displacement.iter().enumerate().map(|(dof, value)| {
            let step = if dof % node_dofs < counts[0] { 2e-3 } else { 4e-3 };
            value + random.within(-step, step)
        });
        path.push(next_displacement.collect());
    }
    path
}

/// Compares two paths to a limit.
fn compare(tally: &mut IdentityTally, place: &str, results: [Result<PathResults>; 2], limit: f64) {
    tally.compare(place, results, |tally, expected, computed| {
        for (name, expected, computed) in [
            ("forces", expected.forces, computed.forces),
            ("tangent", expected.tangent_forces, computed.tangent_forces),
            ("energies", expected.energies, computed.energies),
        ] {
            let difference = relative_difference(&expected, &computed);
            tally.within(&format!("{name}, {place}"), difference, limit);
        }
    });
}

/// GOAL: in any plane of space, forces and energies are those of the beam in the plane, without a force across it.
#[test]
fn beams_of_fibres_in_a_plane_of_space() {
    let mut tally = IdentityTally::new("beams of fibres in a plane of space");
    let mut random = Random(611);
    for number in 0..scenes(30, 600) {
        let mut section = RandomSection::draw(&mut random);
        section.offset[1] = 0.0;
        let axes = random_axes(&mut random);
        let ends = [[0.3, -0.2], [0.3 + random.within(1.0, 3.0), random.within(-3.0, 3.0)]];
        let plane_points = ends.map(|[x, y]| [x, y, 0.0]);
        let points = plane_points.map(|point| along(&axes, point));
        let path = random_path(&mut random, [2, 1]);
        let space_path: Vec<Vec<f64>> = path
            .iter()
            .map(|u| {
                u.chunks(3)
                    .flat_map(|node| {
                        [along(&axes, [node[0], node[1], 0.0]), along(&axes, [0.0, 0.0, node[2]])]
                    })
                    .flatten()
                    .collect()
            })
            .collect();
        // The y axis of the plane's beam is to its left.
        let run = ends[1][0] - ends[0][0];
        let rise = ends[1][1] - ends[0][1];
        let skewness = random.within(-1.0, 1.0);
        let orientation = along(&axes, [-rise + skewness * run, run + skewness * rise, 0.0]);
        let in_plane = section.plane_beam().and_then(|beam| follow(&beam, &plane_points, &path));
        let in_space = section.space_beam(1.0, orientation).and_then(|beam| {
            let results = follow(&beam, &points, &space_path)?;
            // Forces along x and y and the moment about z of the plane; the others vanish.
            let plane_values = |values: &[f64]| -> Vec<f64> {
                let local_values = components(&axes, values);
                let scale = local_values.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
                let vectors = local_values.chunks(6).map(|node| {
                    for across in [node[2], node[3], node[4]] {
                        assert!(across.abs() < 1e-9 * scale, "{across} across the plane");
                    }
                    [node[0], node[1], node[5]]
                });
                vectors.flatten().collect()
            };
            let forces = plane_values(&results.forces);
            let tangent_forces = plane_values(&results.tangent_forces);
            Ok(PathResults { forces, tangent_forces, energies: results.energies })
        });
        tally.scene(&section.words());
        compare(
            &mut tally,
            &format!("{number}: {section:?}"),
            [in_plane, in_space],
            section.limit(),
        );
    }
    tally.close(0.9);
}

/// GOAL: forces, tangents and energies turn with the beam, and do not depend on the order of its nodes.
#[test]
fn beams_of_fibres_turn_with_their_nodes() {
    let mut tally = IdentityTally::new("beams of fibres in space: turned, from the other end");
    let mut random = Random(617);
    for number in 0..scenes(30, 600) {
        let section = RandomSection::draw(&mut random);
        let axes = random_axes(&mut random);
        let first = random_vector(&mut random);
        let direction = unit(random_vector(&mut random));
        let length = random.within(1.0, 4.0);
        let points = [first, std::array::from_fn(|k| first[k] + length * direction[k])];
        let orientation = cross(direction, random_vector(&mut random));
        let path = random_path(&mut random, [3, 3]);
        let is_reversed = random.chance(0.5);
        let mut image_points = points.map(|point| along(&axes, point));
        let mut image_path: Vec<Vec<f64>> = path
            .iter()
            .map(|u| u.chunks(3).flat_map(|v| along(&axes, [v[0], v[1], v[2]])).collect())
            .collect();
        let mut z_factor = 1.0;
        if is_reversed {
            image_points.reverse();
            for displacement in &mut image_path {
                displacement.rotate_left(6);
            }
            z_factor = -1.0;
        }
        let expected =
            section.space_beam(1.0, orientation).and_then(|beam| follow(&beam, &points, &path));
        let image_orientation = along(&axes, orientation);
        let computed = section.space_beam(z_factor, image_orientation).and_then(|beam| {
            let mut results = follow(&beam, &image_points, &image_path)?;
            for values in [&mut results.forces, &mut results.tangent_forces] {
                if is_reversed {
                    values.chunks_mut(12).for_each(|force| force.rotate_left(6));
                }
                *values = components(&axes, values);
            }
            Ok(results)
        });
        let order = if is_reversed { "from the other end" } else { "from the first end" };
        tally.scene(&[&section.words()[..], &[order]].concat());
        let place = format!("{number}: {order}, {section:?}");
        compare(&mut tally, &place, [expected, computed], section.limit());
    }
    tally.close(0.9);
}
