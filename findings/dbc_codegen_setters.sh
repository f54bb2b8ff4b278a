#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dbc-codegen 0.4.0 (Rust): a drive that is set to stop is sent forward, and the goal 2 after the goal 1 is sent as 3.
#
# In a .dbc the direction of a drive is -1, 0 or 1, as a raw value of 0, 1 or 2 with the offset -1, and VAL_ names the
# raw values Backward, Stop and Forward. A second message has a page, with a position on page 0 and a current on page 1.
# Expected of the code that is generated: what is set is what is read again, as VAL_ names raw values.
# What happens: a name is read from the raw value, but set as if its number were the physical one. Set to Backward, the
# frame says Stop, and set to Stop it says Forward; Forward is refused. And set_m0() joins the bits of the new page to
# those that are there, so that in a message that is used again the position 2 after 1 is 3, a page with the position 0
# leaves 3, and the current 8 on page 1 is 11.
# For us: set a named value by its raw value (set_direction_raw_val), and make a new message for each frame with pages.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "setters"
version = "0.1.0"
edition = "2021"
[dependencies]
bitvec = { version = "=1.0.1", default-features = false }
embedded-can = "=0.4.1"
[build-dependencies]
dbc-codegen = "=0.4.0"
[profile.dev]
debug = false
TOML
cat > drive.dbc <<'DBC'
VERSION ""

NS_ :

BS_:

BU_: Drive

BO_ 256 Goal: 8 Drive
 SG_ Direction : 0|8@1+ (1,-1) [-1|1] "" Drive

BO_ 257 Paged: 8 Drive
 SG_ Page M : 0|8@1+ (1,0) [0|1] "" Drive
 SG_ Position m0 : 8|32@1+ (1,0) [0|4294967295] "" Drive
 SG_ Current m1 : 8|16@1+ (1,0) [0|65535] "" Drive

VAL_ 256 Direction 0 "Backward" 1 "Stop" 2 "Forward" ;
DBC
cat > build.rs <<'RUST'
use dbc_codegen::{Config, FeatureConfig};

fn main() {
    let dbc = std::fs::read_to_string("drive.dbc").unwrap();
    let code = Config::builder().dbc_name("drive.dbc").dbc_content(&dbc).impl_debug(FeatureConfig::Always)
        .check_ranges(FeatureConfig::Always).build().generate().unwrap();
    let folder = std::env::var("OUT_DIR").unwrap();
    std::fs::write(format!("{folder}/messages.rs"), code).unwrap();
}
RUST
cat > src/main.rs <<'RUST'
#[allow(dead_code)]
mod messages {
    include!(concat!(env!("OUT_DIR"), "/messages.rs"));
}
use messages::{Goal, GoalDirection, Paged, PagedPageIndex, PagedPageM0, PagedPageM1};

fn main() {
    let sent = |direction| match Goal::new(direction) {
        Ok(goal) => format!("{} {:?}", goal.raw()[0], goal.direction()),
        Err(error) => format!("{error:?}").chars().take_while(|c| c.is_alphabetic()).collect(),
    };
    let read: Vec<_> = (0..3).map(|raw| {
        let goal = Goal::try_from(&[raw, 0, 0, 0, 0, 0, 0, 0][..]).unwrap();
        format!("{raw} {:?}", goal.direction())
    }).collect();
    let set = [sent(GoalDirection::Backward), sent(GoalDirection::Stop), sent(GoalDirection::Forward)];
    println!("read: {}; set to Backward, Stop and Forward: {}", read.join(", "), set.join(", "));

    let mut message = Paged::new(0).unwrap();
    let mut found = Vec::new();
    for position in [1, 2, 0] {
        let mut page = PagedPageM0::new();
        page.set_position(position).unwrap();
        message.set_m0(page).unwrap();
        if let PagedPageIndex::M0(page) = message.page_multiplexed().unwrap() {
            found.push(page.position());
        }
    }
    let mut page = PagedPageM1::new();
    page.set_current(8).unwrap();
    message.set_m1(page).unwrap();
    if let PagedPageIndex::M1(page) = message.page_multiplexed().unwrap() {
        found.push(page.current().into());
    }
    println!("the positions 1, 2 and 0 and the current 8: {found:?}");
    assert_eq!(read, ["0 Backward", "1 Stop", "2 Forward"]);
    assert_eq!(set, ["1 Stop", "2 Forward", "ParameterOutOfRange"]);
    assert_eq!(found, [1, 3, 3, 11]);
}
RUST
timeout 280 cargo run --quiet --ignore-rust-version
