//! Norms as data (skeleton: written elsewhere at this moment).

/// A norm.
#[derive(Clone, Debug)]
pub struct Standard {}
