// SPDX-License-Identifier: Apache-2.0
// The one implementation of tinygltf in the program; its configuration is in CMakeLists.txt.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
