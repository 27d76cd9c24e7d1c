# Mirror images and rotations must agree bit for bit: a*b + c*d must not become fma(a, b, c*d), which prefers one product.
target_compile_options(bagnold_shallow PRIVATE -ffp-contract=off -fopenmp-simd)
# Functions of one cell, without directions, may fuse; two packs go abreast only before the scheduler, which g++ leaves
# switched off for x86, and whose only model of 512-bit registers is that of this processor.
set_source_files_properties(src/shallow/measure_rows.cpp PROPERTIES
  COMPILE_OPTIONS "-ffp-contract=fast;-fschedule-insns;-fsched-pressure;-mtune=skylake-avx512")
