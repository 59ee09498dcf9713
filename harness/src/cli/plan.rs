//! `triptych plan`.

use std::io::Write;

use super::Verdict;
use crate::replay::passes;
use crate::scene::load_entry;
use crate::{corpus, output};

#[derive(clap::Args)]
pub struct Args {
    /// Scenes, as for `replay`
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<String>,
    /// Patterns are whole names
    #[arg(long)]
    exact: bool,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let entries = corpus::list(&corpus::root())?;
    let mut out = output::stdout();
    for entry in corpus::select(&entries, &args.scenes, args.exact)? {
        let loaded = load_entry(&entry, None)?;
        let triangles = loaded.scene.triangles.len();
        writeln!(out, "{}: {triangles} triangles", entry.name)?;
        for remark in loaded.stats.remarks() {
            writeln!(out, "  note  {remark}")?;
        }
        for pass in passes(&loaded, true) {
            let what = if pass.runs { "run " } else { "skip" };
            writeln!(out, "  {what}  {:10}  {}", pass.name, pass.reason)?;
        }
    }
    Ok(Verdict::Agree)
}
