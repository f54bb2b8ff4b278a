.DEFAULT_GOAL := help
PYTHON ?= python3
MINUTES ?= 30
FUZZ_SECONDS ?= 300
VENV := .venv
BIN := $(VENV)/bin
PIP_INSTALL := $(BIN)/pip install --quiet --disable-pip-version-check
PIP_LOG := $(VENV)/pip.log
# pip fails with pages of warnings, and in the same words without a network and without a wheel.
EXPLAIN_PIP = if grep -q 'connection broken' $(PIP_LOG); then \
	echo 'pip cannot reach the package index: see $(PIP_LOG); is there a network?'; \
	elif test "$$(uname -sm)" != 'Linux x86_64'; then \
	echo "ROS has no wheels for $$(uname -sm): install ROS 2 Jazzy, then colcon build"; \
	else grep -m 1 '^ERROR' $(PIP_LOG) || tail -n 1 $(PIP_LOG); fi
# Live tests wait most of the time, so that four workers keep two processors busy.
# Without a limit, pytest-xdist begins a test that has ended its worker again, up to 8 times, and
# may wait for good after that.
PYTEST := -m pytest --numprocesses 4 --dist loadfile --no-loadscope-reorder --max-worker-restart 0 \
	-o faulthandler_exit_on_timeout=true
LOCK := uv pip compile --universal --generate-hashes --python-version 3.11 \
	--no-emit-index-url --quiet --upgrade

# A sourced ROS installation would be mixed with the wheels of the virtual environment.
unexport PYTHONPATH LD_LIBRARY_PATH AMENT_PREFIX_PATH COLCON_PREFIX_PATH RMW_IMPLEMENTATION \
	_ROS_WHEELS_BOOTSTRAP_COMPLETE
# Where it is set, each of the many processes that tests start would compile all that it imports.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help demo simulator quick test coverage lint types docs format pictures soak fuzz lock clean

help: ## Show this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' Makefile

demo: $(VENV)/demo.stamp ## Play the shipped bag through the live node and validate it
	$(BIN)/gearkin demo

# Ctrl-C ends both, and so does SIGTERM, of which make tells the shell alone.
simulator: $(VENV)/demo.stamp ## Run a simulated actuator, and the node beside it
	@trap : INT TERM; config=config/simulated_actuator.yaml; \
	$(BIN)/gear_simulator --ros-args --params-file $$config & simulator=$$!; \
	$(BIN)/gear_state_publisher --ros-args --params-file $$config & node=$$!; \
	wait $$node; kill $$simulator $$node 2> /dev/null; wait

quick: lint ## Check style, and run the tests that need neither a live node nor much time
	$(BIN)/python $(PYTEST) --hypothesis-profile quick -m 'not live and not slow'

test: $(VENV)/test.stamp ## Run every check: ruff, mypy, documentation, pytest
	$(MAKE) --no-print-directory --jobs 2 --output-sync lint types docs
	$(BIN)/python $(PYTEST)

coverage: $(VENV)/test.stamp ## Measure the coverage of all but the slow tests, which takes them twice as long
	$(BIN)/coverage erase
	$(BIN)/coverage run $(PYTEST) -m 'not slow'
	$(BIN)/coverage combine --quiet
	$(BIN)/coverage report

lint: $(VENV)/test.stamp ## Check style and format
	$(BIN)/ruff check
	$(BIN)/ruff format --check

types: $(VENV)/test.stamp ## Check types
	$(BIN)/mypy

docs: $(VENV)/test.stamp ## Build the documentation into build/docs
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going --conf-dir docs . build/docs
	@echo '<meta http-equiv="refresh" content="0; url=docs/index.html">' > build/docs/index.html
	@echo 'build/docs/index.html'

format: $(VENV)/test.stamp ## Rewrite the sources in the house format
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

pictures: $(VENV)/test.stamp ## Redraw the pictures of README and documentation (needs Chromium)
	$(BIN)/python docs/pictures.py > /dev/null

soak: $(VENV)/demo.stamp ## Run the node at 1 kHz for MINUTES (30)
	$(BIN)/python benchmark/soak.py --minutes $(MINUTES)

fuzz: $(VENV)/test.stamp $(VENV)/fuzz.stamp ## Fuzz messages and bags for FUZZ_SECONDS (300) each
	$(BIN)/python fuzz/run.py messages -max_total_time=$(FUZZ_SECONDS)
	$(BIN)/python fuzz/run.py bags -max_total_time=$(FUZZ_SECONDS)

lock: ## Pin the newest versions (needs uv)
	cd requirements && $(LOCK) --output-file demo.txt demo.in
	cd requirements && $(LOCK) --constraint demo.txt --output-file test.txt test.in
	cd requirements && $(LOCK) --output-file kilted.txt kilted.in
	cd requirements && $(LOCK) --output-file fuzz.txt fuzz.in
	cd requirements && $(LOCK) --output-file uv.txt uv.in

clean: ## Remove everything that was generated
	rm -rf $(VENV) .coverage* .hypothesis .mypy_cache .pytest_cache .ruff_cache \
		build dist install log *.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/%.stamp: requirements/%.txt setup.py setup.cfg pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo 'Python 3.11 or newer is needed: make PYTHON=python3.12' >&2; exit 1; }
	@test -x $(BIN)/pip || $(PYTHON) -c 'import ensurepip, venv' 2> /dev/null || { \
		echo 'Python has no ensurepip: apt install $(notdir $(PYTHON))-venv' >&2; exit 1; }
	test -x $(BIN)/pip || $(PYTHON) -m venv --clear $(VENV)
	@echo 'installing $< into $(VENV)'
	@cmp -s $< $(VENV)/uv-$(<F) || $(BIN)/python requirements/install.py $< $(PIP_LOG) || { \
		$(EXPLAIN_PIP) >&2; exit 1; }
	$(PIP_INSTALL) --no-deps --no-build-isolation -e .
	@broken=$$($(BIN)/pip check --disable-pip-version-check) || { echo "$$broken" >&2; exit 1; }
	@touch $@
