# The two commands: `make ui` starts the dashboard, `make test` runs all tests.
# Both need python3, python3-venv and make, and nothing else.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: ui test lint long clean

ui: $(VENV)/.installed
	$(BIN)/geswarm-ui $(ARGS)

test: $(VENV)/.installed-test
	$(BIN)/pytest -n auto $(ARGS)

long: $(VENV)/.installed-test
	$(BIN)/pytest -m long $(ARGS)

lint: $(VENV)/.installed-lint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

$(VENV)/.installed: pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --editable .
	touch $@

$(VENV)/.installed-test: $(VENV)/.installed
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[test]'
	touch $@

$(VENV)/.installed-lint: $(VENV)/.installed
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[lint]'
	touch $@

clean:
	rm -rf $(VENV) build dist *.egg-info
