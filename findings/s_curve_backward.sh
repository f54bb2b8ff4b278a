#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# s_curve 0.1.7 (Rust): a short move back that begins in motion jumps by 2.2 rad, where the same move forward is right.
#
# A joint that turns at 1 rad/s moves from 0 to 2 rad, within 30 rad/s³, 10 rad/s² and 5 rad/s. Expected of the move
# from 2 rad to 0 that begins at -1 rad/s: the mirror image. What happens: where the greatest speed is not reached, the
# times are calculated with the sign of the initial speed, but for a move forward. The move lasts 1.43 s instead of 1.16
# s, its position jumps by 2.20 rad within one step, and it goes up to 5.33 rad/s. is_trajectory_feasible() is true. A
# move of 10 rad is right in both directions.
# For us: plan a move back as the mirror image of a move forward, with a positive initial speed, and negate its values.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "backward"
version = "0.1.0"
edition = "2021"
[dependencies]
s_curve = "=0.1.7"
TOML
cat > src/main.rs <<'RUST'
use s_curve::{s_curve_generator, Derivative, SCurveConstraints, SCurveInput, SCurveStartConditions};

/// The duration, the greatest jump of the position and the greatest speed of a move.
fn planned(q0: f64, q1: f64, v0: f64) -> (f64, f64, f64) {
    let input = SCurveInput {
        constraints: SCurveConstraints { max_jerk: 30.0, max_acceleration: 10.0, max_velocity: 5.0 },
        start_conditions: SCurveStartConditions { q0, q1, v0, v1: 0.0 },
    };
    assert!(input.is_trajectory_feasible());
    let (plan, position) = s_curve_generator(&input, Derivative::Position);
    let (_, velocity) = s_curve_generator(&input, Derivative::Velocity);
    let duration = plan.time_intervals.total_duration();
    let time = |step: i32| duration * f64::from(step) / 10_000.0;
    let jump = (0..10_000).map(|step| (position(time(step + 1)) - position(time(step))).abs()).fold(0.0, f64::max);
    let speed = (0..10_000).map(|step| velocity(time(step)).abs()).fold(0.0, f64::max);
    println!("{q0} to {q1} rad from {v0} rad/s: {duration:.3} s, jump {jump:.4} rad, greatest speed {speed:.2} rad/s");
    (duration, jump, speed)
}

fn main() {
    let (forward, back) = (planned(0.0, 2.0, 1.0), planned(2.0, 0.0, -1.0));
    let (long_forward, long_back) = (planned(0.0, 10.0, 1.0), planned(10.0, 0.0, -1.0));
    assert!(forward.1 < 0.001 && forward.2 < 5.0 && (forward.0 - 1.162).abs() < 0.001);
    assert!((back.1 - 2.2).abs() < 0.01 && (back.2 - 5.33).abs() < 0.01 && (back.0 - 1.433).abs() < 0.001);
    assert!((long_forward.0 - long_back.0).abs() < 1e-9 && long_back.1 < 0.002);
}
RUST
timeout 280 cargo run --quiet
