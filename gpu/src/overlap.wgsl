// Whether a triangle may touch a widened cell: by separating axes (Akenine-Möller 2001) in
// f32, in favour of touching. What the spec's integers keep is kept here.

// In units of 2^-23, of the sum of all terms' sizes. A component of an axis is off by 2 at
// most (those of a normal; others are exact), a dot product by 5 more, the sum of the sizes
// itself by as much: 7 * (1 + 2^-20) and a comparison's own rounding stay below 8.
const OVERLAP_ERROR: f32 = 8.0 / 8388608.0;

fn overlaps(cell: vec3<u32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let start = starts();
    let at = start + cell;
    let near = vec3(boundaries[at.x], boundaries[at.y], boundaries[at.z]);
    let far = vec3(boundaries[at.x + 1u], boundaries[at.y + 1u], boundaries[at.z + 1u]);
    // From a corner of the cell all differences are exact, and so is the cell's size.
    let low = near - WIDENED;
    let size = far + WIDENED - low;
    let p = a - low;
    let q = b - low;
    let r = c - low;
    let e = q - p;
    let f = r - q;
    let g = p - r;
    // The cell's own axes have been looked at: it is among those that the box touches.
    return !(apart_on_edge(e, p, r, size) || apart_on_edge(f, q, p, size)
        || apart_on_edge(g, r, q, size) || apart_on_normal(e, f, p, size));
}

// Whether one of the three axes that are normal to an edge and to an axis of the cell has the
// triangle on one side. Both ends of the edge project alike: one of them and the third corner
// are enough.
fn apart_on_edge(e: vec3<f32>, end: vec3<f32>, third: vec3<f32>, size: vec3<f32>) -> bool {
    return apart(vec3(0.0, -e.z, e.y), end, third, size)
        || apart(vec3(e.z, 0.0, -e.x), end, third, size)
        || apart(vec3(-e.y, e.x, 0.0), end, third, size);
}

fn apart(axis: vec3<f32>, p: vec3<f32>, q: vec3<f32>, size: vec3<f32>) -> bool {
    let least = dot(min(axis, vec3(0.0)), size);
    let most = dot(max(axis, vec3(0.0)), size);
    let one = dot(axis, p);
    let other = dot(axis, q);
    let error = OVERLAP_ERROR * dot(abs(axis), abs(p) + abs(q) + size);
    return min(one, other) > most + error || max(one, other) < least - error;
}

// On the normal all corners project alike. Its own components are off by two roundings of
// their terms, whose sizes take the place of the components in the error.
fn apart_on_normal(e: vec3<f32>, f: vec3<f32>, p: vec3<f32>, size: vec3<f32>) -> bool {
    let normal = cross(e, f);
    let sizes = abs(e.yzx * f.zxy) + abs(e.zxy * f.yzx);
    let least = dot(min(normal, vec3(0.0)), size);
    let most = dot(max(normal, vec3(0.0)), size);
    let at = dot(normal, p);
    let error = OVERLAP_ERROR * dot(sizes, abs(p) + size);
    return at > most + error || at < least - error;
}
