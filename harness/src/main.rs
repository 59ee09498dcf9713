//! The command `triptych`.

use std::process::ExitCode;

fn main() -> ExitCode {
    triptych_harness::native::enter();
    triptych_harness::cli::main()
}
