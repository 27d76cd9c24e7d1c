bagnold_packs_stay_whole(bagnold_dem)
# The kernel lays three independent batches of pairs before the scheduler.
set_source_files_properties(src/dem/fast/engine.cpp src/dem/fast/lists.cpp PROPERTIES
  COMPILE_OPTIONS "${BAGNOLD_ABREAST_${BAGNOLD_SIMD}}")
