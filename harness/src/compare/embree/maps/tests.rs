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
    let text =
        format!("purpose = 'x'\nsize = [8, 8]\n[[mesh]]\n{mesh}\n[ldm]\ndirections = 9\n{keys}\n");
    let entry = Entry::outside(Path::new("planted/scene.toml"));
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene");
    LdmRun::new(&loaded, true).expect("within the limits")
}

fn torus(resolution: u32) -> LdmRun {
    let mesh = "generate.torus = { radii = [1, 0.4], segments = [24, 12] }\nrotate = [30, 10, 0]";
    run(&format!("resolution = {resolution}"), mesh)
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

/// A pixel of 128 steps, as it is where what blocks is small on the lattice.
#[test]
fn the_smallest_pixels_there_are() {
    let small = "generate.torus = { radii = [1, 0.4], segments = [24, 12] }\nscale = 1e-4\n\
                 [[mesh]]\nblocks = false\n\
                 generate.faces = { vertices = [[0, -1, -1], [0, -1, 1], [1, -1, 1]], faces = [[0, 1, 2]] }";
    let run = run("resolution = 362", small);
    let turn = &run.turns[0];
    assert!(turn.maps.pixel < 129.0, "{}", turn.maps.pixel);
    let vote = voted(&run, &turn.maps, &turn.layers);
    assert_eq!(vote.disagree, 0, "{:?}", vote.first);
    assert!(vote.keys > 100 && vote.edge < vote.pairs, "{vote}");
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
    let run = run("resolution = 30", mesh);
    let turn = &run.turns[0];
    let sound = voted(&run, &turn.maps, &turn.layers);
    assert_eq!(sound.disagree, 0, "{:?}", sound.first);
    let mut other = turn.layers.clone();
    // A sixteenth of a pixel is eight sub-pixels, of which the bound is one about.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "keys"
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
