// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "base/status.h"

// The package for browsers, which client/js/furrow-three/tools/pack_character.mjs makes of a
// character package.
namespace furrow::character {

inline constexpr std::size_t kMaxWebPackageBytes = 4'000'000;

// Where the package for browsers lies: "<stem>.web.glb" beside the .glb file.
[[nodiscard]] std::filesystem::path WebPackageBeside(const std::filesystem::path& glb);

// Checks that `web` was made of `glb` and of the rig beside it, as they are now: it states their
// sizes and checksums in the scene extra `furrow_source`. The checksum finds outdated packages; it
// does not protect against forged ones.
//
// Errors: kIo, kParse, kLimit (above kMaxWebPackageBytes), kSchema (no furrow_source),
// kInvalidArgument (made of another version). `where` is the file, and `todo` the command that
// makes it again.
[[nodiscard]] Status CheckWebPackage(const std::filesystem::path& web,
                                     const std::filesystem::path& glb);

// The 32-bit FNV-1a checksum of `bytes`.
[[nodiscard]] std::uint32_t Checksum(std::string_view bytes);

}  // namespace furrow::character
