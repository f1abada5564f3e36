//! GOAL: files written by Gmsh 4.15 give the models they describe.
//! SCENE: a block 6 m wide of two materials, the lower 2 m and the upper 3 m high, unstructured and
//! recombined (`tests/data/gmsh/block.py`), on a named line; first and second order.
//! REFERENCE: areas, uniform strain, and the statics of the layered block; coordinates of a
//! wall whose base is partly in a second group.

use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::io::GmshMesh;
use basemat::structure::{FemModel, Structure, Triplets};

use basemat_problems::dense::{dot, product};

/// File and nodes per element.
const GMSH_FILES: [(&str, usize); 2] = [("block_linear", 4), ("block_second_order", 8)];

fn file(name: &str) -> GmshMesh {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gmsh");
    GmshMesh::read(format!("{folder}/{name}.msh")).unwrap()
}

fn lower() -> Material {
    Material::new(2.0e9, 0.25, 2500.0).unwrap()
}

fn upper() -> Material {
    Material::new(0.5e9, 0.3, 1800.0).unwrap()
}

fn model(gmsh: &GmshMesh) -> FemModel {
    let mesh = gmsh.mesh(&[("upper", upper()), ("lower", lower())]).unwrap();
    FemModel::new(mesh, &gmsh.line("base").unwrap()).unwrap()
}

fn stiffness(model: &FemModel) -> Triplets {
    let mut matrix = Triplets::new(model.dofs());
    model.stiffness(&mut matrix).unwrap();
    matrix
}

#[test]
fn elements_groups_and_lines_are_those_of_the_file() {
    for (name, nodes) in GMSH_FILES {
        let gmsh = file(name);
        assert_eq!(gmsh.surfaces(), ["lower", "upper"]);
        assert_eq!(gmsh.lines(), ["base", "roof"]);
        let model = model(&gmsh);
        let elements = model.mesh().elements();
        assert!(elements.clone().all(|element| element.nodes().len() == nodes));
        for (line, height) in [("base", 0.0), ("roof", 5.0)] {
            let line: Vec<[f64; 2]> =
                gmsh.line(line).unwrap().into_iter().map(|node| gmsh.nodes()[node]).collect();
            let first = line[0];
            let last_node = line[line.len() - 1];
            assert!((first[0] + 3.0).abs() < 1e-12 && (last_node[0] - 3.0).abs() < 1e-12);
            assert!(line.iter().all(|node| (node[1] - height).abs() < 1e-12));
            assert!(line.windows(2).all(|pair| pair[1][0] - pair[0][0] > 0.1));
            assert!(line.len() > 16, "{}", line.len());
        }
        // The line is the whole base: no other node is as low.
        assert_eq!(
            gmsh.line("base").unwrap(),
            model.mesh().nodes_at_height(0.0, 1e-9).unwrap(),
            "{name}"
        );
    }
}

/// Stress over strain without lateral strain, λ + 2μ.
fn constrained_modulus(young: f64, nu: f64) -> f64 {
    young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
}

/// The mass follows the areas, and uniform strain has the energy of both materials. Its forces are zero except at the
/// edge and at the interface of the materials, whatever the shape of the elements.
#[test]
fn masses_and_energies_of_uniform_strain_are_exact() {
    for (name, _) in GMSH_FILES {
        let model = model(&file(name));
        let translation = model.rigid_motion(Direction::X, [0.0; 3]);
        let mut mass = Triplets::new(model.dofs());
        model.mass(&mut mass).unwrap();
        let expected = 2500.0 * 12.0 + 1800.0 * 18.0;
        let computed = dot(&translation, &product(&mass, &translation));
        assert!((computed / expected - 1.0).abs() < 1e-9, "{name}: {computed}");
        // u_x = x: σ_xx ε_xx = λ + 2μ.
        let mut strain = vec![0.0; model.dofs()];
        for (node, [x, ..]) in model.mesh().nodes().iter().enumerate() {
            strain[model.dof(node, Direction::X).unwrap()] = *x;
        }
        let expected =
            constrained_modulus(2.0e9, 0.25) * 12.0 + constrained_modulus(0.5e9, 0.3) * 18.0;
        let force = product(&stiffness(&model), &strain);
        let computed = dot(&strain, &force);
        assert!((computed / expected - 1.0).abs() < 1e-9, "{name}: {computed}");
        for (node, &[x, y, _]) in model.mesh().nodes().iter().enumerate() {
            let inside = x.abs() < 2.99 && y > 0.01 && y < 4.99 && (y - 2.0).abs() > 0.01;
            if inside {
                for direction in [Direction::X, Direction::Y] {
                    let force = force[model.dof(node, direction).unwrap()];
                    assert!(
                        force.abs() < 1e-6 * constrained_modulus(2.0e9, 0.25),
                        "{name} {node}: {force}"
                    );
                }
            }
        }
    }
}

/// The vector with zeros at the fixed degrees of freedom.
fn without_fixed(mut vector: Vec<f64>, fixed: &[bool]) -> Vec<f64> {
    vector.iter_mut().zip(fixed).filter(|(_, fixed)| **fixed).for_each(|(x, _)| *x = 0.0);
    vector
}

/// The residual over the diagonal of the matrix.
fn jacobi_preconditioned(residual: &[f64], diagonal: &[f64]) -> Vec<f64> {
    residual.iter().zip(diagonal).map(|(r, k)| r / k).collect()
}

/// Work of a horizontal weight of 1 m/s² on a block with a fixed base: f·K⁻¹f by conjugate
/// gradients.
fn compliance(model: &FemModel) -> f64 {
    let n = model.dofs();
    let mut fixed = vec![false; n];
    for node in model.base().nodes() {
        node.horizontal
            .iter()
            .chain(&node.vertical)
            .for_each(|&(unknown, _)| fixed[unknown] = true);
    }
    let mut mass = Triplets::new(n);
    model.mass(&mut mass).unwrap();
    let matrix = stiffness(model);
    let mut diagonal = vec![0.0; n];
    matrix
        .entries()
        .iter()
        .filter(|(i, j, _)| i == j)
        .for_each(|&(i, _, k)| diagonal[i] += k);
    let weight = product(&mass, &model.rigid_motion(Direction::X, [0.0; 3]));
    let load = without_fixed(weight, &fixed);
    let mut u = vec![0.0; n];
    let mut r = load.clone();
    let mut z = jacobi_preconditioned(&r, &diagonal);
    let mut p = z.clone();
    for _ in 0..20 * n {
        let image = without_fixed(product(&matrix, &p), &fixed);
        let before = dot(&r, &z);
        let step = before / dot(&p, &image);
        u.iter_mut().zip(&p).for_each(|(u, p)| *u += step * p);
        r.iter_mut().zip(&image).for_each(|(r, a)| *r -= step * a);
        if dot(&r, &r) < 1e-20 * dot(&load, &load) {
            return dot(&load, &u);
        }
        z = jacobi_preconditioned(&r, &diagonal);
        let ratio = dot(&r, &z) / before;
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + ratio * *p);
    }
    panic!("no convergence");
}

#[test]
fn a_static_solution_is_that_of_the_layered_block() {
    let layers = [Layer::new(2.0, 16, lower()), Layer::new(3.0, 24, upper())];
    let block = Mesh::layered_block(-3.0..3.0, 48, &layers).unwrap();
    let fine = compliance(&FemModel::on_base(block).unwrap());
    for ((name, _), tolerance) in GMSH_FILES.into_iter().zip([5e-3, 2e-3]) {
        let computed = compliance(&model(&file(name)));
        println!(
            "{name}: {computed:.6e}, fine block {fine:.6e}, error {:.1e}",
            computed / fine - 1.0
        );
        assert!((computed / fine - 1.0).abs() < tolerance, "{name}: {computed} {fine}");
    }
}

/// Coordinates x of the nodes of a named line.
fn line_coordinates(gmsh: &GmshMesh, name: &str) -> Vec<f64> {
    gmsh.line(name).unwrap().into_iter().map(|node| gmsh.nodes()[node][0]).collect()
}

/// The left third of the base is in a second group, too, which Gmsh writes before the group of the base.
#[test]
fn a_curve_belongs_to_all_of_its_groups() {
    let path = basemat_problems::data_path("gmsh/base_line_in_two_groups.msh");
    let gmsh = GmshMesh::read(&path).unwrap();
    assert_eq!(gmsh.lines(), ["base", "left half"]);
    for (name, count) in [("base", 7), ("left half", 3)] {
        let computed = line_coordinates(&gmsh, name);
        assert_eq!(computed.len(), count, "{name}");
        for (k, x) in computed.into_iter().enumerate() {
            assert!((x - k as f64).abs() < 1e-9, "{name}: {x}");
        }
    }
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    assert!(gmsh.mesh(&[("wall", concrete)]).is_ok());

    // The second surface is in a second group too: one of its groups may have a material, not both.
    let text = std::fs::read_to_string(&path).unwrap();
    let text =
        text.replacen("2 2 0 0 6 3 0 1 12 4 2 3 4 -7", "2 2 0 0 6 3 0 2 12 13 4 2 3 4 -7", 1);
    let gmsh = GmshMesh::from_reader("two", text.as_bytes()).unwrap();
    assert_eq!(gmsh.surfaces(), ["13", "wall"]);
    assert!(gmsh.mesh(&[("wall", concrete)]).is_ok());
    let error = gmsh.mesh(&[("wall", concrete), ("13", concrete)]).unwrap_err().to_string();
    let reason = error.split_once(": ").unwrap().1;
    assert!(
        error.starts_with("two, line ") && reason.contains("surfaces 'wall' and '13'"),
        "{error}"
    );
    let error = gmsh.mesh(&[("13", concrete)]).unwrap_err().to_string();
    assert!(error.contains("material for its surface 'wall'"), "{error}");
}
