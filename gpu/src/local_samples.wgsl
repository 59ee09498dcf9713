// The kernels of local.wgsl for pixels with several samples.
//#import covered_samples for covered
//#import shown_samples for shown
//#import local
