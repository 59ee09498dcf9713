//! How far a driver may put a corner from where it belongs, before it rounds to its grid.
//!
//! With U = 2^-23, H half the viewport in pixels, N the largest normalised coordinate of a
//! corner, C the distance of the viewport's middle from the target's first pixel:
//!
//! **Division and viewport.** No rule binds the divider; it is taken to be as good as
//! WGSL's. A reciprocal within 2.5 U and a product, 3.5 U, then a product and a sum:
//! `U (4.5 H N + (H N + C))`. A rasteriser's grid reaches 2^16 pixels at most, so beyond
//! N = 32 a driver clips.
//!
//! **Clipping**, where a corner lies outside the view. A new point is `A + t (B - A)`, with
//! t a quotient of distances whose signs differ, so that nothing cancels: 1 U for each
//! distance, 1 for their difference, 2.5 for the quotient, then a difference, a product
//! and a sum; or `(a B - b A) / (a - b)`, which has fewer. In each component that is at most
//! `e = 8 U (|B - A| + max(|A|, |B|))`, for each plane that cuts. On the screen it is
//! `H (e_x + N e_w) / w`. Distances of the given corners have certain signs: z is exact,
//! and a rounded `w - z` or `w - |x|` keeps its sign.
//!
//! **Far ends.** A corner far outside of the target is off by more than matters: where its
//! sides are near the target counts. Moved ends a and b move a point G between them by at
//! most `(1 - s) m_a + s m_b`, with s the share of the way from a to G. A driver may also
//! clip the side on the way, at G or anywhere between G and an end, at R. Then that end's
//! part is `|aG| / |aR| m_R`. Along a side N is convex and 1 / w affine, so where both grow
//! outwards that is convex in |aR|, and largest at G or at b; else the larger N over the
//! smaller w bounds it. So G moves by at most
//!
//! ```text
//! max(m_G, (1 - s) m_a) + max(m_G, s m_b)
//! ```
//!
//! and the reach is the most of that for the sides' parts within [`REACH_MAX`] of the target.
//! What is farther moves by less than its distance from there, as long as `(e_x + e_w) / v`
//! is small, with v the least w in view; other sides must not move by more than
//! [`REACH_MAX`] in the viewport.

use triptych_spec::bound::U;
use triptych_spec::vertex::Position;

use super::HALF;
use crate::compare::region::REACH_MAX;

/// Largest `(e_x + e_w) / v`: what lies farther out moves by an eighth more.
const FAR_MAX: f64 = 0.125;

/// A triangle, and what of it is in view.
pub(super) struct Reach {
    /// Clip space.
    pub corners: [Position<f64>; 3],
    /// Clipped in depth alone: normalised x and y, and 1 / w.
    pub deep: Vec<[f64; 3]>,
    /// Half the target, normalised.
    pub target: [f64; 2],
    /// The distance C.
    pub middle: f64,
}

/// What clipping does to x or y, and to w.
#[derive(Clone, Copy)]
struct Errors {
    x: f64,
    w: f64,
}

impl Reach {
    /// The reach, in pixels.
    pub fn before_snapping(&self) -> f64 {
        let error = |k| self.cuts() * 8.0 * U * self.extent(k);
        let errors = Errors {
            x: error(0).max(error(1)),
            w: error(3),
        };
        // The largest 1 / w, once w is off.
        let steepest = self.deep.iter().fold(0.0_f64, |m, c| m.max(c[2]));
        if (errors.x + errors.w) * steepest > FAR_MAX {
            return f64::INFINITY;
        }
        let near = self.target.map(|half| half + REACH_MAX / HALF);
        let ends = self.deep.iter().zip(self.deep.iter().cycle().skip(1));
        let mut reach = 0.0_f64;
        for (a, b) in ends {
            let of = |half| part(*a, *b, half).map(|part| self.moves([*a, *b], part, errors));
            match (of(near), of([1.0; 2])) {
                (Some(moves), _) => reach = reach.max(moves),
                (None, Some(moves)) if moves > REACH_MAX => return f64::INFINITY,
                (None, _) => {}
            }
        }
        // Products of two errors (1 / w is off by an eighth at most), and what `f64` rounds.
        let second = 1.0 / (1.0 - errors.w * steepest) + 1e-3;
        reach.max(self.alone([1.0, 1.0], Errors { x: 0.0, w: 0.0 })) * second
    }

    /// By how much a corner with this N and 1 / w moves.
    fn alone(&self, [largest, inverse]: [f64; 2], errors: Errors) -> f64 {
        let clipping = HALF * (errors.x + largest * errors.w) * inverse;
        U * (5.5 * HALF * largest + self.middle) + clipping
    }

    /// By how much a part of a side moves at most.
    fn moves(&self, ends: [[f64; 3]; 2], part: [f64; 2], errors: Errors) -> f64 {
        let [a, b] = ends;
        let size = |[x, y, inverse]: [f64; 3]| [x.abs().max(y.abs()), inverse];
        let at = |s: f64| size([0, 1, 2].map(|i| a[i] + s * (b[i] - a[i])));
        let larger = |p: [f64; 2], q: [f64; 2]| [p[0].max(q[0]), p[1].max(q[1])];
        let within = larger(at(part[0]), at(part[1]));
        let far = |end: [f64; 2], share: f64| {
            let outwards = end[0] >= within[0] && end[1] >= within[1];
            let (end, share) = match outwards {
                true => (end, share),
                false => (larger(end, within), 1.0),
            };
            self.alone(within, errors)
                .max(share * self.alone(end, errors))
        };
        far(size(a), 1.0 - part[0]) + far(size(b), part[1])
    }

    /// How many planes of the clip volume cut.
    fn cuts(&self) -> f64 {
        let outside: [fn(&Position<f64>) -> bool; 6] = [
            |c| c[2] < 0.0,
            |c| c[2] > c[3],
            |c| c[0] < -c[3],
            |c| c[0] > c[3],
            |c| c[1] < -c[3],
            |c| c[1] > c[3],
        ];
        let cuts = outside.iter().filter(|is| self.corners.iter().any(**is));
        cuts.count() as f64
    }

    /// `|B - A| + max(|A|, |B|)` in a component, for any two corners.
    fn extent(&self, k: usize) -> f64 {
        let of = self.corners.map(|c| c[k]);
        let low = of.iter().copied().fold(f64::INFINITY, f64::min);
        let high = of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (high - low) + high.abs().max(low.abs())
    }
}

/// The part of a segment, from 0 to 1, that lies in a rectangle around the origin (Liang and
/// Barsky 1984).
fn part(a: [f64; 3], b: [f64; 3], half: [f64; 2]) -> Option<[f64; 2]> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let d = b[axis] - a[axis];
        if d == 0.0 {
            if a[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        let [p, q] = [-half[axis], half[axis]].map(|edge| (edge - a[axis]) / d);
        first = first.max(p.min(q));
        last = last.min(p.max(q));
    }
    (first <= last).then_some([first, last])
}

#[cfg(test)]
mod tests;
