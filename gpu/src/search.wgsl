// What a ray meets on its way through the cells.
//#import march
//#import bricks
//#import meet
//#import first
//#import word
//#import runs

const EOL: u32 = 0xffffffffu;

@group(0) @binding(11) var<storage, read> rays: array<Ray>;

@group(0) @binding(12) var<storage, read_write> hits: array<Hit>;

fn packed(cell: vec3<i32>) -> u32 {
    let c = vec3<u32>(cell);
    return c.x | (c.y << 10u) | (c.z << 20u);
}

fn unpacked(word: u32) -> vec3<i32> {
    return vec3<i32>(vec3(word, word >> 10u, word >> 20u) & vec3(1023u));
}

// A ray's search from where it stands, for at most STEPS steps: to the next cell, over an empty
// brick, or to the next triangle.
//
// Rays of a subgroup wait for each other, so that each does one thing until it comes to the other:
// going on to a cell with a list, then through the list. What f32 leaves open about a triangle,
// which is rare and long, is settled outside of both.
fn traced(ray: Ray, given: Hit) -> Hit {
    var hit = given;
    if hit.state == TRACED {
        return hit;
    }
    let way = way(ray);
    var cell = unpacked(hit.state);
    // The end of the list where the ray is; 0 if it is empty, or not known yet.
    var end = 0u;
    if hit.state == FRESH {
        hit = Hit(NOTHING, NEVER, TRACED, EOL);
        cell = entrance(ray, way);
        if !inside(cell) {
            return hit;
        }
    } else if hit.at != EOL {
        end = offsets[number(vec3<u32>(cell)) + 1u];
    }
    hit.state = TRACED;
    var march = March(cell, exits(way, cell));
    var seen = Brick(EOL, vec2(0u));
    var steps = 0u;
    while steps < STEPS {
        while hit.at >= end && steps < STEPS {
            steps += 1u;
            if hit.at != EOL {
                if ends(ray, hit, surely(soonest(march.exit))) {
                    return hit;
                }
                march = stepped(way, march);
                if !inside(march.cell) {
                    return hit;
                }
                hit.at = EOL;
            }
            seen = brick_at(march.cell, seen);
            if is_empty(seen) {
                march.cell = over_brick(ray, hit, way, march.cell);
                if !inside(march.cell) {
                    return hit;
                }
                march.exit = exits(way, march.cell);
            } else if is_listed(seen, march.cell) {
                let at = number(vec3<u32>(march.cell));
                hit.at = offsets[at];
                end = offsets[at + 1u];
            } else {
                hit.at = 0u;
                end = 0u;
            }
        }
        if hit.at >= end {
            break;
        }
        let looked = looked_through(ray, hit.at, min(end, hit.at + STEPS - steps));
        steps += looked.at - hit.at;
        hit.at = looked.at;
        if looked.meeting.verdict == MET {
            hit = nearer(ray, hit, looked.meeting.time, looked.prim);
            if cells.any == 1u {
                return hit;
            }
        }
    }
    hit.at = select(hit.at, EOL, end == 0u);
    hit.state = packed(march.cell);
    atomicOr(&unfinished, 1u);
    return hit;
}

// Past an empty brick; outside of the grid if the search ends in it.
fn over_brick(ray: Ray, hit: Hit, way: Way, cell: vec3<i32>) -> vec3<i32> {
    let last = last_of_brick(cell, way.up);
    let exit = exits(way, last);
    if ends(ray, hit, surely(soonest(exit))) {
        return vec3(-1);
    }
    return past_brick(way, cell, last, exit);
}

// How far a list was looked through.
struct Looked {
    // Where the rest of it begins.
    at: u32,
    // The last triangle, and how it is met.
    prim: u32,
    meeting: Meeting,
}

// A list of at least one, up to the first triangle that is met.
fn looked_through(ray: Ray, start: u32, end: u32) -> Looked {
    var looked = Looked(start, 0u, Meeting(MISSED, 0.0));
    // Read while the one before is looked at.
    var ahead = listed[start];
    while looked.at < end && looked.meeting.verdict == MISSED {
        looked.at += 1u;
        looked.prim = ahead;
        ahead = listed[min(looked.at, end - 1u)];
        looked.meeting = glance(ray, looked.prim);
    }
    if looked.meeting.verdict == OPEN {
        looked.meeting = meets(ray, looked.prim);
    }
    return looked;
}

// Whether nothing after a cell's exit can change the answer.
fn ends(ray: Ray, hit: Hit, exit: f32) -> bool {
    return hit.time < exit || (ray.segment == 1u && exit > 1.0);
}
