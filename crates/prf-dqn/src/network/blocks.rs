//! The first convolution as one over blocks of pixels.
//!
//! A kernel of 8×8 pixels that moves by 4 is one of 2×2 blocks that moves by one, where a block of 4×4 pixels counts as one
//! place with 16 channels. These are the same products, only that processors are much faster at many channels than at one.

/// Side of a block, in pixels.
pub(super) const BLOCK: usize = 4;
/// Side of the kernel, in blocks.
pub(super) const KERNEL: usize = 2;
/// Pixels, and so channels, of a block.
pub(super) const CHANNELS: usize = BLOCK * BLOCK;

/// Blocks along a side of so many pixels; what is left over, no kernel reaches.
pub(super) fn along(side: i64) -> i64 {
    side / BLOCK as i64
}

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

/// Kernels of pixels, shape [n, 8, 8], as kernels of blocks, shape [n, 16, 2, 2].
pub(super) fn of_kernels(kernels: &mut [f32]) {
    reorder(kernels, |of_blocks, of_pixels, kernel, before| kernel[of_blocks] = before[of_pixels]);
}

/// What [`of_kernels`] does, undone.
pub(super) fn to_kernels(kernels: &mut [f32]) {
    reorder(kernels, |of_blocks, of_pixels, kernel, before| kernel[of_pixels] = before[of_blocks]);
}

fn reorder(kernels: &mut [f32], mut assign: impl FnMut(usize, usize, &mut [f32], &[f32])) {
    const SIDE: usize = KERNEL * BLOCK;
    for kernel in kernels.chunks_exact_mut(SIDE * SIDE) {
        let before = kernel.to_vec();
        for (y, x) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
            let channel = y % BLOCK * BLOCK + x % BLOCK;
            let of_blocks = (channel * KERNEL + y / BLOCK) * KERNEL + x / BLOCK;
            assign(of_blocks, y * SIDE + x, kernel, &before);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tch::Tensor;

    #[test]
    fn a_convolution_of_blocks_is_that_of_pixels() {
        // Neither side is a multiple of a block.
        let (count, height, width) = (3, 46, 39);
        let pictures: Vec<u8> = (0..count * height * width).map(|at| (at * 7919 % 251) as u8).collect();
        let mut kernels: Vec<f32> = (0..5 * 64).map(|at| (at * 31 % 17) as f32 - 8.0).collect();
        let shape = [count as i64, 1, height as i64, width as i64];
        let pixels = Tensor::from_slice(&pictures).view(shape).to_kind(tch::Kind::Float);
        let weight = Tensor::from_slice(&kernels).view([5, 1, 8, 8]);
        let expected = pixels.conv2d(&weight, None::<Tensor>, [4, 4], [0, 0], [1, 1], 1);

        let blocks = Tensor::from_slice(&of_pictures(&pictures, [height, width]));
        let blocks = blocks.view([count as i64, along(height as i64), along(width as i64), 16]).permute([0, 3, 1, 2]);
        let before = kernels.clone();
        of_kernels(&mut kernels);
        let weight = Tensor::from_slice(&kernels).view([5, 16, 2, 2]);
        let found = blocks.to_kind(tch::Kind::Float).conv2d(&weight, None::<Tensor>, [1, 1], [0, 0], [1, 1], 1);
        assert_eq!(found.size(), expected.size());
        // Whole numbers, whose sums are exact in any order.
        assert_eq!((found - expected).abs().max().double_value(&[]), 0.0);
        to_kernels(&mut kernels);
        assert_eq!(kernels, before);
    }
}
