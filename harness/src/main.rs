//! The command `triptych`.

fn main() {}
