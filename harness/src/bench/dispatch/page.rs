//! What was measured, as lines on a terminal and as a page.

use std::fmt::Write;

use super::claims::claims;
use super::{Measured, Method, Row};

/// A line for each method of a scene, with frames per second for each number of threads.
pub fn lines(measured: &Measured) -> Vec<String> {
    let mut lines = Vec::new();
    let threads = measured.threads();
    for scene in measured.scenes() {
        let rows: Vec<&Row> = measured.rows.iter().filter(|r| r.scene == scene).collect();
        let first = rows[0];
        lines.push(format!(
            "{scene}, {} x {}, {} triangles, {} rays a frame; frames a second with so many threads",
            first.size[0], first.size[1], first.triangles, first.rays
        ));
        let heads = threads.iter().map(|t| format!("{t:>9}"));
        lines.push(format!("  {:<16}{}", "", heads.collect::<String>()));
        for method in methods(&rows) {
            let own = |threads: &usize| {
                let row = rows
                    .iter()
                    .find(|r| r.method == method && r.threads == *threads);
                row.map_or_else(
                    || format!("{:>9}", ""),
                    |r| format!("{:>9.2}", r.fps.median),
                )
            };
            let values: String = match method {
                Method::Board(_) => board(&rows, method),
                _ => threads.iter().map(own).collect(),
            };
            lines.push(format!("  {:<16}{values}", measured.name(method)));
        }
    }
    lines
}

/// What a board does has no threads.
fn board(rows: &[&Row], method: Method) -> String {
    let row = rows.iter().find(|r| r.method == method);
    row.map_or_else(String::new, |r| {
        format!(
            "{:>9.2}  ({:.1} M rays/s)",
            r.fps.median,
            1e-6 * r.rays_per_second()
        )
    })
}

/// Methods of some rows, in their order.
fn methods(rows: &[&Row]) -> Vec<Method> {
    let mut methods: Vec<Method> = rows.iter().map(|row| row.method).collect();
    methods.dedup();
    methods
}

/// The page.
pub fn page(measured: &Measured) -> String {
    let Measured {
        date,
        machine,
        frames,
        runs,
        ..
    } = measured;
    let mut text = format!(
        "# Work queues and a ray tracer, {date}\n\n\
         {}, {} cores, {}, {}.\n\n\
         {runs} runs of {frames} frames each (the paper: 3 of 200), after one frame of each that does not count; every \
         round runs every method with every number of threads once, every other round backwards. Frames a \
         second are medians of the runs, with the smallest and the largest; speed-up is over the sequential \
         version of the same round. Idle time is a thread's in a frame, on average; access time is that of all \
         threads together; both are of runs of their own, since looking at the clock takes time. The last picture of each run \
         was the spec's to the bit; a GPU's within the bounds of the spec's light, one of floats under a spin lock within their \
         roundings, Embree's in 99 % of pixels. While threads work on a frame, one more makes the rays of the next; a GPU puts \
         the triangles into cells anew in each frame.\n\n",
        machine.cpu, machine.cores, machine.system, machine.version
    );
    text += "| method | what it is |\n|---|---|\n";
    let all: Vec<&Row> = measured.rows.iter().collect();
    let mut shown: Vec<Method> = methods(&all);
    shown.sort_unstable();
    shown.dedup();
    for method in shown {
        let _ = writeln!(text, "| {} | {} |", measured.name(method), method.words());
    }
    text += "\n## The paper's claims\n\n| claim | holds here | figures |\n|---|---|---|\n";
    for claim in claims(measured) {
        let holds = match claim.holds {
            Some(true) => "yes",
            Some(false) => "no",
            None => "cannot be told",
        };
        let _ = writeln!(text, "| {} | {holds} | {} |", claim.says, claim.seen);
    }
    text += &endings(measured);
    for scene in measured.scenes() {
        text += &table(measured, scene);
    }
    if !measured.remarks.is_empty() {
        text += "\n## Remarks\n\n";
        for remark in &measured.remarks {
            let _ = writeln!(text, "- {remark}");
        }
    }
    text
}

/// What it makes of a frame that threads stay until no task is left.
fn endings(measured: &Measured) -> String {
    let mut text = String::from(
        "\n## When a frame is over\n\n\
         As in the paper a thread leaves a frame when it finds the queue empty; counted, it stays until no task is left. \
         Frames a second, counted over as in the paper, and a thread's idle time in a frame.\n\n\
         | scene | queue | threads | frames/s | idle, ms | counted |\n|---|---|---:|---:|---:|---:|\n",
    );
    let mut any = false;
    for scene in measured.scenes() {
        for [empty, counted] in Method::ENDINGS {
            for threads in measured.threads() {
                let of = |method| measured.row(scene, method, threads);
                let (Some(empty), Some(counted)) = (of(empty), of(counted)) else {
                    continue;
                };
                any = true;
                let idle = |row: &Row| {
                    row.spent
                        .map_or_else(String::new, |s| format!("{:.3}", s.idle))
                };
                let _ = writeln!(
                    text,
                    "| {scene} | {} | {threads} | {:.2} | {} | {} |",
                    empty.method.name(),
                    counted.fps.median / empty.fps.median,
                    idle(empty),
                    idle(counted)
                );
            }
        }
    }
    if any { text } else { String::new() }
}

/// A scene's rows.
fn table(measured: &Measured, scene: &str) -> String {
    let rows: Vec<&Row> = measured.rows.iter().filter(|r| r.scene == scene).collect();
    let first = rows[0];
    let mut text = format!(
        "\n## {scene}\n\n{} x {} pixels, {} triangles, {} rays a frame.\n\n\
         | method | threads | frames/s | smallest | largest | speed-up | M rays/s | idle, ms | access, ms |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        first.size[0], first.size[1], first.triangles, first.rays
    );
    for row in rows {
        let spent = |of: fn(super::Spent) -> f64| {
            row.spent
                .map_or_else(String::new, |s| format!("{:.3}", of(s)))
        };
        let threads = match row.threads {
            0 => "-".to_owned(),
            threads => threads.to_string(),
        };
        let _ = writeln!(
            text,
            "| {} | {threads} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {} | {} |",
            measured.name(row.method),
            row.fps.median,
            row.fps.min,
            row.fps.max,
            row.speed_up.median,
            1e-6 * row.rays_per_second(),
            spent(|s| s.idle),
            spent(|s| s.access)
        );
    }
    text
}
