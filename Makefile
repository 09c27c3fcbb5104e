# make campaign   everything from nothing: environment, data, the whole study, report
# make test       everything from nothing: environment, all tests but the long ones
# make test-long  the tests of whole studies, blind tests, statistics, kills, full disks, compilation;
#                 PART=1/3 make test-long runs a third of their files
# make test-fast  the tests that neither run the solver nor Snakemake
# make docs       the documentation as a site, build/docs/index.html
# make test-slurm the study smoke on a Slurm of virtual nodes; needs root, installs Debian's packages
# STUDY=my.yaml make campaign runs your own study; CORES=n sets the number of cores.

PYTHON ?= python3
CORES ?= 2
PART ?= 1/1
VENV := .venv
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)
# Many containers set this; then each process compiles all sources again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: campaign test test-fast test-long test-slurm verification docs data lint bench format lock clean

$(VENV)/installed: requirements.lock pyproject.toml
	@echo "Setting up the environment in $(VENV) (about a minute)"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "Python 3.11 or newer is needed; set PYTHON=python3.xx"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

campaign: $(VENV)/installed
	@study="$(STUDY)"; \
	if [ -z "$$study" ]; then \
		if reason=$$(pyrofit data where 2>&1); then \
			study=config/paper.yaml; echo "Study: paper, on the measured files in $$reason"; \
		elif [ -n "$$PYROFIT_DATA_DIR" ]; then \
			echo "$$reason"; echo "Correct PYROFIT_DATA_DIR, or unset it for synthetic data."; exit 2; \
		else \
			study=config/twin.yaml; \
			echo "Study: twin, on synthetic data of known truth, because the measured files are not here:"; \
			echo "  $${reason#error: }."; \
			echo "Then make campaign runs the published study."; \
		fi; \
	fi; \
	pyrofit check "$$study" && pyrofit run "$$study" --cores $(CORES)

test: $(VENV)/installed
	pytest -n $(CORES) --dist loadfile --no-loadscope-reorder -m "not long"

test-long: $(VENV)/installed
	pytest -n $(CORES) --dist loadfile --no-loadscope-reorder -m long --part $(PART)

test-fast: $(VENV)/installed
	pytest -n $(CORES) -m "not (slow or solver or long)"

test-slurm: $(VENV)/installed
	pytest --slurm -s tests/slurm

verification: $(VENV)/installed
	pytest tests/verification --page docs/verification

EXPLORED := docs/figures/explore/smoke.html

$(EXPLORED): $(VENV)/installed config/smoke.yaml $(wildcard src/pyrofit_explore/*)
	pyrofit explore config/smoke.yaml --static $@ --sliders dh

docs: $(VENV)/installed $(EXPLORED)
	sphinx-build --fail-on-warning --keep-going --quiet -b html -c docs/site -d build/doctrees . build/docs
	@echo "The site: build/docs/index.html"

data: $(VENV)/installed
	pyrofit data fetch

lint: $(VENV)/installed
	ruff check .
	ruff format --check .
	mypy
	snakefmt --check Snakefile workflow src
	codespell
	python tools/plain_words.py --check
	! grep -n "://" requirements.lock

bench: $(VENV)/installed
	python benchmarks/speed.py

format: $(VENV)/installed
	ruff check --fix .
	ruff format .
	snakefmt Snakefile workflow src

lock:
	uv pip compile pyproject.toml --extra dev --extra docs --extra slurm --universal --python-version 3.11 --generate-hashes \
		--no-emit-index-url --no-header --no-annotate --quiet -o requirements.lock

clean:
	rm -rf results .snakemake
