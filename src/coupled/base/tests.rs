//! A base in the plane: means over elements, walls, and errors.

use super::*;
use crate::soil::WaterTable;
use crate::structure::BaseNode;

fn base(nodes: Vec<BaseNode>, elements: &[ContactElement], dofs: usize) -> Result<PlacedBase> {
    let base = Base::from(nodes);
    base.check(dofs)?;
    PlacedBase::on_lines(base.parts(), &Patch::new(elements.to_vec())?)
}

#[test]
fn matching_meshes_give_halves() {
    let nodes: Vec<_> = (0..4).map(|k| BaseNode::free(k as f64, 2 * k, 2 * k + 1)).collect();
    let elements: Vec<_> =
        (0..3).map(|k| ContactElement::new(f64::from(k), f64::from(k + 1))).collect();
    let base = base(nodes, &elements, 8).unwrap();
    let Rows::Sparse(rows) = base.rows else {
        panic!("rows of degrees of freedom")
    };
    assert_eq!(rows[1], vec![(3, -0.5), (5, -0.5)]);
    assert_eq!(rows[3 + 2], vec![(4, 0.5), (6, 0.5)]);
}

#[test]
fn means_of_a_linear_field_are_exact_on_any_mesh() {
    let xs = [-1.0, -0.3, 0.45, 2.0];
    let nodes: Vec<_> =
        xs.iter().enumerate().map(|(k, &x)| BaseNode::free(x, 2 * k, 2 * k + 1)).collect();
    let ends = [-1.0, -0.8, 0.1, 1.3, 2.0];
    let elements: Vec<_> = ends.windows(2).map(|w| ContactElement::new(w[0], w[1])).collect();
    let base = base(nodes, &elements, 8).unwrap();
    let u: Vec<f64> = xs.iter().flat_map(|x| [2.0 + 3.0 * x, 1.0 - 0.5 * x]).collect();
    let mut means = vec![0.0; 8];
    base.means(&u, &mut means);
    for (e, element) in elements.iter().enumerate() {
        let x = element.center()[0];
        assert!((means[e] + (1.0 - 0.5 * x)).abs() < 1e-14);
        assert!((means[4 + e] - (2.0 + 3.0 * x)).abs() < 1e-14);
    }
    assert!((base.rotations(0, &u).next().unwrap() + 0.5).abs() < 1e-14);
    // The middle of the base lies at x = 0.5.
    assert!((base.settlement(0, &u) + (1.0 - 0.5 * 0.5)).abs() < 1e-14);
    // The transpose does the same work: (BᵀAτ)·u = Σ A τ·(B u).
    let traction: Vec<f64> = (0..8).map(|i| f64::from(i).cos()).collect();
    let mut force = vec![0.0; 8];
    base.add_forces(1.0, &traction, &mut force);
    let force_work: f64 = force.iter().zip(&u).map(|(f, u)| f * u).sum();
    let traction_work: f64 = (0..8).map(|i| base.area(i) * traction[i] * means[i]).sum();
    assert!((force_work - traction_work).abs() < 1e-13);
}

/// Rigid motions by hand of a block 4 m wide and 3 m deep.
///
/// Components are along the normals into the soil and along the outline.
#[test]
fn walls_move_along_their_normals_and_tangents() {
    let node = |x: f64, z: f64| BaseNode {
        x,
        z,
        horizontal: [(0, 1.0), (2, -z)].into(),
        vertical: [(1, 1.0), (2, x)].into(),
        ..BaseNode::default()
    };
    let outline = [[-2.0, 0.0], [-2.0, -1.0], [-2.0, -3.0], [0.0, -3.0], [2.0, -3.0], [2.0, 0.0]];
    let elements = outline.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1]));
    let elements: Vec<_> = elements.collect();
    let corners = [(-2.0, 0.0), (-2.0, -3.0), (2.0, -3.0), (2.0, 0.0)];
    let base = base(corners.map(|(x, z)| node(x, z)).to_vec(), &elements, 3).unwrap();
    let mut means = [0.0; 10];
    base.means(&[0.3, 0.2, 0.1], &mut means);
    for (e, ends) in outline.windows(2).enumerate() {
        let x = 0.5 * (ends[0][0] + ends[1][0]);
        let z = 0.5 * (ends[0][1] + ends[1][1]);
        let right = 0.3 - 0.1 * z;
        let up = 0.2 + 0.1 * x;
        let expected = match e {
            0 | 1 => [-right, -up],
            4 => [right, up],
            _ => [-up, right],
        };
        for (component, expected) in expected.into_iter().enumerate() {
            assert!((means[5 * component + e] - expected).abs() < 1e-15, "{e} {means:?}");
        }
    }
    // Forces: pressures p on the walls push to the left and to the right, on the base up.
    let mut force = [0.0; 3];
    base.add_forces(1.0, &[1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], &mut force);
    assert!(force.iter().all(|component| component.abs() < 1e-14), "{force:?}");
    base.add_forces(1.0, &[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], &mut force);
    assert!((force[1] + 4.0).abs() < 1e-14 && force[0].abs() < 1e-14, "{force:?}");
}

#[test]
fn bad_bases_are_errors() {
    let element = [ContactElement::new(0.0, 1.0)];
    let node = |x| BaseNode::free(x, 0, 1);
    assert!(base(vec![node(0.0)], &element, 2).is_err());
    assert!(base(vec![node(0.0), node(0.0)], &element, 2).is_err());
    assert!(base(vec![node(0.0), node(f64::NAN)], &element, 2).is_err());
    assert!(base(vec![node(0.0), node(0.9)], &element, 2).is_err());
    assert!(base(vec![node(0.0), node(1.0)], &element, 1).is_err());
    assert!(base(vec![node(0.0), node(1.0)], &element, 2).is_ok());
}

/// Water on walls and floor of a box: ρ h²/2 and, about the bottom, ρ h³/6 on each wall, ρ h on the floor.
///
/// The water table lies inside an element, and between two nodes.
#[test]
fn water_presses_as_a_triangle_on_walls() {
    let width = 8.0;
    let depth = 5.0;
    let water_depth = 1.37;
    let wall_heights = [0.0, -0.9, -2.2, -3.1, -depth];
    let mut places: Vec<[f64; 2]> = wall_heights.iter().map(|z| [-0.5 * width, *z]).collect();
    places.extend([-1.0, 2.5].map(|x| [x, -depth]));
    places.extend(wall_heights.iter().rev().map(|z| [0.5 * width, *z]));
    let node =
        |(k, &[x, z]): (usize, &[f64; 2])| BaseNode { z, ..BaseNode::free(x, 2 * k, 2 * k + 1) };
    let nodes: Vec<BaseNode> = places.iter().enumerate().map(node).collect();
    let outline = [
        [-4.0, 0.0],
        [-4.0, -2.0],
        [-4.0, -2.7],
        [-4.0, -5.0],
        [-1.5, -5.0],
        [4.0, -5.0],
        [4.0, -2.7],
        [4.0, -2.0],
        [4.0, 0.0],
    ];
    let elements: Vec<_> =
        outline.windows(2).map(|ends| ContactElement::wall(ends[0], ends[1])).collect();
    let dofs = 2 * places.len();
    let base = base(nodes, &elements, dofs).unwrap();
    let water = WaterTable::at_depth(water_depth).unwrap().with_density(1030.0).unwrap();
    let masses = base.water_masses(&water, dofs).unwrap();
    let head = depth - water_depth;
    for (side, sign) in [(-0.5 * width, 1.0), (0.5 * width, -1.0)] {
        let mut thrust = 0.0;
        let mut moment = 0.0;
        for (k, place) in places.iter().enumerate().filter(|(_, place)| place[0] == side) {
            thrust += sign * masses[2 * k];
            moment += sign * masses[2 * k] * (place[1] + depth);
        }
        assert!((thrust / (1030.0 * head.powi(2) / 2.0) - 1.0).abs() < 1e-13, "{thrust}");
        assert!((moment / (1030.0 * head.powi(3) / 6.0) - 1.0).abs() < 1e-13, "{moment}");
    }
    let uplift: f64 = masses.iter().skip(1).step_by(2).sum();
    assert!((uplift / (1030.0 * head * width) - 1.0).abs() < 1e-13, "{uplift}");
    let dry = WaterTable::at_depth(depth).unwrap();
    assert_eq!(base.water_masses(&dry, dofs).unwrap(), []);
}
