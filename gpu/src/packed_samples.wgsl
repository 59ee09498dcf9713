// The kernels of packed.wgsl for pixels with several samples on the fragment path.
//#import drawn_samples for drawn
//#import packed
