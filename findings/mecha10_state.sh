#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mecha10-drivers-motor 0.6.2 (Rust): a Dynamixel is read at 0 rad, 0 °C and without a fault, wherever it is, and a
# stepper that nothing is sent to is read at its goal.
#
# Expected of read_state(), which the documentation of the crate ("production-ready", "hardware error detection",
# "temperature and current monitoring") prints in its example: the position, temperature and faults of the servo. What
# happens: the servo is never asked, and each state is 0 in all fields but the time, also of a servo that is not there.
# Expected of the stepper driver: steps or G-code for the motor. What happens: its port is never opened, init() accepts
# one that does not exist, and the motor is said to have arrived. A move by ten turns that takes 358 s at 1 step/s² has
# arrived at once, with a speed of 0. A pseudo-terminal takes the place of the servo and records what it is sent.
# For us: an output that stays at 0 while its motor turns is such a driver; read the servo's registers yourself.
#
# Exit code 0: still so. Needs cargo and python3; installs the version into a temporary folder; building takes minutes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "state"
version = "0.1.0"
edition = "2021"
[dependencies]
mecha10-drivers-motor = "=0.6.2"
tokio = { version = "1", features = ["full"] }
[profile.dev]
debug = false
TOML
cat > src/main.rs <<'RUST'
use mecha10_drivers_motor::common::{ControlMode, MotorCommand, MotorDriver};
use mecha10_drivers_motor::dynamixel::{DynamixelConfig, DynamixelDriver};
use mecha10_drivers_motor::stepper::{StepperConfig, StepperDriver, StepperInterface, StepperMotorConfig};

fn goal(target: f64) -> MotorCommand {
    MotorCommand {
        motor_id: 1,
        mode: ControlMode::Position,
        target,
        velocity_limit: None,
        torque_limit: None,
        profile_velocity: None,
        profile_acceleration: Some(1.0),
    }
}

#[tokio::main]
async fn main() {
    let mut servo = DynamixelDriver::new(DynamixelConfig {
        port: std::env::args().nth(1).unwrap(),
        baud_rate: 1_000_000,
        motor_ids: vec![1],
        control_mode: ControlMode::Position,
        update_rate_hz: 100.0,
        calibration_file: None,
        position_pid: None,
        velocity_pid: None,
    });
    servo.init().await.unwrap();
    servo.enable(1).await.unwrap();
    servo.send_command(&goal(0.0)).await.unwrap();
    for motor in [1, 99] {
        let state = servo.read_state(motor).await.unwrap();
        println!(
            "Dynamixel {motor}: {} rad, {} °C, {} V, errors {}",
            state.position, state.temperature, state.voltage, state.error_flags
        );
        assert_eq!((state.position, state.temperature, state.voltage, state.error_flags), (0.0, 0.0, 0.0, 0));
    }
    let mut stepper = StepperDriver::new(StepperConfig {
        interface: StepperInterface::GRBL { port: "no such port".to_string(), baud_rate: 115_200 },
        motors: vec![StepperMotorConfig {
            motor_id: 1,
            steps_per_rev: 200,
            microsteps: 16,
            gear_ratio: 1.0,
            max_velocity: 1000.0,
            max_acceleration: 500.0,
            enable_active_high: false,
            invert_direction: false,
        }],
        update_rate_hz: 100.0,
        calibration_file: None,
    });
    stepper.init().await.unwrap();
    let turns = 20.0 * std::f64::consts::PI;
    stepper.send_command(&goal(turns)).await.unwrap();
    let state = stepper.read_state(1).await.unwrap();
    println!("stepper, sent to {turns:.2} rad: {:.2} rad at once, at {} rad/s", state.position, state.velocity);
    assert!((state.position - turns).abs() < 0.01 && state.velocity == 0.0);
}
RUST
cat > servo.py <<'PYTHON'
import os
import pty
import subprocess
import tty

READ, WRITE = 2, 3
servo, host = pty.openpty()
tty.setraw(servo)
subprocess.run(['target/debug/state', os.ttyname(host)], check=True, timeout=60)
# All that the driver has sent: the frames of protocol 2.0, each with its instruction after the length.
frames = os.read(servo, 4096).split(b'\xff\xff\xfd\x00')[1:]
written = [int.from_bytes(frame[4:6], 'little') for frame in frames]
print('instructions:', [frame[3] for frame in frames], 'of the registers', written)
assert {frame[3] for frame in frames} == {WRITE}
assert written == [64, 11, 64, 116]
PYTHON
timeout 1500 cargo build --quiet
python3 servo.py
