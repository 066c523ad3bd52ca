# Tests of the repository itself: include order, and use of the installed library from outside.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

add_test(NAME layers.include_order
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/tools/check_layers ${PROJECT_SOURCE_DIR})
add_test(NAME layers.checker_can_fail
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/tools/check_layers --self-test)
set_tests_properties(layers.include_order layers.checker_can_fail PROPERTIES TIMEOUT 60)

# An instrumented library does not link into a plain consumer.
if(NOT LIBSLAM_SANITIZE AND NOT LIBSLAM_COVERAGE)
  add_test(NAME install.consumer
    COMMAND ${CMAKE_COMMAND}
      -D library_build=${PROJECT_BINARY_DIR}
      -D consumer_source=${PROJECT_SOURCE_DIR}/tests/consumer
      -D scratch=${PROJECT_BINARY_DIR}/consumer
      -D generator=${CMAKE_GENERATOR}
      -D compiler=${CMAKE_CXX_COMPILER}
      -D configuration=$<CONFIG>
      -D rawlog=/usr/share/mrpt/datasets/kf-slam_demo.rawlog
      -P ${PROJECT_SOURCE_DIR}/tests/consumer/install_and_use.cmake)
  set_tests_properties(install.consumer PROPERTIES TIMEOUT 300)
endif()
