# Two commands do all set-up on a fresh machine with Python 3.11+ and pip: `make demo` and `make test`.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/installed
INTEGRATIONS := .venv-integrations

.PHONY: demo test test-browser test-integrations lint wheel-test benchmark clean

demo: $(INSTALLED)
	$(BIN)/mrta-zoo demo

test: $(INSTALLED)
	$(BIN)/python -m pytest -n 2 --dist worksteal

# The replay page in headless Chromium, which the system must have; without it these tests are skipped.
test-browser: $(INSTALLED)
	$(BIN)/pip install --quiet --constraint constraints.txt --editable ".[browser]"
	$(BIN)/python -m pytest -m browser -rs tests/browser

# RLlib, TorchRL, SB3, SuperSuit and Tianshou learn a small problem each, in an environment of their own.
test-integrations: $(INTEGRATIONS)/installed
	OMP_NUM_THREADS=1 $(INTEGRATIONS)/bin/python -m pytest -n 2 --dist loadgroup -m integrations -W ignore tests/integrations

# mypy must see the package as it is installed, with policies/, train/ and eval/ inside mrta_zoo/.
lint: $(INSTALLED)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	rm -rf build/lib build/typed
	$(BIN)/pip install --quiet --no-deps --target build/typed .
	cd build/typed && $(CURDIR)/$(BIN)/mypy --config-file $(CURDIR)/pyproject.toml -p mrta_zoo

# A wheel, installed in an empty environment away from the checkout, runs the demo.
wheel-test: $(INSTALLED)
	rm -rf dist build/lib build/wheel-test
	$(BIN)/python -m build --wheel --outdir dist
	$(PYTHON) -m venv build/wheel-test
	build/wheel-test/bin/pip install --quiet --constraint constraints.txt "$$(ls dist/*.whl)[all]"
	cd build/wheel-test && bin/mrta-zoo demo --out demo

benchmark: $(INSTALLED)
	$(BIN)/python -m mrta_zoo.eval.benchmarks.aec_turns

$(INSTALLED): pyproject.toml constraints.txt
	@echo "installing into $(VENV): two minutes or so, in silence"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --upgrade pip
	PYTHONWARNINGS=ignore $(BIN)/pip install --quiet --constraint constraints.txt --editable ".[dev]"
	touch $(INSTALLED)

# Not compiled ahead: most of it is never imported.
$(INTEGRATIONS)/installed: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(INTEGRATIONS)
	$(INTEGRATIONS)/bin/pip install --quiet --upgrade pip
	PYTHONWARNINGS=ignore $(INTEGRATIONS)/bin/pip install --quiet --no-compile --constraint constraints.txt \
		--editable ".[integrations]" "pytest>=8" "pytest-xdist>=3.5"
	touch $@

clean:
	rm -rf $(VENV) $(INTEGRATIONS) build dist *.egg-info
