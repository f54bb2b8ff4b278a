#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dbc-codegen 0.4.0 (Rust): a position of 1.5 rad in floating point is 1069547520 rad, and an angle that is held creeps.
#
# The code is generated from a .dbc with a position that SIG_VALTYPE_ makes a float of 32 bits, and an angle of 32 bits
# in steps of 0.0001 rad. Expected of position(): 1.5 rad. What happens: the bits of the float are taken as a whole
# number, as SIG_VALTYPE_ has no effect. Expected of angle() at 200000001 steps: 20000.0001 rad. What happens: 20000,
# as it is an f32 of 24 bits. Expected of set_angle() with what angle() gave: the same steps. What happens: for 69449 of
# the first million angles it is one step less, as the quotient is cut off instead of rounded: a joint that is held by
# sending its own position goes back by 0.1 mrad at such an angle.
# For us: use the raw values (angle_raw_val() and set_angle_raw_val()), and scale and round yourself in 64 bits.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder, which may take minutes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "axis"
version = "0.1.0"
edition = "2021"
[dependencies]
bitvec = "=1.0.1"
embedded-can = "=0.4.1"
[build-dependencies]
dbc-codegen = "=0.4.0"
TOML
cat > axis.dbc <<'DBC'
VERSION ""

NS_ :

BS_:

BU_: Drive Master

BO_ 385 Axis: 8 Drive
 SG_ Position : 0|32@1- (1,0) [-1000000|1000000] "rad" Master

BO_ 386 Shaft: 8 Drive
 SG_ Angle : 0|32@1- (0.0001,0) [-214748|214748] "rad" Master

SIG_VALTYPE_ 385 Position : 1;
DBC
cat > build.rs <<'RUST'
use dbc_codegen::Config;

fn main() {
    let dbc = std::fs::read_to_string("axis.dbc").unwrap();
    let code = Config::builder().dbc_name("axis.dbc").dbc_content(&dbc).build().generate().unwrap();
    let path = std::path::Path::new(&std::env::var("OUT_DIR").unwrap()).join("messages.rs");
    std::fs::write(path, code).unwrap();
}
RUST
cat > src/main.rs <<'RUST'
#[allow(dead_code, clippy::all)]
mod messages {
    include!(concat!(env!("OUT_DIR"), "/messages.rs"));
}
use messages::{Axis, Shaft};

fn main() {
    let mut bytes = [0; 8];
    bytes[..4].copy_from_slice(&1.5f32.to_le_bytes());
    let position = Axis::try_from(&bytes[..]).unwrap().position();
    println!("1.5 rad in floating point: {position} rad");

    bytes[..4].copy_from_slice(&200_000_001i32.to_le_bytes());
    let angle = Shaft::try_from(&bytes[..]).unwrap().angle();
    println!("20000.0001 rad in steps of 0.0001 rad: {angle} rad");

    let mut shaft = Shaft::new(0.0).unwrap();
    let mut moved = Vec::new();
    for steps in 0..1_000_000 {
        shaft.set_angle_raw_val(steps);
        let angle = shaft.angle();
        shaft.set_angle(angle).unwrap();
        if shaft.angle_raw_val() != steps {
            moved.push((steps, shaft.angle_raw_val()));
        }
    }
    println!("{} of 1000000 angles are moved by sending what was read, as {:?}", moved.len(), moved[0]);
    assert_eq!((position, angle, moved.len()), (1_069_547_520, 20_000.0, 69_449));
    assert!(moved.iter().all(|(before, after)| *after == before - 1));
}
RUST
timeout 500 cargo run --quiet
