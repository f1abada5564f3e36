//! Bonds that break within a step, against brute force.

use super::*;
use crate::interface::Cohesive;

/// Adds brittle bonds of random strength under every closed element.
fn glue(problem: &mut Problem, random: &mut Random) {
    let pressure = problem.static_traction[0];
    let tension = pressure * random.log_within(0.03, 3.0);
    let cohesion = pressure * random.log_within(0.03, 3.0);
    let law = Cohesive::new(tension, cohesion, problem.parameters.friction).unwrap();
    problem.laws = vec![Box::new(law)];
    let starts = problem.start.iter().map(|start| {
        let mode = if start.mode.is_closed() { Mode::Stick } else { Mode::Open };
        PreviousContact::new(start.state, mode, 1e-3)
    });
    problem.start = PreviousContacts::new(&problem.laws, &starts.collect::<Vec<_>>()).unwrap();
    problem.modes = problem.start.iter().map(|start| start.mode).collect();
    problem.parameters.activation = UnilateralCondition::Position;
}

#[test]
fn bonds_break_where_brute_force_says_they_may() {
    let mut random = Random(5);
    let mut problems = 0;
    let mut breaking = 0;
    let mut several = 0;
    let mut cut = 0;
    for (count, sequences) in [(1, 60), (2, 120), (3, 120), (4, 60), (5, 12)] {
        for sequence in 0..sequences {
            let delassus = if sequence % 2 == 0 {
                scene(count, &mut random).0
            } else {
                invented(count, &mut random)
            };
            let mut problem = begin(delassus, count, &mut random);
            glue(&mut problem, &mut random);
            let mut search = ModeSearch::new(count, ContactSearch::Robust);
            let mut state_variables = problem.start.state_variables().to_vec();
            for _ in 0..10 {
                push(&mut problem, &mut random);
                problems += 1;
                let all = brute_force(&problem);
                search.solver.invalidate();
                let mut modes = problem.modes.clone();
                search.solve(&problem.input(), &mut modes).unwrap();
                assert!(all.iter().any(|(m, _)| *m == modes), "{modes:?} is not among {all:?}");
                let is_bonded = |e: usize| problem.start.state_variables_of(e) == [1.0];
                let keeps_all =
                    |modes: &[Mode]| (0..count).all(|e| !is_bonded(e) || modes[e] == Mode::Stick);
                // No bond breaks where all of them may hold, unless friction alone allows several solutions.
                let may_hold = all.iter().any(|(modes, _)| keeps_all(modes));
                let is_unique = problem.parameters.friction < 1.0;
                assert!(keeps_all(&modes) || !may_hold || !is_unique, "{modes:?} {all:?}");
                breaking += usize::from(!may_hold);
                several += usize::from(distinct(&all) > 1);
                cut += usize::from(problem.start.state_variables().contains(&0.0));
                let laws = &problem.laws;
                let states = &search.solver.response.states;
                problem
                    .start
                    .update_state_variables(laws, states, &modes, &mut state_variables)
                    .unwrap();
                problem.start.advance(states, &modes, &state_variables);
                problem.modes = modes;
            }
        }
    }
    println!(
        "{problems} problems, {breaking} break bonds, {several} have several solutions, {cut}"
    );
    assert!(breaking > problems / 20 && several > problems / 50 && cut < problems);
}
