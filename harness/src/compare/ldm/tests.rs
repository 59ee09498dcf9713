//! Each comparer catches what is planted, and nothing else.

use std::path::Path;

use triptych_spec::ldm::{Chains, Hits, Layers, Open, chain};

use super::*;
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::ldm::{LdmRun, LdmTurn};
use crate::scene::load_text;

const SCENE: &str = "
purpose = 'a box on a floor, under a sky'
size = [16, 12]
camera = { eye = [2.4, 2.6, 4.6], target = [-0.2, 0.4, 0], fov = 36, near = 0.5, far = 20 }
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [2, 0, -2], [2, 0, 2], [-1.5, 0, 2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.box = { size = [0.8, 0.8, 0.8] }
translate = [-0.3, 0.5, 0]
[ldm]
directions = 12
resolution = 16
far = 1.5
sky.gradient = { zenith = [1, 2, 3], nadir = [0, 0, 0] }
";

fn run() -> LdmRun {
    let entry = Entry {
        family: "ldm".to_owned(),
        ..Entry::outside(Path::new("planted/scene.toml"))
    };
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, SCENE).expect("a scene");
    LdmRun::new(&loaded, true).expect("within the limits")
}

fn pixels(run: &LdmRun) -> Vec<u32> {
    run.setup.receivers.iter().map(|r| r.pixel).collect()
}

/// Whether a judgement would pass as a row.
fn passes(judgement: &Judgement) -> bool {
    judgement.differ() == 0 && judgement.compared > judgement.admitted
}

/// One item differs, by this cause, in these words, and at this pixel if it has one.
fn caught(judgement: &Judgement, cause: Cause, words: &str, pixel: Option<u32>) {
    assert_eq!(judgement.causes.get(&cause), Some(&1), "{judgement:?}");
    assert_eq!(judgement.differ(), 1, "{judgement:?}");
    let marks: Vec<u32> = judgement.marks.iter().map(|m| m.0).collect();
    assert_eq!(marks, pixel.into_iter().collect::<Vec<_>>());
    let described = judgement.described.first();
    let described = described.expect("a difference is described");
    assert!(described.contains(words), "{described}");
}

/// A pixel of the second map with two keys that differ, its name, and where its list starts.
fn chosen(turn: &LdmTurn) -> (usize, String, usize) {
    let map = &turn.maps.maps[1];
    let at = (0..map.size.width * map.size.height).find(|at| {
        let list = turn.layers.list(map.first + at);
        list.len() == 2 && list[0] + 2 < list[1]
    });
    let at = at.expect("a pixel before the box");
    let [x, y] = [at % map.size.width, at / map.size.width];
    let pixel = (map.first + at) as usize;
    let start = turn.layers.offsets[pixel] as usize;
    (pixel, format!("map 1 pixel ({x}, {y})"), start)
}

#[test]
fn lists_differ_by_key_order_number_or_start() {
    let run = run();
    let turn = &run.turns[0];
    let Layers { offsets, keys } = &turn.layers;
    let judge = |offsets: &[u32], keys: &[u32]| layers(&turn.maps, &turn.layers, offsets, keys);
    assert!(passes(&judge(offsets, keys)));
    let (pixel, name, start) = chosen(turn);
    let with = |change: &dyn Fn(&mut Vec<u32>)| {
        let mut other = keys.clone();
        change(&mut other);
        judge(offsets, &other)
    };
    let off = with(&|keys| keys[start] += 1);
    caught(&off, Cause::DepthKey, &name, None);
    let swapped = with(&|keys| keys.swap(start, start + 1));
    caught(&swapped, Cause::SortOrder, &name, None);
    let twice = with(&|keys| keys[start] = keys[start + 1]);
    caught(&twice, Cause::Duplicate, &name, None);
    let mut other = offsets.clone();
    other[pixel] -= 1;
    caught(&judge(&other, keys), Cause::CorruptLink, &name, None);
    let short = judge(offsets, &keys[..keys.len() - 1]);
    assert_eq!(short.causes.get(&Cause::ReferenceMissing), Some(&1));
    assert!(!passes(&judge(&[], &[])), "nothing to compare");
    let nothing = Layers::default();
    assert!(!passes(&layers(&turn.maps, &nothing, &[], &[])));
}

#[test]
fn chains_differ_by_link_key_order_or_counter() {
    let run = run();
    let (turn, blockers) = (&run.turns[0], &run.setup.blockers);
    let needed = u32::try_from(turn.layers.keys.len()).expect("few");
    let linked = |capacity| chain(&turn.maps, blockers, capacity).expect("lists");
    let sound = linked(needed);
    let judge = |seen: &Chains| chains(&turn.maps, &turn.layers, seen);
    assert!(passes(&judge(&sound)));
    assert!(passes(&judge(&linked(needed + 9))), "room to spare");
    assert!(passes(&judge(&linked(needed / 2))), "overflow");
    assert!(passes(&judge(&linked(0))), "no room at all");
    let (pixel, name, _) = chosen(turn);
    let first = sound.heads[pixel] as usize;
    let second = sound.links[first].next as usize;
    let with = |change: &dyn Fn(&mut Chains)| {
        let mut other = sound.clone();
        change(&mut other);
        judge(&other)
    };
    let key = with(&|c| c.links[second].key += 1);
    caught(&key, Cause::DepthKey, &name, None);
    let order = with(&|c| {
        let [a, b] = [c.links[first].key, c.links[second].key];
        (c.links[first].key, c.links[second].key) = (b, a);
    });
    caught(&order, Cause::SortOrder, &name, None);
    let cycle = with(&|c| c.links[second].next = sound.heads[pixel]);
    caught(&cycle, Cause::Cycle, &name, None);
    let outside = with(&|c| c.links[second].next = needed + 7);
    caught(&outside, Cause::CorruptLink, &name, None);
    let lost = with(&|c| c.links[first].next = triptych_spec::abuffer::EOL);
    caught(&lost, Cause::LostNode, &name, None);
    let counter = with(&|c| c.attempts += 1);
    caught(&counter, Cause::Overflow, "asked for", None);
    let mut half = linked(needed / 2);
    half.attempts -= 1;
    caught(&judge(&half), Cause::Overflow, "asked for", None);
    let listed = (half
        .heads
        .iter()
        .position(|h| *h != triptych_spec::abuffer::EOL))
    .expect("one");
    half.attempts += 1;
    half.links[half.heads[listed] as usize].key ^= 1 << 20;
    assert!(!passes(&judge(&half)), "a foreign key after an overflow");
}

#[test]
fn traces_differ_by_key_or_by_what_is_found() {
    let run = run();
    let (turn, pixels) = (&run.turns[0], pixels(&run));
    let maps = turn.maps.maps.len();
    let askers = run.setup.receivers.iter();
    let found: Vec<Hits> = askers
        .flat_map(|asker| turn.hits(&asker.receiver).map(|(_, hits)| hits))
        .collect();
    let judge = |seen: &[Hits]| neighbours(&pixels, (0, maps), &found, seen);
    assert!(passes(&judge(&found)));
    let at = found
        .iter()
        .position(|h| h.before.is_some() && h.behind.is_none());
    let at = at.expect("something is above the floor");
    let with = |change: &dyn Fn(&mut Hits)| {
        let mut other = found.clone();
        change(&mut other[at]);
        judge(&other)
    };
    let name = format!("receiver {} in map {}", at / maps, at % maps);
    let pixel = Some(pixels[at / maps]);
    caught(&with(&|h| h.key += 1), Cause::DepthKey, &name, pixel);
    caught(&with(&|h| h.before = None), Cause::Coverage, &name, pixel);
    caught(
        &with(&|h| h.behind = h.before),
        Cause::Coverage,
        &name,
        pixel,
    );
    let other = neighbours(&pixels, (0, maps), &found[1..], &found);
    assert_eq!(other.causes.get(&Cause::ReferenceMissing), Some(&1));
    assert!(!passes(&judge(&found[1..])), "one is missing");
    assert!(!passes(&neighbours(&[], (0, maps), &[], &[])), "nothing");
}

#[test]
fn what_is_open_differs_by_a_unit_or_beyond_its_bound() {
    let run = run();
    let (turn, pixels) = (&run.turns[0], pixels(&run));
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let single = |open: &Open| (open.whole, open.part.value as f32);
    let sound: Vec<(u32, f32)> = turn.open.iter().map(single).collect();
    let judge = |seen: &[(u32, f32)]| open(&pixels, &turn.open, seen);
    let judged = judge(&sound);
    assert!(passes(&judged) && judged.error_over_bound.is_some_and(|r| r < 1.0));
    let at = turn.open.iter().position(|o| o.part.value > 0.0);
    let at = at.expect("something blocks in part");
    let with = |change: &dyn Fn(&mut (u32, f32))| {
        let mut other = sound.clone();
        change(&mut other[at]);
        judge(&other)
    };
    let name = format!("receiver {at}");
    let pixel = Some(pixels[at]);
    caught(&with(&|o| o.0 -= 1), Cause::Coverage, &name, pixel);
    #[expect(clippy::cast_possible_truncation, reason = "a small number")]
    let beyond = (2.0 * turn.open[at].part.bound) as f32;
    caught(&with(&|o| o.1 += beyond), Cause::Interval, &name, pixel);
    caught(&with(&|o| o.1 = f32::NAN), Cause::Interval, &name, pixel);
    // What has no bound is not judged, and a row of nothing else does not pass.
    let mut boundless = turn.open.clone();
    boundless
        .iter_mut()
        .for_each(|o| o.part.bound = f64::INFINITY);
    assert!(!passes(&open(&pixels, &boundless, &sound)));
    assert!(!passes(&judge(&sound[1..])), "one is missing");
    assert!(!passes(&open(&[], &[], &[])), "nothing");
}

#[test]
fn light_differs_beyond_its_bound() {
    let run = run();
    let (turn, pixels) = (&run.turns[0], pixels(&run));
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let sound: Vec<[f32; 3]> = turn
        .light
        .iter()
        .map(|l| l.map(|c| c.value as f32))
        .collect();
    assert!(passes(&light(&pixels, &turn.light, &sound)));
    let mut other = sound.clone();
    #[expect(clippy::cast_possible_truncation, reason = "a small number")]
    let beyond = (2.0 * turn.light[3][1].bound) as f32;
    other[3][1] -= beyond;
    let judged = light(&pixels, &turn.light, &other);
    caught(&judged, Cause::Interval, "number 3", Some(pixels[3]));
    assert!(!passes(&light(&[], &[], &[])), "nothing");
}
