# Run at every build (cmake -P): writes ${OUTPUT} with the present commit, touching the file only when it changed.
set(hash "unknown")
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE answer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed EQUAL 0)
  set(hash ${answer})
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define BAGNOLD_GIT_HASH \"${hash}\"\n")
