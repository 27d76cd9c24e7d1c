#!/bin/sh
# merge_variants.sh FOLDER VARIANT OBJECT... [VARIANT OBJECT...]: from the objects of each variant one object
# FOLDER/VARIANT.o, in which a function f is called f.VARIANT and everything else is private, and FOLDER/dispatch.s, in
# which f jumps to the variant in use. An entry of the section bagnold_variants is four addresses: of the one in use
# (baseline until core/variant.cpp says otherwise) and of baseline, avx2, avx512 (0: not built).
set -eu
folder=$1
shift

objects=""
variant=""
variants=""
merge() {
  [ -n "$variant" ] || return 0
  # Without groups, else the linker would still take one copy of a shared inline function for all variants.
  $LD -r --force-group-allocation -o "$folder/$variant.merged" $objects
  variants="$variants $variant"
}
for argument; do
  case $argument in
    baseline|avx2|avx512) merge; variant=$argument; objects="" ;;
    *) objects="$objects $argument" ;;
  esac
done
merge

list() { $NM --defined-only --extern-only --format=posix "$folder/$1.merged" | LC_ALL=C sort; }
for variant in $variants; do
  list "$variant" | awk '$2 == "T" {print $1}' >"$folder/$variant.functions"
  # Data with a name, or code that runs before main, would be there once per variant, whatever the machine executes.
  if list "$variant" | awk '$2 ~ /[BDRGS]/ {print "global data: " $1; found = 1} END {exit !found}' >&2 ||
     $NM --format=posix "$folder/$variant.merged" | awk '/_GLOBAL__sub_I/ {print "runs before main: " $1; found = 1} END {exit !found}' >&2; then
    echo "merge_variants.sh: error: files compiled per variant may hold functions only" >&2
    exit 1
  fi
  awk -v variant="$variant" '{print $1, $1 "." variant}' "$folder/$variant.functions" >"$folder/$variant.names"
  awk '{print $2}' "$folder/$variant.names" >"$folder/$variant.kept"
  # Constants of inline functions are "unique" and cannot be made private: they get a name that nobody else has.
  list "$variant" | awk -v suffix="$variant.$(basename "$folder")" '$2 == "u" {print $1, $1 "." suffix}' \
    >>"$folder/$variant.names"
  $OBJCOPY --redefine-syms="$folder/$variant.names" "$folder/$variant.merged" "$folder/$variant.renamed"
  $OBJCOPY --keep-global-symbols="$folder/$variant.kept" "$folder/$variant.renamed" "$folder/$variant.o"
  rm "$folder/$variant.merged" "$folder/$variant.renamed"
  cmp -s "$folder/baseline.functions" "$folder/$variant.functions" || {
    echo "merge_variants.sh: error: baseline and $variant do not define the same functions:" >&2
    diff "$folder/baseline.functions" "$folder/$variant.functions" >&2 || true
    exit 1
  }
done

awk -v built="$variants" '
  function address(variant) { return index(built " ", " " variant " ") ? $1 "." variant : "0" }
  BEGIN {
    print "    .section .note.GNU-stack,\"\",@progbits"
    print "    .data\n    .quad _ZN7bagnold7variantEv"  # so that core/variant.cpp, which chooses, is linked
  }
  {
    printf "    .section bagnold_variants,\"aw\"\n    .balign 8\n.Lentry%d:\n", NR
    printf "    .quad %s, %s, %s, %s\n", address("baseline"), address("baseline"), address("avx2"), address("avx512")
    printf "    .text\n    .globl %s\n    .type %s, @function\n%s:\n    jmp *.Lentry%d(%%rip)\n    .size %s, .-%s\n", $1, $1, $1, NR, $1, $1
  }' "$folder/baseline.functions" >"$folder/dispatch.s"
