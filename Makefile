# `make demo` and `make test` set up what they need in .venv and are quick the second time.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready

.PHONY: demo test test-slow lint models figures clean

demo: $(READY)
	$(BIN)/python scripts/compare_wall.py --check --out out/demo

test: $(READY)
	$(BIN)/pytest -n auto

test-slow: $(READY)
	$(BIN)/pytest -n auto -m slow

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

models: $(READY)
	$(BIN)/python scripts/make_models.py

figures: $(READY)
	$(BIN)/python scripts/figure3.py
	$(BIN)/python scripts/table2.py
	$(BIN)/python scripts/convergence.py
	$(BIN)/python scripts/layouts.py
	$(BIN)/python scripts/friction.py

$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "mjrock needs Python 3.11 or newer; name one with: make PYTHON=python3.12 ..."; exit 1; }
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $(READY)

clean:
	rm -rf .venv out .pytest_cache .mypy_cache .ruff_cache
