//! `triptych doctor`.

use std::io::Write;

use super::Verdict;
use crate::calibrate::Grid;
use crate::mutants::Lab;
use crate::replay::gpu::{Adapter, Adapters};
use crate::{corpus, embree, findings, mesh, output};

/// What the project found out the hard way, and no kernel can show: the others are
/// [`findings`].
const KNOWN: [(&str, &str); 2] = [
    (
        "llvmpipe",
        "answers timestamps around compute passes with moments at which nothing was computed",
    ),
    (
        "-gl",
        "naga's GLSL does not compile the sample mask as a fragment input",
    ),
];

pub fn run() -> anyhow::Result<Verdict> {
    let mut out = output::stdout();
    let adapters = Adapters::open(&[]);
    list(&mut out, &adapters)?;
    let usable = adapters.broken.is_empty();
    let mut complete = !(adapters.open.is_empty() && usable);
    let as_found = findings(&mut out, adapters.open)?;
    complete &= embree(&mut out)?;
    complete &= meshes(&mut out)?;
    parts(&mut out)?;
    let last = match (complete, usable, as_found) {
        (false, ..) => "Something is missing; `./x setup` installs it.",
        (true, false, _) => "Not every adapter can be used; a replay goes on with the others.",
        (true, true, false) => "A finding is not as it was found.",
        (true, true, true) => "All legs can run.",
    };
    writeln!(out, "\n{last}")?;
    Ok(if complete && usable && as_found {
        Verdict::Agree
    } else {
        Verdict::Diverge
    })
}

fn list(out: &mut impl Write, Adapters { open, broken }: &Adapters) -> anyhow::Result<()> {
    writeln!(out, "Adapters")?;
    if open.is_empty() && broken.is_empty() {
        writeln!(out, "  none; `./x setup` installs two software drivers")?;
    }
    for adapter in open {
        let Adapter { gpu, grid, .. } = adapter;
        let info = &gpu.info;
        writeln!(out, "  {}: {}, {:?}", gpu.name, info.name, info.backend)?;
        writeln!(out, "    driver {} {}", info.driver, info.driver_info)?;
        let limit = gpu.binding_limit() >> 20;
        let int64 = if gpu.has_int64() {
            "64-bit integers"
        } else {
            "no 64-bit integers"
        };
        let early = if gpu.tests_depth_early(1) {
            "early depth test"
        } else {
            "no early depth test"
        };
        writeln!(out, "    binding at most {limit} MiB, {int64}, {early}")?;
        match grid {
            Grid::Bits(bits) => writeln!(out, "    sub-pixel grid 1/{}", 1 << bits)?,
            Grid::Unknown => writeln!(out, "    sub-pixel grid unknown: compared by a band")?,
        }
        writeln!(out, "    {}", adapter.samples_in_words())?;
        for (_, bug) in KNOWN.iter().filter(|(name, _)| gpu.name.contains(name)) {
            writeln!(out, "    known: {bug}")?;
        }
    }
    for broken in broken {
        writeln!(out, "  {broken}")?;
    }
    Ok(())
}

/// Runs what drivers were found to do wrong, and says whether they still do, and no
/// others.
fn findings(out: &mut impl Write, open: Vec<Adapter>) -> anyhow::Result<bool> {
    let findings = match findings::list(&corpus::root()) {
        Ok(findings) => findings,
        Err(error) => {
            writeln!(out, "Findings\n  cannot be read: {error}")?;
            return Ok(false);
        }
    };
    if findings.is_empty() || open.is_empty() {
        return Ok(true);
    }
    writeln!(out, "Findings")?;
    let mut lab = Lab::new(open);
    let mut all = true;
    for finding in &findings {
        let (name, known) = (&finding.case.name, &finding.known);
        let cells = match lab.run(&finding.case) {
            Ok(cells) => cells,
            Err(error) => {
                all = false;
                writeln!(out, "  {name}: cannot be run: {error}")?;
                continue;
            }
        };
        let seen = cells.iter().filter(|c| c.outcome.kills());
        let seen: Vec<&str> = seen.map(|c| c.leg.as_str()).collect();
        let seen = match seen.is_empty() {
            true => "on no adapter here".to_owned(),
            false => format!("seen on {}", seen.join(", ")),
        };
        writeln!(out, "  {name}: {known}; {seen}")?;
        for wrong in finding.judge(&cells) {
            all = false;
            writeln!(out, "    {wrong}")?;
        }
    }
    Ok(all)
}

fn embree(out: &mut impl Write) -> anyhow::Result<bool> {
    writeln!(out, "Embree")?;
    match embree::library() {
        Ok(library) => {
            writeln!(out, "  {library}")?;
            Ok(true)
        }
        Err(error) => {
            writeln!(out, "  {error}")?;
            Ok(false)
        }
    }
}

fn meshes(out: &mut impl Write) -> anyhow::Result<bool> {
    let folder = corpus::meshes();
    writeln!(out, "Meshes in {}", folder.display())?;
    let mut all = true;
    for row in mesh::lock::read(&mut mesh::Intake::from_disk())? {
        let state = if folder.join(&row.name).is_file() {
            "present"
        } else {
            "missing"
        };
        all &= state == "present";
        writeln!(out, "  {state}  {} ({})", row.name, row.origin)?;
    }
    Ok(all)
}

/// What set-up noted about the parts that it installed or found.
fn parts(out: &mut impl Write) -> anyhow::Result<()> {
    if let Ok(versions) = std::fs::read_to_string(corpus::native().join("versions")) {
        writeln!(out, "Parts")?;
        for line in versions.lines() {
            writeln!(out, "  {line}")?;
        }
    }
    Ok(())
}
