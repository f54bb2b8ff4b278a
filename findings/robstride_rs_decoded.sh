#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robstride 0.3.6 (Rust): its command of 1 rad is read back as -79.5 rad, and its answer of a motor that runs as an
# overcurrent.
#
# It makes commands and answers into frames of CAN, and frames into commands and answers, as a recorder of the bus or a
# simulated motor needs it. Expected: what was made into a frame comes back, within the 16 bits of the frame. What
# happens: of 1 rad, 2 rad/s, 30 N·m/rad and 3 N·m to an RS03 there come -79.5 rad, -70 rad/s, 0.6 N·m/rad and -35 N·m,
# even without a frame between: the inverse of the scaling only adds an offset. Out of the frame, the angle in percent
# of the range is 35475. In answers, mode and faults are written to other bits than those that are read: a motor that
# runs without a fault is at overcurrent, and in reset. The frames of commands that are sent, and the answers of real
# motors, are right.
# For us: decode the frames of commands yourself, from big-endian words over the printed ranges.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "decoded"
version = "0.1.0"
edition = "2021"
[dependencies]
robstride = "=0.3.6"
TOML
cat > src/main.rs <<'RUST'
use robstride::robstride03::RobStride03Command;
use robstride::{Command, CommandData, FeedbackFrame, Frame, MotorMode, TypedCommandData};

fn main() {
    let sent = RobStride03Command {
        target_angle_rad: 1.0,
        target_velocity_rads: 2.0,
        kp: 30.0,
        kd: 1.0,
        torque_nm: 3.0,
    };
    let (id, data) = sent.to_control_command().to_can_packet(1);
    let word = u16::from_be_bytes([data[0], data[1]]);
    let angle = (f64::from(word) / 65535.0 * 2.0 - 1.0) * 4.0 * std::f64::consts::PI;
    println!("frame {id:#010x} {data:02x?}: {angle:.4} rad");
    assert!((angle - 1.0).abs() < 1e-3);

    let read = RobStride03Command::from_control_command(sent.to_control_command());
    let found = [read.target_angle_rad, read.target_velocity_rads, read.kp, read.kd, read.torque_nm];
    println!("read back {found:?}");
    assert!(found.iter().zip([-79.476, -70.0, 0.6, 1.0, -35.0]).all(|(read, wrong)| (read - wrong).abs() < 1e-3));
    let Ok(Frame::Control(percent)) = Command::from_can_packet(id, data).to_frame() else { panic!("no command") };
    println!("{percent:?}");
    assert_eq!(percent.target_angle, 35475.0);

    let answer = FeedbackFrame {
        angle: 10.0,
        velocity: 0.0,
        torque: 0.0,
        temperature: 30.0,
        fault_uncalibrated: false,
        fault_hall_encoding: false,
        fault_magnetic_encoding: false,
        fault_over_temperature: false,
        fault_overcurrent: false,
        fault_undervoltage: false,
        mode: MotorMode::Run,
        motor_id: 1,
    };
    let (id, data) = answer.to_can_packet(0xfd);
    let Ok(Frame::Feedback(found)) = Command::from_can_packet(id, data).to_frame() else { panic!("no answer") };
    println!("{found:?}");
    assert!((found.angle - 10.0).abs() < 1e-2 && found.motor_id == 1);
    assert!(found.fault_overcurrent && found.mode == MotorMode::Reset);
}
RUST
timeout 580 cargo run --quiet
