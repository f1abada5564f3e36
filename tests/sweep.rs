//! A sweep gives what its cases give alone, and outlives the ones that fail.

#[path = "support/scenes.rs"]
mod scenes;

use std::sync::Mutex;

use basemat::coupled::State;
use basemat::{Error, Sweep};
use scenes::{SI, block, scene, states};

/// Negative friction is refused.
const FRICTION: [f64; 5] = [0.2, 0.6, -1.0, 0.4, f64::INFINITY];

fn case(index: usize) -> Result<Vec<State>, Error> {
    let law = basemat::interface::Coulomb::new(FRICTION[index])?;
    let mut simulation = scene(SI, 0.6).structure(block(SI)).interface(law).build()?;
    Ok(states(&mut simulation, 150))
}

#[test]
fn sweep_is_bitwise_sequential_and_outlives_errors() {
    let progress = Mutex::new(vec![Vec::new(); FRICTION.len()]);
    let mut results: Vec<Option<Result<Vec<State>, Error>>> = vec![None; FRICTION.len()];
    let sweep = Sweep::new(FRICTION.len())
        .on_progress(|index, fraction| progress.lock().unwrap()[index].push(fraction));
    sweep.run(
        |now| {
            now.report(0.25);
            case(now.index())
        },
        |index, result| assert!(results[index].replace(result).is_none(), "{index} came twice"),
    );
    drop(sweep);
    for (index, result) in results.into_iter().enumerate() {
        match (result.unwrap(), case(index)) {
            (Ok(found), Ok(wanted)) => assert!(found == wanted, "case {index} differs"),
            (Err(found), Err(wanted)) => {
                assert_eq!(found.to_string(), wanted.to_string());
                assert_eq!(index, 2);
            }
            _ => panic!("case {index}: one fails, the other does not"),
        }
    }
    assert_eq!(progress.into_inner().unwrap(), vec![vec![0.25, 1.0]; FRICTION.len()]);
}

#[test]
fn an_empty_sweep_ends() {
    Sweep::new(0).run(|_| Ok::<(), ()>(()), |_, _| panic!("there is no case"));
}
