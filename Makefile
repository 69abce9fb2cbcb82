# Everything needed is installed into .venv by the targets themselves; Python >= 3.11 and make are all a machine must have.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
OUT ?= out/quickstart
export OMP_NUM_THREADS ?= 1
unexport PYTHONDONTWRITEBYTECODE # each process would compile every module again
FLOORS := .venv-floors
# the fast half: everything that needs no kernel of the full model
FLOOR_TESTS := tests/test_packaging.py tests/gen/recipe tests/gen/corpus tests/raceway/importing tests/gen/physics tests/gen/support/test_yaml_files_laws.py \
	tests/features tests/raceway/test_commands.py --ignore=tests/gen/physics/kernel

.PHONY: quickstart test tests lint generated reference docs paper bench thorough floors clean

$(VENV)/installed: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Raceway needs Python 3.11 or later; set PYTHON=..."; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	@touch $@

quickstart: $(VENV)/installed
	@$(BIN)/raceway generate quickstart -o $(OUT)/corpus
	@$(BIN)/raceway plot $(OUT)/corpus -o $(OUT)/classes.png
	@$(BIN)/raceway features $(OUT)/corpus -o $(OUT)/features.nc
	@$(BIN)/raceway train $(OUT)/corpus -o $(OUT)/model.skops
	@$(BIN)/raceway benchmark $(OUT)/corpus -o $(OUT)/benchmark
	@echo "corpus   $(OUT)/corpus"
	@echo "picture  $(OUT)/classes.png"
	@echo "model    $(OUT)/model.skops"
	@echo "scores   $(OUT)/benchmark/results.json"
	@echo "Open     $(OUT)/benchmark/report.html"

lint: $(VENV)/installed
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright

# types are checked by one process while others run the tests
test: $(VENV)/installed
	@$(MAKE) --jobs=2 --no-print-directory lint tests

tests: $(VENV)/installed
	$(BIN)/python -m pytest -n logical --dist loadfile

generated: $(VENV)/installed
	$(BIN)/python -m gen.pages .
	$(BIN)/python -m benchmarks.feature_pages docs/features.md

# the feature table that ships with Raceway, from which the reference model is trained
reference: $(VENV)/installed
	$(BIN)/python -m benchmarks.reference_table

# the site under out/docs; index.html opens it, search included, without a server. The tutorials run, which takes about six minutes
docs: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --editable '.[docs]'
	$(BIN)/sphinx-build --quiet --fail-on-warning --keep-going -c docs/site -b html . out/docs
	@echo "Open     out/docs/index.html"

# the paper that Raceway began with: its figures drawn again and its statements measured, on one page
paper: $(VENV)/installed
	$(BIN)/python -m studies.ophel2025 -o out/ophel2025

bench: $(VENV)/installed
	$(BIN)/python -m benchmarks

# fresh examples of all laws; then fuzz, kills, memory, other processors, programs of others, and all of the benchmarks
thorough: $(VENV)/installed
	$(BIN)/python -m pytest -n logical --dist loadfile --hypothesis-profile=fresh
	$(BIN)/python -m pytest -n logical tests/thorough
	$(BIN)/python -m tests.thorough.fuzz --count 20000

$(FLOORS)/installed: pyproject.toml
	rm -rf $(FLOORS)
	$(PYTHON) -m venv $(FLOORS)
	$(FLOORS)/bin/python -m tests.floors > $(FLOORS)/floors.txt
	$(FLOORS)/bin/python -m pip install --quiet --constraint $(FLOORS)/floors.txt --editable '.[test]'
	@touch $@

# warnings are no errors here: old packages warn of newer ones that they were never tried with
floors: $(FLOORS)/installed
	NUMBA_CACHE_DIR=$(FLOORS)/kernels $(FLOORS)/bin/python -m pytest -W ignore -p no:cacheprovider $(FLOOR_TESTS)

clean:
	rm -rf $(VENV) $(FLOORS) out build dist *.egg-info
