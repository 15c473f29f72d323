// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"

namespace furrow::motion {

// The recording that a user names, as a path for LoadClip() and for takes. An animation or a
// subject after '#' stays at its end.
//
// - A file that exists, and a name with a slash, is returned as it is. A slash says that a file is
//   meant, so a misspelt path does not select a shipped recording.
// - "performance" and "performance.bvh" are the shipped recording of that name
//   (share/furrow/recordings).
//
// Error: kNotFound (neither); the message says where it looked, and lists the shipped recordings.
[[nodiscard]] Result<std::filesystem::path> FindRecording(const std::string& name_or_path);

}  // namespace furrow::motion
