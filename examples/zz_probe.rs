use basemat::bem::HalfPlaneGround;
use basemat::fem::*;
use basemat::interface::Coulomb;
use basemat::structure::*;
use basemat::{Simulation, Soil};
use std::time::Instant;
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.split(' ').collect();
    (f[13].parse::<f64>().unwrap()) / 100.0
}
fn main() {
    let a: Vec<usize> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let (cols, rows, height) = (a[0], a[1], a[2] as f64);
    let material = Material::new(5.0e9, 0.2, 600.0).unwrap();
    let model = || {
        let mesh =
            Mesh::layered_block(-5.0..5.0, cols, &[Layer::new(height, rows, material)]).unwrap();
        FemModel::on_base(mesh).unwrap().with_mass(MassKind::Lumped)
    };
    let n = model().unknowns();
    let scene = |s: Box<dyn FnOnce() -> Simulation>| s();
    let _ = scene;
    for modes in [0usize, 8, 30] {
        let t = (Instant::now(), cpu());
        let reduced = CraigBampton::new(modes).reduce(model()).unwrap();
        println!(
            "n {n} modes {modes}: reduce {:.2} s wall, {:.2} cpu",
            t.0.elapsed().as_secs_f64(),
            cpu() - t.1
        );
        let r = Simulation::builder(0.01)
            .structure(reduced)
            .ground(
                HalfPlaneGround::strip(Soil::new(200.0e6, 0.33, 1900.0).unwrap(), -5.0..5.0, 20)
                    .unwrap(),
            )
            .interface(Coulomb::new(0.5).unwrap())
            .gravity(9.81)
            .build();
        println!("  reduced scene {:?} cpu {:.2}", r.err(), cpu());
    }
    let t = cpu();
    let r = Simulation::builder(0.01)
        .structure(model())
        .coordinates(basemat::coupled::Coordinates::Unknowns)
        .ground(
            HalfPlaneGround::strip(Soil::new(200.0e6, 0.33, 1900.0).unwrap(), -5.0..5.0, 20)
                .unwrap(),
        )
        .interface(Coulomb::new(0.5).unwrap())
        .gravity(9.81)
        .build();
    println!("  full scene {:?} cpu {:.2}", r.err(), cpu() - t);
}
