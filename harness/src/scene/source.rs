//! Where a scene's meshes come from: files, packages, generators.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use toml::Spanned;

use super::file::MeshEntry;
use super::{LoadError, MeshStats, Parsed, Stats};
use crate::corpus;
use crate::error::InputError;
use crate::mesh::{self, Intake, MATERIALS_MAX, Mesh, TRIANGLES_MAX, VERTICES_MAX};
use crate::text::hex;

/// What installs the meshes of packages.
const INSTALL: &str = "./x setup";

/// A mesh and how it was had.
pub(super) struct Source {
    pub(super) mesh: Mesh,
    pub(super) stats: MeshStats,
}

/// The one mesh of a scene that is a bare file.
pub(super) fn bare(path: &Path) -> Spanned<MeshEntry> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let entry = MeshEntry {
        file: Some(name.into_owned()),
        ..MeshEntry::default()
    };
    Spanned::new(0..0, entry)
}

/// Loads every mesh of a scene, in order, and adds what was read to the digest.
pub(super) fn load_all(
    intake: &mut Intake,
    parsed: &Parsed,
    digest: &mut Sha256,
) -> Result<Vec<Source>, LoadError> {
    let mut totals = Totals::default();
    let mut sources = Vec::new();
    for (number, entry) in (0..).zip(&parsed.file.mesh) {
        let source = load_one(intake, parsed, number, entry, digest)?;
        let added = totals.add(&source);
        added.map_err(|message| parsed.error(entry.span(), message))?;
        sources.push(source);
    }
    Ok(sources)
}

/// What the meshes so far add up to, with all their copies.
#[derive(Default)]
struct Totals {
    triangles: u64,
    vertices: u64,
    materials: u64,
}

impl Totals {
    /// Adds a mesh, or says which limit it exceeds.
    fn add(&mut self, source: &Source) -> Result<(), String> {
        let mesh = &source.mesh;
        // A mesh without copies takes room nevertheless. Neither factor reaches 2^32:
        // meshes and scene files have limits.
        let copies = source.stats.instances.max(1);
        self.triangles += copies * mesh.triangles.len() as u64;
        self.vertices += copies * mesh.positions.len() as u64;
        self.materials += mesh.materials.len() as u64 - 1;
        let (triangles, vertices) = (self.triangles, self.vertices);
        if triangles > TRIANGLES_MAX || vertices > VERTICES_MAX {
            return Err(format!(
                "{triangles} triangles and {vertices} vertices up to here exceed the limits of {TRIANGLES_MAX} and {VERTICES_MAX}"
            ));
        }
        match self.materials > MATERIALS_MAX {
            false => Ok(()),
            true => Err(format!(
                "{} materials of meshes up to here exceed the limit of {MATERIALS_MAX}",
                self.materials
            )),
        }
    }
}

fn load_one(
    intake: &mut Intake,
    parsed: &Parsed,
    number: u64,
    entry: &Spanned<MeshEntry>,
    digest: &mut Sha256,
) -> Result<Source, LoadError> {
    let e = entry.get_ref();
    match (&e.file, &e.package, &e.generate) {
        (Some(file), None, None) => {
            let folder = parsed.path.parent().unwrap_or(Path::new(""));
            let path = if corpus::is_mesh(parsed.path) {
                parsed.path.to_owned() // keeps names that are not UTF-8
            } else {
                folder.join(file)
            };
            load_file(intake, parsed, entry, &path, digest)
        }
        (None, Some(package), None) => {
            let (path, pinned) = find_package(intake, parsed, package)?;
            let source = load_file(intake, parsed, entry, &path, digest)?;
            if is_hair(&path) {
                check_layout(intake, &mesh::layout_of(&path))?;
            }
            if source.stats.sha256.as_deref() != Some(&pinned) {
                let found = source.stats.sha256.unwrap_or_default();
                let message = format!(
                    "has sha256 {found}, not {pinned} of corpus/meshes.lock; run {INSTALL}"
                );
                return Err(InputError::new(path, message).into());
            }
            Ok(source)
        }
        (None, None, Some(generator)) => {
            if let (Some(_), message) = (e.hair, "hair is for a .bin.gz of strands only") {
                return Err(parsed.error(entry.span(), message).into());
            }
            // Meshes of one scene get different sequences.
            let seed = parsed.file.seed.wrapping_mul(1 << 16).wrapping_add(number);
            let mesh = generator
                .get_ref()
                .mesh(seed)
                .map_err(|message| parsed.error(generator.span(), message))?;
            Ok(Source::new(None, mesh, e))
        }
        _ => {
            let message = "a mesh needs exactly one of file, package and generate";
            Err(parsed.error(entry.span(), message).into())
        }
    }
}

fn load_file(
    intake: &mut Intake,
    parsed: &Parsed,
    entry: &Spanned<MeshEntry>,
    path: &Path,
    digest: &mut Sha256,
) -> Result<Source, LoadError> {
    let bytes = intake.read(path, mesh::BYTES_MAX)?;
    let sha256 = hex(&Sha256::digest(&bytes));
    digest.update(sha256.as_bytes());
    if is_hair(path) {
        digest.update(sha256_of(intake, &mesh::layout_of(path))?);
    }
    let mesh = match (is_hair(path), entry.get_ref().hair) {
        (true, hair) => {
            let stride = hair.unwrap_or_default().stride;
            mesh::load_hair(intake, path, bytes, stride)?
        }
        (false, None) => mesh::load(intake, path, bytes)?,
        (false, Some(_)) => {
            let message = "hair is for a .bin.gz of strands only";
            return Err(parsed.error(entry.span(), message).into());
        }
    };
    for named in &mesh.materials {
        digest.update(format!("{named:?}"));
    }
    Ok(Source::new(Some(sha256), mesh, entry.get_ref()))
}

fn is_hair(path: &Path) -> bool {
    path.to_string_lossy().ends_with(".bin.gz")
}

fn sha256_of(intake: &mut Intake, layout: &Path) -> Result<String, InputError> {
    let bytes = intake.read(layout, mesh::LAYOUT_MAX)?;
    Ok(hex(&Sha256::digest(&bytes)))
}

/// Holds the layout of a package's hair against the hash that its own row pins.
fn check_layout(intake: &mut Intake, layout: &Path) -> Result<(), InputError> {
    let name = layout.file_name().unwrap_or_default().to_string_lossy();
    let rows = mesh::lock::read(intake)?;
    let pinned = rows.iter().find(|row| row.name == name);
    let found = sha256_of(intake, layout)?;
    match pinned {
        Some(row) if row.sha256 == found => Ok(()),
        Some(row) => {
            let message = format!(
                "has sha256 {found}, not {} of corpus/meshes.lock; run {INSTALL}",
                row.sha256
            );
            Err(InputError::new(layout, message))
        }
        None => Err(InputError::new(layout, "is not in corpus/meshes.lock")),
    }
}

impl Source {
    fn new(sha256: Option<String>, mesh: Mesh, entry: &MeshEntry) -> Self {
        let source = match (&entry.file, &entry.package, &entry.generate) {
            (Some(file), ..) => format!("file {file}"),
            (_, Some(package), _) => format!("package {package}"),
            (.., Some(generator)) => format!("generate {}", generator.get_ref().name()),
            (None, None, None) => String::new(),
        };
        let mut notes = mesh.notes.clone();
        notes.warnings.extend(undefined(&mesh, entry));
        let stats = MeshStats {
            source,
            sha256,
            triangles: mesh.triangles.len() as u64,
            instances: entry.instances.len() as u64,
            degenerate: mesh.degenerate(),
            notes,
        };
        Self { mesh, stats }
    }
}

/// A remark about materials that neither libraries nor the scene define.
fn undefined(mesh: &Mesh, entry: &MeshEntry) -> Option<String> {
    // Row 0 is of faces that ask for no material.
    let named = &mesh.materials[1..];
    let is_undefined =
        |n: &&mesh::Named| n.defined.is_none() && !entry.materials.contains_key(n.name.as_str());
    let count = named.iter().filter(is_undefined).count();
    (count > 0 && entry.material.is_none()).then(|| {
        format!(
            "{count} of {} materials not defined, so their faces take the default",
            named.len()
        )
    })
}

/// Where a package's mesh lies, and the hash that its row pins.
fn find_package(
    intake: &mut Intake,
    parsed: &Parsed,
    package: &Spanned<String>,
) -> Result<(PathBuf, String), LoadError> {
    let rows = mesh::lock::read(intake)?;
    let name = package.get_ref().as_str();
    let Some(row) = rows.iter().find(|r| r.name == name) else {
        let message = format!("`{name}` is no row of corpus/meshes.lock");
        return Err(parsed.error(package.span(), message).into());
    };
    let path = corpus::meshes().join(name);
    if !intake.has(&path) {
        return Err(LoadError::Missing {
            mesh: name.to_owned(),
            command: INSTALL,
        });
    }
    Ok((path, row.sha256.clone()))
}

/// Sums over the meshes.
pub(super) fn stats(meshes: &[Source]) -> Stats {
    let total = |count: fn(&MeshStats) -> u64| {
        let counts = meshes.iter().map(|m| count(&m.stats) * m.stats.instances);
        counts.sum()
    };
    Stats {
        triangles: total(|m| m.triangles),
        degenerate: total(|m| m.degenerate),
        meshes: meshes.iter().map(|m| m.stats.clone()).collect(),
        sha256: String::new(),
    }
}
