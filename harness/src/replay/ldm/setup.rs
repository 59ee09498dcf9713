//! From a loaded scene to what the spec is given: a lattice, who asks, what blocks, and the
//! directions of every rotation with the light that comes from there.

use std::collections::BTreeSet;

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::{Lattice, Point};
use triptych_spec::ldm::{
    self, FAR_MAX, Falloff, Maps, OFF_MAX, Receiver, directions, rotated, weight,
};
use triptych_spec::rsm::{Gbuffer, Model, OFFSET_MIN, Parameters, RsmError, Surface, View};

use crate::replay::spec::FRAGMENTS_MAX;
use crate::replay::{pieces, placed};
use crate::scene::{Loaded, Mistake};

/// How far from the spec's a device's point may be in maps that are cropped, in steps along each axis:
/// half of the narrowest pixel. More would leave little to crop where a single pixel sees a triangle
/// edge-on.
const MARGIN: i32 = 64;

/// What all rotations share.
pub struct Setup {
    /// World space and the lattice: around everything, and around a perspective eye.
    pub lattice: Lattice,
    /// From where the picture is seen.
    pub eye: View,
    /// What is seen.
    pub model: Model,
    /// What is in the maps.
    pub blockers: Blockers,
    /// What each pixel sees.
    pub seen: Gbuffer,
    /// Who asks: the points that pixels see.
    pub receivers: Vec<Asker>,
    /// Their normals, each once.
    normals: BTreeSet<Point>,
    /// How far points are moved off their faces, in steps along one axis.
    pub offset: u32,
    /// Directions of a set.
    pub directions: u32,
    /// How many sets there are.
    pub rotations: u32,
    /// Pixels of a map across the diagonal of what blocks.
    pub resolution: u32,
    /// How what is hit counts, in steps.
    pub falloff: Falloff,
    seed: u64,
}

/// A pixel that asks what is open over its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asker {
    /// Row-major number of the pixel.
    pub pixel: u32,
    /// Row of the triangle that it sees.
    pub triangle: u32,
    /// The point as the stages take it.
    pub receiver: Receiver,
    /// The unit vector to the eye ([`ldm::view`]).
    pub view: Point,
}

/// The maps of a rotation, before anything is drawn.
pub struct Turn {
    /// Those that somebody needs.
    pub maps: Maps,
    /// Radiance from each map's direction, and from the opposite one; black without a sky.
    pub sky: Vec<ldm::Sky>,
    /// Whether light comes through each: from a side that somebody faces.
    pub lit: Vec<bool>,
}

impl Setup {
    /// Of a scene with an `[ldm]`.
    ///
    /// # Errors
    /// Coordinates that are not finite, and whatever exceeds a limit, in one line, with the key
    /// to change.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let section = loaded.file.ldm.as_ref();
        let section = section.ok_or_else(|| "has no [ldm]".to_owned())?.get_ref();
        let camera = loaded.world.camera;
        let lattice = placed::lattice(loaded, 1, &[&camera], &[])?;
        let (model, blockers) = placed::parts(loaded, &lattice, 0)?;
        let eye = View::new(&camera, &lattice, loaded.scene.size);
        let eye = eye.map_err(|e| told(&e, &lattice))?;
        let fragments = pieces::fragments_of(&model, &eye);
        if fragments > FRAGMENTS_MAX {
            let message = format!(
                "the triangles cover {fragments} fragments, and {FRAGMENTS_MAX} are the limit; use a \
                 smaller size or fewer triangles"
            );
            return Err(Mistake::of("size", message));
        }
        let offset = section.offset.0.max(OFFSET_MIN);
        let seen = pieces::gbuffer(&model, &eye, &off_faces(offset));
        let receivers = receivers((&model, &eye), &seen.surfaces, |_| off(offset));
        let normals = receivers.iter().map(|r| r.receiver.normal).collect();
        let falloff = match section.far {
            None => Falloff::None,
            Some(far) => far_in_steps(&lattice, far.0, section.power())?,
        };
        Ok(Self {
            lattice,
            eye,
            model,
            blockers,
            seen,
            receivers,
            normals,
            offset,
            directions: section.directions.0,
            rotations: section.rotations.0,
            resolution: section.resolution.0,
            falloff,
            seed: loaded.file.seed,
        })
    }

    /// The maps of a rotation. With `skip`, those alone in whose direction somebody's weight is
    /// not 0; the others add nothing to any sum. One is made in any case.
    ///
    /// # Errors
    /// What the spec says of its limits, in one line.
    pub fn turn(&self, loaded: &Loaded, rotation: u32, skip: bool) -> Result<Turn, Mistake> {
        let set = directions(self.directions).map_err(|e| e.to_string())?;
        let mut set = rotated(&set, self.seed, rotation);
        let mut maps = self.maps(&set, skip)?;
        if skip {
            let counts = |map: &&ldm::Map| self.normals.iter().any(|n| weight(map, *n) != 0);
            let needed = maps.maps.iter().filter(counts).map(|map| map.direction);
            let needed: Vec<[f64; 3]> = needed.collect();
            if needed.len() < set.len() {
                set.truncate(1);
                set = if needed.is_empty() { set } else { needed };
                maps = self.maps(&set, skip)?;
            }
        }
        let sky = |map: &ldm::Map| {
            let sky = loaded.sky.as_ref();
            sky.map_or([[0.0; 3]; 2], |sky| sky.sides(map.direction))
        };
        let sky: Vec<ldm::Sky> = maps.maps.iter().map(sky).collect();
        let lit = maps.maps.iter().zip(&sky).map(|(map, sky)| {
            let side = |n: &Point| match weight(map, *n) {
                0 => false,
                weight => sky[usize::from(weight < 0)] != [0.0; 3],
            };
            !skip || self.normals.iter().any(side)
        });
        Ok(Turn {
            lit: lit.collect(),
            maps,
            sky,
        })
    }

    /// Who asks where a device sees these surfaces, which may stray from the spec's: a point that
    /// is another one is as much farther off its surface, as far as a receiver can say.
    pub(super) fn receivers_of(&self, surfaces: &[Option<Surface>]) -> Vec<Asker> {
        receivers((&self.model, &self.eye), surfaces, |pixel| {
            let strays = self.seen.stray[pixel].into_iter().max().unwrap_or(0);
            match surfaces[pixel] == self.seen.surfaces[pixel] {
                true => off(self.offset),
                false => (off(self.offset) + strays).min(OFF_MAX),
            }
        })
    }

    /// How many of a device's points lie farther from the spec's than maps are cropped for. Bounds
    /// let them, where triangles are long and seen edge-on; adapters are steps away.
    pub(super) fn beyond(&self, askers: &[Asker]) -> usize {
        let both = askers.iter().zip(&self.receivers);
        let apart = |(a, b): &(&Asker, &Asker)| {
            let [a, b] = [a, b].map(|asker| asker.receiver.point);
            (0..3).any(|i| (a[i] - b[i]).abs() > MARGIN)
        };
        both.filter(apart).count()
    }

    /// Maps of what blocks. With `skip`, as far as somebody asks, or may by the points of a device.
    pub(crate) fn maps(&self, directions: &[[f64; 3]], skip: bool) -> Result<Maps, String> {
        let corners = self.blockers.triangles.iter().flatten();
        let corners = corners.map(|row| self.blockers.vertices[*row as usize]);
        let blockers = bounds(corners).unwrap_or([[0; 3]; 2]);
        let asking = self.receivers.iter().flat_map(|asker| {
            let (point, strays) = (asker.receiver.point, &self.seen.stray[asker.pixel as usize]);
            let strays = strays.map(|steps| steps.cast_signed().min(MARGIN));
            [-1, 1].map(|way| [0, 1, 2].map(|i| point[i] + way * strays[i]))
        });
        let asking = bounds(asking).filter(|_| skip).unwrap_or(blockers);
        Maps::new(directions, blockers, asking, self.resolution).map_err(|e| e.to_string())
    }
}

/// The box around points; `None` if there are none.
pub fn bounds(points: impl Iterator<Item = Point>) -> Option<[Point; 2]> {
    points.map(|p| [p, p]).reduce(|[low, high], [p, _]| {
        let least = [0, 1, 2].map(|i| low[i].min(p[i]));
        [least, [0, 1, 2].map(|i| high[i].max(p[i]))]
    })
}

/// How far a point is off its surface, in steps along any axis: less than this.
///
/// It is met in its triangle's plane, but for rounding in `f64`, which is far below a step; rounded
/// to the lattice, by half a step along each axis at most; and moved by `offset` steps along one.
fn off(offset: u32) -> u32 {
    offset + 1
}

/// What stage `gbuffer` is told: how far points are moved off their faces, and nothing else.
pub(super) fn off_faces(offset: u32) -> Parameters {
    Parameters {
        radius: 0,
        stride: 1,
        divisor: 1,
        blur: 0,
        bias: 0,
        clamp: 1,
        offset,
        edge: 0,
    }
}

/// The points that pixels see, each off its surface by so many steps along an axis at most.
fn receivers(
    (model, eye): (&Model, &View),
    seen: &[Option<Surface>],
    off: impl Fn(usize) -> u32,
) -> Vec<Asker> {
    let asker = |(pixel, surface): (u32, &Option<Surface>)| {
        let surface = surface.as_ref()?;
        let normal = model.face(surface.triangle).coarse;
        Some(Asker {
            pixel,
            triangle: surface.triangle,
            receiver: Receiver {
                point: surface.point,
                normal: normal.map(|c| c * surface.side),
                off: off(pixel as usize),
            },
            view: ldm::view(eye.viewpoint.from(surface.point)),
        })
    };
    (0..).zip(seen).filter_map(asker).collect()
}

/// The falloff, in steps.
fn far_in_steps(lattice: &Lattice, far: f64, power: u32) -> Result<Falloff, Mistake> {
    let steps = placed::steps(lattice, far);
    match u32::try_from(steps).ok().filter(|steps| *steps <= FAR_MAX) {
        Some(0) => {
            let least = libm::scalbn(0.5, lattice.exponent);
            let message = format!(
                "{far:e} is less than half a step of the lattice; {least:.3e} or more is right"
            );
            Err(Mistake::of("ldm.far", message))
        }
        Some(most) => Ok(Falloff::Distance { most, power }),
        None => {
            let most = libm::scalbn(f64::from(FAR_MAX), lattice.exponent);
            let message = format!(
                "{far:e} is more than {FAR_MAX} steps of the lattice, {most:.3e}; leave it out where \
                 whatever is hit shall block"
            );
            Err(Mistake::of("ldm.far", message))
        }
    }
}

/// A camera that has no view of the lattice. It has one of the world: loading saw to that.
fn told(error: &RsmError, lattice: &Lattice) -> Mistake {
    let words = error.to_string();
    let words = words.trim_start_matches("camera: ");
    let step = libm::scalbn(1.0, lattice.exponent);
    Mistake::of("camera", format!("{words}, in steps of {step} units"))
}
