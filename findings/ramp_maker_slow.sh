#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ramp-maker 0.2.0 (Rust): a stepper that may make no more than 10 steps a second makes 44.7.
#
# Expected, and said by its documentation: the velocity is always equal to or less than the greatest one. What
# happens: a delay is never longer than that of the first step, 1 / sqrt(2 a), so that each greatest velocity below
# sqrt(2 a) is passed: with an acceleration of 1000 steps/s² 44.7 steps/s instead of 10, with 100 000 steps/s² 447
# steps/s. From 44.7 steps/s on the limit is kept.
# For us: a slow move for homing or commissioning needs an acceleration below v² / 2, or Flat instead of Trapezoidal.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
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
ramp-maker = { version = "=0.2.0", features = ["std"] }
TOML
cat > src/main.rs <<'RUST'
use ramp_maker::{Flat, MotionProfile, Trapezoidal};

fn greatest(profile: &mut impl MotionProfile<Velocity = f32, Delay = f32>, limit: f32) -> f32 {
    profile.enter_position_mode(limit, 100);
    let mut delays = Vec::new();
    while let Some(delay) = profile.next_delay() {
        delays.push(delay);
    }
    assert_eq!(delays.len(), 100);
    1.0 / delays.iter().copied().fold(f32::INFINITY, f32::min)
}

fn main() {
    let cases = [(1e3, 10.0, 44.72), (1e5, 10.0, 447.2), (1e3, 50.0, 50.0), (40.0, 10.0, 10.0)];
    for (acceleration, limit, expected) in cases {
        let speed = greatest(&mut Trapezoidal::<f32>::new(acceleration), limit);
        println!("acceleration {acceleration}, limit {limit}: {speed} steps/s");
        assert!((speed / expected - 1.0).abs() < 1e-3);
    }
    assert!((greatest(&mut Flat::<f32>::new(), 10.0) - 10.0).abs() < 1e-3);
}
RUST
timeout 280 cargo run --quiet
