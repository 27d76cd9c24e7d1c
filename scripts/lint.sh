#!/bin/sh
# clang-tidy on the given .cpp files; by default those that differ from main, `all` for every one.
set -eu
cd "$(dirname "$0")/.."
if ! command -v clang-tidy >/dev/null; then
  echo "lint: clang-tidy is not installed (apt-get install clang-tidy)" >&2
  exit 1
fi
base=$(git rev-parse --verify --quiet main || echo HEAD)
case "$*" in
  all) files=$(git ls-files 'src/*.cpp') ;;
  "") files=$( (git diff --name-only --diff-filter=d "$base" -- 'src/*.cpp'; git ls-files -o --exclude-standard -- 'src/*.cpp') | sort -u) ;;
  *) files=$* ;;
esac
if [ -z "$files" ]; then
  echo "lint: no file to look at"
  exit 0
fi
# Its own build directory: g++'s precompiled headers and -march flags are not for clang.
cmake -S . -B build/lint -G Ninja -DCMAKE_BUILD_TYPE=Release -DBAGNOLD_TESTS=OFF >/dev/null
cmake --build build/lint --target bagnold_git_hash >/dev/null
printf '%s\n' $files | xargs -n 1 -P "$(nproc)" clang-tidy -p build/lint --quiet
