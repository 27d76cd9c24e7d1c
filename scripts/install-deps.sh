#!/bin/sh
# Installs what bagnold needs on Debian 12: only the packages that are missing, with sudo when not root.
#   scripts/install-deps.sh             install
#   scripts/install-deps.sh --dry-run   list the missing packages, one a line, and change nothing
set -eu

dry_run=no
case "${1:-}" in
  "") ;;
  --dry-run) dry_run=yes ;;
  *) echo "usage: $0 [--dry-run]" >&2; exit 2 ;;
esac

wanted() {
  cat <<END
g++ cmake ninja-build make git pkg-config   # compiler and build tools
libtomlplusplus-dev                         # cases
libcli11-dev                                # the command line
libfmt-dev                                  # text and numbers
nlohmann-json3-dev                          # summary.json
libhdf5-dev                                 # run.h5, checkpoint.h5
libeigen3-dev libceres-dev                  # least squares of the closures
libgdal-dev                                 # elevation rasters
nettle-dev                                  # SHA-256, the names of settled beds
libgtest-dev librapidcheck-dev              # tests
libbenchmark-dev                            # benchmarks
gnuplot-nox                                 # figures of the report
END
}
packages=$(wanted | sed 's/#.*//')

if ! command -v dpkg-query >/dev/null; then
  echo "$0: error: not a Debian system; install the equivalents of:" $packages >&2
  exit 1
fi

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done

if [ -z "$missing" ]; then
  [ "$dry_run" = yes ] || echo "install-deps: nothing is missing"
  exit 0
fi
if [ "$dry_run" = yes ]; then
  printf '%s\n' $missing
  exit 0
fi

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "$0: error: missing:$missing; installing them takes root or sudo" >&2
    exit 1
  fi
  as_root="sudo"
fi
echo "install-deps: installing$missing"
$as_root apt-get -q -o DPkg::Lock::Timeout=120 update </dev/null
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=120 install --no-install-recommends $missing </dev/null
