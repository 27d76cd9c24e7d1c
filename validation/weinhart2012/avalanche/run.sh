#!/usr/bin/env bash
# A finite mass let go on a slope, by grains and by the shallow-layer solver (see README.md).
# Usage: run.sh [PROGRAM] [SCRATCH]. A particle run that is there already is used again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/avalanche}
mkdir -p "$scratch"

for seed in 1 2; do
  [ -f "$scratch/grains-$seed/summary.json" ] ||
    "$program" run "$top/cases/avalanche.toml" -o "$scratch/grains-$seed" --overwrite --quiet --set seed=$seed
done

# name, options: the layer, the report of both, and the numbers
compare() {
  name=$1; shift
  "$program" run "$here/layer.toml" -o "$scratch/$name" --overwrite --quiet "$@"
  "$program" report "$scratch/grains-1" "$scratch/grains-2" "$scratch/$name" -o "$scratch/report-$name/report.html" --format png
  awk -f "$here/metrics.awk" "$scratch/report-$name/figures/compared.csv" > "$scratch/$name.csv"
}

compare layer
cp "$scratch/layer.csv" "$here/results.csv"
cp "$scratch/report-layer/figures/compared.png" "$here/compared.png"

# How much hangs on the treatment of the tip and on the shape factor: the largest and the mean L1, and the front at the end.
compare tip_0 --set scheme.tip_depth=0
compare tip_6 --set scheme.tip_depth=6
compare alpha_1 --set closure.shape_factor.law=constant --set closure.shape_factor.alpha=1
echo "layer,mean_l1_1,mean_l1_2,largest_l1,front_1,front_2,front_layer" > "$here/sensitivity.csv"
for name in layer tip_0 tip_6 alpha_1; do
  awk -F, -v name=$name 'NR > 2 { a += $2; b += $3; ++n; if ($2 > m) m = $2; if ($3 > m) m = $3; f = $14; g = $15; l = $16 }
    END { printf "%s,%.3f,%.3f,%.3f,%s,%s,%s\n", name, a / n, b / n, m, f, g, l }' "$scratch/$name.csv" | tee -a "$here/sensitivity.csv"
done
