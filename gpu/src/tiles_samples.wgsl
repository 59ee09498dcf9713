// The kernels of tiles.wgsl for pixels with several samples.
//#import covered_samples for covered
//#import shown_samples for shown
//#import network_samples for network
//#import tiles
