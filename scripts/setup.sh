#!/bin/sh
# Makes sure that what acstudy needs is installed.
#
#   scripts/setup.sh [build|report|test|browser|others|bench|lint]...        (default: build report)
#
# Debian, Ubuntu: installs what is missing with apt-get, having said so; SETUP=off never installs.
# others: what some tests compare with; without it they are skipped.
# Elsewhere: names what is missing, with its package for Homebrew, conda-forge and Fedora.
# What make compare compares with is not needed and never installed: on Debian octave, python3-scipy, python3-pysph.
# Exit: 0 all there, 2 usage, 4 something is missing.
set -u
here=$(dirname "$0")

# "found by" is the header that the package brings (or one of several, with commas), a command, or a check below.
# Where apt-get is, headers and Python modules are looked up as packages: that takes no compiler and no Python.
dependencies() {
    cat <<'END'
build  C++20          @compiler                                     g++                 gcc               cxx-compiler     gcc-c++
build  CMake          @cmake                                        cmake               cmake             cmake            cmake
build  pkg-config     pkg-config                                    pkgconf             pkgconf           pkg-config       pkgconf-pkg-config
build  GSL            gsl/gsl_version.h                             libgsl-dev          gsl               gsl              gsl-devel
build  Boost          boost/math/quadrature/tanh_sinh.hpp           libboost-dev        boost             libboost-headers boost-devel
build  Eigen          Eigen/Core                                    libeigen3-dev       eigen             eigen            eigen3-devel
build  HDF5           hdf5.h                                        libhdf5-dev         hdf5              hdf5             hdf5-devel
build  muParser       muParser.h                                    libmuparser-dev     muparser          muparser         muParser-devel
build  fmt            fmt/core.h                                    libfmt-dev          fmt               fmt              fmt-devel
build  CLI11          CLI/CLI.hpp                                   libcli11-dev        cli11             cli11            cli11-devel
build  toml++         toml++/toml.h                                 libtomlplusplus-dev tomlplusplus      tomlplusplus     tomlplusplus-devel
build  nlohmann-json  nlohmann/json.hpp                             nlohmann-json3-dev  nlohmann-json     nlohmann_json    json-devel
report matplotlib     @python                                       python3-matplotlib  python-matplotlib matplotlib-base  python3-matplotlib
report numpy          @python                                       python3-numpy       numpy             numpy            python3-numpy
report h5py           @python                                       python3-h5py        pip:h5py          h5py             python3-h5py
report Jinja2         @python                                       python3-jinja2      pip:jinja2        jinja2           python3-jinja2
bench  benchmark      benchmark/benchmark.h                         libbenchmark-dev    google-benchmark  benchmark        google-benchmark-devel
test   Catch2         catch2/catch_test_macros.hpp,catch2/catch.hpp catch2              catch2            catch2           catch-devel
browser Chromium      chromium                                      chromium            ungoogled-chromium -               chromium
browser chromedriver  chromedriver                                  chromium-driver     chromedriver      python-chromedriver-binary chromedriver
browser Selenium      @import:selenium                              python3-selenium    pip:selenium      selenium         python3-selenium
browser npm           npm                                           npm                 node              nodejs           nodejs-npm
others gfortran       gfortran                                      gfortran            gcc               gfortran         gcc-gfortran
others jsonschema     @import:jsonschema                            python3-jsonschema  pip:jsonschema    jsonschema       python3-jsonschema
others pip            @import:pip                                   python3-pip         python            pip              python3-pip
others setuptools     @import:setuptools                            python3-setuptools  pip:setuptools    setuptools       python3-setuptools
others wheel          @import:wheel                                 python3-wheel       pip:wheel         wheel            python3-wheel
others pandas         @import:pandas                                python3-pandas      pip:pandas        pandas           python3-pandas
lint   clang-format   clang-format                                  clang-format        clang-format      clang-format     clang-tools-extra
END
}

say() { echo "acstudy: $*" >&2; }

# the compiler that CMake would take, without asking it
cxx() {
    for candidate in ${CXX:-c++ g++ clang++}; do
        command -v "$candidate" && return
    done
    return 1
}

compiler_is_new_enough() {
    cxx=$(cxx) || return 1
    "$cxx" -std=c++20 -fsyntax-only -x c++ - 2>/dev/null <<'END'
#include <version>
#if defined(__apple_build_version__)
#  if __clang_major__ < 15
#    error
#  endif
#elif defined(__clang__)
#  if __clang_major__ < 14
#    error
#  endif
#elif !defined(__GNUC__) || __GNUC__ < 12
#  error
#endif
END
}

cmake_is_new_enough() {
    version=$(cmake --version 2>/dev/null) || return 1
    version=${version#cmake version }
    major=${version%%.*}
    minor=${version#*.}
    minor=${minor%%.*}
    [ "$major" -gt 3 ] || { [ "$major" -eq 3 ] && [ "$minor" -ge 20 ]; }
}

module_is_there() { "$("$here/find-python.sh" 2>/dev/null)" -c "import $1" 2>/dev/null; }

python_is_there() { "$here/find-python.sh" >/dev/null 2>&1; }

# where libraries live that the compiler does not know of but CMake finds: beside every bin/ and lib/pkgconfig/ that is in use
include_flags() {
    (
        IFS=:\;
        for prefix in ${CMAKE_PREFIX_PATH:-} "${CONDA_PREFIX:-}" /opt/homebrew /opt/local /usr/local /usr; do
            echo "$prefix"
        done
        for dir in $PATH; do echo "$dir/.."; done
        for dir in ${PKG_CONFIG_PATH:-}; do echo "$dir/../.."; done
    ) | while read -r prefix; do
        for dir in include include/eigen3 include/hdf5/serial; do
            # -idirafter: never before the compiler's own directories, where their order matters
            [ -n "$prefix" ] && [ -d "$prefix/$dir" ] && printf '%s\n' "-idirafter" "$prefix/$dir"
        done
    done
}

# reads "header[,header] dependency" lines, prints the dependencies none of whose headers is found
# (all of them without a compiler: then it is too early to tell)
without_header() {
    headers=$(cat)
    [ -n "$headers" ] || return 0
    if ! cxx=$(cxx); then
        echo "$headers" | while read -r _ dependency; do echo "$dependency"; done
        return
    fi
    flags=$(include_flags)
    (
        IFS='
'
        # a dependency's name is a string to the preprocessor, which would take toml++ apart
        # shellcheck disable=SC2086  # one flag per line
        echo "$headers" |
            awk '{ gsub(",", ">) || __has_include(<", $1); printf "#if !(__has_include(<%s>))\n\"%s\"\n#endif\n", $1, $2 }' |
            "$cxx" -std=c++20 -E -P -x c++ $flags - 2>/dev/null | tr -d '"'
    )
}

# prints those of the table's lines (stdin) whose dependency is not found; with "packages", libraries are looked up with dpkg
missing() {
    lines=$(cat)
    [ -n "$lines" ] || return 0
    absent=' '
    if [ "${1:-}" = packages ]; then
        # shellcheck disable=SC2046  # package names
        installed=" $(dpkg-query -W -f '${Package}:${db:Status-Status} ' $(echo "$lines" | while read -r _ _ _ p _; do echo "$p"; done) 2>/dev/null)"
    else
        absent=" $(echo "$lines" | while read -r _ name found _; do
            case $found in @*) ;; */* | *.h) echo "$found $name" ;; esac
        done | without_header | tr '\n' ' ')"
        python_is_there && python=found || python=
    fi
    echo "$lines" | while read -r purpose name found package others; do
        case $found in
            @compiler) compiler_is_new_enough ;;
            @cmake) cmake_is_new_enough ;;
            @python | @import:* | */* | *.h)
                if [ "${1:-}" = packages ]; then
                    case $installed in *" $package:installed "*) ;; *) false ;; esac
                elif [ "$found" = @python ]; then
                    [ -n "$python" ]
                elif [ "${found#@import:}" != "$found" ]; then
                    module_is_there "${found#@import:}"
                else
                    case $absent in *" $name "*) false ;; esac
                fi
                ;;
            *) command -v "$found" >/dev/null ;;
        esac || echo "$purpose $name $found $package $others"
    done
}

# column N of lines on stdin, on one line
column() { awk -v n="$1" '{ printf "%s%s", sep, $n; sep = " " }'; }

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo -n "$@"; fi
}

apt_get() {
    # a machine just started may still be installing its own updates: wait for the lock
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -y -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@" </dev/null
}

lists_are_empty() {
    for list in /var/lib/apt/lists/*_Packages*; do
        [ ! -e "$list" ]
        return
    done
}

update_lists() {
    say "apt-get update"
    apt_get -qq update
}

install_packages() {
    packages=$1
    log=$(mktemp) || exit 4
    trap 'rm -f "$log"' EXIT
    updated=
    if lists_are_empty; then
        update_lists >"$log"
        updated=yes
    fi
    # python3-fonttools, which matplotlib needs, takes SciPy and a compiler for Python along unless it is offered this small alternative
    case " $packages " in
        *" python3-matplotlib "*)
            dpkg-query -W python3-scipy >/dev/null 2>&1 || ! apt-cache show python3-munkres >/dev/null 2>&1 || packages="$packages python3-munkres"
            ;;
    esac
    # shellcheck disable=SC2086  # package names
    apt_get -q --no-install-recommends install $packages >"$log" 2>&1 && return
    if [ -z "$updated" ]; then
        # the lists may be older than the mirror
        # shellcheck disable=SC2086
        update_lists >"$log" && apt_get -q --no-install-recommends install $packages >"$log" 2>&1 && return
    fi
    tail -n 20 "$log" >&2
    return 1
}

explain_too_old() {
    if cxx=$(cxx) && ! compiler_is_new_enough; then
        say "$cxx is no g++ >= 12 or clang >= 14 with its C++20 library; name another, as in: make clean && make studies CXX=clang++-16"
    fi
    if command -v cmake >/dev/null && ! cmake_is_new_enough; then
        say "$(command -v cmake) is older than 3.20; put a newer one first on the PATH"
    fi
}

# --- which purposes ---------------------------------------------------------------------------------------------------------

[ $# -gt 0 ] || set -- build report
for purpose; do
    case $purpose in
        build | report | bench | test | browser | others | lint) ;;
        *) say "$0: no purpose \"$purpose\"; write build, report, bench, test, browser, others or lint" && exit 2 ;;
    esac
done
case ${SETUP:-on} in on | off) ;; *) say "SETUP = $SETUP; write SETUP=off, or leave it out" && exit 2 ;; esac
wanted=$(dependencies | while read -r purpose line; do
    case " $* " in *" $purpose "*) echo "$purpose $line" ;; esac
done)

# --- Debian, Ubuntu ---------------------------------------------------------------------------------------------------------

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
    lacking=$(echo "$wanted" | missing packages)
    [ -n "$lacking" ] || exit 0
    if [ "${SETUP:-on}" = off ]; then
        why="SETUP=off installs nothing"
    elif [ "$(id -u)" -ne 0 ] && ! sudo -n true 2>/dev/null; then
        why="installing takes root"
    else
        packages=$(echo "$lacking" | column 4)
        say "installing with apt-get: $packages (SETUP=off never installs)"
        install_packages "$packages" || { say "apt-get could not install: $packages" && exit 4; }
        lacking=$(echo "$wanted" | missing packages)
        [ -n "$lacking" ] || exit 0
        explain_too_old
        say "still missing: $(echo "$lacking" | column 2)"
        exit 4
    fi
    # nothing can be installed here, so what came by another way (conda, a module, /usr/local) has to do
    lacking=$(echo "$lacking" | missing)
    [ -n "$lacking" ] || exit 0
    say "missing: $(echo "$lacking" | column 2); $why, so please run"
    [ "$(id -u)" -eq 0 ] && sudo= || sudo="sudo "
    lists_are_empty && update="${sudo}apt-get update && " || update=
    echo "    $update${sudo}apt-get install --no-install-recommends $(echo "$lacking" | column 4)" >&2
    exit 4
fi

# --- elsewhere --------------------------------------------------------------------------------------------------------------

lacking=$(echo "$wanted" | missing)
[ -n "$lacking" ] || exit 0
say "missing, with the names of their packages:"
{
    echo "- dependency - - Homebrew conda-forge Fedora"
    echo "$lacking"
} | awk '{ printf "    %-14s  %-17s  %-16s  %s\n", $2, $5, $6, $7 }' >&2
explain_too_old
echo "$lacking" | grep -q @python && "$here/find-python.sh" >/dev/null
exit 4
