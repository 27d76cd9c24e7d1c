# The fast engine moves rows of doubles as registers; no file of it may be compiled as if that never happened.
target_compile_options(bagnold_dem PRIVATE -fno-strict-aliasing)
# Its kernel lays three independent batches of pairs before the scheduler, which g++ leaves switched off for x86, and whose
# only model of 512-bit registers is that of this processor.
set_source_files_properties(src/dem/fast/engine.cpp src/dem/fast/ledger_pass.cpp src/dem/fast/lists.cpp PROPERTIES
  COMPILE_OPTIONS "-fschedule-insns;-fsched-pressure;-mtune=skylake-avx512")
