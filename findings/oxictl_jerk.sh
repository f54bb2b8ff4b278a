#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oxictl 0.1.1 (Rust): a move of limited jerk to 2 rad overshoots to 2.79 rad and jumps back to 2 rad within one step.
#
# JerkLimitedProfile plans within 30 rad/s³, 10 rad/s² and 5 rad/s, and "handles short distances". Expected of a move by
# 2 rad: that it ends at 2 rad with a speed of 0. What happens: the peak speed for a short distance is taken as the root
# of jerk times distance over 4, without the limit of the acceleration, which is too much; the move goes on to 2.79 rad,
# and at its last step the position is set to its goal, 0.79 rad back. With 1000 rad/s³ a move by 1 rad goes to 2.55
# rad. A move by 10 rad is right.
# For us: look at the last step of a planned move before it is sent to a motor, which cannot follow such a step.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "jerk"
version = "0.1.0"
edition = "2021"
[dependencies]
oxictl = { version = "=0.1.1", features = ["trajectory"] }
TOML
cat > src/main.rs <<'RUST'
use oxictl::trajectory::jerk_limited::JerkLimitedProfile;

/// The greatest position of a move, and the step that it makes at its end.
fn moved(jerk: f64, goal: f64) -> (f64, f64) {
    let mut profile = JerkLimitedProfile::<f64>::new(jerk, 10.0, 5.0);
    profile.plan(goal);
    let (mut positions, mut time) = (vec![0.0], 0.0);
    while !profile.is_done() {
        positions.push(profile.update(0.0001).0);
        time += 0.0001;
    }
    let greatest = positions.iter().cloned().fold(0.0, f64::max);
    let last = positions[positions.len() - 1] - positions[positions.len() - 2];
    println!("{jerk} rad/s³ to {goal} rad: up to {greatest:.3} rad, last step {last:.4} rad after {time:.2} s");
    (greatest, last)
}

fn main() {
    let near = |found: (f64, f64), greatest: f64, last: f64| (found.0 - greatest).abs() < 0.01 && (found.1 - last).abs() < 0.01;
    assert!(near(moved(30.0, 2.0), 2.789, -0.789));
    assert!(near(moved(30.0, 0.5), 0.983, -0.483));
    assert!(near(moved(1000.0, 1.0), 2.55, -1.55));
    assert!(near(moved(30.0, 10.0), 10.0, 0.0));
}
RUST
timeout 280 cargo run --quiet
