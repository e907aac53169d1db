# `make demo` sets up the package in .venv, `make test` adds what tests need. Both are quick the second time.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready
TEST := .venv/.test
DOCS := .venv/.docs
OLDEST := .venv-oldest
INSTALLED := out/installed
CONTACTS := out/contacts

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
	$(BIN)/pytest -n auto --dist worksteal -m slow

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
test-contacts:
	rm -rf $(CONTACTS)
	$(PYTHON) -m venv $(CONTACTS)/build
	$(CONTACTS)/build/bin/python -m pip install --quiet --disable-pip-version-check 'hatchling>=1.27'
	cd packaging/mjcontacts && ../../$(CONTACTS)/build/bin/python -m hatchling build -t wheel -d ../../$(CONTACTS)/files
	mkdir $(CONTACTS)/tests
	cp tests/contacts/*.py tests/pairs.py tests/everyday.py $(CONTACTS)/tests
	sed -i.before -e 's/^import mjrock as mr$$/import mjcontacts as mr/' -e 's/mjrock\.contacts/mjcontacts/g' $(CONTACTS)/tests/*.py
	cp packaging/mjcontacts/pyproject.toml $(CONTACTS)
	for needs in 'mujoco==3.3.2 numpy==1.26.4' 'mujoco numpy'; do \
		$(PYTHON) -m venv --clear $(CONTACTS)/venv && \
		$(CONTACTS)/venv/bin/python -m pip install --quiet --disable-pip-version-check $$needs pytest $(CONTACTS)/files/*.whl && \
		(cd $(CONTACTS) && venv/bin/python -m pytest tests) || exit 1; \
	done

lint: $(TEST)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

calibrate: $(READY) # the laws that ship, and what they are worth on walls they have not seen; half an hour on two cores
	$(BIN)/python scripts/paper/calibrate.py --laws mjrock/problem/damping/laws
	$(BIN)/python scripts/paper/validate_law.py
	cp out/calibrate/calibrated_fit.png docs/figures/damping_corners.png
	cp out/calibrate/calibrated_bed_fit.png docs/figures/damping_bed.png
	cp out/calibrate/calibrated_sensitivity.png docs/figures/damping_sensitivity.png
	cp out/validate_law/validation.png docs/figures/damping_validation.png

models: $(READY)
	$(BIN)/python scripts/models/make_models.py

figures: $(DOCS) # the pictures and tables of the README; RECORDS=folder takes recorded ground motions where a script does, SAMPLES=folder those of compas_cra
	$(BIN)/python -m mjrock demo --force --output docs/figures/demo
	$(BIN)/python scripts/paper/sketch.py --out docs/figures
	$(BIN)/python scripts/studies/first_pictures.py --out docs/figures
	$(BIN)/python scripts/paper/figure3.py --out docs/figures
	$(BIN)/python scripts/studies/animate.py --out docs/figures
	$(BIN)/python scripts/models/stack_before_and_after.py --out docs/figures
	$(BIN)/python scripts/models/rocking_by_the_guide.py --out docs/figures
	$(BIN)/python scripts/models/four_masses.py --out docs/figures
	$(BIN)/python scripts/paper/table2.py --out docs/figures
	$(BIN)/python scripts/measure/convergence.py --out docs/figures
	$(BIN)/python scripts/paper/layouts.py --out docs/figures
	$(BIN)/python scripts/checks/friction.py --out docs/figures
	$(BIN)/python scripts/checks/sliding.py --out docs/figures
	$(BIN)/python scripts/checks/limit_analysis.py --out docs/figures
	$(BIN)/python scripts/checks/slow_push.py --out docs/figures
	$(BIN)/python scripts/checks/arching.py --out docs/figures
	$(BIN)/python scripts/studies/shear_wall.py --out docs/figures
	$(BIN)/python scripts/paper/law_range.py --out docs/figures
	$(BIN)/python scripts/checks/hard_cases.py --out docs/figures
	$(BIN)/python scripts/checks/trouble.py --out docs/figures
	$(BIN)/python scripts/measure/work_precision.py --out docs/figures
	$(BIN)/python scripts/measure/records_accuracy.py --out docs/figures
	$(BIN)/python scripts/peers/peers.py --out docs/figures
	$(BIN)/python scripts/peers/other_codes.py $(if $(SAMPLES),--samples $(SAMPLES)) --out docs/figures
	$(BIN)/python scripts/measure/masonry_precision.py --out docs/figures
	$(BIN)/python scripts/measure/stack_losses.py --out docs/figures
	$(BIN)/python scripts/studies/thresholds.py --out docs/figures
	$(BIN)/python scripts/studies/overturning_spectrum.py --out docs/figures
	$(BIN)/python scripts/studies/ida.py --out docs/figures
	$(BIN)/python scripts/studies/fragility.py --out docs/figures
	$(BIN)/python scripts/studies/polarity.py --out docs/figures
	$(BIN)/python scripts/studies/town.py --out docs/figures
	$(BIN)/python scripts/studies/sensitivity.py --out docs/figures
	$(BIN)/python scripts/studies/limestone_blocks.py --out docs/figures
	$(BIN)/python scripts/studies/maxima.py --out docs/figures
	$(BIN)/python scripts/studies/restitution_spread.py --out docs/figures
	$(BIN)/python scripts/studies/agreement.py $(if $(RECORDS),--records $(RECORDS)) --out docs/figures
	$(BIN)/python scripts/measure/effect_costs.py $(if $(RECORDS),--records $(RECORDS)) --out docs/figures
	$(BIN)/python scripts/studies/facade.py $(if $(RECORDS),--records $(RECORDS)) --out docs/figures
	$(BIN)/python scripts/studies/cracked_facade.py $(if $(RECORDS),--records $(RECORDS)) --out docs/figures
	$(BIN)/python scripts/studies/drums.py --out docs/figures
	$(BIN)/python scripts/studies/panel.py --out docs/figures
	$(BIN)/python scripts/studies/solvers_of_masonry.py --out docs/figures
	$(BIN)/python scripts/studies/many_blocks.py --out docs/figures
	$(BIN)/python scripts/studies/many_records.py --out docs/figures
	$(BIN)/python scripts/studies/joint_stiffness.py --out docs/figures
	$(BIN)/python scripts/studies/two_storeys.py --out docs/figures
	$(BIN)/python scripts/studies/heap.py --out docs/figures
	$(BIN)/python scripts/studies/plain_masonry.py --out docs/figures
	$(BIN)/python scripts/studies/plain_models.py --out docs/figures
	$(BIN)/python scripts/studies/second_opinion.py --out docs/figures
	$(BIN)/python scripts/studies/in_the_viewer.py --out docs/figures
	$(BIN)/python scripts/studies/in_the_browser.py --out docs/figures
	$(BIN)/python scripts/studies/columns_in_space.py --out docs/figures
	$(BIN)/python scripts/studies/four_solvers.py --out docs/figures
	$(BIN)/python scripts/studies/facade_in_space.py --out docs/figures
	$(BIN)/python scripts/studies/corner_block.py --out docs/figures
	$(BIN)/python scripts/studies/law_in_space.py --out docs/figures
	$(BIN)/python scripts/studies/dome.py --out docs/figures
	$(BIN)/python scripts/studies/vaults.py --out docs/figures
	$(BIN)/python scripts/studies/mechanisms.py --out docs/figures
	$(BIN)/python scripts/studies/your_geometry.py --out docs/figures
	$(BIN)/python scripts/studies/bonded_facade.py --out docs/figures
	$(BIN)/python scripts/studies/opened_in_vtk.py --out docs/figures
	$(BIN)/python scripts/studies/drawn_in_space.py --out docs/figures
	$(BIN)/python scripts/measure/throughput.py --out docs/figures
	$(BIN)/python scripts/measure/plain_throughput.py --out docs/figures
	$(BIN)/python scripts/measure/rebound_phase.py --out docs/figures
	$(BIN)/python scripts/measure/step_cost.py --out docs/figures
	$(BIN)/python scripts/measure/speed.py

robots: $(READY) # public robots; PACKAGES=folder of packages that carry their models, MJX=a Python that has MuJoCo's MJX
	$(BIN)/python scripts/peers/robots/public_models.py --packages $(PACKAGES)
	$(BIN)/python scripts/peers/robots/feet.py --packages $(PACKAGES)
	$(if $(MJX),$(BIN)/python scripts/peers/robots/mjx_contacts.py --python $(MJX))

$(READY): INSTALL = pip install --quiet --disable-pip-version-check
$(OLDEST)/.ready: PYTHON = python3.11
$(OLDEST)/.ready: EXTRA = [test]
$(OLDEST)/.ready: INSTALL = pip install --quiet --disable-pip-version-check uv && \
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
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $@

$(DOCS): $(TEST)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	@touch $@

clean:
	rm -rf .venv $(OLDEST) out docs/build docs/auto_examples .pytest_cache .mypy_cache .ruff_cache
