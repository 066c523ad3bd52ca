# Installs libslam into an empty prefix, then configures, builds and runs a program that finds it there.
# Needs: library_build, consumer_source, scratch, generator, compiler, configuration, rawlog.
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${scratch})
run(${CMAKE_COMMAND} --install ${library_build} --prefix ${scratch}/prefix
  --config ${configuration} --component development)
run(${CMAKE_COMMAND} -S ${consumer_source} -B ${scratch}/build -G ${generator}
  -D CMAKE_CXX_COMPILER=${compiler}
  -D CMAKE_BUILD_TYPE=${configuration}
  -D CMAKE_PREFIX_PATH=${scratch}/prefix)
run(${CMAKE_COMMAND} --build ${scratch}/build --config ${configuration})
run(${scratch}/build/consumer ${rawlog} ${scratch}/run)
