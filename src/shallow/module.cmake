# Mirror images and rotations must agree bit for bit: a*b + c*d must not become fma(a, b, c*d), which prefers one product.
target_compile_options(bagnold_shallow PRIVATE -ffp-contract=off)
# Two packs go abreast only before the scheduler, which g++ leaves switched off for x86, and whose only model of 512-bit
# registers is that of this processor. Functions of one cell, without directions, may fuse.
set(abreast -fschedule-insns -fsched-pressure -mtune=skylake-avx512)
set_source_files_properties(src/shallow/face_rows.cpp PROPERTIES COMPILE_OPTIONS "${abreast}")
set_source_files_properties(src/shallow/measure_rows.cpp PROPERTIES COMPILE_OPTIONS "${abreast};-ffp-contract=fast")
