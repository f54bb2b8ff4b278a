#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# signalo_filters 0.6.1 (Rust): of two bad readings in a row, its Hampel filter takes the second one as sound.
#
# A joint that trembles by 1 mrad around 1.001 rad is read at 1.050 rad twice in a row. The documentation says that a
# reading is replaced by the median if it is more than `threshold` standard deviations away from it, estimated by the
# median absolute deviation of the window. Before each of the two readings, seven readings have a median of 1.001 rad
# and a median absolute deviation of at most 1 mrad, so that 3 · 1.4826 · 1 mrad = 4.4 mrad are allowed. Expected: both
# are replaced. What happens: the second one passes, as the deviation is taken from min() and max() of a Median, and
# max(), documented as the greatest value in the buffer, is the newest one: 1.000 rad where a value is 1.002 rad.
# For us: do not use max() of Median, and take a window and its median absolute deviation yourself.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "hampel"
version = "0.1.0"
edition = "2021"
[dependencies]
signalo_filters = "=0.6.1"
TOML
cat > src/main.rs <<'RUST'
use signalo_filters::hampel::{Config, Hampel};
use signalo_filters::median::Median;
use signalo_filters::traits::{Filter, WithConfig};

/// The median of the values, and the median of their distances from it.
fn deviation(values: &[f64]) -> (f64, f64) {
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let median = middle(values.to_vec());
    (median, middle(values.iter().map(|value| (value - median).abs()).collect()))
}

fn main() {
    let mut readings: Vec<f64> = (0..20).map(|sample| [1.0, 1.001, 1.002, 1.001][sample % 4]).collect();
    readings[14] = 1.05;
    readings[15] = 1.05;
    let mut hampel: Hampel<f64, 7> = Hampel::with_config(Config { threshold: 3.0 });
    let mut window: Median<f64, 7> = Median::default();
    for sample in 0..readings.len() {
        let filtered = hampel.filter(readings[sample]);
        if sample == 14 || sample == 15 {
            let (median, spread) = deviation(&readings[sample - 7..sample]);
            let allowed = 3.0 * 1.4826 * spread;
            println!("{} rad becomes {filtered} rad, where {median} ± {allowed:.5} rad is allowed", readings[sample]);
            assert!((median - 1.001).abs() < 1e-9 && allowed < 0.0045);
            assert_eq!(filtered, if sample == 14 { 1.001 } else { 1.05 });
        }
        window.filter(readings[sample]);
        if sample == 12 {
            let greatest = readings[6..13].iter().copied().fold(f64::MIN, f64::max);
            println!("max() {:?} rad, the greatest value {greatest} rad", window.max());
            assert!(window.max() == Some(1.0) && greatest == 1.002);
        }
    }
}
RUST
timeout 580 cargo run --quiet
