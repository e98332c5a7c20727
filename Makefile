# opshock: what a user and a developer run. `make help` lists the targets.
SHELL := /bin/bash
OPSHOCK := target/release/opshock
JOBS ?= $(shell nproc)

.DEFAULT_GOAL := help
.PHONY: help bootstrap build fig13 study test check fmt clippy doc bench verify verify-film verify-effects verify-durability verify-store verify-search verify-slurm verify-hard verify-scenes verify-fuzz verify-accuracy verify-mounts verify-faults verify-hdf5 verify-klu accuracy figures bench-against

help: ## this list
	@grep -hE '^[a-z0-9-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 20

bootstrap: ## install what the machine lacks (apt; --verify adds outside checks)
	@scripts/bootstrap

build: bootstrap ## build the optimised program
	cargo build --release --locked -p opshock

.PHONY: results
results: build ## every committed result anew, in order, with its time in results/times.csv (hours; goes on where it stopped): ONLY="fig13 fig13-converged fig13-stiffness fig13-geometry clearance damage touch thresholds minimum-height qualify yield worth answers paper match-paper accuracy bench presets finest" (needs python3)
	scripts/results --jobs $(JOBS) $(ONLY)

# Exit code 4: some points are open, which the table says.
OR_OPEN := || test $$? -eq 4
YIELD = $(OPSHOCK) yield studies/yield/study.toml --spec studies/yield/operating.toml -j $(JOBS) --tolerances
QUALIFY = $(OPSHOCK) qualify studies/qualify/study.toml -j $(JOBS) --spec

fig13: build ## the paper's Fig. 13: sweep, table, report and plots in results/fig13/
	@$(MAKE) --no-print-directory study NAME=fig13

.PHONY: fig13-converged
fig13-converged: build ## Fig. 13 with converged disk modes, and the paper's statements judged by it, in results/fig13-converged/
	@$(MAKE) --no-print-directory study NAME=fig13-converged
	$(OPSHOCK) claims studies/fig13-converged/study.toml --critical results/fig13-converged/table.csv --out results/fig13-converged --quiet -j $(JOBS) > /dev/null

accuracy: build ## what accuracy costs on fig13-stiffness: refinement studies, plots and table in results/accuracy/
	$(OPSHOCK) accuracy studies/fig13-stiffness/study.toml --at none:2:- --at deformable:2:- --out results/accuracy

# The preset fine takes hours: two points give its time beside the other presets', and all of fig13-stiffness is swept by a target of its own.
FINE_SUBSET := --set 'ramp.models=["none"]' --set 'pulse.widths_ms=[1.0]' --set search.tolerance_pct=0.1
FINEST := --set resolution.preset=fine --set search.tolerance_pct=0.1 --set search.max_refinements=3

.PHONY: accuracy-presets accuracy-finest
accuracy-finest: build ## fig13-stiffness at the preset fine, refined, in results/accuracy/fig13-0.1/ (40 minutes at a time; goes on where it stopped)
	$(OPSHOCK) sweep studies/fig13-stiffness/study.toml --store results/accuracy/fig13-0.1/fig13.opshock $(FINEST) --budget 40m -j $(JOBS) $(OR_OPEN)
	$(OPSHOCK) report results/accuracy/fig13-0.1/fig13.opshock --out results/accuracy/fig13-0.1 $(OR_OPEN)

accuracy-presets: build ## time against the largest uncertainty of each resolution preset on fig13-stiffness, in results/accuracy/presets.md (needs python3; goes on where it stopped)
	scripts/presets --program $(OPSHOCK) --jobs $(JOBS) --presets coarse,coarse+3,standard,standard+3
	scripts/presets --program $(OPSHOCK) --jobs $(JOBS) --presets fine,fine+3 -- $(FINE_SUBSET)

# The drive of both studies is one: what `make fig13` found is Fig. 13 of the figures and of the statements.
CRITICAL := --critical results/fig13/table.csv
figures: build ## the paper's Fig. 1 to 13 in results/paper/ (SVG, PNG, CSV)
	$(OPSHOCK) figures studies/paper-cases/study.toml $(CRITICAL) --out results/paper

.PHONY: claims claims-sensitivity verify-report
claims: build ## the paper's statements judged, in results/paper/claims.md
	$(OPSHOCK) claims studies/paper-cases/study.toml $(CRITICAL) --out results/paper --quiet -j $(JOBS) > /dev/null

claims-sensitivity: build ## the same, and which parameters each depends on: tornado plot in results/paper/sensitivity.md (2 minutes, resumes)
	$(OPSHOCK) claims studies/paper-cases/study.toml $(CRITICAL) --out results/paper --sensitivity results/paper/sensitivity -j $(JOBS) > /dev/null

.PHONY: match-paper
match-paper: build ## which drive makes the paper's statements true: in results/match-paper/ (at most 3 hours at a time; goes on where it stopped)
	$(OPSHOCK) match studies/paper-cases/match.toml --store results/match-paper/match.opshock --out results/match-paper --budget 3h -j $(JOBS)

study: build ## run another study: make study NAME=drive-2.5in
	@test -n "$(NAME)" || { echo "make study NAME=<folder under studies/>"; exit 2; }
	$(OPSHOCK) sweep studies/$(NAME)/study.toml --store results/$(NAME)/$(NAME).opshock -j $(JOBS) $(OR_OPEN)
	$(OPSHOCK) report results/$(NAME)/$(NAME).opshock --out results/$(NAME) $(OR_OPEN)

.PHONY: qualify
qualify: build ## a drive that passes a specification, one that fails, one that is undecided, and a damage boundary: results/qualify/ (minutes, resumes)
	$(QUALIFY) studies/qualify/operating-boundary.toml --store results/qualify/passes.opshock --out results/qualify/passes
	$(QUALIFY) studies/qualify/operating.toml --set ramp.clearance_um=40 --store results/qualify/fails.opshock --out results/qualify/fails || test $$? -eq 8
	$(QUALIFY) studies/qualify/operating-433g.toml --store results/qualify/undecided.opshock --out results/qualify/undecided $(OR_OPEN)

# Of today's drive and of the one that Fig. 13 was made with before.
THRESHOLDS = --set pulse.widths_ms=2 --set 'failure.clearance_nm=[0.0,0.6,1.0]' --set 'resolution.min_film_height_nm=[0.3,0.15,0.075]' --set search.uncertainty=false -j $(JOBS)
.PHONY: thresholds
thresholds: build ## critical shocks by the clearance that is called failure and by the minimum film height, of two drives: results/thresholds/ (minutes, resumes)
	$(OPSHOCK) sweep studies/fig13/study.toml $(THRESHOLDS) --store results/thresholds/thresholds.opshock $(OR_OPEN)
	$(OPSHOCK) report results/thresholds/thresholds.opshock --out results/thresholds --x failure.clearance_nm $(OR_OPEN)
	$(OPSHOCK) sweep studies/fig13-stiffness/study.toml --set 'ramp.models=["none"]' $(THRESHOLDS) --store results/thresholds/stiffness.opshock $(OR_OPEN)
	$(OPSHOCK) report results/thresholds/stiffness.opshock --out results/thresholds/stiffness --x failure.clearance_nm $(OR_OPEN)

HEIGHTS = $(OPSHOCK) sweep studies/fig13/study.toml --set 'ramp.models=["none"]' --set search.uncertainty=false --set 'asperity_contact.roughness_nm=[0.3,0.6]' \
	--set 'resolution.min_film_height_nm=[0.3,0.15]' --set failure.criterion=damage --set failure.damage.overlap_nm=2.0 -j $(JOBS)
.PHONY: minimum-height
minimum-height: build ## critical shocks of damage between rough surfaces, with the minimum film height and with half of it: results/minimum-height/ (23 minutes of a core, resumes)
	$(HEIGHTS) --set search.monotonicity_scan=full --set 'search.amplitude_g={min=370,max=799}' --store results/minimum-height/below-799g.opshock $(OR_OPEN)
	$(OPSHOCK) report results/minimum-height/below-799g.opshock --out results/minimum-height/below-799g $(OR_OPEN)
	$(HEIGHTS) --set 'pulse.widths_ms=[1.5,2.0,3.0]' --set 'pulse.signs=["-"]' --set 'search.amplitude_g={min=799,max=2000}' --store results/minimum-height/from-799g.opshock $(OR_OPEN)
	$(OPSHOCK) report results/minimum-height/from-799g.opshock --out results/minimum-height/from-799g $(OR_OPEN)

.PHONY: yield
yield: build ## share of drives with tolerances that survives a specification, for two lines of drives: results/yield/ (half an hour of two idle cores, resumes)
	$(YIELD) studies/yield/tolerances.toml --store results/yield/tight.opshock --out results/yield/tight
	$(YIELD) studies/yield/tolerances-wide.toml --store results/yield/loose.opshock --out results/yield/loose

.PHONY: answers
answers: build ## what less time costs in an answer of qualify, yield and worth: results/answers/ (resumes; needs python3)
	scripts/answers --jobs $(JOBS)

.PHONY: worth
worth: build ## by how much each tolerance changes the critical shocks: results/worth/ (18 minutes of two cores, resumes)
	$(OPSHOCK) worth studies/worth/study.toml -j $(JOBS) --tolerances studies/worth/tolerances.toml --store results/worth/pairs.opshock --out results/worth

.PHONY: book
book: ## the book, docs/ as HTML with search, in target/book/
	@scripts/bootstrap --python
	scripts/book

.PHONY: manual
manual: build ## the verification manual, docs/verification-manual.md, from the physics tests (minutes; needs python3)
	scripts/manual

.PHONY: verify-book
verify-book: wheel ## the book: its links, its pages in Chromium, every command of its lessons prints what the page shows, and those of all other pages run
	@scripts/bootstrap --verify
	scripts/book
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture --test-threads=1 the_book_ lessons_are commands_of

.PHONY: wheel verify-python
wheel: ## the Python package as a wheel with everything in it: target/wheels/ (the first time it compiles HDF5)
	@scripts/bootstrap --python
	scripts/wheel

.PHONY: dist verify-dist
dist: ## one archive for clusters and colleagues, the program with HDF5 in it: target/dist/
	@scripts/bootstrap --python
	scripts/dist

verify-dist: ## the archive, tried in a Debian without HDF5, Rust and Python (as root)
	@scripts/bootstrap --verify
	scripts/dist --verify

verify-python: ## the Python package from its wheel: tests, types, and what a batch of 1000 shocks costs beside the same in Rust
	@scripts/bootstrap --verify
	scripts/verify-python

.PHONY: verify-notebooks
verify-notebooks: ## every notebook of notebooks/ with the package from its wheel: no error, no warning, and its time (some minutes; needs python3 with venv)
	@test -e target/wheels/opshock-*.whl || $(MAKE) --no-print-directory wheel
	scripts/verify-notebooks

test: bootstrap ## every test (slow ones are in `make verify`)
	cargo test --workspace --locked

fmt: ## check the formatting
	cargo fmt --all -- --check

clippy: ## lints, warnings are errors
	cargo clippy --workspace --all-targets --locked -- -D warnings

doc: ## API documentation, warnings are errors
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

check: fmt clippy doc test ## what CI runs

bench: bootstrap ## benchmarks; what they print is kept in results/bench
	scripts/bench

bench-against: bootstrap ## processor and wall time against an older revision: make bench-against REV=7e99eeb [CASES="shock sweep refined"] [PAIRS=3]
	@test -n "$(REV)" || { echo "make bench-against REV=<revision>"; exit 2; }
	scripts/bench-against $(REV) $(CASES)

verify: verify-film verify-documents verify-digests verify-effects verify-durability verify-store verify-search verify-slurm verify-hard verify-scenes verify-contacts verify-accuracy verify-report verify-series verify-flight verify-solid verify-ramp verify-mounts verify-faults verify-hdf5 verify-octave verify-klu verify-match verify-forecast verify-uncertainty verify-yield verify-worth verify-dist verify-python verify-notebooks verify-book ## heavy evidence, in parts

verify-film: bootstrap ## film convergence to the reference limit
	cargo test --release --locked -p opshock-tests --test physics -- --ignored --nocapture film_slow

verify-documents: bootstrap ## the sweep that docs/your-own-drive.md shows gives the table there
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture documents_slow

verify-digests: bootstrap ## Fig. 13 swept anew gives the bits of the committed digests
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture digests_slow

verify-effects: bootstrap ## every condition of every rule deleted; 2000 random scenes, reduced model against full model (OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --features mutants --test physics -- effects_mutant
	cargo test --release --locked -p opshock-tests --test physics -- --ignored --nocapture effects_slow

verify-durability: bootstrap ## kill -9, torn journals, threads on the real study
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture durability_slow

verify-faults: ## system calls that fail at every place, file systems that fill up (root, strace): PART=sweep, report, export or run
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-tests --test durability -- --ignored --nocapture --test-threads=1 faults_slow_$(PART)

verify-store: bootstrap ## 2000 kill -9 at random moments (OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --test durability -- --ignored --nocapture --test-threads=1 store_slow

verify-search: bootstrap ## monotonicity_scan = "full" on 10 000 random tables (OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture search_slow

verify-slurm: ## a job array with a killed task on a real Slurm on the loopback address
	@scripts/bootstrap --verify
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture slurm::

verify-hard: bootstrap ## hard cases that take longer, each with figure and bound
	cargo test --release --locked -p opshock-tests --test hard -- --ignored --nocapture hard_slow

.PHONY: verify-flight verify-digests verify-documents
verify-match: bootstrap ## planted truths that `opshock match` must keep (20 minutes; OPSHOCK_SEEDS=first..end for a part)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture match_slow

verify-flight: bootstrap ## 1000 random drives with each gas model fly or cannot (100 of each at a time; OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --test hard -- --ignored --nocapture flight_slow

.PHONY: verify-contacts
verify-contacts: bootstrap ## random shocks on rough surfaces through their contacts: works, pressures, energy balance (2000; parts of 400, OPSHOCK_SEEDS=first..end, take some 25 minutes of two cores)
	cargo test --release --locked -p opshock-tests --test hard -- --ignored --nocapture contacts_slow

.PHONY: verify-yield
verify-yield: bootstrap ## verdicts on 40 drives by shocks against those of their uncertainty intervals (half a minute and more a drive; OPSHOCK_SEEDS=first..end for others)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture yield_slow

.PHONY: verify-worth
verify-worth: bootstrap ## changes by tolerances at the preset coarse against those at standard, and their intervals against separate ones (half an hour; needs results/worth)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture worth_slow

.PHONY: verify-forecast
verify-forecast: bootstrap ## forecasts of 20 studies of 4 to 36 points against the time they take (about an hour of two idle cores; OPSHOCK_SEEDS=first..end for a part)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture forecast_slow

.PHONY: verify-uncertainty
verify-uncertainty: bootstrap ## are independent critical shocks inside the uncertainty intervals of Fig. 13 and of random drives? (hours; goes on where it stopped; OPSHOCK_SEEDS=first..end for some of them)
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture --test-threads=1 uncertainty_slow

.PHONY: verify-solid
verify-solid: ## frequencies of finite elements of a ramp and a cantilever against CalculiX on the same mesh
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-solid --test calculix -- --ignored --nocapture

.PHONY: verify-ramp
verify-ramp: ## a ramp by Gmsh and CalculiX, imported: frequencies and critical shocks against opshock's own
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-tests --test products -- --ignored --nocapture outside_slow

verify-scenes: bootstrap ## 12000 random scenes (OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --test hard -- --ignored --nocapture --test-threads=1 scenes_slow

verify-accuracy: bootstrap ## do the uncertainty intervals contain the truth? 300 known answers, 40 ten times finer
	cargo test --release --locked -p opshock-tests --test products -- --ignored --nocapture accuracy_slow

verify-report: ## the report in headless Chromium (installs it): 1400 and 420 px, light, dark, printed; pictures in target/report-pages/
	@scripts/bootstrap --report
	cargo test --locked -p opshock-tests --test products -- --ignored --nocapture report_page

.PHONY: verify-series
verify-series: ## the series of `opshock export --format vtu` read by VTK (installs it)
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-tests --test products -- --ignored --nocapture series_slow

verify-mounts: bootstrap ## stores on file systems that are full or read-only (needs root, to mount them)
	cargo test --locked -p opshock-tests --test durability -- --ignored --nocapture mounts_

verify-hdf5: ## h5dump and h5py read every dataset with its units, pandas goes from the table to the histories
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-tests --test products -- --ignored --nocapture hdf5_readers

.PHONY: verify-octave
verify-octave: ## scripts/matlab and the lines of docs/matlab.md under Octave on small real files: numbers of `opshock report` and of the CSV history, to the bit
	@scripts/bootstrap --verify
	cargo build --release --locked -p opshock
	tests/octave/run $(OPSHOCK)

verify-klu: ## SuiteSparse's KLU, a reference of the benchmarks, on a system with a known solution
	@scripts/bootstrap --verify
	cargo test --locked -p opshock-klu -- --ignored --nocapture

verify-fuzz: bootstrap ## 10 million damaged files a reader: PART=study, surface, pulse, journal, market, calculix, dense, rail, run, dynamic or gmsh (OPSHOCK_SEEDS=first..end goes on)
	cargo test --release --locked -p opshock-tests --test fuzz -- --ignored --nocapture --test-threads=1 fuzz_slow_$(PART)
