//! One picture, whatever the queue.

use triptych_spec::dispatch::{Searched, Sums, render};
use triptych_spec::scene::Size;

use super::worlds::world;
use crate::dispatch::crew::{Crew, Ending};
use crate::dispatch::film::{Film, Spinning, Units};
use crate::dispatch::queue::{Lfree, Local, Lock, Queue, Segments, Stealing};
use crate::dispatch::render::{Task, picture, sequential};
use crate::dispatch::tree::Tree;

const SIZE: Size = Size {
    width: 40,
    height: 30,
};

/// A picture by every queue.
fn each_queue(threads: usize, mut check: impl FnMut(&str, &dyn Fn(Crew) -> Sums)) {
    let (world, _) = world(7, 300, SIZE);
    let tree = Tree::new(&world.blockers);
    fn by<Q: Queue<Task>>(
        world: &triptych_spec::dispatch::World,
        tree: &Tree,
        queue: &Q,
        crew: Crew,
    ) -> Sums {
        let mut film = Units::new(SIZE);
        picture(world, tree, &film, crew, queue);
        film.sums()
    }
    check("lock", &|crew| by(&world, &tree, &Lock::new(), crew));
    check("lfree", &|crew| by(&world, &tree, &Lfree::new(), crew));
    check("local", &|crew| {
        by(&world, &tree, &Local::new(threads), crew)
    });
    check("segments", &|crew| {
        by(&world, &tree, &Segments::new(), crew)
    });
    check("stealing", &|crew| {
        by(&world, &tree, &Stealing::new(threads), crew)
    });
}

#[test]
fn pictures_are_the_specs_whatever_the_queue_and_the_threads() {
    let (world, grid) = world(7, 300, SIZE);
    let searched = Searched {
        grid: &grid,
        blockers: &world.blockers,
    };
    let own = render(&world, &searched);
    let lit = own.pixels.iter().filter(|p| **p != [0; 3]).count();
    assert!(lit > 500, "only {lit} pixels have any light");
    let mut film = Units::new(SIZE);
    sequential(&world, &Tree::new(&world.blockers), &film);
    assert_eq!(film.sums(), own, "one thread, no queue of many");
    for threads in [1, 2, 3, 8, 32] {
        each_queue(threads, |name, picture| {
            for ending in Ending::ALL {
                let crew = Crew {
                    threads,
                    ending,
                    watched: false,
                };
                let made = picture(crew);
                assert_eq!(made, own, "{name}, {threads} threads, {}", ending.name());
            }
        });
    }
}

#[test]
fn float_sums_under_a_spin_lock_come_close() {
    let (world, _) = world(7, 300, SIZE);
    let tree = Tree::new(&world.blockers);
    let (mut exact, mut spinning) = (Units::new(SIZE), Spinning::new(SIZE));
    sequential(&world, &tree, &exact);
    picture(&world, &tree, &spinning, Crew::new(3), &Lfree::new());
    let exact = exact.sums();
    let mut most: f64 = 0.0;
    for (pixel, light) in spinning.light().into_iter().enumerate() {
        for (float, sum) in light.into_iter().zip(exact.light(pixel)) {
            // At most 30 terms, of 4 lamps and a mirror at 6 bounces: each is added with a
            // rounding to f32 there, and rounded to a unit here.
            let off = (f64::from(float) - sum).abs();
            let allowed = 30.0 * (f64::from(f32::EPSILON) / 2.0 * sum + 0.5 / 16_777_216.0);
            assert!(off <= allowed, "{off} of {sum} at {pixel}");
            most = most.max(sum);
        }
    }
    assert!(most > 0.1, "there is light");
    exact_is_cleared(&mut Units::new(SIZE));
}

fn exact_is_cleared(film: &mut Units) {
    film.add(3, [1.0, 0.5, 0.0]);
    assert_eq!(film.sums().pixels[3], [1 << 24, 1 << 23, 0], "units");
    film.clear();
    assert_eq!(film.sums(), Sums::new(SIZE), "no light is left");
}
