//! A folder of pictures with ever more bars.

use std::fs;
use std::path::Path;

use crate::pictures::bars;

/// Writes a picture of each of these numbers of bars into a new folder, as `1.png` and so on.
pub(crate) fn folder(folder: &Path, counts: impl IntoIterator<Item = u32>) {
    fs::create_dir(folder).expect("its parent is ours");
    for count in counts {
        bars(&folder.join(format!("{count}.png")), count);
    }
}
