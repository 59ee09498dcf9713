//! Work queues for threads, and the ray tracer that feeds on them.
//!
//! Nunes and Santos, "Workload Distribution for Ray Tracing in Multi-Core Systems": threads that
//! are all alike take tasks of [`triptych_spec::dispatch::queue::TASK_RAYS`] rays from a [`queue`],
//! trace them, and add what they shoot as new tasks, frame by frame ([`crew`]). What a ray means is
//! the spec's ([`triptych_spec::dispatch::follow`]); here are only the threads, a [`tree`] in place of the
//! spec's grid, and [`film`]s that several threads add to. Pictures are the spec's to the bit,
//! whatever the queue, however many threads.

pub mod crew;
pub mod film;
mod gate;
pub mod queue;
pub mod render;
pub mod share;
pub mod tree;

#[cfg(test)]
mod tests;
