// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_pose_reader.h"

#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "base/asset_path.h"
#include "base/status.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::rig {
namespace {

using wrinkle::FieldAt;
using wrinkle::InvalidField;

// Reads reference poses in the order of the file. A mix first reads its parts, recursively.
class PoseReader {
 public:
  PoseReader(const TableList<schema::ReferencePose>* list, const std::filesystem::path& folder,
             const wrinkle::PoseSource& source, wrinkle::Skeleton* recorded,
             std::set<std::string>* missing, const PoseAnchors& anchors)
      : list_(list),
        folder_(folder),
        source_(source),
        recorded_(recorded),
        missing_(missing),
        anchors_(anchors) {}

  Status Run(std::vector<wrinkle::ReferencePose>* poses) {
    // The limit comes before any reading, so that a hostile file cannot make this load thousands of
    // recordings.
    const std::size_t count = list_ == nullptr ? 0 : list_->size();
    if (count > wrinkle::kMaxReferencePoses) {
      return {StatusCode::kLimit,
              "more than " + std::to_string(wrinkle::kMaxReferencePoses) + " poses",
              "reference_poses"};
    }
    // All names first: a mix may precede its parts.
    for (std::size_t i = 0; i < count; ++i) {
      if (!index_.emplace(list_->Get(i)->name()->str(), i).second) {
        return InvalidField("the name '" + list_->Get(i)->name()->str() + "' is given twice",
                            FieldAt("reference_poses", i) + ".name");
      }
    }
    poses_.resize(count);
    state_.resize(count, State::kUntouched);
    for (std::size_t i = 0; i < count; ++i) {
      FURROW_RETURN_IF_ERROR(Resolve(i));
    }
    *poses = std::move(poses_);
    return {};
  }

 private:
  // kOpen marks the poses on the current path of mixes. A part in this state closes a cycle. A path
  // is at most as deep as the number of poses.
  enum class State { kUntouched, kOpen, kDone };

  Status Resolve(std::size_t i) {
    if (state_[i] == State::kDone) return {};
    state_[i] = State::kOpen;
    const schema::ReferencePose& pose = *list_->Get(i);
    const std::string at = FieldAt("reference_poses", i);
    const bool is_list = pose.joints() != nullptr || pose.shapes() != nullptr;
    const int ways = is_list + (pose.file() != nullptr) + (pose.mix() != nullptr);
    if (ways != 1) {
      return InvalidField(
          "a reference pose needs exactly one of joints or shapes, file and mix, not " +
              std::to_string(ways),
          at);
    }
    Status status = is_list                  ? ReadLists(pose, at, &poses_[i])
                    : pose.file() != nullptr ? ReadFrame(pose, at, &poses_[i])
                                             : ReadMix(pose, at, &poses_[i]);
    state_[i] = State::kDone;
    return status;
  }

  static Status ReadLists(const schema::ReferencePose& from, const std::string& at,
                          wrinkle::ReferencePose* to) {
    to->name = from.name()->str();
    to->source_size = from.source_size();
    if (from.shapes() != nullptr && from.shapes()->size() > wrinkle::kMaxPoseShapes) {
      return {StatusCode::kLimit,
              "more than " + std::to_string(wrinkle::kMaxPoseShapes) + " blend shapes",
              at + ".shapes"};
    }
    FURROW_RETURN_IF_ERROR(ForEach(
        from.shapes(), at + ".shapes", [&](const schema::ShapePose& shape, const std::string&) {
          to->shapes.push_back({shape.blend_shape()->str(), shape.value()});
          return Status();
        }));
    // A rotation is a quaternion or Euler angles, never both. Without either, the joint keeps its
    // rest rotation.
    return ForEach(from.joints(), at + ".joints",
                   [&](const schema::JointPose& joint, const std::string& where) -> Status {
                     wrinkle::JointDelta delta;
                     delta.joint = joint.joint()->str();
                     if (joint.rotation() != nullptr && joint.euler_degrees() != nullptr) {
                       return InvalidField("rotation and euler_degrees are both set",
                                           where + ".euler_degrees", "remove one of them");
                     }
                     // The file has x, y, z, w; glm's constructor takes w first.
                     if (const schema::Quat* q = joint.rotation()) {
                       delta.rotation = glm::quat(q->w(), q->x(), q->y(), q->z());
                       const float square = glm::dot(delta.rotation, delta.rotation);
                       const bool hand_rounded = std::abs(square - 1.0f) > 1e-6f;
                       // Removes rounding errors of numbers written by hand. CheckRig() rejects
                       // larger ones.
                       if (hand_rounded && std::abs(square - 1.0f) < 2e-3f) {
                         delta.rotation = glm::normalize(delta.rotation);
                       }
                     }
                     if (joint.euler_degrees() != nullptr) {
                       delta.rotation = FromEulerDegrees(ToVec3(*joint.euler_degrees()));
                     }
                     if (joint.translation() != nullptr) {
                       delta.translation = ToVec3(*joint.translation());
                     }
                     to->joints.push_back(std::move(delta));
                     return {};
                   });
  }

  // Reads one frame. The error's `where` becomes the rig's field, so the recording's own place
  // moves into the text.
  Result<wrinkle::PoseFrame> Frame(const std::filesystem::path& path, int frame,
                                   const std::string& where) {
    if (frame < 0) return InvalidField("negative frame; frames are counted from 0", where);
    Result<wrinkle::PoseFrame> result = source_(path, frame);
    if (result.ok()) return result;
    const Status s = result.status();
    const std::string what = s.where().empty() ? s.what() : s.where() + ": " + s.what();
    return Status(s.code(), what, where, s.todo());
  }

  Status ReadFrame(const schema::ReferencePose& from, const std::string& at,
                   wrinkle::ReferencePose* to) {
    if (!source_) {
      return {StatusCode::kUnsupported, "this program cannot read poses from recordings",
              at + ".file", "write the pose as joints"};
    }
    const Result<std::filesystem::path> path = FindAsset(from.file()->string_view(), folder_);
    if (path.status().code() == StatusCode::kNotFound && missing_ != nullptr) {
      missing_->insert(from.file()->str());
      to->name = from.name()->str();
      return {};
    }
    if (!path.ok()) {
      const Status s = path.status();
      return {s.code(), s.what(), at + ".file", s.todo()};
    }
    const Result<wrinkle::PoseFrame> frame = Frame(*path, from.frame(), at + ".frame");
    FURROW_RETURN_IF_ERROR(frame);
    // A negative rest_frame means the skeleton's own rest pose.
    Result<wrinkle::PoseFrame> rest = Status(StatusCode::kNotFound, {});
    if (from.rest_frame() >= 0) {
      rest = Frame(*path, from.rest_frame(), at + ".rest_frame");
      FURROW_RETURN_IF_ERROR(rest);
    }
    if (recorded_->num_joints() == 0) *recorded_ = frame->skeleton;
    Result<wrinkle::ReferencePose> pose =
        ReferencePoseFromFrame(from.name()->str(), *frame, rest.ok() ? &*rest : nullptr, anchors_);
    if (!pose.ok()) return pose.status().At(at + ".file");
    *to = std::move(*pose);
    return {};
  }

  Status ReadMix(const schema::ReferencePose& from, const std::string& at,
                 wrinkle::ReferencePose* to) {
    std::vector<std::size_t> parts;
    std::vector<float> weights;
    const auto resolve = [&](const schema::MixPart& part, const std::string& where) -> Status {
      const auto found = index_.find(part.pose()->str());
      if (found == index_.end()) {
        return InvalidField("there is no reference pose '" + part.pose()->str() + "'",
                            where + ".pose");
      }
      if (state_[found->second] == State::kOpen) {
        return {StatusCode::kCyclic, "the mix contains itself through '" + part.pose()->str() + "'",
                where + ".pose"};
      }
      // The negation also rejects NaN.
      if (!(std::abs(part.weight()) <= 10.0f)) {
        return InvalidField("the weight must be a number in [-10, 10]", where + ".weight");
      }
      parts.push_back(found->second);
      weights.push_back(part.weight());
      return Resolve(found->second);
    };
    FURROW_RETURN_IF_ERROR(ForEach(from.mix(), at + ".mix", resolve));
    if (parts.empty()) return InvalidField("a mix needs at least one part", at + ".mix");
    // Pointers into poses_ stay valid: the list has its final size.
    std::vector<WeightedPose> weighted;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      weighted.push_back({&poses_[parts[i]], weights[i]});
    }
    *to = MixReferencePoses(from.name()->str(), weighted);
    return {};
  }

  const TableList<schema::ReferencePose>* list_;
  const std::filesystem::path& folder_;
  const wrinkle::PoseSource& source_;
  wrinkle::Skeleton* recorded_;
  std::set<std::string>* missing_;
  const PoseAnchors& anchors_;
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<wrinkle::ReferencePose> poses_;
  std::vector<State> state_;
};

}  // namespace

Status ReadReferencePoses(const TableList<schema::ReferencePose>* list,
                          const std::filesystem::path& folder, const wrinkle::PoseSource& source,
                          std::vector<wrinkle::ReferencePose>* poses, wrinkle::Skeleton* recorded,
                          std::set<std::string>* missing, const PoseAnchors& anchors) {
  return PoseReader(list, folder, source, recorded, missing, anchors).Run(poses);
}

}  // namespace furrow::rig
