#!/usr/bin/env bash
# Columns of grains (cases/column.toml, r0 = 8 d) beside a continuum with the grains' own friction (see README.md).
# Usage: grains.sh [PROGRAM] [SCRATCH]. Makes grains.csv and grains-lode.csv.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/grain-columns}

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; } # of a key of summary.json
run() { # CASE NAME OPTION...: unless it has been completed
  local case=$1 name=$2
  shift 2
  grep -q '"status": "completed"' "$scratch/$name/summary.json" 2>/dev/null && return
  "$program" run "$top/cases/$case.toml" -o "$scratch/$name" --overwrite --quiet --set output.vtk_every=10 "$@"
}
row() { # NAME MODEL ASPECT_RATIO
  local summary=$scratch/$1/summary.json
  awk -v OFS=, -v a="$3" -v model="$2" -v n="$(value "$summary" "$([ "$2" = grains ] && echo grains || echo particles)")" -v t="$(value "$summary" time)" \
    -v x50="$(value "$summary" runout_50)" -v x90="$(value "$summary" runout_90)" -v x="$(value "$summary" runout)" \
    -v h="$(value "$summary" height_final)" -v hash="$(value "$summary" git_hash | tr -d '"')" 'BEGIN {
      e = a < 1.7 ? 1.24*a : 1.6*sqrt(a)
      print a, model, n, sprintf("%.3f", t), sprintf("%.3f", x50), sprintf("%.3f", x90), sprintf("%.3f", x), sprintf("%.3f", e),
            sprintf("%.4f", h), hash }' | tee -a "$here/grains.csv"
}

echo "aspect_ratio,model,elements,time_s,runout_50,runout_90,runout,runout_experiment,height_final_m,git_hash" > "$here/grains.csv"
for a in 0.9 1.6 2.75 6; do
  # The plane is wide enough for the experiments' run-out and a third; the time 6.5 sqrt(H0/g).
  # shellcheck disable=SC2046
  run column "$a" $(awk -v a=$a 'BEGIN {
    r0 = 8*0.004; H = a*r0; x = a < 1.7 ? 1.24*a : 1.6*sqrt(a); t = sqrt(H/9.81)
    printf "--set scenario.radius=%.5f --set scenario.height=%.5f --set scenario.length=%.4f --set time.end=%.4f --set output.snapshot_every=%.5f", r0, H,
      2*(1.3 + 1.35*x)*r0, 6.5*t, 0.1*t }')
  row "$a" grains "$a"
  # The same column of a continuum: friction and solid fraction as in plane strain (class plane of grains-lode.csv), 20 rings in r0.
  for surface in drucker_prager matsuoka_nakai; do
    # shellcheck disable=SC2046
    run column-6 "$surface-$a" --set material.yield_surface=$surface --set material.grain_diameter=0.004 --set material.grain_density=2500 \
      --set material.static_angle_deg=20.8 --set material.limit_angle_deg=33 --set material.i0=0.11 --set material.phi_max=0.57 --set material.phi_min=0.425 \
      --set scenario.radius=0.032 --set scenario.spacing=0.0016 --set output.energy_ledger=true --set output.series_every=0.0025 $(awk -v a=$a 'BEGIN {
        H = 0.032*a
        printf "--set scenario.height=%g --set time.end=%g --set material.compressibility=%g --set material.tau0=%g", H, 5*sqrt(H/9.81), 7.1e-7/H, 8400*H }')
    row "$surface-$a" $surface "$a"
  done
done

# Friction by the Lode angle: a = 6 above, and a pile of the same grains (in their own units) that is periodic across and spreads in plane strain.
run avalanche planar --set scenario.angle_deg=0 --set scenario.length=120 --set scenario.width=10 --set scenario.height=60 --set scenario.extent=20 \
  --set scenario.centre=60 --set contact.collision_time=auto --set contact.restitution=auto --set contact.stiffness=12370 --set contact.damping=12.05 --set contact.rolling=spring_slider --set contact.rolling_friction=0.05 --set time.end=25 \
  --set output.snapshot_every=0.75
instants() { # FLOW H G D RHO OPTION...: fields of FLOW from 0.4 to 2 sqrt(H/g), every tenth of it (every snapshot)
  local flow=$1 H=$2 g=$3 d=$4 rho=$5 files=() k
  shift 5
  for k in 0.4 0.5 0.6 0.7 0.8 0.9 1.0 1.1 1.2 1.3 1.4 1.5 1.6 1.7 1.8 1.9 2.0; do
    # shellcheck disable=SC2046
    "$program" cg "$scratch/$flow" -o "$scratch/fields/$flow-$k" --kernel lucy "$@" $(awk -v H="$H" -v g="$g" -v k=$k 'BEGIN {
      t = sqrt(H/g); printf "--from %g --until %g", (k - 0.049)*t, (k + 0.049)*t }') > /dev/null
    files+=("$scratch/fields/$flow-$k/fields.csv")
  done
  awk -v flow="$flow" -v H="$H" -v g="$g" -v d="$d" -v rho="$rho" -f "$here/grains-lode.awk" "${files[@]}" | tee -a "$here/grains-lode.csv"
}
echo "flow,strain,inertial_number,mu,mu_rate,mu_rate_err,phi,cos3theta_stress,power_share,nodes,instants" > "$here/grains-lode.csv"
instants 6 0.192 9.81 0.004 2500 --grid xyz --width 0.006 --spacing 0.006
instants planar 60 1 1 1.90986 --grid xz --width 1 --spacing 1
