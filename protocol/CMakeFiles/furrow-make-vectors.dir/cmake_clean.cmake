file(REMOVE_RECURSE
  "../bin/furrow-make-vectors"
  "../bin/furrow-make-vectors.pdb"
  "CMakeFiles/furrow-make-vectors.dir/vectors/make_vectors.cpp.o"
  "CMakeFiles/furrow-make-vectors.dir/vectors/make_vectors.cpp.o.d"
)

# Per-language clean rules from dependency scanning.
foreach(lang CXX)
  include(CMakeFiles/furrow-make-vectors.dir/cmake_clean_${lang}.cmake OPTIONAL)
endforeach()
