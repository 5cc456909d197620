VENV ?= .venv
BIN := $(VENV)/bin
PYTHON ?= python3

.PHONY: run test verify bench docs lint clean

run: $(VENV)/.ready
	$(BIN)/python studies/all.py

test: $(VENV)/.ready lint
	$(BIN)/python -m pytest -n auto --maxprocesses 2 --dist loadgroup

verify: $(VENV)/.ready
	$(BIN)/python -m pytest -n auto --maxprocesses 2 --dist loadgroup -m "slow or not slow"

bench: $(VENV)/.bench
	$(BIN)/python studies/peers.py
	$(BIN)/python studies/chain_growth.py
	$(BIN)/python studies/roofline.py
	$(BIN)/python studies/compile_budget.py

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx -q -W --keep-going -b html docs out/docs
	@echo "open out/docs/index.html"

lint: $(VENV)/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

$(VENV)/.ready: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[plot,store,cad,test]"
	touch $@

$(VENV)/.docs: $(VENV)/.ready pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[docs]"
	touch $@

# where the peer cannot be installed, the rest of the bench runs all the same
$(VENV)/.bench: $(VENV)/.ready pyproject.toml
	if $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[bench]"; then touch $@; fi

clean:
	rm -rf $(VENV) out
