//! From a loaded scene to what the spec is given: a lattice for all frames, and on it the
//! views, the parameters, and each frame's surfaces and blockers.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::{Lattice, LatticeError, Point};
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, ENTRIES_MAX, Grid, GridError, Membership};
use triptych_spec::matrix::Matrix;
use triptych_spec::rsm::{BIAS_MAX, Lamp, Model, OFFSET_MIN, Parameters, View};
use triptych_spec::vertex::DEPTH_ONE;

use super::told::Told;
use crate::scene::file::MeshEntry;
use crate::scene::rsm::Rsm;
use crate::scene::{Loaded, Mistake};
use crate::vector::{length, sub};

/// Distance from a plane within which points are one surface, by default: a 256th of the
/// lattice's side.
const EDGE: u32 = 1 << 16;

/// A reference distance, in steps, that the spec takes.
const REFERENCE: f64 = 16_777_216.0;

/// What all frames share.
pub struct Setup {
    /// World space and the lattice: around everything in all frames, and around perspective
    /// eyes, so that frames compare.
    pub lattice: Lattice,
    /// From where the picture is seen.
    pub eye: View,
    /// What lights it.
    pub lamp: Lamp,
    /// In steps of the lattice.
    pub parameters: Parameters,
    /// How many frames there are.
    pub frames: u32,
}

/// What a frame is made of.
pub struct Parts {
    /// What is seen.
    pub model: Model,
    /// What blocks indirect light.
    pub blockers: Blockers,
    /// The blockers' cells.
    pub grid: Grid,
}

impl Setup {
    /// Of a scene with an `[rsm]`.
    ///
    /// # Errors
    /// Coordinates that are not finite, and whatever exceeds a limit of the spec, in one line, with
    /// the key to change.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let rsm = loaded.file.rsm.as_ref();
        let rsm = rsm.ok_or_else(|| "has no [rsm]".to_owned())?.get_ref();
        let eye = loaded.world.camera;
        let light = rsm.lamp.get_ref().camera()?;
        let lattice = lattice(loaded, rsm.frames.0, [&eye, &light])?;
        let told = Told {
            rsm,
            light: &light,
            lattice: &lattice,
        };
        let view =
            |key, camera, size| View::new(camera, &lattice, size).map_err(|e| told.view(key, &e));
        let lamp = view("rsm.lamp", &light, rsm.map.0)?;
        let (strength, reference) = bright(rsm, &light, &lattice);
        let lamp = Lamp::new(lamp, strength, reference).map_err(|e| told.lamp(&e))?;
        let parameters = parameters(rsm, &light, &lattice);
        let checked = parameters.check(loaded.scene.size);
        checked.map_err(|e| told.parameters(&e))?;
        Ok(Self {
            eye: view("camera", &eye, loaded.scene.size)?,
            lamp,
            parameters,
            frames: rsm.frames.0,
            lattice,
        })
    }

    /// What a frame is made of; the blockers' cells are built anew for each.
    ///
    /// # Errors
    /// Whatever exceeds a limit of the spec, in one line.
    pub fn parts(&self, loaded: &Loaded, frame: u32) -> Result<Parts, Mistake> {
        let points = points(loaded, frame);
        let scene = &loaded.scene;
        let entries = loaded.entries();
        let of = |is: fn(&MeshEntry) -> bool| {
            let triangles = scene.triangles.iter();
            triangles.filter(move |t| is(entries[t.instance as usize]))
        };
        let snap = |row: u32| self.lattice.snap(points[row as usize]).unwrap_or_default();
        let seen = of.clone()(MeshEntry::is_seen);
        let (vertices, triangles) = packed(seen.clone().map(|t| t.vertices), snap);
        let colours = seen.map(|t| [t.colour[0], t.colour[1], t.colour[2]]);
        let model = Model::new(vertices, triangles, colours.collect());
        let (vertices, triangles) = packed(of(MeshEntry::does_block).map(|t| t.vertices), snap);
        let blockers = Blockers {
            vertices,
            triangles,
        };
        let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box);
        Ok(Parts {
            model: model.map_err(|e| e.to_string())?,
            grid: grid.map_err(|e| cells(frame, &e))?,
            blockers,
        })
    }
}

/// Why blockers have no cells. Nobody states how many there are.
fn cells(frame: u32, error: &GridError) -> Mistake {
    let of = match error {
        GridError::Entries(entries) => {
            format!(
                "{entries} entries in the cells of the blockers, and {ENTRIES_MAX} are the limit"
            )
        }
        _ => error.to_string(),
    };
    Mistake::of(
        "rsm",
        format!("frame {}: {of}; use simpler blockers", frame + 1),
    )
}

/// Triangles with only those vertices that they use, in order of first use.
fn packed(
    triangles: impl Iterator<Item = [u32; 3]>,
    point: impl Fn(u32) -> Point,
) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut rows = std::collections::BTreeMap::new();
    let mut vertices = Vec::new();
    let mut row = |old: u32| {
        *rows.entry(old).or_insert_with(|| {
            vertices.push(point(old));
            u32::try_from(vertices.len() - 1).expect("scenes have fewer than 2^32 rows")
        })
    };
    let triangles = triangles.map(|corners| corners.map(&mut row)).collect();
    (vertices, triangles)
}

/// The scene's vertices in world space, in one frame.
fn points(loaded: &Loaded, frame: u32) -> Vec<[f64; 3]> {
    let placed = loaded.world.instances.iter().zip(loaded.entries());
    let worlds: Vec<Matrix> = placed
        .map(|(world, entry)| moved(world, entry, frame))
        .collect();
    let vertices = loaded.scene.vertices.iter();
    let point = |v: &triptych_spec::scene::Vertex| {
        worlds[v.instance as usize].point(v.position.map(f64::from))
    };
    vertices.map(point).collect()
}

/// Where a mesh stands in a frame: turned about its own origin, placed, and moved on.
fn moved(world: &Matrix, entry: &MeshEntry, frame: u32) -> Matrix {
    let (motion, times) = (entry.motion(), f64::from(frame));
    let turned = (0..3).fold(Matrix::scale([1.0; 3]), |m, axis| {
        Matrix::rotate(axis, motion.rotate.0[axis] * times).times(&m)
    });
    let on = Matrix::translate(motion.translate.0.map(|c| c * times));
    on.times(world).times(&turned)
}

/// The finest lattice that holds all frames, and the eyes.
fn lattice(loaded: &Loaded, frames: u32, cameras: [&Camera; 2]) -> Result<Lattice, String> {
    let perspective = |c: &&Camera| matches!(c.projection, Projection::Perspective { .. });
    let eyes = cameras.into_iter().filter(perspective).map(|c| c.eye);
    let still = loaded.entries().iter().all(|entry| entry.moves.is_none());
    let frames = if still { 1 } else { frames };
    let all = (0..frames).flat_map(|frame| {
        let points = points(loaded, frame);
        let triangles = loaded.scene.triangles.iter();
        triangles.flat_map(move |t| t.vertices.map(|v| points[v as usize]))
    });
    match Lattice::around(all.chain(eyes)) {
        Ok(lattice) => Ok(lattice),
        // Nothing is seen, from infinitely far away.
        Err(LatticeError::Empty) => Ok(Lattice {
            centre: [0.0; 3],
            exponent: 0,
        }),
        Err(error) => Err(error.to_string()),
    }
}

/// The strength of the lamp, and at how many steps from it. A spot light that is so strong at a
/// distance is four times as strong at half of it; so any distance will do, also those that
/// are longer than the lattice. A directional light has none.
fn bright(rsm: &Rsm, light: &Camera, lattice: &Lattice) -> ([f32; 3], u32) {
    let mut strength = rsm.strength.0;
    let mut reference = match light.projection {
        Projection::Orthographic { .. } => 1.0,
        Projection::Perspective { .. } => {
            let distance = length(sub(light.target, light.eye));
            let distance = rsm.reference.map_or(distance, |length| length.0);
            libm::scalbn(distance, -lattice.exponent)
        }
    };
    // Where it is too strong for a number, the spec refuses it.
    while reference > REFERENCE && strength.iter().all(|c| c.is_finite()) {
        reference /= 2.0;
        strength = strength.map(|c| 4.0 * c);
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let strength = strength.map(|c| c as f32);
    (
        strength,
        u32::try_from(nearest(reference)).unwrap_or(u32::MAX),
    )
}

/// A length in steps of the lattice, to the nearest.
fn steps(lattice: &Lattice, length: f64) -> u64 {
    nearest(libm::scalbn(length, -lattice.exponent))
}

fn nearest(x: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, and limits are checked afterwards"
    )]
    let integer = libm::floor(x + 0.5) as u64;
    integer
}

/// Lengths of the world in steps, and the defaults. What is beyond a limit stays so, for the
/// spec to refuse.
fn parameters(rsm: &Rsm, light: &Camera, lattice: &Lattice) -> Parameters {
    let distance = length(sub(light.target, light.eye));
    let texel = texel(rsm, light);
    let bias = rsm.bias.map_or(2.0 * texel, |length| length.0);
    let clamp = steps(lattice, clamp(rsm, light));
    let edge = rsm.edge.map(|length| steps(lattice, length.0));
    let edge = edge.map(|steps| u32::try_from(steps).unwrap_or(u32::MAX));
    Parameters {
        radius: rsm.radius.0,
        stride: rsm.stride.0,
        divisor: rsm.divisor.0,
        blur: rsm.blur.0,
        bias: keys(light, distance, bias),
        clamp: clamp.saturating_mul(clamp).max(1),
        offset: rsm.offset.0.max(OFFSET_MIN),
        edge: edge.unwrap_or(EDGE),
    }
}

/// How wide a texel is at the lamp's target.
fn texel(rsm: &Rsm, light: &Camera) -> f64 {
    let side = match light.projection {
        Projection::Perspective { fov } => {
            let distance = length(sub(light.target, light.eye));
            2.0 * libm::tan(fov.to_radians() / 2.0) * distance
        }
        Projection::Orthographic { height } => height,
    };
    side / f64::from(rsm.map.0.height)
}

/// As which length shorter ones count.
pub(super) fn clamp(rsm: &Rsm, light: &Camera) -> f64 {
    let default = || 2.0 * texel(rsm, light) * f64::from(rsm.stride.0);
    rsm.clamp.map_or_else(default, |length| length.0)
}

/// Depth keys that a length along a camera's axis takes at a distance. All depths are equal
/// from [`BIAS_MAX`] on, so more is no error.
fn keys(camera: &Camera, distance: f64, length: f64) -> u32 {
    let (near, far) = (camera.near, camera.far);
    let slope = match camera.projection {
        // Depth is f / (f - n) (1 - n / d).
        Projection::Perspective { .. } => far * near / ((far - near) * distance * distance),
        Projection::Orthographic { .. } => 1.0 / (far - near),
    };
    let keys = nearest(slope * length * f64::from(DEPTH_ONE));
    u32::try_from(keys).unwrap_or(BIAS_MAX).min(BIAS_MAX)
}
