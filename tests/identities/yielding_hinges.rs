//! GOAL: a hinge that yields has the same response at any angle, mirrored, and with its nodes exchanged.
//! SCENE: single hinges of all kinds, with and without rigid arms, along random paths.
//! REFERENCE: the hinge as it stands.

use basemat::Result;
use basemat::fem::{
    AxialMomentSurface, BilinearMoment, Element, Hinge, InteractionHinge, MenegottoPinto,
    SpaceHinge,
};
use basemat_problems::random::Random;

use super::compare::relative_difference;
use super::tally::{IdentityTally, scenes};
use super::yielding_elements::{PATH_STEPS, PathResults, ROUNDING_LIMIT, follow};

/// Rotation of space about a vector through zero, after a mirror at x = 0 or not.
#[derive(Debug, Clone, Copy)]
struct SpaceMap {
    axis: [f64; 3],
    angle: f64,
    is_mirrored: bool,
}

impl SpaceMap {
    /// Image of a displacement (Rodrigues' formula).
    fn vector(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let v = [if self.is_mirrored { -x } else { x }, y, z];
        let a = self.axis;
        let across =
            [a[1] * v[2] - a[2] * v[1], a[2] * v[0] - a[0] * v[2], a[0] * v[1] - a[1] * v[0]];
        let along: f64 = (0..3).map(|k| a[k] * v[k]).sum();
        let sin = self.angle.sin();
        let cos = self.angle.cos();
        std::array::from_fn(|k| cos * v[k] + sin * across[k] + (1.0 - cos) * along * a[k])
    }

    /// Image of a rotation: a mirror reverses it.
    fn rotation(&self, vector: [f64; 3]) -> [f64; 3] {
        let image = self.vector(vector);
        if self.is_mirrored { image.map(|part| -part) } else { image }
    }
}

/// Numbers of a hinge and of its path.
struct HingeCase {
    kind: &'static str,
    axis: [f64; 3],
    orientation: [f64; 3],
    stiffness: [f64; 4],
    strengths: [f64; 2],
    hardening_ratio: f64,
    /// Vector from the first to the second node, m.
    arm: [f64; 3],
}

const HINGE_KINDS: [&str; 6] = ["bilinear", "curved", "rectangle", "ellipse", "polygon", "space"];

impl HingeCase {
    fn draw(random: &mut Random) -> Self {
        let kind = random.pick(&HINGE_KINDS);
        let is_in_space = kind == "space";
        let mut vector = |size: f64| -> [f64; 3] {
            let [x, y, z] = std::array::from_fn(|_| random.within(-size, size));
            [x, y, if is_in_space { z } else { 0.0 }]
        };
        let axis = vector(1.0);
        let orientation = vector(1.0);
        let arm = vector(0.5);
        Self {
            kind,
            axis,
            orientation,
            arm: if random.chance(0.5) { arm } else { [0.0; 3] },
            stiffness: std::array::from_fn(|_| random.log_within(1e7, 1e9)),
            strengths: [random.log_within(1e5, 1e6), random.log_within(1e4, 1e5)],
            hardening_ratio: random.pick(&[0.0, 0.01, 0.2]),
        }
    }

    /// The hinge after a map; from its other side, in which the second node comes first and the axis is reversed.
    fn hinge(&self, map: &SpaceMap, is_reversed: bool) -> Result<Box<dyn Element>> {
        let sign = if is_reversed { -1.0 } else { 1.0 };
        let axis = map.vector(self.axis).map(|part| sign * part);
        let [k0, k1, k2, k3] = self.stiffness;
        let [axial_strength, moment] = self.strengths;
        let plane_axis = [axis[0], axis[1]];
        let nodes = [0, 1];
        let surface = match self.kind {
            "bilinear" => {
                let law = BilinearMoment::new(moment, k2, self.hardening_ratio)?;
                return Ok(Box::new(Hinge::new(nodes, k0, law)?.with_rigid_arm()));
            }
            "curved" => {
                let law = MenegottoPinto::new(moment, k2, self.hardening_ratio)?;
                return Ok(Box::new(Hinge::new(nodes, k0, law)?.with_rigid_arm()));
            }
            "space" => {
                let axes = [axis, map.vector(self.orientation)];
                let hinge = SpaceHinge::new(nodes, axes, k0, [k1, k2, k3], self.strengths)?
                    .with_hardening(self.hardening_ratio)?;
                return Ok(Box::new(hinge.with_rigid_arm()));
            }
            "rectangle" => AxialMomentSurface::rectangle(axial_strength, moment)?,
            "ellipse" => AxialMomentSurface::ellipse(axial_strength, moment)?,
            _ => {
                // The moment changes its sign in a mirror and from the other side.
                let moment = if map.is_mirrored == is_reversed { moment } else { -moment };
                AxialMomentSurface::polygon(&[
                    [axial_strength, 0.0],
                    [0.0, moment],
                    [-2.0 * axial_strength, 0.8 * moment],
                    [-axial_strength, -0.6 * moment],
                ])?
            }
        };
        let hinge = InteractionHinge::new(nodes, plane_axis, [k0, k1], k2, surface)?
            .with_hardening(self.hardening_ratio)?;
        Ok(Box::new(hinge.with_rigid_arm()))
    }
}

/// Displacements of two nodes after a map, in the order of the element's nodes.
fn mapped_displacements(values: &[f64], map: &SpaceMap, is_reversed: bool) -> Vec<f64> {
    let node_values = values.len() / 2;
    let mut nodes: Vec<Vec<f64>> = Vec::new();
    for node in values.chunks(node_values) {
        nodes.push(if node_values == 3 {
            let [x, y, _] = map.vector([node[0], node[1], 0.0]);
            vec![x, y, map.rotation([0.0, 0.0, node[2]])[2]]
        } else {
            let displacement = map.vector([node[0], node[1], node[2]]);
            let rotation = map.rotation([node[3], node[4], node[5]]);
            [displacement, rotation].concat()
        });
    }
    if is_reversed {
        nodes.reverse();
    }
    nodes.concat()
}

/// GOAL: forces, tangents and energies turn with the hinge.
#[test]
fn hinges_that_yield_turn_with_their_nodes() {
    let mut tally = IdentityTally::new("yielding hinges: turned, mirrored, from the other side");
    let mut random = Random(747);
    for number in 0..scenes(90, 3000) {
        let case = HingeCase::draw(&mut random);
        let is_in_space = case.kind == "space";
        let axis = if is_in_space {
            let axis: [f64; 3] = std::array::from_fn(|_| random.within(-1.0, 1.0));
            let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
            axis.map(|part| part / length)
        } else {
            [0.0, 0.0, 1.0]
        };
        let map =
            SpaceMap { axis, angle: random.within(-3.0, 3.0), is_mirrored: random.chance(0.5) };
        // An arm ends at the second node, so that the sides of such a hinge differ.
        let is_reversed = case.arm == [0.0; 3] && random.chance(0.5);
        let identity = SpaceMap { axis, angle: 0.0, is_mirrored: false };
        let order = if is_in_space { 12 } else { 6 };
        let mut path = vec![vec![0.0; order]];
        for _ in 0..PATH_STEPS {
            let last_displacement = &path[path.len() - 1];
            path.push(last_displacement.iter().map(|u| u + random.within(-4e-3, 4e-3)).collect());
        }
        let first = [2.0, -1.0, if is_in_space { 3.0 } else { 0.0 }];
        let second: [f64; 3] = std::array::from_fn(|k| first[k] + case.arm[k]);
        let mut image_points = vec![map.vector(first), map.vector(second)];
        if is_reversed {
            image_points.reverse();
        }
        let image_path: Vec<Vec<f64>> =
            path.iter().map(|values| mapped_displacements(values, &map, is_reversed)).collect();
        let mapped_list = |values: &[f64]| -> Vec<f64> {
            values
                .chunks(order)
                .flat_map(|step| mapped_displacements(step, &map, is_reversed))
                .collect()
        };
        tally.scene(&[case.kind, if is_reversed { "other side" } else { "one side" }]);
        let results: [Result<PathResults>; 2] = [
            case.hinge(&identity, false)
                .and_then(|hinge| follow(hinge.as_ref(), &[first, second], &path)),
            case.hinge(&map, is_reversed)
                .and_then(|hinge| follow(hinge.as_ref(), &image_points, &image_path)),
        ];
        let place = format!("{number}: {}, {map:?}, {is_reversed}", case.kind);
        tally.compare(&place, results, |tally, expected, computed| {
            for (name, expected, computed) in [
                ("forces", mapped_list(&expected.forces), computed.forces),
                ("tangent", mapped_list(&expected.tangent_forces), computed.tangent_forces),
                ("energies", expected.energies, computed.energies),
            ] {
                let difference = relative_difference(&expected, &computed);
                tally.within(&format!("{name}, {place}"), difference, ROUNDING_LIMIT);
            }
        });
    }
    tally.close(0.9);
}
