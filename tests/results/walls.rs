//! GOAL: results of a structure with walls have the place of each element.

use basemat::Soil;
use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::interface::Bonded;
use basemat::plot;
use basemat::results::{DeformedShape, Recorder};
use basemat::structure::{DofCombination, RigidBlock, WithWalls};
use basemat::{Result, Simulation};

fn block() -> Result<WithWalls> {
    WithWalls::new(RigidBlock::new(6.0, 8.0, 900.0)?, 4.0)
}

fn positions(shape: &DeformedShape) -> Vec<[f64; 2]> {
    shape.points().iter().map(|point| point.position).collect()
}

#[test]
fn elements_of_walls_have_heights_and_pictures_show_the_trench() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let elements = Trench::new(-3.0..3.0, 4.0).unwrap().elements(2, 1).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(block().unwrap())
        .ground(TrenchGround::new(soil, elements).unwrap())
        .interface(Bonded)
        .initial_velocity([0.1, 0.0, 0.0])
        .expected_steps(4)
        .build()
        .unwrap();
    let mut series = Recorder::new().contact(1).motion(1).start(&simulation).unwrap();
    let run = simulation.run(4, |state| series.record(state).unwrap()).unwrap();

    let text = series.contact_csv().to_string();
    let lines: Vec<_> = text.lines().collect();
    assert!(lines[0].starts_with("time_s,element,left_m,right_m,bottom_m,top_m,mode,gap_m"));
    for (line, place) in
        lines[1..]
            .iter()
            .zip(["-3.0,-3.0,-4.0,0.0", "-3.0,0.0,-4.0,-4.0", "0.0,3.0,-4.0,-4.0"])
    {
        assert!(line.contains(place), "{line}");
    }
    let envelope = run.envelope_csv().to_string();
    assert!(envelope.starts_with("element,left_m,right_m,bottom_m,top_m,static_pressure_pa"));
    assert!(envelope.lines().nth(4).unwrap().starts_with("3,3.0,3.0,-4.0,0.0,"));
    let page = run.to_string();
    assert!(page.contains("Pressure on base and walls") && page.contains("z, m"), "{page}");

    // The middle of the base does not move in a rotation about it; the shape lies where the block does.
    let rows = DofCombination::of_base(&block().unwrap(), [0.0, 0.0, 0.0]).unwrap();
    let displacement = [0.3, 0.2, 0.1];
    assert_eq!([rows[0].value(&displacement), rows[2].value(&displacement)], [0.3, 0.2]);
    let shape = DeformedShape::of_block(&block().unwrap(), 8.0).unwrap();
    let corners = [[-3.0, -4.0], [3.0, -4.0], [3.0, 4.0], [-3.0, 4.0]];
    assert_eq!(positions(&shape), corners);
    let block_without_walls = RigidBlock::new(6.0, 8.0, 900.0).unwrap();
    let lowered = DeformedShape::of_block(&block_without_walls, 8.0).unwrap().lowered(4.0).unwrap();
    assert_eq!(positions(&lowered), corners);
    assert!(lowered.lowered(f64::NAN).is_err());

    let svg = plot::animation("Block", &shape, &series, 20.0, 1.0).unwrap();
    super::layout::assert_readable(svg.as_str(), "animation with walls");
    // Marks of four elements, and the surface with the trench.
    assert_eq!(svg.as_str().matches("stroke-width=\"0.6\"").count(), 4);
    let surface = svg.as_str().split("fill=\"#fff\" d=\"").nth(1).unwrap();
    assert_eq!(surface.split('"').next().unwrap().matches('L').count(), 4);
    plot::deformed_shapes("Block", &shape, &series, &[0.04], 20.0).unwrap();
}
