# Mirror images and rotations must agree bit for bit: a*b + c*d must not become fma(a, b, c*d), which prefers one product.
target_compile_options(bagnold_shallow PRIVATE -ffp-contract=off)
bagnold_hot(shallow both_stages.cpp closure_rows.cpp face_rows.cpp measure_rows.cpp sweep.cpp)
# Two packs go abreast only before the scheduler.
bagnold_abreast(shallow face_rows.cpp measure_rows.cpp)
# Functions of one cell, without directions, may fuse.
set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/shallow/measure_rows.cpp APPEND PROPERTY COMPILE_OPTIONS -ffp-contract=fast)
