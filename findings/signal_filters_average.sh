#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# signal-filters 0.1.16 (Rust): after a million counts, the average of readings of 0.1 is -23.5, and a median of five
# begins at 0.
#
# An axis moves at a million counts and more, and is then set to zero. Expected of MovingAverageFilterf32 of 8 readings,
# when 100 have been 0.1: 0.1. What happens: the sum is kept in single precision, in which each reading is added once
# and taken off later; what is rounded off at large values stays in it for good. reset() clears it. A shaft at 100 rad
# with a noise of 1 mrad is read 2.6 mrad away after an hour at 1 kHz. Expected of MedianFilter5f32 at a shaft that
# stands at 100 rad: 100. What happens: its first two values are 0, as its five readings begin as zeros;
# MedianFilter3f32 gives 100 from the first on.
# For us: give the filter angles within a turn, or call reset() at standstill; leave out the first two medians.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "average"
version = "0.1.0"
edition = "2021"
[dependencies]
signal-filters = "=0.1.16"
TOML
cat > src/main.rs <<'RUST'
use signal_filters::{MedianFilter3f32, MedianFilter5f32, MovingAverageFilterf32};

fn main() {
    let mut average = MovingAverageFilterf32::<8>::new();
    for reading in 0..1000 {
        average.update(1e6 + 0.37 * reading as f32);
    }
    let still = (0..100).map(|_| average.update(0.1)).last().unwrap();
    average.reset();
    let cleared = (0..100).map(|_| average.update(0.1)).last().unwrap();
    println!("average of 0.1 after a move: {still}, after a reset: {cleared}");
    assert!(still == -23.5 && (cleared - 0.1).abs() < 1e-6);

    let mut average = MovingAverageFilterf32::<4>::new();
    let (mut state, mut worst) = (1_u32, 0.0_f32);
    for reading in 0..3_600_000 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = (state >> 8) as f32 / 16_777_216.0 - 0.5;
        let value = average.update(100.0 + 0.001 * noise);
        if reading > 3_599_000 {
            worst = worst.max((value - 100.0).abs());
        }
    }
    println!("after an hour at 1 kHz with a noise of 1 mrad: {worst} rad away");
    assert!(worst > 0.002);

    let (mut five, mut three) = (MedianFilter5f32::new(), MedianFilter3f32::new());
    let medians: Vec<f32> = (0..4).map(|_| five.update(100.0)).collect();
    println!("first medians of five: {medians:?}, of three: {}", three.update(100.0));
    assert_eq!(medians, [0.0, 0.0, 100.0, 100.0]);
}
RUST
timeout 280 cargo run --quiet
