//! `triptych add`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::FromArgMatches;

use super::{Verdict, replay};
use crate::add::{Added, New, add};
use crate::output::stdout;
use crate::{corpus, text};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych add knot.obj --purpose \"a knot whose strands touch\"\n  \
    triptych add my-scene/ --to raster/thin-walls\n\n\
    The scene is copied, replayed on every leg, and left with a pending snapshot, which \
    `cargo insta review` shows and accepts.")]
pub struct Args {
    /// A mesh, or a folder with a scene.toml and the meshes that it names
    #[arg(value_name = "MESH|FOLDER")]
    from: PathBuf,
    /// What the scene is called [default: abuffer/ and the file's name]
    #[arg(long, value_name = "FAMILY/CASE")]
    to: Option<String>,
    /// What the scene shows, in one sentence; a scene.toml says so itself
    #[arg(long, value_name = "SENTENCE")]
    purpose: Option<String>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let corpus = corpus::root();
    let Added { entry, files } = add(&corpus, &args.from, &args.scene()?)?;
    let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
    writeln!(
        stdout(),
        "corpus/{}: {}, and a row in corpus/README.md",
        entry.name,
        names.join(", ")
    )?;
    let verdict = replay::run(&replay_of(&entry.name)?)?;
    writeln!(
        stdout(),
        "\nLook at the report, edit {}, and replay it until it shows the point. Then\n  \
         cargo insta review                          accepts its snapshot\n  \
         ./x test --test scenes --test expect        holds it, from now on",
        entry.path.display()
    )?;
    Ok(verdict)
}

/// The replay of one scene, as a user would ask for it, that leaves its snapshot.
fn replay_of(scene: &str) -> anyhow::Result<replay::Args> {
    let command = <replay::Args as clap::Args>::augment_args(clap::Command::new("replay"));
    let words = ["replay", "--exact", "--no-cache", "--snapshot", scene];
    let matches = command.try_get_matches_from(words)?;
    Ok(replay::Args::from_arg_matches(&matches)?)
}

impl Args {
    fn scene(&self) -> anyhow::Result<New> {
        let (family, case) = match &self.to {
            Some(to) => match to.split_once('/') {
                Some((family, case)) => (family.to_owned(), case.to_owned()),
                None => anyhow::bail!("--to {}: FAMILY/CASE is expected", text::clean(to)),
            },
            None => ("abuffer".to_owned(), case_of(&self.from)),
        };
        Ok(New {
            family,
            case,
            purpose: self.purpose.clone(),
        })
    }
}

/// A file's name as a case: small letters and digits, with `-` between them.
fn case_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = if corpus::is_mesh(path) {
        name.split('.').next().unwrap_or_default()
    } else {
        &name
    };
    let words = stem.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|w| !w.is_empty()).collect();
    words.join("-").to_lowercase()
}
