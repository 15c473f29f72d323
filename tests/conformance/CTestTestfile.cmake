# CMake generated Testfile for 
# Source directory: /tmp/hp/tests/conformance
# Build directory: /tmp/hp/tests/conformance
# 
# This file includes the relevant testing commands required for 
# testing this directory and lists subdirectories to be tested as well.
add_test([=[conformance.vectors_are_current]=] "/tmp/hp/bin/furrow-make-vectors" "--check" "/tmp/hp/protocol/vectors")
set_tests_properties([=[conformance.vectors_are_current]=] PROPERTIES  LABELS "conformance" TIMEOUT "60" _BACKTRACE_TRIPLES "/tmp/hp/tests/conformance/CMakeLists.txt;5;add_test;/tmp/hp/tests/conformance/CMakeLists.txt;0;")
add_test([=[conformance.python_decodes_vectors]=] "/usr/bin/python3" "/tmp/hp/tests/conformance/decode.py" "--check" "/tmp/hp/protocol/vectors")
set_tests_properties([=[conformance.python_decodes_vectors]=] PROPERTIES  LABELS "conformance" TIMEOUT "60" _BACKTRACE_TRIPLES "/tmp/hp/tests/conformance/CMakeLists.txt;6;add_test;/tmp/hp/tests/conformance/CMakeLists.txt;0;")
