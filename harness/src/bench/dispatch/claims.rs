//! What the paper claims of its queues (section 5.2), and what of it holds here.

use std::cmp::Ordering;

use super::{Measured, Method, Row};

/// The scene for which work cannot be dealt evenly beforehand.
const UNEVEN: &str = "dispatch/uneven";

/// The paper's cores, of which it used a thread each.
const CORES: usize = 24;

/// LOCAL's access time is negligible beside the others' if it is a smaller part of them.
const NEGLIGIBLE: f64 = 0.1;

/// What is said where there are no figures.
const NOT_MEASURED: &str = "not measured";

/// A claim and what was seen.
pub(super) struct Claim {
    /// In the paper's words, shortened.
    pub(super) says: &'static str,
    /// Whether it holds; `None` if it cannot be told from these rows.
    pub(super) holds: Option<bool>,
    /// The figures.
    pub(super) seen: String,
}

/// All of them.
pub(super) fn claims(measured: &Measured) -> Vec<Claim> {
    vec![
        best(measured),
        idles(measured),
        alike(measured),
        ahead(measured),
        grows(measured),
        efficiency(measured),
        uneven(measured),
    ]
}

/// The paper's kind of scenes.
fn even(measured: &Measured) -> Vec<&str> {
    let mut scenes = measured.scenes();
    scenes.retain(|scene| *scene != UNEVEN);
    scenes
}

/// Rows of the paper's queues on a scene with so many threads: LOCK, LFREE, LOCAL.
fn three<'m>(measured: &'m Measured, scene: &str, threads: usize) -> Option<[&'m Row; 3]> {
    let [lock, lfree, local] = Method::PAPERS.map(|m| measured.row(scene, m, threads));
    Some([lock?, lfree?, local?])
}

/// The same of all scenes of the paper's kind and all numbers of threads.
fn all(measured: &Measured) -> Vec<(usize, [&Row; 3])> {
    let threads = measured.threads();
    let scenes = even(measured).into_iter();
    let pairs = scenes.flat_map(|scene| threads.iter().map(move |t| (scene, *t)));
    pairs
        .filter_map(|(scene, threads)| Some((threads, three(measured, scene, threads)?)))
        .collect()
}

fn best(measured: &Measured) -> Claim {
    let all = all(measured);
    let beside = |(_, [lock, lfree, local]): &(usize, [&Row; 3])| {
        let better = [local.beside(lock), local.beside(lfree)];
        let behind = better.contains(&Some(Ordering::Less));
        let ahead = better == [Some(Ordering::Greater); 2];
        let lead = local.fps.median / lock.fps.median.max(lfree.fps.median) - 1.0;
        (ahead, behind, lead)
    };
    let told: Vec<(bool, bool, f64)> = all.iter().map(beside).collect();
    let ahead = told.iter().filter(|(ahead, ..)| *ahead).count();
    let behind = told.iter().filter(|(_, behind, _)| *behind).count();
    let leads = || told.iter().map(|(.., lead)| *lead);
    Claim {
        says: "N23: LOCAL outperforms the other two under all settings",
        holds: verdict(!told.is_empty() && ahead == told.len(), behind > 0),
        seen: match told.len() {
            0 => NOT_MEASURED.to_owned(),
            settings => format!(
                "ahead of both in {ahead} of {settings} settings, behind one in {behind}, else the same as far as runs \
                 tell; {:+.0} % to {:+.0} % of the better of the two",
                100.0 * leads().fold(f64::INFINITY, f64::min),
                100.0 * leads().fold(f64::NEG_INFINITY, f64::max)
            ),
        },
    }
}

/// Yes or no where one of them was seen.
fn verdict(yes: bool, no: bool) -> Option<bool> {
    (yes || no).then_some(!no)
}

fn idles(measured: &Measured) -> Claim {
    let cores = measured.machine.cores;
    // More threads than cores wait for each other, whatever the queue.
    let own = |t: &usize| (2..=cores).contains(t);
    let threads = measured.threads().into_iter().filter(own);
    let threads = threads.max().unwrap_or(0);
    let idle = |row: &Row| row.spent.map_or(0.0, |spent| spent.idle);
    let access = |row: &Row| row.spent.map_or(0.0, |spent| spent.access);
    let rows = all(measured);
    let rows: Vec<_> = rows.iter().filter(|(t, _)| *t == threads).collect();
    let as_told = rows.iter().filter(|(_, [lock, lfree, local])| {
        let least = access(lock).min(access(lfree));
        idle(local) > idle(lock).max(idle(lfree)) && access(local) < NEGLIGIBLE * least
    });
    let as_told = as_told.count();
    let told = rows.iter().map(|(_, [lock, lfree, local])| {
        format!(
            "{}: idle {:.2}, {:.2}, {:.2} ms; access {:.2}, {:.2}, {:.3} ms",
            local.scene,
            idle(lock),
            idle(lfree),
            idle(local),
            access(lock),
            access(lfree),
            access(local)
        )
    });
    Claim {
        says: "N23: LOCAL idles more, and its access time is negligible",
        holds: (!rows.is_empty()).then_some(as_told == rows.len()),
        seen: format!(
            "in {as_told} of {} scenes; with {threads} threads, LOCK, LFREE, LOCAL: {}",
            rows.len(),
            listed(&told.collect::<Vec<_>>())
        ),
    }
}

fn ratio([lock, lfree, _]: &[&Row; 3]) -> f64 {
    lfree.fps.median / lock.fps.median
}

fn alike(measured: &Measured) -> Claim {
    let most = measured.machine.cores.min(8);
    let rows = all(measured)
        .into_iter()
        .filter(|(t, _)| (2..=most).contains(t));
    let rows: Vec<_> = rows.map(|(_, rows)| rows).collect();
    let unlike = rows
        .iter()
        .filter(|[lock, lfree, _]| lfree.beside(lock).is_some());
    let unlike = unlike.count();
    let ratios: Vec<f64> = rows.iter().map(ratio).collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Claim {
        says: "N24: LOCK and LFREE are very similar up to 8 threads",
        holds: (!ratios.is_empty()).then_some(unlike == 0),
        seen: match &ratios[..] {
            [] => NOT_MEASURED.to_owned(),
            all => format!(
                "apart in {unlike} of {} settings; LFREE's frames a second are {least:.2} to {most:.2} of LOCK's",
                all.len()
            ),
        },
    }
}

fn ahead(measured: &Measured) -> Claim {
    let rows = all(measured).into_iter().filter(|(t, _)| *t == CORES);
    let rows: Vec<_> = rows.map(|(_, rows)| rows).collect();
    let ahead = |[lock, lfree, _]: &[&Row; 3]| lfree.beside(lock) == Some(Ordering::Greater);
    let ratios: Vec<f64> = rows.iter().map(ratio).collect();
    let told: Vec<String> = ratios.iter().map(|ratio| format!("{ratio:.2}")).collect();
    Claim {
        says: "N24: LFREE clearly outperforms LOCK with 24 threads",
        holds: on_cores(measured, &ratios).then(|| rows.iter().all(ahead)),
        seen: match &told[..] {
            [] => NOT_MEASURED.to_owned(),
            told => format!(
                "with {CORES} threads on {} cores LFREE's frames a second are {} of LOCK's",
                measured.machine.cores,
                told.join(", ")
            ),
        },
    }
}

/// Whether there are figures of as many cores as the paper's machine has.
fn on_cores(measured: &Measured, figures: &[f64]) -> bool {
    measured.machine.cores >= CORES && !figures.is_empty()
}

fn listed(told: &[String]) -> String {
    match told {
        [] => NOT_MEASURED.to_owned(),
        told => told.join("; "),
    }
}

/// How an access time grows from one number of threads to another: the power of their ratio.
fn power(from: (usize, f64), to: (usize, f64)) -> f64 {
    (to.1 / from.1).ln() / (to.0 as f64 / from.0 as f64).ln()
}

fn grows(measured: &Measured) -> Claim {
    let mut told = Vec::new();
    let mut holds = true;
    for scene in even(measured) {
        let of = |method| {
            let rows = measured
                .rows
                .iter()
                .filter(move |r| r.scene == scene && r.method == method)
                .filter(|r| r.threads <= measured.machine.cores);
            let times = rows.filter_map(|row| Some((row.threads, row.spent?.access)));
            times.collect::<Vec<(usize, f64)>>()
        };
        for (method, sublinear) in [(Method::Lock, false), (Method::Lfree, true)] {
            let times = of(method);
            let [first, .., last] = &times[..] else {
                continue;
            };
            let power = power(*first, *last);
            holds &= (power < 1.0) == sublinear;
            told.push(format!(
                "{scene} {}: {:.2} ms with {}, {:.2} with {} threads, power {power:.2}",
                method.name(),
                first.1,
                first.0,
                last.1,
                last.0
            ));
        }
    }
    Claim {
        says: "N25: access time grows exponentially with LOCK, sublinearly with LFREE",
        holds: (!told.is_empty()).then_some(holds),
        seen: listed(&told),
    }
}

fn efficiency(measured: &Measured) -> Claim {
    // Of fewer cores, what all of them give is told, and nothing is judged.
    let cores = measured.machine.cores.min(CORES);
    let rows = all(measured).into_iter().filter(|(t, _)| *t == cores);
    let shares: Vec<f64> = rows
        .map(|(_, [.., local])| local.speed_up.median / cores as f64)
        .collect();
    let told: Vec<String> = shares
        .iter()
        .map(|s| format!("{:.0} %", 100.0 * s))
        .collect();
    Claim {
        says: "N26: efficiency is under 50 % on 24 cores",
        holds: on_cores(measured, &shares).then(|| shares.iter().all(|s| *s < 0.5)),
        seen: format!(
            "LOCAL with a thread for each of {cores} cores: {}",
            listed(&told)
        ),
    }
}

fn uneven(measured: &Measured) -> Claim {
    let mut told = Vec::new();
    // With a thread for each core, or as near to it as there are figures: fewer may have luck.
    let mut holds = None;
    let threads = measured.threads();
    let several = threads
        .iter()
        .filter(|t| (2..=measured.machine.cores).contains(*t));
    for threads in several.filter(|t| t.is_power_of_two()) {
        let Some([_, lfree, local]) = three(measured, UNEVEN, *threads) else {
            continue;
        };
        let ratio = local.fps.median / lfree.fps.median;
        holds = local.beside(lfree).map(Ordering::is_lt);
        told.push(format!("{ratio:.2} with {threads}"));
    }
    Claim {
        says: "N27: LOCAL suffers where the depth of ray trees is very uneven",
        holds,
        seen: match &told[..] {
            [] => NOT_MEASURED.to_owned(),
            told => format!(
                "on {UNEVEN} LOCAL's frames a second over LFREE's: {}",
                told.join(", ")
            ),
        },
    }
}
