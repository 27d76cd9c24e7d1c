#!/usr/bin/env bash
# Creep of a resting heap (see README.md). Usage: run.sh [PROGRAM] [SCRATCH]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/heap}

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; } # of a key of summary.json
echo "m0_s,slope_deg,speed_rms,creep_d_per_sqrt_H_over_g,force_evaluations,git_hash" > "$here/results.csv"
for run in "1.2 22" "1e3 22" "1e4 22" "1e4 28" "1e5 22"; do
  read -r m0 slope <<< "$run"
  directory=$scratch/$m0-$slope
  "$program" run "$top/cases/heap-at-rest.toml" -o "$directory" --overwrite --quiet --set scenario.slope_deg="$slope" \
    --set material.m0="$m0"
  s=$directory/summary.json
  awk -v OFS=, -v m0="$m0" -v slope="$slope" -v v="$(value "$s" speed_rms)" -v n="$(value "$s" force_evaluations)" -v hash="$(value "$s" git_hash | tr -d '"')" \
    'BEGIN { print m0, slope, v, sprintf("%.3g", v*sqrt(0.04/9.81)/0.32e-3), n, hash }' | tee -a "$here/results.csv"
done
