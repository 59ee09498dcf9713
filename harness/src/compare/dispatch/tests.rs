//! Every kind of damage is told by its cause.

use triptych_spec::bound::Bounded;
use triptych_spec::dispatch::{Carried, Met, Ray, Sums};
use triptych_spec::grid::ray::Ray as Way;
use triptych_spec::rsm::Surface;
use triptych_spec::scene::Size;

use super::{lights, located, met, overflow, picture, shot, sums};
use crate::cause::Cause;
use crate::compare::Judgement;

fn ray(pixel: u32, x: i32) -> Ray {
    Ray {
        way: Way::between([x, 0, 0], [1, 2, 3]),
        pixel,
        depth: 0,
        carried: Carried::Light([0.5, 0.25, 0.0]),
    }
}

fn rays() -> Vec<Ray> {
    vec![ray(0, 1), ray(0, 2), ray(3, 1), ray(7, 9)]
}

#[track_caller]
fn is(judgement: &Judgement, causes: &[(Cause, u64)]) {
    let seen: Vec<(Cause, u64)> = judgement.causes.iter().map(|(c, n)| (*c, *n)).collect();
    assert_eq!(seen, causes, "{:?}", judgement.described);
    assert!(judgement.compared > 0, "something is compared");
    assert_eq!(judgement.unexplained, 0, "all has a cause");
}

#[test]
fn queues_hold_the_same_rays_in_any_order() {
    let (must, mut seen) = (rays(), rays());
    seen.reverse();
    is(&shot(&must, &seen), &[]);
    let lost = &seen[1..];
    is(&shot(&must, lost), &[(Cause::LostNode, 1)]);
    let mut twice = seen.clone();
    twice.push(ray(3, 1));
    is(&shot(&must, &twice), &[(Cause::Duplicate, 1)]);
    let mut wrong = seen.clone();
    wrong[0].way.direction[2] += 1;
    is(&shot(&must, &wrong), &[(Cause::Interval, 1)]);
    wrong[0].pixel = 8;
    let elsewhere = [(Cause::Duplicate, 1), (Cause::LostNode, 1)];
    is(&shot(&must, &wrong), &elsewhere);
    // Light is not what makes a ray.
    seen[0].carried = Carried::Light([9.0; 3]);
    is(&shot(&must, &seen), &[]);
}

#[test]
fn light_is_held_to_its_bound() {
    let bound = |value| Bounded {
        value,
        bound: 0.125,
    };
    let (must, mut seen) = (rays(), rays());
    let bounds = vec![[bound(0.5), bound(0.25), bound(0.0)]; 4];
    seen.swap(0, 3);
    let judgement = lights(&must, &bounds, &seen);
    is(&judgement, &[]);
    seen[0].carried = Carried::Light([0.5, 0.375, 0.0]);
    let judgement = lights(&must, &bounds, &seen);
    is(&judgement, &[]);
    assert_eq!(judgement.error_over_bound, Some(1.0), "at the bound");
    seen[0].carried = Carried::Light([0.5, 0.376, 0.0]);
    is(&lights(&must, &bounds, &seen), &[(Cause::Interval, 1)]);
    seen[0].carried = Carried::Light([f32::NAN, 0.25, 0.0]);
    is(&lights(&must, &bounds, &seen), &[(Cause::Interval, 1)]);
}

#[test]
fn an_overflow_stores_what_there_is_room_for() {
    let must = rays();
    is(&overflow(&must, [2, 4], &must[1..3]), &[]);
    is(
        &overflow(&must, [2, 3], &must[1..3]),
        &[(Cause::Overflow, 1)],
    );
    is(
        &overflow(&must, [2, 4], &must[1..2]),
        &[(Cause::Overflow, 1)],
    );
    let twice = [must[1], must[1]];
    is(&overflow(&must, [2, 4], &twice), &[(Cause::Duplicate, 1)]);
}

#[test]
fn what_is_met_is_exact() {
    let rays = rays();
    let must = [Met::Nothing, Met::Triangle(4), Met::Something, Met::Nothing];
    is(&met(&rays, &must, &must), &[]);
    let mut seen = must;
    seen[1] = Met::Triangle(5);
    is(&met(&rays, &must, &seen), &[(Cause::Coverage, 1)]);
    is(
        &met(&rays, &must, &seen[..1]),
        &[(Cause::ReferenceMissing, 1)],
    );
    let point = Surface {
        triangle: 4,
        side: 1,
        point: [1, 2, 3],
    };
    let must = [None, Some(point), None, None];
    is(&located(&rays, &must, &must), &[]);
    let off = Surface {
        point: [1, 2, 4],
        ..point
    };
    let other = Surface {
        triangle: 5,
        ..point
    };
    let with = |surface| [None, Some(surface), None, None];
    is(&located(&rays, &must, &with(off)), &[(Cause::Vertex, 1)]);
    is(
        &located(&rays, &must, &with(other)),
        &[(Cause::Coverage, 1)],
    );
    is(
        &located(&rays, &must, &must[..2]),
        &[(Cause::ReferenceMissing, 1)],
    );
}

#[test]
fn pictures_are_equal_or_within_their_bounds() {
    let size = Size {
        width: 2,
        height: 1,
    };
    let must = Sums {
        size,
        pixels: vec![[1 << 24, 5, 0], [0; 3]],
    };
    is(&sums(&must, &must), &[]);
    let mut seen = must.clone();
    seen.pixels[1][2] = 1;
    is(&sums(&must, &seen), &[(Cause::Interval, 1)]);
    let unit = 1.0 / f64::from(1 << 24);
    is(&picture(&must, &[[unit; 3]; 2], &seen), &[]);
    let judgement = picture(&must, &[[0.9 * unit; 3]; 2], &seen);
    is(&judgement, &[(Cause::Interval, 1)]);
    seen.pixels.pop();
    is(
        &picture(&must, &[[1.0; 3]; 2], &seen),
        &[(Cause::ReferenceMissing, 1)],
    );
}
