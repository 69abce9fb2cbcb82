# Everything needed is installed into .venv by the targets themselves; Python >= 3.11 and make are all a machine must have.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
OUT ?= out/quickstart
export OMP_NUM_THREADS ?= 1

.PHONY: quickstart test lint generated bench fuzz clean

$(VENV)/installed: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Raceway needs Python 3.11 or later; set PYTHON=..."; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	@touch $@

quickstart: $(VENV)/installed
	@$(BIN)/raceway generate quickstart -o $(OUT)/corpus
	@$(BIN)/raceway features $(OUT)/corpus -o $(OUT)/features.nc
	@$(BIN)/raceway train $(OUT)/corpus -o $(OUT)/model.skops
	@$(BIN)/raceway benchmark $(OUT)/corpus -o $(OUT)/benchmark
	@echo "corpus  $(OUT)/corpus/corpus.nc"
	@echo "model   $(OUT)/model.skops"
	@echo "report  $(OUT)/benchmark/report.html"
	@echo "scores  $(OUT)/benchmark/results.json"

lint: $(VENV)/installed
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright

test: lint
	$(BIN)/python -m pytest -n logical --dist worksteal

generated: $(VENV)/installed
	$(BIN)/python -m gen.pages .

bench: $(VENV)/installed
	$(BIN)/python -m benchmarks

fuzz: $(VENV)/installed
	$(BIN)/python -m tests.fuzz --count 20000

clean:
	rm -rf $(VENV) out build *.egg-info
