//! `triptych list`.

use std::io::Write;

use super::Verdict;
use super::scenes::Scenes;
use crate::{corpus, output};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let entries = corpus::list(&corpus::root())?;
    let selected = args.scenes.select(&entries)?;
    let width = selected.iter().map(|e| e.name.len()).max().unwrap_or(0);
    let mut out = output::stdout();
    for entry in &selected {
        let purpose = crate::scene::purpose(&entry.path)?;
        writeln!(out, "{:width$}  {purpose}", entry.name)?;
    }
    Ok(Verdict::Agree)
}
