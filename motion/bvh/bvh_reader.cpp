// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/ascii.h"
#include "base/numbers.h"
#include "base/status.h"
#include "base/text.h"
#include "base/text_cursor.h"
#include "motion/bvh/bvh.h"
#include "motion/bvh/bvh_hierarchy.h"
#include "motion/bvh/bvh_positions.h"
#include "motion/clip/limits.h"

namespace furrow::motion {
namespace {

using wrinkle::Transform;

struct MotionHeader {
  std::size_t stated_frames = 0;
  double frame_time = 0.0;  // seconds
};

// Reads the value in "Frames: 12", "Frames:12", "Frames : 12" or "Frame Time: .0083333".
Result<double> ReadHeaderNumber(TextCursor* cursor, std::string_view keyword) {
  std::string_view line;
  if (!cursor->NextLine(&line)) {
    return cursor->Error(StatusCode::kParse, "expected '" + std::string(keyword) + ":'",
                         "the file seems to be cut off");
  }
  const std::size_t colon = line.find(':');
  std::string_view before = line.substr(0, colon == std::string_view::npos ? 0 : colon);
  std::string found(TakeToken(&before));
  for (std::string_view word = TakeToken(&before); !word.empty(); word = TakeToken(&before)) {
    found.append(" ").append(word);
  }
  if (!EqualsIgnoreCase(found, keyword)) {
    return cursor->Error(StatusCode::kParse, "expected '" + std::string(keyword) + ":'");
  }
  std::string_view rest = line.substr(colon + 1);
  const std::string_view token = TakeToken(&rest);
  if (!TakeToken(&rest).empty()) {
    return cursor->Error(StatusCode::kParse, "more than one number after '" + found + ":'");
  }
  return ParseNumber(token, cursor->Where());
}

// Files with a single pose often state no frame time. Files with motion must.
constexpr double kDefaultFrameTime = 1.0 / 30.0;

// The two lines after MOTION. The count of frames is only a claim: memory grows with the frames
// that are read.
Result<MotionHeader> ReadMotionHeader(TextCursor* cursor, ClipReport* report) {
  MotionHeader header;
  const Result<double> frames = ReadHeaderNumber(cursor, "Frames");
  FURROW_RETURN_IF_ERROR(frames);
  if (*frames < 0.0 || *frames != std::floor(*frames)) {
    return cursor->Error(StatusCode::kParse, "'Frames:' is not a count");
  }
  if (*frames > static_cast<double>(kMaxFrames)) {
    return cursor->Error(StatusCode::kLimit, "more than " + std::to_string(kMaxFrames) + " frames");
  }
  header.stated_frames = static_cast<std::size_t>(*frames);
  const Result<double> time = ReadHeaderNumber(cursor, "Frame Time");
  FURROW_RETURN_IF_ERROR(time);
  header.frame_time = *time;
  if (*time <= 0.0) {
    if (*time < 0.0 || header.stated_frames > 1) {
      return cursor->Error(StatusCode::kParse, "'Frame Time:' must be greater than 0");
    }
    header.frame_time = kDefaultFrameTime;
    if (report != nullptr) {
      report->warnings.push_back(cursor->Where() + ": the frame time is 0; 1/30 s is used");
    }
  }
  return header;
}

// The quaternion of a turn about a coordinate axis (0 to 2). Double, because up to three are
// multiplied per joint.
glm::dquat AxisRotation(int axis, double degrees) {
  const double half = degrees * (std::numbers::pi / 360.0);
  glm::dquat rotation(std::cos(half), 0.0, 0.0, 0.0);
  rotation[axis] = std::sin(half);  // glm 0.9.9's operator[] orders x, y, z, w
  return rotation;
}

// One joint's channel values in one frame, in the file's unit. kAuto is decided after all frames
// (AddPositionsThatCollapse()).
Transform MakeLocal(const BvhJointChannels& channels, const double* values, const glm::vec3& offset,
                    BvhPositions positions) {
  const bool keep = positions == BvhPositions::kOffsets;
  glm::dvec3 translation(offset);
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < channels.count; ++i) {
    const int channel = static_cast<int>(channels.channels[static_cast<std::size_t>(i)]);
    if (channel < 3) {
      if (keep) continue;
      translation[channel] = values[i] + (positions == BvhPositions::kAdd ? offset[channel] : 0.0);
    } else {
      // Channels apply in the order of the file, each about the axes that the ones before have
      // turned.
      rotation = rotation * AxisRotation(channel - 3, values[i]);
    }
  }
  Transform local;
  local.translation = glm::vec3(translation);
  local.rotation = glm::quat(glm::normalize(rotation));
  return local;
}

// Reads the frames of MOTION into a clip with a complete skeleton.
class FrameReader {
 public:
  FrameReader(TextCursor* cursor, const BvhHierarchy& hierarchy, const LoadOptions& options)
      : cursor_(*cursor),
        hierarchy_(hierarchy),
        options_(options),
        values_(hierarchy.num_channels) {}

  Status Run(const MotionHeader& header, Clip* clip, ClipReport* report) {
    const std::size_t num_joints = hierarchy_.joints.size();
    std::string_view line;
    while (cursor_.NextLine(&line)) {
      const std::size_t frame = clip->times.size();
      if (frame >= kMaxFrames || (frame + 1) * num_joints > kMaxTransforms) {
        return cursor_.Error(StatusCode::kLimit, "more than " + std::to_string(frame) +
                                                     " frames of " + std::to_string(num_joints) +
                                                     " joints");
      }
      FURROW_RETURN_IF_ERROR(ReadValues(line));
      FURROW_RETURN_IF_ERROR(AppendFrame(clip));
      clip->times.push_back(static_cast<double>(frame) * header.frame_time);
    }
    return CheckCount(header, clip->times.size(), report);
  }

 private:
  Status ReadValues(std::string_view line) {
    std::size_t count = 0;
    for (std::string_view rest = line;; ++count) {
      const std::string_view token = TakeToken(&rest);
      if (token.empty()) break;
      if (count >= values_.size()) continue;  // still counted, for the message
      if (!TryParseNumber(token, &values_[count])) {
        return ParseNumber(token, cursor_.Where()).status();
      }
    }
    if (count == values_.size()) return {};
    return cursor_.Error(StatusCode::kParse,
                         "the frame has " + std::to_string(count) + " numbers, the hierarchy has " +
                             std::to_string(values_.size()) + " channels",
                         cursor_.line_was_ended() ? "" : "the file seems to be cut off");
  }

  Status AppendFrame(Clip* clip) {
    const std::size_t num_joints = hierarchy_.joints.size();
    const double* values = values_.data();
    for (std::size_t j = 0; j < num_joints; ++j) {
      const BvhJointChannels& channels = hierarchy_.channels[j];
      const bool is_root = hierarchy_.joints[j].parent == wrinkle::kNoJoint;
      // A root has no other way to travel.
      const bool travels = is_root && options_.bvh_positions == BvhPositions::kOffsets;
      Transform local = MakeLocal(channels, values, hierarchy_.joints[j].rest.translation,
                                  travels ? BvhPositions::kReplace : options_.bvh_positions);
      // Finite numbers can leave the range of a float when they are added or scaled.
      local.translation *= options_.scale;
      if (!wrinkle::IsValid(local)) {
        return cursor_.Error(
            StatusCode::kNonFinite,
            "the values of joint '" + hierarchy_.joints[j].name + "' are out of range");
      }
      KeepSign(*clip, num_joints, &local.rotation);
      clip->locals.push_back(local);
      values += channels.count;
    }
    return {};
  }

  // q and -q are the same rotation. Takes the one closer to the previous frame, so that later
  // interpolation follows the shorter arc.
  static void KeepSign(const Clip& clip, std::size_t num_joints, glm::quat* rotation) {
    const std::size_t at = clip.locals.size();
    const float sign =
        at < num_joints ? rotation->w : glm::dot(*rotation, clip.locals[at - num_joints].rotation);
    if (sign < 0.0f) *rotation = -*rotation;
  }

  Status CheckCount(const MotionHeader& header, std::size_t frames, ClipReport* report) const {
    const std::string difference = "'Frames:' states " + std::to_string(header.stated_frames) +
                                   ", the file holds " + std::to_string(frames);
    // A file that ends within a line was cut off. A wrong count in a complete file is a common
    // error of exporters.
    if (frames == 0 || (frames < header.stated_frames && !cursor_.line_was_ended())) {
      return cursor_.Error(StatusCode::kParse, difference, "the file seems to be cut off");
    }
    if (frames != header.stated_frames && report != nullptr) {
      report->warnings.push_back(cursor_.Where() + ": " + difference);
    }
    return {};
  }

  TextCursor& cursor_;
  const BvhHierarchy& hierarchy_;
  const LoadOptions& options_;
  std::vector<double> values_;
};

Result<wrinkle::Skeleton> MakeSkeleton(const BvhHierarchy& hierarchy, float scale,
                                       std::string_view source_name) {
  // The frames use the unscaled offsets, so the scale applies to a copy.
  std::vector<wrinkle::JointDesc> joints = hierarchy.joints;
  for (wrinkle::JointDesc& joint : joints) {
    joint.rest.translation *= scale;
    if (joint.tail) *joint.tail *= scale;
  }
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(std::move(joints));
  if (!skeleton.ok()) return skeleton.status().At(source_name);
  return skeleton;
}

}  // namespace

Result<Clip> ParseBvh(std::string_view text, std::string_view source_name,
                      const LoadOptions& options, ClipReport* report) {
  TextCursor cursor(text, source_name);
  if (text.size() > kMaxFileBytes)
    return cursor.Error(StatusCode::kLimit, "the file is larger than 512 MiB");
  if (!std::isfinite(options.scale) || options.scale <= 0.0f) {
    return Status(StatusCode::kInvalidArgument, "the scale must be greater than 0");
  }
  const Result<BvhHierarchy> hierarchy = ParseBvhHierarchy(&cursor, report);
  FURROW_RETURN_IF_ERROR(hierarchy);
  const Result<MotionHeader> header = ReadMotionHeader(&cursor, report);
  FURROW_RETURN_IF_ERROR(header);

  Clip clip;
  Result<wrinkle::Skeleton> skeleton = MakeSkeleton(*hierarchy, options.scale, source_name);
  FURROW_RETURN_IF_ERROR(skeleton);
  clip.skeleton = std::move(*skeleton);
  FrameReader reader(&cursor, *hierarchy, options);
  FURROW_RETURN_IF_ERROR(reader.Run(*header, &clip, report));
  if (options.bvh_positions == BvhPositions::kAuto) {
    AddPositionsThatCollapse(*hierarchy, options.scale, source_name, &clip, report);
  }
  return clip;
}

}  // namespace furrow::motion
