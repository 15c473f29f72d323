# CMake generated Testfile for 
# Source directory: /tmp/hp/protocol
# Build directory: /tmp/hp/protocol
# 
# This file includes the relevant testing commands required for 
# testing this directory and lists subdirectories to be tested as well.
