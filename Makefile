# Fleet Supervisor. `make help` lists what there is; `make demo` and `make test` need nothing but this file.
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

READY := .venv/.fleet-setup
RUN := .venv/bin/python
HEADLESS := env QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$(CURDIR)/build/run
DRAW := $(HEADLESS) PYTHONPATH=scripts $(RUN) -m pictures

# Given on the command line: make test ARGS="-k robotmap" JOBS=0 (ARGS=-rs says why tests were skipped),
# make install PROFILE=work LINK=1
ARGS ?=
JOBS ?= 6
# Which file comes when says tests/conftest.py. pytest-qgis takes --dist for a sign that workers have QGIS, so
# without workers it must not be there.
SIDE_BY_SIDE = $(if $(filter 0,$(JOBS)),,-n $(JOBS) --dist loadfile --no-loadscope-reorder)
PROFILE ?= default
LINK ?=
# For plugins.qgis.org: make package REPOSITORY=https://... TRACKER=https://...
REPOSITORY ?=
TRACKER ?=
# How long PARTS=endurance runs; half an hour without.
MINUTES ?=
export PYTHON DESTDIR PREFIX PROGRAM ARGS JOBS REPOSITORY TRACKER MINUTES

.PHONY: help setup demo test test-core test-newer lint desktop screenshots install install-service uninstall-service serve-maps translations package clean bench mutants

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-18s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(READY) ## install what is missing (QGIS, Xvfb, .venv); quick when nothing is

$(READY): pyproject.toml scripts/setup.sh
	@scripts/setup.sh

build/run:
	@mkdir -p -m 700 $@

demo: $(READY) build/run ## run the main job once, headless, on the sample site; see build/demo/ (PARTS=zalazone)
	@$(HEADLESS) $(RUN) scripts/demo.py $(PARTS)

test: $(READY) build/run ## run every test, style and import rules included, headless
	@$(HEADLESS) $(RUN) -m pytest -q -rfEs $(SIDE_BY_SIDE) --durations=5 --durations-min=1 $(ARGS)

test-core: $(READY) ## run within a minute what needs neither QGIS nor database servers nor a display
	@$(RUN) -m pytest -q -rfE -p no:pytest_qgis --core -n 2 --dist loadfile --no-loadscope-reorder $(ARGS)

test-newer: ## run every test on the newer QGIS of Debian forky, in a root folder of its own (as root)
	@scripts/newer.sh

lint: $(READY) ## check style, types and import rules only
	@$(RUN) -m pytest -q tests/packaging/test_style.py

desktop: $(READY) ## open QGIS Desktop with the plugin, the sample site and three driving robots
	@$(RUN) scripts/desktop.py

screenshots: $(READY) build/run ## make the pictures in docs/images, in real windows under Xvfb
	@$(RUN) scripts/desktop.py --screenshot docs/images/desktop.png
	@PYTHONPATH=scripts $(RUN) -m walkthrough --pictures docs/images
	@$(RUN) scripts/roles_picture.py
	@$(DRAW).robot_maps
	@$(DRAW).cones
	@$(DRAW).assignment
	@$(DRAW).supervisors
	@$(RUN) scripts/cone_plan_pictures.py
	@$(DRAW).roads
	@$(DRAW).stored_loop
	@$(DRAW).road_surfaces

install: $(READY) ## put the plugin into your QGIS profile (PROFILE=name, LINK=1 links this folder)
	@$(RUN) scripts/install_plugin.py --profile "$(PROFILE)" $(if $(LINK),--link)

install-service: ## put the gateway on this computer as a systemd service (DESTDIR=, PREFIX=/opt/robot-bridge)
	@scripts/service.sh install

uninstall-service: ## take that service away; settings and data stay
	@scripts/service.sh uninstall

serve-maps: $(READY) ## serve a project and the fleet as WMS, WMTS, WFS (ARGS="--fleet fleet.vrt --port 8790"); docs/services.md
	@$(RUN) tools/serve_maps.py $(ARGS)

translations: $(READY) ## bring resources/translations up to date with the source
	@$(RUN) scripts/translations.py

package: $(READY) ## build the zip for plugins.qgis.org
	@$(RUN) scripts/package.py

bench: $(READY) ## measure on the real data beside the project (PARTS=maps ..., MINUTES=5, TRIAL=1); see docs/benchmarks.md
	@$(RUN) scripts/bench.py $(PARTS)

mutants: $(READY) ## change what stops robots in every way that a test must notice (ARGS=emergency); docs/benchmarks.md
	@.venv/bin/pip install -q $$($(RUN) -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["mutation"])')
	@nice -n 10 $(RUN) scripts/mutants.py $(ARGS)

clean: ## remove build/ (what was built, not the environment)
	rm -rf build
