#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# feetech-servo-sdk 0.3.0 (Rust): an effort of 0 turns the servo to -180°, and writing the position that was read moves
# it.
#
# By the README a RawEffort drives the servo by PWM, past its position loop. Expected: RawEffort(0) asks for no torque.
# What happens: it is written as goal position 0, the end at -180°. Positions are read in steps of 1/4095 turn, but
# written in steps of 1/4096: a servo at 3584 counts is read at 2.3575 rad, and this goal is sent as 3585. The middle,
# 2048, is 0.0008 rad. A stream answers here as a servo does.
# For us: read_raw_position() gives counts; one count of an STS3215 is 2 π / 4096.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "effort"
version = "0.1.0"
edition = "2021"
[dependencies]
feetech-servo-sdk = { version = "=0.3.0", default-features = false }
tokio = { version = "1", features = ["io-util", "macros", "rt", "time"] }
TOML
cat > src/main.rs <<'RUST'
use feetech_servo_sdk::{ControlOp, FeetechController, MotorBus};
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};

async fn servo(mut line: DuplexStream, registers: Arc<Mutex<[u8; 256]>>) {
    let mut head = [0; 4];
    while line.read_exact(&mut head).await.is_ok() {
        let mut body = vec![0; head[3] as usize];
        line.read_exact(&mut body).await.unwrap();
        let address = body[1] as usize;
        let mut answer = vec![head[2], 2, 0];
        if body[0] == 2 {
            let length = body[2] as usize;
            answer[1] += body[2];
            answer.extend(&registers.lock().unwrap()[address..address + length]);
        } else {
            let data = &body[2..body.len() - 1];
            registers.lock().unwrap()[address..address + data.len()].copy_from_slice(data);
        }
        answer.push(!answer.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte)));
        line.write_all(&[[0xFF, 0xFF].as_slice(), &answer].concat()).await.unwrap();
    }
}

#[tokio::main(flavor = "current_thread")]
async fn main() {
    let (host, device) = tokio::io::duplex(256);
    let registers = Arc::new(Mutex::new([0u8; 256]));
    tokio::spawn(servo(device, registers.clone()));
    let mut bus = FeetechController::with_timeout(host, std::time::Duration::from_secs(5));
    let goal = || i16::from_le_bytes(registers.lock().unwrap()[42..44].try_into().unwrap());
    for (counts, radians, written) in [(2048i16, 0.00077, 2049), (3584, 2.35754, 3585)] {
        registers.lock().unwrap()[56..58].copy_from_slice(&counts.to_le_bytes());
        let read = bus.read_position(1).await.unwrap();
        bus.write_goal(1, ControlOp::Position(read)).await.unwrap();
        println!("at {counts} counts: {read:.5} rad, as a goal {}", goal());
        assert!((read - radians).abs() < 1e-4 && goal() == written);
    }
    assert!(bus.write_goal(1, ControlOp::Velocity(0.0)).await.is_err());
    bus.write_goal(1, ControlOp::RawEffort(0)).await.unwrap();
    println!("an effort of 0: the goal is at {} counts", goal());
    assert_eq!(goal(), 0);
}
RUST
timeout 280 cargo run --quiet
