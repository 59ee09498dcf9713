//! The paper's ray tracer on a queue.

use triptych_spec::dispatch::queue::Fifo;
use triptych_spec::dispatch::{Ray, Shot, Tracer, World, follow, primary, tasks};

use super::crew::{Crew, Hands};
use super::film::Film;
use super::queue::{Queue, Worker};

/// Rays that are done together.
pub type Task = Vec<Ray>;

/// The tasks that a picture begins with.
pub fn first(world: &World) -> Vec<Task> {
    let rays: Vec<Ray> = primary(&world.eye).collect();
    tasks(&rays).collect()
}

/// Does a task (listing 2, lines 5 to 10) and adds those that come of it.
pub fn shade<W: Worker<Task>>(
    world: &World,
    tracer: &impl Tracer,
    film: &impl Film,
    hands: &mut Hands<'_, W>,
    task: &Task,
) {
    let mut shot = Vec::new();
    for ray in task {
        if let Shot::Light(light) = follow(world, tracer, ray, &mut shot) {
            film.add(ray.pixel, light);
        }
    }
    tasks(&shot).for_each(|task| hands.add(task));
}

/// A picture, by a crew.
pub fn picture<Q: Queue<Task>>(
    world: &World,
    tracer: &(impl Tracer + Sync),
    film: &impl Film,
    crew: Crew,
    queue: &Q,
) {
    crew.run(queue, first(world), |hands, task| {
        shade(world, tracer, film, hands, &task);
    });
}

/// A picture by one thread without any queue of many: the *sequential version* that the paper's
/// speed-ups are relative to (section 5.2).
pub fn sequential(world: &World, tracer: &impl Tracer, film: &impl Film) {
    let mut queue = Fifo::default();
    first(world).into_iter().for_each(|task| queue.add(task));
    let mut shot = Vec::new();
    while let Some(task) = queue.get() {
        for ray in &task {
            if let Shot::Light(light) = follow(world, tracer, ray, &mut shot) {
                film.add(ray.pixel, light);
            }
        }
        tasks(&shot).for_each(|task| queue.add(task));
        shot.clear();
    }
}
