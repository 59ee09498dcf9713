// Bricks of 4 x 4 x 4 cells, a bit for each cell that lists anything: an empty brick is
// crossed in one step.

// Two words a brick; x fastest, in a brick and among them.
@group(0) @binding(14) var<storage, read_write> bricks: array<vec2<u32>>;

// The brick that a ray is in, so that it is read once.
struct Brick {
    number: u32,
    words: vec2<u32>,
}

fn brick_counts() -> vec3<u32> {
    return (vec3(cells.x, cells.y, cells.z) + 3u) / 4u;
}

fn brick_of(cell: vec3<u32>) -> u32 {
    let counts = brick_counts();
    let brick = cell / 4u;
    return brick.x + counts.x * (brick.y + counts.y * brick.z);
}

fn bit_of(cell: vec3<u32>) -> u32 {
    let at = cell % 4u;
    return at.x + 4u * at.y + 16u * at.z;
}

// The brick of a cell, given the one that was read last.
fn brick_at(cell: vec3<i32>, last: Brick) -> Brick {
    let number = brick_of(vec3<u32>(cell));
    if number == last.number {
        return last;
    }
    return Brick(number, bricks[number]);
}

fn is_empty(brick: Brick) -> bool {
    return (brick.words.x | brick.words.y) == 0u;
}

fn is_listed(brick: Brick, cell: vec3<i32>) -> bool {
    let bit = bit_of(vec3<u32>(cell));
    return ((select(brick.words.x, brick.words.y, bit >= 32u) >> (bit % 32u)) & 1u) == 1u;
}

// The bits of a brick.
fn words_of(brick: u32) -> vec2<u32> {
    let counts = brick_counts();
    let first = 4u * vec3(brick % counts.x, brick / counts.x % counts.y, brick / (counts.x * counts.y));
    let end = min(first + 4u, vec3(cells.x, cells.y, cells.z));
    var words = vec2(0u);
    for (var z = first.z; z < end.z; z += 1u) {
        for (var y = first.y; y < end.y; y += 1u) {
            let row = number(vec3(first.x, y, z)) - first.x;
            var start = offsets[row + first.x];
            for (var x = first.x; x < end.x; x += 1u) {
                let next = offsets[row + x + 1u];
                let bit = bit_of(vec3(x, y, z));
                words[bit / 32u] |= u32(start < next) << (bit % 32u);
                start = next;
            }
        }
    }
    return words;
}

// The last cell of the brick on each axis, in the direction of the ray.
fn last_of_brick(cell: vec3<i32>, up: vec3<i32>) -> vec3<i32> {
    let first = cell & vec3(-4);
    let end = min(first + 3, vec3<i32>(vec3(cells.x, cells.y, cells.z)) - 1);
    return select(first, end, up == vec3(1));
}

// The neighbour of an empty brick that the ray enters next, given its last cell and when that is
// left.
fn past_brick(way: Way, cell: vec3<i32>, last: vec3<i32>, exit: vec3<f32>) -> vec3<i32> {
    let time = soonest(exit);
    let start = starts();
    let x = settled(cell.x, last.x, start.x, way.step.x, way.up.x, way.origin.x, way.inverse.x, time);
    let y = settled(cell.y, last.y, start.y, way.step.y, way.up.y, way.origin.y, way.inverse.y, time);
    let z = settled(cell.z, last.z, start.z, way.step.z, way.up.z, way.origin.z, way.inverse.z, time);
    if exit.x <= min(exit.y, exit.z) {
        return vec3(last.x + way.step.x, y, z);
    }
    if exit.y <= exit.z {
        return vec3(x, last.y + way.step.y, z);
    }
    return vec3(x, y, last.z + way.step.z);
}

// The cell of an axis at a time, between a cell and the last one of its brick: at most three
// on, in steps of two and one.
fn settled(cell: i32, last: i32, start: u32, step: i32, up: i32, origin: f32, inverse: f32, time: f32) -> i32 {
    var at = cell;
    if (last - at) * step >= 2 && crossing(at + step + up, start, origin, inverse) <= time {
        at += 2 * step;
    }
    if (last - at) * step >= 1 && crossing(at + up, start, origin, inverse) <= time {
        at += step;
    }
    return at;
}
