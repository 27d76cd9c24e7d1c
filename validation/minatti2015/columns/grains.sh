#!/usr/bin/env bash
# Columns of grains (cases/column.toml, r0 = 8 d) beside those of the continuum (see README.md). Usage: grains.sh [PROGRAM] [SCRATCH]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/grain-columns}

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; } # of a key of summary.json

echo "aspect_ratio,grains,time_s,runout_99,runout_experiment,ratio,height_final_m,git_hash" > "$here/grains.csv"
for a in 0.9 2.75 6; do
  # The plane is wide enough for the experiments' run-out and a third; the time 6.5 sqrt(H0/g).
  options=$(awk -v a=$a 'BEGIN {
    r0 = 8*0.004; H = a*r0; x = a < 1.7 ? 1.24*a : 1.6*sqrt(a)
    printf "--set scenario.radius=%.5f --set scenario.height=%.5f --set scenario.length=%.4f --set time.end=%.3f", r0, H, 2*(1.3 + 1.35*x)*r0, 6.5*sqrt(H/9.81) }')
  summary=$scratch/$a/summary.json
  # shellcheck disable=SC2086
  grep -q '"status": "completed"' "$summary" 2>/dev/null ||
    "$program" run "$top/cases/column.toml" -o "$scratch/$a" --overwrite --quiet --set output.vtk_every=10 $options
  awk -v OFS=, -v a=$a -v n="$(value "$summary" grains)" -v t="$(value "$summary" time)" -v x="$(value "$summary" runout)" \
    -v h="$(value "$summary" height_final)" -v hash="$(value "$summary" git_hash | tr -d '"')" 'BEGIN {
      e = a < 1.7 ? 1.24*a : 1.6*sqrt(a)
      print a, n, sprintf("%.3f", t), sprintf("%.3f", x), sprintf("%.3f", e), sprintf("%.3f", x/e), sprintf("%.4f", h), hash }' | tee -a "$here/grains.csv"
done
