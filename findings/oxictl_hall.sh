#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oxictl 0.1.1 (Rust): where a motor turns back, its angle rises within each sector, and its Hall sensors are never at
# fault.
#
# HallSensor interpolates the electrical angle between two edges. Expected of a motor that turns back at 20 rad/s: an
# angle that falls from the upper to the lower edge of each sector. What happens: it is counted up from the lower edge
# with the speed's absolute value, and jumps down by two sectors at the next edge: up to 1.05 rad away, where forward it
# is right within 0.01 rad. Expected of is_fault() where all three sensors are on, as with a broken cable: true. What
# happens: such a state is not stored, so that it is false for any input; and a motor whose last edge was an hour ago
# keeps its speed of 20 rad/s.
# For us: leave out a velocity that a driver takes from it; interpolate by the sign of the speed.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "hall"
version = "0.1.0"
edition = "2021"
[dependencies]
oxictl = { version = "=0.1.1", features = ["motor"] }
TOML
cat > src/main.rs <<'RUST'
use oxictl::motor::encoder::hall::HallSensor;
use std::f64::consts::{FRAC_PI_3, TAU};

/// The states of the three sensors in the order of the sectors, as documented.
const STATES: [u8; 6] = [5, 1, 3, 2, 6, 4];

/// A sensor after four turns, and its greatest difference from the angle in the last two.
fn turned(speed: f64) -> (HallSensor<f64>, f64) {
    let mut sensor = HallSensor::<f64>::new(1, 1.0);
    let turns = (4.0 * TAU / speed.abs() / 0.0001) as i32;
    let mut worst: f64 = 0.0;
    for sample in 0..turns {
        let angle = (speed * 0.0001 * f64::from(sample)).rem_euclid(TAU);
        sensor.update(STATES[(angle / FRAC_PI_3) as usize % 6], 0.0001);
        if sample > turns / 2 {
            let difference = sensor.theta_e() - angle;
            worst = worst.max((difference - TAU * (difference / TAU).round()).abs());
        }
    }
    println!("{speed} rad/s: speed {:.2} rad/s, angle up to {worst:.3} rad away", sensor.omega_e());
    (sensor, worst)
}

fn main() {
    let (_, forward) = turned(20.0);
    let (mut sensor, back) = turned(-20.0);
    assert!(forward < 0.01 && back > 1.03 && back < 1.06);
    for _ in 0..36_000 {
        sensor.update(7, 0.1);
    }
    println!("an hour after all sensors went on: fault {}, speed {:.2} rad/s", sensor.is_fault(), sensor.omega_e());
    assert!(!sensor.is_fault() && (sensor.omega_e() + 20.0).abs() < 0.04);
    let state = sensor.hall;
    for _ in 0..36_000 {
        sensor.update(state, 0.1);
    }
    println!("an hour at standstill: speed {:.2} rad/s", sensor.omega_e());
    assert!((sensor.omega_e() + 20.0).abs() < 0.04);
}
RUST
timeout 280 cargo run --quiet
