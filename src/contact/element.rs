//! The contact problem of one element, with the tractions of the others fixed.

use super::fixed_modes::{JUMP_ROUNDING_FACTOR, TRACTION_ROUNDING_FACTOR};
use super::problem::{ContactInput, ContactResponse, LawResult};
use crate::interface::{Condition, ContactState, Mode, Tolerance};

/// Solves element `e` with all other tractions fixed, and returns its mode.
///
/// It tries the present mode first, and keeps it if no mode is admissible.
pub(super) fn local_mode(
    response: &mut ContactResponse,
    input: &ContactInput<'_>,
    e: usize,
    present_mode: Mode,
) -> LawResult<Mode> {
    let layout = response.layout;
    let size = layout.len();
    let [n, t] = layout.indices_of(e);
    let rows = [n, t].map(|i| &input.delassus[i * size..(i + 1) * size]);
    // Jump without the change of traction on this element.
    let mut jump = [0.0; 2];
    for ((jump, row), i) in jump.iter_mut().zip(rows).zip([n, t]) {
        let jump_change = crate::linalg::dot(row, &response.traction);
        *jump = input.free_jump[i] + jump_change
            - row[n] * response.traction[n]
            - row[t] * response.traction[t];
    }
    let block = rows.map(|row| [row[n], row[t]]);
    let static_traction = [input.static_traction[n], input.static_traction[t]];
    let closing_pressure = jump[0].abs() / block[0][0].abs();
    let traction_scale =
        static_traction[0].abs().max(closing_pressure).max(static_traction[1].abs());
    let tolerance = Tolerance {
        length: JUMP_ROUNDING_FACTOR * input.length_scale,
        traction: TRACTION_ROUNDING_FACTOR * traction_scale,
    };
    let candidates = std::iter::once(present_mode).chain(input.modes(e).iter().copied());
    for mode in candidates {
        let conditions = input.conditions(e, mode)?;
        let Some(change) = solve_element(conditions, jump, block, static_traction) else {
            continue;
        };
        let gap = jump[0] + block[0][0] * change[0] + block[0][1] * change[1];
        let tangential_jump = jump[1] + block[1][0] * change[0] + block[1][1] * change[1];
        let state = ContactState {
            gap,
            slip: -tangential_jump,
            pressure: static_traction[0] + change[0],
            shear: static_traction[1] + change[1],
            ..ContactState::default()
        };
        if input.next_mode(e, mode, &state, tolerance)? == mode {
            response.traction[n] = change[0];
            response.traction[t] = change[1];
            response.states[e] = state;
            return Ok(mode);
        }
    }
    Ok(present_mode)
}

/// Change of traction of one element that satisfies its two conditions.
///
/// `None` if they are dependent.
fn solve_element(
    conditions: [Condition; 2],
    jump: [f64; 2],
    block: [[f64; 2]; 2],
    static_traction: [f64; 2],
) -> Option<[f64; 2]> {
    let [[a, b, r], [c, d, s]] = conditions.map(|condition| {
        [
            condition.gap * block[0][0] - condition.slip * block[1][0] + condition.pressure,
            condition.gap * block[0][1] - condition.slip * block[1][1] + condition.shear,
            condition.value - condition.gap * jump[0] + condition.slip * jump[1]
                - condition.pressure * static_traction[0]
                - condition.shear * static_traction[1],
        ]
    });
    let determinant = a * d - b * c;
    let change = [(r * d - b * s) / determinant, (a * s - r * c) / determinant];
    (determinant != 0.0 && change.iter().all(|x| x.is_finite())).then_some(change)
}
