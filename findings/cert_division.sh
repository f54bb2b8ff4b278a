#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cert 0.1.4 (Rust): a gear ratio of 100 rad / 20 rad, each with 1 %, is found as 5 ± 8000 instead of 5 ± 0.07.
#
# The rotor of a gear turns by 100 ± 1 rad, its output by 20 ± 0.2 rad. Expected of their ratio: 5 ± 0.0707, as the
# relative uncertainties of a ratio add as squares. What happens:
# 1. With AbsUncertainty 5 ± 8000, as the square of the denominator is multiplied where it should divide.
# 2. With RelUncertainty, whose uncertainty is a fraction of the mean, the formulas are those of absolute uncertainties:
#    the ratio is 5 ± 2000, the product 2000 ± 2040 instead of 2000 ± 28.3, the sum 120 ± 1.70 instead of 120 ± 1.02.
# 3. The cube of 20 ± 0.2 is 8000 ± 226 instead of 8000 ± 240, and its inverse 0.05 ± 0.00035 instead of 0.05 ± 0.0005,
#    as powi() takes 2^n where n^2 is right; for n = 2 they are equal.
# The sum and the product with AbsUncertainty are right.
# Output: absolute, ratio: 5.0000 ± 8000.00000, right is 0.07071
#         absolute, product: 2000.0000 ± 28.28427, right is 28.28427
#         absolute, sum: 120.0000 ± 1.01980, right is 1.01980
#         absolute, cube: 8000.0000 ± 226.27417, right is 240.00000
#         absolute, inverse: 0.0500 ± 0.00035, right is 0.00050
#         relative, ratio: 5.0000 ± 2000.00000, right is 0.07071
#         relative, product: 2000.0000 ± 2039.60781, right is 28.28427
#         relative, sum: 120.0000 ± 1.69706, right is 1.01980
# For us: take AbsUncertainty, for sums and products alone, and work out the uncertainty of a ratio by hand.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "ratio"
version = "0.1.0"
edition = "2021"
[dependencies]
cert = "=0.1.4"
TOML
cat > src/main.rs <<'RUST'
use cert::{AbsUncertainty, RelUncertainty, Uncertainty};

fn expect<U: Uncertainty<Float = f64>>(name: &str, found: U, mean: f64, deviation: f64, right: f64) {
    let (m, d) = (found.mean(), found.standard_deviation());
    println!("{name}: {m:.4} ± {d:.5}, right is {right:.5}");
    assert!((m / mean - 1.0).abs() < 1e-9 && (d / deviation - 1.0).abs() < 1e-3);
}

fn main() {
    let (rotor, output) = (AbsUncertainty::new(100.0, 1.0), AbsUncertainty::new(20.0, 0.2));
    expect("absolute, ratio", rotor / output, 5.0, 8000.0, 5.0 * 2f64.sqrt() / 100.0);
    expect("absolute, product", rotor * output, 2000.0, 28.284, 20.0 * 2f64.sqrt());
    expect("absolute, sum", rotor + output, 120.0, 1.0198, 1.04f64.sqrt());
    expect("absolute, cube", output.powi(3), 8000.0, 226.274, 240.0);
    expect("absolute, inverse", output.powi(-1), 0.05, 0.000353553, 0.0005);
    let (rotor, output): (RelUncertainty<f64>, RelUncertainty<f64>) = (rotor.into(), output.into());
    expect("relative, ratio", rotor / output, 5.0, 2000.0, 5.0 * 2f64.sqrt() / 100.0);
    expect("relative, product", rotor * output, 2000.0, 2039.6, 20.0 * 2f64.sqrt());
    expect("relative, sum", rotor + output, 120.0, 1.69706, 1.04f64.sqrt());
}
RUST
timeout 170 cargo run --quiet
