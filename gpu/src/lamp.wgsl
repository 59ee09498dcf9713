// The light, as the eye's points see it: where they lie in its map, and what comes straight.
//#import view
//#import texel

// Depth keys of the light's map; NOTHING is farther than all.
@group(0) @binding(8) var<storage, read> keys: array<u32>;

const PLACE_MAX: i32 = 1048576;
const DEPTH_ONE: i32 = 0x7fffffff;
const DEPTH_SCALE: f32 = 2147483648.0;

// Where in the light's map a point lies.
fn place_of(point: vec3<f32>) -> Place {
    let q = vec4(point, 1.0);
    let w = dot(view.w, q);
    if !(w > 0.0) {
        return Place(vec2(0), 0u, 0u);
    }
    let at = floor(vec2(dot(view.x, q), dot(view.y, q)) / w);
    let texel = vec2<i32>(clamp(at, vec2(-f32(PLACE_MAX)), vec2(f32(PLACE_MAX))));
    let depth = dot(view.z, q) / w;
    let key = select(i32(max(depth, 0.0) * DEPTH_SCALE), DEPTH_ONE, depth >= 1.0);
    return Place(texel, u32(key), 1u);
}

// The traditional shadow test.
fn reached(place: Place) -> bool {
    let size = vec2<i32>(vec2(parameters.map_width, parameters.map_height));
    if place.known == 0u || any(place.texel < vec2(0)) || any(place.texel >= size) {
        return false;
    }
    let key = keys[u32(place.texel.y) * parameters.map_width + u32(place.texel.x)];
    return key == NOTHING || place.key <= key + parameters.bias;
}

fn irradiance(towards: f32, way: vec3<f32>) -> vec3<f32> {
    let inverse = inverseSqrt(max(dot(way, way), 1.0));
    var factor = towards * inverse;
    if view.near == 1u {
        let ratio = parameters.reference * inverse;
        factor *= ratio * ratio;
    }
    return factor * parameters.strength.xyz;
}
