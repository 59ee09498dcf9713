//! From a parsed scene and its meshes to [`Scene`].

use toml::Spanned;
use triptych_spec::camera::{Camera, ENTRY_MAX, Projection};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Triangle, Vertex};

use super::file::{CameraEntry, MeshEntry};
use super::source::Source;
use super::value::{Point, Scale};
use super::{LoadError, Parsed, fit, shade};
use crate::error::InputError;
use crate::mesh::{TRIANGLES_MAX, VERTICES_MAX};

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

pub(super) fn flatten(parsed: &Parsed, sources: &[Source]) -> Result<Scene, LoadError> {
    check_names(parsed)?;
    let entries = parsed.file.mesh.iter().zip(sources);
    let placed: Vec<Placed> = entries
        .map(|(entry, source)| place(parsed, entry, source))
        .collect::<Result<_, _>>()?;
    check_limits(parsed, &placed)?;
    let size = parsed.file.size.0;
    let view = view(parsed, &placed)?;
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
    Ok(scene)
}

/// Refuses two materials of one name.
fn check_names(parsed: &Parsed) -> Result<(), InputError> {
    let mut seen = std::collections::BTreeSet::new();
    for name in parsed.file.material.iter().map(|m| &m.name) {
        if !seen.insert(name.get_ref()) {
            let message = format!("material `{}` is defined twice", name.get_ref());
            return Err(parsed.error(name.span(), message));
        }
    }
    Ok(())
}

/// Refuses what exceeds the limits before anything is made.
fn check_limits(parsed: &Parsed, placed: &[Placed]) -> Result<(), InputError> {
    let (mut triangles, mut vertices) = (0_u64, 0_u64);
    for mesh in placed {
        let copies = mesh.worlds.len() as u64;
        // Both factors are below 2^32: a mesh and a scene file have limits.
        triangles += copies * mesh.source.mesh.triangles.len() as u64;
        vertices += copies * mesh.source.mesh.positions.len() as u64;
        if triangles > TRIANGLES_MAX || vertices > VERTICES_MAX {
            let message = format!(
                "{triangles} triangles and {vertices} vertices up to here exceed the limits of {TRIANGLES_MAX} and {VERTICES_MAX}"
            );
            return Err(parsed.error(mesh.entry.span(), message));
        }
    }
    Ok(())
}

fn place<'a>(
    parsed: &Parsed,
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
        surfaces: surfaces(parsed, e, source)?,
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
    entry: &MeshEntry,
    source: &Source,
) -> Result<Vec<Surface>, InputError> {
    let named = &source.mesh.materials;
    for key in entry.materials.keys() {
        if !named.iter().any(|n| n.name == *key.get_ref()) {
            let known: Vec<&str> = named[1..].iter().map(|n| n.name.as_str()).collect();
            let message = format!(
                "the mesh has no material `{}`; it has: {}",
                key.get_ref(),
                known.join(", ")
            );
            return Err(parsed.error(key.span(), message));
        }
    }
    let resolve = |n: &crate::mesh::Named| {
        let single = entry.materials.iter().find(|(k, _)| *k.get_ref() == n.name);
        let chosen = single
            .map(|(_, material)| material)
            .or(entry.material.as_ref());
        match (chosen, n.defined) {
            (Some(material), _) => find_material(parsed, material),
            (None, Some((reflectance, opacity))) => Ok(Surface {
                reflectance,
                opacity,
            }),
            (None, None) => Ok(DEFAULT),
        }
    };
    named.iter().map(resolve).collect()
}

fn find_material(parsed: &Parsed, name: &Spanned<String>) -> Result<Surface, InputError> {
    let materials = &parsed.file.material;
    match materials
        .iter()
        .find(|m| m.name.get_ref() == name.get_ref())
    {
        Some(m) => Ok(Surface {
            reflectance: m.colour.0,
            opacity: m.opacity.0,
        }),
        None => {
            let known: Vec<&str> = materials
                .iter()
                .map(|m| m.name.get_ref().as_str())
                .collect();
            let message = format!(
                "no [[material]] is named `{}`; there are: {}",
                name.get_ref(),
                known.join(", ")
            );
            Err(parsed.error(name.span(), message))
        }
    }
}

/// Clip space from world space.
fn view(parsed: &Parsed, placed: &[Placed]) -> Result<Matrix, InputError> {
    let size = parsed.file.size.0;
    let aspect = f64::from(size.width) / f64::from(size.height);
    let Some(entry) = &parsed.file.camera else {
        let points = || placed.iter().flat_map(Placed::points);
        let fitted = fit::camera(points, aspect).matrix(aspect);
        return fitted.map_err(|e| InputError::new(parsed.path, e.to_string()));
    };
    let error = |message: String| parsed.error(entry.span(), message);
    let camera = camera(entry.get_ref()).map_err(error)?;
    camera.matrix(aspect).map_err(|e| error(e.to_string()))
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

/// A row number; [`check_limits`] has bounded it.
fn row(n: usize) -> u32 {
    u32::try_from(n).expect("scenes have fewer than 2^32 rows")
}
