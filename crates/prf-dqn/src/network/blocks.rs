//! The first convolution as one over blocks of pixels.
//!
//! A kernel of 8×8 pixels that moves by 4 is one of 2×2 blocks that moves by one, where a block of 4×4 pixels counts as one
//! place with 16 channels. These are the same products, only that processors are much faster at many channels than at one.

/// Side of a block, in pixels.
pub(super) const BLOCK: usize = 4;
/// Pixels, and so channels, of a block.
pub(super) const CHANNELS: usize = BLOCK * BLOCK;

/// The blocks of pictures of `[height, width]` pixels, row by row, each with its pixels row by row.
pub(super) fn of_pictures(pictures: &[u8], [height, width]: [usize; 2]) -> Vec<u8> {
    let (rows, columns) = (height / BLOCK, width / BLOCK);
    let count = pictures.len() / (height * width);
    let mut blocks = vec![0; count * rows * columns * CHANNELS];
    let row_len = columns * CHANNELS;
    for (picture, blocks) in pictures.chunks_exact(height * width).zip(blocks.chunks_exact_mut(rows * row_len)) {
        for (y, pixels) in picture.chunks_exact(width).take(rows * BLOCK).enumerate() {
            let row = &mut blocks[y / BLOCK * row_len..][..row_len];
            for (block, pixels) in row.chunks_exact_mut(CHANNELS).zip(pixels.chunks_exact(BLOCK)) {
                block[y % BLOCK * BLOCK..][..BLOCK].copy_from_slice(pixels);
            }
        }
    }
    blocks
}

/// Where the weight of the pixel at (y, x) of a kernel of `side` pixels lies in the kernel of blocks: block by block, each with its
/// pixels row by row.
pub(super) fn place(side: usize, [y, x]: [usize; 2]) -> usize {
    (y / BLOCK * (side / BLOCK) + x / BLOCK) * CHANNELS + y % BLOCK * BLOCK + x % BLOCK
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_row_by_row_and_what_is_left_over_is_left_out() {
        // Two pictures of 9×10 pixels that say where they are.
        let pictures: Vec<u8> = (0..180).collect();
        let blocks = of_pictures(&pictures, [9, 10]);
        assert_eq!(blocks.len(), 2 * 4 * CHANNELS);
        assert_eq!(blocks[..16], [0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33]);
        // The second picture, the second row of blocks, the second block in it.
        let corner = 90 + 4 * 10 + 4;
        assert_eq!(blocks[(4 + 3) * 16..][..6], [0, 1, 2, 3, 10, 11].map(|pixel| corner + pixel));
        assert_eq!([[0, 0], [0, 3], [1, 0], [0, 4], [4, 0], [7, 7]].map(|at| place(8, at)), [0, 3, 4, 16, 32, 63]);
    }
}
