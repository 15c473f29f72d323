// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wrinkle/pose.h"
#include "wrinkle/skeleton.h"
#include "wrinkle/status.h"

namespace furrow::motion {

// A recorded performance of one subject, sampled: what every reader of this folder yields and every
// writer takes.
struct Clip {
  std::string name;
  wrinkle::Skeleton skeleton;                    // may be empty (0 joints): blend shapes alone
  std::vector<std::string> blend_shape_names;
  std::vector<double> times;                     // seconds, increasing, one a frame
  std::vector<wrinkle::Transform> locals;        // num_frames x num_joints, frame-major
  std::vector<float> blend_shapes;               // num_frames x num names, frame-major

  [[nodiscard]] int num_frames() const { return static_cast<int>(times.size()); }
  [[nodiscard]] double duration() const { return times.empty() ? 0.0 : times.back() - times.front(); }
  // Frame `frame` in [0, num_frames) as a pose.
  void GetPose(int frame, wrinkle::LocalPose* pose) const;
};

struct LoadOptions {
  float scale = 1.0f;          // multiplies every length (BVH has no unit)
  double sample_rate = 0.0;    // Hz for formats made of curves (glTF); 0: the file's own keys
};

// Reads a clip by its extension: .bvh, .glb/.gltf/.vrma, .csv (Live Link Face).
//
// Errors: kNotFound, kIo, kParse, kSchema, kLimit, kNonFinite, kUnsupported, with file and line
// (or field) in `where`.
[[nodiscard]] Result<Clip> LoadClip(const std::filesystem::path& path, const LoadOptions& options = {});

// Writes a clip by its extension: .bvh, .glb/.gltf, .csv. Nothing is left behind on failure.
[[nodiscard]] Status SaveClip(const Clip& clip, const std::filesystem::path& path);

}  // namespace furrow::motion
