//! Pictures of every queue, by any number of threads, are the spec's; and so is what rays meet in
//! a tree.

mod pictures;
mod threads;
mod traced;
mod worlds;
