#!/usr/bin/env bash
# Three inclinations, three regimes (see README.md). Usage: run.sh [PROGRAM] [SCRATCH]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/regimes}

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; }   # of a key of summary.json

echo "theta_deg,status,regime,time,u_bar,energy_ratio,max_overlap_over_radius" > "$here/results.csv"
for theta in 18 24 34; do
  "$program" run "$top/cases/chute.toml" -o "$scratch/$theta" --overwrite --quiet \
    --set scenario.angle_deg=$theta --set scenario.fill_height=10 --set time.end=${END:-300} \
    --set output.series_every=1 --set output.vtk_every=50 --set output.snapshot_every=100 --set cg.from=200 --set cg.until=${END:-300}
  summary=$scratch/$theta/summary.json
  row="$theta"
  for key in status regime time u_bar energy_ratio max_overlap_over_radius; do row="$row,$(value "$summary" $key)"; done
  echo "$row" | tee -a "$here/results.csv"
done
