//! Pairs in world space: the scene's own triangles, camera rays.
//!
//! What is expected is what the spec covers with its snapped triangles; which pairs can be
//! judged is decided from the exact triangle on the screen, before Embree is asked:
//!
//! - *edge*: within one sub-pixel of the border of the triangle, clipped to the view
//!   ([`Region`]). The spec moves a corner by half a sub-pixel at most, so farther from
//!   the border it covers what the triangle itself covers.
//! - *unresolved*: farther, but within Embree's own `f32` bound, of an edge or of the ends
//!   of the ray's range ([`bound`]).
//!
//! **Depth.** A sample p in a snapped triangle has convex coordinates there; the point q of
//! the exact triangle with the same ones is at most half a sub-pixel from p in x and in y,
//! and has the depth that the spec interpolates. So the two depths at p differ by at most
//! half a sub-pixel times the slopes of depth on the screen. Floors take off less than a
//! key at the corners, and less than one more at the sample.

use rayon::slice::ParallelSliceMut;
use triptych_spec::raster::{self, Span};
use triptych_spec::scene::{Scene, Size};
use triptych_spec::vertex::{self, DEPTH_ONE, Position, Primitives};

use super::pairs::{Class, Expected, Pairs};
use crate::compare::region::{Columns, Region};
use crate::dispatch::share;
use crate::embree::world::World;
use crate::embree::world::bound::{Promise, promise};

/// Triangles of a piece of work.
const TRIANGLES: usize = 1 << 12;

/// The spec's coverage by pixel and source triangle, and the exact triangles.
pub(super) struct InWorld<'a> {
    scene: &'a Scene,
    world: &'a World,
    /// Pixel, source triangle, key; in order.
    fragments: Vec<[u32; 3]>,
    /// One for each source triangle; none if it is out of view.
    regions: Vec<Option<Region>>,
    /// Keys by which the spec's depth may differ from the exact one.
    slack: Vec<f64>,
}

impl<'a> InWorld<'a> {
    pub(super) fn new(scene: &'a Scene, world: &'a World, spec: &Primitives) -> Self {
        let mut fragments = Vec::new();
        raster::cover(spec, |f| {
            fragments.push([f.pixel, spec.source[f.prim as usize], f.key]);
        });
        fragments.par_sort_unstable();
        // Pieces of a clipped triangle overlap by less than a sub-pixel, in class edge.
        fragments.dedup_by_key(|f| [f[0], f[1]]);
        let positions = vertex::transform::<f64>(scene);
        let polygons = vertex::clip(scene, &positions);
        let subpixel = 1.0 / f64::from(1_u32 << spec.bits);
        let region = |range: &[u32]| {
            let corners = &polygons.corners[range[0] as usize..range[1] as usize];
            let screen = |[x, y, _, w]: &Position<f64>| [x / w, y / w];
            let corners: Vec<[f64; 2]> = corners.iter().map(screen).collect();
            Region::new(&corners, subpixel)
        };
        let slack = |t: &triptych_spec::scene::Triangle| {
            let slopes = slopes(t.vertices.map(|v| positions[v as usize]));
            subpixel / 2.0 * slopes * f64::from(DEPTH_ONE) * (1.0 + 1e-9) + 2.0
        };
        Self {
            scene,
            world,
            fragments,
            regions: share::runs(polygons.offsets.len() - 1, TRIANGLES, |rows| {
                rows.map(|row| region(&polygons.offsets[row..row + 2]))
                    .collect()
            }),
            slack: share::map(&scene.triangles, TRIANGLES, slack),
        }
    }

    /// The part of the triangles' area, in pixels each, that lies in the band of class
    /// edge: along the lines of samples, so that the share of samples is one of it.
    pub(super) fn band_share(&self) -> f64 {
        let size = self.scene.size;
        let lengths = |region: &Region| {
            let rows = region.rows(size);
            let all = rows.map(|row| region.columns(row, size).lengths);
            all.fold([0.0; 2], |sum, l| [sum[0] + l[0], sum[1] + l[1]])
        };
        // In order: a sum of floats is to be the same in every run.
        let each = share::map(&self.regions, TRIANGLES, |region| {
            region.as_ref().map_or([0.0; 2], lengths)
        });
        let [may, must] = each
            .iter()
            .fold([0.0; 2], |s, l| [s[0] + l[0], s[1] + l[1]]);
        if may > 0.0 { (may - must) / may } else { 0.0 }
    }
}

impl Pairs for InWorld<'_> {
    type Candidate = u32;
    type Row = Columns;

    fn size(&self) -> Size {
        self.scene.size
    }

    fn count(&self) -> u32 {
        u32::try_from(self.regions.len()).expect("a scene has fewer than 2^32 triangles")
    }

    fn candidate(&self, prim: u32) -> u32 {
        prim
    }

    fn rows(&self, prim: &u32) -> Span {
        let region = self.regions[*prim as usize].as_ref();
        region.map_or(0..0, |region| region.rows(self.scene.size))
    }

    fn reach(&self, prim: &u32, row: u32) -> (Span, Columns) {
        let region = self.regions[*prim as usize].as_ref();
        let columns = region.map(|region| region.columns(row, self.scene.size));
        let columns = columns.unwrap_or_default();
        (columns.may.clone(), columns)
    }

    fn expect(&self, prim: &u32, columns: &Columns, [column, row]: [u32; 2]) -> Expected {
        let pixel = row * self.scene.size.width + column;
        let found = self
            .fragments
            .binary_search_by_key(&[pixel, *prim], |f| [f[0], f[1]]);
        let key = found.ok().map(|at| self.fragments[at][2]);
        let class = if columns.is_open(column) {
            Class::Edge
        } else {
            let vertices = self.scene.triangles[*prim as usize].vertices;
            let view = &self.world.view;
            match (promise(self.world, vertices, &view.ray([column, row])), key) {
                (Promise::Unresolved, _) => Class::Unresolved,
                (Promise::Hit { t, bound }, Some(key)) => Class::Judged {
                    depth: Some((key, view.key_bound(t, bound) + self.slack[*prim as usize])),
                },
                _ => Class::Judged { depth: None },
            }
        };
        Expected {
            covered: key.is_some(),
            class,
        }
    }

    fn key(&self, t: f32) -> f64 {
        self.world.view.key(f64::from(t) / self.world.scale)
    }
}

/// The slopes of depth along x and y on the screen, per pixel, added up: depth is affine
/// there, and homogeneous pixels give three equations for it. Infinite for a triangle
/// that is seen edge on.
fn slopes(corners: [Position<f64>; 3]) -> f64 {
    let column = |i: usize| corners.map(|c| c[i]);
    let [x, y, z, w] = [0, 1, 2, 3].map(column);
    let det = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        let cross = crate::vector::cross(b, c);
        crate::vector::dot(a, cross)
    };
    let all = det(x, y, w);
    let slope = (det(z, y, w).abs() + det(x, z, w).abs()) / all.abs();
    if slope.is_finite() {
        slope
    } else {
        f64::INFINITY
    }
}
