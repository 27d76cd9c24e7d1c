#!/usr/bin/env bash
# Three inclinations, three regimes (see README.md). Usage: run.sh [PROGRAM] [SCRATCH]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/regimes}

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; }   # of a key of summary.json

# Largest value of column $2 of series.csv in $1 after t = 100: the initial fall is over.
largest() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) k = i }
                        NR > 1 && $1 > 100 && $k > m { m = $k } END { print m }' "$1"
}

echo "theta_deg,status,regime,time,h,u_bar,max_overlap_over_radius_after_100" > "$here/results.csv"
for theta in 18 24 34; do
  "$program" run "$top/cases/chute.toml" -o "$scratch/$theta" --overwrite --quiet \
    --set scenario.angle_deg=$theta --set scenario.fill_height=10 --set time.end=300 \
    --set output.series_every=1 --set output.vtk_every=50 --set output.snapshot_every=100 --set cg.from=200 --set cg.until=300
  row="$theta"
  for key in status regime time h u_bar; do row="$row,$(value "$scratch/$theta/summary.json" $key | tr -d '"')"; done
  echo "$row,$(largest "$scratch/$theta/series.csv" max_overlap_over_radius)" | tee -a "$here/results.csv"
done

# Layers: over a smooth base, and none over a rough one (cases/demo.toml, the smaller box).
echo "theta_deg,lambda,time,regime,layering,layering_err,phi_bulk,h,u_bar,energy_growth" > "$here/layers.csv"
while read -r theta lambda end from; do
  out=$scratch/layers-$theta-$lambda
  "$program" run "$top/cases/demo.toml" -o "$out" --overwrite --quiet --set scenario.angle_deg="$theta" \
    --set scenario.base_size_ratio="$lambda" --set time.end="$end" --set cg.from="$from" --set output.vtk_every=1000
  row="$theta,$lambda,$end"
  for key in regime layering layering_err phi_bulk h u_bar energy_growth; do
    row="$row,$(value "$out/summary.json" $key | tr -d '"')"
  done
  echo "$row" | tee -a "$here/layers.csv"
done <<'END'
22 0.5 400 300
26 1 150 110
END
