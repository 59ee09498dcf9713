//! scene.toml files.

use super::{Case, Fails, Loads};

/// What each is, and what is to come of it.
#[rustfmt::skip] // one case, one row
pub const CASES: &[Case] = &[
    // ---- loads
    ("empty-scene.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n", Loads(0)),
    ("byte-order-mark.toml", b"\xef\xbb\xbfpurpose = 'x'\nsize = [1, 1]\nmesh = []\n", Loads(0)),
    ("fan.toml", b"purpose = 'x'\nsize = [8, 8]\n[[mesh]]\ngenerate.fan = { spokes = 5, radius = 1 }\n", Loads(5)),
    ("no-copies.toml", b"purpose = 'x'\nsize = [8, 8]\n[[mesh]]\ngenerate.fan = { spokes = 5, radius = 1 }\ninstances = []\n", Loads(0)),
    ("flattened.toml", b"purpose = 'x'\nsize = [8, 8]\n[[mesh]]\ngenerate.fan = { spokes = 5, radius = 1 }\nscale = 0\n", Loads(5)),
    ("light-inside.toml", b"purpose = 'x'\nsize = [8, 8]\n[[light]]\npoint = { position = [0, 0, 0], intensity = [1, 1, 1] }\n[[mesh]]\ngenerate.faces = { vertices = [[0, 0, 0], [1, 0, 0], [-1, 0, 0]], faces = [[0, 1, 2]] }\n", Loads(1)),
    // ---- syntax and keys
    ("nothing.toml", b"", Fails(":1: missing field `purpose`")),
    ("no-syntax.toml", b"purpose = 'x'\nsize = [1, 1\n", Fails(":2: unclosed array, expected `]`")),
    ("not-utf-8.toml", b"purpose = 'x'\nsize = '\xff'\n", Fails(":2: is not UTF-8; a scene.toml is expected")),
    ("unknown-key.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\ncolour = 3\n", Fails(":4: unknown field `colour`, expected one of `purpose`, `seed`, `size`, `background`, `camera`, `light`, `material`, `mesh`, `abuffer`, `budget`, `expect`")),
    ("unknown-table.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[lights]\na = 1\n", Fails(":4: unknown field `lights`, expected one of `purpose`, `seed`, `size`, `background`, `camera`, `light`, `material`, `mesh`, `abuffer`, `budget`, `expect`")),
    ("twice.toml", b"purpose = 'x'\npurpose = 'y'\n", Fails(":2: duplicate key")),
    ("no-purpose.toml", b"size = [1, 1]\nmesh = []\n", Fails(":1: missing field `purpose`")),
    ("blank-purpose.toml", b"purpose = ' '\nsize = [1, 1]\nmesh = []\n", Fails(":1: say in one line what the scene is for")),
    ("no-mesh.toml", b"purpose = 'x'\nsize = [1, 1]\n", Fails(":1: missing field `mesh`")),
    ("wrong-type.toml", b"purpose = 3\nsize = [1, 1]\nmesh = []\n", Fails(":1: invalid type: integer `3`, expected a string")),
    // ---- values
    ("size-zero.toml", b"purpose = 'x'\nsize = [0, 5]\nmesh = []\n", Fails(":2: 0 is outside 1 to 2048 pixels")),
    ("size-negative.toml", b"purpose = 'x'\nsize = [5, -1]\nmesh = []\n", Fails(":2: -1 is outside 1 to 2048 pixels")),
    ("size-large.toml", b"purpose = 'x'\nsize = [2049, 1]\nmesh = []\n", Fails(":2: 2049 is outside 1 to 2048 pixels")),
    ("size-beyond.toml", b"purpose = 'x'\nsize = [9223372036854775807, 1]\nmesh = []\n", Fails(":2: 9223372036854775807 is outside 1 to 2048 pixels")),
    ("size-one.toml", b"purpose = 'x'\nsize = [8]\nmesh = []\n", Fails(":2: invalid length 1, expected an array of length 2")),
    ("size-fraction.toml", b"purpose = 'x'\nsize = [8.5, 8]\nmesh = []\n", Fails(":2: invalid type: floating point `8.5`, expected i64")),
    ("background-nan.toml", b"purpose = 'x'\nsize = [1, 1]\nbackground = [0, nan, 0]\nmesh = []\n", Fails(":3: NaN is outside 0 to 1e6")),
    ("background-negative.toml", b"purpose = 'x'\nsize = [1, 1]\nbackground = [0, -1, 0]\nmesh = []\n", Fails(":3: -1 is outside 0 to 1e6")),
    ("seed-negative.toml", b"purpose = 'x'\nseed = -1\nsize = [1, 1]\nmesh = []\n", Fails(":2: invalid value: integer `-1`, expected u64")),
    ("capacity.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[abuffer]\ncapacity = 'most'\n", Fails(":5: \"most\" is neither \"all\", \"all-N\" nor a number of nodes")),
    ("capacity-negative.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\nabuffer.capacity = -1\n", Fails(":4: -1 is neither \"all\", \"all-N\" nor a number of nodes")),
    ("budget.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\nbudget.edge = 2\n", Fails(":4: 2 is outside 0 to 1")),
    ("opacity.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[[material]]\nname = 'a'\ncolour = [1, 1, 1]\nopacity = 1.5\n", Fails(":7: 1.5 is outside 0 to 1")),
    ("material-twice.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\nmaterial = [\n{ name = 'a', colour = [1, 1, 1], opacity = 1 },\n{ name = 'a', colour = [1, 1, 1], opacity = 0 }]\n", Fails(":6: material `a` is defined twice")),
    ("light-kind.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[[light]]\nspot = { intensity = [1, 1, 1] }\n", Fails(":5: unknown variant `spot`, expected one of `ambient`, `directional`, `point`")),
    ("light-direction.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[[light]]\ndirectional = { direction = [0, 0, 0], intensity = [1, 1, 1] }\n", Fails(":5: a direction must not be zero")),
    // ---- camera
    ("camera-neither.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n\n[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nnear = 1\nfar = 2\n", Fails(":5: camera: either fov (perspective) or height (orthographic) is needed")),
    ("camera-flat.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n\n[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 1]\nfov = 40\nnear = 1\nfar = 2\n", Fails(":5: camera: eye, target and up must span a plane")),
    ("camera-near.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n\n[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nfov = 40\nnear = 2\nfar = 2\n", Fails(":5: camera: near must be less than far")),
    ("camera-fov.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n\n[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nfov = 180\nnear = 1\nfar = 2\n", Fails(":5: camera: fov must lie in (0, 180) degrees")),
    ("camera-inf.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n[camera]\neye = [0, inf, 1]\ntarget = [0, 0, 0]\nfov = 40\nnear = 1\nfar = 2\n", Fails(":5: inf is not a finite number")),
    ("camera-beyond.toml", b"purpose = 'x'\nsize = [1, 1]\nmesh = []\n\n[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nheight = 1e-200\nnear = 1\nfar = 2\n", Fails(":5: camera: the matrix is out of range")),
    // ---- meshes
    ("mesh-nothing.toml", b"purpose = 'x'\nsize = [1, 1]\n\n[[mesh]]\nscale = 2\n", Fails(":4: a mesh needs exactly one of file, package and generate")),
    ("mesh-both.toml", b"purpose = 'x'\nsize = [1, 1]\n\n[[mesh]]\nfile = 'a.obj'\npackage = 'bunny.obj'\n", Fails(":4: a mesh needs exactly one of file, package and generate")),
    ("mesh-key.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\nfile = 'a.obj'\nrotation = [0, 0, 0]\n", Fails(":5: unknown field `rotation`, expected one of `file`, `package`, `generate`, `hair`, `material`, `materials`, `scale`, `rotate`, `translate`, `instances`")),
    ("mesh-scale.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\nfile = 'a.obj'\nscale = [1, 2]\n", Fails(":5: [1, 2] is neither a number nor three")),
    ("mesh-scale-nan.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\nfile = 'a.obj'\nscale = nan\n", Fails(":5: NaN is not a finite number")),
    ("mesh-placement.toml", b"purpose = 'x'\nsize = [1, 1]\n\n[[mesh]]\ngenerate.box = { size = [1, 1, 1] }\nscale = 1e51\n", Fails(":4: the placement's matrix has 1e51, beyond 1e50")),
    ("mesh-material.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.box = { size = [1, 1, 1] }\nmaterial = 'glass'\n", Fails(":5: no [[material]] is named `glass`; there are: ")),
    ("mesh-materials.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.box = { size = [1, 1, 1] }\nmaterials = { red = 'glass' }\n", Fails(":5: the mesh has no material `red`; it has: ")),
    ("mesh-package.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\npackage = '../../etc/passwd'\n", Fails(":4: `../../etc/passwd` is no row of corpus/meshes.lock")),
    ("mesh-extension.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\nfile = 'mesh-extension.toml'\n", Fails(": is no mesh by its name: .obj and .ply are read, and .gz of either")),
    ("mesh-hair.toml", b"purpose = 'x'\nsize = [1, 1]\n\n[[mesh]]\ngenerate.box = { size = [1, 1, 1] }\nhair = { stride = 2 }\n", Fails(":4: hair is for a .bin.gz of strands only")),
    ("hair-zero.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\npackage = 'furBall_A.bin.gz'\nhair = { stride = 0 }\n", Fails(":5: invalid value: integer `0`, expected a nonzero u32")),
    // ---- generators
    ("generator.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.cone = { radius = 1 }\n", Fails(":4: unknown variant `cone`, expected one of `faces`, `stack`, `fan`, `grid`, `scatter`, `sphere`, `torus`, `box`")),
    ("generator-key.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.fan = { spokes = 3, radius = 1, hubb = 1 }\n", Fails(":4: unexpected keys in table: hubb, available keys: spokes, radius, hub")),
    ("generator-few.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.fan = { spokes = 2, radius = 1 }\n", Fails(":4: spokes = 2 does not close a circle; 3 or more do")),
    ("generator-many.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.grid = { cells = [4294967295, 4294967295], cell = [1, 1] }\n", Fails(":4: 36893488130239234050 triangles and 18446744073709551616 vertices exceed the limits of 4194304 and 12582912")),
    ("generator-none.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.grid = { cells = [0, 5], cell = [1, 1] }\n", Fails(":4: no triangles")),
    ("generator-jitter.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.grid = { cells = [5, 5], cell = [1, 1], jitter = 0.25 }\n", Fails(":4: jitter = 0.25 is outside 0 to 0.25")),
    ("generator-beyond.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.sphere = { radius = 1e39, segments = [4, 4] }\n", Fails(":4: vertex 0 at [0.0, 1e39, 0.0] is beyond f32")),
    ("generator-index.toml", b"purpose = 'x'\nsize = [1, 1]\n[[mesh]]\ngenerate.faces = { vertices = [[0, 0, 0]], faces = [[0, 0, 1]] }\n", Fails(":4: face 0 names vertex 1 of 1")),
    ("instances.toml", b"purpose = 'x'\nsize = [1, 1]\n\n[[mesh]]\ngenerate.scatter = { count = 1000, copies = 4000, extent = [1, 1, 1], length = 1, width = 1 }\ninstances = [{}, {}]\n", Fails(":4: 8000000 triangles and 6000 vertices up to here exceed the limits of 4194304 and 12582912")),
    ("light-near.toml", b"purpose = 'x'\nsize = [1, 1]\n[[light]]\npoint = { position = [0, 0, 1e-9], intensity = [1, 1, 1] }\n\n[[mesh]]\ngenerate.faces = { vertices = [[0, 1, 0], [1, -1, 0], [-1, 0, 0]], faces = [[0, 1, 2]] }\n", Fails(":6: triangle 0: shading gives 8e17, beyond 1e6")),
];
