// Where a ray meets a triangle: the same answer as the spec's integers.
//#import volume

struct Meeting {
    met: bool,
    time: f32,
}

// How good a volume must be for a time: its error is then 2^-10 of it at most.
const FOR_TIME: f32 = 1024.0;

// The ray passes all three edges on one side, or on them, and is within its own ends. Signs
// are exact, so neighbours leave no gap and no order of corners matters.
fn meets(ray: Ray, triangle: u32) -> Meeting {
    let miss = Meeting(false, 0.0);
    let a = corner(triangle, 0u) - ray.origin;
    let b = corner(triangle, 1u) - ray.origin;
    let c = corner(triangle, 2u) - ray.origin;
    let of_c = volume(b - a, ray.direction, a, 1.0).sign;
    let of_a = volume(c - b, ray.direction, b, 1.0).sign;
    if of_c * of_a < 0 {
        return miss;
    }
    let of_b = volume(a - c, ray.direction, c, 1.0).sign;
    if of_b * of_c < 0 || of_b * of_a < 0 {
        return miss;
    }
    // The sides sum up to direction . normal.
    let facing = sign(of_a + of_b + of_c);
    let height = volume(a, b - a, c - a, FOR_TIME);
    if facing == 0 || height.sign * facing < 0 {
        return miss;
    }
    if ray.segment == 1u && volume(a - ray.direction, b - a, c - a, 1.0).sign * facing > 0 {
        return miss;
    }
    let slope = volume(ray.direction, b - a, c - a, FOR_TIME);
    return Meeting(true, height.value / slope.value);
}
