//! Pictures of results in space, and files for ParaView.

use basemat::coupled::State;
use basemat::interface::ContactState;
use basemat::io::paraview;
use basemat::results::{Quantity, Recorder};
use basemat::{Error, plot};

use super::results::{RockingBody, rocking_simulation, strip_simulation};

fn occurrences(svg: &plot::Svg, text: &str) -> usize {
    svg.as_str().matches(text).count()
}

/// One rectangle for each open element, and one line for each arrow, in addition to the lines of the key.
#[test]
fn pictures_show_open_and_sliding_cells() {
    let RockingBody { time_series, run, states } = RockingBody::new();
    let time = run.whole.uplifted_area.highest.time;
    let frames = states.iter().step_by(10);
    let shown_frames = frames
        .min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()))
        .unwrap();
    let open_count = shown_frames.modes.iter().filter(|mode| !mode.is_closed()).count();
    let slip_count = shown_frames.modes.iter().filter(|mode| mode.is_slip()).count();
    assert!(open_count > 2 && slip_count > 2, "{open_count} {slip_count}");
    let picture = plot::contact_plan("Contact", &time_series, time).unwrap();
    let at_rest = plot::contact_plan("Contact", &time_series, 0.0).unwrap();
    assert_eq!(occurrences(&picture, "fill=\"#164878\""), open_count + 1);
    assert_eq!(occurrences(&at_rest, "fill=\"#164878\""), 0);
    // Axes are lines too: the axes of both pictures, and the sample of the key.
    let line_count = occurrences(&picture, "<polyline");
    let axis_line_count = occurrences(&at_rest, "<polyline");
    assert!(line_count > slip_count && line_count <= slip_count + 2 + axis_line_count);
    let envelope = plot::pressure_envelope("Pressure", &run).unwrap();
    assert_eq!(occurrences(&envelope, "stroke=\"#FFFFFF\""), time_series.elements().len());
    let torque = plot::time_series("T", &[("body", &time_series)], Quantity::Torque).unwrap();
    assert!(torque.as_str().contains("torque, kN·m"));
    let energy = plot::energy("E", &time_series).unwrap();
    assert!(energy.as_str().contains("energy, kJ") && !energy.as_str().contains("kJ/m"));
    for error in [
        plot::mode_map("Modes", &time_series).err(),
        plot::contact_plan("T", &time_series, f64::NAN).err(),
    ] {
        assert!(matches!(error, Some(Error::Scene { .. } | Error::Input { .. })), "{error:?}");
    }
}

#[test]
fn pictures_do_not_mix_dimensions() {
    let body = RockingBody::new().time_series;
    let mut simulation = strip_simulation(false);
    let mut strip = Recorder::new().contact(1).start(&simulation).unwrap();
    simulation.run(3, |state| strip.record(state)).unwrap();
    assert!(matches!(plot::contact_plan("T", &strip, 0.0), Err(Error::Scene { .. })));
    let bodies = [("body", &body), ("strip", &strip)];
    assert!(matches!(
        plot::time_series("T", &bodies, Quantity::BaseShear),
        Err(Error::Scene { .. })
    ));
    assert!(plot::time_series("T", &bodies, Quantity::MeanSlip).is_ok());
    // Series of results in space are empty in the plane.
    assert!(strip.series(Quantity::Torque).is_empty() && !strip.in_plan());
}

/// Numbers of an array in a VTK file.
fn vtk_array(text: &str, name: &str) -> Vec<f64> {
    let rest = text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
    let numbers = rest.split_once(">\n").unwrap().1.split("</DataArray>").next().unwrap();
    numbers.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
}

/// A number of each element's contact.
fn contact_values(state: &State, value: fn(&ContactState) -> f64) -> Vec<f64> {
    state.contact.iter().map(value).collect()
}

#[test]
fn paraview_files_have_the_base_as_rectangles() {
    let RockingBody { time_series, states, .. } = RockingBody::new();
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("base_in_plan");
    assert_eq!(paraview::write_base(&folder, "mat", &time_series), Ok(41));
    let text = std::fs::read_to_string(folder.join("mat_base_0030.vtu")).unwrap();
    let count = time_series.elements().len();
    assert!(text.contains(&format!("NumberOfPoints=\"{}\" NumberOfCells=\"{count}\"", 4 * count)));
    let state = &states[300];
    let shear_across = contact_values(state, |contact| contact.shear_across);
    assert_eq!(vtk_array(&text, "shear_across"), shear_across);
    let slip_across = contact_values(state, |contact| contact.slip_across);
    assert_eq!(vtk_array(&text, "slip_across"), slip_across);
    let pressure = contact_values(state, |contact| contact.pressure);
    assert_eq!(vtk_array(&text, "pressure"), pressure);
    let element = &time_series.elements()[5];
    let left = element.left();
    let right = element.right();
    let [front, back] = element.depth();
    let corners = [left, front, 0.0, right, front, 0.0, right, back, 0.0, left, back, 0.0];
    assert_eq!(vtk_array(&text, "points")[60..72], corners);
    assert!(vtk_array(&text, "types").iter().all(|kind| *kind == 9.0));
    let without_contact = Recorder::new().start(&rocking_simulation()).unwrap();
    let result = paraview::write_base(&folder, "mat", &without_contact);
    assert!(matches!(result, Err(Error::Scene { .. })));
}
