//! What a mesh cycle takes of memory, before any of it is computed.

use std::path::Path;

use fe_contact::statics::{MOST_BYTES, cycle_bytes};
use scene::Scene;

use crate::error::{Result, unfit};

/// Refuses a mesh cycle whose contact cells would take more than [`MOST_BYTES`], unless that is asked for (`--large`);
/// `dial`: the argument or key that sets how many positions of the cycle are kept.
pub(crate) fn within_memory(
    path: &Path,
    scene: &Scene,
    (dial, positions): (&str, usize),
    is_large: bool,
) -> Result<()> {
    let bytes = cycle_bytes(scene, positions);
    if is_large || bytes <= MOST_BYTES {
        return Ok(());
    }
    let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
    let cells = scene.fe_contact.contact_cells;
    let fitting = MOST_BYTES / cycle_bytes(scene, 1).max(1);
    let fewer = f64::from(cells) * (MOST_BYTES as f64 / bytes as f64).sqrt();
    Err(unfit(
        path,
        format!(
            "{dial} = {positions} with `fe_contact.contact_cells` = {cells}: by estimate these contact cells take {:.1} GiB of memory, \
             and time in proportion; up to {:.0} GiB are taken, which are {fitting} positions or {} cells, and more with --large",
            gib(bytes),
            gib(MOST_BYTES),
            fewer.floor()
        ),
    ))
}
