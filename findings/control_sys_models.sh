#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# control-sys 0.1.0 (Rust): an arm of 2000 kg·m² is not controllable, and an even turn has an acceleration.
#
# 1. An arm with an inertia of 2000 kg·m² and a damping of 1000 N·m·s/rad is turned by a torque in N·m. Expected of
#    `is_ss_controllable()`: true, as for the same arm with a torque in kN·m. What happens: false, since the rank of the
#    controllability matrix is that above an absolute tolerance of 1e-3.
# 2. A motor whose speed follows x' = -10 x + 10 u, and whose acceleration, -10 x + 10 u, is the output. Expected of a
#    step: 10 rad/s² at first, then 0, as the motor turns evenly. What happens: 0 at first, then -10 rad/s², since the
#    simulation leaves the matrix D out, which each model takes.
# 3. Expected of `from_continuous_ss_forward_euler()`, "using the forward Euler method": A = I + dt A. What happens:
#    inverse(I - dt A), the backward Euler method: an output of an elastic shaft without damping, at 20 rad/s, swings by
#    14 % of its first amplitude after 10 s in steps of 1 ms, where the forward method would make 739 % of it.
# Output: controllable: in N·m false, in kN·m true
#         acceleration: -0.00 at first, -10.00 at the end
#         A of the forward Euler method: 0.9615 instead of 1; swing after 10 s: 0.14
# For us: scale a model to numbers near 1, add D u to each output, and take an exact discretization for an elastic gear.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder (about a minute).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "models"
version = "0.1.0"
edition = "2021"
[dependencies]
control-sys = "=0.1.0"
nalgebra = "=0.33.2"
TOML
cat > src/main.rs <<'RUST'
use control_sys::analysis::is_ss_controllable;
use control_sys::model::{ContinuousStateSpaceModel, DiscreteStateSpaceModel, StateSpaceModel};
use control_sys::simulator::step_for_continuous_ss;
use nalgebra::dmatrix;

fn arm(gain: f64) -> ContinuousStateSpaceModel {
    ContinuousStateSpaceModel::from_matrices(
        &dmatrix![0.0, 1.0; 0.0, -0.5], &dmatrix![0.0; gain], &dmatrix![1.0, 0.0], &dmatrix![0.0])
}

fn main() {
    let (newton, kilonewton) = (is_ss_controllable(&arm(1.0 / 2000.0)).0, is_ss_controllable(&arm(0.5)).0);
    println!("controllable: in N·m {newton}, in kN·m {kilonewton}");

    let motor = ContinuousStateSpaceModel::from_matrices(
        &dmatrix![-10.0], &dmatrix![10.0], &dmatrix![-10.0], &dmatrix![10.0]);
    let (acceleration, _, _) = step_for_continuous_ss(&motor, 1e-3, 2.0);
    let (first, last) = (acceleration[(0, 0)], acceleration[(0, acceleration.ncols() - 1)]);
    println!("acceleration: {first:.2} at first, {last:.2} at the end");

    let shaft = ContinuousStateSpaceModel::from_matrices(
        &dmatrix![0.0, 1.0; -400.0, 0.0], &dmatrix![0.0; 400.0], &dmatrix![1.0, 0.0], &dmatrix![0.0]);
    let discrete = DiscreteStateSpaceModel::from_continuous_ss_forward_euler(&shaft, 0.01);
    let (angle, _, _) = step_for_continuous_ss(&shaft, 1e-3, 10.0);
    let swing = angle.columns(angle.ncols() - 400, 400).max() - 1.0;
    let entry = discrete.mat_a()[(0, 0)];
    println!("A of the forward Euler method: {entry:.4} instead of 1; swing after 10 s: {swing:.2}");

    assert!(!newton && kilonewton);
    assert!(first.abs() < 1e-9 && (last + 10.0).abs() < 1e-3);
    assert!((entry - 1.0 / 1.04).abs() < 1e-9 && (swing - 0.14).abs() < 0.03);
}
RUST
timeout 170 cargo run --quiet
