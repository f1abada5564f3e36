//! GOAL: groups of a mesh from Gmsh take any material of solids, elastic or one that yields.
//! SCENE: two quadrilaterals of four nodes and two of eight, in three groups.
//! REFERENCE: the elements written one by one; errors that name element and need.

use std::any::Any;

use basemat::Error;
use basemat::fem::{
    DruckerPrager, Element, Iwan, Material, Mesh, Quad4, Quad8, QuadFormulation, SharedMaterial,
};
use basemat::structure::FemModel;

use super::gmsh::{concrete, read};

/// Two squares and two squares of eight nodes in a row, of the groups "clay", "wall", "clay" and "sand".
const ROW_OF_SQUARES: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 \"base\"
2 2 \"clay\"
2 3 \"wall\"
2 4 \"sand\"
$EndPhysicalNames
$Nodes
19
1 0 0 0
2 1 0 0
3 2 0 0
4 2 1 0
5 1 1 0
6 0 1 0
7 10 0 0
8 12 0 0
9 12 2 0
10 10 2 0
11 11 0 0
12 12 1 0
13 11 2 0
14 10 1 0
15 14 0 0
16 14 2 0
17 13 0 0
18 14 1 0
19 13 2 0
$EndNodes
$Elements
5
1 1 2 1 1 1 2
2 3 2 2 2 1 2 5 6
3 3 2 3 3 2 3 4 5
4 16 2 2 4 7 8 9 10 11 12 13 14
5 16 2 4 5 8 15 16 9 17 18 19 12
$EndElements
";

fn clay() -> Iwan {
    Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.45, 1800.0).unwrap()
}

fn sand() -> DruckerPrager {
    let elastic = Material::new(60.0e6, 0.3, 1900.0).unwrap();
    DruckerPrager::new(elastic, 5.0e3, 0.5, 0.5).unwrap()
}

/// An element of a mesh as its type.
fn element<E: Element>(mesh: &Mesh, index: usize) -> &E {
    let element: &dyn Any = mesh.elements().nth(index).unwrap();
    element.downcast_ref().unwrap()
}

/// GOAL: every group has its material, and formulations follow from it.
#[test]
fn groups_take_materials_that_yield() {
    let gmsh = read(ROW_OF_SQUARES).unwrap();
    let clay = SharedMaterial::from(clay());
    let sand = SharedMaterial::from(sand());
    let groups = [("clay", clay.clone()), ("sand", sand.clone()), ("wall", concrete().into())];
    let mesh = gmsh.mesh(&groups).unwrap();
    // Equality is that of nodes, formulation and law, which is the same one in memory.
    let soil = Quad4::new([0, 1, 4, 5], clay.clone(), QuadFormulation::MeanDilatation);
    assert_eq!(*element::<Quad4>(&mesh, 0), soil);
    let wall = Quad4::new([1, 2, 3, 4], concrete(), QuadFormulation::IncompatibleModes);
    assert_eq!(*element::<Quad4>(&mesh, 1), wall);
    assert_eq!(*element::<Quad8>(&mesh, 2), Quad8::new([6, 7, 8, 9, 10, 11, 12, 13], clay));
    assert_eq!(*element::<Quad8>(&mesh, 3), Quad8::new([7, 14, 15, 8, 16, 17, 18, 11], sand));
    let model = FemModel::new(mesh, &gmsh.line("base").unwrap()).unwrap();
    assert!(model.inelastic_elements().eq([0, 2, 3]));
}

/// GOAL: one law serves all elements of a group, which share it.
#[test]
fn elements_of_a_group_share_its_law() {
    let gmsh = read(&ROW_OF_SQUARES.replace(" 2 3 3 ", " 2 2 2 ").replace(" 2 4 5 ", " 2 2 5 "));
    let mesh = gmsh.unwrap().mesh(&[("clay", clay())]).unwrap();
    for [first, second] in [[0, 1], [2, 3]] {
        let elements: Vec<&dyn Element> = mesh.elements().collect();
        let moved_element = elements[first].with_nodes(elements[second].nodes()).unwrap();
        let moved_element: &dyn Any = moved_element.as_ref();
        let is_shared = if first == 0 {
            moved_element.downcast_ref() == Some(element::<Quad4>(&mesh, second))
        } else {
            moved_element.downcast_ref() == Some(element::<Quad8>(&mesh, second))
        };
        assert!(is_shared, "elements {first} and {second}");
    }
}

/// GOAL: a formulation that materials that yield do not have is an error with the line of the element.
#[test]
fn formulations_of_elastic_materials_are_errors_for_others() {
    let gmsh = read(ROW_OF_SQUARES).unwrap();
    let groups = [("clay", clay().into()), ("sand", sand().into()), ("wall", concrete().into())];
    let groups: [(&str, SharedMaterial); 3] = groups;
    let error = gmsh.mesh_of(&groups, QuadFormulation::IncompatibleModes).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, Error::File(_)), "{text}");
    assert!(text.contains("QuadFormulation::MeanDilatation"), "{text}");
    assert!(text.contains("test.msh, line 36"), "{text}");
    assert!(gmsh.mesh_of(&groups, QuadFormulation::MeanDilatation).is_ok());
}
