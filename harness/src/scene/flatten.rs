//! From a parsed scene and its meshes to [`Scene`].

use std::collections::{BTreeMap, BTreeSet};

use toml::Spanned;
use triptych_spec::camera::{Camera, CameraError, ENTRY_MAX, Projection};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Triangle, Vertex};

use super::file::{CameraEntry, MaterialEntry, MeshEntry};
use super::source::Source;
use super::value::{Point, Scale};
use super::world::World;
use super::{LoadError, Parsed, fit, shade};
use crate::error::InputError;
use crate::mesh::Named;

/// Largest entry of a mesh's placement. World coordinates then stay below 1e90,
/// and their products in shading below the largest `f64`.
const PLACEMENT_MAX: f64 = 1e50;

/// What a face is made of if neither scene nor mesh says so: it lets light
/// through, so that a bare mesh shows its layers.
const DEFAULT: Surface = Surface {
    reflectance: [0.8; 3],
    opacity: 0.5,
};

#[derive(Clone, Copy)]
struct Surface {
    reflectance: [f64; 3],
    opacity: f64,
}

/// The scene's materials by name.
type Materials<'a> = BTreeMap<&'a str, Surface>;

/// One mesh entry, resolved.
struct Placed<'a> {
    source: &'a Source,
    /// World from object, one per instance.
    worlds: Vec<Matrix>,
    /// One per row of the mesh's materials.
    surfaces: Vec<Surface>,
    entry: &'a Spanned<MeshEntry>,
}

impl Placed<'_> {
    /// Every vertex of every instance in world space.
    fn points(&self) -> impl Iterator<Item = [f64; 3]> {
        let points = |world: &Matrix| {
            let world = *world;
            let positions = self.source.mesh.positions.iter();
            positions.map(move |p| world.point(p.map(f64::from)))
        };
        self.worlds.iter().flat_map(points)
    }
}

pub(super) fn flatten(parsed: &Parsed, sources: &[Source]) -> Result<(Scene, World), LoadError> {
    let materials = materials(parsed)?;
    let entries = parsed.file.mesh.iter().zip(sources);
    let placed: Vec<Placed> = entries
        .map(|(entry, source)| place(parsed, &materials, entry, source))
        .collect::<Result<_, _>>()?;
    let size = parsed.file.size.0;
    let (camera, view) = view(parsed, &placed)?;
    let mut scene = Scene {
        size,
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: Vec::new(),
        background: parsed.file.background.0.map(shade::single),
    };
    let mut primitive = 0;
    for mesh in &placed {
        append(&mut scene, parsed, &view, mesh, &mut primitive)?;
    }
    // In the order of the scene's own.
    let instances = placed.iter().flat_map(|mesh| &mesh.worlds);
    let instances = instances.copied().collect();
    Ok((scene, World { camera, instances }))
}

/// The scene's materials by name. Refuses two of one name.
fn materials<'a>(parsed: &'a Parsed) -> Result<Materials<'a>, InputError> {
    let mut materials = Materials::new();
    for MaterialEntry {
        name,
        colour,
        opacity,
    } in &parsed.file.material
    {
        let surface = Surface {
            reflectance: colour.0,
            opacity: opacity.0,
        };
        if materials.insert(name.get_ref(), surface).is_some() {
            let message = format!("material `{}` is defined twice", name.get_ref());
            return Err(parsed.error(name.span(), message));
        }
    }
    Ok(materials)
}

fn place<'a>(
    parsed: &Parsed,
    materials: &Materials,
    entry: &'a Spanned<MeshEntry>,
    source: &'a Source,
) -> Result<Placed<'a>, LoadError> {
    let e = entry.get_ref();
    let own = matrix(e.scale, e.rotate, e.translate);
    let world = |t: &super::file::Transform| matrix(t.scale, t.rotate, t.translate).times(&own);
    let worlds: Vec<Matrix> = e.instances.iter().map(world).collect();
    let entries = worlds.iter().flat_map(|m| m.rows.iter().flatten());
    if let Some(x) = entries
        .into_iter()
        .find(|x| x.is_nan() || x.abs() > PLACEMENT_MAX)
    {
        let message = format!("the placement's matrix has {x:e}, beyond {PLACEMENT_MAX:e}");
        return Err(parsed.error(entry.span(), message).into());
    }
    Ok(Placed {
        source,
        worlds,
        surfaces: surfaces(parsed, materials, e, source)?,
        entry,
    })
}

fn matrix(Scale(s): Scale, Point(r): Point, Point(t): Point) -> Matrix {
    let turned = (0..3).fold(Matrix::scale(s), |m, axis| {
        Matrix::rotate(axis, r[axis]).times(&m)
    });
    Matrix::translate(t).times(&turned)
}

/// The surface of every material of a mesh: named in `materials`, else
/// `material`, else what the mesh's library defines, else [`DEFAULT`].
fn surfaces(
    parsed: &Parsed,
    materials: &Materials,
    entry: &MeshEntry,
    source: &Source,
) -> Result<Vec<Surface>, InputError> {
    let named = &source.mesh.materials;
    let names: BTreeSet<&str> = named[1..].iter().map(|n| n.name.as_str()).collect();
    for key in entry.materials.keys() {
        if !names.contains(key.get_ref().as_str()) {
            let known = listed(names.iter().copied());
            let message = format!(
                "the mesh has no material `{}`; it has: {known}",
                key.get_ref()
            );
            return Err(parsed.error(key.span(), message));
        }
    }
    let resolve = |n: &Named| {
        let single = entry.materials.get(n.name.as_str());
        match (single.or(entry.material.as_ref()), n.defined) {
            (Some(material), _) => find_material(parsed, materials, material),
            (None, Some((reflectance, opacity))) => Ok(Surface {
                reflectance,
                opacity,
            }),
            (None, None) => Ok(DEFAULT),
        }
    };
    named.iter().map(resolve).collect()
}

fn find_material(
    parsed: &Parsed,
    materials: &Materials,
    name: &Spanned<String>,
) -> Result<Surface, InputError> {
    materials
        .get(name.get_ref().as_str())
        .copied()
        .ok_or_else(|| {
            let known = listed(materials.keys().copied());
            let message = format!(
                "no [[material]] is named `{}`; there are: {known}",
                name.get_ref()
            );
            parsed.error(name.span(), message)
        })
}

/// Names as an error shows them: not all of a thousand.
fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 12;
    let more = names.len().saturating_sub(SHOWN);
    let mut shown = names.take(SHOWN).collect::<Vec<_>>().join(", ");
    if more > 0 {
        shown += &format!(" and {more} more");
    }
    shown
}

/// The camera, and clip space from world space.
fn view(parsed: &Parsed, placed: &[Placed]) -> Result<(Camera, Matrix), InputError> {
    let size = parsed.file.size.0;
    let aspect = f64::from(size.width) / f64::from(size.height);
    let Some(entry) = &parsed.file.camera else {
        let points = || placed.iter().flat_map(Placed::points);
        let camera = fit::camera(points, aspect);
        let error = |e: CameraError| InputError::new(parsed.path, e.to_string());
        return Ok((camera, camera.matrix(aspect).map_err(error)?));
    };
    let error = |message: String| parsed.error(entry.span(), message);
    let camera = camera(entry.get_ref()).map_err(error)?;
    let matrix = camera.matrix(aspect).map_err(|e| error(e.to_string()))?;
    Ok((camera, matrix))
}

fn camera(entry: &CameraEntry) -> Result<Camera, String> {
    let projection = match (entry.fov, entry.height) {
        (Some(fov), None) => Projection::Perspective { fov: fov.0 },
        (None, Some(height)) => Projection::Orthographic { height: height.0 },
        _ => {
            let message = "camera: either fov (perspective) or height (orthographic) is needed";
            return Err(message.to_owned());
        }
    };
    Ok(Camera {
        eye: entry.eye.0,
        target: entry.target.0,
        up: entry.up.0,
        projection,
        near: entry.near.0,
        far: entry.far.0,
    })
}

/// Adds all instances of a mesh, so that triangles stay in the order of
/// `(primitive, instance)`.
fn append(
    scene: &mut Scene,
    parsed: &Parsed,
    view: &Matrix,
    placed: &Placed,
    primitive: &mut u32,
) -> Result<(), InputError> {
    let mesh = &placed.source.mesh;
    let (instance, vertex) = (row(scene.instances.len()), row(scene.vertices.len()));
    for (number, world) in (instance..).zip(&placed.worlds) {
        let clip = view.times(world);
        if let Some(x) = clip
            .rows
            .iter()
            .flatten()
            .find(|x| x.is_nan() || x.abs() > ENTRY_MAX)
        {
            let message = format!("placement and camera together have {x:e}, beyond {ENTRY_MAX:e}");
            return Err(parsed.error(placed.entry.span(), message));
        }
        scene.instances.push(clip);
        scene.vertices.extend(mesh.positions.iter().map(|p| Vertex {
            position: *p,
            instance: number,
        }));
    }
    for (corners, material) in mesh.triangles.iter().zip(&mesh.material) {
        let surface = placed.surfaces[*material as usize];
        for (copy, world) in (0..).zip(&placed.worlds) {
            let at = |v: &u32| world.point(mesh.positions[*v as usize].map(f64::from));
            let [a, b, c] = corners;
            let [r, g, b] = shade::face(
                &parsed.file.light,
                surface.reflectance,
                [at(a), at(b), at(c)],
            )
            .map_err(|e| parsed.error(placed.entry.span(), format!("triangle {primitive}: {e}")))?;
            let first = vertex + copy * row(mesh.positions.len());
            scene.triangles.push(Triangle {
                vertices: corners.map(|v| first + v),
                instance: instance + copy,
                primitive: *primitive,
                colour: [r, g, b, shade::single(surface.opacity)],
            });
        }
        *primitive += 1;
    }
    Ok(())
}

/// A row number; limits of meshes and scenes have bounded it.
fn row(n: usize) -> u32 {
    u32::try_from(n).expect("scenes have fewer than 2^32 rows")
}
