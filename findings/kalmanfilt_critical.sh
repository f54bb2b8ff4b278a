#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kalmanfilt 0.3.0 (Rust): the critically damped filter of a joint's angle, speed and acceleration rings and is slower.
#
# critical_damping_parameters_order_three(θ) gives the three gains of a GHKFilter whose three poles are all at θ. What
# happens: its second gain, h, is two thirds of the right one, because a 3 in the formula has the value 2. At θ = 0.9
# the poles are at 0.783 and 0.965·exp(±0.059i). Where a joint starts to turn at 1 count a sample, the speed goes up
# to 1.36 instead of 1.24, and is within 1 % after 116 samples instead of 82. The function of order two is right.
# For us: multiply h by 1.5.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "critical"
version = "0.1.0"
edition = "2021"
[dependencies]
kalmanfilt = "=0.3.0"
TOML
cat > src/main.rs <<'RUST'
use kalmanfilt::gh::{critical_damping_parameters_order_three, critical_damping_parameters_order_two, GHFilter, GHKFilter};

const THETA: f64 = 0.9;

/// How far a filter with the given gains is from one whose poles are all at THETA: the largest of |(A - THETA)³|, where
/// A takes the errors of one sample to those of the next.
fn distance(g: f64, h: f64, k: f64) -> f64 {
    let columns: Vec<[f64; 3]> = (0..3)
        .map(|column| {
            let start = |row: usize| if row == column { 1.0 } else { 0.0 };
            let mut filter = GHKFilter::new(start(0), start(1), start(2), g, h, k, 1.0);
            filter.update(0.0);
            [filter.xt, filter.dxt, filter.ddxt]
        })
        .collect();
    let mut shifted = [[0.0; 3]; 3];
    for row in 0..3 {
        for column in 0..3 {
            shifted[row][column] = columns[column][row] - if row == column { THETA } else { 0.0 };
        }
    }
    let times = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        let mut product = [[0.0; 3]; 3];
        for row in 0..3 {
            for column in 0..3 {
                product[row][column] = (0..3).map(|inner| a[row][inner] * b[inner][column]).sum();
            }
        }
        product
    };
    let cube = times(times(shifted, shifted), shifted);
    cube.iter().flatten().fold(0.0, |greatest: f64, value| greatest.max(value.abs()))
}

/// The greatest speed, and the last sample at which it is not within 1 % of that of a joint, which starts to turn at
/// 1 count a sample.
fn started(g: f64, h: f64, k: f64) -> (f64, usize) {
    let mut filter = GHKFilter::new(0.0, 0.0, 0.0, g, h, k, 1.0);
    let (mut greatest, mut last): (f64, usize) = (0.0, 0);
    for sample in 0..2000 {
        filter.update(sample as f64);
        greatest = greatest.max(filter.dxt);
        if sample > 0 && (filter.dxt - 1.0).abs() > 0.01 {
            last = sample;
        }
    }
    (greatest, last)
}

fn main() {
    let (g, h, k) = critical_damping_parameters_order_three(THETA);
    let (given, right) = (started(g, h, k), started(g, 1.5 * h, k));
    println!("h {h}: greatest speed {} until {}, with 1.5 h {} until {}", given.0, given.1, right.0, right.1);
    println!("distance from three equal poles {} with 1.5 h {}", distance(g, h, k), distance(g, 1.5 * h, k));
    assert!(distance(g, 1.5 * h, k) < 1e-9 && distance(g, h, k) > 1e-3);
    assert!((given.0 - 1.356).abs() < 1e-3 && given.1 == 116 && (right.0 - 1.238).abs() < 1e-3 && right.1 == 82);
    let (g, h) = critical_damping_parameters_order_two(THETA);
    let mut filter = GHFilter::new(1.0, 0.0, g, h, 1.0);
    filter.update(0.0); // the trace of the matrix of errors is twice the pole, its determinant the square
    let first = (filter.xt, filter.dxt);
    let mut filter = GHFilter::new(0.0, 1.0, g, h, 1.0);
    filter.update(0.0);
    assert!((first.0 + filter.dxt - 2.0 * THETA).abs() < 1e-9);
    assert!((first.0 * filter.dxt - first.1 * filter.xt - THETA * THETA).abs() < 1e-9);
}
RUST
timeout 280 cargo run --quiet
