//! Arguments → library → printed diagnostics → exit code.
fn main() {}
