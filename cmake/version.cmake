# What a result must say about the program that made it.
find_package(Git QUIET)
set(BAGNOLD_GIT_HASH "unknown")
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${CMAKE_SOURCE_DIR} describe --always --dirty --abbrev=12
                  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(BAGNOLD_GIT_HASH ${hash})
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/.git/HEAD)
endif()
set(BAGNOLD_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}, native=${BAGNOLD_NATIVE}")
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/core/version.cpp PROPERTIES COMPILE_DEFINITIONS
  "BAGNOLD_VERSION=\"${PROJECT_VERSION}\";BAGNOLD_GIT_HASH=\"${BAGNOLD_GIT_HASH}\";BAGNOLD_COMPILER=\"${BAGNOLD_COMPILER}\"")
