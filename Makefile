# Everything from a fresh clone: `make run` and `make test` do their own set-up, once.
# Needs git, make, and Python 3.10 to 3.12 with its venv module; writes inside the checkout only.
SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DEFAULT_GOAL := help
.NOTPARALLEL:

PYTHON ?= python3
VENV := .venv
PEERS := .venv-peers
OLDEST := .venv-oldest
SITE := .venv-site
SITE_PACKAGES := 'mkdocs-material>=9.5,<10' 'mkdocstrings[python]>=0.26'
VENV_EXTRAS := ros,opencv,bags,operator,test,build,fit
PEERS_EXTRAS := ros,bags,evaluate
BUILT := install/.built
SOURCES := $(shell find het_ros config launch resource -type f -not -name '*.pyc' 2>/dev/null)

# The order matters: the venv's Python, then its ROS packages, then this workspace over them.
# A sourced ROS from apt would mix two Pythons' packages, so its variables are left outside; and
# so is the mark of ROS's wheels that LD_LIBRARY_PATH has been set, since it is set anew.
CLEAN := unset PYTHONPATH PYTHONHOME LD_LIBRARY_PATH COLCON_PREFIX_PATH ROS_DISTRO \
	_ROS_WHEELS_BOOTSTRAP_COMPLETE
ROS := $(CLEAN); source $(VENV)/bin/activate; export AMENT_PREFIX_PATH="$$VIRTUAL_ENV"
WORKSPACE := $(ROS); source install/setup.bash
PEERS_SPACE := $(CLEAN); source $(PEERS)/bin/activate; export AMENT_PREFIX_PATH="$$VIRTUAL_ENV"; \
	source install/setup.bash

.PHONY: help setup build run operator test test-oldest fuzz faults soak evaluate compare scenes fit \
	bench docs site picture dist count coverage format clean

help: ## What there is to make
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 14
	@echo
	@echo 'make run [VIDEO=file INIT=x,y,w,h | SEQUENCE=folder] [NETWORK=folder] [OUT=out/run]'
	@echo 'make operator [VIDEO=file | SEQUENCE=folder] [NETWORK=folder] [OPERATOR="-o host:=0.0.0.0"]; make run WEB=1'
	@echo 'make evaluate DATA=folder [OUT=out/evaluate] [TRACKERS=het,csrt] [SEEDS=3]'
	@echo '     [PROTOCOL=ope|tre|sre|passes|half_rate|realtime|restart] [SEQUENCES=a,b] [SCHEDULER=tcp://host:8786]'
	@echo '     [MODELS=folder] [BOXES="NAME=folder ..."]'
	@echo 'make compare A=folder B=folder[:tracker] [OUT=folder] [DATA=folder]'
	@echo 'make scenes [OUT=out/scenes] [NETWORK=folder] [SCENES="--seeds 20 --stories lookalike_crosses"]'
	@echo 'make fit DATA=folder [MODELS=folder] [SEQUENCES=a,b] [SEEDS=3] [FIT="--off 1 --again"]'
	@echo 'make bench [OUT=out/bench] [DATA=folder] [MODELS=folder]'
	@echo 'make fuzz [MINUTES=10] [OUT=out/fuzz]'
	@echo 'make soak [MINUTES=60] [OUT=out/soak] [SOAK="--size 1280x720 -p seed:=3"]'

# Set-up -------------------------------------------------------------------------------------

setup: $(VENV)/.ready ## The environment .venv: ROS 2 Jazzy and all that runs and tests it
build: $(BUILT) ## colcon build into install/

define make_venv
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
		{ echo "$(PYTHON) is too old or missing: install Python 3.10 to 3.12, or name it: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
		{ echo "Python's venv module is missing: sudo apt install python3-venv"; exit 1; }
	test -x $(1)/bin/python || $(PYTHON) -m venv $(1)
	$(CLEAN); $(1)/bin/python -m pip install --quiet --disable-pip-version-check -e '.[$(2)]'
	@touch $(1)/.ready
endef

$(VENV)/.ready: setup.py package.xml
	@echo 'Setting up $(VENV): ROS 2 Jazzy and tools from PyPI, about two minutes and 1.3 GB'
	$(call make_venv,$(VENV),$(VENV_EXTRAS))

$(PEERS)/.ready: setup.py
	@echo 'Setting up $(PEERS): the same with the OpenCV that has the peers (opencv-contrib)'
	$(call make_venv,$(PEERS),$(PEERS_EXTRAS))

$(OLDEST)/.ready: setup.py test/oldest.txt
	@echo 'Setting up $(OLDEST): ROS 2 Jazzy with the oldest NumPy, OpenCV and filterpy'
	$(call make_venv,$(OLDEST),ros)
	$(CLEAN); $(OLDEST)/bin/python -m pip install --quiet --disable-pip-version-check -r test/oldest.txt
	@touch $@

$(SITE)/.ready: setup.py
	@echo 'Setting up $(SITE): MkDocs'
	test -x $(SITE)/bin/python || $(PYTHON) -m venv $(SITE)
	$(CLEAN); $(SITE)/bin/python -m pip install --quiet --disable-pip-version-check $(SITE_PACKAGES)
	@touch $@

$(BUILT): $(VENV)/.ready package.xml setup.py setup.cfg $(SOURCES)
	$(ROS); colcon build --packages-select het_ros --event-handlers console_stderr- summary-
	@touch $@

# Use ----------------------------------------------------------------------------------------

VIDEO ?=
INIT ?=
SEQUENCE ?=
NETWORK ?=
FPS ?=
FOOTAGE = $(if $(VIDEO),--video '$(VIDEO)') $(if $(SEQUENCE),--sequence '$(SEQUENCE)') \
	$(if $(FPS),--fps $(FPS)) $(if $(NETWORK),--network '$(NETWORK)')

run: OUT ?= out/run
run: $(BUILT) ## Follow the target of the recorded bag, or of your own footage; look into out/run
	@$(WORKSPACE); python -m $(if $(WEB),het_ros.operator.demo $(OPERATOR),het_ros.tools.run \
		$(if $(INIT),--init '$(INIT)')) $(FOOTAGE) --out '$(OUT)'

operator: WEB = 1
operator: OUT ?= out/operator
operator: run ## The same in a browser, to and fro: pick the target on the page whose address it tells

# Tests of many processes and of real time do not bear company; the others run side by side.
# A choice by PYTEST may leave nothing to do (pytest's exit code 5) for one of the two.
SIDE_BY_SIDE := test/tracking test/pages/test_examples.py test/pages/test_pages.py \
	test/pages/test_words.py test/scene test/evaluation test/fuzz test/test_copyright.py \
	test/tools/test_closed_loop.py test/tools/test_replay.py
PYTEST ?=
CHOSEN = $(PYTEST) $(if $(PYTEST),|| test $$? = 5)

test: $(BUILT) ## Style, types, import contracts, package.xml, all tests
	$(WORKSPACE); ruff check .
	$(WORKSPACE); ruff format --check --quiet .
	$(WORKSPACE); mypy
	$(WORKSPACE); lint-imports
	$(WORKSPACE); python -c 'from catkin_pkg.package import parse_package as p; print("package.xml is valid:", p("package.xml", warnings=[]))'
	$(WORKSPACE); python -m pytest -n logical --dist loadfile $(SIDE_BY_SIDE) $(CHOSEN)
	$(WORKSPACE); python -m pytest $(addprefix --ignore=,$(SIDE_BY_SIDE)) $(CHOSEN)

# Whole stories with the oldest versions tell nothing that the others do not, and take a minute.
OLDEST_TESTS := test/tracking --ignore=test/tracking/test_states.py \
	test/fuzz/test_conversions.py test/fuzz/test_core.py \
	$(addprefix test/ros/test_,images.py image_size.py messages.py optics.py depth.py stamps.py \
	session.py parameters.py tracker_node.py)

test-oldest: $(OLDEST)/.ready ## Core, conversions and node with NumPy 1.26 and OpenCV 4.6
	$(CLEAN); source $(OLDEST)/bin/activate; export AMENT_PREFIX_PATH="$$VIRTUAL_ENV"; \
		python -c 'import cv2, numpy; print("NumPy", numpy.__version__, "OpenCV", cv2.__version__)'; \
		python -m pytest -p no:cacheprovider -n logical --dist loadfile $(OLDEST_TESTS) $(PYTEST)

fuzz: MINUTES = 10
fuzz: OUT ?= out/fuzz
fuzz: $(BUILT) ## Random input for MINUTES=10: what breaks something is kept in out/fuzz
	@$(WORKSPACE); python test/fuzz/campaign.py --minutes $(MINUTES) --out '$(OUT)'

faults: $(BUILT) ## The faults that take minutes: a pulled cable (as root), a hundred signals
	@$(WORKSPACE); python -m pytest -m slow test/faults -s $(PYTEST)

soak: MINUTES = 60
soak: OUT ?= out/soak
soak: $(BUILT) ## The tracker for MINUTES=60 at 30 frames/s: memory, latency, files; passes or fails
	@$(WORKSPACE); python -m het_ros.faults.soak --minutes $(MINUTES) --out '$(OUT)' $(SOAK)

DATA ?=
PEER_OPTIONS = $(if $(TRACKERS),--trackers '$(TRACKERS)') $(if $(SEEDS),--seeds $(SEEDS)) \
	$(if $(PROTOCOL),--protocol $(PROTOCOL)) $(if $(SEQUENCES),--sequences '$(SEQUENCES)') \
	$(if $(SCHEDULER),--scheduler '$(SCHEDULER)') $(if $(PUBLISHED),--published '$(PUBLISHED)') \
	$(if $(MODELS),--models '$(MODELS)') $(foreach pair,$(BOXES),--boxes '$(pair)')

evaluate: OUT ?= out/evaluate
evaluate: $(BUILT) $(PEERS)/.ready ## Score this tracker and OpenCV's on DATA=folder
	@test -n '$(DATA)' || { echo 'make evaluate DATA=folder: name a folder of sequences (OTB or VOT layout)'; exit 2; }
	@$(PEERS_SPACE); python -m het_ros.evaluation.cli --data '$(DATA)' --out '$(OUT)' $(PEER_OPTIONS) $(EVALUATE)

compare: $(BUILT) ## Judge a change: paired differences of the results folders A and B
	@test -n '$(A)' -a -n '$(B)' || { echo 'make compare A=out/before B=out/after: name two folders that make evaluate wrote'; exit 2; }
	@$(WORKSPACE); python -m het_ros.evaluation.cli --compare '$(A)' '$(B)' $(if $(OUT),--out '$(OUT)') $(if $(DATA),--data '$(DATA)')

scenes: OUT ?= out/scenes
scenes: $(BUILT) ## Is it honest? Rendered stories with exact truth: hidden, gone, look-alikes
	@$(WORKSPACE); python -m het_ros.tools.scenes --out '$(OUT)/scenes.json' \
		$(if $(NETWORK),--network '$(NETWORK)') $(SCENES)

fit: OUT ?= out/fit
fit: $(VENV)/.ready ## Fit the tracker's calibration to DATA=folder; writes het_ros/tracking/fitted.py
	@test -n '$(DATA)' || { echo 'make fit DATA=folder [MODELS=folder]: name a folder of sequences (OTB or VOT layout)'; exit 2; }
	@$(ROS); python -m het_ros.tools.fit --data '$(DATA)' --plot '$(OUT)/fit.png' $(if $(MODELS),--models '$(MODELS)') \
		$(if $(SEQUENCES),--sequences '$(SEQUENCES)') $(if $(SEEDS),--seeds $(SEEDS)) $(FIT)

bench: OUT ?= out/bench
bench: $(BUILT) $(PEERS)/.ready ## Speed of the core and of the node, as ratios to the peers
	@$(PEERS_SPACE); python -m het_ros.bench.cli --out '$(OUT)' $(if $(DATA),--data '$(DATA)') \
		$(if $(MODELS),--models '$(MODELS)') $(BENCH)

docs: $(BUILT) ## Write what is generated: parameters, and the map of the imports
	@$(WORKSPACE); python -m het_ros.ros.reference .; python test/pages/import_map.py

site: $(SITE)/.ready ## The pages as a web site in out/site; broken links are errors
	@NO_MKDOCS_2_WARNING=1 $(SITE)/bin/mkdocs build --strict --quiet
	@echo 'open out/site/index.html'

dist: ## Wheel and sdist into out/dist, each tried in an empty environment
	@$(CLEAN); $(PYTHON) .ci/dist.py out/dist

picture: $(BUILT) ## The moving picture of the README, from the recorded bag
	@$(WORKSPACE); python -m het_ros.tools.replay bags/follow_walk --out out/picture; \
		python -m het_ros.tools.picture out/picture/track.mp4 docs/images/follow_walk.webp

coverage: $(BUILT) ## Which lines of the core and the node the tests reach; states it, gates nothing
	@$(WORKSPACE); python -m pip install --quiet --disable-pip-version-check pytest-cov; \
		python -m pytest -q --cov=het_ros.tracking --cov=het_ros.ros --cov-report=term:skip-covered \
		test/tracking test/ros $(PYTEST)

count: ## Lines, parameters and module constants of the tracker; lines of all parts, words of pages
	@$(PYTHON) .ci/count.py
	@for part in het_ros/*/ test examples; do \
		printf '%7d lines  %s\n' $$(find $$part -name '*.py' -exec cat {} + | wc -l) $$part; done
	@wc -l README.md; wc -w README.md CONTRIBUTING.md $$(find docs -name '*.md' | sort)

format: $(VENV)/.ready ## Format the code
	$(ROS); ruff check --fix .; ruff format .

clean: ## Remove what was built and measured; the environments stay
	rm -rf build install log out
