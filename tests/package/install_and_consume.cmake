# Stops at the first step that fails, with its output.
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${code}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
step(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja -D CMAKE_BUILD_TYPE=Release
     -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${prefix})
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${CMAKE_COMMAND} -E env CONCORD_HOME=${prefix}/${DATA} ${WORK}/build/consumer)
set(methods "${output}")
step(${CMAKE_COMMAND} -E env CONCORD_HOME=${prefix}/${DATA} ${WORK}/build/scene_only)
if(NOT methods MATCHES "delaunay tlsph")
  message(FATAL_ERROR "the consumer does not see the methods: ${methods}")
endif()

# The installed program finds its scenes without help from the environment of the sources.
step(${CMAKE_COMMAND} -E env --unset=CONCORD_HOME ${prefix}/${BIN}/concord list --json)
if(NOT output MATCHES "swinging_cube" OR NOT output MATCHES "\"fem\"")
  message(FATAL_ERROR "the installed program does not list scene and method: ${output}")
endif()
