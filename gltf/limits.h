// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// The limits on glTF files. All readers share this table. A file that exceeds a limit is rejected
// with kLimit, except where a comment says that the surplus is cut.
namespace furrow::gltf {

// Container and JSON.
inline constexpr std::uint64_t kMaxFileBytes = 1ull << 30;  // a file; also all its buffers together
inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::size_t kMaxJsonValues = 4'000'000;  // strings count once, whatever their size
inline constexpr std::size_t kMaxBuffers = 256;
inline constexpr std::size_t kMaxDracoMeshes = 4096;

// Accessors.
inline constexpr std::size_t kMaxAccessorNumbers = 128'000'000;  // elements x components
inline constexpr std::size_t kMaxByteStride = 252;               // glTF 2.0, section 5.11

// Scene.
inline constexpr std::size_t kMaxNodes = 65'536;
inline constexpr std::size_t kMaxNameBytes = 240;  // longer joint names are cut
inline constexpr std::size_t kMaxMaterials = 1024;
inline constexpr std::size_t kMaxImages = 64;
inline constexpr std::size_t kMaxVertices = 8u << 20;  // of one mesh, and of all meshes
inline constexpr std::size_t kMaxIndices = 48u << 20;  // of one mesh, and of all meshes
inline constexpr int kMaxInfluenceSets = 4;            // JOINTS_0 to JOINTS_3; more are ignored
inline constexpr std::size_t kMaxMorphTargets = 2048;  // of one mesh
inline constexpr std::size_t kMaxAllMorphTargets = 65'536;     // of all meshes
inline constexpr std::size_t kMaxMorphElements = 128'000'000;  // vertices read for all targets
inline constexpr std::size_t kMaxMorphDeltas = 16u << 20;      // kept: vertices that targets move

// Animation.
inline constexpr std::size_t kMaxChannels = 65'536;
inline constexpr std::size_t kMaxAnimationNumbers = 128'000'000;  // all keys of all channels
inline constexpr std::size_t kMaxVrmNodes = 2048;                 // human bones; expressions
inline constexpr std::size_t kMaxVrmBinds = 65'536;               // of all expressions

// Further warnings are counted and summarised in one line.
inline constexpr std::size_t kMaxWarnings = 32;

}  // namespace furrow::gltf
