#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tinygo.org/x/drivers 0.37.0: a run current of 16 is sent to a TMC2209 as 2, and a driver that is too hot has no error.
#
# The register IHOLD_IRUN has, by the datasheet, the run current in bits 8 to 12 and the delay in bits 16 to 19, as
# tmc2209 0.3.0 for Rust packs them. Pack() puts the run current at bit 5 and the delay at bit 10: 16 of 31 becomes 2
# and a delay of 8 becomes 0. Expected of CheckErrorStatus() of a driver with a short circuit that is too hot: false.
# What happens: true, as the status that is read is never looked at, and VerifyCommunication() is false for a driver
# that answers, for the same reason. Unpack() does not use the value that it is given. A table of registers answers here
# as a driver does.
# For us: a motor with an eighth of its current loses steps under load, which looks like a slipped coupling.
#
# Exit code 0: still so. Needs go; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GOMODCACHE="$folder/modules" GOFLAGS=-modcacherw
go mod init example.org/driver 2> log
go get tinygo.org/x/drivers/tmc2209@v0.37.0 2>> log || { cat log; exit 1; }
cat > main.go <<'GO'
package main

import (
	"fmt"
	"io"
	"log"
	"os"

	"tinygo.org/x/drivers/tmc2209"
)

type registers map[uint8]uint32

func (r registers) ReadRegister(register uint8, _ uint8) (uint32, error) {
	return r[register], nil
}

func (r registers) WriteRegister(register uint8, value uint32, _ uint8) error {
	r[register] = value
	return nil
}

func main() {
	log.SetOutput(io.Discard)
	current := tmc2209.NewIholdIrun()
	current.Ihold, current.Irun, current.Iholddelay = 8, 16, 8
	packed := current.Pack()
	hold, run, delay := packed&31, packed>>8&31, packed>>16&15
	fmt.Printf("hold 8, run 16, delay 8: %#x, which is hold %d, run %d, delay %d\n", packed, hold, run, delay)
	const version, tooHot, shortCircuit = 0x21 << 24, 1 << 1, 1 << 2
	driver := registers{0x06: version, 0x6F: tooHot | shortCircuit}
	sound, answers := tmc2209.CheckErrorStatus(driver, 0), tmc2209.VerifyCommunication(driver, 0)
	fmt.Println("hot, with a short circuit: sound", sound, "and answers", answers)
	read := tmc2209.NewIholdIrun()
	read.Unpack(0x00041008)
	fmt.Println("unpacked: hold", read.Ihold, "run", read.Irun)
	if hold != 8 || run != 2 || delay != 0 || !sound || answers || read.Ihold != 0 {
		os.Exit(1)
	}
}
GO
timeout 200 go run .
