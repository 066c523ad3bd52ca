# Sanitizers and coverage: whole-tree compile and link options, off unless a preset asks for them.
set(LIBSLAM_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined or thread")
option(LIBSLAM_COVERAGE "Record line coverage; target coverage_report writes the page" OFF)

if(LIBSLAM_SANITIZE)
  add_compile_options(-fsanitize=${LIBSLAM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # MRPT 2.5.8 allocates over-aligned drawing objects with the plain new (CEllipsoid2D.h:40).
  add_compile_options(-fno-sanitize=alignment)
  add_link_options(-fsanitize=${LIBSLAM_SANITIZE})
endif()

if(LIBSLAM_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
  find_program(LIBSLAM_GCOVR gcovr)
  if(LIBSLAM_GCOVR)
    add_custom_target(coverage_report
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/coverage
      COMMAND ${LIBSLAM_GCOVR} --root ${PROJECT_SOURCE_DIR} --filter ${PROJECT_SOURCE_DIR}/libslam
              --exclude-throw-branches --print-summary
              --html-details ${PROJECT_BINARY_DIR}/coverage/index.html
      WORKING_DIRECTORY ${PROJECT_BINARY_DIR}
      VERBATIM)
  endif()
endif()
