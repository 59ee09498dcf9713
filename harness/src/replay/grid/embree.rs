//! Embree's vote on a grid's rays.

use std::time::Instant;

use triptych_spec::grid::trace::Query;

use super::spec::GridRun;
use crate::compare::embree::compare_kinds;
use crate::compare::{Judgement, compare};
use crate::embree::EmbreeError;
use crate::embree::rays::RayScene;
use crate::observe::{Embree, Observed, Spec};
use crate::rays::Kind;
use crate::replay::rows::Rows;
use crate::row::Class;
use crate::scene::file::Budget;

/// The share of rays that are drawn where Embree cannot tell: at edges, at corners, nearly along
/// planes, and those that end where they meet a triangle. Of others, as many as of any pairs. It is
/// what may be in class edge where a scene states nothing.
pub(super) fn drawn_for_edges(run: &GridRun) -> f64 {
    let (mut there, mut others) = (0.0, 0.0);
    let mut start = 0;
    for (kind, end) in Kind::ALL.into_iter().zip(run.ends) {
        for ray in run.rays[start..end].iter().filter(|ray| ray.moves()) {
            match kind {
                Kind::Edge | Kind::Vertex | Kind::Grazing => there += 1.0,
                Kind::Aimed if ray.segment => there += 1.0,
                Kind::Aimed | Kind::Random | Kind::Cell => others += 1.0,
            }
        }
        start = end;
    }
    (there + Budget::EDGE * others) / f64::max(there + others, 1.0)
}

/// Asks Embree of every ray, and adds a row for each query; `edge_budget` is the largest share
/// of rays in class edge.
pub(super) fn run(spec: &Observed<Spec, GridRun>, edge_budget: f64, rows: &mut Rows) {
    if let Err(error) = ask(spec, edge_budget, rows) {
        rows.fail("trace", &spec.label, "embree", None, error.to_string());
    }
}

fn ask(
    spec: &Observed<Spec, GridRun>,
    edge_budget: f64,
    rows: &mut Rows,
) -> Result<(), EmbreeError> {
    let scene = RayScene::new(&spec.value.blockers)?;
    let embree = Observed::<Embree, _>::new("embree", scene);
    for (query, name) in [(Query::Any, "any hit"), (Query::Closest, "closest hit")] {
        let start = Instant::now();
        let mut failed = None;
        let judgement = compare(spec, &embree, |spec, scene| {
            let GridRun { grid, blockers, .. } = spec;
            let vote = compare_kinds(grid, blockers, &spec.rays, kinds(spec), query, scene);
            match vote {
                Ok(vote) => {
                    let judgement = vote.judgement(Some(edge_budget));
                    let note = format!("{name}: {}", judgement.note);
                    Judgement { note, ..judgement }
                }
                Err(error) => {
                    failed = Some(error);
                    Judgement::new(Class::Vote, "rays")
                }
            }
        });
        if let Some(error) = failed {
            return Err(error);
        }
        let times = spec.map(|_| ()).taking(spec.value.times.trace);
        let seen = embree.map(|_| ()).taking(start.elapsed());
        rows.add("trace", &times, &seen, judgement);
    }
    Ok(())
}

/// Kinds of rays and where each ends; behind them, those that no scene file can draw.
fn kinds(spec: &GridRun) -> impl Iterator<Item = (&'static str, usize)> {
    let names = Kind::ALL.into_iter().map(Kind::name).chain(["own"]);
    names.zip(spec.ends.into_iter().chain([spec.rays.len()]))
}
