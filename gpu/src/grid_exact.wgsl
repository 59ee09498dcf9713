// Rays through a grid whose nearest triangles are the spec's: first_exact.wgsl decides where f32
// cannot. Rays that others start from what these meet are then the same on every leg.
//#import first_exact for first
//#import grid
