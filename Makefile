# Every target sets up what it needs by itself, once; see tools/setup.sh.
# Settings: PYTHON=/path/to/python3.12   WORKERS=2   PYTEST_FLAGS="-k drop"

VENV := .venv
EXTRAS := .venv-extras
BIN := $(VENV)/bin
WORKERS ?= 2
PYTEST_FLAGS ?=
DEMO := runs/demo
# Neighbours stay in one worker, which makes their rooms once; who is done takes from the other.
PYTEST := $(BIN)/pytest -n $(WORKERS) --dist worksteal

export VENV
# Silences a notice about the future of mkdocs.
export NO_MKDOCS_2_WARNING = 1
# Tests start many processes: what one of them has compiled is read by the next.
export PYTHONDONTWRITEBYTECODE =
ifdef PYTHON
export PYTHON
endif

.DEFAULT_GOAL := help
.PHONY: help demo test test-all test-extras check format docs bench venv clean
# Two set-ups at once would write to the same environment.
.NOTPARALLEL:

help: ## Show this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed 's/:.*## /|/' | \
		while IFS='|' read -r name text; do printf '  make %-11s %s\n' "$$name" "$$text"; done

demo: $(VENV)/.package $(VENV)/.gl ## Watch the built-in baseline carry out an instruction
	@rm -rf $(DEMO)
	@$(BIN)/adamo-vh run "Pick the glass then place it next to the plate" \
		--scene s1 --model baseline --out $(DEMO)
	@find $(CURDIR)/$(DEMO) -name '*.html' -exec printf '\nOpen in a browser: %s\n' {} +

test: $(VENV)/.dev $(VENV)/.gl ## Run the tests, without the slow ones
	@$(PYTEST) -m "not slow and not extras" $(PYTEST_FLAGS)

test-all: $(VENV)/.dev $(VENV)/.gl ## Run all tests
	@ADAMO_VH_EXPLORE=1 $(PYTEST) -m "not extras" $(PYTEST_FLAGS)

test-extras: $(EXTRAS)/.extras ## Run the tests of large extras, in an environment of their own
	@$(EXTRAS)/bin/pytest -m extras $(PYTEST_FLAGS) $$(grep -rl --include="*.py" "mark\.extras" tests)

check: $(VENV)/.dev ## Formatting, lint, types, layers and docs, as CI does
	@failed=; for gate in "ruff format --check ." "ruff check ." "mypy" "lint-imports --no-logo" "mkdocs build --quiet"; do \
		echo "==> $$gate"; $(BIN)/$$gate || failed="$$failed [$$gate]"; \
	done; [ -z "$$failed" ] || { echo "==> Failed:$$failed"; exit 1; }

docs: $(VENV)/.dev ## Build the documentation as a site, in .cache/site
	@$(BIN)/mkdocs build --quiet
	@printf "Open in a browser: %s\n" "$(CURDIR)/.cache/site/index.html"

format: $(VENV)/.dev ## Put the code in order: formatting, imports, safe fixes
	@$(BIN)/ruff check --fix .
	@$(BIN)/ruff format .

bench: $(VENV)/.package $(VENV)/.gl ## Measure speed; each script prints one JSON object
	@for script in $$(grep -l -e '"--json"' benchmarks/*.py); do \
		echo "==> $$script"; \
		$(BIN)/python "$$script" --json || exit 1; \
	done

venv: $(VENV)/.dev ## Only set up .venv, with the tools for tests and checks

clean: ## Remove the environment, caches and demo runs; other runs stay
	rm -rf $(VENV) $(EXTRAS) .cache .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	rm -rf build dist $(DEMO)
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +

# The stamps remember what is set up; a change of the dependencies makes it again.
$(VENV)/.package: pyproject.toml
	@tools/setup.sh package
	@touch $@

$(VENV)/.dev: pyproject.toml
	@tools/setup.sh dev
	@touch $@ $(VENV)/.package

$(EXTRAS)/.extras: pyproject.toml
	@VENV=$(EXTRAS) tools/setup.sh extras
	@VENV=$(EXTRAS) tools/setup.sh gl
	@touch $@

$(VENV)/.gl: | $(VENV)/.package
	@tools/setup.sh gl
	@touch $@
