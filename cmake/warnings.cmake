# One interface target carries the warning flags of the project; it is never exported.
add_library(libslam_warnings INTERFACE)
target_compile_options(libslam_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
