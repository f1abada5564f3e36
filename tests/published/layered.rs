//! GOAL: structures on layered ground move as another program computes.
//! SCENE: rigid block on a layer over rock, elastic and damped, and on a rigid base; bonded,
//! vertically incident SV Ricker pulse; 16 graded elements.
//! REFERENCE: `td_block_SV_*`, synthesis of Laplace transforms.

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Strip};
use basemat::soil::{Elastic, Kjartansson, SoilProfile};

use super::linear::block_errors;
use basemat_problems::profiles::{gmb, p1, p3};
use basemat_problems::series::assert_within;

fn ground(profile: SoilProfile, elements: usize) -> ElasticGround {
    ElasticGround::new(profile, Strip::graded(-1.0..1.0, elements).unwrap()).unwrap()
}

#[test]
fn blocks_on_layers_move_as_in_the_tables_td_block() {
    let names = ["u_base", "theta", "u_roof", "V", "M"];
    let kjartansson = Kjartansson::new(0.05, 0.3).unwrap();
    for (name, profile, limits) in [
        ("P1_elastic", p1(Elastic, Elastic), [4.5e-3, 5e-3, 8.5e-3, 3.2e-3, 1.5e-2]),
        ("P1_gmb", p1(gmb(5), gmb(1)), [4e-3, 4.5e-3, 8.5e-3, 3.2e-3, 1.5e-2]),
        ("P3_kj", p3(kjartansson), [4.5e-3, 5e-3, 8.5e-3, 3.2e-3, 1.5e-2]),
    ] {
        let file = format!("layered/td_block_SV_{name}.csv");
        for stages in [Stages::Two, Stages::Three] {
            let ground = ground(profile.clone(), 16).with_stages(stages);
            let errors = block_errors(&file, ground, 2.0, 1.0, 0.05);
            assert_within(&format!("block {name}, {stages:?}"), &names, &errors, &limits);
        }
    }
}
