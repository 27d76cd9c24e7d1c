# The fast engine moves rows of doubles as registers; no file of it may be compiled as if that never happened.
target_compile_options(bagnold_dem PRIVATE -fno-strict-aliasing)
