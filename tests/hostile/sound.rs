//! What holds of every mesh, whatever it was loaded from.

use triptych_harness::mesh::Mesh;

/// What every mesh that loads must satisfy.
pub fn assert_sound(mesh: &Mesh) {
    let finite = mesh.positions.iter().flatten().all(|x| x.is_finite());
    assert!(finite, "a coordinate is not finite");
    let corners = mesh.triangles.iter().flatten();
    let inside = corners
        .into_iter()
        .all(|v| (*v as usize) < mesh.positions.len());
    assert!(inside, "a corner is out of range");
    let named = mesh
        .material
        .iter()
        .all(|m| (*m as usize) < mesh.materials.len());
    assert!(named, "a material is out of range");
    let counts = [mesh.material.len(), mesh.triangles.len()];
    assert!(
        counts[0] == counts[1] && counts[0] > 0,
        "counts are {counts:?}"
    );
}
