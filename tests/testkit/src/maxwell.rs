//! Numbers of a generalised Maxwell body from a reference table.

/// The numbers between brackets after a name.
fn number_list(block: &str, name: &str) -> Vec<f64> {
    let list = block.split(&format!("\"{name}\": [")).nth(1).unwrap();
    list.split(']')
        .next()
        .unwrap()
        .split(',')
        .map(|x| x.trim().parse().unwrap())
        .collect()
}

/// Long-term modulus, moduli and frequencies of the law of `gmb.json` for a damping ratio of 5 % or 1 %.
pub fn gmb_numbers(percent: u32) -> (f64, Vec<f64>, Vec<f64>) {
    let text = include_str!("../../data/layered/gmb.json");
    let block = text.split(&format!("\"gmb{percent}\"")).nth(1).unwrap();
    let long_term = block.split("\"mr\": ").nth(1).unwrap().split('\n').next().unwrap();
    let long_term = long_term.trim().parse().unwrap();
    (long_term, number_list(block, "y"), number_list(block, "w"))
}
