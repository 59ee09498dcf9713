// What is seen, and the planes of triangles. Points are integers of the lattice, as f32,
// which holds them exactly; so are their differences.
//#import parameters
//#import volume
//#import ray

// Three for each triangle; the fourth numbers are not used.
@group(0) @binding(4) var<storage, read> corners: array<vec4<f32>>;

struct Face {
    // The normal at length 1, or 0.
    unit: vec3<f32>,
    // The axis along which the normal is longest, from 1, with the sign of its component; 0
    // without a normal.
    axis: i32,
    // The normal at length 2^14, in integers.
    coarse: vec3<i32>,
    unused: u32,
    // Linear; the fourth number is not used.
    colour: vec4<f32>,
}

@group(0) @binding(5) var<storage, read> faces: array<Face>;

// A point of a triangle, and from which side it is seen.
struct Surface {
    point: vec3<f32>,
    // Twice the triangle, and 1 if its normal points away from the viewer; or NOTHING.
    face: u32,
}

fn corner(triangle: u32, i: u32) -> vec3<f32> {
    return corners[3u * triangle + i].xyz;
}

fn side_of(face: u32) -> f32 {
    return select(1.0, -1.0, (face & 1u) == 1u);
}

// The unit normal on the side that is seen.
fn towards_viewer(face: u32) -> vec3<f32> {
    return side_of(face) * faces[face / 2u].unit;
}

// The sign of normal . d, exactly.
fn sign_along(triangle: u32, d: vec3<f32>) -> i32 {
    let a = corner(triangle, 0u);
    return volume(Factors(d, corner(triangle, 1u) - a, corner(triangle, 2u) - a, 1.0)).sign;
}

// How far n . d may be off, over |d|_1, for a unit normal n. With u = 2^-23 for a rounding in
// any direction n was rounded to nearest, half a u; the product meets three roundings, in any
// order and fused or not; no component of n exceeds 1 + u; |d|_1 itself meets two, and so does
// its product with this number: 3.5 of them, with room.
const FACING_ERROR: f32 = 6.0 / 8388608.0;

// How far a difference reaches in front of a face.
struct Along {
    // n . d, not negative.
    value: f32,
    // Whether n . d > 0, exactly.
    faces: bool,
}

fn along(face: u32, unit: vec3<f32>, d: vec3<f32>) -> Along {
    let value = dot(unit, d);
    let certain = abs(value) > FACING_ERROR * (abs(d.x) + abs(d.y) + abs(d.z));
    if certain {
        return Along(max(value, 0.0), value > 0.0);
    }
    let sign = sign_along(face / 2u, d);
    return Along(max(value, 0.0), select(sign > 0, sign < 0, (face & 1u) == 1u));
}

// Whether two surfaces are on the same side of all depth edges and creases
// (spec/src/rsm/same.rs).
fn same(a: Surface, b: Surface) -> bool {
    if a.face / 2u == b.face / 2u {
        return a.face == b.face;
    }
    let n = i32(side_of(a.face)) * faces[a.face / 2u].coarse;
    let m = i32(side_of(b.face)) * faces[b.face / 2u].coarse;
    let apart = vec3<i32>(a.point - b.point);
    // At most 3 * 2^28.
    return n.x * m.x + n.y * m.y + n.z * m.z > 0 && is_near(n, apart) && is_near(m, apart);
}

// |n . d| <= edge 2^14, in 64 bits.
fn is_near(n: vec3<i32>, d: vec3<i32>) -> bool {
    let sum = wide_add(wide_mul(n.x, d.x), wide_add(wide_mul(n.y, d.y), wide_mul(n.z, d.z)));
    let zero = wide(0);
    var size = sum;
    if wide_negative(sum) {
        size = wide_sub(zero, sum);
    }
    return !wide_less(wide_shift(wide_from(parameters.edge), COARSE_BITS), size);
}

const COARSE_BITS: u32 = 14u;
