bagnold_packs_stay_whole(bagnold_shallow)
# Mirror images and rotations must agree bit for bit: a*b + c*d must not become fma(a, b, c*d), which prefers one product.
target_compile_options(bagnold_shallow PRIVATE -ffp-contract=off -fopenmp-simd)
# Two packs go abreast only before the scheduler. Functions of one cell, without directions, may fuse.
set_source_files_properties(src/shallow/face_rows.cpp PROPERTIES COMPILE_OPTIONS "${BAGNOLD_ABREAST_${BAGNOLD_SIMD}}")
set_source_files_properties(src/shallow/measure_rows.cpp PROPERTIES
  COMPILE_OPTIONS "${BAGNOLD_ABREAST_${BAGNOLD_SIMD}};-ffp-contract=fast")
