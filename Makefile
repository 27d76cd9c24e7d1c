# Everything a developer types. The program ends up in build/release/bagnold.
#   make demo    install what is missing, build, run cases/demo.toml, write a report
#   make test    install what is missing, build, run every test
PRESET   ?= release
JOBS     ?= $(shell nproc)
BUILD    := build/$(PRESET)
CCACHE   := $(shell command -v ccache)
LAUNCHER := $(if $(CCACHE),-DCMAKE_CXX_COMPILER_LAUNCHER=$(CCACHE))
SOURCES   = $(shell git ls-files 'src/*.hpp' 'src/*.cpp' 'tests/*.hpp' 'tests/*.cpp' 'bench/*.hpp' 'bench/*.cpp')
DEMO     := out/demo

.PHONY: help build demo test bench format format-check lint package install-deps clean

help:            ## this list
	@grep -E '^[a-z-]+: .*##' $(MAKEFILE_LIST) | sed 's/:[^#]*##/\t/' | expand -t 16

install-deps:    ## install the Debian packages that are missing
	@scripts/install-deps.sh

build: install-deps  ## build/release/bagnold (PRESET=dev, portable, asan-ubsan, tsan, coverage for others)
	@cmake --preset $(PRESET) $(LAUNCHER) -DBAGNOLD_TESTS=OFF
	@cmake --build $(BUILD) --parallel $(JOBS) --target bagnold

demo: build      ## a granular chute flow, grain by grain, in a few minutes
	$(BUILD)/bagnold run cases/demo.toml -o $(DEMO) --overwrite
	$(BUILD)/bagnold report $(DEMO)
	@echo
	@echo "report:    $(CURDIR)/$(DEMO)/report.html"
	@for file in $(DEMO)/vtk/*.pvd; do echo "ParaView:  $(CURDIR)/$$file"; done

test: install-deps   ## build and run every test
	@cmake --preset $(PRESET) $(LAUNCHER) -DBAGNOLD_TESTS=ON
	@cmake --build $(BUILD) --parallel $(JOBS)
	ctest --test-dir $(BUILD) --output-on-failure -j2

bench: install-deps  ## build and run the benchmarks
	@cmake --preset $(PRESET) $(LAUNCHER) -DBAGNOLD_BENCH=ON
	@cmake --build $(BUILD) --parallel $(JOBS)
	@cmake --build $(BUILD) --target run_benchmarks

format:          ## clang-format everything
	clang-format -i $(SOURCES)

format-check:    ## fail when clang-format would change something
	clang-format --dry-run --Werror $(SOURCES)

lint:            ## clang-tidy on the files changed since main (FILES="..." for others, FILES=all for all)
	@scripts/lint.sh $(FILES)

package:         ## build/portable/bagnold_*.deb, runs on any x86-64
	@cmake --preset portable $(LAUNCHER) -DBAGNOLD_TESTS=OFF
	@cmake --build build/portable --parallel $(JOBS) --target bagnold
	@cd build/portable && cpack -G DEB

clean:           ## remove build/ and out/
	rm -rf build out
