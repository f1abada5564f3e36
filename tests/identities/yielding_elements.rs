//! GOAL: an element that yields has the same response at any angle, mirrored, and with its nodes in another order.
//! SCENE: single quadrilaterals of clay and sand, of random shape, along random paths with internal variables.
//! REFERENCE: the element as it stands.

use basemat::Result;
use basemat::fem::{
    DruckerPrager, Element, InelasticForce, Iwan, Material, Quad4, Quad8, Quad8Integration,
    QuadFormulation, SharedMaterial,
};
use basemat_problems::random::Random;

use super::compare::relative_difference;
use super::tally::{IdentityTally, scenes};

/// Largest relative difference, by rounding along a path.
pub(super) const ROUNDING_LIMIT: f64 = 1e-11;
/// Steps of a path.
pub(super) const PATH_STEPS: usize = 12;

/// Orthogonal map of the plane: a turn, after a mirror or not.
#[derive(Debug, Clone, Copy)]
struct PlaneMap {
    angle: f64,
    is_mirrored: bool,
}

impl PlaneMap {
    fn apply(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let x = if self.is_mirrored { -x } else { x };
        let sin = self.angle.sin();
        let cos = self.angle.cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// Two values for each node.
    fn apply_to_all(self, values: &[f64]) -> Vec<f64> {
        values.chunks(2).flat_map(|pair| self.apply([pair[0], pair[1]])).collect()
    }
}

fn material(random: &mut Random) -> SharedMaterial {
    if random.chance(0.5) {
        return Iwan::hyperbolic(20.0e6, 40.0e3, 0.2, random.within(0.1, 0.49), 1800.0)
            .unwrap()
            .into();
    }
    let elastic = Material::new(60.0e6, random.within(0.1, 0.45), 1900.0).unwrap();
    let dilation_angle = random.pick(&[0.0, 0.3, 0.55]);
    DruckerPrager::new(elastic, 20.0e3, 0.55, dilation_angle).unwrap().into()
}

/// A quadrilateral on the nodes in this order, with four or eight nodes.
fn quad(nodes: &[usize], material: &SharedMaterial, kind: &str) -> Box<dyn Element> {
    let material = material.clone();
    if let Ok(nodes) = <[usize; 4]>::try_from(nodes) {
        return Box::new(Quad4::new(nodes, material, QuadFormulation::MeanDilatation));
    }
    let integration =
        if kind == "full" { Quad8Integration::Full } else { Quad8Integration::Reduced };
    let nodes = nodes.try_into().unwrap();
    Box::new(Quad8::new(nodes, material).with_integration(integration))
}

/// Corners of a distorted square of 2 m counter-clockwise, then points near the middle of its sides.
fn points(random: &mut Random, node_count: usize) -> Vec<[f64; 2]> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut points: Vec<[f64; 2]> =
        corners.iter().map(|corner| corner.map(|x| x + random.within(-0.3, 0.3))).collect();
    for side in 0..node_count - 4 {
        let ends = [points[side], points[(side + 1) % 4]];
        let shift = random.within(-0.05, 0.05);
        points.push([0, 1].map(|axis| 0.5 * (ends[0][axis] + ends[1][axis]) + shift));
    }
    points
}

/// Forces, tangent times the next displacement, energies and remainder along a path of displacements.
pub(super) struct PathResults {
    pub(super) forces: Vec<f64>,
    pub(super) tangent_forces: Vec<f64>,
    /// Stored and dissipated energy, remainder.
    pub(super) energies: Vec<f64>,
}

/// Follows a path of displacements from the undeformed element.
pub(super) fn follow(
    element: &dyn Element,
    coordinates: &[[f64; 3]],
    path: &[Vec<f64>],
) -> Result<PathResults> {
    let law: &dyn InelasticForce = element.inelastic().expect("the element yields");
    let mut variables = vec![0.0; law.variable_count()];
    law.initialize(coordinates, &mut variables)?;
    let order = element.order();
    let mut results =
        PathResults { forces: Vec::new(), tangent_forces: Vec::new(), energies: Vec::new() };
    for ends in path.windows(2) {
        let start = &ends[0];
        let end = &ends[1];
        let midstep: Vec<f64> = start.iter().zip(end).map(|(a, b)| 0.5 * (a + b)).collect();
        let mut force = vec![0.0; order];
        law.force(coordinates, end, &variables, &mut force)?;
        let mut tangent = vec![0.0; order * order];
        law.tangent(coordinates, end, &variables, &mut tangent)?;
        for row in tangent.chunks(order) {
            results.tangent_forces.push(row.iter().zip(end).map(|(k, u)| k * u).sum());
        }
        let energy = law.energy(coordinates, end, &variables)?;
        let remainder = law.remainder(coordinates, [start, &midstep, end], &variables)?;
        results.energies.extend([energy.stored, energy.dissipated, remainder]);
        results.forces.extend(force);
        law.commit(coordinates, end, &mut variables);
    }
    Ok(results)
}

/// Compares results of an element with those of its image, whose nodes stand in the order `order`.
fn compare(
    tally: &mut IdentityTally,
    place: &str,
    results: [Result<PathResults>; 2],
    map: PlaneMap,
    order: &[usize],
) {
    // Values of the image in the order of its nodes.
    let image = |values: &[f64]| -> Vec<f64> {
        let mut list = Vec::new();
        for step in values.chunks(2 * order.len()) {
            let mapped_step = map.apply_to_all(step);
            list.extend(
                order.iter().flat_map(|&node| [mapped_step[2 * node], mapped_step[2 * node + 1]]),
            );
        }
        list
    };
    tally.compare(place, results, |tally, expected, computed| {
        for (name, expected, computed) in [
            ("forces", image(&expected.forces), computed.forces),
            ("tangent", image(&expected.tangent_forces), computed.tangent_forces),
            ("energies", expected.energies, computed.energies),
        ] {
            let difference = relative_difference(&expected, &computed);
            tally.within(&format!("{name}, {place}"), difference, ROUNDING_LIMIT);
        }
    });
}

/// GOAL: forces, tangents and energies turn with the element.
#[test]
fn elements_that_yield_turn_with_their_nodes() {
    let mut tally = IdentityTally::new("yielding elements: turned, mirrored, from another corner");
    let mut random = Random(741);
    for number in 0..scenes(60, 2000) {
        let kind = random.pick(&["four nodes", "reduced", "full"]);
        let node_count = if kind == "four nodes" { 4 } else { 8 };
        let material = material(&mut random);
        let map = PlaneMap { angle: random.within(-3.0, 3.0), is_mirrored: random.chance(0.5) };
        let points = points(&mut random, node_count);
        let mut path = vec![vec![0.0; 2 * node_count]];
        for _ in 0..PATH_STEPS {
            let last_displacement = &path[path.len() - 1];
            path.push(last_displacement.iter().map(|u| u + random.within(-2e-3, 2e-3)).collect());
        }
        // The nodes begin at another corner; in a mirror, which reverses the order, they are clockwise.
        let first_corner = random.pick(&[0, 1, 2, 3]);
        let corner =
            |k: usize| if map.is_mirrored { first_corner + 4 - k } else { first_corner + k };
        let side = |k: usize| if map.is_mirrored { first_corner + 3 - k } else { first_corner + k };
        let mut order: Vec<usize> = (0..4).map(|k| corner(k) % 4).collect();
        order.extend((0..node_count - 4).map(|k| 4 + side(k) % 4));
        let image_points: Vec<[f64; 2]> =
            order.iter().map(|&node| map.apply(points[node])).collect();
        let image_path: Vec<Vec<f64>> = path
            .iter()
            .map(|displacement| {
                let mapped_displacement = map.apply_to_all(displacement);
                order
                    .iter()
                    .flat_map(|&node| {
                        [mapped_displacement[2 * node], mapped_displacement[2 * node + 1]]
                    })
                    .collect()
            })
            .collect();
        tally.scene(&[kind, if map.is_mirrored { "mirrored" } else { "turned" }]);
        let nodes: Vec<usize> = (0..node_count).collect();
        let element = quad(&nodes, &material, kind);
        let results = [(&points, &path), (&image_points, &image_path)].map(|(points, path)| {
            let coordinates: Vec<[f64; 3]> = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
            follow(element.as_ref(), &coordinates, path)
        });
        compare(&mut tally, &format!("{number}: {kind}, {map:?}"), results, map, &order);
    }
    tally.close(0.9);
}
