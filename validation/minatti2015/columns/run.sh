#!/usr/bin/env bash
# The six columns of table 3 (see README.md). Usage: run.sh [PROGRAM] [SCRATCH] [RUN...]
# Runs what is named (default: everything) and has not been completed in SCRATCH, then puts all that is there into results.csv and literal.csv.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/columns}
shift $(($# < 2 ? $# : 2))

printed_kt=(- 9.0e-5 5.3e-5 4.1e-5 3.1e-5 2.4e-5 2.2e-6)
printed_m0=(- 1.2 1.4 1.2 1.4 1.6 1.6)
half_dp=(- 0.0006 0.0011 0.00151 0.00162 0.00243 0.00243)
end=(- 0.3 0.5 0.55 0.75 0.95 1.0) # s, 5.6 sqrt(H0/g) at least

# NAME is FORMULATION-GEOMETRY-ROW, or FORMULATION.sSEED-GEOMETRY-ROW for a member of an ensemble: particles start up to 0.0005 dp off
# their lattice.
options() {
  local row=${1##*-} a= seed
  seed=$(sed -n 's/.*\.s\([0-9]*\)-.*/\1/p' <<< "$1")
  set -- "${1/.s$seed-/-}"
  case $1 in # row 4 or 6 made lower or higher: tall4 has a = 4; tall4c with the collisional branch, tall4n with friction by Lode angle
    *tall[0-9]*)
      a=${1%%-*}
      a=${a##*tall}
      awk -v a="${a%[cn]}" 'BEGIN { H = 0.0972*a
        printf "--set scenario.height=%g --set material.compressibility=%g --set material.tau0=%g --set time.end=%.3f ", H, 6.53e-7/H, 9120*H, 4.5*sqrt(H/9.81) }' ;;
    literal-* | stepped-*) echo "--set time.end=${end[row]}" ;; # these creep for ever; the others stop when they have arrested
  esac
  echo "--set output.series_every=0.01 --set output.snapshot_every=0.025 --set output.vtk_every=10"
  [ -z "$seed" ] || echo "--set scenario.disorder=0.0005 --set seed=$seed"
  case $1 in
    improved-axisymmetric-*) ;; # the case as it is
    fine-axisymmetric-*) echo "--set scenario.spacing=${half_dp[row]}" ;;
    cone-axisymmetric-*) echo "--set material.yield_surface=matsuoka_nakai" ;; # friction by Lode angle
    finelade-axisymmetric-*) echo "--set material.yield_surface=lade_duncan --set scenario.spacing=${half_dp[row]}" ;;
    finetriaxial-axisymmetric-*) echo "--set material.yield_surface=triaxial_ratio --set scenario.spacing=${half_dp[row]}" ;; # strength that grains show
    finecone-axisymmetric-*) echo "--set material.yield_surface=matsuoka_nakai --set scenario.spacing=${half_dp[row]}" ;;
    finemn*-axisymmetric-* | finemc*-axisymmetric-* | mc*-axisymmetric-* | mn*-axisymmetric-*) # another friction angle: finemn29.5
      local angle=${1%%-*} surface=matsuoka_nakai
      case $angle in *mc*) surface=mohr_coulomb ;; esac
      echo "--set material.yield_surface=$surface --set material.static_angle_deg=${angle##*m[nc]}"
      [ "${1#fine}" = "$1" ] || echo "--set scenario.spacing=${half_dp[row]}" ;;
    improved-planar-*) echo "--set scenario.geometry=planar" ;;
    improved-cylinder-3) echo "--set scenario.geometry=cylinder --set scenario.spacing=0.009" ;;
    cone-cylinder-3) echo "--set scenario.geometry=cylinder --set scenario.spacing=0.009 --set material.yield_surface=matsuoka_nakai" ;;
    collisional-axisymmetric-*) echo "--set material.friction=collisional --set material.dilatancy=collisional" ;;
    tall[0-9]*-axisymmetric-[46] | finetall[0-9]*-axisymmetric-[46])
      case $a in
        *c) echo "--set material.friction=collisional --set material.dilatancy=collisional" ;;
        *n) echo "--set material.yield_surface=matsuoka_nakai" ;;
      esac
      [ "${1#fine}" = "$1" ] || echo "--set scenario.spacing=${half_dp[row]}" ;;
    literal-planar-* | stepped-planar-*) # as printed; `stepped`: the same equations stepped implicitly
      echo "--set scenario.geometry=planar --set numerics.operator=minatti2015
            --set numerics.shifting=0 --set numerics.volume_correction=0 --set numerics.density_diffusion=0
            --set numerics.base_friction=0
            --set material.compressibility=${printed_kt[row]} --set material.m0=${printed_m0[row]}"
      case $1 in
        literal-*) echo "--set numerics.stepping=minatti2015 --set numerics.cfl=0.5" ;;
        *) echo "--set numerics.stepping=implicit" ;;
      esac ;;
    *) echo "unknown run $1" >&2; return 1 ;;
  esac
}

runs=("$@")
if [ ${#runs[@]} = 0 ]; then
  for row in 1 2 3 4 5 6; do
    runs+=(improved-axisymmetric-$row fine-axisymmetric-$row cone-axisymmetric-$row finecone-axisymmetric-$row finelade-axisymmetric-$row improved-planar-$row literal-planar-$row stepped-planar-$row)
  done
  runs+=(improved-cylinder-3 cone-cylinder-3 collisional-axisymmetric-5 collisional-axisymmetric-6)
  runs+=(tall4-axisymmetric-6 tall4c-axisymmetric-6 tall6-axisymmetric-6 tall6c-axisymmetric-6)
  runs+=(tall4n-axisymmetric-6 tall6n-axisymmetric-6 finetall4n-axisymmetric-6)
  runs+=(finetall1.2-axisymmetric-4 finetall1.2n-axisymmetric-4 finetall2.0-axisymmetric-4 finetall2.0n-axisymmetric-4)
fi
for run in "${runs[@]}"; do
  grep -q '"status": "\(completed\|arrested\)"' "$scratch/$run/summary.json" 2>/dev/null && continue
  # shellcheck disable=SC2046
  "$program" run "$top/cases/column-${run##*-}.toml" -o "$scratch/$run" --overwrite --quiet $(options "$run") || echo "$run failed" >&2
done

value() { sed -n "s/^ *\"$2\": \(.*[^,]\),\{0,1\}\$/\1/p" "$1" | head -1; }        # of a key of summary.json
key() { sed -n "s/^$2 = \([0-9.e-]*\).*/\1/p" "$1" | head -1; }                    # of case.toml
# When the connected front comes within 1 % of r0 of where it ends, and its speed over the last 0.05 s in sqrt(g H0).
front() {
  awk -F, -v H="$(key "$1/case.toml" height)" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "front") k = i; next }
    { t[++n] = $1; f[n] = $k }
    END {
      stop = t[1]
      for (j = 1; j < n; ++j) if (f[n] - f[j] > 0.000972 || f[j] - f[n] > 0.000972) stop = t[j + 1]
      for (j = n; j > 1 && t[n] - t[j] < 0.05; --j);
      printf "%.3f,%.5f", stop, (f[n] - f[j])/(t[n] - t[j])/sqrt(9.81*H)
    }' "$1/series.csv"
}
header="row,geometry,formulation,aspect_ratio,spacing_m,particles,t_end_s,t_stop_s,front_speed_end,runout_connected,runout_layer,runout_raw,height_m,runout_experiment,error_percent,layer_error_percent,raw_error_percent,git_hash"
rows() { # of the runs named
  for directory in "$@"; do
    s=$directory/summary.json
    grep -q '"status": "\(completed\|arrested\)"' "$s" 2> /dev/null || continue
    name=$(basename "$directory")
    rest=${name%-*}
    awk -v OFS=, -v row="${name##*-}" -v geometry="${rest##*-}" -v formulation="${rest%%-*}" -v a="$(value "$s" aspect_ratio)" \
      -v dp="$(key "$directory/case.toml" spacing)" -v n="$(value "$s" particles)" -v t="$(value "$s" time)" -v front="$(front "$directory")" \
      -v r0="$(value "$s" r0)" -v runout="$(value "$s" runout)" -v raw="$(value "$s" r_final_raw)" -v layer="$(value "$s" runout_layer)" -v h="$(value "$s" height_final)" \
      -v target="$(value "$s" runout_experiment)" -v hash="$(value "$s" git_hash | tr -d '"')" 'BEGIN {
        raw = raw/r0 - 1
        print row, geometry, formulation, sprintf("%.3f", a), dp, n, sprintf("%.3f", t), front, sprintf("%.4f", runout), sprintf("%.4f", layer), sprintf("%.4f", raw),
              sprintf("%.4f", h), sprintf("%.3f", target), sprintf("%+.1f", 100*(runout/target - 1)), sprintf("%+.1f", 100*(layer/target - 1)),
              sprintf("%+.1f", 100*(raw/target - 1)), hash }'
  done
}
# The table in a file with the runs named; rows of other runs stay as they are.
renew() {
  local file=$1
  shift
  {
    rows "$@"
    tail -n +2 "$file"
  } | awk -F, '!known[$1, $2, $3]++' | sort -t, -k3,3 -k2,2 -k1,1n > "$file.new"
  { echo "$header"; cat "$file.new"; } > "$file"
  rm "$file.new"
}
improved=() literal=()
for directory in "$scratch"/*-*-[1-6]; do
  case $(basename "$directory") in
    literal-* | stepped-*) literal+=("$directory") ;;
    *) improved+=("$directory") ;;
  esac
done
renew "$here/results.csv" "${improved[@]}"
renew "$here/literal.csv" "${literal[@]}"
cat "$here/results.csv" "$here/literal.csv"
