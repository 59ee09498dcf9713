// Lists of nodes in order, blended node by node. Imported where there is `listing`, and of nodes
// `next_of`, `key_of_node` and `colour_of_node`.
//#import relink

// Pixels that are not done yet ask for another dispatch.
struct Work {
    unfinished: atomic<u32>,
    pixels: array<Progress>,
}

@group(0) @binding(11) var<storage, read_write> progress: Work;

// A list from its head on: no layer has been shown. `left_size` says how many have.
fn from_head(head: u32) -> Progress {
    return Progress(EOL, EOL, head, EOL, 0u, 0u, 1u, FIND);
}

// As stage resolve, of listing.layers layers at most. `head` is read where nothing has been shown yet.
fn blend_list(pixel: u32, head: u32) {
    var p = progress.pixels[pixel];
    if p.state == DONE {
        return;
    }
    var seen = picture[pixel];
    if p.run == 0u {
        p = from_head(head);
        seen = vec4(0.0, 0.0, 0.0, 1.0);
    }
    let end = opaque_key[pixel];
    var i = 0u;
    while i < STEPS && p.left_size < listing.layers && p.left != EOL && key_of_node(p.left) < end {
        seen = under(seen, colour_of_node(p.left));
        p.left = next_of(p.left);
        p.left_size += 1u;
        i += 1u;
    }
    if i == STEPS {
        atomicStore(&progress.unfinished, 1u);
    } else {
        seen = vec4(seen.rgb + seen.a * behind(pixel), 1.0);
        p.state = DONE;
    }
    picture[pixel] = seen;
    progress.pixels[pixel] = p;
}
