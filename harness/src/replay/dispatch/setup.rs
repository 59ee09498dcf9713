//! From a loaded scene to what the spec is given: a lattice, and on it triangles, lamps and eye.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::dispatch::{DispatchError, Eye, LIGHT_MAX, Lamp, Material, World};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, ENTRIES_MAX, Grid, GridError, Membership};
use triptych_spec::scene::Size;

use crate::replay::pieces;
use crate::replay::placed::{self, nearest};
use crate::scene::dispatch::LampEntry;
use crate::scene::{Loaded, Mistake};

/// A reference distance, in steps, that the spec takes.
const REFERENCE: f64 = 16_777_216.0;

/// A shorter one is taken longer, so that rounding it to steps changes light by 2^-19 at most.
const SHORT: f64 = 1_048_576.0;

/// What rays are traced in.
pub struct Setup {
    /// World space and the lattice: around everything, around lamps and a perspective eye.
    pub lattice: Lattice,
    /// Triangles, lamps and eye.
    pub world: World,
    /// The triangles' cells.
    pub grid: Grid,
}

impl Setup {
    /// Of a scene with a `[dispatch]`.
    ///
    /// # Errors
    /// Coordinates that are not finite, and whatever exceeds a limit of the spec, in one line, with
    /// the key to change.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let section = loaded.file.dispatch.as_ref();
        let section = section.ok_or_else(|| "has no [dispatch]".to_owned())?;
        let section = section.get_ref();
        let entries: Vec<LampEntry> = section.lamp.iter().map(|l| *l.get_ref()).collect();
        let camera = loaded.world.camera;
        let mut places: Vec<[f64; 3]> = entries.iter().map(|lamp| lamp.position.0).collect();
        places.extend(corners(&camera, loaded.scene.size)?);
        let lattice = placed::lattice(loaded, 1, &[&camera], &places)?;
        let eye = Eye::new(&camera, &lattice, loaded.scene.size);
        let eye = eye.map_err(|e| Mistake::of("camera", e.to_string()))?;
        let lamps = entries.iter().map(|entry| lamp(entry, &lattice));
        let lamps = lamps.collect::<Result<_, _>>()?;
        let blockers = blockers(loaded, &lattice);
        let triangles = loaded.scene.triangles.iter().zip(&loaded.world.mirrors);
        let materials = triangles.map(|(triangle, mirror)| {
            let [r, g, b, _] = triangle.colour;
            Material {
                diffuse: [r, g, b],
                mirror: *mirror,
            }
        });
        let materials: Vec<Material> = materials.collect();
        let built = pieces::build(&blockers, Resolution::FromScene, Membership::Box);
        let (background, depth) = (loaded.scene.background, section.depth.0);
        let world = World::new(blockers, &materials, lamps, background, eye, depth);
        Ok(Self {
            lattice,
            world: world.map_err(|e| Mistake::from(e.to_string()))?,
            grid: built.map_err(|e| cells(&e))?.grid,
        })
    }
}

/// Where the rays of an orthographic view begin, at its corners; nowhere for a perspective, whose rays
/// begin in the eye.
fn corners(camera: &Camera, size: Size) -> Result<Vec<[f64; 3]>, Mistake> {
    let Projection::Orthographic { .. } = camera.projection else {
        return Ok(Vec::new());
    };
    let aspect = f64::from(size.width) / f64::from(size.height);
    let axes = camera.axes(aspect);
    let [right, up, _] = axes.map_err(|e| Mistake::of("camera", e.to_string()))?;
    let corner = |x: f64, y: f64| [0, 1, 2].map(|i| camera.eye[i] + x * right[i] + y * up[i]);
    Ok([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
        .map(|(x, y)| corner(x, y))
        .into())
}

/// The scene's triangles; rows are those of the scene.
fn blockers(loaded: &Loaded, lattice: &Lattice) -> Blockers {
    let points = loaded.world.points(&loaded.scene);
    // A vertex that no triangle uses may lie anywhere.
    let snap = |p: &[f64; 3]| lattice.snap(*p).unwrap_or_default();
    Blockers {
        vertices: points.iter().map(snap).collect(),
        triangles: loaded.scene.triangles.iter().map(|t| t.vertices).collect(),
    }
}

/// A lamp on the lattice. One that is so strong at a distance is four times as strong at half of it, and a
/// quarter at twice: so any reference distance will do, also those that are longer than the lattice, or so short that
/// whole steps would be another.
fn lamp(entry: &LampEntry, lattice: &Lattice) -> Result<Lamp, Mistake> {
    let steps = |length: f64| libm::scalbn(length, -lattice.exponent);
    let wrong = |message: String| Mistake::of("dispatch.lamp", message);
    let (mut strength, mut reference) = (entry.strength.0, steps(entry.reference.0));
    if !(reference > 0.0 && reference.is_finite()) {
        let length = entry.reference.0;
        return Err(wrong(format!(
            "a reference distance of {length:e} is none in this scene"
        )));
    }
    while reference > REFERENCE {
        reference /= 2.0;
        strength = strength.map(|c| 4.0 * c);
    }
    while reference < SHORT {
        reference *= 2.0;
        strength = strength.map(|c| c / 4.0);
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let strength = strength.map(|c| c as f32);
    let whole = |steps: f64| u32::try_from(nearest(steps)).unwrap_or(u32::MAX);
    let least = steps(entry.least());
    if least > REFERENCE {
        let length = entry.least();
        return Err(wrong(format!(
            "a least distance of {length:e} is longer than the scene"
        )));
    }
    let place = lattice.snap(entry.position.0);
    let place = place.ok_or_else(|| wrong("a lamp is not on the lattice".to_owned()))?;
    Lamp::new(place, strength, whole(reference), whole(least).max(1)).map_err(|e| told(&e))
}

/// What a scene's author can do about a lamp that the spec refuses.
fn told(error: &DispatchError) -> Mistake {
    let message = match error {
        DispatchError::Bright(light) => format!(
            "its light may reach {light:e}, where its distance is least, and {LIGHT_MAX:e} is the limit; \
             state a longer `least` or less `strength`"
        ),
        other => other.to_string(),
    };
    Mistake::of("dispatch.lamp", message)
}

/// Why triangles have no cells. Nobody states how many there are.
fn cells(error: &GridError) -> Mistake {
    let of = match error {
        GridError::Entries(entries) => {
            format!(
                "{entries} entries in the cells of the triangles, and {ENTRIES_MAX} are the limit"
            )
        }
        _ => error.to_string(),
    };
    Mistake::of("dispatch", format!("{of}; use simpler meshes"))
}
