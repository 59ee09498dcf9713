//! Blurred and composed: light goes nowhere where it was not.

use proptest::prelude::*;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{Coarse, Colour, Frame, Model, Surface, blur, compose, same};
use triptych_spec::scene::Size;

use super::{Scene, scenes, volume};
use crate::config;

fn grey(value: f64) -> Colour {
    [Bounded { value, bound: 0.0 }; 3]
}

/// Whether two surfaces are one by the definition in fractions: near each other's planes,
/// and turned the same way. `None` where rounded normals may decide otherwise.
fn one(model: &Model, a: &Surface, b: &Surface, edge: u32) -> Option<bool> {
    let exact = |s: &Surface| {
        let corners = model.corners(s.triangle);
        let n = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|axis| volume(corners, axis) as f64);
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        n.map(|c| c / length * f64::from(s.side))
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (m, n) = (exact(a), exact(b));
    let d = [0, 1, 2].map(|i| f64::from(a.point[i] - b.point[i]));
    let length: f64 = d.iter().map(|c| c.abs()).sum();
    // Components of normals are off by half of 2^-14.
    let room = length / f64::from(1 << 15);
    let heights = [m, n].map(|n| dot(n, d).abs() - f64::from(edge));
    let turn = dot(m, n);
    // Two normals are off by as much, each times the other's sum of components.
    let unsure = turn.abs() <= 4.0 / f64::from(1 << 15) || heights.iter().any(|h| h.abs() <= room);
    let same = turn > 0.0 && heights.iter().all(|h| *h < 0.0);
    (!unsure && turn.is_finite()).then_some(same)
}

fn blurred(scene: &Scene, frame: &Frame, buffer: &[Colour]) -> Vec<Colour> {
    blur(&scene.model, &frame.coarse, buffer, &scene.parameters)
}

proptest! {
    #![proptest_config(config(400))]

    /// A constant stays what it is.
    #[test]
    fn constant(scene in scenes(), value in 0.0..9.0_f32) {
        let frame = scene.frame();
        let value = f64::from(value);
        let buffer = vec![grey(value); frame.coarse.surfaces.len()];
        for (pixel, mean) in blurred(&scene, &frame, &buffer).iter().enumerate() {
            let expected = if frame.coarse.surfaces[pixel].is_some() { value } else { 0.0 };
            prop_assert!((mean[1].value - expected).abs() <= 1e-14 * value);
            prop_assert!(mean[1].admits(expected));
        }
        // A sum beyond f32 is promised by nobody, though its mean is within.
        let most = vec![grey(0.75 * f64::from(f32::MAX)); buffer.len()];
        for (mean, sums) in blurred(&scene, &frame, &most).iter().zip(blurred(&scene, &frame, &buffer)) {
            prop_assert_eq!(mean[1].bound.is_infinite(), value > 0.0 && sums[1].bound > 0.0);
        }
    }

    /// One bright pixel brightens exactly those within the radius that see the same surface,
    /// each by its share.
    #[test]
    fn never_mixes(scene in scenes(), bright in any::<prop::sample::Index>()) {
        let frame = scene.frame();
        let surfaces = &frame.coarse.surfaces;
        let bright = bright.index(surfaces.len());
        let mut buffer = vec![grey(0.0); surfaces.len()];
        buffer[bright] = grey(1.0);
        let width = frame.coarse.size.width as usize;
        let near = |a: usize, b: usize| {
            let apart = (a % width).abs_diff(b % width).max((a / width).abs_diff(b / width));
            apart <= scene.parameters.blur as usize
        };
        let belong = |a: usize, b: usize| match (&surfaces[a], &surfaces[b]) {
            (Some(x), Some(y)) => near(a, b) && same(&scene.model, x, y, scene.parameters.edge),
            _ => false,
        };
        for (pixel, mean) in blurred(&scene, &frame, &buffer).iter().enumerate() {
            let count = (0..surfaces.len()).filter(|other| belong(pixel, *other)).count();
            let expected = if belong(pixel, bright) { 1.0 / count as f64 } else { 0.0 };
            prop_assert_eq!(mean[0].value, expected);
            prop_assert_eq!(mean[0].bound == 0.0, expected == 0.0 || count == 1);
        }
    }

    /// Surfaces are the same by their planes and normals, whichever is asked first; the
    /// same triangle always is.
    #[test]
    fn edges(scene in scenes()) {
        let frame = scene.frame();
        let surfaces: Vec<&Surface> = frame.seen.surfaces.iter().flatten().collect();
        for a in &surfaces {
            for b in &surfaces {
                let edge = scene.parameters.edge;
                let answer = same(&scene.model, a, b, edge);
                prop_assert_eq!(answer, same(&scene.model, b, a, edge));
                if a.triangle == b.triangle {
                    prop_assert!(answer);
                } else if let Some(expected) = one(&scene.model, a, b, edge) {
                    prop_assert_eq!(answer, expected, "{:?} {:?}", a, b);
                }
            }
        }
    }

    /// The same of any two triangles near each other, and points near both.
    #[test]
    fn pairs(
        corners in prop::collection::vec(super::place(1 << 12), 6),
        points in [super::place(1 << 12), super::place(1 << 12)],
        sides in [any::<bool>(), any::<bool>()],
        edge in 0..1_u32 << 13,
    ) {
        let model = Model::new(corners, super::rows(2), vec![[0.0; 3]; 2]).expect("a model");
        let side = |front: bool| if front { 1 } else { -1 };
        let a = Surface { triangle: 0, side: side(sides[0]), point: points[0] };
        let b = Surface { triangle: 1, side: side(sides[1]), point: points[1] };
        let answer = same(&model, &a, &b, edge);
        prop_assert_eq!(answer, same(&model, &b, &a, edge));
        if let Some(expected) = one(&model, &a, &b, edge) {
            prop_assert_eq!(answer, expected);
        }
    }

    /// The picture is no darker than direct light and no brighter than with all light, and
    /// with a dark buffer B it is just that.
    #[test]
    fn between(scene in scenes()) {
        let frame = scene.frame();
        let dark = vec![grey(0.0); frame.blurred.len()];
        let light = [&frame.direct.light[..], &frame.all];
        let make = |b: &[Colour]| compose(&scene.model, &frame.seen, light, (&frame.coarse, b), &scene.parameters, [0.0; 3]);
        let (most, picture) = (make(&dark), make(&frame.blurred));
        for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
            let Some(surface) = surface else { continue };
            let colour = scene.model.colours[surface.triangle as usize];
            for i in 0..3 {
                let (direct, all) = (light[0][pixel][i].value, light[1][pixel][i].value);
                let c = f64::from(colour[i]);
                prop_assert_eq!(most[pixel][i].value, (direct + all) * c);
                prop_assert!(direct * c <= picture[pixel][i].value);
                prop_assert!(picture[pixel][i].value <= most[pixel][i].value);
            }
        }
    }

    /// Every pixel takes from one of the four pixels of buffer B around it, from one of its
    /// own surface if there is one, and no nearer one would do.
    #[test]
    fn taken(scene in scenes()) {
        let frame = scene.frame();
        let divisor = scene.parameters.divisor as usize;
        let [width, columns] = [frame.seen.size, frame.coarse.size].map(|s| s.width as usize);
        let surfaces = &frame.coarse.surfaces;
        let mut model = scene.model.clone();
        model.colours.fill([1.0; 3]);
        let numbers: Vec<Colour> = (0..surfaces.len()).map(|n| grey(n as f64)).collect();
        let pixels = frame.seen.surfaces.len();
        let (none, many) = (vec![grey(0.0); pixels], vec![grey(1e3); pixels]);
        let picture = compose(&model, &frame.seen, [&none, &many], (&frame.coarse, &numbers), &scene.parameters, [0.0; 3]);
        for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
            let Some(surface) = surface else { continue };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row")]
            let from = (1e3 - picture[pixel][0].value) as usize;
            let (x, y) = (pixel % width, pixel / width);
            let apart = |cell: usize| {
                let (dx, dy) = (x.abs_diff(cell % columns * divisor), y.abs_diff(cell / columns * divisor));
                (dx < divisor && dy < divisor || cell == from).then_some(dx * dx + dy * dy)
            };
            let belongs = |cell: usize| surfaces[cell].is_some_and(|s| same(&model, surface, &s, scene.parameters.edge));
            let best = (0..surfaces.len()).filter(|c| apart(*c).is_some()).min_by_key(|c| (!belongs(*c), apart(*c), *c));
            prop_assert_eq!(Some(from), best);
        }
    }
}

/// A bright neighbour cannot make a pixel's indirect light negative.
#[test]
fn never_negative() {
    let model = Model::new(
        vec![[0, 0, 0], [64, 0, 0], [0, 64, 0]],
        vec![[0, 1, 2]],
        vec![[1.0; 3]],
    );
    let model = model.expect("a model");
    let size = Size {
        width: 1,
        height: 1,
    };
    let surfaces = vec![Some(Surface {
        triangle: 0,
        side: 1,
        point: [1, 1, 2],
    })];
    let seen = triptych_spec::rsm::Gbuffer {
        size,
        keys: vec![0],
        surfaces: surfaces.clone(),
        stray: vec![[0; 3]],
    };
    let coarse = Coarse { size, surfaces };
    let parameters = triptych_spec::rsm::Parameters {
        radius: 0,
        stride: 1,
        divisor: 1,
        blur: 0,
        bias: 0,
        clamp: 1,
        offset: 2,
        edge: 0,
    };
    let light = [&[grey(0.5)][..], &[grey(1.0)]];
    let picture = compose(
        &model,
        &seen,
        light,
        (&coarse, &[grey(2.0)]),
        &parameters,
        [0.0; 3],
    );
    assert_eq!(picture[0][0].value, 0.5);
}
