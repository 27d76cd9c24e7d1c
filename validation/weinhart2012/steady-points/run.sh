#!/usr/bin/env bash
# The same steady flows by grains and by the shallow-layer solver (see README.md). Usage: run.sh [PROGRAM] [SCRATCH]
# A particle run that is there already is used again; the flow at 24 degrees, H = 20 is that of ../chute-h20-24deg.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/steady-points}
error=0.121   # err(F) of table 1, lambda = 1
mkdir -p "$scratch"

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1 | tr -d '"'; }   # of a key of summary.json

# theta H end from: a particle flow in a periodic box of 10 x 8 diameters
grains() {
  [ -f "$scratch/$1-$2/summary.json" ] || "$program" run "$top/cases/demo.toml" -o "$scratch/$1-$2" --overwrite --quiet \
    --set scenario.angle_deg="$1" --set scenario.fill_height="$2" --set time.end="$3" --set cg.from="$4" --set cg.until="$3" \
    --set output.vtk_every=1000 --set output.snapshot_every=1000
}

# theta thickness velocity: last row of final.csv, "... h u ..." of one cell of the steady state
layer() {
  "$program" run "$here/uniform.toml" -o "$scratch/layer" --overwrite --quiet \
    --set scenario.angle_deg="$1" --set release.thickness="$2" --set release.velocity="$3"
  tail -1 "$scratch/layer/final.csv" | cut -d, -f3,4 | tr , ' '
}

echo "theta_deg,H,regime,h,h_err,u,u_err,F,F_err,h_solver,u_solver,F_solver,difference,within" > "$here/results.csv"
while read -r theta H end from; do
  summary=$scratch/$theta-$H/summary.json
  if [ "$end" = stored ]; then summary=$here/../chute-h20-24deg/summary.json; else grains "$theta" "$H" "$end" "$from"; fi
  h=$(value "$summary" h) u=$(value "$summary" u_bar)
  # Density depends on velocity, so thickness changes with it: a second run starts with the steady velocity of the first.
  read -r _ u1 <<< "$(layer "$theta" "$h" "$u")"
  read -r h2 u2 <<< "$(layer "$theta" "$h" "$u1")"
  awk -v OFS=, -v theta="$theta" -v H="$H" -v regime="$(value "$summary" regime)" -v h="$h" -v he="$(value "$summary" h_err)" \
      -v u="$u" -v ue="$(value "$summary" u_bar_err)" -v F="$(value "$summary" froude)" -v Fe="$(value "$summary" froude_err)" \
      -v hs="$h2" -v us="$u2" -v error=$error 'BEGIN {
    Fs = us / sqrt(hs * cos(theta * atan2(0, -1) / 180)); d = Fs - F
    print theta, H, regime, sprintf("%.5g,%.2g,%.5g,%.2g,%.4f,%.2g,%.5g,%.5g,%.4f,%+.4f", h, he, u, ue, F, Fe, hs, us, Fs, d),
          (d < error && -d < error ? "yes" : "no") }' | tee -a "$here/results.csv"
done <<END
22 20 700 400
24 10 500 250
24 20 stored -
26 10 400 200
26 20 400 200
28 10 2000 1000
END
