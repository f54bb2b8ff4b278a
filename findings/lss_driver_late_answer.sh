#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lss_driver 0.8.4 (Rust): once one servo has answered after 12 ms, each servo is read at the angle of the one before.
#
# Three Lynxmotion servos stand at 10°, 150° and -30°. Each answer begins with the number of its servo, as in *2QD1500.
# Expected of query_position(1): the angle of servo 1, or an error. What happens: an answer is waited for for 10 ms,
# less than the 16 ms that a USB adapter of FTDI holds bytes back by default, and the one that comes later stays in the
# buffer. It is taken as the answer to the next query, without a look at its number, and so on: servo 1 is read at 150°,
# servo 2 at 10°, and servo 3 at 150°, each with Ok. Only the late query itself is an error. A terminal that answers
# takes the place of the servos.
# For us: open the port anew after each TimeoutError.
#
# Exit code 0: still so. Needs cargo and Python; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir src
cat > Cargo.toml <<'TOML'
[package]
name = "angles"
version = "0.1.0"
edition = "2021"

[dependencies]
lss_driver = "=0.8.4"
tokio = { version = "1", features = ["rt", "macros", "time"] }
TOML
cat > src/main.rs <<'RUST'
#[tokio::main(flavor = "current_thread")]
async fn main() {
    let port = std::env::args().nth(1).unwrap();
    let mut servos = lss_driver::LSSDriver::new(&port).unwrap();
    for number in [1, 2, 1, 2, 3, 1] {
        match servos.query_position(number).await {
            Ok(angle) => println!("{number} {angle}"),
            Err(error) => println!("{number} {error:?}"),
        }
    }
}
RUST
cargo build --quiet 2> build.log || { cat build.log; exit 1; }
timeout 60 python3 - target/debug/angles <<'PYTHON'
import os
import pty
import subprocess
import sys
import threading
import tty

ANGLES = {1: 100, 2: 1500, 3: -300}  # in tenths of a degree


def answer(host):
    """Answer each query, but the second one together with the third."""
    received, queries, late = b'', 0, ''
    while True:
        received += os.read(host, 100)
        while b'\r' in received:
            query, received = received.split(b'\r', 1)
            number = int(query.removeprefix(b'#').removesuffix(b'QD'))
            late += f'*{number}QD{ANGLES[number]}\r'
            queries += 1
            if queries != 2:
                os.write(host, late.encode())
                late = ''


for _ in range(30):  # a busy computer may make other answers late, too
    host, port = pty.openpty()
    tty.setraw(host)
    tty.setraw(port)
    threading.Thread(target=answer, args=(host,), daemon=True).start()
    program = subprocess.run([sys.argv[1], os.ttyname(port)], capture_output=True, text=True, timeout=30, check=True)
    found = program.stdout.split('\n')[:-1]
    if found.count('2 TimeoutError') == 1 and program.stdout.count('TimeoutError') == 1:
        break
print('number and angle:', found)
assert found == ['1 10', '2 TimeoutError', '1 150', '2 10', '3 150', '1 -30'], found
PYTHON
