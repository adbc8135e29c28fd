//! Frames on which an innocent choice of cell and norm turns a reward's sign; see `tests/reference/make_flappy.py`.

use std::fs;
use std::path::Path;

/// Puts `goal.png`, `screen.png`, `frames.png` (400 of them) and `scores.csv` into a folder.
pub(crate) fn put_into(folder: &Path) {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/flappy");
    for name in ["goal.png", "screen.png", "frames.png", "scores.csv"] {
        fs::copy(golden.join(name), folder.join(name)).expect("the folder is ours");
    }
}
