//! Stage clip.

use super::{CORNERS_MAX, GUARD, Polygons, Position, guard_origin, row};
use crate::bound::Real;
use crate::scene::{Scene, Size, Triangle};

/// A half-space that clipping keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// Depth at least 0.
    Near,
    /// Depth at most 1.
    Far,
    /// At or right of the guard's left edge.
    Left(i32),
    /// At or left of the guard's right edge.
    Right(i32),
    /// At or below the guard's top edge.
    Top(i32),
    /// At or above the guard's bottom edge.
    Bottom(i32),
}

impl Plane {
    /// The six planes in the order in which polygons are cut. Near comes first:
    /// behind it `w` is positive and the others are meaningful.
    pub fn all(size: Size) -> [Self; 6] {
        let (x, y) = (guard_origin(size.width), guard_origin(size.height));
        [
            Self::Near,
            Self::Far,
            Self::Left(x),
            Self::Right(x + GUARD),
            Self::Top(y),
            Self::Bottom(y + GUARD),
        ]
    }

    /// Signed distance, up to a positive factor; kept where it is not negative.
    pub fn distance<T: Real>(self, [x, y, z, w]: Position<T>) -> T {
        let at = |edge: i32| T::exact(f64::from(edge)).mul(w);
        match self {
            Self::Near => z,
            Self::Far => w.sub(z),
            Self::Left(edge) => x.sub(at(edge)),
            Self::Right(edge) => at(edge).sub(x),
            Self::Top(edge) => y.sub(at(edge)),
            Self::Bottom(edge) => at(edge).sub(y),
        }
    }
}

/// Stage `clip`: cuts every triangle to the view's depth range and the guard
/// rectangle (Sutherland and Hodgman 1974).
///
/// An edge's new point is computed from its two ends in an order that does not
/// depend on the triangle, so that neighbours get the same point, to the bit.
pub fn clip<T: Real>(scene: &Scene, positions: &[Position<T>]) -> Polygons<T> {
    clip_run(scene.size, &scene.triangles, positions)
}

/// [`clip`] of some of a scene's triangles.
pub fn clip_run<T: Real>(
    size: Size,
    triangles: &[Triangle],
    positions: &[Position<T>],
) -> Polygons<T> {
    let planes = Plane::all(size);
    let mut clipper = Clipper::default();
    let mut polygons = Polygons {
        offsets: vec![0],
        corners: Vec::new(),
    };
    for triangle in triangles {
        let corners = triangle.vertices.map(|v| positions[v as usize]);
        let polygon = clipper.clip(&planes, corners, |_, plain| plain);
        polygons.corners.extend_from_slice(polygon);
        polygons.offsets.push(row(polygons.corners.len()));
    }
    polygons
}

/// Clips one triangle; empty if nothing is left.
///
/// Every branch asks `decide`, with the number whose sign decides and with what
/// that sign says: whoever knows that an `f32` evaluation may see the other sign
/// can follow the other branch.
pub fn clip_triangle<T: Real>(
    planes: &[Plane; 6],
    corners: [Position<T>; 3],
    decide: impl FnMut(T, bool) -> bool,
) -> Vec<Position<T>> {
    Clipper::default().clip(planes, corners, decide).to_vec()
}

/// What is left of a triangle while it is clipped. The room is kept from one to the next: most
/// are not cut at all.
struct Clipper<T> {
    polygon: Vec<Position<T>>,
    sides: Vec<Side<T>>,
    kept: Vec<Position<T>>,
}

impl<T> Default for Clipper<T> {
    fn default() -> Self {
        Self {
            polygon: Vec::with_capacity(CORNERS_MAX),
            sides: Vec::with_capacity(CORNERS_MAX),
            kept: Vec::with_capacity(CORNERS_MAX),
        }
    }
}

impl<T: Real> Clipper<T> {
    /// [`clip_triangle`].
    fn clip(
        &mut self,
        planes: &[Plane; 6],
        corners: [Position<T>; 3],
        mut decide: impl FnMut(T, bool) -> bool,
    ) -> &[Position<T>] {
        self.polygon.clear();
        self.polygon.extend(corners);
        for plane in planes {
            self.sides.clear();
            self.sides.extend(self.polygon.iter().map(|p| {
                let distance = plane.distance(*p);
                let inside = decide(distance, distance.value() >= 0.0);
                Side { distance, inside }
            }));
            if self.sides.iter().any(|side| !side.inside) {
                self.cut();
            }
        }
        // Fewer than three corners are left only of a triangle without area.
        let visible = self.polygon.len() >= 3
            && (self.polygon.iter()).all(|p| decide(p[3], p[3].value() > 0.0));
        if visible { &self.polygon } else { &[] }
    }

    /// Keeps what is inside.
    fn cut(&mut self) {
        let Self {
            polygon,
            sides,
            kept,
        } = self;
        kept.clear();
        for (i, (&a, &side_a)) in polygon.iter().zip(&*sides).enumerate() {
            let next = (i + 1) % polygon.len();
            let (b, side_b) = (polygon[next], sides[next]);
            if side_a.inside {
                kept.push(a);
            }
            if side_a.inside != side_b.inside {
                kept.push(canonical_crossing(a, side_a.distance, b, side_b.distance));
            }
        }
        std::mem::swap(polygon, kept);
    }
}

/// Where a corner lies with respect to a plane.
#[derive(Clone, Copy)]
struct Side<T> {
    distance: T,
    inside: bool,
}

/// The same point whichever of two neighbours asks.
fn canonical_crossing<T: Real>(a: Position<T>, da: T, b: Position<T>, db: T) -> Position<T> {
    let (first, second) = if precedes(&a, &b) {
        ((a, da), (b, db))
    } else {
        ((b, db), (a, da))
    };
    let plain = crossing(first.0, first.1, second.0, second.1);
    // An f32 evaluation orders the ends alike if their first components, as far as
    // they may stray, leave no doubt; otherwise it may start from the other end.
    if a[0].certainly_differs(b[0]) {
        return plain;
    }
    let other = crossing(second.0, second.1, first.0, first.1);
    [0, 1, 2, 3].map(|i| plain[i].or(other[i]))
}

/// The point between `a` and `b` where the distance is zero.
fn crossing<T: Real>(a: Position<T>, da: T, b: Position<T>, db: T) -> Position<T> {
    let t = da.fraction(db);
    [0, 1, 2, 3].map(|i| a[i].add(t.mul(b[i].sub(a[i]))))
}

/// A total order of positions by their numbers alone.
fn precedes<T: Real>(a: &Position<T>, b: &Position<T>) -> bool {
    let mut order = std::cmp::Ordering::Equal;
    for (a, b) in a.iter().zip(b) {
        order = order.then_with(|| a.value().total_cmp(&b.value()));
    }
    order.is_lt()
}
