//! Rows of the tables of benchmarks: values of the same formulation, targets, gates, and computed values.

use basemat_problems::table;

/// One value of a benchmark.
#[derive(Debug, Clone)]
pub(super) struct BenchmarkRow {
    pub(super) table: &'static str,
    pub(super) benchmark: String,
    pub(super) quantity: String,
    pub(super) mesh: String,
    /// Value of another program.
    pub(super) tabled: f64,
    /// Largest relative difference from the tabled value.
    pub(super) tolerance: f64,
    /// Accepted value, and largest relative difference from it.
    pub(super) target: Option<(f64, Option<f64>)>,
    pub(super) computed: Option<f64>,
}

impl BenchmarkRow {
    /// A value without a target, of six digits.
    fn new(table: &'static str, benchmark: &str, quantity: &str, mesh: &str, tabled: f64) -> Self {
        Self {
            table,
            benchmark: benchmark.to_owned(),
            quantity: quantity.to_owned(),
            mesh: mesh.to_owned(),
            tabled,
            // Half of the last digit.
            tolerance: 1e-5,
            target: None,
            computed: None,
        }
    }

    /// Whether the row has these names.
    fn has_names(&self, benchmark: &str, quantity: &str, mesh: &str) -> bool {
        self.benchmark == benchmark && self.quantity == quantity && self.mesh == mesh
    }

    /// Relative difference of the computed value from the tabled value.
    pub(super) fn difference(&self) -> Option<f64> {
        Some((self.computed? / self.tabled - 1.0).abs())
    }

    /// Computed value over the target.
    pub(super) fn ratio(&self) -> Option<f64> {
        Some(self.computed? / self.target?.0)
    }

    /// Words of a verdict; those in capitals are failures.
    pub(super) fn verdict(&self) -> &'static str {
        let Some(difference) = self.difference() else { return "not computed" };
        let gate = self.target.and_then(|(_, gate)| gate);
        let misses_target =
            self.ratio().zip(gate).is_some_and(|(ratio, gate)| (ratio - 1.0).abs() > gate);
        match (difference > self.tolerance, misses_target) {
            (true, true) => "OFF TABLE AND TARGET",
            (true, false) => "OFF TABLE",
            (false, true) => "OFF TARGET",
            (false, false) if gate.is_none() => "as tabled",
            (false, false) => "holds",
        }
    }

    pub(super) fn fails(&self) -> bool {
        self.verdict().starts_with("OFF")
    }
}

/// Whether a raft has one cell for each element: "Shell4 16x16, 16x16 cells".
fn has_cell_for_each_element(mesh: &str) -> bool {
    let counts: Vec<&str> = mesh.split([' ', ',']).filter(|word| word.contains('x')).collect();
    matches!(counts[..], [elements, cells] if elements == cells)
}

/// Limits of the raft, with gates for 16 and 32 elements along a side.
///
/// On springs a Ritz solution of degree 36, on the half-space the values extrapolated to small cells.
fn raft_target(is_winkler: bool, quantity: &str, mesh: &str) -> Option<(f64, Option<f64>)> {
    // On springs, and on the half-space.
    let targets = match quantity {
        "settlement middle, mm" => [3.487_449, 6.037],
        "settlement middle of a side, mm" => [0.743_579_3, 3.072],
        "settlement corner, mm" => [-0.495_681_2, 1.678],
        "moment mx = my under the load, kNm/m" => [729.3671, f64::NAN],
        _ => return None,
    };
    let target = if is_winkler { targets[0] } else { targets[1] };
    let gates = if quantity.starts_with("moment") { [0.14, 0.04] } else { [1e-2, 3e-3] };
    let gate = if mesh.starts_with("Shell4 16x16") {
        Some(gates[0])
    } else if mesh.starts_with("Shell4 32x32") {
        Some(gates[1])
    } else {
        None
    };
    target.is_finite().then_some((target, gate))
}

/// Rows of the tables, and computed values that no table has.
#[derive(Debug, Default)]
pub(super) struct BenchmarkRows {
    pub(super) all: Vec<BenchmarkRow>,
    pub(super) others: Vec<(String, f64)>,
    /// Values that must not exceed a bound.
    pub(super) bounds: Vec<(String, f64, f64)>,
}

impl BenchmarkRows {
    /// The tables of `tests/data/elements`.
    pub(super) fn tabled() -> Self {
        let mut all_rows = Vec::new();
        let gates = table("elements/gates.csv");
        let benchmarks = gates.text("benchmark");
        let quantities = gates.text("quantity");
        let meshes = gates.text("element and mesh");
        let targets = gates.text("accepted target");
        let accuracies = gates.text("accuracy gate");
        let values = gates.column("value (same formulation: within 1e-5)");
        for (k, &tabled) in values.iter().enumerate() {
            let target: Option<f64> = targets[k].parse().ok();
            let row = BenchmarkRow::new("gates", benchmarks[k], quantities[k], meshes[k], tabled);
            let target = target.map(|target| (target, accuracies[k].parse().ok()));
            all_rows.push(BenchmarkRow { target, ..row });
        }
        let shells = table("elements/containment.csv");
        let benchmarks = shells.text("benchmark");
        let quantities = shells.text("quantity");
        let masses = shells.text("mass");
        let meshes = shells.text("mesh around x (cylinder + dome)");
        for (k, &tabled) in shells.column("value").iter().enumerate() {
            let mesh = format!("{} {}", meshes[k], masses[k]);
            all_rows.push(BenchmarkRow::new(
                "containment",
                benchmarks[k],
                quantities[k],
                &mesh,
                tabled,
            ));
        }
        let raft = table("elements/raft.csv");
        let grounds = raft.text("ground");
        let solutions = raft.text("solution");
        let quantities = raft.text("quantity");
        for (k, &tabled) in raft.column("value").iter().enumerate() {
            if !solutions[k].starts_with("Shell4") {
                continue;
            }
            let is_winkler = grounds[k].starts_with("Winkler");
            let mut row =
                BenchmarkRow::new("raft", grounds[k], quantities[k], solutions[k], tabled);
            if !is_winkler && !has_cell_for_each_element(solutions[k]) {
                // Two elements a cell: the other program uses other means.
                row.tolerance = 1e-2;
            }
            row.target = raft_target(is_winkler, quantities[k], solutions[k]);
            all_rows.push(row);
        }
        let plates = table("elements/invariance.csv");
        let tests = plates.text("test");
        let elements = plates.text("element");
        for (k, &tabled) in plates.column("relative difference or ratio").iter().enumerate() {
            if !tests[k].starts_with("clamped square") {
                continue;
            }
            let mut row = BenchmarkRow::new("invariance", tests[k], "", elements[k], tabled);
            if tests[k].contains("1e-06") {
                // The ratio of shear and bending stiffness, 1e12 for the thinnest plate, costs digits.
                row.tolerance = 1e-3;
            }
            all_rows.push(row);
        }
        Self { all: all_rows, ..Self::default() }
    }

    /// The row of the tables with these names.
    pub(super) fn get(&self, benchmark: &str, quantity: &str, mesh: &str) -> Option<&BenchmarkRow> {
        self.all.iter().find(|row| row.has_names(benchmark, quantity, mesh))
    }

    /// Enters a value of the tables' `benchmark`, `quantity` and `mesh`.
    pub(super) fn put(&mut self, benchmark: &str, quantity: &str, mesh: &str, value: f64) {
        match self.all.iter_mut().find(|row| row.has_names(benchmark, quantity, mesh)) {
            Some(row) => {
                row.computed = Some(value);
                println!(
                    "{benchmark} | {quantity} | {mesh} | {value:.6e} | {:.6e} | {:.0e} | {} | {}",
                    row.tabled,
                    row.difference().unwrap_or(f64::NAN),
                    row.ratio().map_or(String::new(), |ratio| format!("{ratio:.4}")),
                    row.verdict()
                );
            }
            None => self.note(&format!("{benchmark} | {quantity} | {mesh}"), value),
        }
    }

    /// Enters a value that must not exceed a bound.
    pub(super) fn bound(&mut self, name: &str, value: f64, bound: f64) {
        let verdict = if value <= bound { "holds" } else { "ABOVE ITS BOUND" };
        println!("{name} | {value:.1e} | at most {bound:.0e} | {verdict}");
        self.bounds.push((name.to_owned(), value, bound));
    }

    /// Rows and bounds that fail, as text.
    pub(super) fn failed(&self) -> Vec<String> {
        let rows = self.all.iter().filter(|row| row.fails()).map(|row| {
            format!("{} | {} | {}: {}", row.benchmark, row.quantity, row.mesh, row.verdict())
        });
        let bounds = self.bounds.iter().filter(|(_, value, bound)| value > bound || value.is_nan());
        rows.chain(bounds.map(|(name, value, bound)| format!("{name}: {value:e} > {bound:e}")))
            .collect()
    }

    /// Rows without a value.
    ///
    /// Stresses of bricks from strains at the corner do not count: the crate extrapolates stresses from the Gauss points.
    pub(super) fn missing(&self) -> impl Iterator<Item = String> {
        self.all
            .iter()
            .filter(|row| row.computed.is_none() && row.quantity != "syy at D, at the corner, MPa")
            .map(|row| format!("{} | {} | {}: not computed", row.benchmark, row.quantity, row.mesh))
    }

    /// Enters a value that no table has.
    pub(super) fn note(&mut self, name: &str, value: f64) {
        println!("{name} | {value:.7e} | no table");
        self.others.push((name.to_owned(), value));
    }
}
