#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lowpassns 0.2.0 (Rust): a motor that is read once a second is filtered with 10 s instead of a time constant of 1 s.
#
# A motor's temperature, read once a second, jumps from 20 °C to 80 °C. Expected behind a low-pass with a time constant
# of 1 s: after 10 s, 80 °C but for 60 K · (1/2)^10 = 0.06 K, by the filter's own formula dt/(tau + dt), or less. What
# happens: 56.9 °C, 23 K too low: update() takes each time between two readings of more than 0.1 s as 0.1 s. The readme
# says that tiny times are clamped and that 100 Hz to 10 kHz are ideal, nothing of long times. At ten readings a second,
# 80 °C is reached to 0.004 K.
# For us: give the filter several updates with parts of at most 0.1 s, or compute the low-pass yourself.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "slow"
version = "0.1.0"
edition = "2021"
[dependencies]
lowpassns = "=0.2.0"
TOML
cat > src/main.rs <<'RUST'
use lowpassns::LowPass1;

/// The filtered temperature in °C after 10 s, with readings at this interval in s.
fn filtered(interval: f64) -> f64 {
    let mut filter = LowPass1::new(20.0, 1.0);
    let mut temperature = 20.0;
    for _ in 0..(10.0 / interval).round() as usize {
        temperature = filter.update(80.0, interval);
    }
    temperature
}

fn main() {
    let expected = |interval: f64| 80.0 - 60.0 * (1.0 / (1.0 + interval)).powf((10.0 / interval).round());
    for interval in [0.1, 1.0] {
        println!("every {interval} s: {:.2} °C, expected {:.2} °C", filtered(interval), expected(interval));
    }
    assert!((filtered(0.1) - expected(0.1)).abs() < 1e-9);
    assert!((filtered(1.0) - (80.0 - 60.0 / 1.1_f64.powi(10))).abs() < 1e-9 && filtered(1.0) < 57.0);
}
RUST
timeout 580 cargo run --quiet
