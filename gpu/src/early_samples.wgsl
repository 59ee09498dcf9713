// The kernels of early.wgsl for pixels with several samples, all of which have one depth.
//#import drawn_samples for drawn
//#import early
