//! The one libtorch that `tch` speaks to, for each platform: wheels of the Python package index and
//! what of them is needed to build and run on the CPU.

use std::env::consts::{ARCH, OS};

use anyhow::{Context, Result};

/// Version of PyTorch; `tch` in the workspace's `Cargo.toml` decides it.
pub const VERSION: &str = "2.11.0";

/// What makes a libtorch on one platform.
#[derive(Debug)]
pub struct Pin<'a> {
    /// Operating system and processor, such as `linux x86_64`.
    pub platform: &'a str,
    /// Where the parts come from.
    pub wheels: &'a [Wheel<'a>],
    /// Space it takes while it is set up, in megabytes: pip keeps the largest wheel twice for a
    /// moment, and then wheels and unpacked files lie side by side.
    pub space_mb: u64,
}

/// One wheel, and what is taken from it.
#[derive(Debug)]
pub struct Wheel<'a> {
    /// What pip is asked for.
    pub requirement: &'a str,
    /// The platform that pip is asked for.
    pub tag: &'a str,
    /// Name of the file.
    pub file: &'a str,
    /// SHA-256 of the file, in lower-case hexadecimal digits.
    pub sha256: &'a str,
    /// Size of the file in bytes, for the progress shown.
    pub bytes: u64,
    /// `FROM=TO` takes what begins with `FROM` to where it begins with `TO`; `!FROM` leaves it out.
    pub rules: &'a [&'a str],
}

impl Pin<'_> {
    /// Identifies an unpacked libtorch made from this pin.
    pub fn stamp(&self) -> String {
        let mut stamp = format!("libtorch {VERSION} {}\n", self.platform);
        for Wheel { file, sha256, rules, .. } in self.wheels {
            stamp += &format!("{sha256} {file} {}\n", rules.join(" "));
        }
        stamp
    }
}

/// The pin for the machine this runs on.
///
/// # Errors
/// If there is none.
pub fn for_this_machine() -> Result<&'static Pin<'static>> {
    let platform = format!("{OS} {ARCH}");
    PINS.iter().find(|pin| pin.platform == platform).with_context(|| {
        format!(
            "libtorch {VERSION} can't be fetched for {platform}: set LIBTORCH to a libtorch \
             {VERSION} of your own, a folder with lib/ and include/"
        )
    })
}

/// Everything but what serves Python and the GPU. `libtorch.so` itself stays: it is linked by name.
const TORCH: &[&str] = &[
    "torch/include/=include/",
    "torch/lib/=lib/",
    "!torch/lib/libc10_cuda",
    "!torch/lib/libcaffe2_nvrtc",
    "!torch/lib/libshm",
    "!torch/lib/libtorch_cuda",
    "!torch/lib/libtorch_nvshmem",
    "!torch/lib/libtorch_python",
];

// On Linux even the CPU's library is linked to these two.
const CUDART: &[&str] = &["nvidia/cu13/lib/libcudart.so.13=lib/libcudart.so.13"];
const CUPTI: &[&str] = &["nvidia/cu13/lib/libcupti.so.13=lib/libcupti.so.13"];

/// Every platform that is served. The versions beside torch are those its own metadata asks for
/// (through `cuda-toolkit` 13.0.2).
pub static PINS: [Pin<'static>; 3] = [
    Pin {
        platform: "linux x86_64",
        wheels: &[
            Wheel {
                requirement: "nvidia-cuda-runtime==13.0.96",
                tag: "manylinux_2_17_x86_64",
                file: "nvidia_cuda_runtime-13.0.96-py3-none-manylinux2014_x86_64.manylinux_2_17_x86_64.whl",
                sha256: "7f82250d7782aa23b6cfe765ecc7db554bd3c2870c43f3d1821f1d18aebf0548",
                bytes: 2_243_632,
                rules: CUDART,
            },
            Wheel {
                requirement: "nvidia-cuda-cupti==13.0.85",
                tag: "manylinux_2_25_x86_64",
                file: "nvidia_cuda_cupti-13.0.85-py3-none-manylinux_2_25_x86_64.whl",
                sha256: "4eb01c08e859bf924d222250d2e8f8b8ff6d3db4721288cf35d14252a4d933c8",
                bytes: 10_715_597,
                rules: CUPTI,
            },
            Wheel {
                requirement: "torch==2.11.0",
                tag: "manylinux_2_28_x86_64",
                file: "torch-2.11.0-cp312-cp312-manylinux_2_28_x86_64.whl",
                sha256: "0f68f4ac6d95d12e896c3b7a912b5871619542ec54d3649cf48cc1edd4dd2756",
                bytes: 530_712_279,
                rules: TORCH,
            },
        ],
        space_mb: 1_150,
    },
    Pin {
        platform: "linux aarch64",
        wheels: &[
            Wheel {
                requirement: "nvidia-cuda-runtime==13.0.96",
                tag: "manylinux_2_17_aarch64",
                file: "nvidia_cuda_runtime-13.0.96-py3-none-manylinux2014_aarch64.manylinux_2_17_aarch64.whl",
                sha256: "ef9bcbe90493a2b9d810e43d249adb3d02e98dd30200d86607d8d02687c43f55",
                bytes: 2_261_060,
                rules: CUDART,
            },
            Wheel {
                requirement: "nvidia-cuda-cupti==13.0.85",
                tag: "manylinux_2_25_aarch64",
                file: "nvidia_cuda_cupti-13.0.85-py3-none-manylinux_2_25_aarch64.whl",
                sha256: "796bd679890ee55fb14a94629b698b6db54bcfd833d391d5e94017dd9d7d3151",
                bytes: 10_310_827,
                rules: CUPTI,
            },
            Wheel {
                requirement: "torch==2.11.0",
                tag: "manylinux_2_28_aarch64",
                file: "torch-2.11.0-cp312-cp312-manylinux_2_28_aarch64.whl",
                sha256: "f99924682ef0aa6a4ab3b1b76f40dc6e273fca09f367d15a524266db100a723f",
                bytes: 419_731_115,
                rules: TORCH,
            },
        ],
        space_mb: 900,
    },
    Pin {
        platform: "macos aarch64",
        wheels: &[Wheel {
            requirement: "torch==2.11.0",
            tag: "macosx_11_0_arm64",
            file: "torch-2.11.0-cp312-cp312-macosx_11_0_arm64.whl",
            sha256: "4b5866312ee6e52ea625cd211dcb97d6a2cdc1131a5f15cc0d87eec948f6dd34",
            bytes: 80_606_338,
            rules: TORCH,
        }],
        space_mb: 400,
    },
];
