//! Our figures beside the paper's, as tables.

mod layouts;

use super::super::error::decibels;
use super::super::table::mebibytes;
use super::super::{Bench, Method, Row};
use super::{DRAGON, FIGURE, FIGURE_ALPHA, MECHA, SAMPLES, TABLE, TEAPOT};
use crate::text::clean;

pub(in crate::bench) use layouts::{LaidOut, laid_out};

/// A table with a heading.
pub struct Section {
    /// What it shows.
    pub heading: String,
    /// How to read it.
    pub note: &'static str,
    /// The first columns, which are words.
    pub names: usize,
    /// Of the columns.
    pub columns: Vec<String>,
    /// Cells.
    pub rows: Vec<Vec<String>>,
}

/// Nothing to show.
const NONE: &str = "–";

const TABLE_NOTE: &str = "*Over list*: the median of the frame, from its vertices to the picture, over that of \
    the same leg's linked lists (the faster of *insertion* and *sort*). *Paper's*: the same ratio of its frames per \
    second. The rows: *linked list*, one counter for all nodes; *precalc*, fragments counted, added up, and put into \
    runs of one array by a second pass over the triangles; *bucket depth peeling*, an array as long as the longest list \
    for each pixel; *depth peeling*, a pass over the triangles for each layer; *dual depth peeling*, nearest and farthest \
    at once; *lists by tiles*, the fastest of our three techniques that draw tile by tile. – stands for what the paper \
    has no figure of, or was not measured here: the list at the top says why.";

const FIGURE_NOTE: &str = "Only so many nearest layers of each pixel are shown, which costs time and takes error away. \
    *Over all*: the median of the frame over that of all layers; *paper's*: the same of its frames per second. PSNR in \
    decibels of linear colours against all layers, *exact* where nothing differs; *largest*: the largest difference of \
    a channel. Alpha blending blends the triangles as they come, whatever their depth.";

const SAMPLES_NOTE: &str = "Masks of what a triangle covers in the nodes, a surface for each sample, and the mean of the \
    samples. *Over one*: the median of the frame over that of one sample a pixel.";

const FRAMES_NOTE: &str = "*As fast*: the frame of the hardware's rasteriser with linked lists, over the row's. *Parts* \
    are medians in ms: *vertices* is transform, clip and snap; by tiles, *bin* puts triangles in bins, *place* counts \
    fragments, *fill* stores them, *local* draws without lists in memory.";

const MEMORY_NOTE: &str = "All buffers of a frame at once: triangles, surfaces, lists, picture. *Bytes/fragment*: of a \
    fragment that is stored, its colour included where it is; twice those of an entry where long lists are merged from \
    one array into another. *Bands* of rows are drawn one after another in the same buffers.";

/// The tables of the paper's scenes that were measured.
pub fn sections(bench: &Bench) -> Vec<Section> {
    let all = [table(bench), figure(bench), samples(bench), frames(bench)];
    let some = all
        .into_iter()
        .chain([layouts::table(bench), memory(bench)]);
    some.filter(|section| !section.rows.is_empty()).collect()
}

/// Legs of adapters.
fn legs(bench: &Bench) -> impl Iterator<Item = &str> {
    bench.legs().into_iter().filter(|leg| *leg != "spec")
}

fn ms(row: &Row) -> String {
    format!("{:.2}", row.whole())
}

fn ratio(value: Option<f64>) -> String {
    value.map_or_else(|| NONE.to_owned(), |value| format!("{value:.2}"))
}

fn columns(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Table 1: teapot and dragon, each technique over linked lists.
fn table(bench: &Bench) -> Section {
    let mut rows = Vec::new();
    for leg in legs(bench) {
        let lists = &TABLE[0];
        for technique in TABLE {
            let mut cells = vec![clean(leg).into_owned(), technique.name.to_owned()];
            // What the paper has and we do not keeps its place.
            let mut any = technique.fps.iter().any(Option::is_some);
            let mut measured = false;
            for (scene, at) in [(TEAPOT, 0), (DRAGON, 1)] {
                let best = |methods| bench.best((scene, leg), methods, None);
                let (own, list) = (best(technique.methods), best(lists.methods));
                any |= own.is_some();
                measured |= list.is_some();
                let over = own.zip(list).map(|(own, list)| own.whole() / list.whole());
                let fps = lists.fps[at].zip(technique.fps[at]);
                cells.push(own.map_or_else(|| NONE.to_owned(), ms));
                cells.push(ratio(over));
                cells.push(ratio(fps.map(|(list, own)| list / own)));
            }
            if any && measured {
                rows.push(cells);
            }
        }
    }
    Section {
        heading: "The paper's Table 1: teapot and dragon, 512 x 512, time of a frame over that of \
                  the same leg's linked lists"
            .to_owned(),
        note: TABLE_NOTE,
        names: 2,
        columns: columns(&[
            "leg",
            "technique",
            "teapot, ms",
            "over list",
            "paper's",
            "dragon, ms",
            "over list",
            "paper's",
        ]),
        rows,
    }
}

/// Figure 4 (a): numbers of layers, over all of them.
fn figure(bench: &Bench) -> Section {
    let lists = [Method::Insertion, Method::Sort];
    let (_, paper_all) = FIGURE[FIGURE.len() - 1];
    let mut rows = Vec::new();
    for leg in legs(bench) {
        let Some(all) = bench.best((MECHA, leg), &lists, None) else {
            continue;
        };
        let mut add = |what: String, row: Option<&Row>, paper: f64| {
            if let Some(row) = row {
                rows.push(vec![
                    clean(leg).into_owned(),
                    what,
                    ms(row),
                    format!("{:.0}", 1000.0 / row.whole()),
                    ratio(Some(row.whole() / all.whole())),
                    ratio(Some(paper_all / paper)),
                    decibels(row.psnr),
                    format!("{:.1e}", row.largest),
                ]);
            }
        };
        let alpha = bench.best((MECHA, leg), &[Method::Alpha], None);
        add("alpha blending".to_owned(), alpha, FIGURE_ALPHA);
        for (layers, paper) in FIGURE {
            let shown = (layers < all.longest).then_some(layers);
            let row = bench.best((MECHA, leg), &lists, shown);
            let what = match shown {
                Some(layers) => layers.to_string(),
                None => format!("{layers}, all {}", all.longest),
            };
            add(what, row, paper);
        }
    }
    Section {
        heading: "The paper's Figure 4: the stand-in for its mecha, 1280 x 720, time of a frame \
                  over that of all layers"
            .to_owned(),
        note: FIGURE_NOTE,
        names: 2,
        columns: columns(&[
            "leg", "layers", "time, ms", "frames/s", "over all", "paper's", "PSNR, dB", "largest",
        ]),
        rows,
    }
}

/// Samples a pixel, over one.
fn samples(bench: &Bench) -> Section {
    let lists = [Method::Insertion, Method::Sort];
    let one = SAMPLES[0].1;
    let mut rows = Vec::new();
    for (leg, (name, methods)) in legs(bench).flat_map(|leg| {
        [("linked list", &lists[..]), ("tiles", &Method::BY_TILES)].map(|m| (leg, m))
    }) {
        let with = |count: u32| {
            let own = bench.rows.iter().filter(|row| row.samples == count);
            let scene = own
                .map(|row| &row.scene)
                .find(|name| name.starts_with(DRAGON));
            scene.and_then(|scene| bench.best((scene, leg), methods, None))
        };
        let Some(single) = with(1) else { continue };
        for (count, fps) in SAMPLES {
            if let Some(row) = with(count) {
                let paper = one.zip(fps).filter(|_| name != "tiles");
                rows.push(vec![
                    clean(leg).into_owned(),
                    name.to_owned(),
                    count.to_string(),
                    ms(row),
                    ratio(Some(row.whole() / single.whole())),
                    ratio(paper.map(|(one, own)| one / own)),
                    mebibytes(row.memory),
                ]);
            }
        }
    }
    rows.retain(|_| bench.rows.iter().any(|row| row.samples > 1));
    Section {
        heading: "Samples a pixel: the dragon, 512 x 512, over the same with one sample".to_owned(),
        note: SAMPLES_NOTE,
        names: 3,
        columns: columns(&[
            "leg",
            "technique",
            "samples",
            "time, ms",
            "over one",
            "paper's",
            "memory",
        ]),
        rows,
    }
}

/// Whole frames: the hardware's path beside ours.
fn frames(bench: &Bench) -> Section {
    let lists = [Method::Insertion, Method::Sort];
    let mut rows = Vec::new();
    for scene in [DRAGON, MECHA] {
        for hardware in legs(bench).filter(|leg| leg.ends_with("/fragment")) {
            let Some(own) = bench.best((scene, hardware), &lists, None) else {
                continue;
            };
            let adapter = hardware.trim_end_matches("fragment");
            for leg in legs(bench).filter(|leg| leg.starts_with(adapter)) {
                for (name, methods) in [("linked list", &lists[..]), ("tiles", &Method::BY_TILES)] {
                    let Some(row) = bench.best((scene, leg), methods, None) else {
                        continue;
                    };
                    let parts = row.parts.iter().map(|(name, ms)| format!("{name} {ms:.2}"));
                    let before = row.frame.map(|frame| frame.median - row.time.median);
                    let before = before.map(|ms| format!("vertices {ms:.2}"));
                    let parts: Vec<String> = before.into_iter().chain(parts).collect();
                    rows.push(vec![
                        clean(leg).into_owned(),
                        format!("{scene}, {name}"),
                        ms(row),
                        ratio(Some(own.whole() / row.whole())),
                        parts.join(", "),
                    ]);
                }
            }
        }
    }
    Section {
        heading: "Whole frames, from vertices to the picture of all layers: how many times as \
                  fast as the hardware's path with linked lists"
            .to_owned(),
        note: FRAMES_NOTE,
        names: 2,
        columns: columns(&["leg", "scene", "time, ms", "as fast", "parts, ms"]),
        rows,
    }
}

/// What each technique holds.
fn memory(bench: &Bench) -> Section {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let whole = |row: &&Row| row.layers >= row.longest && row.samples == 1;
    for scene in [DRAGON, MECHA] {
        let own = bench.rows.iter().filter(|row| row.scene == scene);
        for row in own.filter(whole).filter(|row| row.leg != "spec") {
            let cells = vec![
                scene.to_owned(),
                row.method.name().to_owned(),
                mebibytes(row.memory),
                row.of_fragment
                    .map_or_else(|| NONE.to_owned(), |bytes| bytes.to_string()),
                row.bands.to_string(),
            ];
            // Most are the same on all legs.
            if !rows.contains(&cells) {
                rows.push(cells);
            }
        }
    }
    Section {
        heading: "Memory at most, and of a stored fragment".to_owned(),
        note: MEMORY_NOTE,
        names: 2,
        columns: columns(&["scene", "technique", "memory", "bytes/fragment", "bands"]),
        rows,
    }
}

#[cfg(test)]
mod tests;
