#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rotary-encoder-embedded 0.5.0 (Rust): a shaft that trembles across one edge of its encoder is counted on and on.
#
# Expected: a decoder of an incremental encoder counts a shaft that trembles across one edge to and fro, so that it
# stays where it is. What happens in the standard mode, that of the README: a falling edge of one signal is a step if
# the other signal is low, but the rising edge there is none. 100 trembles of a quarter of a cycle are 100 steps in one
# direction. The quadrature table counts them right, but where the signals are not both low at first, its first reading
# is a step.
# For us: a joint that is held against a load trembles so; its position drifts in one direction without any lost edge.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "tremble"
version = "0.1.0"
edition = "2021"
[dependencies]
rotary-encoder-embedded = "=0.5.0"
TOML
cat > src/main.rs <<'RUST'
use rotary_encoder_embedded::quadrature::QuadratureTableMode;
use rotary_encoder_embedded::standard::StandardMode;
use rotary_encoder_embedded::Direction;

/// The signals of the encoder at this quarter of a cycle.
fn signals(quarter: i32) -> (bool, bool) {
    match quarter.rem_euclid(4) {
        0 => (false, false),
        1 => (true, false),
        2 => (true, true),
        _ => (false, true),
    }
}

fn count(mut update: impl FnMut(bool, bool) -> Direction, quarters: impl Iterator<Item = i32>) -> i32 {
    quarters
        .map(|quarter| {
            let (dt, clk) = signals(quarter);
            match update(dt, clk) {
                Direction::Clockwise => 1,
                Direction::Anticlockwise => -1,
                Direction::None => 0,
            }
        })
        .sum()
}

fn main() {
    let turn = || 0..=400;
    let tremble = || (0..=200).map(|sample| sample % 2);
    let mut standard = StandardMode::new();
    count(|dt, clk| standard.update(dt, clk), [0, 0, 0].into_iter());
    let turned = count(|dt, clk| standard.update(dt, clk), turn());
    let trembled = count(|dt, clk| standard.update(dt, clk), tremble());
    println!("standard: 100 cycles are {turned} steps, 100 trembles {trembled}");
    assert_eq!((turned.abs(), trembled.abs()), (100, 100));
    let mut table = QuadratureTableMode::new(1);
    let trembled = count(|dt, clk| table.update(dt, clk), tremble());
    let mut table = QuadratureTableMode::new(1);
    let still = count(|dt, clk| table.update(dt, clk), [1, 1, 1].into_iter());
    println!("table: 100 trembles are {trembled} steps, a shaft that stands {still}");
    assert_eq!((trembled, still), (0, 1));
}
RUST
timeout 280 cargo run --quiet
