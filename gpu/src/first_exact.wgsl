// Which of two meetings is first, and when a search has passed one: exactly, where the f32 times
// of meet.wgsl leave it open. Twin: first.wgsl.
//
// A time is the quotient of two volumes, each off by 1 / FOR_TIME = 2^-10 of it at most: by less
// than 2^-8.9 in all. If one is below NEAR = 1 - 2^-7 of another, no error of both turns them
// around, for (1 - 2^-7) (1 + 2^-8.9) < 1 - 2^-8.9; nor one of a single time.
//#import long

const NEAR: f32 = 1.0 - 1.0 / 128.0;

// The first of two; the smaller id of two at a time.
fn nearer(ray: Ray, hit: Hit, time: f32, prim: u32) -> Hit {
    var is_first = time < hit.time * NEAR;
    if !is_first && time * NEAR <= hit.time {
        is_first = precedes(ray, prim, hit.prim);
    }
    return Hit(select(hit.prim, prim, is_first), select(hit.time, time, is_first), hit.state, hit.at);
}

// What a hit's time must be below to be before a time at which a cell is left.
fn surely(exit: f32) -> f32 {
    return exit * NEAR;
}

// When a ray meets a triangle, as the quotient of two integers below 2^76, neither negative.
struct Quotient {
    num: Long,
    den: Long,
}

fn time_of(ray: Ray, triangle: u32) -> Quotient {
    let a = corner(triangle, 0u);
    let e = vec3<i32>(corner(triangle, 1u) - a);
    let f = vec3<i32>(corner(triangle, 2u) - a);
    return Quotient(
        long_size(long_volume(vec3<i32>(a - ray.origin), e, f)),
        long_size(long_volume(vec3<i32>(ray.direction), e, f)),
    );
}

// Whether one triangle is met before another, of two at a time the smaller.
fn precedes(ray: Ray, prim: u32, other: u32) -> bool {
    let one = time_of(ray, prim);
    let two = time_of(ray, other);
    let left = product(one.num, two.den);
    let right = product(two.num, one.den);
    if all(left.high == right.high) && all(left.low == right.low) {
        return prim < other;
    }
    if all(left.high == right.high) {
        return left.low.y < right.low.y || (left.low.y == right.low.y && left.low.x < right.low.x);
    }
    return lower(left.high, right.high);
}

// Six words, low ones first.
struct Product {
    low: vec2<u32>,
    high: vec4<u32>,
}

fn product(a: Long, b: Long) -> Product {
    let x = scaled(a, b.x);
    let y = added(vec4(x.yzw, 0u), scaled(a, b.y));
    let z = added(vec4(y.yzw, 0u), scaled(a, b.z));
    return Product(vec2(x.x, y.x), z);
}

// Four words; a is not negative.
fn scaled(a: Long, by: u32) -> vec4<u32> {
    let x = wide_mul_words(a.x, by);
    let y = wide_mul_words(a.y, by);
    let z = wide_mul_words(a.z, by);
    return added(vec4(x, z), vec4(0u, y, 0u));
}

fn added(a: vec4<u32>, b: vec4<u32>) -> vec4<u32> {
    let low = long_add(a.xyz, b.xyz);
    // A sum of three words that is less than a part of it has carried.
    return vec4(low, a.w + b.w + u32(long_less(low, a.xyz)));
}

fn lower(a: vec4<u32>, b: vec4<u32>) -> bool {
    if a.w != b.w {
        return a.w < b.w;
    }
    return long_less(a.xyz, b.xyz);
}
