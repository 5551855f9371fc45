# Fleet Supervisor. `make help` lists what there is; `make demo` and `make test` need nothing but this file.
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

READY := .venv/.fleet-setup
RUN := .venv/bin/python
HEADLESS := env QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$(CURDIR)/build/run
DRAW := $(HEADLESS) $(RUN) -m tools.pictures

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

.PHONY: help setup demo test test-core test-newer test-release lint desktop screenshots install install-service install-maps-service uninstall-service serve-maps translations package docs check-plugin clean bench mutants

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-18s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(READY) ## install what is missing (QGIS, Xvfb, .venv); quick when nothing is

$(READY): pyproject.toml tools/setup.sh
	@tools/setup.sh

build/run:
	@mkdir -p -m 700 $@

demo: $(READY) build/run ## run the main job once, headless, on the sample site; see build/demo/ (PARTS=cluster, zalazone)
	@$(HEADLESS) $(RUN) -m tools.demo $(PARTS)

test: $(READY) build/run ## run every test, style and import rules included, headless
	@$(HEADLESS) $(RUN) -m pytest -q -rfEs $(SIDE_BY_SIDE) --durations=5 --durations-min=1 $(ARGS)

test-release: $(READY) build/run ## run before a release: every test on everything; one that would be skipped fails
	@$(HEADLESS) $(RUN) -m pytest -q -rfE $(SIDE_BY_SIDE) --release $(ARGS)

test-core: $(READY) ## run in a few minutes what needs neither QGIS nor database servers nor a display
	@$(RUN) -m pytest -q -rfE -p no:pytest_qgis --core -n 2 --dist loadfile --no-loadscope-reorder $(ARGS)

test-newer: ## run every test on the newer QGIS of Debian forky, in a root folder of its own (as root)
	@tools/newer.sh

lint: $(READY) build/run ## check style, types and import rules only
	@$(HEADLESS) $(RUN) -m pytest -q tests/packaging/test_style.py

desktop: $(READY) ## open QGIS Desktop with the plugin, the sample site and three driving robots
	@$(RUN) -m tools.desktop

screenshots: $(READY) build/run ## make the pictures in docs/images, in real windows under Xvfb
	@$(RUN) -m tools.desktop --screenshot docs/images/desktop.png
	@$(RUN) -m tools.walkthrough --pictures docs/images
	@$(RUN) -m tools.roles_picture
	@$(DRAW).robot_maps
	@$(DRAW).cones
	@$(DRAW).assignment
	@$(DRAW).supervisors
	@$(RUN) -m tools.cone_plan_pictures
	@$(DRAW).roads
	@$(DRAW).stored_loop
	@$(DRAW).road_surfaces

install: $(READY) ## put the plugin into your QGIS profile (PROFILE=name, LINK=1 links this folder)
	@$(RUN) -m tools.install_plugin --profile "$(PROFILE)" $(if $(LINK),--link)

install-service: ## put the gateway on this computer as a systemd service (DESTDIR=, PREFIX=/opt/robot-bridge)
	@tools/service.sh install

install-maps-service: ## put make serve-maps on this computer as a systemd service beside it; docs/services.md
	@tools/service.sh install-maps

uninstall-service: ## take these services away; settings and data stay
	@tools/service.sh uninstall

serve-maps: $(READY) ## serve a project and the fleet as WMS, WMTS, WFS (ARGS="--fleet fleet.vrt --port 8790"); docs/services.md
	@$(RUN) tools/serve_maps.py $(ARGS)

translations: $(READY) ## bring resources/translations up to date with the source
	@$(RUN) -m tools.translations

package: $(READY) ## build the plugin's zip for plugins.qgis.org, and the gateway's wheel and sdist
	@$(RUN) -m tools.package
	@$(RUN) -m tools.gateway_package

docs: $(READY) ## build these guides as a site, build/site
	@$(RUN) -m tools.documentation

check-plugin: $(READY) ## run on the plugin's zip what plugins.qgis.org runs on it; takes two minutes
	@$(RUN) -m tools.plugin_checks

bench: $(READY) ## measure on the real data beside the project (PARTS=maps ..., MINUTES=5, TRIAL=1); see docs/benchmarks.md
	@$(RUN) -m benchmarks $(PARTS)

mutants: $(READY) ## change what stops robots in every way that a test must notice (ARGS=emergency); docs/benchmarks.md
	@.venv/bin/pip install -q $$($(RUN) -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["mutation"])')
	@nice -n 10 $(RUN) -m tools.mutants $(ARGS)

clean: ## remove build/ (what was built, not the environment)
	rm -rf build
