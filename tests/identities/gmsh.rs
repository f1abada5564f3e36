//! Meshes written as Gmsh files and read again.

use std::fmt::Write;

use basemat::Result;
use basemat::fem::{Material, Mesh};
use basemat::io::{GmshMesh, GmshPart, GmshSpaceMesh};
use basemat::structure::FemModel;

use super::blueprint::{Blueprint, POISSON_RATIO, Piece};
use super::view::PLAIN_VIEW;

/// Kind and nodes of a piece in a file; `None` for a piece that a mesh from Gmsh does not have.
fn cell(piece: &Piece) -> Option<(usize, &[usize])> {
    Some(match piece {
        Piece::SpaceBeam(ends, ..) => (1, ends),
        Piece::Shell(corners, _) if corners.len() == 3 => (2, corners),
        Piece::Shell(corners, _) => (3, corners),
        Piece::Quad(corners) => (3, corners),
        Piece::Brick(corners) => (5, corners),
        Piece::Quad8(nodes) => (16, nodes),
        _ => return None,
    })
}

/// Dimension of a kind of cells.
fn dimension(kind: usize) -> usize {
    match kind {
        1 => 1,
        5 => 3,
        _ => 2,
    }
}

/// The cells of a blueprint in format 2.2, each a physical group with the number of the piece.
fn text(plan: &Blueprint) -> String {
    let cells: Vec<_> = plan
        .pieces
        .iter()
        .enumerate()
        .filter_map(|(number, piece)| cell(piece).map(|(kind, nodes)| (number + 1, kind, nodes)))
        .collect();
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n");
    let _ = writeln!(text, "{}", cells.len());
    for (number, kind, _) in &cells {
        let _ = writeln!(text, "{} {number} \"{number}\"", dimension(*kind));
    }
    let _ = writeln!(text, "$EndPhysicalNames\n$Nodes\n{}", plan.points.len());
    for (number, [x, y, z]) in plan.points.iter().enumerate() {
        let other_coordinates = if plan.in_space { [y, z] } else { [z, y] };
        let _ = writeln!(
            text,
            "{} {x:?} {:?} {:?}",
            number + 1,
            other_coordinates[0],
            other_coordinates[1]
        );
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", cells.len());
    for (number, kind, nodes) in &cells {
        let _ = write!(text, "{number} {kind} 2 {number} {number}");
        for node in *nodes {
            let _ = write!(text, " {}", node + 1);
        }
        text.push('\n');
    }
    text + "$EndElements\n"
}

/// The model of a blueprint in SI units, with the mesh of its file.
pub(crate) fn model(plan: &Blueprint) -> Result<FemModel> {
    let mut mesh = mesh_from_file(plan)?;
    for piece in plan.pieces.iter().filter(|piece| cell(piece).is_none()) {
        plan.add_piece(&mut mesh, piece.clone(), &PLAIN_VIEW)?;
    }
    plan.completed(mesh, &PLAIN_VIEW)
}

/// The mesh of a blueprint in SI units as read from its file, without the pieces that a file does not have.
fn mesh_from_file(plan: &Blueprint) -> Result<Mesh> {
    let text = text(plan);
    let material = Material::new(plan.young, POISSON_RATIO, plan.density)?;
    let mut names = Vec::new();
    let mut parts = Vec::new();
    for (number, piece) in plan.pieces.iter().enumerate() {
        let part = match piece {
            Piece::SpaceBeam(_, side, plane) => {
                GmshPart::Beam(material, Blueprint::section(*side)?, *plane)
            }
            Piece::Shell(_, thickness) => GmshPart::Shell(material, *thickness),
            Piece::Quad(_) | Piece::Quad8(_) | Piece::Brick(_) => GmshPart::Solid(material),
            _ => continue,
        };
        names.push((number + 1).to_string());
        parts.push(part);
    }
    let names = names.iter().map(String::as_str);
    if plan.in_space {
        let parts: Vec<_> = names.zip(parts).collect();
        GmshSpaceMesh::from_reader("blueprint.msh", text.as_bytes())?.mesh(&parts)
    } else {
        let material = plan.quad_material(&PLAIN_VIEW)?;
        let materials: Vec<_> = names.map(|name| (name, material.clone())).collect();
        GmshMesh::from_reader("blueprint.msh", text.as_bytes())?.mesh(&materials)
    }
}
