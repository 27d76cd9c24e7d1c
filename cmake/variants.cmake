# One binary for every x86-64 processor: the files of a module that work on packs of numbers (core/simd.hpp) are compiled
# once per SIMD variant, and every function they define becomes a jump to the variant that this machine executes.
#
#   bagnold_hot(dem fast/engine.cpp ...)
#
# Each variant is linked into one object whose own functions are private to it, shared templates and inline functions of
# the standard library included: nothing compiled for AVX-512 can end up under the name that the rest of the program calls.
# core/variant.cpp chooses. A build with one variant (Debug, sanitizers, other processors) compiles the files as any other.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(BAGNOLD_FLAGS_baseline -march=x86-64)
  set(BAGNOLD_FLAGS_avx2 -march=x86-64-v3)
  set(BAGNOLD_FLAGS_avx512 -march=x86-64-v4)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    set(variants baseline)
  else()
    set(variants baseline avx2 avx512)
  endif()
else()
  set(variants baseline)
endif()
set(BAGNOLD_VARIANTS "${variants}" CACHE STRING "SIMD variants to build: baseline, avx2, avx512, or one of them")

# What core/variant.cpp knows of this.
list(TRANSFORM BAGNOLD_VARIANTS PREPEND "Variant::" OUTPUT_VARIABLE built)
list(JOIN built "," built)
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/core/variant.cpp PROPERTIES
  COMPILE_DEFINITIONS "BAGNOLD_VARIANTS_BUILT=${built}")

# A pack that is taken apart into scalars is many times slower, and nothing but this warning says so.
set(whole_packs -Werror=vector-operation-performance)

function(bagnold_hot module)
  set(target bagnold_${module})
  list(TRANSFORM ARGN PREPEND ${CMAKE_SOURCE_DIR}/src/${module}/ OUTPUT_VARIABLE files)
  list(LENGTH BAGNOLD_VARIANTS count)
  if(count EQUAL 1)
    set_property(SOURCE ${files} APPEND PROPERTY COMPILE_OPTIONS ${BAGNOLD_FLAGS_${BAGNOLD_VARIANTS}} ${whole_packs})
    set_target_properties(${target} PROPERTIES BAGNOLD_VARIANT ${BAGNOLD_VARIANTS})
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(REMOVE_ITEM sources ${files})
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")

  set(folder ${CMAKE_BINARY_DIR}/variants/${module})
  set(merged)
  set(arguments)
  set(depends)
  foreach(variant IN LISTS BAGNOLD_VARIANTS)
    set(library ${target}_${variant})
    add_library(${library} OBJECT ${files})
    target_compile_options(${library} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_OPTIONS> ${BAGNOLD_FLAGS_${variant}}
                           ${whole_packs})
    set_target_properties(${library} PROPERTIES BAGNOLD_VARIANT ${variant})
    target_include_directories(${library} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${library} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>)
    list(APPEND merged ${folder}/${variant}.o)
    list(APPEND arguments ${variant} $<TARGET_OBJECTS:${library}>)
    list(APPEND depends $<TARGET_OBJECTS:${library}>)
  endforeach()
  add_custom_command(OUTPUT ${folder}/dispatch.s ${merged}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND ${CMAKE_COMMAND} -E env LD=${CMAKE_LINKER} NM=${CMAKE_NM} OBJCOPY=${CMAKE_OBJCOPY}
            ${CMAKE_SOURCE_DIR}/cmake/merge_variants.sh ${folder} ${arguments}
    DEPENDS ${depends} ${CMAKE_SOURCE_DIR}/cmake/merge_variants.sh
    COMMAND_EXPAND_LISTS VERBATIM COMMENT "One entry for every function of ${module}'s SIMD variants")
  set_source_files_properties(${merged} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set_source_files_properties(${folder}/dispatch.s PROPERTIES LANGUAGE ASM GENERATED ON)
  target_sources(${target} PRIVATE ${merged} ${folder}/dispatch.s)
endfunction()

# bagnold_abreast(module file...): these lay independent chains of operations side by side. g++ leaves its scheduler
# switched off for x86; its only model of 512-bit registers is that of skylake-avx512.
function(bagnold_abreast module)
  list(TRANSFORM ARGN PREPEND ${CMAKE_SOURCE_DIR}/src/${module}/ OUTPUT_VARIABLE files)
  set(variant "$<TARGET_PROPERTY:BAGNOLD_VARIANT>")
  set_property(SOURCE ${files} APPEND PROPERTY COMPILE_OPTIONS
    "$<$<NOT:$<STREQUAL:${variant},baseline>>:-fschedule-insns;-fsched-pressure>"
    "$<$<STREQUAL:${variant},avx512>:-mtune=skylake-avx512>")
endfunction()
