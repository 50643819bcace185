# make setup   the virtual environment, and a software Vulkan driver when the machine has no adapter
# make demo    renders the gallery into out/demo
# make test    the tests, without the slow ones        make test-slow   all of them
# make check   ruff and mypy                           make bench       the timings

SHELL := /bin/bash
PY := .venv/bin/python
QUIET := -qq --disable-pip-version-check
OUT ?= out/demo
SUITE ?= eikonal
WORKERS ?= 2

.NOTPARALLEL:
.PHONY: help setup adapter demo test test-slow check bench

help:
	@sed -n 's/^# make/make/p' Makefile

# The stamps hold the environment: what is installed is looked at again only when pyproject.toml changes.
.venv/.created:
	@python="$$(tools/find_python.sh)" && tools/create_venv.sh "$$python" .venv
	@touch $@

.venv/.ready: pyproject.toml .venv/.created
	@echo "installing pellucid into .venv (a minute, the first time)"
	@$(PY) -m pip install $(QUIET) -e .
	@touch $@

.venv/.ready-dev: pyproject.toml .venv/.created
	@echo "installing pellucid and its test tools into .venv (a minute, the first time)"
	@$(PY) -m pip install $(QUIET) -e '.[dev]'
	@touch .venv/.ready $@

adapter: .venv/.ready
	@tools/ensure_adapter.sh $(PY)

setup: .venv/.ready-dev adapter
	@echo "ready: .venv/bin/pellucid --help"

demo: .venv/.ready adapter
	@.venv/bin/pellucid demo --output $(OUT)

test: .venv/.ready-dev adapter
	@$(PY) -m pytest -n $(WORKERS) -m 'not slow'

test-slow: .venv/.ready-dev adapter
	@$(PY) -m pytest

check: .venv/.ready-dev
	@$(PY) -m ruff check .
	@$(PY) -m ruff format --check .
	@$(PY) -m mypy

bench: .venv/.ready adapter
	@.venv/bin/pellucid bench $(SUITE)
