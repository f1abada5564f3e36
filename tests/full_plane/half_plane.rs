//! GOAL: the flat full-plane boundary agrees with the half-plane, but for its truncated surface.
//! SCENE: rigid strips and blocks with free elements on either side.
//! REFERENCE: impedances by a spectral method, and runs on the half-plane.

use basemat::bem::full_plane::{Boundary, CqMethod, FullPlaneGround, Stability};
use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::unobserved;

use super::soil;
use basemat_problems::assert_close;
use basemat_problems::series::{RelativeError as SeriesError, assert_within};
use basemat_problems::truncation::{FullPlaneMesh, block_errors, impedance_errors, rocking};

/// FullPlaneMesh with the time kernel.
fn time_kernel_mesh(elements: usize, free: usize, beta: f64) -> FullPlaneMesh {
    FullPlaneMesh { elements, free, beta, quadrature: None }
}

/// FullPlaneMesh with convolution quadrature by BDF2.
fn bdf2_mesh(free: usize) -> FullPlaneMesh {
    FullPlaneMesh { elements: 8, free, beta: 1.15, quadrature: Some(CqMethod::Bdf2) }
}

/// GOAL: impedances on the flat boundary are those of the half-plane, but for its truncated surface.
/// SCENE: bonded massless rigid strip of 8 elements, β = 1.15.
/// REFERENCE: impedances by a spectral method. The coupling, a small number that comes from H and the
/// free surface alone, has a large error at every time step, hardly less with twice the elements.
#[test]
fn impedances_of_a_bonded_strip_are_those_of_the_half_plane() {
    for (free, limits) in
        [(5, [4.2e-2, 4.6e-2, 1.5e-1, 5.2e-1]), (10, [4.2e-2, 4.6e-2, 1.5e-1, 4.2e-1])]
    {
        let errors = impedance_errors("0333", 1.0 / 3.0, time_kernel_mesh(8, free, 1.15));
        assert_within(&format!("{free} free"), &["khh", "kvv", "krr", "khr"], &errors, &limits);
    }
}

/// GOAL: the error of the truncated free surface. The direct impedances have the error of the mesh with or without free
/// elements; the coupling, which comes from the free surface and from H alone, converges to that of the half-plane with
/// about the root of the surface's length. SCENE: as before by convolution quadrature (BDF2), which is bounded with any
/// of these surfaces. REFERENCE: impedances by a spectral method.
#[test]
fn the_coupling_converges_with_the_length_of_the_free_surface() {
    let ground = bdf2_mesh(20).ground(soil(1.0 / 3.0));
    let time_step = bdf2_mesh(0).time_step(soil(1.0 / 3.0));
    assert!(ground.assess(time_step, 1e-4).unwrap().iter().all(Stability::is_bounded));
    let errors = [0, 5, 20, 80].map(|free| impedance_errors("0333", 1.0 / 3.0, bdf2_mesh(free)));
    for (errors, coupling) in errors.iter().zip([4.6e-1, 3.3e-1, 2.4e-1, 1.4e-1]) {
        let limits = [4.3e-2, 4.2e-2, 7.8e-2, coupling];
        assert_within("BDF2", &["khh", "kvv", "krr", "khr"], errors, &limits);
    }
    for k in 0..3 {
        let direct_errors = errors.map(|errors| errors[k]);
        let min_error = direct_errors.into_iter().fold(1.0_f64, f64::min);
        let max_magnitude = direct_errors.into_iter().fold(0.0_f64, f64::max);
        assert!(max_magnitude < 1.2 * min_error, "{k}: {direct_errors:?}");
    }
    // The last quadrupling of the length: by 2^(2 · 0.4).
    assert_close("order", (errors[2][3] / errors[3][3]).log2() / 2.0, 0.4, 0.1, 0.0);
}

/// GOAL: coupled runs on both grounds converge to the same response.
/// SCENE: bonded rigid block under a Ricker pulse, 5 free elements on either side, β = 1.
#[test]
fn a_rigid_block_moves_alike_on_both_grounds() {
    for (count, free, limits) in [(8, 5, [6.2e-2, 7.6e-2, 3e-2]), (16, 5, [2.2e-2, 3.8e-2, 3.2e-2])]
    {
        let errors = block_errors(time_kernel_mesh(count, free, 1.0));
        assert_within(&format!("{count}, {free}"), &["u_base", "theta", "V"], &errors, &limits);
    }
}

/// GOAL: contact with friction converges with an operator that is not symmetric.
/// SCENE: a block that rocks and slides, 5 free elements on either side, β = 2.
#[test]
fn a_block_rocks_and_slides_alike_on_both_grounds() {
    let [(full_slip, full_uplift), (half_slip, half_uplift)] = rocking(8, 5, 2.0);
    println!("uplift {full_uplift} {half_uplift}");
    println!("slip {:?} {:?}", full_slip.last(), half_slip.last());
    let mut error = SeriesError::default();
    full_slip.iter().zip(&half_slip).for_each(|(a, b)| error.add(*a, *b));
    assert_within("rocking", &["slip"], &[error.relative()], &[1e-2]);
    assert!(full_uplift > 0.0 && (full_uplift - half_uplift).abs() < 0.13);
}

/// Differences of a static compliance of four elements that need no datum.
///
/// Under a load on the left element: differences of the z and of the x displacements of two others,
/// then the coupling of x and z.
fn relative_compliances(matrix: &[f64; 64]) -> [f64; 4] {
    [
        matrix[2 * 8] - matrix[3 * 8],
        matrix[6 * 8 + 4] - matrix[7 * 8 + 4],
        matrix[3 * 8 + 4],
        matrix[7 * 8],
    ]
}

/// GOAL: the static limit of the boundary equation is the half-plane's.
/// SCENE: a surface whose last element is inclined by a millionth, so that it is not treated as flat.
/// REFERENCE: the half-plane's static compliance; between two elements, as there is no datum.
#[test]
fn the_static_compliance_is_that_of_the_half_plane() {
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let mut half_plane = ElasticGround::new(soil(0.3), strip).unwrap();
    half_plane.prepare(0.1, None, &mut unobserved).unwrap();
    let mut compliance = [0.0; 64];
    half_plane.static_compliance(&mut compliance).unwrap();
    let expected = relative_compliances(&compliance);
    let errors: [[f64; 4]; 3] = [5, 20, 80].map(|free| {
        let flat_boundary = Boundary::flat(&[Strip::uniform(-1.0..1.0, 4).unwrap()], free).unwrap();
        let mut segments = flat_boundary.segments().to_vec();
        segments.last_mut().unwrap().to[1] += 1e-6;
        let boundary = Boundary::new(segments, flat_boundary.contact()).unwrap();
        assert!(!boundary.is_flat());
        let ground = FullPlaneGround::new(soil(0.3), boundary);
        let mut compliance = [0.0; 64];
        ground.static_compliance(&mut compliance).unwrap();
        let computed = relative_compliances(&compliance);
        std::array::from_fn(|k| (computed[k] / expected[k] - 1.0).abs())
    });
    // Midpoints against means, on elements as long as a quarter of the strip, differ by some percent.
    for (errors, coupling) in errors.iter().zip([1.2e-1, 1.1e-1, 8.5e-2]) {
        let limits = [1.7e-2, 1.7e-2, coupling, coupling];
        assert_within("static", &["zz", "xx", "zx", "xz"], errors, &limits);
    }
}
