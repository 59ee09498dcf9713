//! The comparer in world space, on scenes of the corpus and on planted bugs.

use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use crate::cause::Cause;
use crate::compare::embree::{EmbreeVote, compare_world};
use crate::corpus::{self, Entry};
use crate::embree::view::View;
use crate::embree::world::{World, WorldScene};
use crate::embree::{EmbreeError, Hit, RayHits};
use crate::scene::{Loaded, load_entry};

/// A perspective with instances that are turned and scaled; one through the near plane; one
/// without perspective.
const SCENES: [&str; 3] = ["abuffer/mixed", "raster/near-plane", "raster/jittered-grid"];

pub(super) fn load(name: &str) -> Loaded {
    let entry = Entry {
        name: name.into(),
        family: String::new(),
        path: corpus::root().join(name).join("scene.toml"),
    };
    load_entry(&entry, None).expect("the scene is sound")
}

fn world(loaded: &Loaded) -> World {
    let view = View::new(loaded.world.camera, loaded.scene.size);
    World::new(&loaded.world.points(&loaded.scene), view)
}

/// The vote of these rays.
fn vote(loaded: &Loaded, embree: &impl RayHits) -> (EmbreeVote, f64) {
    let spec = primitives(&loaded.scene, SUBPIXEL_BITS);
    compare_world(&loaded.scene, &world(loaded), &spec, embree).expect("Embree traces")
}

fn embree(loaded: &Loaded, world: &World) -> WorldScene {
    WorldScene::new(&loaded.scene, world).expect("Embree builds")
}

/// Embree's hits at another place, and after a change.
struct Changed<F>(WorldScene, [u32; 2], F);

impl<F: Fn(&mut Vec<Hit>) + Sync> RayHits for Changed<F> {
    fn hits(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        let [right, down] = self.1;
        self.0.hits(column + right, row + down, hits)?;
        (self.2)(hits);
        Ok(())
    }
}

/// A bug that the vote must see, for nothing else than what it is.
fn assert_seen(vote: &EmbreeVote) {
    let causes = [(Cause::OracleDisagreement, vote.disagreeing())];
    assert!(vote.disagreeing() > 0, "{vote}");
    assert_eq!(vote.causes(), causes.into(), "{vote}");
}

#[test]
fn scenes_agree_and_their_edge_share_is_that_of_the_area() {
    for name in SCENES {
        let loaded = load(name);
        let (vote, band) = vote(&loaded, &embree(&loaded, &world(&loaded)));
        assert_eq!(vote.disagreeing(), 0, "{name}: {vote}");
        assert!(
            vote.depths > 5_000 && vote.steps > 0 || name == SCENES[2],
            "{name}: {vote}"
        );
        assert!(vote.unresolved * 1000 < vote.pairs, "{name}: {vote}");
        assert!(
            (0.5..=1.0).contains(&vote.error_over_bound),
            "{name}: {vote}"
        );
        assert!(
            vote.edge_agreeing < vote.edge,
            "the class is needed: {name}: {vote}"
        );
        let share = vote.edge as f64 / vote.pairs as f64;
        let ratio = share / band;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{name}: {share} of pairs, {band} of the area"
        );
    }
}

#[test]
fn a_camera_off_by_a_pixel_is_seen() {
    for (name, by) in SCENES.into_iter().zip([[1, 0], [0, 1], [1, 1]]) {
        let loaded = load(name);
        let shifted = Changed(embree(&loaded, &world(&loaded)), by, |_: &mut Vec<Hit>| {});
        let (vote, _) = vote(&loaded, &shifted);
        assert_seen(&vote);
        assert!(vote.missed > 0 && vote.invented > 0, "{name}: {vote}");
    }
}

#[test]
fn rows_of_a_transform_that_changed_places_are_seen() {
    for name in SCENES {
        let loaded = load(name);
        let mut turned = loaded.clone();
        for placement in &mut turned.world.instances {
            placement.rows.swap(0, 1);
        }
        let (vote, _) = vote(&loaded, &embree(&loaded, &world(&turned)));
        assert_seen(&vote);
    }
}

#[test]
fn a_triangle_that_is_dropped_is_seen() {
    let loaded = load("abuffer/mixed");
    let all = embree(&loaded, &world(&loaded));
    let (mut hits, size) = (Vec::new(), loaded.scene.size);
    all.hits(size.width / 2, size.height / 2, &mut hits)
        .expect("Embree traces");
    let dropped = hits[0].prim;
    let drop = |hits: &mut Vec<Hit>| hits.retain(|hit| hit.prim != dropped);
    let (vote, _) = vote(&loaded, &Changed(all, [0, 0], drop));
    assert_seen(&vote);
    assert!(vote.first.iter().all(|d| d.prim == dropped), "{vote}");
    assert_eq!(vote.disagreeing(), vote.missed, "{vote}");
}

#[test]
fn a_distance_off_by_twice_the_bound_is_seen() {
    let loaded = load("raster/near-plane");
    let clean = vote(&loaded, &embree(&loaded, &world(&loaded))).0;
    let farther = |hits: &mut Vec<Hit>| hits.iter_mut().for_each(|hit| hit.t *= 1.001);
    let all = embree(&loaded, &world(&loaded));
    let (vote, _) = vote(&loaded, &Changed(all, [0, 0], farther));
    assert_seen(&vote);
    assert_eq!(vote.missed + vote.invented, 0, "{vote}");
    assert!(vote.depths_outside * 2 > clean.depths, "{vote}");
}

/// Rays that hit nothing.
struct Nothing;

impl RayHits for Nothing {
    fn hits(&self, _: u32, _: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        hits.clear();
        Ok(())
    }
}

#[test]
fn without_triangles_no_part_of_their_area_is_near_an_edge() {
    let mut loaded = load("raster/jittered-grid");
    loaded.scene.triangles.clear();
    let (vote, band) = vote(&loaded, &Nothing);
    assert_eq!((vote.pairs, vote.disagreeing(), band), (0, 0, 0.0));
}
