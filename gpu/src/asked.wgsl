// Which rays buffer B asks for.
//#import coarse
//#import texel

// The ray of a pair of a pixel of buffer B and a texel of its kernel.
struct Asked {
    ray: Ray,
    // Whether the texel would light the pixel.
    counts: bool,
}

fn asked_by(pair: u32) -> Asked {
    let none = Asked(Ray(vec3(0.0), 1u, vec3(0.0), pair), false);
    let kernel = side() * side();
    let cell = pair / kernel;
    let pixel = fine(cell % parameters.coarse_width, cell / parameters.coarse_width);
    let surface = seen[pixel];
    let place = places[pixel];
    if surface.face == NOTHING || place.known == 0u {
        return none;
    }
    let number = pair % kernel;
    let texel = texel_at(place, number % side(), number / side());
    if texel == NOTHING || !term(surface, towards_viewer(surface.face), texel).counts {
        return none;
    }
    return Asked(Ray(surface.point, 1u, lights[texel].point - surface.point, pair), true);
}
