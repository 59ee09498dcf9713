//! A scene with its references.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Falloff, Open, Receiver, openness};

use super::flip;
use crate::embree::rays::{RayAnswers, RayScene};
use crate::replay::ldm::{Asker, Setup, Turn, random, same};
use crate::scene::Loaded;

/// Receivers of a sample, at most.
const SAMPLE: usize = 1 << 11;

/// Random rays of each of them.
pub(super) const SAMPLES: u32 = 4096;

/// What rays say is open.
struct Reference {
    /// Of each receiver of the sample.
    open: f64,
    variance: f64,
}

/// A scene whose maps are measured.
pub(super) struct Case<'l> {
    pub(super) name: String,
    loaded: &'l Loaded,
    pub(super) setup: Setup,
    pub(super) receivers: Vec<Receiver>,
    /// Receivers that are held against rays.
    pub(super) sample: Vec<usize>,
    pub(super) rays: RayScene,
    random: Vec<Reference>,
    /// For people; made when it is first looked at.
    picture: OnceLock<Result<flip::Reference, String>>,
    /// By number of directions.
    same: BTreeMap<u32, Vec<f64>>,
}

/// How far what is open is from rays in the same directions and in random ones: root of the mean
/// square, and the largest.
pub(super) struct Off {
    pub(super) same: [f64; 2],
    pub(super) random: [f64; 2],
    pub(super) noise: f64,
}

impl<'l> Case<'l> {
    /// Sets a scene up, with each triangle cut into four so often.
    ///
    /// # Errors
    /// One line for a scene beyond the limits of the spec; what Embree reports.
    pub(super) fn new(name: &str, loaded: &'l Loaded, cuts: u32) -> Result<Self, String> {
        let mut setup = Setup::new(loaded).map_err(|e| e.to_string())?;
        for _ in 0..cuts {
            setup.blockers = cut(&setup.blockers);
        }
        let receivers: Vec<Receiver> = setup.receivers.iter().map(|a| a.receiver).collect();
        let stride = receivers.len().div_ceil(SAMPLE).max(1);
        let sample: Vec<usize> = (stride / 2..receivers.len()).step_by(stride).collect();
        if sample.is_empty() {
            return Err("nothing is seen".to_owned());
        }
        let rays = RayScene::new(&setup.blockers).map_err(|e| e.to_string())?;
        Ok(Self {
            name: name.to_owned(),
            loaded,
            random: Vec::new(),
            picture: OnceLock::new(),
            same: BTreeMap::new(),
            rays,
            setup,
            receivers,
            sample,
        })
    }

    /// Asks Embree for what is open in random directions, with the falloff that is set.
    ///
    /// # Errors
    /// What Embree reports.
    pub(super) fn ask(&mut self) -> Result<(), String> {
        let seed = self.seed();
        self.random = self.each(|asker| {
            let (open, variance) = random(&self.setup, asker, (seed, SAMPLES), &self.rays);
            Reference { open, variance }
        })?;
        self.same.clear();
        self.picture = OnceLock::new();
        Ok(())
    }

    /// Another falloff, for all that follows.
    ///
    /// # Errors
    /// What Embree reports.
    pub(super) fn fade(&mut self, falloff: Falloff) -> Result<(), String> {
        self.setup.falloff = falloff;
        self.ask()
    }

    /// What seeds everything that is random.
    pub(super) fn seed(&self) -> u64 {
        self.loaded.file.seed
    }

    /// What sums over maps in so many directions look like, beside the reference.
    ///
    /// # Errors
    /// What Embree reports.
    pub(super) fn look(&self, directions: u32, opened: &[Open]) -> Result<flip::Seen, String> {
        let reference = self.picture.get_or_init(|| flip::Reference::new(self));
        let reference = reference.as_ref().map_err(Clone::clone)?;
        Ok(reference.seen(self, directions, opened))
    }

    /// Length of the diagonal of what blocks, in steps.
    pub(super) fn diagonal(&self) -> f64 {
        let end = |of: fn(i32, i32) -> i32, start: i32, axis: usize| {
            let all = self.setup.blockers.vertices.iter();
            f64::from(all.fold(start, |end, v| of(end, v[axis])))
        };
        let side = |axis| end(i32::max, i32::MIN, axis) - end(i32::min, i32::MAX, axis);
        [0, 1, 2]
            .map(|axis| side(axis).powi(2))
            .iter()
            .sum::<f64>()
            .sqrt()
    }

    /// How far what is open over the sample is from random rays, of each, and the root of the mean
    /// variance of those.
    pub(super) fn off_random(&self, own: &[f64]) -> (Vec<f64>, f64) {
        let off = own.iter().zip(&self.random).map(|(a, b)| a - b.open);
        let variance: f64 = self.random.iter().map(|r| r.variance).sum();
        let noise = (variance / self.random.len().max(1) as f64).sqrt();
        (off.collect(), noise)
    }

    /// Something of every receiver of the sample, by Embree.
    fn each<T: Send>(&self, of: impl Fn(&Asker) -> T + Sync + Send) -> Result<Vec<T>, String> {
        use rayon::prelude::*;
        let askers = self.sample.par_iter().map(|at| &self.setup.receivers[*at]);
        let all = askers.map(of).collect();
        self.rays.check().map_err(|e| e.to_string())?;
        Ok(all)
    }

    /// Maps in so many directions, of so many pixels across.
    ///
    /// # Errors
    /// What the spec says of its limits.
    pub(super) fn turn(&mut self, directions: u32, resolution: u32) -> Result<Turn, String> {
        self.setup.directions = directions;
        self.setup.resolution = resolution;
        let turn = self.setup.turn(self.loaded, 0, true);
        let turn = turn.map_err(|e| e.to_string())?;
        if !self.same.contains_key(&directions) {
            let maps = &turn.maps.maps;
            let open =
                self.each(|asker| same(&self.setup, maps.iter(), directions, asker, &self.rays))?;
            self.same.insert(directions, open);
        }
        Ok(turn)
    }

    /// The scene's own maps as planned, and as if nobody's needs were known.
    ///
    /// # Errors
    /// What the spec says of its limits.
    pub(super) fn turns(&self) -> Result<[Turn; 2], String> {
        let turn = |skip| self.setup.turn(self.loaded, 0, skip);
        let turn = |skip| turn(skip).map_err(|e| e.to_string());
        Ok([turn(true)?, turn(false)?])
    }

    /// Whether light comes from anywhere.
    pub(super) fn has_sky(&self) -> bool {
        self.loaded.sky.is_some()
    }

    /// How far sums over maps in so many directions are from both references.
    pub(super) fn off(&self, directions: u32, opened: &[Open]) -> Off {
        let own = self
            .sample
            .iter()
            .map(|at| openness(&opened[*at], directions).value);
        let own: Vec<f64> = own.collect();
        let same = own.iter().zip(&self.same[&directions]).map(|(a, b)| a - b);
        let (random, noise) = self.off_random(&own);
        Off {
            same: apart(same),
            random: apart(random.into_iter()),
            noise,
        }
    }
}

pub(super) fn apart(all: impl Iterator<Item = f64>) -> [f64; 2] {
    let (mut squares, mut most, mut count) = (0.0, 0.0_f64, 0.0);
    for off in all {
        squares += off * off;
        most = most.max(off.abs());
        count += 1.0;
    }
    [(squares / f64::max(count, 1.0)).sqrt(), most]
}

/// Every triangle as four, by the middles of its edges, rounded down.
fn cut(blockers: &Blockers) -> Blockers {
    let mut vertices = blockers.vertices.clone();
    let mut middles = BTreeMap::new();
    let mut triangles = Vec::with_capacity(4 * blockers.triangles.len());
    for &[a, b, c] in &blockers.triangles {
        let mut middle = |p: u32, q: u32| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                let [p, q] = [p, q].map(|row| vertices[row as usize]);
                vertices.push([0, 1, 2].map(|i| (p[i] + q[i]) >> 1));
                u32::try_from(vertices.len() - 1).expect("fewer than 2^32 vertices")
            })
        };
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Blockers {
        vertices,
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_cut_without_gaps() {
        let square = Blockers {
            vertices: vec![[0, 0, 0], [8, 0, 0], [8, 8, 4], [0, 8, 4]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let finer = cut(&cut(&square));
        assert_eq!((finer.vertices.len(), finer.triangles.len()), (25, 32));
        let doubled = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|row| finer.vertices[row as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        assert!(finer.triangles.iter().all(|t| doubled(t) == 4));
    }

    #[test]
    fn distances_are_squared() {
        assert_eq!(apart([3.0, -4.0].into_iter()), [(12.5_f64).sqrt(), 4.0]);
    }
}
