//! GOAL: rows of a model's shells give the resultants at its nodes, also where nodes follow others.
//! SCENE: a strip 6 × 1 m, clamped at x = 0, with a rigid tip; 1 kN upwards and 5 kN along.
//! REFERENCE: statics of a beam.

use super::{ALL, Assembly, Pattern, X, Z, material};
use basemat::Error;
use basemat::fem::{LumpedMass, ShellResultants};
use basemat::structure::{FemModel, ShellRows, Structure};
use basemat_problems::dense::{solve_held, stiffness};
use basemat_problems::table::close;

#[test]
fn a_strip_is_a_beam() {
    let mut strip = Assembly::new();
    let concrete = (material(30.0e9, 0.0, 0.0), 0.2);
    let nodes = strip.grid([12, 2], Pattern::Clockwise, concrete, |x, y| [6.0 * x, y, 0.0]);
    let shells: Vec<usize> = (0..strip.shells.len()).collect();
    let tip = &nodes[12];
    let last = strip.mesh.add(LumpedMass::in_space(tip[1], 1.0, [0.0; 3]).unwrap()).unwrap();
    let model = FemModel::on_base(strip.mesh).unwrap();
    let model = model.with_rigid_link(tip[1], &[tip[0], tip[2]]).unwrap();
    let mut load = vec![0.0; model.dofs()];
    for (direction, force) in [(X, 5000.0), (Z, 1000.0)] {
        load[model.dof(tip[1], direction).unwrap()] = force;
    }
    let held =
        nodes[0].iter().flat_map(|&node| ALL.map(|own| (model.dof(node, own).unwrap(), 0.0)));
    let u = solve_held(&stiffness(&model), &load, &held.collect::<Vec<_>>());

    let east_up = model.shell_rows(&shells, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let away_down = model.shell_rows(&shells, |_| [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]).unwrap();
    let at = |rows: &[ShellRows], node: usize| {
        let own = rows.iter().find(|own| own.node == node).unwrap();
        own.value(&u)
    };
    let check = |own: ShellResultants, wanted: [f64; 8]| {
        let found = [&own.membrane[..], &own.moments, &own.shears].concat();
        for (found, wanted) in found.into_iter().zip(wanted) {
            close("resultant", found, wanted, 1e-5, 0.0);
        }
    };
    assert_eq!(east_up.len(), 39);
    for (column, lever) in [(3, 4.5), (6, 3.0), (9, 1.5)] {
        let moment = 1000.0 * lever;
        for &node in &nodes[column] {
            let own = at(&east_up, node);
            assert_eq!(own.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            check(own, [5000.0, 0.0, 0.0, moment, 0.0, 0.0, 1000.0, 0.0]);
            let [most, least] = own.principal_moments();
            close("principal moment", most, moment, 1e-5, 0.0);
            close("principal moment", least, 0.0, 1e-5, 0.0);
            check(at(&away_down, node), [0.0, 5000.0, 0.0, 0.0, -moment, 0.0, 0.0, -1000.0]);
        }
    }
    // Bending is constant over an element: at a follower the lever of the middle of the last one.
    check(at(&east_up, tip[0]), [5000.0, 0.0, 0.0, 250.0, 0.0, 0.0, 1000.0, 0.0]);
    let corners = model.shell_resultants(shells[22], &u).unwrap();
    assert_eq!(corners.len(), 4);
    for own in corners {
        let own = own.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
        check(own, [5000.0, 0.0, 0.0, 250.0, 0.0, 0.0, 1000.0, 0.0]);
    }
    let units = |own: &ShellRows| [own.membrane[2].unit, own.moments[0].unit, own.shears[1].unit];
    assert_eq!(units(&east_up[0]), ["N/m", "N·m/m", "N/m"]);

    let fault = |element: usize| model.shell_resultants(element, &u).unwrap_err();
    assert_eq!(fault(last).to_string(), format!("element {last}: it is not a shell"));
    assert!(matches!(fault(last + 1), Error::Index { .. }));
    assert!(matches!(model.shell_resultants(0, &u[1..]), Err(Error::Size { .. })));
    let steep = model.shell_rows(&shells, |_| [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]).unwrap_err();
    assert!(steep.to_string().starts_with("element 0: part of the direction"), "{steep}");
}
