VENV ?= .venv
BIN := $(VENV)/bin
PYTHON ?= python3

.PHONY: run test verify bench docs lint clean

run: $(VENV)/.ready
	$(BIN)/python -m studies.all

# two workers already use the cores of a small machine; threads of linear algebra beside them take three times as long
test verify: export OPENBLAS_NUM_THREADS = 1

test: $(VENV)/.ready lint
	$(BIN)/python -m pytest -n auto --maxprocesses 2 --dist loadgroup

# run once more with kernels that check every access to arrays
CHECKED := tests/kernels/test_compiler.py \
	tests/kernels/test_compiler_refusals.py \
	tests/kernels/test_out_of_bounds.py \
	tests/kernels/test_lanes.py \
	tests/equations/test_kernels.py \
	tests/kernels/test_bidirectional_lu.py \
	tests/kernels/test_band_newton.py \
	tests/equations/test_statics.py \
	tests/solvers/test_dynamics.py \
	tests/equations/test_section_laws.py \
	tests/equations/test_bordered.py \
	tests/physics/test_connections.py \
	tests/solvers/test_motion_on_rollers.py

verify: $(VENV)/.ready
	$(BIN)/python -m pytest -n auto --maxprocesses 2 --dist loadgroup -m "slow or not slow"
	BEAMFEM_CHECK=1 $(BIN)/python -m pytest -n auto --maxprocesses 2 --dist loadgroup $(CHECKED)

bench: $(VENV)/.bench
	$(BIN)/python -m studies.benchmarks.peers
	$(BIN)/python -m studies.benchmarks.fresh_models
	$(BIN)/python -m studies.benchmarks.chain_growth
	$(BIN)/python -m studies.benchmarks.integrators
	$(BIN)/python -m studies.benchmarks.part_costs
	$(BIN)/python -m studies.benchmarks.roofline
	$(BIN)/python -m studies.benchmarks.compile_budget
	$(BIN)/python -m studies.benchmarks.package_size

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx -q -W --keep-going -b html docs out/docs
	@echo "open out/docs/index.html"

lint: $(VENV)/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

$(VENV)/.ready: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[plot,vtk,mesh,cad,store,pandas,xarray,test]"
	touch $@

$(VENV)/.docs: $(VENV)/.ready pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[docs]"
	touch $@

# where the peer cannot be installed, the rest of the bench runs all the same
$(VENV)/.bench: $(VENV)/.ready pyproject.toml
	if $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[bench]"; then touch $@; fi

clean:
	rm -rf $(VENV) out
