//! GOAL: a step finds a solution of its contact problem wherever enumeration finds one.
//! SCENE: random problems of one to four elements, friction from 0 to 3, in sequences.
//! REFERENCE: all combinations of modes, one by one. `cargo study contact-problems` runs many more problems.

use basemat_problems::contact_problems::{ContactTally, sequence};
use basemat_problems::random::Random;

#[test]
fn steps_find_a_solution_of_brute_force() {
    let mut random = Random(11);
    for [low, high] in [[0.0, 0.0], [0.05, 0.6], [0.6, 1.5], [1.5, 3.0]] {
        let mut tally = ContactTally::default();
        for k in 0..60 {
            let friction = if high > 0.0 { random.within(low, high) } else { 0.0 };
            tally.add(&sequence(1 + k % 4, friction, k % 2 == 0, &mut random));
        }
        println!("friction {low} to {high}: {tally:?}");
        assert_eq!((tally.failed_steps, tally.unsolvable_problems), (0, 0), "{tally:?}");
        assert!(tally.max_violation < 1e-10 && tally.max_distance < 1e-9, "{tally:?}");
        assert!(tally.ambiguous_problems == 0 || high > 0.6, "{tally:?}");
        // Problems whose start is the solution would not test the search.
        assert!(tally.trials > 3 * tally.problems / 2, "{tally:?}");
    }
}
