//! The vote notices what is planted in lists, in maps, and in what Embree says.

use std::path::Path;

use triptych_spec::grid::ray::Ray;
use triptych_spec::ldm::Layers;

use super::*;
use crate::corpus::Entry;
use crate::embree::rays::RayScene;
use crate::mesh::Intake;
use crate::replay::ldm::{LdmRun, LdmTurn};
use crate::scene::load_text;

fn run(keys: &str, mesh: &str) -> LdmRun {
    let text = format!("purpose = 'x'\nsize = [8, 8]\n[[mesh]]\n{mesh}\n[ldm]\n{keys}\n");
    let entry = Entry::outside(Path::new("planted/scene.toml"));
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene");
    LdmRun::new(&loaded, true).expect("within the limits")
}

fn torus(resolution: u32) -> LdmRun {
    let mesh = "generate.torus = { radii = [1, 0.4], segments = [24, 12] }\nrotate = [30, 10, 0]";
    run(&format!("directions = 9\nresolution = {resolution}"), mesh)
}

/// Every pixel of every map.
fn all(turn: &LdmTurn) -> Vec<Sampled> {
    let of = |map| Sampled { map, stride: 1 };
    (0..turn.maps.maps.len()).map(of).collect()
}

fn voted(run: &LdmRun, maps: &Maps, layers: &Layers) -> MapVote {
    let blockers = &run.setup.blockers;
    let scene = RayScene::new(blockers).expect("Embree is there");
    compare_maps(maps, layers, blockers, &all(&run.turns[0]), &scene).expect("no error")
}

/// A pixel with two keys or more that differ much, and where its list starts.
fn chosen(turn: &LdmTurn) -> (usize, usize) {
    let lists = turn.layers.offsets.windows(2).enumerate();
    let deep = |(_, ends): &(usize, &[u32])| {
        let list = &turn.layers.keys[ends[0] as usize..ends[1] as usize];
        list.len() >= 2 && list.windows(2).all(|pair| pair[1] - pair[0] > 1 << 22)
    };
    // Not the first, so that the pixel is no border's.
    let (pixel, ends) = lists.filter(deep).nth(100).expect("a pixel of the torus");
    (pixel, ends[0] as usize)
}

#[test]
fn every_list_of_a_closed_mesh_is_voted_for() {
    let run = torus(40);
    let turn = &run.turns[0];
    let vote = voted(&run, &turn.maps, &turn.layers);
    assert_eq!(vote.disagree, 0, "{:?}", vote.first);
    assert_eq!(vote.rays, u64::from(turn.maps.pixels));
    assert_eq!(vote.keys, turn.layers.keys.len() as u64);
    assert!(vote.edge * 20 < vote.pairs, "{vote}");
    assert!(vote.error_over_bound <= 1.0 && vote.times > 5000, "{vote}");
}

#[test]
fn a_vote_on_nothing_is_no_agreement() {
    let nothing = MapVote {
        rays: 7,
        ..MapVote::default()
    };
    assert!(nothing.judgement(None).skipped.is_some());
    let wrong = MapVote {
        disagree: 1,
        ..nothing
    };
    let judgement = wrong.judgement(None);
    assert_eq!((judgement.skipped, judgement.compared), (None, 0));
}

/// Slivers of less than a pixel: rays through pixels' middles pass every one of them near an edge.
#[test]
fn a_vote_on_edges_alone_is_none() {
    let mesh = "generate.scatter = { count = 60, extent = [1, 1, 1], length = 1, width = 1e-4 }\n\
                [[mesh]]\nblocks = false\n\
                generate.faces = { vertices = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], faces = [[0, 1, 2]] }";
    let run = run("directions = 9\nresolution = 24", mesh);
    let turn = &run.turns[0];
    let vote = voted(&run, &turn.maps, &turn.layers);
    assert!(vote.pairs > 0 && vote.pairs == vote.edge, "{vote}");
    let judgement = vote.judgement(Some(0.1));
    let reason = format!("all {} pairs are in class edge", vote.pairs);
    assert_eq!(judgement.skipped, Some(reason));
    assert!(judgement.causes.is_empty(), "{vote}");
    let wrong = MapVote {
        disagree: 1,
        ..vote
    };
    assert_eq!(wrong.judgement(None).skipped, None);
}

/// Pixels of 128 steps, as they are where what blocks is small on the lattice.
fn small() -> LdmRun {
    let mesh = "generate.torus = { radii = [1, 0.4], segments = [24, 12] }\nscale = 1e-4\n\
                [[mesh]]\nblocks = false\n\
                generate.faces = { vertices = [[0, -1, -1], [0, -1, 1], [1, -1, 1]], faces = [[0, 1, 2]] }";
    run("directions = 400\nresolution = 362", mesh)
}

#[test]
fn the_smallest_pixels_there_are() {
    let run = small();
    let turn = &run.turns[0];
    assert!(turn.maps.pixel < 129.0, "{}", turn.maps.pixel);
    let vote = voted(&run, &turn.maps, &turn.layers);
    assert_eq!(vote.disagree, 0, "{:?}", vote.first);
    assert!(vote.keys > 3_000 && 2 * vote.edge < vote.pairs, "{vote}");
}

/// Rays are integers, so they miss the middles of such pixels; how far is known of all points on
/// their way.
#[test]
fn rays_stray_as_far_as_they_say() {
    let run = small();
    let maps = &run.turns[0].maps;
    let mut farthest = 0.0_f64;
    for map in maps.maps.iter().step_by(7) {
        let projection = Projection::new(maps, map);
        for at in [[0, 0], [map.size.width / 2, map.size.height / 3]] {
            let through = projection.through(at);
            let way = through
                .way
                .expect("the map is in the middle of the lattice");
            let middle = at.map(|c| f64::from((c << maps.bits) + (1 << (maps.bits - 1))));
            // 2^23 steps of a direction of 24 bits are half of it; the lattice has four of those.
            for part in 0..=4 {
                let point =
                    [0, 1, 2].map(|i| way.ray.origin[i] + part * (way.ray.direction[i] / 4));
                if point.iter().any(|c| c.abs() > 1 << 23) {
                    break;
                }
                let place = projection.place(point);
                let off = [0, 1].map(|i| (place[i] - middle[i]).abs());
                // A quarter of the direction loses up to three quarters of a step along each axis.
                let lost = f64::from(part) * 1.3;
                assert!(
                    off.iter().all(|off| *off <= through.stray + lost),
                    "{off:?}"
                );
                if part == 0 {
                    assert!(off.iter().all(|off| *off <= through.stray), "{off:?}");
                    farthest = farthest.max(off[0]).max(off[1]);
                }
            }
        }
    }
    assert!(
        farthest > 0.3 && farthest < 1.0,
        "half a step and a bit: {farthest}"
    );
}

#[test]
fn a_list_that_is_wrong_is_noticed() {
    let run = torus(40);
    let turn = &run.turns[0];
    let (pixel, start) = chosen(turn);
    let with = |change: &dyn Fn(&mut Layers)| {
        let mut other = turn.layers.clone();
        change(&mut other);
        let vote = voted(&run, &turn.maps, &other);
        assert_eq!(vote.disagree, 1, "{:?}", vote.first);
        vote.first[0]
    };
    let moved = with(&|layers| layers.keys[start] += 1 << 21);
    assert!(matches!(moved.conflict, MapConflict::Key { .. }), "{moved}");
    let map = &turn.maps.maps[moved.map];
    assert_eq!((map.first + moved.pixel) as usize, pixel, "is named");
    let swapped = with(&|layers| layers.keys.swap(start, start + 1));
    assert_eq!(swapped.conflict, MapConflict::Order);
    let after = |layers: &mut Layers, by: i32| {
        let later = layers.offsets[pixel + 1..].iter_mut();
        later.for_each(|o| *o = o.checked_add_signed(by).expect("some"));
    };
    let lost = with(&|layers| {
        layers.keys.remove(start);
        after(layers, -1);
    });
    assert!(matches!(lost.conflict, MapConflict::Lost { .. }), "{lost}");
    let twice = with(&|layers| {
        layers.keys.insert(start, turn.layers.keys[start]);
        after(layers, 1);
    });
    assert!(matches!(twice.conflict, MapConflict::Key { .. }), "{twice}");
}

/// Keys are held to as little as their bounds allow: half a pixel's slope of a face.
#[test]
fn intervals_are_narrow() {
    let mesh = "generate.faces = { vertices = [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], \
                faces = [[0, 1, 2, 3]] }";
    let run = run("directions = 9\nresolution = 30", mesh);
    let turn = &run.turns[0];
    let sound = voted(&run, &turn.maps, &turn.layers);
    assert_eq!(sound.disagree, 0, "{:?}", sound.first);
    let mut other = turn.layers.clone();
    // A sixteenth of a pixel is eight sub-pixels, of which the bound is one about.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a sixteenth of a pixel, in keys: a few thousand at most"
    )]
    let by = (turn.maps.pixel * 8.0 / 16.0) as u32;
    other.keys.iter_mut().for_each(|key| *key += by);
    let vote = voted(&run, &turn.maps, &other);
    assert!(vote.disagree * 2 > vote.keys, "{vote}");
}

#[test]
fn a_map_that_is_not_where_it_says_is_noticed() {
    let run = torus(40);
    let turn = &run.turns[0];
    // The second map is drawn by a row that is off by a hundredth, and so its lists are.
    let mut maps = turn.maps.clone();
    maps.maps[1].rows[0] = maps.maps[1].rows[0].map(|c| c - c / 100);
    let vote = voted(&run, &maps, &turn.layers);
    assert!(vote.disagree > 0, "{vote}");
    assert!(
        vote.first.iter().all(|first| first.map == 1),
        "{:?}",
        vote.first
    );
}

/// Embree's answers, with one that is not right.
struct Corrupt<'a> {
    scene: &'a RayScene,
    change: fn(&mut Vec<Hit>),
}

impl RayLists for Corrupt<'_> {
    fn all(&self, ray: &Ray, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        self.scene.all(ray, hits)?;
        (self.change)(hits);
        Ok(())
    }
}

#[test]
fn what_embree_must_not_say_is_noticed() {
    let run = torus(24);
    let turn = &run.turns[0];
    let blockers = &run.setup.blockers;
    let scene = &RayScene::new(blockers).expect("Embree is there");
    let with = |change| {
        let corrupt = Corrupt { scene, change };
        let sampled = all(turn);
        let vote = compare_maps(&turn.maps, &turn.layers, blockers, &sampled, &corrupt);
        vote.expect("no error")
    };
    let is = |vote: &MapVote, kind: fn(&MapConflict) -> bool| {
        assert!(vote.disagree > 100, "{vote}");
        assert!(
            vote.first.iter().any(|f| kind(&f.conflict)),
            "{:?}",
            vote.first
        );
    };
    let missed = with(|hits| hits.truncate(hits.len().saturating_sub(1)));
    is(&missed, |c| matches!(c, MapConflict::Missed { .. }));
    let late = with(|hits| hits.iter_mut().for_each(|hit| hit.t *= 1.001));
    is(&late, |c| matches!(c, MapConflict::Time { .. }));
    let nan = with(|hits| hits.iter_mut().for_each(|hit| hit.t = f32::NAN));
    is(&nan, |c| matches!(c, MapConflict::Time { .. }));
    let invented = with(|hits| hits.push(Hit { prim: 9999, t: 0.5 }));
    is(&invented, |c| {
        matches!(c, MapConflict::Invented { prim: 9999 })
    });
}
