//! The same of a scene whose fragments are too many to be kept.

use triptych_gpu::raster::SATURATED;
use triptych_spec::abuffer::{NOTHING, Opaque, opaque, visible};
use triptych_spec::raster;
use triptych_spec::scene::{Scene, Size};
use triptych_spec::tiles::SIDE;
use triptych_spec::vertex::Primitives;

use super::{Counts, histogram};
use crate::plan::Plan;
use crate::replay::spec::faces;

/// What was counted.
pub struct Counted {
    /// What formulas are made of.
    pub counts: Counts,
    /// Fragments in the lists of each row of pixels.
    pub rows: Vec<u32>,
    /// The nearest opaque surface at each sample.
    pub opaque: Opaque,
}

impl Counts {
    /// Of a scene with any number of fragments, which are counted and not kept.
    ///
    /// # Errors
    /// One line for more fragments in lists than a word counts.
    pub fn counted(scene: &Scene, primitives: &Primitives, plan: &Plan) -> Result<Counted, String> {
        let faces = faces(scene, primitives);
        let surfaces = match plan.opaque {
            true => opaque(scene, primitives),
            false => Opaque::nothing(primitives),
        };
        let pixels = primitives.size.pixels();
        let (mut lists, mut seen) = (vec![0_u32; pixels], vec![0_u32; pixels]);
        let (mut considered, mut opaque_fragments) = (0, 0);
        raster::cover(primitives, |f| {
            if faces[f.prim as usize][3] >= 1.0 {
                opaque_fragments += 1;
                return;
            }
            considered += 1;
            let is_seen = visible(primitives, &surfaces, &f) != 0;
            lists[f.pixel as usize] += u32::from(!plan.depth_test || is_seen);
            seen[f.pixel as usize] += u32::from(is_seen);
        });
        let fragments: u64 = lists.iter().map(|list| u64::from(*list)).sum();
        if fragments >= u64::from(SATURATED) {
            return Err(format!(
                "{fragments} fragments in lists, more than the {} that are counted",
                SATURATED - 1
            ));
        }
        let rows = lists.chunks(primitives.size.width as usize);
        let opaque_triangles = faces.iter().filter(|face| face[3] >= 1.0).count() as u64;
        let counts = Self {
            pixels: pixels as u64,
            fragments,
            considered,
            opaque_fragments,
            opaque_pixels: surfaces.prim.iter().filter(|p| **p != NOTHING).count() as u64,
            transparent: faces.len() as u64 - opaque_triangles,
            opaque: opaque_triangles,
            lengths: histogram(lists.iter().copied()),
            seen: histogram(seen.into_iter()),
            rows: self::rows(&lists, primitives.size),
        };
        Ok(Counted {
            rows: rows.map(|row| row.iter().sum()).collect(),
            counts,
            opaque: surfaces,
        })
    }
}

/// Words that tell of the rows of tiles, from the lengths of all lists.
pub(super) fn rows(lists: &[u32], size: Size) -> u64 {
    let across = size.width.div_ceil(SIDE) as usize;
    let mut longest = vec![0; across * size.height.div_ceil(SIDE) as usize];
    for (y, row) in lists.chunks(size.width as usize).enumerate() {
        for (x, length) in row.iter().enumerate() {
            let tile = &mut longest[y / SIDE as usize * across + x / SIDE as usize];
            *tile = (*length).max(*tile);
        }
    }
    longest.iter().map(|length| 1 + u64::from(*length)).sum()
}

#[cfg(test)]
mod tests {
    use triptych_spec::vertex::primitives;

    use super::*;
    use crate::corpus;
    use crate::replay::spec::SpecRun;
    use crate::scene::load;

    /// What is counted by itself is what lists have.
    #[test]
    fn fragments_are_counted_as_they_are_stored() {
        for name in ["mixed", "msaa-mixed", "quads"] {
            let file = corpus::root().join("abuffer").join(name).join("scene.toml");
            let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
            let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
            let prims = primitives(scene, 8);
            let counted = Counts::counted(scene, &prims, &plan).unwrap();
            let run = SpecRun::new(scene, prims, &plan).unwrap();
            assert_eq!(counted.counts, Counts::of(&run), "{name}");
            assert!(counted.opaque == run.opaque, "{name}");
            assert_eq!(counted.rows, run.sorted.rows(scene.size.width), "{name}");
        }
    }
}
