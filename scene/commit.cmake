# Writes the commit of the repository at -DSOURCE=... into the file -DOUT=...; rewrites it only when it has
# changed. A file beside the library, not code in it: a commit alone then changes no binary and no key of a cache.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "${commit}\n")
