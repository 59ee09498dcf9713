//! `triptych bundle`.

use std::io::Write;
use std::path::PathBuf;

use super::Verdict;
use super::scenes::Scenes;
use crate::bundle::bundle;
use crate::output::{complain, stdout};
use crate::{corpus, text};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bundle /tmp/triptych                 the whole corpus, and what bench reads beside\n  \
    triptych bundle /tmp/triptych raster/ bunny   some scenes\n\n\
    The other machine needs a C library as new as this one's, Vulkan's loader and a driver. \
    There, DIR/run replays everything; DIR/run COMMAND does what `triptych COMMAND` does here, \
    and `triptych report` here merges what `--json` wrote there.")]
pub struct Args {
    /// A folder that is new, or empty
    #[arg(value_name = "DIR")]
    to: PathBuf,
    #[command(flatten)]
    scenes: Scenes,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let entries = corpus::list(&corpus::root())?;
    let scenes = args.scenes.select(&entries)?;
    let bundled = bundle(&args.to, &scenes, scenes.len() == entries.len())?;
    bundled.remarks.iter().for_each(complain);
    let bytes: u64 = bundled.files.iter().map(|(_, bytes)| bytes).sum();
    writeln!(
        stdout(),
        "{}: {}, {} MB; copy it, and start {}/run there",
        args.to.display(),
        text::plural(bundled.files.len() as u64, "file"),
        bytes.div_ceil(1_000_000),
        args.to.display(),
    )?;
    Ok(Verdict::Agree)
}
