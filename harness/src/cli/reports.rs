//! Where commands leave their results.

use std::path::PathBuf;

use crate::corpus;

/// The folder of the report and all beside it: `reports/out`, beside the corpus.
pub fn out() -> PathBuf {
    corpus::root().with_file_name("reports").join("out")
}

/// The report.
pub fn page() -> PathBuf {
    out().join("index.html")
}

/// The last run of all mutants, which the report shows.
pub fn mutants() -> PathBuf {
    out().join("mutants.json")
}

/// The folder of what `bench` measured.
pub fn bench() -> PathBuf {
    out().join("bench")
}
