#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# deimos_numerics 0.21.2 (Rust): a joint that is to turn by 10 rad at no more than 1 rad/s stops at 1 rad, for good.
#
# A proportional controller of 1/s, with AntiWindup::Clamp to ±1 rad/s, commands the speed of a joint. Expected: full
# speed up to 9 rad, then ever slower to 10 rad; without an integral gain there is nothing to wind up. What happens: in
# the first step the integral is moved to 1 - 10 = -9, so that the output is at its limit, and with no gain it stays
# there. The joint brakes at once and rests at 1 rad, 9 rad from its goal, at an output of 0 and without an error. With
# AntiWindup::BackCalculation it rests at 3.29 rad. With an integral gain of 0.1 it comes within 0.1 rad of its goal
# only after 41 s; the proportional part alone would need 11 s. AntiWindup::None, with the output limited outside, is
# right.
# For us: take AntiWindup::None and with_integrator_limits(), and limit the output yourself.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "limit"
version = "0.1.0"
edition = "2021"
[dependencies]
deimos_numerics = { version = "=0.21.2", default-features = false }
TOML
cat > src/main.rs <<'RUST'
use deimos_numerics::embedded::fixed::lti::{AntiWindup, Pid};

const GOAL: f64 = 10.0;

/// The angles of the joint in rad, every 0.01 s over 100 s.
fn turned(integral: f64, limit: AntiWindup<f64>) -> Vec<f64> {
    let controller = Pid::<f64, 1>::new(1.0, integral, 0.0, 0.01, None, limit).unwrap();
    let mut state = controller.reset_state();
    let mut angle = 0.0;
    (0..10_000)
        .map(|_| {
            let speed = (GOAL - angle + state.integrator[0]).clamp(-1.0, 1.0);
            controller.step_with_tracking(&mut state, [GOAL], [angle], [speed]).unwrap();
            angle += 0.01 * speed;
            angle
        })
        .collect()
}

fn main() {
    let clamp = AntiWindup::Clamp { low: -1.0, high: 1.0 };
    let rest = [AntiWindup::None, clamp, AntiWindup::BackCalculation { gain: 1.0 }]
        .map(|limit| (turned(0.0, limit)[9_999] * 100.0).round() / 100.0);
    println!("without an integral gain it rests at {:?} rad: no limit, clamp, back-calculation", rest);
    assert_eq!(rest, [10.0, 1.0, 3.29]);

    let late = turned(0.1, clamp).iter().position(|angle| GOAL - angle < 0.1).unwrap() as f64 * 0.01;
    println!("with an integral gain of 0.1 it is 0.1 rad from its goal after {late} s");
    assert!(late > 40.0);
}
RUST
timeout 280 cargo run --quiet
