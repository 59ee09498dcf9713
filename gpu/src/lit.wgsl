// Lamps, and what they give to a point (spec/src/dispatch/light.rs).
//#import task
//#import volume

const LAMPS_MAX: u32 = 64u;

struct Lamp {
    position: vec3<f32>,
    // Where strength is meant, in lattice steps.
    reference: f32,
    strength: vec3<f32>,
    // Least squared distance, rounded.
    least: f32,
}

@group(0) @binding(1) var<uniform> lamps: array<Lamp, 64>;

// Whether numbers that are not negative are above 0, subnormal ones too, which sums and products
// may take for 0.
fn some(v: vec3<f32>) -> vec3<bool> {
    return (bitcast<vec3<u32>>(v) & vec3(0x7fffffffu)) != vec3(0u);
}

// The sign of normal . d for the side that is seen, exactly.
fn sign_towards(face: u32, d: vec3<f32>) -> i32 {
    let a = triangles[face / 2u].a;
    let e = triangles[face / 2u].b - a;
    let f = triangles[face / 2u].c - a;
    return side_of(face) * volume(Factors(d, e, f, 1.0)).sign;
}

// Whether a lamp could add anything to what is seen with a weight.
fn could_light(surface: Surface, weight: vec3<u32>, lamp: Lamp) -> bool {
    let colour = some(triangles[surface.face / 2u].colour);
    return any((weight > vec3(0u)) & colour & some(lamp.strength))
        && sign_towards(surface.face, lamp.position - surface.point) > 0;
}

// What it adds if nothing is in between.
fn lit(surface: Surface, weight: vec3<u32>, lamp: Lamp) -> vec3<f32> {
    let way = lamp.position - surface.point;
    let inverse = inverseSqrt(max(dot(way, way), lamp.least));
    let unit = f32(side_of(surface.face)) * triangles[surface.face / 2u].unit;
    let cosine = max(dot(unit, way), 0.0) * inverse;
    let ratio = lamp.reference * inverse;
    let part = vec3<f32>(weight) / f32(WEIGHT_ONE);
    return (cosine * (ratio * ratio)) * (lamp.strength * triangles[surface.face / 2u].colour * part);
}
