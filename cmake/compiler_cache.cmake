# ccache where it is installed and nobody chose another launcher.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(LIBSLAM_CCACHE ccache)
  mark_as_advanced(LIBSLAM_CCACHE)
  if(LIBSLAM_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${LIBSLAM_CCACHE})
  endif()
endif()
