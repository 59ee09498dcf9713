//! The same lists laid out otherwise: time of building and of what is made of them, bytes, error.

use super::{NONE, Section, columns, legs, ratio};
use crate::bench::error::decibels;
use crate::bench::table::mebibytes;
use crate::bench::{Bench, Method, Row};
use crate::text::clean;

/// What stands for each layout: the fastest of these.
const ALL: [&[Method]; 9] = [
    &LISTS,
    &[Method::Regions],
    &[Method::Packed],
    &[Method::Ordered],
    &[Method::Linked],
    &[Method::Precalc],
    &[Method::Bucket],
    &[Method::Tiles],
    &[Method::Local],
];

/// Linked lists with one counter.
const LISTS: [Method; 2] = [Method::Insertion, Method::Sort];

const NOTE: &str = "The same fragments of one view, stored in several ways; lists and pictures were compared before \
    and after. *Build* is what makes lists, or bins of triangles, from snapped triangles; *resolve* puts layers in order \
    and blends them; each is the sum of its parts' medians, and *over list* that over the linked list's of the same leg. \
    *Node*: what holds a fragment. *B/fragment*: bytes of it, where arrays are merged those of both; *wanted*: the most \
    that they were to be, 16 of linked nodes and 8 of arrays. *Memory*: all buffers of a frame at once. *PSNR* and \
    *largest* difference are from the exact picture: colours of a byte a channel are an approximation.\n\n\
    *insertion*, *sort*: linked lists, one counter for all nodes, colours of full precision beside them; on the fragment \
    path they alone are built behind a test of depth, where the adapter has one and something is opaque. *regions*: the \
    same with 64 counters, each with nodes of its own. *packed*: nodes of 16 bytes with a byte for each channel; heads \
    need no clearing. *ordered*: in order while they are built, by atomic minima. *linked*: by tiles of 8 x 8 pixels, \
    a counter for each. *precalc*: counted first, then runs of one array. *bucket*: an array as long as the longest list \
    for each pixel. *tiles*: runs by tiles, entries of a row of lists side by side. *local*: no lists in memory, but \
    where a tile needs them.";

/// What was measured of a scene, leg by leg: a row for each layout, linked lists first.
pub(in crate::bench) struct LaidOut<'b> {
    pub(in crate::bench) scene: &'b str,
    pub(in crate::bench) legs: Vec<(&'b str, Vec<&'b Row>)>,
}

/// The scenes that have layouts beside linked lists.
pub(in crate::bench) fn laid_out(bench: &Bench) -> Vec<LaidOut<'_>> {
    let mut scenes = bench.scenes();
    scenes.retain(|scene| {
        let mut own = bench.rows.iter().filter(|row| row.scene == *scene);
        own.any(|row| row.method.layout().is_some())
    });
    let of = |scene| {
        let rows = |leg| {
            let row = |methods: &&[Method]| bench.best((scene, leg), methods, None);
            let rows: Vec<&Row> = ALL.iter().filter_map(row).collect();
            let with_lists = rows.first().is_some_and(|row| row.method.has_lists());
            with_lists.then_some((leg, rows))
        };
        LaidOut {
            scene,
            legs: legs(bench).filter_map(rows).collect(),
        }
    };
    scenes.into_iter().map(of).collect()
}

/// Layouts of each scene that has some beside linked lists, leg by leg.
pub(super) fn table(bench: &Bench) -> Section {
    let all = laid_out(bench);
    let legs = all.iter().flat_map(|own| &own.legs);
    let rows = legs.flat_map(|(_, rows)| rows.iter().map(|row| cells(row, rows[0])));
    Section {
        heading:
            "Layouts and formats of nodes: the same lists, time of building them and of what is \
                  made of them"
                .to_owned(),
        note: NOTE,
        names: 3,
        rows: rows.collect(),
        columns: columns(&[
            "leg",
            "scene, layout",
            "node",
            "build, ms",
            "over list",
            "resolve, ms",
            "over list",
            "memory",
            "B/fragment",
            "wanted",
            "PSNR, dB",
            "largest",
        ]),
    }
}

fn cells(row: &Row, list: &Row) -> Vec<String> {
    let over = |own: f64, list: f64| ratio((list > 0.0).then(|| own / list));
    let wanted = row.method.most_of_fragment().zip(row.of_fragment);
    let wanted = wanted.map(|(most, bytes)| match bytes <= most {
        true => format!("{most}: met"),
        false => format!("{most}: not met"),
    });
    let none = || NONE.to_owned();
    vec![
        clean(&row.leg).into_owned(),
        format!("{}, {}", clean(&row.scene), row.method.name()),
        row.method.node().unwrap_or(NONE).to_owned(),
        format!("{:.2}", row.build()),
        over(row.build(), list.build()),
        format!("{:.2}", row.resolve()),
        over(row.resolve(), list.resolve()),
        mebibytes(row.memory),
        row.of_fragment.map_or_else(none, |bytes| bytes.to_string()),
        wanted.unwrap_or_else(none),
        decibels(row.psnr),
        format!("{:.1e}", row.largest),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::bench_example;

    /// A leg with linked lists and two other layouts; the list is built in 4 ms and blended in 2.
    fn bench() -> Bench {
        let mut bench = bench_example();
        let example = bench.rows[0].clone();
        let row = |method, build, blend, bytes, psnr| Row {
            leg: "gpu@a/compute".to_owned(),
            method,
            layers: 4,
            parts: vec![
                ("opaque".to_owned(), 9.0),
                ("build".to_owned(), build),
                ("sort".to_owned(), 0.5),
                ("blend".to_owned(), blend),
            ],
            of_fragment: Some(bytes),
            psnr,
            ..example.clone()
        };
        bench.rows = vec![
            row(Method::Sort, 4.0, 1.5, 32, None),
            row(Method::Packed, 2.0, 3.5, 16, Some(51.0)),
            row(Method::Precalc, 8.0, 0.5, 8, None),
        ];
        bench
    }

    #[test]
    fn each_part_is_over_the_lists() {
        let section = table(&bench());
        let of = |at: usize| section.rows[at][3..].join(" ");
        assert_eq!(
            of(0),
            "4.00 1.00 2.00 1.00 1.0 MiB 32 16: not met exact 2.5e-1"
        );
        assert_eq!(of(1), "2.00 0.50 4.00 2.00 1.0 MiB 16 16: met 51.0 2.5e-1");
        assert_eq!(of(2), "8.00 2.00 1.00 0.50 1.0 MiB 8 8: met exact 2.5e-1");
        assert_eq!(section.rows.len(), 3);
        assert!(
            section
                .rows
                .iter()
                .all(|row| row.len() == section.columns.len())
        );
    }

    #[test]
    fn lists_alone_are_no_layouts() {
        let mut bench = bench();
        bench.rows.truncate(1);
        assert!(table(&bench).rows.is_empty());
    }
}
