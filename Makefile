# Two commands do all set-up on a fresh machine with Python 3.11+ and pip: `make demo` and `make test`.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/installed

.PHONY: demo test lint wheel-test benchmark clean

demo: $(INSTALLED)
	$(BIN)/mrta-zoo demo

test: $(INSTALLED)
	$(BIN)/python -m pytest -n 2

# mypy sees the installed package, in which policies/, train/ and eval/ lie inside mrta_zoo/.
lint: $(INSTALLED)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy -p mrta_zoo

# A wheel, installed in an empty environment away from the checkout, runs the demo.
wheel-test: $(INSTALLED)
	rm -rf dist build/wheel-test
	$(BIN)/python -m build --wheel --outdir dist
	$(PYTHON) -m venv build/wheel-test
	build/wheel-test/bin/pip install --quiet --constraint constraints.txt "$$(ls dist/*.whl)[all]"
	cd build/wheel-test && bin/mrta-zoo demo --out demo

benchmark: $(INSTALLED)
	$(BIN)/python -m mrta_zoo.eval.benchmarks.aec_turns

# Strict editable mode links every file into one package folder, which type checkers understand; new files need
# `make clean` (or touching pyproject.toml) to be linked.
$(INSTALLED): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --upgrade pip
	$(BIN)/pip install --quiet --constraint constraints.txt --config-settings editable_mode=strict --editable ".[dev]"
	touch $(INSTALLED)

clean:
	rm -rf $(VENV) build dist *.egg-info
