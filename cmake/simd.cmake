# Which registers core/simd.hpp packs numbers into with the flags of this build: BAGNOLD_SIMD is avx512, avx2 or baseline.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS "")
if(BAGNOLD_NATIVE)
  set(CMAKE_REQUIRED_FLAGS -march=native)
endif()
check_cxx_source_compiles("
#if !(defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__))
#error
#endif
int main() {}" BAGNOLD_HAS_AVX512)
check_cxx_source_compiles("
#if !(defined(__AVX2__) && defined(__FMA__))
#error
#endif
int main() {}" BAGNOLD_HAS_AVX2)
unset(CMAKE_REQUIRED_FLAGS)
if(BAGNOLD_HAS_AVX512)
  set(BAGNOLD_SIMD avx512)
elseif(BAGNOLD_HAS_AVX2)
  set(BAGNOLD_SIMD avx2)
else()
  set(BAGNOLD_SIMD baseline)
endif()

# A pack that is taken apart into scalars is many times slower, and nothing but this warning says so.
function(bagnold_packs_stay_whole target)
  target_compile_options(${target} PRIVATE -Werror=vector-operation-performance)
endfunction()

# g++ leaves its scheduler switched off for x86. It lays independent chains of operations side by side where the processor
# cannot look far enough ahead; its only model of 512-bit registers is that of skylake-avx512.
set(BAGNOLD_ABREAST_avx512 -fschedule-insns -fsched-pressure -mtune=skylake-avx512)
set(BAGNOLD_ABREAST_avx2 -fschedule-insns -fsched-pressure)
set(BAGNOLD_ABREAST_baseline "")
