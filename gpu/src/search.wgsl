// What a ray meets on its way through the cells.
//#import march
//#import bricks
//#import meet
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
fn traced(ray: Ray, given: Hit) -> Hit {
    var hit = given;
    if hit.state == TRACED {
        return hit;
    }
    let way = way(ray);
    var cell = unpacked(hit.state);
    if hit.state == FRESH {
        hit = Hit(NOTHING, NEVER, TRACED, EOL);
        cell = entrance(ray, way);
    }
    var march = March(cell, exits(way, max(cell, vec3(0))));
    var steps = 0u;
    while inside(march.cell) && steps < STEPS {
        steps += 1u;
        if hit.at == EOL && brick_is_empty(march.cell) {
            let last = last_of_brick(march.cell, way.up);
            let exit = soonest(exits(way, last));
            if ends(ray, hit, exit) {
                march.cell = vec3(-1);
                break;
            }
            march.cell = past_brick(way, march.cell);
            if inside(march.cell) {
                march.exit = exits(way, march.cell);
            }
            continue;
        }
        let at = number(vec3<u32>(march.cell));
        let end = offsets[at + 1u];
        if hit.at == EOL {
            hit.at = offsets[at];
        }
        while hit.at < end && steps < STEPS {
            steps += 1u;
            let prim = prims[hit.at];
            let meeting = meets(ray, prim);
            hit.at += 1u;
            if meeting.met && nearer(meeting.time, prim, hit) {
                hit.prim = prim;
                hit.time = meeting.time;
                if cells.any == 1u {
                    hit.state = TRACED;
                    return hit;
                }
            }
        }
        if hit.at < end {
            break;
        }
        if ends(ray, hit, soonest(march.exit)) {
            march.cell = vec3(-1);
            break;
        }
        hit.at = EOL;
        march = stepped(way, march);
    }
    if !inside(march.cell) {
        hit.state = TRACED;
        return hit;
    }
    hit.state = packed(march.cell);
    atomicOr(&unfinished, 1u);
    return hit;
}

// Whether nothing after a cell's exit can change the answer.
fn ends(ray: Ray, hit: Hit, exit: f32) -> bool {
    return hit.time < exit || (ray.segment == 1u && exit > 1.0);
}

fn nearer(time: f32, prim: u32, hit: Hit) -> bool {
    return time < hit.time || (time == hit.time && prim < hit.prim);
}
