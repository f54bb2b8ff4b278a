#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# advanced-pid 0.2.3 (Rust): the velocity form drives a joint away from its goal when the first error is not 0.
#
# VelPid is a PID in velocity form: its output sums up the changes of the terms, so that with the same gains it should
# come to the output of the position form Pid. What happens: the first update leaves out the derivative, because there
# is no earlier value, but it keeps its p_term, so that the second update sees it fall back from error / dt to 0. The
# output keeps an offset of -kd * first error / dt for good, which only the integral takes away. With kp 4, ki 0.5 and
# kd 0.05 at 1 ms an error held at 1 rad gives -45.9 after 0.1 s, where Pid gives 4.05. A motor at 0 that should go to
# 1 rad goes to -2.5 rad and is at -2.0 after 2 s, with the limits at 10; without kd it arrives. Nothing warns of it.
# For us: make the first update with the set point at the measured position, or keep kd at 0.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder. The motor is of the script.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "first_update"
version = "0.1.0"
edition = "2021"
[dependencies]
advanced-pid = "=0.2.3"
TOML
cat > src/main.rs <<'RUST'
use advanced_pid::{prelude::*, Pid, PidConfig, VelPid};

const DT: f32 = 0.001;

/// Output after 0.1 s with the error held at 1 rad.
fn held<C: PidController>(kd: f32) -> f32 {
    let mut controller = C::new(PidConfig::new(4.0, 0.5, kd));
    (0..101).map(|_| controller.update(1.0, 0.0, DT)).last().unwrap()
}

/// Positions of a motor with a time constant of 0.1 s that starts at 0 and should go to 1 rad; `settled` makes one
/// update before with the set point at the position.
fn motor<C: PidController>(kd: f32, settled: bool) -> (f32, f32) {
    let mut controller = C::new(PidConfig::new(4.0, 0.5, kd).with_limits(-10.0, 10.0));
    if settled {
        controller.update(0.0, 0.0, DT);
    }
    let (mut position, mut speed, mut lowest) = (0.0f32, 0.0f32, 0.0f32);
    for _ in 0..2000 {
        let output = controller.update(1.0, position, DT);
        speed += (output - speed) / 0.1 * DT;
        position += speed * DT;
        lowest = lowest.min(position);
    }
    (lowest, position)
}

fn main() {
    let (position_form, velocity_form) = (held::<Pid>(0.05), held::<VelPid>(0.05));
    println!("error of 1 rad held for 0.1 s: Pid {position_form:.2}, VelPid {velocity_form:.2}");
    assert!((position_form - 4.05).abs() < 0.01);
    assert!((velocity_form - (position_form - 0.05 * 1.0 / DT)).abs() < 0.05);
    assert!((held::<VelPid>(0.0) - held::<Pid>(0.0)).abs() < 0.01);

    let (_, by_position_form) = motor::<Pid>(0.05, false);
    let (lowest, by_velocity_form) = motor::<VelPid>(0.05, false);
    let (_, without_kd) = motor::<VelPid>(0.0, false);
    let (_, settled) = motor::<VelPid>(0.05, true);
    println!("motor to 1 rad after 2 s: Pid {by_position_form:.2}, VelPid {by_velocity_form:.2}, lowest {lowest:.2}");
    println!("VelPid without kd {without_kd:.2}, with one update at rest before {settled:.2}");
    assert!((by_position_form - 1.03).abs() < 0.02 && (without_kd - 1.0).abs() < 0.1);
    assert!(lowest < -2.4 && by_velocity_form < -1.9);
    assert!((settled - 1.03).abs() < 0.1);
}
RUST
cargo run --quiet
