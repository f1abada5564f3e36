//! GOAL: the matrices of single elements are right in every entry.
//! SCENE: three quadrilaterals and three triangles of `tests/data/shells`.
//! REFERENCE: an implementation in Python, 17 digits.

use super::{TabledShell, tabled_shells};
use basemat::fem::{Element, MassKind};
use basemat_problems::dense::largest;
use basemat_problems::table::table;

#[test]
fn matrices_are_the_tabled_ones() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        let table = table(&format!("shells/{name}.csv"));
        let order = shell.order();
        for matrix in ["stiffness", "mass", "lumped_mass"] {
            let expected = table.symmetric(matrix, order);
            let mut computed = vec![0.0; order * order];
            match matrix {
                "stiffness" => shell.stiffness(&nodes, &mut computed),
                "mass" => shell.mass(&nodes, MassKind::Consistent, &mut computed),
                _ => shell.mass(&nodes, MassKind::Lumped, &mut computed),
            }
            let error: Vec<f64> = computed.iter().zip(&expected).map(|(a, b)| a - b).collect();
            let error = largest(&error) / largest(&expected);
            assert!(error < 1e-13, "{matrix} of {name}: {error:.1e}");
        }
    }
}
