#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot_behavior 0.8.1 (Rust): a joint that shall move 3 rad at 1 rad/s jumps by 3 rad and goes to 20.7 rad.
#
# joint_trapezoid, joint_s_curve and joint_simple_4th_curve plan a move within a speed and an acceleration, t_curve one
# distance. Expected: positions that rise from 0 to 3 rad, by at most 1 mrad in each ms. What happens: where the
# acceleration ends, the position of joint_trapezoid jumps by the whole move, then it rises at 7 rad/s instead of 1, and
# before the deceleration it jumps back from 20.7 to 2.75 rad. A move of 0.1 rad, which never reaches the speed, jumps
# back to -0.15 rad in its middle. t_curve is right for long moves, but takes a speed that is too great by the square
# root of 2 for short ones, so that a distance of 0.4 rad jumps back by 0.1 rad. joint_s_curve exceeds the speed where
# it is reached before the acceleration: with 10 rad/s² and 20 rad/s³ it goes at 3.6 rad/s.
# For us: plan with joint_simple_4th_curve, which is right, and look at a planned move before it is sent to a drive.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder. RUSTC_BOOTSTRAP lets a stable
# compiler build this crate, which is written for a nightly one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "trapezoid"
version = "0.1.0"
edition = "2024"
[dependencies]
robot_behavior = "=0.8.1"
TOML
cat > src/main.rs <<'RUST'
use robot_behavior::utils::path_generate::{joint_s_curve, joint_simple_4th_curve, joint_trapezoid, t_curve};
use std::time::Duration;

const SPEED: f64 = 1.0;
const ACCELERATION: f64 = 2.0;

/// The least and the greatest position of a move, and the greatest step of one ms, in mrad.
fn span(name: &str, goal: f64, last: f64, position: impl Fn(Duration) -> f64) -> [i64; 3] {
    let positions: Vec<f64> = (0..=(last * 1000.0) as u64).map(|ms| position(Duration::from_millis(ms))).collect();
    let least = positions.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let step = positions.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    println!("{name} of {goal} rad: from {least:.3} to {greatest:.3} rad, at most {step:.4} rad in one ms");
    [least, greatest, step].map(|value| (value * 1000.0).round() as i64)
}

fn trapezoid(goal: f64) -> [i64; 3] {
    let (position, time) = joint_trapezoid(&[0.0], &[goal], &[SPEED], &[ACCELERATION]);
    span("joint_trapezoid", goal, time.as_secs_f64(), |t| position(t)[0])
}

fn curve(goal: f64) -> [i64; 3] {
    let (time, position) = t_curve(goal, SPEED, ACCELERATION);
    span("t_curve", goal, time, |t| position(t))
}

fn s_curve(goal: f64, acceleration: f64) -> [i64; 3] {
    let (position, time) = joint_s_curve(&[0.0], &[goal], &[SPEED], &[acceleration], &[20.0]);
    span("joint_s_curve", goal, time.as_secs_f64(), |t| position(t)[0])
}

fn fourth(goal: f64) -> [i64; 3] {
    let (position, time) = joint_simple_4th_curve(&[0.0], &[goal], &[SPEED], &[ACCELERATION]);
    span("joint_simple_4th_curve", goal, time.as_secs_f64(), |t| position(t)[0])
}

fn main() {
    assert_eq!([trapezoid(3.0), trapezoid(0.1)], [[0, 20743, 17993], [-149, 100, 159]]);
    assert_eq!([curve(3.0), curve(0.4)], [[0, 3000, 1], [0, 400, 99]]);
    assert_eq!([s_curve(3.0, ACCELERATION), s_curve(3.0, 10.0)], [[0, 3000, 1], [0, 3000, 4]]);
    assert_eq!([fourth(3.0), fourth(0.1)], [[0, 3000, 1], [0, 100, 0]]);
}
RUST
RUSTC_BOOTSTRAP=1 timeout 560 cargo run --quiet
