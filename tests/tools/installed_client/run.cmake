# Installs the client as lilod-dev does, and builds the example with it by find_package and by pkgconf.
set(prefix ${WORK}/prefix)
set(example ${prefix}/share/doc/lilod-dev/examples/print_poses.cpp)
file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component lilod-dev)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_PREFIX_PATH=${prefix} -DEXAMPLE=${example})
run(${CMAKE_COMMAND} --build ${WORK}/build)

set(ENV{PKG_CONFIG_PATH} ${prefix}/share/pkgconfig)
execute_process(COMMAND pkgconf --cflags lilo OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY
  OUTPUT_STRIP_TRAILING_WHITESPACE)
separate_arguments(flags)
run(${COMPILER} -std=c++17 ${flags} -fsyntax-only ${example})
