//! Studies of basemat: the sources of the tables and figures of its documents, one subcommand each.
//!
//! ```text
//! cargo study                          # lists them
//! cargo study validation --short       # one of them
//! cargo study validation --help        # its options
//! ```
//!
//! `cargo study` is short for `cargo run --release -p basemat-studies --`. Files go to a folder of the study's
//! name under `target/study`; with `--docs docs` tables and pictures go between the markers of the documents.

mod artificial_motion;
mod contact_chatter;
mod contact_cost;
mod contact_problems;
mod containment;
mod document;
mod elements;
mod embedded;
mod fiber_cost;
mod figure;
mod fragility;
mod full_plane;
mod history;
mod incoherence;
mod key;
mod layered_accuracy;
mod layered_cost;
mod mats;
mod near_field;
mod opensees;
mod paper_readings;
mod paper_scheme;
mod passivity;
mod performance;
mod precision;
mod rocking_footing;
mod settling_cost;
mod stability;
mod trench_cost;
mod validation;
mod yielding;

use std::process::ExitCode;

use clap::Parser;

use document::AnyError;

/// Studies that make the tables and figures of basemat's documents.
#[derive(Debug, Parser)]
#[command(bin_name = "cargo study")]
enum Study {
    Validation(validation::ValidationOptions),
    Precision(precision::PrecisionOptions),
    Stability(stability::StabilityOptions),
    Performance(performance::PerformanceOptions),
    Containment(containment::ContainmentOptions),
    PaperReadings(paper_readings::PaperReadingsOptions),
    PaperScheme(paper_scheme::PaperSchemeOptions),
    FullPlane(full_plane::FullPlaneOptions),
    FiberCost(fiber_cost::FiberCostOptions),
    Fragility(fragility::FragilityOptions),
    Opensees(opensees::OpenseesOptions),
    Passivity(passivity::PassivityOptions),
    ContactChatter(contact_chatter::ContactChatterOptions),
    ContactCost(contact_cost::ContactCostOptions),
    ContactProblems(contact_problems::ContactProblemsOptions),
    HistoryCost(history::CostOptions),
    HistoryExponentials(history::ExponentialsOptions),
    Incoherence(incoherence::IncoherenceOptions),
    LayeredAccuracy(layered_accuracy::LayeredAccuracyOptions),
    LayeredCost(layered_cost::LayeredCostOptions),
    Mats(mats::MatsOptions),
    Elements(elements::ElementsOptions),
    Embedded(embedded::EmbeddedOptions),
    NearField(near_field::NearFieldOptions),
    RockingFooting(rocking_footing::RockingFootingOptions),
    SettlingCost(settling_cost::SettlingCostOptions),
    TrenchCost(trench_cost::TrenchCostOptions),
    Yielding(yielding::YieldingOptions),
}

fn main() -> ExitCode {
    let outcome = match Study::parse() {
        Study::Validation(options) => validation::run(&options),
        Study::Precision(options) => precision::run(&options),
        Study::Stability(options) => stability::run(&options),
        Study::Performance(options) => performance::run(&options),
        Study::Containment(options) => containment::run(&options),
        Study::PaperReadings(options) => paper_readings::run(options),
        Study::PaperScheme(options) => paper_scheme::run(&options),
        Study::FullPlane(options) => full_plane::run(&options),
        Study::FiberCost(options) => fiber_cost::run(&options),
        Study::Fragility(options) => fragility::run(&options),
        Study::Opensees(options) => opensees::run(&options),
        Study::Passivity(options) => {
            passivity::run(&options);
            Ok(())
        }
        Study::ContactChatter(options) => contact_chatter::run(&options),
        Study::ContactCost(options) => contact_cost::run(&options),
        Study::ContactProblems(options) => contact_problems::run(&options),
        Study::HistoryCost(options) => history::cost(&options),
        Study::HistoryExponentials(options) => history::exponentials(&options),
        Study::Incoherence(options) => incoherence::run(&options),
        Study::LayeredAccuracy(options) => layered_accuracy::run(&options),
        Study::LayeredCost(options) => layered_cost::run(&options),
        Study::Mats(options) => mats::run(&options),
        Study::Elements(options) => elements::run(&options),
        Study::Embedded(options) => embedded::run(&options),
        Study::NearField(options) => near_field::run(&options),
        Study::RockingFooting(options) => rocking_footing::run(&options),
        Study::SettlingCost(options) => settling_cost::run(&options),
        Study::TrenchCost(options) => trench_cost::run(&options),
        Study::Yielding(options) => yielding::run(&options),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        // As text, for example the names of missing shards.
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
