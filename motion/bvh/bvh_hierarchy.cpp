// SPDX-License-Identifier: Apache-2.0
#include "motion/bvh/bvh_hierarchy.h"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "base/ascii.h"
#include "base/numbers.h"
#include "base/status.h"
#include "base/text.h"
#include "motion/clip/clip.h"

namespace furrow::motion {
namespace {

using wrinkle::JointDesc;
using wrinkle::kNoJoint;

constexpr int kMaxNameBytes = 255;

std::optional<BvhChannel> FindChannel(std::string_view name) {
  static constexpr std::pair<std::string_view, BvhChannel> kNames[] = {
      {"Xposition", BvhChannel::kXPosition}, {"Yposition", BvhChannel::kYPosition},
      {"Zposition", BvhChannel::kZPosition}, {"Xrotation", BvhChannel::kXRotation},
      {"Yrotation", BvhChannel::kYRotation}, {"Zrotation", BvhChannel::kZRotation}};
  for (const auto& [text, channel] : kNames) {
    if (EqualsIgnoreCase(text, name)) return channel;
  }
  return std::nullopt;
}

// Parses nested joints with an explicit stack, so that a deep file cannot exhaust the call stack.
class HierarchyParser {
 public:
  HierarchyParser(TextCursor* cursor, ClipReport* report) : cursor_(*cursor), report_(report) {}

  Result<BvhHierarchy> Run() {
    FURROW_RETURN_IF_ERROR(Expect("HIERARCHY"));
    while (true) {
      const std::string_view token = cursor_.NextToken();
      Status status;
      // `open_` is the path from the root to the current joint. Properties are valid inside a joint
      // only, MOTION outside only.
      if (token == "}") {
        status = CloseJoint();
      } else if (open_.empty() && EqualsIgnoreCase(token, "MOTION")) {
        break;
      } else if (EqualsIgnoreCase(token, open_.empty() ? "ROOT" : "JOINT")) {
        status = OpenJoint();
      } else if (!open_.empty()) {
        status = ReadProperty(token);
      } else {
        status = Unexpected(token, "ROOT or MOTION");
      }
      if (!status.ok()) return status;
    }
    if (hierarchy_.joints.empty()) return cursor_.Error(StatusCode::kParse, "there is no ROOT");
    return std::move(hierarchy_);
  }

 private:
  struct Open {
    int joint;
    bool has_offset = false;
    bool has_channels = false;
  };

  Status Unexpected(std::string_view token, std::string_view wanted) const {
    std::string what = "expected " + std::string(wanted) + ", found " +
                       (token.empty() ? "the end of the file" : Quoted(token));
    return cursor_.Error(StatusCode::kParse, std::move(what),
                         token.empty() ? "the file seems to be cut off" : "");
  }

  Status Expect(std::string_view keyword) {
    const std::string_view token = cursor_.NextToken();
    return EqualsIgnoreCase(token, keyword) ? Status() : Unexpected(token, keyword);
  }

  // A name extends to the end of the line: 3ds Max writes "ROOT Bip01 Pelvis".
  Status OpenJoint() {
    const std::string name(cursor_.RestOfLine());
    if (name.empty()) return cursor_.Error(StatusCode::kParse, "the joint has no name");
    if (name.size() > kMaxNameBytes) {
      return cursor_.Error(StatusCode::kLimit, "the joint's name is longer than 255 bytes");
    }
    if (!names_.insert(name).second) {
      return cursor_.Error(StatusCode::kParse, "several joints are named " + Quoted(name),
                           "rename one of them");
    }
    if (hierarchy_.joints.size() >= static_cast<std::size_t>(wrinkle::kMaxJoints)) {
      return cursor_.Error(StatusCode::kLimit,
                           "more than " + std::to_string(wrinkle::kMaxJoints) + " joints");
    }
    FURROW_RETURN_IF_ERROR(Expect("{"));
    JointDesc joint;
    joint.name = name;
    joint.parent = open_.empty() ? kNoJoint : open_.back().joint;
    open_.push_back({.joint = static_cast<int>(hierarchy_.joints.size())});
    hierarchy_.joints.push_back(std::move(joint));
    hierarchy_.channels.emplace_back();
    return {};
  }

  // Without an OFFSET the bone's length would silently be 0.
  Status CloseJoint() {
    if (open_.empty()) return Unexpected("}", "ROOT or MOTION");
    if (!open_.back().has_offset) {
      return cursor_.Error(StatusCode::kParse,
                           "joint " + Quoted(Current().name) + " has no OFFSET");
    }
    open_.pop_back();
    return {};
  }

  Status ReadProperty(std::string_view token) {
    if (EqualsIgnoreCase(token, "OFFSET")) {
      open_.back().has_offset = true;
      return ReadVector(&Current().rest.translation);
    }
    if (EqualsIgnoreCase(token, "CHANNELS")) return ReadChannels();
    if (EqualsIgnoreCase(token, "End")) return ReadEndSite();
    return Unexpected(token, "OFFSET, CHANNELS, JOINT, End Site or }");
  }

  Status ReadVector(glm::vec3* vector) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view token = cursor_.NextToken();
      if (token.empty()) return Unexpected(token, "a number");
      const Result<double> number = ParseNumber(token, cursor_.Where());
      FURROW_RETURN_IF_ERROR(number);
      (*vector)[axis] = static_cast<float>(*number);
    }
    return {};
  }

  Status ReadChannels() {
    if (open_.back().has_channels) {
      return cursor_.Error(StatusCode::kParse, "the joint has a second CHANNELS");
    }
    open_.back().has_channels = true;
    const std::string_view token = cursor_.NextToken();
    const Result<double> count = ParseNumber(token, cursor_.Where());
    FURROW_RETURN_IF_ERROR(count);
    // The bounds come first: a cast of a number beyond an int is undefined.
    if (*count < 0.0 || *count > 6.0 || *count != static_cast<int>(*count)) {
      return cursor_.Error(StatusCode::kParse, "a joint has 0 to 6 channels, not " + Quoted(token));
    }
    BvhJointChannels& channels = hierarchy_.channels.back();
    // `channels` has one entry per joint in order, and a child has already appended its own.
    if (open_.back().joint != static_cast<int>(hierarchy_.joints.size()) - 1) {
      return cursor_.Error(StatusCode::kParse, "CHANNELS must come before the joint's children");
    }
    for (int i = 0; i < static_cast<int>(*count); ++i) {
      FURROW_RETURN_IF_ERROR(ReadChannel(&channels));
    }
    // An understated count would shift every number of every frame.
    if (FindChannel(cursor_.PeekToken())) {
      return cursor_.Error(StatusCode::kParse, "there are more channel names than CHANNELS states");
    }
    hierarchy_.num_channels += static_cast<std::size_t>(channels.count);
    return {};
  }

  // A rotation axis may occur twice (Z X Z), a position axis may not.
  Status ReadChannel(BvhJointChannels* channels) {
    const std::string_view token = cursor_.NextToken();
    const std::optional<BvhChannel> channel = FindChannel(token);
    if (!channel) {
      if (EqualsIgnoreCase(token, "Xscale") || EqualsIgnoreCase(token, "Yscale") ||
          EqualsIgnoreCase(token, "Zscale")) {
        return cursor_.Error(StatusCode::kUnsupported, "scale channels are not supported",
                             "export without scale");
      }
      return Unexpected(token, "a channel name (Xposition, ..., Zrotation)");
    }
    for (int i = 0; *channel <= BvhChannel::kZPosition && i < channels->count; ++i) {
      if (channels->channels[static_cast<std::size_t>(i)] == *channel) {
        return cursor_.Error(StatusCode::kParse, "channel " + Quoted(token) + " occurs twice");
      }
    }
    channels->channels[static_cast<std::size_t>(channels->count++)] = *channel;
    return {};
  }

  Status ReadEndSite() {
    FURROW_RETURN_IF_ERROR(Expect("Site"));
    cursor_.RestOfLine();  // some exporters write a name here
    FURROW_RETURN_IF_ERROR(Expect("{"));
    FURROW_RETURN_IF_ERROR(Expect("OFFSET"));
    glm::vec3 tail(0.0f);
    FURROW_RETURN_IF_ERROR(ReadVector(&tail));
    FURROW_RETURN_IF_ERROR(Expect("}"));
    if (!Current().tail) {
      Current().tail = tail;
    } else if (report_ != nullptr) {
      report_->warnings.push_back(cursor_.Where() + ": joint " + Quoted(Current().name) +
                                  " has several End Sites; the first counts");
    }
    return {};
  }

  JointDesc& Current() { return hierarchy_.joints[static_cast<std::size_t>(open_.back().joint)]; }

  TextCursor& cursor_;
  ClipReport* report_;
  BvhHierarchy hierarchy_;
  std::vector<Open> open_;
  std::unordered_set<std::string> names_;
};

}  // namespace

Result<BvhHierarchy> ParseBvhHierarchy(TextCursor* cursor, ClipReport* report) {
  return HierarchyParser(cursor, report).Run();
}

}  // namespace furrow::motion
