# Everything that has to be built or drawn, each with one command. CMakeLists.txt builds; this file only names the steps.

BUILD  ?= build
OUT    ?= reports/out
THREADS ?= 1,2
JOBS   ?= $(shell nproc 2>/dev/null || sysctl -n hw.ncpu 2>/dev/null || echo 2)
REPORT  = $(OUT)/index.html
# SETUP=off installs no system package, PYTHON draws the report, CXX builds: all three reach the scripts by the environment

acstudy = "$(BUILD)/acstudy"
setup   = @scripts/setup.sh
stage   = scripts/stage.sh

# One build folder for all targets: the tests are added to it, and stay, once they have been asked for.
configure = cmake -S . -B "$(BUILD)" -DCMAKE_BUILD_TYPE=Release -DACSTUDY_FOLDERS=ON -DACSTUDY_OWN_PROCESSOR=ON $(CMAKE_ARGS)
# its own number of jobs, not that of the make which calls it
compile   = MAKEFLAGS=--no-print-directory cmake --build "$(BUILD)" -j $(JOBS)

# What fine errors are made of gates nothing.
gate_studies = $(filter-out studies/pollution.toml,$(wildcard studies/*.toml))

# Those whose errors are compared, with finer levels, and those that show how run times scale.
bench_studies = $(wildcard studies/fig*.toml studies/bench/fine-*.toml) studies/bench/scaling-n.toml studies/bench/scaling-horizon.toml

.PHONY: help studies test check mutants kills bench compare deep build format format-check clean compiled compiled-tests drawable

help:  ## lists the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-13s %s\n", $$1, $$2 }' Makefile
	@echo "  variables: BUILD=$(BUILD)  OUT=$(OUT)  JOBS=$(JOBS)  THREADS=$(THREADS)  COMPARE=--quick|--all"
	@echo "             SETUP=off  PYTHON=...  CXX=..."

# On a fresh machine the packages that draw are installed while the C++ compiles: half a minute less.
# A verdict that departs (1) or a run that failed (3) is to be seen in the report too.
studies:  ## runs every study and draws every figure, from nothing
	@echo "acstudy: from nothing some 7 minutes on two processors, and 0.3 GB of disk"
	@$(stage) installed scripts/setup.sh build
	@$(stage) built $(MAKE) --no-print-directory -j 2 compiled drawable
	@status=0; $(stage) run $(acstudy) run studies/*.toml --out "$(OUT)" --jobs $(JOBS) || status=$$?; \
	case $$status in 0|1|3) ;; *) exit $$status ;; esac; \
	python=$$(scripts/find-python.sh) && echo "acstudy: drawing with $$python" && \
	$(stage) drawn "$$python" reports/report.py "$(OUT)" || exit; \
	echo "acstudy: the report is $(REPORT)"; exit $$status

test:  ## builds and runs every test
	$(setup) build test
	@$(MAKE) --no-print-directory -j 2 compiled-tests drawable
	@PYTHON=$$(scripts/find-python.sh) && export PYTHON && ctest --test-dir "$(BUILD)" --output-on-failure -j $(JOBS)

check: build  ## the gates: exit 1 if any verdict departs from what its study expects
	@$(acstudy) run $(gate_studies) --out "$(OUT)" --jobs $(JOBS) || case $$? in 1|3) ;; *) exit $$? ;; esac
	@$(acstudy) check $(patsubst studies/%.toml,"$(OUT)"/%.json,$(gate_studies))

mutants:  ## tests the tests: each mistake planted in a copy of the sources has to be caught (some 20 minutes)
	$(setup) build test
	@$(MAKE) --no-print-directory drawable
	@status=0; scripts/mutants.py --out "$(OUT)/mutants" --jobs $(JOBS) || status=$$?; \
	if ls "$(OUT)"/*.h5 >/dev/null 2>&1; then "$$(scripts/find-python.sh)" reports/report.py "$(OUT)" || \
		[ $$status -ne 0 ] || status=4; fi; exit $$status

kills: build  ## kills runs, shares, merges and benches 500 times at random and lets them go on: nothing may be lost (some 10 minutes)
	$(setup) report
	@"$$(scripts/find-python.sh)" scripts/kills.py --acstudy $(acstudy)

# Those that step in several ways. That some of these blow up (3) is part of the answer.
way_studies = $(wildcard studies/bench/stiff-*-timed.toml)

bench: build  ## error against run time: times every case alone, in turn, prints the tables, draws (some 12 minutes)
	@echo "acstudy: some 12 minutes, in which the machine should do nothing else"
	@$(acstudy) bench $(bench_studies) --out "$(OUT)/bench" --fresh
	@$(acstudy) bench studies/bench/scaling-threads.toml --threads $(THREADS) --out "$(OUT)/bench-threads" --fresh
	@$(acstudy) bench $(way_studies) --runs 2 --least-seconds 0.1 --out "$(OUT)/bench-stiff" --fresh || [ $$? -eq 3 ]
	$(setup) report
	@python=$$(scripts/find-python.sh) && "$$python" reports/bench_tables.py "$(OUT)" && \
	"$$python" reports/bench_tables.py --ways "$(OUT)" && "$$python" reports/report.py "$(OUT)"

compare: build  ## the same cases in NumPy, Octave and PySPH, error by error and second by second (5 minutes; COMPARE=--quick: 45 s)
	$(setup) report
	@python=$$(scripts/find-python.sh) && \
	"$$python" scripts/compare/compare.py $(COMPARE) --acstudy "$(BUILD)/acstudy" --out "$(OUT)/compare" || exit; \
	if ls "$(OUT)"/*.h5 >/dev/null 2>&1; then "$$python" reports/report.py "$(OUT)"; fi

deep: build  ## figures 1 and 3 to N = 20480, the path sqrt(h) to N = 40960, what the finest errors are made of (some 6 minutes)
	@$(acstudy) run studies/deep/*.toml --out "$(OUT)/deep" --jobs $(JOBS)
	$(setup) report
	@"$$(scripts/find-python.sh)" reports/report.py "$(OUT)/deep"

build:  ## builds acstudy
	$(setup) build
	@$(MAKE) --no-print-directory compiled

format:  ## formats the C++ sources
	$(setup) lint
	@$(sources) -exec clang-format -i {} +

format-check:  ## names the C++ sources that make format would change
	$(setup) lint
	@$(sources) -exec clang-format --dry-run --Werror {} +

clean:  ## removes what was built; results in OUT stay
	@[ ! -e "$(BUILD)" ] || [ -e "$(BUILD)/CMakeCache.txt" ] || { echo "$(BUILD) is no build folder; not removed" >&2; exit 2; }
	rm -rf "$(BUILD)"

sources = find solver mms studies reports tests bench \( -name '*.hpp' -o -name '*.cpp' \)

# steps of the targets above

compiled:
	@$(configure) $(if $(wildcard $(BUILD)/CMakeCache.txt),,-DACSTUDY_TESTS=OFF)
	@$(compile) --target acstudy

compiled-tests:
	@$(configure) -DACSTUDY_TESTS=ON
	@$(compile)

drawable:
	$(setup) report
