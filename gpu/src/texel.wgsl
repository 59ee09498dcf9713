// Texels of the light's map as lights.
//#import surface

struct Light {
    point: vec3<f32>,
    // As a surface's; NOTHING: the texel is dark.
    face: u32,
    // The unit normal on the side that is seen.
    unit: vec3<f32>,
    unused: u32,
}

@group(0) @binding(10) var<storage, read_write> lights: array<Light>;

// Linear; the fourth number is not used.
@group(0) @binding(11) var<storage, read_write> intensities: array<vec4<f32>>;

struct Place {
    // Column and row in the light's map, also beyond it.
    texel: vec2<i32>,
    // Depth key.
    key: u32,
    // 1, or 0: nowhere in front of the light.
    known: u32,
}

@group(0) @binding(7) var<storage, read_write> places: array<Place>;

fn side() -> u32 {
    return 2u * parameters.radius + 1u;
}

fn words() -> u32 {
    return (side() * side() + 31u) / 32u;
}

// The texel of a kernel's row and column; NOTHING beyond the map.
fn texel_at(place: Place, column: u32, row: u32) -> u32 {
    let way = (vec2<i32>(vec2(column, row)) - i32(parameters.radius)) * i32(parameters.stride);
    let texel = place.texel + way;
    let inside = all(texel >= vec2(0)) && all(texel < vec2<i32>(vec2(parameters.map_width, parameters.map_height)));
    return select(NOTHING, u32(texel.y) * parameters.map_width + u32(texel.x), inside);
}

// What a texel gives to a surface in free space.
struct Term {
    // Over its intensity.
    factor: f32,
    // Whether each is turned to the other, exactly.
    counts: bool,
}

fn term(to: Surface, unit: vec3<f32>, texel: u32) -> Term {
    let none = Term(0.0, false);
    let light = lights[texel];
    if light.face == NOTHING {
        return none;
    }
    let d = light.point - to.point;
    let p = along(to.face, unit, d);
    if !p.faces {
        return none;
    }
    let q = along(light.face, light.unit, -d);
    let square = max(dot(d, d), parameters.clamp);
    return Term(p.value * q.value / (square * square), q.faces);
}
