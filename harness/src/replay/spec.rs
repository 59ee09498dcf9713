//! The spec's side of a replay.

use std::time::{Duration, Instant};

use triptych_spec::abuffer::{Lists, Opaque, Sorted};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, Fragment};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use super::pieces::{Asked, bands, draw};
use super::rivals::Rivals;
use crate::plan::Plan;

/// More fragments than this are refused: with nodes, colours, sorted lists and the
/// legs' copies, a fragment costs about 100 bytes, so this is about 7 GB.
pub const FRAGMENTS_MAX: u64 = 1 << 26;

/// Everything that the spec says about a scene, from one set of snapped triangles.
pub struct SpecRun {
    /// What it starts from.
    pub primitives: Primitives,
    /// Colour of each row of `prims`.
    pub faces: Vec<[f32; 4]>,
    /// Every fragment, if the plan asks for the stream.
    pub cover: Vec<Fragment>,
    /// Nearest opaque surfaces.
    pub opaque: Opaque,
    /// Linked lists as inserted, one by one, band by band ([`super::pieces`]).
    pub lists: Lists,
    /// The lists, sorted.
    pub sorted: Sorted,
    /// The picture, with bounds.
    pub image: Vec<[Bounded; 3]>,
    /// The rivals of its lists.
    pub rivals: Rivals,
    /// Time of each stage.
    pub times: Times,
}

/// Time of each stage on one core, though several may share it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Stage transform.
    pub transform: Duration,
    /// Stage clip.
    pub clip: Duration,
    /// Stage snap.
    pub snap: Duration,
    /// Stage cover.
    pub cover: Duration,
    /// Stage opaque.
    pub opaque: Duration,
    /// Stage build.
    pub build: Duration,
    /// Stage sort.
    pub sort: Duration,
    /// Stage resolve.
    pub resolve: Duration,
}

impl SpecRun {
    /// Runs the stages that the plan names.
    ///
    /// # Errors
    /// One line if the scene has more than [`FRAGMENTS_MAX`] fragments.
    pub fn new(scene: &Scene, primitives: Primitives, plan: &Plan) -> Result<Self, String> {
        let count = bands::fragments(&primitives);
        if count > FRAGMENTS_MAX {
            return Err(format!(
                "the triangles cover {count} fragments, more than the {FRAGMENTS_MAX} that a \
                 replay holds; use a smaller size or fewer triangles"
            ));
        }
        let asked = Asked {
            cover: plan.cover,
            opaque: plan.opaque,
            depth_test: plan.depth_test,
        };
        let drawn = draw(scene, &primitives, asked, count);
        Ok(Self {
            faces: faces(scene, &primitives),
            cover: drawn.cover,
            opaque: drawn.opaque,
            lists: drawn.lists,
            sorted: drawn.sorted,
            image: drawn.image,
            rivals: Rivals::new(plan.asked),
            times: Times {
                cover: drawn.times.cover,
                opaque: drawn.times.opaque,
                build: drawn.times.build,
                sort: drawn.times.sort,
                resolve: drawn.times.resolve,
                ..Times::default()
            },
            primitives,
        })
    }

    /// Every fragment, whatever the plan says.
    pub fn fragments(&self) -> Vec<Fragment> {
        let mut fragments = Vec::new();
        raster::cover(&self.primitives, |f| fragments.push(f));
        fragments
    }

    /// Most transparent fragments of a pixel in front of its opaque surface.
    pub fn layers(&self) -> u32 {
        let visible = |pixel: usize| {
            let list = self.sorted.list(pixel).iter();
            list.take_while(|f| f.key < self.opaque.key[pixel]).count()
        };
        let most = (0..self.opaque.key.len()).map(visible).max();
        u32::try_from(most.unwrap_or(0)).expect("fewer than 2^32 fragments")
    }

    /// Whether a row of `prims` is opaque.
    pub fn is_opaque(&self, prim: u32) -> bool {
        self.faces[prim as usize][3] >= 1.0
    }

    /// The picture without its bounds, as an `f32` shows it.
    pub fn picture(&self) -> Vec<[f32; 3]> {
        #[expect(clippy::cast_possible_truncation, reason = "for showing")]
        let channel = |b: Bounded| b.value as f32;
        self.image.iter().map(|p| p.map(channel)).collect()
    }
}

/// Colour of each row of `prims`.
pub fn faces(scene: &Scene, primitives: &Primitives) -> Vec<[f32; 4]> {
    primitives
        .source
        .iter()
        .map(|s| scene.triangles[*s as usize].colour)
        .collect()
}

/// A result and how long it took.
pub fn timed<T>(f: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let result = f();
    (result, start.elapsed())
}
