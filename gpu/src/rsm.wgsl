// RSM: one bounce of indirect light from a reflective shadow map, with indirect shadows (Yang
// et al. 2010, section 4.2). Twin: spec/src/rsm.rs.
//
// Rays between `block_rays` and `block_bits` are searched by `trace` (grid.wgsl). Within a pass,
// invocations meet in atomics only; sums have an order of their own, so pictures do not depend
// on who comes first.
//#import item
//#import parameters
//#import surface
//#import view
//#import texel
//#import lamp
//#import coarse
//#import asked

// Row in the model of the triangle that a pixel sees, by way of `sources`; or NOTHING.
@group(0) @binding(2) var<storage, read> nearest: array<u32>;

// Row in the model of each triangle that was drawn.
@group(0) @binding(3) var<storage, read> sources: array<u32>;

// What a texel's strength and colour are multiplied by.
@group(0) @binding(9) var<storage, read> weights: array<f32>;

// Irradiance that comes straight; the fourth number is 1 where the light reaches, else 0.
@group(0) @binding(12) var<storage, read_write> lit: array<vec4<f32>>;

// Buffer A: irradiance. The fourth number of this and those that follow is not used.
@group(0) @binding(13) var<storage, read_write> all_light: array<vec4<f32>>;

// words() for each pixel of buffer B: which texels are blocked.
@group(0) @binding(14) var<storage, read_write> bits: array<atomic<u32>>;

// Buffer B: irradiance.
@group(0) @binding(15) var<storage, read_write> blocked: array<vec4<f32>>;

// The same, averaged.
@group(0) @binding(16) var<storage, read_write> blurred: array<vec4<f32>>;

@group(0) @binding(17) var<storage, read_write> picture: array<vec4<f32>>;

// How many rays were asked for.
@group(0) @binding(18) var<storage, read_write> asked: atomic<u32>;

@group(0) @binding(19) var<storage, read_write> rays: array<Ray>;

@group(0) @binding(20) var<storage, read_write> hits: array<Hit>;

fn nothing() -> Surface {
    return Surface(vec3(0.0), NOTHING);
}

fn seen_at(pixel: u32) -> Surface {
    let drawn = nearest[pixel];
    if drawn == NOTHING {
        return nothing();
    }
    return surface_of(sources[drawn], pixel);
}

// One pixel.
@compute @workgroup_size(64)
fn gbuffer(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel < parameters.items {
        seen[pixel] = seen_at(pixel);
    }
}

// One texel.
@compute @workgroup_size(64)
fn rsm(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let texel = item(id, groups);
    if texel >= parameters.items {
        return;
    }
    let surface = seen_at(texel);
    lights[texel] = Light(surface.point, surface.face, vec3(0.0), 0u);
    if surface.face != NOTHING {
        lights[texel].unit = towards_viewer(surface.face);
        intensities[texel] = weights[texel] * parameters.strength * faces[surface.face / 2u].colour;
    }
}

// One pixel.
@compute @workgroup_size(64)
fn place(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel >= parameters.items {
        return;
    }
    let surface = seen[pixel];
    places[pixel] = Place(vec2(0), 0u, 0u);
    if surface.face != NOTHING {
        places[pixel] = place_of(surface.point);
    }
}

// One pixel.
@compute @workgroup_size(64)
fn direct(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel >= parameters.items {
        return;
    }
    let surface = seen[pixel];
    lit[pixel] = vec4(0.0);
    if surface.face == NOTHING || !reached(places[pixel]) {
        return;
    }
    let way = to_viewer(surface.point);
    let towards = along(surface.face, towards_viewer(surface.face), way);
    if towards.faces {
        lit[pixel] = vec4(irradiance(towards.value, way), 1.0);
    }
}

// One pixel, and some rows of its kernel.
@compute @workgroup_size(64)
fn gather(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel >= parameters.items {
        return;
    }
    let surface = seen[pixel];
    let place = places[pixel];
    var sum = vec4(0.0);
    if parameters.first > 0u {
        sum = all_light[pixel];
    }
    if surface.face != NOTHING && place.known == 1u {
        let unit = towards_viewer(surface.face);
        for (var row = parameters.first; row < parameters.first + parameters.rows; row += 1u) {
            for (var column = 0u; column < side(); column += 1u) {
                let texel = texel_at(place, column, row);
                if texel != NOTHING {
                    let term = term(surface, unit, texel);
                    if term.counts {
                        sum += term.factor * intensities[texel];
                    }
                }
            }
        }
    }
    all_light[pixel] = sum;
}

// Rays of a workgroup, and the place of the first: one addition to `asked` for all of them, which
// would otherwise be what the pass waits for.
var<workgroup> claimed: atomic<u32>;
var<workgroup> first_place: u32;

// One pair: a ray, if the texel would light the pixel.
@compute @workgroup_size(64)
fn block_rays(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if lane == 0u {
        atomicStore(&claimed, 0u);
    }
    workgroupBarrier();
    let at = item(id, groups);
    var asking = Asked(Ray(vec3(0.0), 1u, vec3(0.0), 0u), false);
    if at < parameters.items {
        asking = asked_by(parameters.first + at);
    }
    var own = 0u;
    if asking.counts {
        own = atomicAdd(&claimed, 1u);
    }
    workgroupBarrier();
    if lane == 0u {
        first_place = atomicAdd(&asked, atomicLoad(&claimed));
    }
    workgroupBarrier();
    if asking.counts {
        rays[first_place + own] = asking.ray;
        hits[first_place + own] = Hit(NOTHING, 0.0, FRESH, 0u);
    }
}

// One ray.
@compute @workgroup_size(64)
fn block_bits(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let ray = item(id, groups);
    if ray >= parameters.items || hits[ray].prim == NOTHING {
        return;
    }
    let kernel = side() * side();
    let number = rays[ray].owner % kernel;
    let word = rays[ray].owner / kernel * words() + number / 32u;
    atomicOr(&bits[word], 1u << (number % 32u));
}

// One pixel of buffer B, and some rows of its kernel.
@compute @workgroup_size(64)
fn block_sum(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let cell = item(id, groups);
    if cell >= parameters.items {
        return;
    }
    let pixel = fine(cell % parameters.coarse_width, cell / parameters.coarse_width);
    let surface = seen[pixel];
    let place = places[pixel];
    var sum = vec4(0.0);
    if parameters.first > 0u {
        sum = blocked[cell];
    }
    if surface.face != NOTHING && place.known == 1u {
        let unit = towards_viewer(surface.face);
        let begin = parameters.first * side();
        let end = begin + parameters.rows * side();
        for (var at = begin / 32u; at * 32u < end; at += 1u) {
            var word = blocked_word(cell, at, begin, end);
            while word != 0u {
                let number = at * 32u + firstTrailingBit(word);
                word &= word - 1u;
                let texel = texel_at(place, number % side(), number / side());
                sum += term(surface, unit, texel).factor * intensities[texel];
            }
        }
    }
    blocked[cell] = sum;
}

// Which of the 32 texels of a word are blocked, of those from `begin` to `end`.
fn blocked_word(cell: u32, at: u32, begin: u32, end: u32) -> u32 {
    var word = atomicLoad(&bits[cell * words() + at]);
    if at * 32u < begin {
        word &= 0xffffffffu << (begin - at * 32u);
    }
    if end - at * 32u < 32u {
        word &= (1u << (end - at * 32u)) - 1u;
    }
    return word;
}

// One pixel of buffer B.
@compute @workgroup_size(64)
fn blur(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let cell = item(id, groups);
    if cell >= parameters.items {
        return;
    }
    let column = cell % parameters.coarse_width;
    let row = cell / parameters.coarse_width;
    let middle = seen[fine(column, row)];
    if middle.face == NOTHING {
        blurred[cell] = vec4(0.0);
        return;
    }
    let first = vec2(column, row) - min(vec2(column, row), vec2(parameters.blur));
    let last = min(vec2(column, row) + parameters.blur, vec2(parameters.coarse_width, parameters.coarse_height) - 1u);
    var sum = vec4(0.0);
    var terms = 0u;
    for (var y = first.y; y <= last.y; y += 1u) {
        for (var x = first.x; x <= last.x; x += 1u) {
            let other = seen[fine(x, y)];
            if other.face != NOTHING && same(middle, other) {
                sum += blocked[y * parameters.coarse_width + x];
                terms += 1u;
            }
        }
    }
    // One term is what it was.
    blurred[cell] = select(sum / f32(terms), sum, terms == 1u);
}

// One pixel.
@compute @workgroup_size(64)
fn compose(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel >= parameters.items {
        return;
    }
    let surface = seen[pixel];
    if surface.face == NOTHING {
        picture[pixel] = parameters.background;
        return;
    }
    let cell = taken_from(surface, pixel);
    let indirect = max(all_light[pixel] - blurred[cell], vec4(0.0));
    let light = vec4(lit[pixel].xyz, 0.0) + indirect;
    picture[pixel] = light * faces[surface.face / 2u].colour;
}
