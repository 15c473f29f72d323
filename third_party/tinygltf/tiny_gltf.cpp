// SPDX-License-Identifier: Apache-2.0
// The only translation unit that compiles tinygltf. CMakeLists.txt sets its options.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
