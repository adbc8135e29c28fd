//! What a convolution multiplies, as the rows of a matrix: one for each place that comes out, with all numbers in the kernel's
//! reach. With it, the gradient of the kernels is one product of matrices.

use tch::Tensor;

use super::shape::Convolution;
use crate::error::Result;

/// The rows of `pictures`, shape [count · height · width, channels].
pub(super) fn of_pictures(pictures: &Tensor, layer: &Convolution) -> Result<Tensor> {
    let Convolution { inputs, kernel, stride, from: [height, width], to: [down, across], .. } = *layer;
    let count = pictures.size()[0] as usize / (height * width);
    let row = width * inputs;
    let sizes = [count, down, across, kernel, kernel * inputs].map(|size| size as i64);
    let strides = [height * row, stride * row, stride * inputs, row, 1].map(|stride| stride as i64);
    let shape = [count * layer.places(), layer.reach()].map(|size| size as i64);
    Ok(pictures.f_contiguous()?.f_as_strided(sizes, strides, None)?.f_reshape(shape)?)
}
