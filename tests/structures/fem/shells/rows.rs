//! GOAL: rows of a model's shells give the resultants at its nodes, also where nodes follow others.
//! SCENE: a strip 6 × 1 m, clamped at x = 0, with a rigid tip; 1 kN upwards and 5 kN along.
//! REFERENCE: statics of a beam.

use super::{ALL_DIRECTIONS, Assembly, CellPattern, X, Z, material};
use basemat::Error;
use basemat::fem::{LumpedMass, ShellResultants};
use basemat::structure::{FemModel, ShellRows, Structure};
use basemat_problems::dense::{solve_with_prescribed, stiffness};
use basemat_problems::table::assert_close;

fn resultants_at(rows: &[ShellRows], node: usize, u: &[f64]) -> ShellResultants {
    rows.iter().find(|rows| rows.node == node).unwrap().value(u)
}

fn assert_resultants(computed: &ShellResultants, expected: [f64; 8]) {
    let components = [&computed.membrane[..], &computed.moments, &computed.shears].concat();
    for (components, expected) in components.into_iter().zip(expected) {
        assert_close("resultant", components, expected, 1e-5, 0.0);
    }
}

#[test]
fn a_strip_is_a_beam() {
    let mut strip = Assembly::new();
    let concrete = (material(30.0e9, 0.0, 0.0), 0.2);
    let nodes = strip.grid([12, 2], CellPattern::Clockwise, concrete, |x, y| [6.0 * x, y, 0.0]);
    let shells: Vec<usize> = (0..strip.shells.len()).collect();
    let tip = &nodes[12];
    let last_element =
        strip.mesh.add(LumpedMass::in_space(tip[1], 1.0, [0.0; 3]).unwrap()).unwrap();
    let model = FemModel::on_base(strip.mesh).unwrap();
    let model = model.with_rigid_link(tip[1], &[tip[0], tip[2]]).unwrap();
    let mut load = vec![0.0; model.dofs()];
    for (direction, force) in [(X, 5000.0), (Z, 1000.0)] {
        load[model.dof(tip[1], direction).unwrap()] = force;
    }
    let mut fixed = Vec::new();
    for &node in &nodes[0] {
        fixed.extend(ALL_DIRECTIONS.map(|direction| (model.dof(node, direction).unwrap(), 0.0)));
    }
    let u = solve_with_prescribed(&stiffness(&model), &load, &fixed);

    let east_up = model.shell_rows(&shells, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let away_down = model.shell_rows(&shells, |_| [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]).unwrap();
    assert_eq!(east_up.len(), 39);
    for (column, lever) in [(3, 4.5), (6, 3.0), (9, 1.5)] {
        let moment = 1000.0 * lever;
        for &node in &nodes[column] {
            let resultants = resultants_at(&east_up, node, &u);
            assert_eq!(resultants.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            assert_resultants(&resultants, [5000.0, 0.0, 0.0, moment, 0.0, 0.0, 1000.0, 0.0]);
            let principal = resultants.principal_moments();
            assert_close("principal moment", principal[0], moment, 1e-5, 0.0);
            assert_close("principal moment", principal[1], 0.0, 1e-5, 0.0);
            let rotated_resultants = resultants_at(&away_down, node, &u);
            assert_resultants(
                &rotated_resultants,
                [0.0, 5000.0, 0.0, 0.0, -moment, 0.0, 0.0, -1000.0],
            );
        }
    }
    // Bending is constant over an element: at a follower the lever of the middle of the last one.
    let at_tip = [5000.0, 0.0, 0.0, 250.0, 0.0, 0.0, 1000.0, 0.0];
    assert_resultants(&resultants_at(&east_up, tip[0], &u), at_tip);
    let corners = model.shell_resultants(shells[22], &u).unwrap();
    assert_eq!(corners.len(), 4);
    for corner in corners {
        let resultants = corner.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
        assert_resultants(&resultants, at_tip);
    }
    let rows = &east_up[0];
    let units = [rows.membrane[2].unit, rows.moments[0].unit, rows.shears[1].unit];
    assert_eq!(units, ["N/m", "N·m/m", "N/m"]);

    let mass = model.shell_resultants(last_element, &u).unwrap_err();
    assert_eq!(mass.to_string(), format!("element {last_element}: it is not a shell"));
    let error_of_a_missing_node = model.shell_resultants(last_element + 1, &u).unwrap_err();
    assert!(matches!(error_of_a_missing_node, Error::Index { .. }));
    assert!(matches!(model.shell_resultants(0, &u[1..]), Err(Error::Size { .. })));
    let error_of_a_normal_axis =
        model.shell_rows(&shells, |_| [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]).unwrap_err();
    assert!(
        error_of_a_normal_axis.to_string().starts_with("element 0: part of the direction"),
        "{error_of_a_normal_axis}"
    );
}
