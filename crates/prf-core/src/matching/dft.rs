//! Fourier transforms of 2 to 5 numbers, written out.

/// Real and imaginary part.
pub(super) type Complex = [f32; 2];

#[inline(always)]
fn plus(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
fn minus(a: Complex, b: Complex) -> Complex {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
pub(super) fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[inline(always)]
fn scaled(a: Complex, factor: f32) -> Complex {
    [a[0] * factor, a[1] * factor]
}

/// A quarter turn clockwise: times −i.
#[inline(always)]
fn turned(a: Complex) -> Complex {
    [a[1], -a[0]]
}

#[inline(always)]
pub(super) fn dft2([a, b]: [Complex; 2]) -> [Complex; 2] {
    [plus(a, b), minus(a, b)]
}

#[inline(always)]
pub(super) fn dft3([a, b, c]: [Complex; 3]) -> [Complex; 3] {
    const SIN_60: f32 = 0.866_025_4;
    let sum = plus(b, c);
    let middle = minus(a, scaled(sum, 0.5));
    let side = turned(scaled(minus(b, c), SIN_60));
    [plus(a, sum), plus(middle, side), minus(middle, side)]
}

#[inline(always)]
pub(super) fn dft4([a, b, c, d]: [Complex; 4]) -> [Complex; 4] {
    let (even, odd) = (dft2([a, c]), dft2([b, d]));
    let side = turned(odd[1]);
    [plus(even[0], odd[0]), plus(even[1], side), minus(even[0], odd[0]), minus(even[1], side)]
}

#[inline(always)]
pub(super) fn dft5([a, b, c, d, e]: [Complex; 5]) -> [Complex; 5] {
    const COS: [f32; 2] = [0.309_017, -0.809_017];
    const SIN: [f32; 2] = [0.951_056_54, 0.587_785_24];
    let (outer, inner) = (dft2([b, e]), dft2([c, d]));
    let middle = |near, far| plus(a, plus(scaled(outer[0], near), scaled(inner[0], far)));
    let (first, second) = (middle(COS[0], COS[1]), middle(COS[1], COS[0]));
    let side = turned(plus(scaled(outer[1], SIN[0]), scaled(inner[1], SIN[1])));
    let other = turned(minus(scaled(outer[1], SIN[1]), scaled(inner[1], SIN[0])));
    [
        plus(a, plus(outer[0], inner[0])),
        plus(first, side),
        plus(second, other),
        minus(second, other),
        minus(first, side),
    ]
}
