//! The contact problem of one element, with the tractions of the others fixed.

use super::problem::ContactInput;
use super::response::ContactResponse;
use crate::error::LawError;
use crate::interface::{Condition, ContactState, Mode, Tolerance};

/// Solves element `e` with all other tractions fixed, and returns its mode.
pub(super) fn local_mode(
    response: &mut ContactResponse,
    input: &ContactInput<'_>,
    e: usize,
    current: Mode,
) -> Result<Mode, LawError> {
    let layout = response.layout;
    let size = layout.len();
    let [n, t] = layout.places(e);
    let rows = [n, t].map(|i| &input.delassus[i * size..(i + 1) * size]);
    // Jump without the change of traction of this element.
    let mut jump = [0.0; 2];
    for ((jump, row), i) in jump.iter_mut().zip(rows).zip([n, t]) {
        let all = crate::linalg::dot(row, &response.traction);
        *jump = input.free_jump[i] + all
            - row[n] * response.traction[n]
            - row[t] * response.traction[t];
    }
    let block = rows.map(|row| [row[n], row[t]]);
    let fixed = [input.static_traction[n], input.static_traction[t]];
    let scale = fixed[0].abs().max(jump[0].abs() / block[0][0].abs()).max(fixed[1].abs());
    let tolerance = Tolerance { length: 1e-13 * input.length_scale, traction: 1e-12 * scale };
    let candidates = std::iter::once(current).chain(input.modes(e).iter().copied());
    for mode in candidates {
        let conditions = input.conditions(e, mode)?;
        let Some(change) = solve_element(conditions, jump, block, fixed) else {
            continue;
        };
        let gap = jump[0] + block[0][0] * change[0] + block[0][1] * change[1];
        let tangential = jump[1] + block[1][0] * change[0] + block[1][1] * change[1];
        let state = ContactState {
            gap,
            slip: -tangential,
            pressure: fixed[0] + change[0],
            shear: fixed[1] + change[1],
            ..ContactState::default()
        };
        if input.next_mode(e, mode, &state, tolerance)? == mode {
            response.traction[n] = change[0];
            response.traction[t] = change[1];
            response.states[e] = state;
            return Ok(mode);
        }
    }
    Ok(current)
}

/// The change of traction of one element from its two conditions; `None` if they are dependent.
fn solve_element(
    conditions: [Condition; 2],
    jump: [f64; 2],
    block: [[f64; 2]; 2],
    fixed: [f64; 2],
) -> Option<[f64; 2]> {
    let [[a, b, r], [c, d, s]] = conditions.map(|k| {
        [
            k.gap * block[0][0] - k.slip * block[1][0] + k.pressure,
            k.gap * block[0][1] - k.slip * block[1][1] + k.shear,
            k.value - k.gap * jump[0] + k.slip * jump[1]
                - k.pressure * fixed[0]
                - k.shear * fixed[1],
        ]
    });
    let determinant = a * d - b * c;
    let change = [(r * d - b * s) / determinant, (a * s - r * c) / determinant];
    (determinant != 0.0 && change.iter().all(|x| x.is_finite())).then_some(change)
}
