//! The adapters of a command, and what it says of those of no use.

use std::fmt::Display;

use anyhow::Context;

use crate::again::option;
use crate::output::complain;
use crate::replay::gpu::Adapters;

/// Adapters by parts of their names; all of them without one.
#[derive(clap::Args)]
pub(super) struct OnAdapters {
    /// Only adapters whose name contains this (repeatable); "gl" adds OpenGL's
    #[arg(long, value_name = "SUBSTRING")]
    adapter: Vec<String>,
}

impl OnAdapters {
    /// The adapters that were asked for, of which some work; of the others it is said why
    /// not.
    ///
    /// # Errors
    /// None works.
    pub(super) fn usable(&self) -> anyhow::Result<Adapters> {
        let found = adapters(&self.adapter)?;
        if found.open.is_empty() {
            return could_not_run(found.broken);
        }
        found.broken.iter().for_each(complain);
        Ok(found)
    }

    /// What a command must repeat to run on the same.
    pub(super) fn again(&self) -> impl Iterator<Item = String> {
        self.adapter.iter().map(|name| option("--adapter", name))
    }
}

/// The adapters that were asked for, and work or do not; all of them, if none was.
fn adapters(wanted: &[String]) -> anyhow::Result<Adapters> {
    let adapters = Adapters::open(wanted);
    let none = adapters.open.is_empty() && adapters.broken.is_empty();
    if none && wanted.is_empty() {
        anyhow::bail!("no adapter; `./x setup` installs two software drivers");
    }
    if none {
        let wanted = wanted.join(" or ");
        anyhow::bail!("no adapter is called {wanted}; see `triptych doctor`");
    }
    Ok(adapters)
}

/// Says of everything that a run could not do without why, a line each.
pub(super) fn could_not_run<T>(mut reasons: Vec<impl Display>) -> anyhow::Result<T> {
    let last = reasons.pop().context("no reason")?;
    for reason in reasons {
        complain(reason);
    }
    anyhow::bail!("{last}")
}
