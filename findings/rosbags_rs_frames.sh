#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbags-rs 0.3.4 (Rust): a forearm at 90° is read as (0, 0.71, 0.71, -1) if the frame of its IMU is called "imu".
#
# In the CDR of ROS 2, each float64 begins at a multiple of 8 bytes behind the four bytes of the header. Expected of
# from_cdr(): the orientation that was written, whatever its frame is called. What happens: the orientation of an Imu
# is looked for 28 bytes behind the beginning, which is right for "imu_link" and each name of 4 to 11 letters. With
# "imu", a forearm that is turned by 90° about z, (0, 0, 0.71, 0.71), is read as (0, 0.71, 0.71, -1), which is no
# rotation. With "forearm_imu_link" it is (0, 0, -3e-162, -3e-162). A TransformStamped from "base" to "elbow" has
# 4.7e-62 m instead of 0.3 m, and no rotation, since its numbers are looked for right behind its names. No error is
# returned.
# For us: read bags with rosbags or with rosbag2 itself.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "read"
version = "0.1.0"
edition = "2021"
[dependencies]
rosbags-rs = { version = "=0.3.4", default-features = false }
TOML
cat > src/main.rs <<'RUST'
use rosbags_rs::cdr::CdrDeserializer;
use rosbags_rs::messages::{FromCdr, Imu, TransformStamped};

/// A little-endian CDR, whose numbers begin at a multiple of their size behind its header.
struct Cdr(Vec<u8>);

impl Cdr {
    fn align(&mut self, size: usize) {
        while (self.0.len() - 4) % size != 0 {
            self.0.push(0);
        }
    }

    fn header(frame: &str) -> Self {
        let mut cdr = Cdr(vec![0, 1, 0, 0]);
        cdr.0.extend(5i32.to_le_bytes());
        cdr.0.extend(0u32.to_le_bytes());
        cdr.text(frame);
        cdr
    }

    fn text(&mut self, text: &str) {
        self.align(4);
        self.0.extend((text.len() as u32 + 1).to_le_bytes());
        self.0.extend(text.bytes());
        self.0.push(0);
    }

    fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.align(8);
            self.0.extend(number.to_le_bytes());
        }
    }
}

/// Return the orientation of an Imu in this frame that is turned by 90 degrees about z.
fn orientation(frame: &str) -> [f64; 4] {
    let mut cdr = Cdr::header(frame);
    let half = 0.5f64.sqrt();
    cdr.numbers(&[0.0, 0.0, half, half, -1.0]);
    cdr.numbers(&[0.0; 32]);
    let read = Imu::from_cdr(&mut CdrDeserializer::new(&cdr.0).unwrap()).unwrap().orientation;
    [read.x, read.y, read.z, read.w]
}

fn main() {
    let half = 0.5f64.sqrt();
    let [right, short, long] = ["imu_link", "imu", "forearm_imu_link"].map(orientation);
    println!("imu_link: {right:?}\nimu: {short:?}\nforearm_imu_link: {long:?}");
    assert_eq!(right, [0.0, 0.0, half, half]);
    assert_eq!(short, [0.0, half, half, -1.0]);
    assert!(long[2] != half && long[3] != half);

    let mut cdr = Cdr::header("base");
    cdr.text("elbow");
    cdr.numbers(&[0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let read = TransformStamped::from_cdr(&mut CdrDeserializer::new(&cdr.0).unwrap()).unwrap();
    println!("{} to {}: {:?}", read.header.frame_id, read.child_frame_id, read.transform);
    assert!(read.transform.translation.x != 0.3 && read.transform.rotation.w != 1.0);
}
RUST
timeout 280 cargo run --quiet
