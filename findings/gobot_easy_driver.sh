#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gobot.io/x/gobot/v2 2.5.0 (Go): a move of -100 steps goes forward and is counted back, and 360 moves of 1° are 316°.
#
# An EasyDriver has a direction pin, 0 for forward. Expected of Move(-100): the pin is set to 1 for 100 steps. What
# happens: only the counter knows of the sign; the pin keeps its level, the motor turns forward, and CurrentStep() is
# -100. After SetDirection("backward") and Move(100) the motor turns back and is counted forward. Only Run() does both
# alike. Expected of 360 moves of 1° by a StepperDriver with 2048 steps per turn: one turn. What happens: each is cut
# off to 5 of its 5.69 steps, so that they make 1800 steps, 316°; with 200 steps per turn each is an error, as 0.56
# steps are none.
# For us: call SetDirection() before each Move() of positive steps, and count yourself; give angles as steps.
#
# Exit code 0: still so. Needs go; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GOMODCACHE="$folder/modules" GOFLAGS=-modcacherw
go mod init example.org/driver 2> log
go get gobot.io/x/gobot/v2/drivers/gpio@v2.5.0 2>> log || { cat log; exit 1; }
cat > main.go <<'GO'
package main

import (
	"fmt"
	"io"
	"log"
	"os"

	"gobot.io/x/gobot/v2/drivers/gpio"
)

// pins is a board that counts the steps of a motor by the level of its direction pin.
type pins struct {
	direction byte
	turned    int
	writes    int
}

func (board *pins) Name() string    { return "pins" }
func (board *pins) SetName(string)  {}
func (board *pins) Connect() error  { return nil }
func (board *pins) Finalize() error { return nil }

func (board *pins) DigitalWrite(pin string, level byte) error {
	board.writes++
	if pin == "direction" {
		board.direction = level
	} else if pin == "step" && level == 1 {
		board.turned += 1 - 2*int(board.direction)
	}
	return nil
}

func main() {
	log.SetOutput(io.Discard)
	board := &pins{}
	motor := gpio.NewEasyDriver(board, 1.8, "step", gpio.WithEasyDirectionPin("direction"))
	must(motor.SetSpeed(motor.MaxSpeed()))
	must(motor.Move(-100))
	fmt.Println("Move(-100): turned", board.turned, "counted", motor.CurrentStep())
	wrong := board.turned == 100 && motor.CurrentStep() == -100
	must(motor.SetDirection("backward"))
	must(motor.Move(100))
	fmt.Println("backward, Move(100): turned", board.turned-100, "counted", motor.CurrentStep()+100)
	wrong = wrong && board.turned == 0 && motor.CurrentStep() == 0

	board = &pins{}
	fine := gpio.NewStepperDriver(board, [4]string{"1", "2", "3", "4"}, gpio.StepperModes.DualPhaseStepping, 2048)
	for move := 0; move < 360; move++ {
		must(fine.MoveDeg(1))
	}
	steps := board.writes / 4
	fmt.Println("360 moves of 1°:", steps, "steps of 2048,", 360*float64(steps)/2048, "°")
	coarse := gpio.NewStepperDriver(board, [4]string{"1", "2", "3", "4"}, gpio.StepperModes.DualPhaseStepping, 200)
	err := coarse.MoveDeg(1)
	fmt.Println("200 steps per turn:", err)
	if !wrong || steps != 1800 || err == nil {
		os.Exit(1)
	}
}

func must(err error) {
	if err != nil {
		panic(err)
	}
}
GO
timeout 280 go run .
