//! How many free-surface elements the paper's formulation needs: errors of the full-plane ground
//! against the half-plane. More than a few do not help: they let the scheme grow instead.
//!
//! ```text
//! cargo run --release --example full_plane_truncation
//! ```

#[path = "../tests/support/mod.rs"]
mod support;
#[path = "../tests/support/truncation.rs"]
mod truncation;

use support::series::print_errors;
use truncation::{block_errors, impedance_errors};

fn main() {
    println!("bonded strip, impedances over 0.1 <= a0 <= 4 against the table, beta = 1.15");
    for (elements, frees) in [(8, &[0, 5, 10, 20, 40][..]), (16, &[0, 5, 10, 20, 40])] {
        for &free in frees {
            let errors = impedance_errors("0333", 1.0 / 3.0, elements, free, 1.15);
            let scene = format!("{elements} elements, {free} free on either side");
            print_errors(&scene, &["khh", "kvv", "krr", "khr"], &errors);
        }
    }
    println!("rigid block under a Ricker pulse against the half-plane, beta = 1");
    for (elements, frees) in
        [(8, &[0, 5, 10, 20, 40][..]), (16, &[0, 5, 10, 20]), (32, &[0, 5, 10])]
    {
        for &free in frees {
            let errors = block_errors(elements, free, 1.0);
            let scene = format!("{elements} elements, {free} free on either side");
            print_errors(&scene, &["u_base", "theta", "V"], &errors);
        }
    }
}
