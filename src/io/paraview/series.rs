//! A run as a series of grids.

use std::fmt::Write;
use std::path::Path;

use super::grid::Grid;
use crate::error::{Error, Result, write_file};
use crate::interface::Mode;
use crate::results::{ContactFrame, Histories, MotionFrame, Wireframe};

/// Writes `name.pvd`, and for every frame of motion that `histories` keep a grid of the structure
/// (`name_0000.vtu`, …) and for every frame of contact one of the base (`name_base_0000.vtu`, …),
/// into `folder`, which is made if need be. Returns the number of grids.
///
/// # Errors
/// [`Error::Scene`] if no motion was kept ([`crate::results::Recorder::motion`]) or the name is not
/// one of letters, digits, `-` and `_`; [`Error::Index`] if `shape` belongs to another structure;
/// [`Error::Write`] if a file cannot be written.
pub fn write_series(
    folder: impl AsRef<Path>,
    name: &str,
    shape: &Wireframe,
    histories: &Histories,
) -> Result<usize> {
    let folder = folder.as_ref();
    let plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || !name.chars().all(plain) {
        let needed = "letters, digits, - and _ only, one at least";
        return Err(Error::Scene { quantity: "name of a series", needed });
    }
    if histories.motion_frames().next().is_none() {
        let needed = "tell the recorder to keep the motion";
        return Err(Error::Scene { quantity: "series of the structure", needed });
    }
    let made = std::fs::create_dir_all(folder);
    made.map_err(|e| Error::Write { file: folder.display().to_string(), reason: e.kind() })?;

    let mut entries = Vec::new();
    for (k, frame) in histories.motion_frames().enumerate() {
        let file = format!("{name}_{k:04}.vtu");
        write_file(&folder.join(&file), &structure(shape, &frame)?)?;
        entries.push((frame.time, 0, file));
    }
    let cells: Vec<Vec<usize>> =
        (0..histories.elements().len()).map(|e| vec![2 * e, 2 * e + 1]).collect();
    for (k, frame) in histories.contact_frames().enumerate() {
        let file = format!("{name}_base_{k:04}.vtu");
        write_file(&folder.join(&file), base(histories, &cells, &frame))?;
        entries.push((frame.time, 1, file));
    }
    entries.sort_by(|a, b| a.0.total_cmp(&b.0));
    write_file(&folder.join(format!("{name}.pvd")), collection(&entries))?;
    Ok(entries.len())
}

fn structure(shape: &Wireframe, frame: &MotionFrame<'_>) -> Result<String> {
    let grid = Grid {
        points: shape.points().iter().map(|point| point.position).collect(),
        cells: shape.cells(),
        point_vectors: vec![
            ("displacement", shape.displacements(frame.displacement)?),
            ("velocity", shape.displacements(frame.velocity)?),
        ],
        cell_scalars: Vec::new(),
    };
    Ok(grid.xml())
}

fn base(histories: &Histories, cells: &[Vec<usize>], frame: &ContactFrame<'_>) -> String {
    let ends = histories.elements().iter().flat_map(|e| [[e.left, 0.0], [e.right, 0.0]]);
    let states = frame.states.iter();
    let number = |mode: &Mode| match mode {
        Mode::Stick => 0.0,
        Mode::SlipLeft => 1.0,
        Mode::SlipRight => 2.0,
        Mode::Open => 3.0,
        Mode::Yield => 4.0,
        Mode::YieldLeft => 5.0,
        Mode::YieldRight => 6.0,
    };
    let grid = Grid {
        points: ends.collect(),
        cells,
        point_vectors: Vec::new(),
        cell_scalars: vec![
            ("pressure", states.clone().map(|s| s.pressure).collect()),
            ("shear", states.clone().map(|s| s.shear).collect()),
            ("gap", states.clone().map(|s| s.gap).collect()),
            ("slip", states.map(|s| s.slip).collect()),
            ("mode", frame.modes.iter().map(number).collect()),
        ],
    };
    grid.xml()
}

fn collection(entries: &[(f64, usize, String)]) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (time, part, file) in entries {
        // Writing to a string does not fail.
        let _ = writeln!(
            out,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file}\"/>"
        );
    }
    out + "</Collection>\n</VTKFile>\n"
}
