// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"

namespace furrow::server {

// The folder for files that only save time: the first folder of $CACHE_DIRECTORY (systemd's
// CacheDirectory=), $XDG_CACHE_HOME/furrow or $HOME/.cache/furrow. Empty if none of them is set to
// an absolute path.
[[nodiscard]] std::filesystem::path CacheFolder();

// Creates `folder`, for its owner alone. Errors: kIo (it cannot be created), kInvalidArgument (it
// is not a folder, or somebody else owns it or may write to it: files of others must not reach a
// driver).
[[nodiscard]] Status PrepareCacheFolder(const std::filesystem::path& folder);

// Lets the OpenGL drivers keep compiled shaders below `folder`, at most kMaxShaderMegabytes of
// them, so that only the first start of a version compiles. What the user has set for them
// (MESA_SHADER_CACHE_DIR and the like) stays. Changes the environment of the process: call it
// before other threads start and before OpenGL is used.
void LetDriversCache(const std::filesystem::path& folder);
inline constexpr int kMaxShaderMegabytes = 128;  // per driver

}  // namespace furrow::server
