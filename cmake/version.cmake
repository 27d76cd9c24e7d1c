# What a result must say about the program that made it. The commit is asked for at every build: asked at
# configuration, it would go stale with the next commit.
set(BAGNOLD_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}")
set(BAGNOLD_GENERATED ${CMAKE_BINARY_DIR}/generated)
add_custom_target(bagnold_git_hash BYPRODUCTS ${BAGNOLD_GENERATED}/git_hash.hpp
  COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${CMAKE_SOURCE_DIR} -D OUTPUT=${BAGNOLD_GENERATED}/git_hash.hpp
          -P ${CMAKE_SOURCE_DIR}/cmake/git_hash.cmake
  COMMENT "Asking git for the commit" VERBATIM)
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/core/version.cpp PROPERTIES
  INCLUDE_DIRECTORIES ${BAGNOLD_GENERATED}
  COMPILE_DEFINITIONS "BAGNOLD_VERSION=\"${PROJECT_VERSION}\";BAGNOLD_COMPILER=\"${BAGNOLD_COMPILER}\"")
