#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# syact 0.15.0 (Rust): behind a gear whose output turns the other way, no angle lies between the stops of the output.
#
# Expected of Gear::new(motor, -0.05), whose ratio is "velocity_b / velocity_m" and negative where the output turns
# against the motor: with set_pos_limits(-2 rad, 1 rad) the output may go from -2 to 1 rad, as with a ratio of 0.05.
# What happens: the limits are divided by the ratio but not exchanged, and the motor gets 40 rad as its least and
# -20 rad as its greatest position. At each angle resolve_pos_limits_for_abs_pos() tells that a stop has been passed, at
# 0 rad by 2 rad in the direction of the greatest angle, and at -3 rad by 4 rad instead of 1. The gear itself gives back
# the limits that were set. In the same way, a speed limit of 1 rad/s is -20 rad/s at the motor, and a friction of 2 N·m
# at the output is -0.1 N·m there, so that the motor has 0.6 N·m left of 0.5 N·m instead of 0.4.
# The motor is the DemoActuator of the crate.
# For us: give the ratio without its sign, and turn the signs of angles and speeds yourself.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "reversing"
version = "0.1.0"
edition = "2021"
[dependencies]
syact = { version = "=0.15.0", features = ["testing"] }
syunit = "=0.4.0"
TOML
cat > src/main.rs <<'RUST'
use syact::data::ActuatorVars;
use syact::prelude::*;
use syact::AdvancedActuator;
use syunit::metric::NewtonMeters;

const ANGLES: [f32; 4] = [-3.0, 0.0, 0.5, 1.5];

/// By how much each angle is beyond a stop, the limits of the motor, and the torque that friction leaves of 0.5 N·m.
fn behind(ratio: f32) -> ([f32; 4], [f32; 3], f32) {
    let mut gear = Gear::new(DemoActuator::new(), ratio);
    gear.set_pos_limits(Some(PositionRad(-2.0)), Some(PositionRad(1.0)));
    gear.set_velocity_max(Some(RadPerSecond(1.0))).unwrap();
    gear.apply_gen_force(NewtonMeters(2.0)).unwrap();
    assert_eq!((gear.limit_min(), gear.limit_max()), (Some(PositionRad(-2.0)), Some(PositionRad(1.0))));
    let beyond = ANGLES.map(|angle| gear.resolve_pos_limits_for_abs_pos(PositionRad(angle)).0);
    let motor = &gear.actuator;
    let limits = [motor.limit_min().unwrap().0, motor.limit_max().unwrap().0, motor.velocity_max().unwrap().0];
    let load = ActuatorVars::<Rotary> { force_load_gen: motor.force_gen(), ..Default::default() };
    let left = load.force_after_load(NewtonMeters(0.5), Direction::CW).unwrap().0;
    println!("ratio {ratio}: {ANGLES:?} rad are beyond a stop by {beyond:?} rad");
    println!("    the motor goes from {} to {} rad at {} rad/s and has {left} N·m", limits[0], limits[1], limits[2]);
    (beyond, limits, left)
}

fn near(found: &[f32], expected: &[f32]) -> bool {
    found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4)
}

fn main() {
    let (beyond, limits, left) = behind(0.05);
    assert!(near(&beyond, &[-1.0, 0.0, 0.0, 0.5]) && near(&limits, &[-40.0, 20.0, 20.0]) && near(&[left], &[0.4]));
    let (beyond, limits, left) = behind(-0.05);
    assert!(near(&beyond, &[-4.0, 2.0, 2.5, 3.5]) && near(&limits, &[40.0, -20.0, -20.0]) && near(&[left], &[0.6]));
}
RUST
timeout 280 cargo run --quiet
