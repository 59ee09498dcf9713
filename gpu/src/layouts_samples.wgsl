// The kernels of layouts.wgsl for pixels with several samples on the fragment path.
//#import drawn_samples for drawn
//#import layouts
