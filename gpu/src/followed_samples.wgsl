// The same where pixels have several samples: a turn of them. Imported where there are also `sampled`, and of
// nodes `face_of_node` and `layer_of_node`.
//#import followed

fn blend_list_samples(pixel: u32, head: u32) {
    var p = progress.pixels[pixel];
    if p.state == DONE {
        return;
    }
    enter_turn(pixel, p.run == 0u);
    if p.run == 0u {
        p = from_head(head);
    }
    for (var i = 0u; i < SAMPLED && p.left_size < listing.layers && p.left != EOL; i += 1u) {
        under_turn(pixel, key_of_node(p.left), face_of_node(p.left), layer_of_node(p.left));
        p.left = next_of(p.left);
        p.left_size += 1u;
    }
    let goes_on = p.left_size < listing.layers && p.left != EOL;
    leave_turn(pixel, !goes_on);
    if goes_on {
        atomicStore(&progress.unfinished, 1u);
    } else {
        p.state = DONE;
    }
    progress.pixels[pixel] = p;
}
