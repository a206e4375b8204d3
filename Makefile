# Everything a developer or a new user runs. Each target makes what it needs: .venv, the installed package, the C builds.
# Needed beforehand: a C11 compiler, make, Python >= 3.11 with its headers and the venv module.

PYTHON ?= python3
VENV   := .venv
BUILD  := build
PY     := $(VENV)/bin/python
PIP    := $(PY) -m pip --disable-pip-version-check --quiet

# The venv's meson, ninja and numpy-config come before any other.
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)

# What the installed package and the C tests are made from. The lists are kept in files that change only when a list
# does, so that a removed file counts as a change too.
SOURCES := $(sort $(shell find csrc python -type f \( -name '*.[ch]' -o -name '*.py' -o -name '*.pyi' -o -name py.typed \
             -o -name '*.csv' -o -name '*.json' -o -name '*.toml' -o -name '*.js' -o -name '*.css' -o -name '*.html' \
             -o -name meson.build \)) meson.build meson.options pyproject.toml)
C_TESTS := $(sort $(wildcard tests/c/*))
C_FILES  = $(wildcard csrc/*.[ch] csrc/binding/*.[ch] tests/c/*.[ch])

# $(call keep,text) writes a target that holds the text, unless it holds it already.
keep = @echo '$(1)' | cmp -s - $@ || { mkdir -p $(@D); echo '$(1)' >$@; }

# $(call requirements,build) or $(call requirements,test): that list of pyproject.toml, one requirement a line.
requirements = $(PY) -c 'import sys, tomllib; p = tomllib.load(open("pyproject.toml", "rb")); \
  lists = p["project"]["optional-dependencies"] | {"build": p["build-system"]["requires"]}; \
  print(*lists[sys.argv[1]], sep="\n")' $(1)

# The C files compile without a warning under gcc, and under clang where it is installed.
COMPILERS := lint $(if $(shell command -v clang),lint-clang)

# The sanitizers' libraries must be in the process first, and the C++ library whose exceptions they watch with them.
SANITIZERS = $(foreach library,libasan.so libubsan.so libstdc++.so.6,$(shell cc -print-file-name=$(library)))

.PHONY: demo test ctest pytest asan coverage bench peers lint verify clean always

# Two pip runs on one environment do not mix, and pytest has the last word.
.NOTPARALLEL:

demo: $(VENV)/package
	$(PY) examples/motor.py

test: ctest pytest

# One thread of BLAS in each of the processes: theirs would only wait for one another.
pytest: $(VENV)/package $(VENV)/test
	OPENBLAS_NUM_THREADS=1 $(PY) -m pytest -n auto --dist loadfile

ctest: $(BUILD)/ctest/build.ninja
	meson compile -C $(BUILD)/ctest
	meson test -C $(BUILD)/ctest --print-errorlogs

# The C tests, then the tests of the binding and of what calls C most directly, both against code built with both
# sanitizers. The Python tests use a sanitized copy of the package; the interpreter's own leaks do not count.
ASAN_TESTS := tests/core tests/bearing/test_kernel.py tests/bearing/test_imperfections.py tests/cms/test_part_march.py \
  tests/analysis/test_march.py tests/analysis/test_exact_step.py tests/analysis/test_softening_march.py \
  tests/analysis/test_steady_borne.py tests/analysis/test_abreast.py tests/analysis/test_film_march.py \
  tests/bearing/test_film_memory.py tests/sound/test_radiation.py tests/analysis/test_beginnings.py \
  tests/analysis/test_bands.py tests/analysis/test_steady_softening.py tests/analysis/test_softening_zones.py \
  tests/analysis/test_film_response.py tests/parts/test_flexible_bore.py tests/parts/test_bore_of_a_solid.py
asan: $(BUILD)/asan/build.ninja $(VENV)/package $(VENV)/test
	meson compile -C $(BUILD)/asan
	meson test -C $(BUILD)/asan --print-errorlogs
	meson install -C $(BUILD)/asan --quiet
	LD_PRELOAD="$(SANITIZERS)" ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1 \
	  PYTHONMALLOC=malloc PYTHONPATH=$(BUILD)/asan/site OPENBLAS_NUM_THREADS=1 \
	  $(PY) -m pytest -n auto --dist loadfile --capture=sys $(ASAN_TESTS)

# Lines of Python and of C that the C tests and the quick Python tests run through, the least covered files first.
# The Python tests use a copy of the package whose extension counts lines.
coverage: $(BUILD)/coverage/build.ninja $(VENV)/package $(VENV)/test $(VENV)/coverage
	find $(BUILD)/coverage -name '*.gcda' -delete
	meson compile -C $(BUILD)/coverage
	meson test -C $(BUILD)/coverage --print-errorlogs
	meson install -C $(BUILD)/coverage --quiet
	PYTHONPATH=$(BUILD)/coverage/site COVERAGE_FILE=$(BUILD)/coverage/python.data \
	  $(PY) -m coverage run --source=bearingdyn -m pytest
	cd $(BUILD)/coverage/site && \
	  COVERAGE_FILE=../python.data $(CURDIR)/$(PY) -m coverage report --sort=cover --skip-covered
	$(PY) -m gcovr --root . --filter csrc/ --sort=uncovered-percent --print-summary $(BUILD)/coverage

bench: $(VENV)/package $(VENV)/test
	$(PY) benchmarks/transient.py --json
	$(PY) benchmarks/exact.py --json
	$(PY) benchmarks/harmonic.py --json
	$(PY) benchmarks/bearing.py --json
	$(PY) benchmarks/memory.py --json
	$(PY) benchmarks/study.py --json
	$(PY) benchmarks/sound.py --json
	$(PY) benchmarks/steady.py --json

# Other programs beside this one; each that is not installed is named and skipped.
peers: $(VENV)/package $(VENV)/test
	$(PY) benchmarks/peers_fem.py
	$(PY) benchmarks/peers.py

lint: $(VENV)/package $(VENV)/lint $(COMPILERS:%=$(BUILD)/%/build.ninja)
	ruff check
	ruff format --check
	clang-format --dry-run -Werror $(C_FILES)
	mypy
	stubtest bearingdyn --mypy-config-file pyproject.toml --allowlist tests/stubtest.allow
	set -e; for build in $(COMPILERS); do meson compile -C $(BUILD)/$$build; done

# The slow tests, and VERIFICATION.md anew: case, source, expected, computed, error.
verify: $(VENV)/package $(VENV)/test $(VENV)/docs
	$(PY) -m pytest -m slow
	PYTHONPATH=examples:benchmarks $(PY) tests/verification.py

# The documentation, in build/docs; a warning is an error. The notebooks are run where they changed: a minute or two.
.PHONY: docs
docs: $(VENV)/package $(VENV)/docs
	$(PY) -m sphinx -W --keep-going -n -q -d $(BUILD)/doctrees docs $(BUILD)/docs
	@echo open $(BUILD)/docs/index.html

# A source archive that needs no git, a wheel built from it, and the wheel tested in an empty environment, where no
# compiler is found: published cases, the ten lines of a ready machine, its drawing and its model file.
.PHONY: wheel
DIST := $(BUILD)/dist
wheel: $(VENV)/tools
	rm -rf $(DIST) && mkdir -p $(DIST)/source $(DIST)/empty
	$(PY) tests/make_sdist.py $(DIST)
	tar -xzf $(DIST)/bearingdyn-*.tar.gz -C $(DIST)/source --strip-components=1
	cd $(DIST)/source && $(CURDIR)/$(PY) -m pip --disable-pip-version-check --quiet wheel --no-deps \
	  --no-build-isolation --wheel-dir .. .
	$(PYTHON) -m venv $(DIST)/venv
	$(DIST)/venv/bin/python -m pip --disable-pip-version-check --quiet install $(DIST)/bearingdyn-*.whl
	cd $(DIST)/empty && CC=/nonexistent PATH=$(CURDIR)/$(DIST)/venv/bin $(CURDIR)/$(DIST)/venv/bin/python \
	  $(CURDIR)/tests/wheel_trial.py

# A wheel for each Python of WHEEL_PYTHONS that runs on any Linux since 2014, tried in an empty environment; with
# WHEEL_MACHINE=aarch64 it is built for that processor, and its platform and symbols are checked.
.PHONY: wheels
WHEEL_PYTHONS ?= $(PYTHON)
WHEEL_MACHINE ?=
wheels: $(VENV)/tools
	$(PY) tests/make_wheels.py $(BUILD)/wheels $(WHEEL_PYTHONS) $(if $(WHEEL_MACHINE),--machine $(WHEEL_MACHINE))

clean:
	rm -rf $(VENV) $(BUILD) out docs/_static .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
	find python tests examples benchmarks notebooks docs -name __pycache__ -prune -exec rm -rf {} + 2>/dev/null || true

# The environment. Its build tools stand outside pip's isolated builds, so that rebuilding is incremental and
# the C tests use the same Meson, Ninja and NumPy as the package.
$(VENV)/tools: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed; set PYTHON=")'
	$(PY) -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV)
	$(call requirements,build) >$(VENV)/requirements.txt
	$(PIP) install --requirement $(VENV)/requirements.txt
	@touch $@

$(VENV)/package: $(SOURCES) $(BUILD)/sources.list $(VENV)/tools
	$(PIP) install --no-build-isolation --config-settings=build-dir=$(BUILD)/package .
	@rm -rf out/kept # of the package before
	@touch $@

$(VENV)/test $(VENV)/lint $(VENV)/coverage $(VENV)/docs: $(VENV)/%: $(VENV)/tools
	$(call requirements,$*) >$(VENV)/requirements.txt
	$(PIP) install --requirement $(VENV)/requirements.txt
	@touch $@

# The C builds: configured here, brought up to date by `meson compile`.
configure = meson setup $(if $(wildcard $@),--reconfigure) $(@D)

$(BUILD)/ctest/build.ninja: $(VENV)/tools $(BUILD)/tests.list
	$(configure) -Dctests=true

$(BUILD)/asan/build.ninja: $(VENV)/tools $(BUILD)/tests.list
	$(configure) -Dctests=true -Dbuildtype=debugoptimized -Db_sanitize=address,undefined -Db_lundef=false \
	  --prefix=$(CURDIR)/$(BUILD)/asan -Dpython.platlibdir=site -Dpython.purelibdir=site

$(BUILD)/coverage/build.ninja: $(VENV)/tools $(BUILD)/tests.list
	$(configure) -Dctests=true -Dbuildtype=debugoptimized -Db_coverage=true \
	  --prefix=$(CURDIR)/$(BUILD)/coverage -Dpython.platlibdir=site -Dpython.purelibdir=site

$(BUILD)/lint/build.ninja: $(VENV)/tools $(BUILD)/tests.list
	$(configure) -Dctests=true -Dwerror=true

$(BUILD)/lint-clang/build.ninja: $(VENV)/tools $(BUILD)/tests.list
	CC=clang $(configure) -Dctests=true -Dwerror=true

$(BUILD)/sources.list: always
	$(call keep,$(SOURCES))

$(BUILD)/tests.list: always
	$(call keep,$(C_TESTS))
