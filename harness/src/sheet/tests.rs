mod decode;
mod scenes;

use triptych_spec::abuffer::{EOL, Lists};

use super::*;
use crate::compare::order::flatten;
use crate::embree::EmbreeScene;
use crate::replay::embree::look;
use crate::replay::gpu::GpuSeen;
use decode::{KINDS, Reader, entry};
use scenes::{layers, run, seen};

#[test]
fn what_was_packed_comes_back() {
    let mut wild = entry(u32::MAX, u32::MAX);
    wild.source = [u32::MAX; 2];
    wild.mask = u32::MAX;
    wild.colour = [f32::MIN_POSITIVE, -0.0, f32::INFINITY, 1.0];
    let mut kinds: Vec<Entry> = (0..9).map(|i| entry(i, 1000 - i)).collect();
    kinds
        .iter_mut()
        .zip(KINDS)
        .for_each(|(e, kind)| e.kind = kind);
    let mut other = entry(3, 7);
    other.colour[2] = 0.75;
    let pixels: Vec<Pixel> = vec![
        (0, vec![kinds.clone(), vec![]]),
        (
            7,
            vec![vec![wild, entry(3, 0), other], vec![entry(3, 0x7fff_ffff)]],
        ),
        (u32::MAX, vec![vec![], vec![wild, wild]]),
    ];
    assert_eq!(Reader::new(&pack(&pixels, 2)).pixels(), pixels);
    assert_eq!(Reader::new(&pack(&[], 1)).pixels(), [], "nothing at all");
}

#[test]
fn the_specs_sheet_is_its_lists() {
    let scene = layers([5, 3], &[(0.5, 0.5), (0.25, 0.5), (0.75, 1.0)]);
    let run = run(&scene);
    let sheet = spec(&scene, &run, "spec");
    assert_eq!((sheet.stride, sheet.held, sheet.left_out), (1, 15, 0));
    for (pixel, lists) in Reader::new(&sheet.data).pixels() {
        let list = &lists[0];
        let prims: Vec<u32> = list.iter().map(|e| e.prim).collect();
        assert_eq!(prims, [1, 0, 2], "nearest first, the surface behind");
        assert_eq!(list[2].kind, Kind::Opaque);
        let must = run.sorted.list(pixel as usize);
        let keys = must
            .iter()
            .map(|f| f.key)
            .chain([run.opaque.key[pixel as usize]]);
        assert!(keys.eq(list.iter().map(|e| e.key)), "keys of pixel {pixel}");
        let near = |e: &Entry| (e.colour[0] - 0.3).abs() < 0.3 / 128.0;
        assert!(list.iter().all(near), "colours to eight bits");
    }
}

#[test]
fn too_many_lists_are_thinned_out_and_counted() {
    // 300,000 entries, two to three times what is kept.
    let scene = layers([500, 300], &[(0.5, 0.5), (0.25, 0.5)]);
    let run = run(&scene);
    let sheet = spec(&scene, &run, "spec");
    assert_eq!(sheet.stride, 2, "every second column and row");
    assert_eq!(sheet.held + sheet.left_out, 150_000, "none is forgotten");
    assert!(sheet.data.len() <= SPEC_BYTES, "{} bytes", sheet.data.len());
    let held = Reader::new(&sheet.data).pixels();
    assert_eq!(held.len() as u64, sheet.held);
    let on = |(pixel, _): &Pixel| (pixel % 500) % 2 == 0 && (pixel / 500) % 2 == 0;
    assert!(held.iter().all(on), "on the lattice");
}

#[test]
fn a_leg_that_agrees_adds_nothing() {
    let scene = layers([4, 4], &[(0.5, 0.5), (0.25, 0.5), (0.75, 1.0)]);
    let run = run(&scene);
    let seen = seen(&run);
    let order = flatten(seen.abuffer.bands[0].sorted.as_ref().expect("sorted"));
    assert_eq!(
        order.as_ref(),
        Some(&run.sorted),
        "the helper links in order"
    );
    let sheet = gpu(&scene, &run, "spec", "gpu@x/compute", &seen);
    assert_eq!((sheet.held, sheet.left_out, sheet.data.len()), (0, 0, 0));
    assert_eq!((sheet.worst, sheet.note.as_str()), (None, ""));
}

#[test]
fn whatever_a_leg_does_otherwise_is_held_with_both_lists() {
    let scene = layers([4, 4], &[(0.5, 0.5), (0.25, 0.5), (0.75, 1.0)]);
    let run = run(&scene);
    let held = |spoil: &dyn Fn(&mut GpuSeen)| {
        let mut seen = seen(&run);
        spoil(&mut seen);
        let band = &seen.abuffer.bands[0];
        seen.sorted = band.sorted.as_ref().and_then(flatten);
        let sheet = gpu(&scene, &run, "spec", "gpu@x/compute", &seen);
        assert!(sheet.worst.is_some(), "words for readers without a script");
        Reader::new(&sheet.data).pixels()
    };
    let sorted = |seen: &mut GpuSeen, change: &dyn Fn(&mut Lists)| {
        change(seen.abuffer.bands[0].sorted.as_mut().expect("sorted"));
    };
    let only = |pixels: &[Pixel], pixel| {
        assert_eq!(pixels.len(), 1, "{pixels:?}");
        assert_eq!(pixels[0].0, pixel);
        let [must, is] = &pixels[0].1[..] else {
            panic!("two lists");
        };
        (must.clone(), is.clone())
    };
    let lost = held(&|s| sorted(s, &|l| l.heads[5] = l.nodes[l.heads[5] as usize].next));
    let (must, is) = only(&lost, 5);
    assert_eq!(is, must[1..], "the first is missing");
    let key = held(&|s| sorted(s, &|l| l.nodes[l.heads[6] as usize].key -= 3));
    let (must, is) = only(&key, 6);
    assert_eq!((must[0].key - is[0].key, &is[1..]), (3, &must[1..]));
    let colour = held(&|s| {
        let address = s.abuffer.bands[0].built.heads[7] as usize;
        s.abuffer.bands[0].built.colours[address][1] = 0.625;
    });
    let (must, is) = only(&colour, 7);
    assert_eq!(is.iter().filter(|e| e.colour[1] == 0.625).count(), 1);
    assert!(
        must.iter().all(|e| e.colour[1] == 0.6),
        "exact, for comparing"
    );
    let surface = held(&|s| s.abuffer.opaque.key[8] += 1);
    let (must, is) = only(&surface, 8);
    assert_eq!(is[2].key, must[2].key + 1);
    let swapped = held(&|s| {
        sorted(s, &|l| {
            let first = l.heads[9];
            let second = l.nodes[first as usize].next;
            l.heads[9] = second;
            l.nodes[second as usize].next = first;
            l.nodes[first as usize].next = EOL;
        });
    });
    let (must, is) = only(&swapped, 9);
    assert_eq!([is[0], is[1]], [must[1], must[0]], "another order");
    let garbage = held(&|s| sorted(s, &|l| l.nodes[l.heads[3] as usize].prim = u32::MAX));
    assert_eq!(
        only(&garbage, 3).1[0].source,
        [u32::MAX; 2],
        "no such triangle"
    );
}

#[test]
fn damaged_lists_end_where_a_link_leads_astray() {
    let scene = layers([4, 4], &[(0.5, 0.5), (0.25, 0.5)]);
    let run = run(&scene);
    let mut seen = seen(&run);
    let band = &mut seen.abuffer.bands[0];
    let head = band.built.heads[2] as usize;
    band.built.nodes[head].next = 4711;
    (band.sorted, seen.sorted) = (None, None);
    let sheet = gpu(&scene, &run, "spec", "gpu@x/compute", &seen);
    let pixels = Reader::new(&sheet.data).pixels();
    assert_eq!(
        pixels.len(),
        1,
        "in other pixels only the order is not known"
    );
    let last = pixels[0].1[1].last().expect("two entries");
    assert_eq!((last.kind, last.key), (Kind::Astray, 4711));
    assert!(sheet.note.contains("damaged"), "{}", sheet.note);
}

#[test]
fn of_too_many_pixels_the_worst_are_held() {
    let scene = layers([160, 160], &[(0.5, 0.5), (0.25, 0.5), (0.75, 0.5)]);
    let run = run(&scene);
    let mut seen = seen(&run);
    let lists = seen.abuffer.bands[0].sorted.as_mut().expect("sorted");
    // Every pixel lacks one, a few lack all.
    for pixel in 0..lists.heads.len() {
        lists.heads[pixel] = lists.nodes[lists.heads[pixel] as usize].next;
    }
    for pixel in [777, 20_000] {
        lists.heads[pixel] = EOL;
    }
    seen.sorted = flatten(lists);
    let sheet = gpu(&scene, &run, "spec", "gpu@x/compute", &seen);
    assert_eq!(sheet.held + sheet.left_out, 160 * 160, "none is forgotten");
    assert!(sheet.left_out > 0 && sheet.data.len() <= GPU_BYTES);
    let held = Reader::new(&sheet.data).pixels();
    for pixel in [0, 777, 20_000] {
        assert!(held.iter().any(|(p, _)| *p == pixel), "{pixel} is left out");
    }
    let words = sheet.worst.expect("the worst").words;
    assert!(words.starts_with("pixel (137, 4): 3 entries"), "{words}");
}

#[test]
fn embrees_sheet_has_its_hits_and_what_it_lacks() {
    let scene = layers(
        [4, 3],
        &[(0.5, 0.5), (0.25, 0.5), (0.75, 1.0), (0.875, 0.5)],
    );
    let run = run(&scene);
    let embree = EmbreeScene::new(&run.primitives).expect("a small scene");
    let all = look(&scene, &run, &embree).expect("Embree answers");
    assert_eq!((all.hits, all.pixels), (48, 12), "hidden ones too");
    let sheet = Rays::new(&scene, &run, &embree).sheet(&all);
    assert_eq!((sheet.stride, sheet.held, sheet.left_out), (1, 12, 0));
    for (pixel, lists) in Reader::new(&sheet.data).pixels() {
        let prims: Vec<(u32, Kind)> = lists[0].iter().map(|e| (e.prim, e.kind)).collect();
        let listed = [1, 0, 2, 3].map(|prim| (prim, Kind::Listed));
        assert_eq!(prims, listed, "pixel {pixel}: nearest first, all agree");
    }
    // A triangle that the spec has, and Embree was not told of.
    let mut fewer = run.primitives.clone();
    let gone = fewer.prims[0];
    fewer.prims[0] = [gone[0]; 3];
    let blind = EmbreeScene::new(&fewer).expect("a small scene");
    let sheet = Rays::new(&scene, &run, &blind).sheet_of(&[4].into());
    let pixels = Reader::new(&sheet.data).pixels();
    let lacks: Vec<u32> = pixels[0].1[0]
        .iter()
        .filter(|e| e.kind == Kind::Missed)
        .map(|e| e.prim)
        .collect();
    assert_eq!((pixels.len(), lacks), (1, vec![0]));
}
