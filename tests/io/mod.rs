//! Files of other programs: Gmsh, Matrix Market, ParaView.

mod gmsh;
mod gmsh_files;
mod gmsh_formats;
mod gmsh_groups;
mod gmsh_materials;
mod gmsh_space;
mod matrix_market;
mod vtk;
mod vtk_models;
