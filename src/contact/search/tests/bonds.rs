//! Bonds that break within a step, against all sets of modes.

use super::*;
use crate::interface::Cohesive;

/// Adds brittle bonds of random strength to all closed elements.
fn add_bonds(problem: &mut Problem, random: &mut Random) {
    let pressure = problem.static_traction[0];
    let tension = pressure * random.log_within(0.03, 3.0);
    let cohesion = pressure * random.log_within(0.03, 3.0);
    let law = Cohesive::new(tension, cohesion, problem.parameters.friction).unwrap();
    problem.laws = vec![Box::new(law)];
    let starts: Vec<_> = problem
        .start
        .iter()
        .map(|start| {
            let mode = if start.mode.is_closed() { Mode::Stick } else { Mode::Open };
            PreviousContact::new(start.state, mode, 1e-3)
        })
        .collect();
    problem.start = PreviousContacts::new(&problem.laws, &starts).unwrap();
    problem.modes = problem.start.iter().map(|start| start.mode).collect();
    problem.parameters.condition = UnilateralCondition::Position;
}

#[test]
fn bonds_break_only_where_brute_force_allows_it() {
    let mut random = Random(5);
    let mut problem_count = 0;
    // Problems in which a bond must break, with several solutions, and that begin with a broken bond.
    let mut breaking_count = 0;
    let mut multiple_count = 0;
    let mut broken_count = 0;
    for (count, sequences) in [(1, 60), (2, 120), (3, 120), (4, 60), (5, 12)] {
        for sequence in 0..sequences {
            let delassus = if sequence % 2 == 0 {
                scene_delassus(count, &mut random)
            } else {
                random_delassus(count, &mut random)
            };
            let mut problem = random_problem(delassus, count, &mut random);
            add_bonds(&mut problem, &mut random);
            let mut search = ModeSearch::new(count, ContactSearch::Robust);
            let mut state_variables = problem.start.state_variables().to_vec();
            for _ in 0..10 {
                advance_free_jump(&mut problem, &mut random);
                problem_count += 1;
                let solutions = brute_force(&problem);
                search.solver.invalidate();
                let mut modes = problem.modes.clone();
                search.solve(&problem.input(), &mut modes).unwrap();
                let is_solution =
                    solutions.iter().any(|(solution_modes, _)| *solution_modes == modes);
                assert!(is_solution, "{modes:?} is not among {solutions:?}");
                let keeps_bonds = |modes: &[Mode]| {
                    (0..count).all(|e| {
                        let is_bonded = problem.start.state_variables_of(e) == [1.0];
                        !is_bonded || modes[e] == Mode::Stick
                    })
                };
                // No bond breaks where all bonds may stay intact, unless friction alone allows several solutions.
                let may_keep_bonds = solutions.iter().any(|(modes, _)| keeps_bonds(modes));
                let is_unique = problem.parameters.friction < 1.0;
                assert!(
                    keeps_bonds(&modes) || !may_keep_bonds || !is_unique,
                    "{modes:?} {solutions:?}"
                );
                breaking_count += usize::from(!may_keep_bonds);
                multiple_count += usize::from(solution_count(&solutions) > 1);
                broken_count += usize::from(problem.start.state_variables().contains(&0.0));
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
    assert!(breaking_count > problem_count / 20 && multiple_count > problem_count / 50);
    assert!(broken_count < problem_count);
}
