//! From a parsed scene and its meshes to [`Scene`].

use toml::Spanned;
use triptych_spec::camera::{Camera, CameraError, ENTRY_MAX};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Triangle, Vertex};

use super::file::MeshEntry;
use super::source::Source;
use super::surface::{Materials, Surface, made_opaque, materials, surfaces};
use super::value::{Point, Scale};
use super::world::World;
use super::{LoadError, Parsed, fit, shade};
use crate::error::InputError;

/// Largest entry of a mesh's placement. World coordinates then stay below 1e90,
/// and their products in shading below the largest `f64`.
pub(super) const PLACEMENT_MAX: f64 = 1e50;

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

/// The scene, and what it is before the camera looks at it. Remarks go to the sources.
pub(super) fn flatten(
    parsed: &Parsed,
    sources: &mut [Source],
) -> Result<(Scene, World), LoadError> {
    let materials = materials(parsed)?;
    if parsed.file.is_lit_later() {
        remark(parsed, &materials, sources)?;
    }
    let entries = parsed.file.mesh.iter().zip(&*sources);
    let placed: Vec<Placed> = entries
        .map(|(entry, source)| place(parsed, &materials, entry, source))
        .collect::<Result<_, _>>()?;
    let size = parsed.file.size.0;
    let (camera, view) = view(parsed, &placed)?;
    let mut scene = Scene {
        samples: parsed.file.samples.0,
        order: parsed.file.abuffer.order.order(),
        size,
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: Vec::new(),
        background: parsed.file.background.0.map(shade::single),
    };
    let mut primitive = 0;
    let mut mirrors = Vec::new();
    for mesh in &placed {
        append(&mut scene, parsed, &view, mesh, &mut primitive)?;
        if parsed.file.dispatch.is_some() {
            mirrors.extend(mirrored(mesh));
        }
    }
    // In the order of the scene's own.
    let instances = placed.iter().flat_map(|mesh| &mesh.worlds);
    let instances = instances.copied().collect();
    let world = World {
        camera,
        instances,
        mirrors,
    };
    Ok((scene, world))
}

/// What each triangle of a mesh mirrors, in the order in which they are in the scene.
fn mirrored(mesh: &Placed) -> impl Iterator<Item = [f32; 3]> {
    let rows = mesh.source.mesh.material.iter();
    rows.flat_map(|row| {
        let mirror = mesh.surfaces[*row as usize].mirror.map(shade::single);
        mesh.worlds.iter().map(move |_| mirror)
    })
}

/// Says of each mesh what a scene whose light is worked out later does not do of what its materials
/// ask for.
fn remark(
    parsed: &Parsed,
    materials: &Materials,
    sources: &mut [Source],
) -> Result<(), InputError> {
    let section = match (&parsed.file.ldm, &parsed.file.dispatch) {
        (Some(_), _) => "[ldm]",
        (None, Some(_)) => "[dispatch]",
        (None, None) => "[rsm]",
    };
    for (entry, source) in parsed.file.mesh.iter().zip(sources) {
        let surfaces = surfaces(parsed, materials, entry.get_ref(), source)?;
        let remark = made_opaque(&surfaces, source, section);
        source.stats.notes.warnings.extend(remark);
    }
    Ok(())
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
    let camera = entry.get_ref().camera().map_err(error)?;
    let matrix = camera.matrix(aspect).map_err(|e| error(e.to_string()))?;
    Ok((camera, matrix))
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
    // Such a scene's light is worked out by its legs, and passes through nothing.
    let lit_later = parsed.file.is_lit_later();
    let opacity = |opacity| match lit_later {
        true => 1.0,
        false => shade::single(opacity),
    };
    for (corners, material) in mesh.triangles.iter().zip(&mesh.material) {
        let surface = placed.surfaces[*material as usize];
        for (copy, world) in (0..).zip(&placed.worlds) {
            let at = |v: &u32| world.point(mesh.positions[*v as usize].map(f64::from));
            let [a, b, c] = corners;
            let shaded = match lit_later {
                true => Ok(surface.reflectance.map(shade::single)),
                false => shade::face(
                    &parsed.file.light,
                    surface.reflectance,
                    [at(a), at(b), at(c)],
                ),
            };
            let [r, g, b] = shaded.map_err(|e| {
                parsed.error(placed.entry.span(), format!("triangle {primitive}: {e}"))
            })?;
            let first = vertex + copy * row(mesh.positions.len());
            scene.triangles.push(Triangle {
                vertices: corners.map(|v| first + v),
                instance: instance + copy,
                primitive: *primitive,
                colour: [r, g, b, opacity(surface.opacity)],
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
