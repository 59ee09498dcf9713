//! What is put together from triangles is covered exactly once.

use proptest::prelude::*;
use triptych_spec::abuffer::{build, opaque, resolve, sort};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use crate::abuffer::painted;
use crate::config;
use crate::samples::{
    self, Triangle, area, corner, depth, flat, fragments, primitives, samples, size, times,
};

/// A triangle and a grid point inside it or on its border: corners `p + u`, `p + v`
/// and `p - (i u + j v)` with `i, j >= 0`. The z of the point is not set.
fn split_at() -> impl Strategy<Value = (Size, u32, Triangle, [i32; 3])> {
    (size(), 1_u32..=8).prop_flat_map(|(size, bits)| {
        let reach = (size.width.max(size.height) << bits).cast_signed();
        let vector = || [-reach..=reach, -reach..=reach];
        let parts = (
            corner(size, bits),
            [vector(), vector()],
            [0_i32..3, 0..3],
            [depth(), depth(), depth()],
        );
        parts.prop_map(move |([x, y, _], [u, v], [i, j], z)| {
            let w: [i32; 2] = [0, 1].map(|k| -(i * u[k] + j * v[k]));
            let at = |d: [i32; 2], z| [x + d[0], y + d[1], z];
            let corners = [at(u, z[0]), at(v, z[1]), at(w, z[2])];
            (size, bits, corners, [x, y, 0])
        })
    })
}

fn parts([a, b, c]: Triangle, p: [i32; 3]) -> [Triangle; 3] {
    [[p, a, b], [b, p, c], [c, a, p]]
}

/// Corners of a star around a hub, in order, and the hub.
fn star() -> impl Strategy<Value = (Size, u32, Vec<[i32; 2]>, [i32; 2])> {
    (size(), 1_u32..=8).prop_flat_map(|(size, bits)| {
        let hub = [size.width, size.height].map(|side| samples::coordinate(side, bits));
        // The guard's ends are too far for a star; what strays is brought back.
        let near = move |x: i32| x.clamp(-(8 << bits), 28 << bits);
        (hub, prop::collection::vec(1_i32..=20 << bits, 3..12)).prop_map(move |(hub, radii)| {
            let hub = hub.map(near);
            (size, bits, rim(hub, &radii), hub)
        })
    })
}

/// Points in all directions at these distances, rounded to the grid.
fn rim(hub: [i32; 2], radii: &[i32]) -> Vec<[i32; 2]> {
    let turn = std::f64::consts::TAU / radii.len() as f64;
    let point = |(i, r): (usize, &i32)| {
        let (sin, cos) = (turn * i as f64).sin_cos();
        #[expect(clippy::cast_possible_truncation, reason = "radii are small")]
        let offset = [cos, sin].map(|s| (f64::from(*r) * s).round() as i32);
        [hub[0] + offset[0], hub[1] + offset[1]]
    };
    radii.iter().enumerate().map(point).collect()
}

/// Whether the rim goes around the hub in one sense; rounding may spoil it.
fn is_star(rim: &[[i32; 2]], hub: [i32; 2]) -> bool {
    around(rim).all(|(a, b)| area(hub, a, b) >= 0)
}

/// The edges of a closed line.
fn around<T: Copy>(points: &[T]) -> impl Iterator<Item = (T, T)> {
    let next = points.iter().cycle().skip(1);
    points.iter().copied().zip(next.copied())
}

/// Triangles from the hub to every edge of the rim, wound at random.
fn fan(rim: &[[i32; 3]], hub: [i32; 3], winding: u64) -> Vec<Triangle> {
    let turned = |(i, (a, b))| match winding >> (i % 64) & 1 {
        0 => [hub, a, b],
        _ => [b, a, hub],
    };
    around(rim).enumerate().map(turned).collect()
}

/// How often a closed line goes around a point; `None` if the point is on it.
fn winding_number(line: &[[i32; 2]], [x, y]: [i128; 2]) -> Option<i32> {
    let mut number = 0;
    for (a, b) in around(line) {
        let ([ax, ay], [bx, by]) = (a.map(i128::from), b.map(i128::from));
        let side = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)).signum();
        let within =
            (ax.min(bx)..=ax.max(bx)).contains(&x) && (ay.min(by)..=ay.max(by)).contains(&y);
        if side == 0 && within {
            return None;
        }
        match (ay <= y, by <= y) {
            (true, false) if side == -1 => number -= 1,
            (false, true) if side == 1 => number += 1,
            _ => {}
        }
    }
    Some(number)
}

/// Vertices of a mesh and its triangles, each wound as its neighbours require.
type Closed = (Size, u32, Vec<[i32; 3]>, Vec<[usize; 3]>);

/// A torus, topologically, with its vertices anywhere.
fn torus() -> impl Strategy<Value = Closed> {
    (size(), 1_u32..=8, 3_usize..5, 3_usize..5).prop_flat_map(|(size, bits, m, n)| {
        let at = move |i: usize, j: usize| (i % m) * n + j % n;
        let quad = move |q: usize| {
            let (i, j) = (q / n, q % n);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let faces: Vec<[usize; 3]> = (0..m * n).flat_map(quad).collect();
        let vertices = prop::collection::vec(corner(size, bits), m * n);
        (Just(size), Just(bits), vertices, Just(faces))
    })
}

fn sign([a, b, c]: Triangle) -> i64 {
    area(flat(a), flat(b), flat(c)).signum()
}

/// What lies in a rectangle of sub-pixels, right and lower side excluded, is covered
/// once; nothing else is.
fn once_within(soup: &Primitives, low: [i32; 2], high: [i32; 2]) -> Result<(), TestCaseError> {
    let times = times(soup);
    for (pixel, at) in samples(soup.size, soup.bits) {
        let inside = (0..2).all(|k| i128::from(low[k]) <= at[k] && at[k] < i128::from(high[k]));
        prop_assert_eq!(times[pixel as usize], u32::from(inside), "at {:?}", at);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(1000))]

    /// Split at a point of its plane, a triangle is the sum of its parts: each pixel
    /// once, with equal keys.
    #[test]
    fn split_on_the_plane((size, bits, corners, p) in split_at(), slope in [-900..900, -900..900]) {
        // 2^30 - 2 * 900 * 2^19 > 0, and 2^30 + 2 * 900 * 2^19 < 2^31.
        prop_assume!(corners.iter().flat_map(|c| &c[..2]).all(|v| v.abs() <= 1 << 19));
        let on = |[x, y, _]: [i32; 3]| [x, y, (1 << 30) + slope[0] * x + slope[1] * y];
        let (corners, p) = (corners.map(on), on(p));
        let whole = fragments(&primitives(size, bits, &[corners]));
        let mut sum = fragments(&primitives(size, bits, &parts(corners, p)));
        sum.iter_mut().for_each(|f| f.prim = 0);
        sum.sort();
        prop_assert_eq!(sum, whole);
    }

    /// So its parts, of its colour, give the same picture, to the bit, before whatever
    /// lies behind.
    #[test]
    fn split_leaves_the_picture(
        (size, bits, corners, p) in split_at(),
        colour in [0_f32..2.0, 0_f32..2.0, 0_f32..2.0, 0_f32..1.0],
        behind in [0_f32..1.0, 0_f32..1.0, 0_f32..1.0],
    ) {
        let level = |[x, y, _]: [i32; 3]| [x, y, 1 << 30];
        let (corners, p) = (corners.map(level), level(p));
        let picture = |triangles: &[Triangle]| {
            let primitives = primitives(size, bits, triangles);
            let scene = painted(&primitives, &vec![colour; triangles.len()], behind);
            let opaque = opaque(&scene, &primitives);
            let lists = build(&scene, &primitives, &opaque, true, u32::MAX);
            resolve(&scene, &primitives, &opaque, &sort(&lists))
        };
        prop_assert_eq!(picture(&parts(corners, p)), picture(&[corners]));
    }

    /// With the point's depth rounded down to a key, a part's plane lies less than one
    /// key before the whole's: its keys are equal or one less.
    #[test]
    fn split_beside_the_plane((size, bits, corners, p) in split_at()) {
        prop_assume!(sign(corners) != 0);
        let z = super::depth(corners, [p[0], p[1]].map(i128::from));
        let p = [p[0], p[1], i32::try_from(z).expect("between the corners' keys")];
        let whole = fragments(&primitives(size, bits, &[corners]));
        let mut sum = fragments(&primitives(size, bits, &parts(corners, p)));
        sum.sort_by_key(|f| f.pixel);
        prop_assert_eq!(sum.len(), whole.len());
        for (part, whole) in sum.iter().zip(&whole) {
            prop_assert_eq!(part.pixel, whole.pixel);
            prop_assert!(part.key == whole.key || part.key + 1 == whole.key, "{part:?} {whole:?}");
        }
    }

    /// A closed fan covers what lies inside its rim exactly once, what lies outside
    /// never, and its border at most once.
    #[test]
    fn fan_covers_once((size, bits, rim, hub) in star(), z in depth(), winding in any::<u64>()) {
        prop_assume!(is_star(&rim, hub));
        let lift = |[x, y]: [i32; 2]| [x, y, z];
        let corners: Vec<[i32; 3]> = rim.iter().copied().map(lift).collect();
        let times = times(&primitives(size, bits, &fan(&corners, lift(hub), winding)));
        for (pixel, at) in samples(size, bits) {
            match winding_number(&rim, at) {
                None => prop_assert!(times[pixel as usize] <= 1, "on the border at {at:?}"),
                Some(n) => prop_assert_eq!(times[pixel as usize], n.unsigned_abs(), "at {:?}", at),
            }
        }
    }

    /// A grid of triangles with straight borders covers its rectangle exactly once,
    /// wherever its inner vertices are, whichever way cells are cut and wound.
    #[test]
    fn grid_covers_once(
        size in size(),
        bits in 1_u32..=8,
        [columns, rows] in [1_i32..6, 1..6],
        cell in 4_i32..2000,
        origin in [-1000_i32..1000, -1000..1000],
        random in prop::collection::vec(any::<[u16; 3]>(), 36),
    ) {
        let vertex = |i: i32, j: i32| {
            // Under a quarter of a cell, no triangle turns over.
            let reach = (cell - 1) / 4;
            let [dx, dy, z] = random[usize::try_from(j * 6 + i).expect("in range")].map(i32::from);
            let stray = |d: i32, n: i32, last: i32| match n {
                0 => 0,
                _ if n == last => 0,
                _ => d % (2 * reach + 1) - reach,
            };
            [
                origin[0] + i * cell + stray(dx, i, columns),
                origin[1] + j * cell + stray(dy, j, rows),
                z,
            ]
        };
        let mut triangles = Vec::new();
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            triangles.extend(match (a[2] + c[2]) % 4 {
                0 => [[a, b, c], [a, c, d]],
                1 => [[a, b, c], [d, c, a]],
                2 => [[a, b, d], [b, c, d]],
                _ => [[d, b, a], [b, c, d]],
            });
        }
        let high = [origin[0] + columns * cell, origin[1] + rows * cell];
        once_within(&primitives(size, bits, &triangles), origin, high)?;
    }

    /// A closed surface, even one that goes through itself, is entered as often as it
    /// is left: at each sample as many triangles face one way as the other.
    #[test]
    fn closed_meshes_balance((size, bits, vertices, faces) in torus()) {
        let corners: Vec<Triangle> = faces.iter().map(|f| f.map(|v| vertices[v])).collect();
        let mut sum = vec![0; size.pixels()];
        for f in fragments(&primitives(size, bits, &corners)) {
            sum[f.pixel as usize] += sign(corners[f.prim as usize]);
        }
        prop_assert_eq!(sum, vec![0; size.pixels()]);
    }

    /// Along depth, bodies behind one another are entered and left by turns.
    #[test]
    fn closed_bodies_alternate(
        (size, bits, rim, hub) in star(),
        heights in prop::collection::vec([0_i32..1000, 0..1000], 1..5),
    ) {
        prop_assume!(is_star(&rim, hub));
        let (mut triangles, mut enters) = (Vec::new(), Vec::new());
        let mut z = 0;
        for [front, back] in heights {
            let middle = z + front;
            let corners: Vec<[i32; 3]> = rim.iter().map(|[x, y]| [*x, *y, middle]).collect();
            for (tip, enter) in [(z, true), (middle + back, false)] {
                let side = fan(&corners, [hub[0], hub[1], tip], if enter { 0 } else { u64::MAX });
                enters.extend(side.iter().map(|_| enter));
                triangles.extend(side);
            }
            z = middle + back + 1;
        }
        let mut all = fragments(&primitives(size, bits, &triangles));
        all.sort_by_key(|f| (f.pixel, f.key, !enters[f.prim as usize]));
        for body in all.chunks(2) {
            prop_assert_eq!(body.len(), 2);
            prop_assert_eq!(body[0].pixel, body[1].pixel);
            prop_assert_eq!([0, 1].map(|i| enters[body[i].prim as usize]), [true, false]);
        }
    }
}
