//! `triptych list`.

use std::io::Write;

use super::Verdict;
use crate::{corpus, output};

#[derive(clap::Args)]
pub struct Args {
    /// Parts of scene names; all scenes without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    /// Patterns are whole names
    #[arg(long)]
    exact: bool,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let entries = corpus::list(&corpus::root())?;
    let selected = corpus::select(&entries, &args.patterns, args.exact)?;
    let width = selected.iter().map(|e| e.name.len()).max().unwrap_or(0);
    let mut out = output::stdout();
    for entry in &selected {
        let purpose = crate::scene::purpose(&entry.path)?;
        writeln!(out, "{:width$}  {purpose}", entry.name)?;
    }
    Ok(Verdict::Agree)
}
