//! GOAL: cells lie where faces are, and what cannot be covered says so.
//! SCENE: rectangles, an L, a triangle, discs, masks, several mats; faces and numbers that make no mat.
//! REFERENCE: areas, centres and counts by hand.

use std::ops::ControlFlow;

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, Ground, GroundError, PlanError};
use basemat::soil::SoilProfile;
use basemat::{Error, Soil, unobserved};

fn rectangle(x: [f64; 2], y: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

fn fault(faces: &[Vec<[f64; 2]>], cells: usize) -> PlanError {
    match Plan::on_faces(faces, cells) {
        Err(Error::Plan(fault)) => fault,
        other => panic!("{other:?}"),
    }
}

/// The face that is no convex polygon.
fn no_polygon(faces: &[Vec<[f64; 2]>]) -> String {
    match Plan::on_faces(faces, 4) {
        Err(Error::Item { item, source })
            if matches!(*source, Error::Scene { quantity: "polygon", .. }) =>
        {
            item
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn rectangles_reach_beyond_their_outline() {
    let plan = Plan::rectangle(2.0..22.0, -3.0..11.0, 8).unwrap();
    assert_eq!(plan.count(), 11 * 8);
    assert_eq!(plan.middle(), [12.0, 4.0]);
    assert!((plan.pitch()[0] - 20.0 / 10.79).abs() < 1e-14);
    assert!(plan.area_error().abs() < 1e-14);
    let plan = plan.without_overhang().unwrap();
    assert!((plan.pitch()[1] - 14.0 / 8.0).abs() < 1e-14 && plan.area_error().abs() < 1e-14);
    // The same of two faces, in either order of their corners.
    let mut faces = [rectangle([2.0, 9.0], [-3.0, 11.0]), rectangle([9.0, 22.0], [-3.0, 11.0])];
    faces[1].reverse();
    let found = Plan::on_faces(&faces, 8).unwrap();
    assert_eq!((found.count(), found.middle()), (88, [12.0, 4.0]));
}

/// Area inside the outline, and its centre: of an L, a triangle, a turned square and a disc.
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
            let size = area.sqrt() / cells as f64;
            for (plan, most) in [(plan.clone(), 0.06), (plan.without_overhang().unwrap(), 0.02)] {
                let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
                let ground = ElasticGround::in_plan(soil, plan).unwrap();
                let mut sums = [0.0; 3];
                for element in ground.elements() {
                    let (own, [x, y, _]) = (element.area(), element.center());
                    [1.0, x, y].iter().zip(&mut sums).for_each(|(x, sum)| *sum += own * x);
                }
                assert!((sums[0] / area - 1.0).abs() < 1e-9, "{cells} {area} {}", sums[0]);
                for axis in 0..2 {
                    let error = (sums[1 + axis] / sums[0] - center[axis]) / size;
                    assert!(error.abs() < most, "{cells} {area} {axis}: {error} cells");
                }
            }
        }
    }
}

#[test]
fn discs_and_masks_are_their_cells() {
    let disc = Plan::disc([1.0, 2.0], 3.0, 20).unwrap();
    assert!(disc.middle().iter().zip([1.0, 2.0]).all(|(x, y)| (x - y).abs() < 1e-12));
    // A ring in a mask with an empty margin.
    let text = ".....\n.###.\n.#.#.\n.###.\n.....";
    let mask: Vec<bool> = text.lines().flat_map(str::chars).map(|c| c == '#').collect();
    let ring = Plan::masked([0.0; 2], [2.0, 1.0], 5, &mask).unwrap();
    assert_eq!((ring.count(), ring.middle(), ring.area_error()), (8, [5.0, 2.5], 0.0));
    assert_eq!(ring.clone().without_overhang().unwrap(), ring);
}

#[test]
fn faces_that_are_no_mat_are_errors() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0]);
    let two = [square.clone(), vec![[2.0, 0.0], [3.0, 1.0]]];
    assert_eq!(no_polygon(&two), "face 1");
    for bad in [
        vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
        vec![[0.0, 0.0], [1.0, f64::NAN], [0.0, 1.0]],
        vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
        vec![[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]],
        vec![[1e300, 0.0], [-1e300, 1e300], [0.0, -1e300]],
    ] {
        assert_eq!(no_polygon(&[bad]), "face 0");
    }
    // Faces that overlap by 80, 0.5 and 1e-5 of 1; a smaller overlap is the rounding of coordinates.
    for part in [0.8, 5e-3, 1e-5] {
        let found = fault(&[square.clone(), rectangle([1.0 - part, 2.0], [0.0, 1.0])], 8);
        let PlanError::Overlap { faces: [0, 1], area } = found else { panic!("{found}") };
        assert!((area / part - 1.0).abs() < 1e-9, "{area} {part}");
    }
    let close = Plan::on_faces(&[square.clone(), rectangle([1.0 - 1e-7, 2.0], [0.0, 1.0])], 8);
    assert!(close.unwrap().area_error().abs() < 1e-6);
    // One inside the other, and a cross.
    let inner = rectangle([0.2, 0.4], [0.3, 0.5]);
    let found = fault(&[inner, rectangle([3.0, 4.0], [0.0, 1.0]), square.clone()], 8);
    assert!(
        matches!(found, PlanError::Overlap { faces: [0, 2], area } if (area - 0.04).abs() < 1e-12)
    );
    let cross = [rectangle([-1.0, 2.0], [0.4, 0.6]), square.clone()];
    assert!(
        matches!(fault(&cross, 8), PlanError::Overlap { area, .. } if (area - 0.2).abs() < 1e-12)
    );
    // A mat between the centres of cells.
    let narrow = [rectangle([0.0, 4.0], [0.0, 1.0]), rectangle([0.0, 4.0], [3.0, 3.01])];
    let found = fault(&narrow, 4);
    assert!(
        matches!(found, PlanError::NoCells { mat: 1, .. } | PlanError::Uncovered { .. }),
        "{found}"
    );
    for gap in [0.02, 0.1] {
        let apart = [square.clone(), rectangle([1.0 + gap, 2.0], [0.0, 1.0])];
        let found = fault(&apart, 6);
        assert!(matches!(found, PlanError::TooClose { mats: [0, 1], .. }), "{found}");
        assert_eq!(Plan::on_faces(&apart, 80).unwrap().count() % 80, 0);
    }
    let corner = [square.clone(), rectangle([1.02, 2.0], [1.02, 2.0])];
    assert!(matches!(fault(&corner, 6), PlanError::TooClose { .. }));
}

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
    let masked = |columns, mask: &[bool]| Plan::masked([0.0; 2], [1.0; 2], columns, mask);
    assert!(matches!(masked(2, &[false; 4]), Err(Error::Plan(PlanError::NoCells { .. }))));
    assert!(matches!(masked(2, &[]), Err(Error::Size { .. } | Error::Plan(_))));
    assert!(matches!(masked(0, &[true]), Err(Error::Size { .. })));
    assert!(matches!(masked(2, &[true; 3]), Err(Error::Size { found: 3, needed: 4, .. })));
    let flat = Plan::masked([0.0; 2], [1.0, 0.0], 1, &[true]);
    assert!(matches!(flat, Err(Error::Input { .. })));
}

#[test]
fn impedances_say_what_they_cannot() {
    let soil = Soil::from_shear_wave_speed(100.0, 0.3, 1800.0).unwrap();
    let profile: SoilProfile = soil.into();
    let plan = Plan::rectangle(-5.0..5.0, -5.0..5.0, 4).unwrap();
    let bonded = StripContact::Bonded;
    let at = |frequency: f64| {
        impedances_in_plan(&profile, &plan, &[1.0, frequency], bonded, &mut unobserved)
    };
    let found = at(20.0);
    assert!(
        matches!(found, Err(Error::Plan(PlanError::CoarseCells { frequency: 20.0, .. }))),
        "{found:?}"
    );
    for frequency in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(at(frequency).is_err());
    }
    assert!(
        impedances_in_plan(
            &SoilProfile::on_rigid_bedrock(),
            &plan,
            &[1.0],
            bonded,
            &mut unobserved
        )
        .is_err()
    );
    assert!(impedances_in_plan(&profile, &plan, &[], bonded, &mut unobserved).unwrap().is_empty());
    let skin = profile.clone().with_layer(soil, 1e-4).unwrap();
    let found = impedances_in_plan(&skin, &plan, &[1.0], bonded, &mut unobserved);
    assert!(matches!(found, Err(Error::Ground(GroundError::TooFine { .. }))), "{found:?}");

    let mut heard = vec![];
    let all = |observer: &mut dyn FnMut(usize) -> ControlFlow<()>| {
        impedances_in_plan(&profile, &plan, &[0.0, 2.0], bonded, &mut |progress| {
            observer(progress.done)
        })
    };
    let found = all(&mut |done| {
        heard.push(done);
        ControlFlow::Continue(())
    });
    assert_eq!(
        found.unwrap(),
        impedances_in_plan(&profile, &plan, &[0.0, 2.0], bonded, &mut unobserved).unwrap()
    );
    assert!(heard.is_sorted() && heard.last() == Some(&16));
    for last in [0, 8, 11] {
        let stopped = all(&mut |done| {
            if done == last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(matches!(stopped, Err(Error::Stopped(progress)) if progress.done == last));
    }
}
