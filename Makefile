# `make demo` sets up the package in .venv, `make test` adds what tests need. Both are quick the second time.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready
TEST := .venv/.test
DOCS := .venv/.docs
OLDEST := .venv-oldest
INSTALLED := out/installed
CONTACTS := out/contacts
# No module is compiled to bytecode as it is installed: a run imports few of them.
PIP := pip install --quiet --no-compile --disable-pip-version-check

.PHONY: demo docs test test-slow test-processors test-oldest test-installed test-contacts mutants lint calibrate models figures robots clean stale

# Tests fill every core with processes. Where threads of BLAS wait for a core, small matrices take up to 200 times longer.
test test-slow test-processors test-oldest test-installed test-contacts mutants: export OPENBLAS_NUM_THREADS = 1
# Bytecode is stored: the processes that tests start then need not compile the package again, nor pytest rewrite its tests.
test test-slow test-processors test-oldest test-installed: export PYTHONDONTWRITEBYTECODE =

demo: $(READY)
	$(BIN)/python -m mjrock demo --force --output out/demo

test: $(TEST)
	$(BIN)/pytest -n auto

docs: $(DOCS) # the documentation, with the examples run: docs/build/html/index.html; a warning is an error
	rm -rf docs/build docs/auto_examples
	$(BIN)/python -m sphinx -b html -W --keep-going -q -d docs/build/doctrees docs docs/build/html
	@echo "docs/build/html/index.html"

test-slow: $(DOCS)
	$(BIN)/pytest -n auto -m slow

test-processors: $(TEST) # the everyday tests of the physics by the linear algebra of other processors; OTHERS=1 the few for .ci/run
	$(BIN)/python tests/processors.py $(if $(OTHERS),--others)

mutants: $(TEST) # changes one operator or number of the physics at a time and names what no test notices; some minutes
	$(BIN)/python tests/mutants.py $(if $(COUNT),--count $(COUNT)) $(if $(SEED),--seed $(SEED))

# The everyday tests with the oldest Python and versions that pyproject.toml allows. An older numba has a store of its own:
# each version removes what another one has stored.
test-oldest: export NUMBA_CACHE_DIR = $(CURDIR)/out/oldest
test-oldest: $(OLDEST)/.ready
	$(OLDEST)/bin/pytest -n auto

# The everyday tests by PYTHON, away from the checkout. The package is installed from files alone: the wheel that brings what
# it needs, and over it one that is built from the source distribution.
test-installed:
	rm -rf $(INSTALLED)
	$(PYTHON) -m venv $(INSTALLED)/venv
	$(INSTALLED)/venv/bin/python -m pip install --quiet 'hatchling>=1.27'
	$(INSTALLED)/venv/bin/python -m hatchling build -d $(INSTALLED)/files
	cp -r tests docs scripts models pyproject.toml README.md CHANGELOG.md $(INSTALLED)
	cd $(INSTALLED) && venv/bin/python -m pip download --quiet --dest files "$$(ls files/mjrock-*.whl)[test]"
	cd $(INSTALLED) && venv/bin/python -m pip install --quiet --no-index --find-links files "$$(ls files/mjrock-*.whl)[test]"
	cd $(INSTALLED) && venv/bin/python -m pip install --quiet --no-index --no-build-isolation --no-deps --force-reinstall \
		files/mjrock-*.tar.gz
	cd $(INSTALLED) && venv/bin/python -m pytest -n auto --ignore tests/house

# The distribution mjcontacts: its wheel in fresh environments with the oldest and the newest MuJoCo, and its tests there.
# OLDEST_ONLY=1 leaves out the newest, with which `make test` runs the same tests by the names of mjrock.
test-contacts:
	rm -rf $(CONTACTS)
	$(PYTHON) -m venv $(CONTACTS)/build
	$(CONTACTS)/build/bin/python -m $(PIP) 'hatchling>=1.27'
	cd packaging/mjcontacts && ../../$(CONTACTS)/build/bin/python -m hatchling build -t wheel -d ../../$(CONTACTS)/files
	mkdir $(CONTACTS)/tests
	cp tests/contacts/*.py tests/pairs.py tests/everyday.py $(CONTACTS)/tests
	sed -i.before -e 's/^import mjrock as mr$$/import mjcontacts as mr/' -e 's/mjrock\.contacts/mjcontacts/g' $(CONTACTS)/tests/*.py
	cp packaging/mjcontacts/pyproject.toml $(CONTACTS)
	for needs in 'mujoco==3.3.2 numpy==1.26.4' $(if $(OLDEST_ONLY),,'mujoco numpy'); do \
		$(PYTHON) -m venv --clear $(CONTACTS)/venv && \
		$(CONTACTS)/venv/bin/python -m $(PIP) $$needs pytest $(CONTACTS)/files/*.whl && \
		(cd $(CONTACTS) && venv/bin/python -m pytest tests) || exit 1; \
	done

lint: $(TEST)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

calibrate: $(READY) # the laws that ship, and what they are worth on walls they have not seen; half an hour on two cores
	$(BIN)/python scripts/paper/calibrate.py --laws mjrock/problem/damping/laws
	$(BIN)/python scripts/paper/validate_law.py

models: $(READY)
	$(BIN)/python scripts/models/make_models.py

# The figures and tables of the pages that are stale, all with ALL=1. RECORDS=folder has recorded ground motions, MOTIONS=folder
# those of the shake table, SAMPLES=folder the assemblies of compas_cra; what needs one that is not given is named.
figures: $(DOCS)
	$(BIN)/python scripts/figures.py $(if $(ALL),--all) $(if $(RECORDS),--records $(RECORDS)) \
		$(if $(MOTIONS),--motions $(MOTIONS)) $(if $(SAMPLES),--samples $(SAMPLES)) $(NAMES)

robots: $(READY) # public robots; PACKAGES=folder of packages that carry their models, MJX=a Python that has MuJoCo's MJX
	$(BIN)/python scripts/peers/robots/public_models.py --packages $(PACKAGES)
	$(BIN)/python scripts/peers/robots/feet.py --packages $(PACKAGES)
	$(if $(MJX),$(BIN)/python scripts/peers/robots/mjx_contacts.py --python $(MJX))

$(READY): INSTALL = $(PIP)
$(OLDEST)/.ready: PYTHON = python3.11
$(OLDEST)/.ready: EXTRA = [test]
$(OLDEST)/.ready: INSTALL = $(PIP) uv && \
	$(OLDEST)/bin/python -m uv pip install --quiet --python $(OLDEST)/bin/python --resolution lowest-direct

# An environment whose Python is gone, or that belongs to another folder, is stale and is made anew.
SERVES = import importlib.util, os, sys; \
	found = importlib.util.find_spec("mjrock"); \
	sys.exit(found is None or not os.path.samefile(found.origin, "mjrock/__init__.py"))
STALE = $(shell $*/bin/python -I -c '$(SERVES)' 2>/dev/null || echo stale)

.SECONDEXPANSION:
$(READY) $(OLDEST)/.ready: %/.ready: pyproject.toml $$(STALE)
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "mjrock needs Python 3.11 or newer; name one with: make PYTHON=python3.12 ..."; exit 1; }
	$(PYTHON) -m venv $(if $(filter stale,$^),--clear) $*
	$*/bin/python -m $(INSTALL) --editable '.$(EXTRA)'
	@touch $@

$(TEST): $(READY)
	$(BIN)/python -m $(PIP) --editable '.[test]'
	@touch $@

$(DOCS): $(TEST)
	$(BIN)/python -m $(PIP) --editable '.[docs]'
	@touch $@

clean:
	rm -rf .venv $(OLDEST) out docs/build docs/auto_examples .pytest_cache .mypy_cache .ruff_cache
