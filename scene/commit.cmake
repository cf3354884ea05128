# Writes concord_commit.hpp (-DOUT=...) from the repository at -DSOURCE=...; rewrites it only when
# the commit has changed, so that an unchanged tree compiles nothing.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n#define CONCORD_COMMIT \"${commit}\"\n")
