VENV ?= .venv
BIN := $(VENV)/bin
PYTHON ?= python3

.PHONY: run test verify bench lint clean

run: $(VENV)/.ready
	$(BIN)/python studies/all.py

test: $(VENV)/.ready lint
	$(BIN)/python -m pytest

verify: $(VENV)/.ready
	$(BIN)/python -m pytest -m "slow or not slow"

bench: $(VENV)/.ready
	$(BIN)/python studies/peers.py

lint: $(VENV)/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

$(VENV)/.ready: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[plot,store,cad,test]"
	touch $@

clean:
	rm -rf $(VENV) out
