// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time/timecode.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

// The types that all readers and writers of recordings share. motion/clip_file.h loads and saves
// clips by file type.
namespace furrow::motion {

// A recorded performance of one subject, sampled at `times`.
struct Clip {
  std::string name;
  wrinkle::Skeleton skeleton;  // may be empty: blend shapes alone
  std::vector<std::string> blend_shape_names;
  std::vector<double> times;               // seconds, strictly increasing, one per frame
  std::vector<wrinkle::Transform> locals;  // local transforms, num_frames x num_joints, frame-major
  std::vector<float> blend_shapes;         // num_frames x num names, frame-major
  // The source's timecodes, one per frame. Empty: none.
  std::vector<std::optional<Timecode>> timecodes;

  [[nodiscard]] int num_frames() const { return static_cast<int>(times.size()); }
  // Seconds from the first frame to the last.
  [[nodiscard]] double duration() const {
    return times.empty() ? 0.0 : times.back() - times.front();
  }
  // Copies frame `frame`, in [0, num_frames), to `pose`.
  void GetPose(int frame, wrinkle::LocalPose* pose) const;
};

// The meaning of a BVH joint's position channels, which the format does not define.
// - kReplace: they replace the joint's OFFSET, as in most tools.
// - kAdd: they are added to it.
// - kOffsets: only those of roots count; all other joints keep their OFFSET.
// - kAuto: kReplace, but kAdd below roots if kReplace would collapse the body (bvh_positions.h).
// An axis without a channel keeps the OFFSET. With any of them, LoadClip() keeps the OFFSET of a
// root whose position is 0 in every frame; MakeHuman writes such files.
enum class BvhPositions { kAuto, kReplace, kAdd, kOffsets };

// The word of --bvh-positions: auto, channels (or replace), add, offsets. nullopt for others.
[[nodiscard]] std::optional<BvhPositions> ParseBvhPositions(std::string_view word);
inline constexpr char kBvhPositionsWords[] = "auto, channels, offsets or add";

// The axis that points up in a BVH file, which the format does not define. FindUpAxis() and
// MovesAlongZ() implement kAuto. A loaded clip is always Y up and faces +Z.
enum class UpAxis { kAuto, kY, kZ };

// The word of --up-axis: auto, y or z. nullopt for others.
[[nodiscard]] std::optional<UpAxis> ParseUpAxis(std::string_view word);

// How a recording is read. Each reader uses the options of its format.
struct LoadOptions {
  float scale = 1.0f;        // multiplies every length, to convert it to metres
  double sample_rate = 0.0;  // Hz, for formats that store curves (glTF); 0: the file's own keys
  BvhPositions bvh_positions = BvhPositions::kAuto;
  UpAxis up_axis = UpAxis::kAuto;  // BVH only
  int rest_frame = -1;             // the frame that is the rest pose; -1: the file's own rest pose
  double timecode_rate = 0.0;  // frames per second of a Live Link Face CSV's timecode; 0: inferred
  // For files with several animations (takes): the name of one, or its index from 0. Empty: the
  // first. "FILE#NAME" as a path takes precedence; see SplitClipPath().
  std::string animation;
};

// An animation (take) of a file.
struct AnimationInfo {
  std::string name;  // may be empty
  double seconds = 0.0;
};

// What a reader tolerated, or what a writer could not express in its format. One sentence per
// entry, with the place: "take.bvh:186: states 100 frames, holds 99".
struct ClipReport {
  std::vector<std::string> warnings;
  std::vector<AnimationInfo> animations;  // glTF, FBX and Collada: all of the file's
};

}  // namespace furrow::motion
