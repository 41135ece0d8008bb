//! Which branches are looked for beside the first one.

use serde::{Deserialize, Serialize};

/// Which branches are looked for beside the one through the motion found from rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Search {
    /// Those that leave it at its period doublings and branch points.
    pub switch: bool,
}
