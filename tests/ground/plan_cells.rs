//! GOAL: cells cover the faces of a mat; faces that cannot be covered give errors.
//! SCENE: rectangles, an L, a triangle, discs, masks, several mats; faces and numbers that make no mat.
//! REFERENCE: areas, centres and counts by hand.

use std::ops::ControlFlow;

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, PlanImpedance, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, GroundError, PlanError};
use basemat::soil::SoilProfile;
use basemat::{Error, Observer, Result, Soil, unobserved};

fn rectangle(x: [f64; 2], y: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

fn fault(faces: &[Vec<[f64; 2]>], cells: usize) -> PlanError {
    match Plan::on_faces(faces, cells) {
        Err(Error::Plan(fault)) => fault,
        other => panic!("{other:?}"),
    }
}

/// Name of the face that is no convex polygon.
fn face_without_polygon(faces: &[Vec<[f64; 2]>]) -> String {
    match Plan::on_faces(faces, 4) {
        Err(Error::Item { item, source })
            if matches!(*source, Error::Scene { quantity: "polygon", .. }) =>
        {
            item
        }
        other => panic!("{other:?}"),
    }
}

/// GOAL: cells of a rectangle reach beyond its outline unless this is excluded, whatever the order of corners.
#[test]
fn rectangles_reach_beyond_their_outline() {
    let plan = Plan::rectangle(2.0..22.0, -3.0..11.0, 8).unwrap();
    assert_eq!(plan.count(), 11 * 8);
    assert_eq!(plan.middle(), [12.0, 4.0]);
    assert!((plan.pitch()[0] - 20.0 / 10.79).abs() < 1e-14);
    assert!(plan.area_error().abs() < 1e-14);
    let plan = plan.without_overhang().unwrap();
    assert!((plan.pitch()[1] - 14.0 / 8.0).abs() < 1e-14 && plan.area_error().abs() < 1e-14);
    // The same rectangle as two faces, one with its corners in the other order.
    let mut faces = [rectangle([2.0, 9.0], [-3.0, 11.0]), rectangle([9.0, 22.0], [-3.0, 11.0])];
    faces[1].reverse();
    let plan = Plan::on_faces(&faces, 8).unwrap();
    assert_eq!((plan.count(), plan.middle()), (88, [12.0, 4.0]));
}

/// Area of the elements of a plan, and its moments about the y and x axes.
fn area_and_moments(plan: Plan) -> [f64; 3] {
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let ground = ElasticGround::in_plan(soil, plan).unwrap();
    let mut sums = [0.0; 3];
    for element in ground.elements() {
        let center = element.center();
        for (sum, arm) in sums.iter_mut().zip([1.0, center[0], center[1]]) {
            *sum += element.area() * arm;
        }
    }
    sums
}

/// GOAL: area and centre of the cells are those of the outline: of an L, a triangle, a turned square and a disc.
#[test]
fn cut_cells_have_the_area_and_the_centre_of_their_outline() {
    let ell = [rectangle([0.0, 3.0], [0.0, 1.0]), rectangle([0.0, 1.76], [1.0, 2.0])];
    let triangle = [vec![[0.0, 0.0], [3.0, 1.0], [1.0, 2.5]]];
    let square = [vec![[1.0, 0.0], [2.2, 1.0], [1.2, 2.2], [0.0, 1.2]]];
    let center = [(3.0 * 1.5 + 1.76 * 0.88) / 4.76, (3.0 * 0.5 + 1.76 * 1.5) / 4.76];
    for cells in [3, 4, 5, 6, 7, 8, 11, 16, 24] {
        for (plan, area, center) in [
            (Plan::on_faces(&ell, cells).unwrap(), 4.76, center),
            (Plan::on_faces(&triangle, cells).unwrap(), 3.25, [4.0 / 3.0, 3.5 / 3.0]),
            (Plan::on_faces(&square, cells).unwrap(), 2.44, [1.1, 1.1]),
            (Plan::disc([1.0, 2.0], 3.0, cells).unwrap(), 9.0 * std::f64::consts::PI, [1.0, 2.0]),
        ] {
            assert!(plan.area_error().abs() < 1e-9, "{cells} {}", plan.area_error());
            let cell_side = area.sqrt() / cells as f64;
            for (plan, limit) in [(plan.clone(), 0.06), (plan.without_overhang().unwrap(), 0.02)] {
                let sums = area_and_moments(plan);
                assert!((sums[0] / area - 1.0).abs() < 1e-9, "{cells} {area} {}", sums[0]);
                for axis in 0..2 {
                    let error = (sums[1 + axis] / sums[0] - center[axis]) / cell_side;
                    assert!(error.abs() < limit, "{cells} {area} {axis}: {error} cells");
                }
            }
        }
    }
}

/// GOAL: cells of a disc lie about its centre; a mask has one cell for each of its marks.
#[test]
fn discs_and_masks_have_their_cells() {
    let disc = Plan::disc([1.0, 2.0], 3.0, 20).unwrap();
    assert!(disc.middle().iter().zip([1.0, 2.0]).all(|(x, y)| (x - y).abs() < 1e-12));
    // A ring in a mask with an empty margin.
    let text = ".....\n.###.\n.#.#.\n.###.\n.....";
    let mask: Vec<bool> = text.lines().flat_map(str::chars).map(|c| c == '#').collect();
    let ring = Plan::masked([0.0; 2], [2.0, 1.0], 5, &mask).unwrap();
    assert_eq!((ring.count(), ring.middle(), ring.area_error()), (8, [5.0, 2.5], 0.0));
    assert_eq!(ring.clone().without_overhang().unwrap(), ring);
}

/// GOAL: faces that are no convex polygons are named.
#[test]
fn faces_that_are_no_polygons_are_errors() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0]);
    let two_faces = [square, vec![[2.0, 0.0], [3.0, 1.0]]];
    assert_eq!(face_without_polygon(&two_faces), "face 1");
    for face in [
        vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
        vec![[0.0, 0.0], [1.0, f64::NAN], [0.0, 1.0]],
        vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
        vec![[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]],
        vec![[1e300, 0.0], [-1e300, 1e300], [0.0, -1e300]],
    ] {
        assert_eq!(face_without_polygon(&[face]), "face 0");
    }
}

/// GOAL: faces that overlap, lie too close or contain no centre of a cell are errors.
#[test]
fn faces_that_are_no_mat_are_errors() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0]);
    // Faces that overlap by 0.8, 0.005 and 1e-5 of a square; a smaller overlap is the rounding of coordinates.
    for overlap in [0.8, 5e-3, 1e-5] {
        let error = fault(&[square.clone(), rectangle([1.0 - overlap, 2.0], [0.0, 1.0])], 8);
        let PlanError::Overlap { faces: [0, 1], area } = error else {
            panic!("{error}")
        };
        assert!((area / overlap - 1.0).abs() < 1e-9, "{area} {overlap}");
    }
    let touching = Plan::on_faces(&[square.clone(), rectangle([1.0 - 1e-7, 2.0], [0.0, 1.0])], 8);
    assert!(touching.unwrap().area_error().abs() < 1e-6);
    // One rectangle lies inside the other, and two cross.
    let inner_rectangle = rectangle([0.2, 0.4], [0.3, 0.5]);
    let error = fault(&[inner_rectangle, rectangle([3.0, 4.0], [0.0, 1.0]), square.clone()], 8);
    assert!(
        matches!(error, PlanError::Overlap { faces: [0, 2], area } if (area - 0.04).abs() < 1e-12)
    );
    let cross = [rectangle([-1.0, 2.0], [0.4, 0.6]), square.clone()];
    assert!(
        matches!(fault(&cross, 8), PlanError::Overlap { area, .. } if (area - 0.2).abs() < 1e-12)
    );
    // The second mat lies between the centres of cells.
    let narrow_faces = [rectangle([0.0, 4.0], [0.0, 1.0]), rectangle([0.0, 4.0], [3.0, 3.01])];
    let error = fault(&narrow_faces, 4);
    assert!(
        matches!(error, PlanError::NoCells { mat: 1, .. } | PlanError::Uncovered { .. }),
        "{error}"
    );
    for gap in [0.02, 0.1] {
        let separate_faces = [square.clone(), rectangle([1.0 + gap, 2.0], [0.0, 1.0])];
        let error = fault(&separate_faces, 6);
        assert!(matches!(error, PlanError::TooClose { mats: [0, 1], .. }), "{error}");
        assert_eq!(Plan::on_faces(&separate_faces, 80).unwrap().count() % 80, 0);
    }
    let corner = [square, rectangle([1.02, 2.0], [1.02, 2.0])];
    assert!(matches!(fault(&corner, 6), PlanError::TooClose { .. }));
}

/// Plan of unit cells where the mask is true.
fn masked_plan(columns: usize, mask: &[bool]) -> Result<Plan> {
    Plan::masked([0.0; 2], [1.0; 2], columns, mask)
}

/// GOAL: counts, sides and masks that make no mat give typed errors.
#[test]
fn numbers_that_are_no_mat_are_errors() {
    assert!(matches!(Plan::on_faces(&[], 4), Err(Error::Size { found: 0, .. })));
    assert!(matches!(Plan::rectangle(0.0..1.0, 0.0..1.0, 1), Err(Error::Input { value: 1.0, .. })));
    assert!(matches!(Plan::rectangle(0.0..-1.0, 0.0..1.0, 4), Err(Error::Input { .. })));
    assert!(matches!(Plan::rectangle(0.0..f64::NAN, 0.0..1.0, 4), Err(Error::Input { .. })));
    for cells in [100_000, usize::MAX] {
        assert!(matches!(Plan::rectangle(0.0..1.0, 0.0..1.0, cells), Err(Error::Memory(_))));
        assert!(matches!(Plan::disc([0.0; 2], 1.0, cells), Err(Error::Memory(_))));
    }
    assert!(matches!(Plan::rectangle(0.0..1e6, 0.0..1.0, 4), Err(Error::Memory(_))));
    assert!(matches!(Plan::disc([0.0; 2], -1.0, 4), Err(Error::Input { .. })));
    assert!(matches!(Plan::disc([f64::INFINITY, 0.0], 1.0, 4), Err(Error::Input { .. })));
    assert!(matches!(masked_plan(2, &[false; 4]), Err(Error::Plan(PlanError::NoCells { .. }))));
    assert!(matches!(masked_plan(2, &[]), Err(Error::Size { .. } | Error::Plan(_))));
    assert!(matches!(masked_plan(0, &[true]), Err(Error::Size { .. })));
    assert!(matches!(masked_plan(2, &[true; 3]), Err(Error::Size { found: 3, needed: 4, .. })));
    let result = Plan::masked([0.0; 2], [1.0, 0.0], 1, &[true]);
    assert!(matches!(result, Err(Error::Input { .. })));
}

fn soft_soil() -> Soil {
    Soil::from_shear_wave_speed(100.0, 0.3, 1800.0).unwrap()
}

/// Bonded impedances of a square mat of 4 × 4 cells.
fn impedances_of_square(
    profile: &SoilProfile,
    frequencies: &[f64],
    observer: &mut Observer<'_>,
) -> Result<Vec<PlanImpedance>> {
    let plan = Plan::rectangle(-5.0..5.0, -5.0..5.0, 4).unwrap();
    impedances_in_plan(profile, &plan, frequencies, StripContact::Bonded, observer)
}

/// GOAL: frequencies too high for the cells, out of range, and profiles out of reach give typed errors.
#[test]
fn impossible_impedances_are_errors() {
    let profile: SoilProfile = soft_soil().into();
    let result = impedances_of_square(&profile, &[1.0, 20.0], &mut unobserved);
    assert!(
        matches!(result, Err(Error::Plan(PlanError::CoarseCells { frequency: 20.0, .. }))),
        "{result:?}"
    );
    for frequency in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(impedances_of_square(&profile, &[1.0, frequency], &mut unobserved).is_err());
    }
    let bedrock = SoilProfile::on_rigid_bedrock();
    assert!(impedances_of_square(&bedrock, &[1.0], &mut unobserved).is_err());
    assert!(impedances_of_square(&profile, &[], &mut unobserved).unwrap().is_empty());
    let thin_layer = profile.with_layer(soft_soil(), 1e-4).unwrap();
    let result = impedances_of_square(&thin_layer, &[1.0], &mut unobserved);
    assert!(matches!(result, Err(Error::Ground(GroundError::TooFine { .. }))), "{result:?}");
}

/// GOAL: impedances in plan report their progress and stop.
#[test]
fn impedances_report_and_stop() {
    let profile: SoilProfile = soft_soil().into();
    let mut reports = vec![];
    let observed = impedances_of_square(&profile, &[0.0, 2.0], &mut |progress| {
        reports.push(progress.done);
        ControlFlow::Continue(())
    });
    let expected = impedances_of_square(&profile, &[0.0, 2.0], &mut unobserved);
    assert_eq!(observed.unwrap(), expected.unwrap());
    assert!(reports.is_sorted() && reports.last() == Some(&16));
    for last_report in [0, 8, 11] {
        let result = impedances_of_square(&profile, &[0.0, 2.0], &mut |progress| {
            if progress.done == last_report {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert!(matches!(result, Err(Error::Stopped(progress)) if progress.done == last_report));
    }
}
