# Installs a build of Hooke to a fresh prefix, builds the program beside this file against it, and runs it.
set(prefix ${FOLDER}/prefix)
set(build ${FOLDER}/build)
file(REMOVE_RECURSE ${prefix} ${FOLDER}/moved ${build})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN} ended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${HOOKE_BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${build} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
run(${CMAKE_COMMAND} --build ${build})
run(${build}/rope)

# Ten seconds in thick air: it hangs still, and 2 m of rope are 2 m.
if(NOT output MATCHES "is 2\\.00 m below")
  message(FATAL_ERROR "unexpected output: ${output}")
endif()

# The prefix is none that the build was configured for, the program stands elsewhere: it finds its importer all the same.
if(APPS)
  unset(ENV{HOOKE_IMPORT})
  run(${build}/model ${MODEL})
  if(NOT output MATCHES "^[1-9][0-9]* triangles")
    message(FATAL_ERROR "unexpected output: ${output}")
  endif()
  # Only in PATH.
  file(RENAME ${prefix} ${FOLDER}/moved)
  set(ENV{PATH} "${FOLDER}/moved/bin:$ENV{PATH}")
  run(${build}/model ${MODEL})
  file(RENAME ${FOLDER}/moved ${prefix})
endif()
