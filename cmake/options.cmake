# Flags of every target, as one interface library.
add_library(bagnold_options INTERFACE)
target_compile_features(bagnold_options INTERFACE cxx_std_20)
target_include_directories(bagnold_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
# No -ffast-math anywhere: results must be reproducible. These two change no result, they only say
# that nobody reads errno after sqrt or installs floating-point traps, which lets loops vectorise.
target_compile_options(bagnold_options INTERFACE -Wall -Wextra -Wshadow -Wno-missing-field-initializers -fno-math-errno -fno-trapping-math
  -Wno-psabi)  # vector types are never passed between objects built with different flags
# g++ 12 sees an overflow in fmt 9 that is not there, as soon as native instructions are on.
target_compile_options(bagnold_options INTERFACE -Wno-stringop-overflow)
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_options(bagnold_options INTERFACE -ffp-contract=off)
endif()
if(BAGNOLD_SANITIZE)
  target_compile_options(bagnold_options INTERFACE -fsanitize=${BAGNOLD_SANITIZE} -fno-omit-frame-pointer -g)
  target_link_options(bagnold_options INTERFACE -fsanitize=${BAGNOLD_SANITIZE})
endif()
if(BAGNOLD_COVERAGE)
  target_compile_options(bagnold_options INTERFACE --coverage -O0 -g)
  target_link_options(bagnold_options INTERFACE --coverage)
endif()
