//! A scene to be rendered over and over.

use std::time::{Duration, Instant};

use triptych_spec::dispatch::{Sums, Tracer, World};
use triptych_spec::scene::Size;

use super::Method;
use crate::dispatch::crew::{Crew, Spent};
use crate::dispatch::film::{Film, Spinning, Units};
use crate::dispatch::queue::{Lfree, Local, Lock, Queue, Segments, Stealing};
use crate::dispatch::render::{Task, first, sequential, shade};
use crate::dispatch::tree::Tree;
use crate::embree::rays::{RayAnswers, RayScene};
use crate::replay::dispatch::DispatchRun;

/// What is rendered, and how its picture must be.
pub(super) struct Scene {
    pub(super) name: String,
    pub(super) triangles: u64,
    pub(super) rays: u64,
    run: DispatchRun,
    tree: Tree,
    embree: RayScene,
    /// The most terms that a pixel's sum has.
    terms: u64,
}

/// How long frames took, and what threads did in that time.
pub(super) struct Taken {
    pub(super) time: Duration,
    pub(super) spent: Vec<Spent>,
}

/// Embree as a tracer. Its decisions are its own: rays near edges may meet something else.
struct ByEmbree<'a>(&'a RayScene);

impl Tracer for ByEmbree<'_> {
    fn closest(&self, way: triptych_spec::grid::ray::Ray) -> Option<u32> {
        self.0.closest(&way).map(|hit| hit.prim)
    }
    fn blocked(&self, way: triptych_spec::grid::ray::Ray) -> bool {
        self.0.occluded(&way)
    }
}

impl Scene {
    /// With the spec's own picture, which every method must give.
    ///
    /// # Errors
    /// One line, where Embree refuses the triangles.
    pub(super) fn new(name: &str, run: DispatchRun) -> Result<Self, String> {
        let blockers = &run.setup.world.blockers;
        let mut terms = vec![0_u64; run.sums.pixels.len()];
        for (pixel, _) in run
            .bounces
            .iter()
            .flat_map(|b| b.deposits(&run.setup.world))
        {
            terms[pixel as usize] += 1;
        }
        Ok(Self {
            name: name.to_owned(),
            triangles: blockers.triangles.len() as u64,
            rays: run.rays(),
            tree: Tree::new(blockers),
            embree: RayScene::new(blockers).map_err(|e| e.to_string())?,
            terms: terms.into_iter().max().unwrap_or(0),
            run,
        })
    }

    pub(super) fn size(&self) -> Size {
        self.world().eye.size
    }

    /// What the spec says.
    pub(super) fn run(&self) -> &DispatchRun {
        &self.run
    }

    fn world(&self) -> &World {
        &self.run.setup.world
    }

    /// Renders frames, and holds the last one against the spec's.
    ///
    /// # Errors
    /// One line, where the picture is another.
    pub(super) fn render(&self, method: Method, crew: Crew, frames: u32) -> Result<Taken, String> {
        let threads = crew.threads;
        match method {
            Method::Sequential => self.alone(frames),
            Method::Lock | Method::LockCounted => self.exact(&Lock::new(), crew, frames),
            Method::Lfree | Method::LfreeCounted => self.exact(&Lfree::new(), crew, frames),
            Method::Local => self.exact(&Local::new(threads), crew, frames),
            Method::Segments => self.exact(&Segments::new(), crew, frames),
            Method::Stealing => self.exact(&Stealing::new(threads), crew, frames),
            Method::LfreeSpinning => self.spinning(crew, frames),
            Method::Rayon => self.rayon(threads, frames),
            Method::Embree => self.embree(crew, frames),
            Method::Board(_) => Err("a board has no threads".to_owned()),
        }
    }

    fn alone(&self, frames: u32) -> Result<Taken, String> {
        let mut film = Units::new(self.size());
        let start = Instant::now();
        for _ in 0..frames {
            film.clear();
            sequential(self.world(), &self.tree, &film);
        }
        let time = start.elapsed();
        self.must_be(&film.sums())?;
        Ok(Taken {
            time,
            spent: Vec::new(),
        })
    }

    /// Frames by a crew.
    fn frames<Q: Queue<Task>>(
        &self,
        tracer: &(impl Tracer + Sync),
        film: &impl Film,
        queue: &Q,
        crew: Crew,
        frames: u32,
    ) -> Taken {
        let (mut begun, mut ended) = (0, 0);
        let start = Instant::now();
        let spent = crew.frames(
            queue,
            || {
                begun += 1;
                (begun <= frames).then(|| first(self.world()))
            },
            |hands, task| shade(self.world(), tracer, film, hands, &task),
            || {
                ended += 1;
                if ended < frames {
                    film.clear();
                }
            },
        );
        Taken {
            time: start.elapsed(),
            spent,
        }
    }

    fn exact<Q: Queue<Task>>(&self, queue: &Q, crew: Crew, frames: u32) -> Result<Taken, String> {
        let mut film = Units::new(self.size());
        let taken = self.frames(&self.tree, &film, queue, crew, frames);
        self.must_be(&film.sums())?;
        Ok(taken)
    }

    fn spinning(&self, crew: Crew, frames: u32) -> Result<Taken, String> {
        let mut film = Spinning::new(self.size());
        let taken = self.frames(&self.tree, &film, &Lfree::new(), crew, frames);
        // Each term is added with a rounding there, and rounded to a unit here.
        let terms = self.terms as f64;
        for (pixel, light) in film.light().into_iter().enumerate() {
            for (float, sum) in light.into_iter().zip(self.run.sums.light(pixel)) {
                let allowed = terms * (f64::from(f32::EPSILON) / 2.0 * sum + 0.5 / 16_777_216.0);
                if (f64::from(float) - sum).abs() > allowed {
                    return Err(format!("pixel {pixel} is {float} in place of {sum}"));
                }
            }
        }
        Ok(taken)
    }

    fn rayon(&self, threads: usize, frames: u32) -> Result<Taken, String> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| e.to_string())?;
        let mut film = Units::new(self.size());
        let start = Instant::now();
        for _ in 0..frames {
            film.clear();
            let (tasks, film) = (first(self.world()), &film);
            pool.scope_fifo(|scope| {
                for task in tasks {
                    scope.spawn_fifo(move |scope| self.job(film, scope, &task));
                }
            });
        }
        let time = start.elapsed();
        self.must_be(&film.sums())?;
        Ok(Taken {
            time,
            spent: Vec::new(),
        })
    }

    /// A task as a job of `rayon`'s, which adds jobs.
    fn job<'s>(&'s self, film: &'s Units, scope: &rayon::ScopeFifo<'s>, task: &Task) {
        use triptych_spec::dispatch::{Shot, follow, tasks};
        let mut shot = Vec::new();
        for ray in task {
            if let Shot::Light(light) = follow(self.world(), &self.tree, ray, &mut shot) {
                film.add(ray.pixel, light);
            }
        }
        for task in tasks(&shot) {
            scope.spawn_fifo(move |scope| self.job(film, scope, &task));
        }
    }

    /// With Embree's decisions: of a hundred pixels at most one may have another colour than the spec's.
    fn embree(&self, crew: Crew, frames: u32) -> Result<Taken, String> {
        let mut film = Units::new(self.size());
        let queue = Local::new(crew.threads);
        let taken = self.frames(&ByEmbree(&self.embree), &film, &queue, crew, frames);
        self.embree.check().map_err(|e| e.to_string())?;
        let made = film.sums();
        let pairs = made.pixels.iter().zip(&self.run.sums.pixels);
        let unlike = pairs.filter(|(a, b)| a != b).count();
        match 100 * unlike <= made.pixels.len() {
            true => Ok(taken),
            false => Err(format!("{unlike} pixels are not the spec's")),
        }
    }

    fn must_be(&self, made: &Sums) -> Result<(), String> {
        match *made == self.run.sums {
            true => Ok(()),
            false => Err("the picture is not the spec's".to_owned()),
        }
    }
}
