//! `--vertex hardware`: coverage where the driver divides, clips and snaps.
//!
//! The driver is handed clip space as `f32`; these numbers are the input, and exact. The
//! triangle on the screen follows in `f64`, clipped to the view. What the driver does
//! before it rasterises puts a corner elsewhere by at most a *reach* (module `reach`) and one
//! step of its grid, whichever way it rounds; [`Region`] says what it then must, may and
//! must not cover. A triangle whose reach exceeds [`REACH_MAX`] is not judged, and counted:
//! it is cut so near the eye that rounding decides where it is.
//!
//! Depth keys are not compared: the rasterised corners are known only up to the reach.

mod reach;

use std::collections::BTreeMap;

use triptych_spec::raster::Fragment;
use triptych_spec::scene::{Scene, Size};
use triptych_spec::vertex::{self, GUARD, Plane, Position, clip_triangle, guard_origin};

use super::region::{Columns, REACH_MAX, Region};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::dispatch::share;
use crate::row::Class;
use reach::Reach;

/// Triangles of a piece of work.
const TRIANGLES: usize = 1 << 12;

/// Half the viewport, in pixels.
const HALF: f64 = GUARD as f64 / 2.0;

/// What a driver is handed, and what it must make of it.
pub struct Handed {
    size: Size,
    /// Clip space of the guard rectangle, by source triangle.
    pub triangles: Vec<[Position<f32>; 3]>,
    places: Vec<Place>,
}

/// Where a triangle is on the screen.
#[derive(Clone, Debug, PartialEq)]
enum Place {
    /// Out of view.
    Nowhere,
    /// In view.
    There(Region),
    /// In view, and too near the eye.
    Unjudged,
}

impl Handed {
    /// A scene's triangles for a driver whose grid has steps of `step` pixels.
    pub fn new(scene: &Scene, step: f64) -> Self {
        let positions = vertex::transform::<f64>(scene);
        let middle = [scene.size.width, scene.size.height].map(middle);
        let clip = |[x, y, z, w]: Position<f64>| {
            let of = |v: f64, middle: f64| (v - middle * w) / HALF;
            #[expect(clippy::cast_possible_truncation, reason = "the one rounding")]
            [of(x, middle[0]), -of(y, middle[1]), z, w].map(|v| v as f32)
        };
        let corners =
            |t: &triptych_spec::scene::Triangle| t.vertices.map(|v| clip(positions[v as usize]));
        let triangles: Vec<_> = scene.triangles.iter().map(corners).collect();
        let place = |t: &[Position<f32>; 3]| place(scene.size, *t, step);
        Self {
            size: scene.size,
            places: share::map(&triangles, TRIANGLES, place),
            triangles,
        }
    }

    /// Judges a driver's fragments, which are sorted here: those of judged triangles, and
    /// the triangles.
    pub fn judge(&self, seen: &[Fragment]) -> [Judgement; 2] {
        let mut rows = BTreeMap::<(u32, u32), Vec<u32>>::new();
        let width = self.size.width;
        for f in seen {
            let row = rows.entry((f.prim, f.pixel / width)).or_default();
            row.push(f.pixel % width);
        }
        rows.values_mut()
            .for_each(|columns| columns.sort_unstable());
        let mut pairs = Pairs::new(width);
        for (prim, place) in (0_u32..).zip(&self.places) {
            let region = match place {
                Place::There(region) => Some(region),
                Place::Nowhere => None,
                // What the driver makes of it is neither right nor wrong.
                Place::Unjudged => continue,
            };
            let within = region.map_or(0..0, |region| region.rows(self.size));
            for row in within {
                let columns = region.map(|region| region.columns(row, self.size));
                let seen = rows.remove(&(prim, row)).unwrap_or_default();
                pairs.row(prim, row, &columns.unwrap_or_default(), &seen);
            }
        }
        let judged = |prim: u32| self.places[prim as usize] != Place::Unjudged;
        for ((prim, row), seen) in rows.into_iter().filter(|((prim, _), _)| judged(*prim)) {
            pairs.row(prim, row, &Columns::default(), &seen);
        }
        [pairs.finish(self.size), self.triangles_judged()]
    }

    /// How many triangles are judged at all.
    fn triangles_judged(&self) -> Judgement {
        let mut judgement = Judgement::new(Class::Band, "triangles");
        judgement.compared = self.places.len() as u64;
        let unjudged = self.places.iter().filter(|p| **p == Place::Unjudged);
        judgement.admitted = unjudged.count() as u64;
        let (unjudged, all) = (judgement.admitted, judgement.compared);
        judgement.note = format!(
            "{unjudged} of {all} triangles unjudged: a corner may be off by more than \
             {REACH_MAX} pixels"
        );
        if unjudged == all {
            judgement.skipped = Some(judgement.note.clone());
        }
        judgement
    }
}

/// The pairs of a sample and a triangle.
struct Pairs {
    judgement: Judgement,
    width: u32,
    /// Those that may be covered, and are.
    open: u64,
}

impl Pairs {
    fn new(width: u32) -> Self {
        Self {
            judgement: Judgement::new(Class::Band, "pairs"),
            width,
            open: 0,
        }
    }

    /// Judges a row of a triangle; `seen` is sorted.
    fn row(&mut self, prim: u32, row: u32, columns: &Columns, seen: &[u32]) {
        let Columns { may, must, .. } = columns;
        let twice = |i: usize| i > 0 && seen[i - 1] == seen[i];
        let outside = |column: &&u32| !may.contains(column);
        self.judgement.compared += may.len() as u64;
        self.judgement.admitted += (may.len() - must.len()) as u64;
        for column in must.clone() {
            if seen.binary_search(&column).is_err() {
                self.differs(
                    Cause::Coverage,
                    prim,
                    [column, row],
                    "must be covered, is not, by",
                );
            }
        }
        for (i, column) in seen.iter().enumerate() {
            if twice(i) {
                let words = "is covered more than once by";
                self.differs(Cause::Duplicate, prim, [*column, row], words);
            } else if outside(&column) {
                self.judgement.compared += 1;
                let words = "must not be covered, is, by";
                self.differs(Cause::Coverage, prim, [*column, row], words);
            } else if !must.contains(column) {
                self.open += 1;
            }
        }
    }

    fn differs(&mut self, cause: Cause, prim: u32, [column, row]: [u32; 2], words: &str) {
        let pixel = row * self.width + column;
        let width = self.width;
        self.judgement.differs(cause, Some(pixel), || {
            format!("{} {words} triangle {prim}", at(pixel, width))
        });
    }

    fn finish(self, size: Size) -> Judgement {
        let mut judgement = self.judgement;
        let (may, all) = (judgement.admitted, judgement.compared);
        if all == 0 {
            judgement.unit = "empty pixels";
            judgement.compared = size.pixels() as u64;
            return judgement;
        }
        // Any share passes, short of all: the column of such shares shows it.
        judgement.admitted_budget = Some(1.0);
        let share = 100.0 * may as f64 / all as f64;
        judgement.note = format!(
            "MAY: {may} of {all} pairs ({share:.2} %), {} of these are covered",
            self.open
        );
        if may == all && judgement.differ() == 0 {
            judgement.skipped = Some(format!("all {all} pairs may go either way"));
        }
        judgement
    }
}

/// Where a triangle is, once it is divided and clipped.
fn place(size: Size, corners: [Position<f32>; 3], step: f64) -> Place {
    let exact = corners.map(|c| c.map(f64::from));
    let middle = [size.width, size.height].map(middle);
    let pixel =
        |[x, y, z, w]: Position<f64>| [x * HALF + middle[0] * w, -y * HALF + middle[1] * w, z, w];
    let pixels = exact.map(pixel);
    let polygon = clip_triangle(&Plane::all(size), pixels, |_, plain| plain);
    if polygon.is_empty() {
        return Place::Nowhere;
    }
    let screen = |[x, y, _, w]: &Position<f64>| [x / w, y / w];
    let corners: Vec<[f64; 2]> = polygon.iter().map(screen).collect();
    let reach = reach(size, exact, pixels).before_snapping();
    let region = Region::new(&corners, step + reach);
    region.map_or(Place::Unjudged, Place::There)
}

/// What the reach of a triangle follows from: its corners in clip space, and in pixels before
/// their division.
fn reach(size: Size, corners: [Position<f64>; 3], pixels: [Position<f64>; 3]) -> Reach {
    let [near, far, ..] = Plane::all(size);
    let middle = [size.width, size.height].map(middle);
    // Clipped in depth alone: a driver need not clip x and y.
    let deep = clip_triangle(&[near, far, near, far, near, far], pixels, |_, plain| plain);
    let normalised = |[x, y, _, w]: &Position<f64>| {
        [
            (x / w - middle[0]) / HALF,
            (y / w - middle[1]) / HALF,
            1.0 / w,
        ]
    };
    Reach {
        corners,
        deep: deep.iter().map(normalised).collect(),
        target: [size.width, size.height].map(|side| f64::from(side) / 2.0 / HALF),
        middle: middle[0].abs().max(middle[1].abs()),
    }
}

/// The middle of the viewport along an axis, in pixels of the target.
fn middle(side: u32) -> f64 {
    f64::from(guard_origin(side)) + HALF
}

#[cfg(test)]
mod tests;
