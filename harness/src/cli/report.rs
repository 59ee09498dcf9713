//! `triptych report`.

use std::path::PathBuf;

use super::Verdict;

#[derive(clap::Args)]
pub struct Args {
    /// JSON lines written by `replay --json`
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Where the report goes
    #[arg(long, value_name = "FILE", default_value = "reports/out/index.html")]
    output: PathBuf,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let _ = args;
    anyhow::bail!("report: being wired")
}
