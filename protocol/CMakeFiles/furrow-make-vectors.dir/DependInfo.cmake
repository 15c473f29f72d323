
# Consider dependencies only in project.
set(CMAKE_DEPENDS_IN_PROJECT_ONLY OFF)

# The set of languages for which implicit dependencies are needed:
set(CMAKE_DEPENDS_LANGUAGES
  )

# The set of dependency files which are needed:
set(CMAKE_DEPENDS_DEPENDENCY_FILES
  "/tmp/hp/protocol/vectors/make_vectors.cpp" "protocol/CMakeFiles/furrow-make-vectors.dir/vectors/make_vectors.cpp.o" "gcc" "protocol/CMakeFiles/furrow-make-vectors.dir/vectors/make_vectors.cpp.o.d"
  )

# Targets to which this target links.
set(CMAKE_TARGET_LINKED_INFO_FILES
  "/tmp/hp/protocol/CMakeFiles/furrow_protocol.dir/DependInfo.cmake"
  )

# Fortran module output directory.
set(CMAKE_Fortran_TARGET_MODULE_DIR "")
