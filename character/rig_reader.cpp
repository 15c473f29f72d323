// SPDX-License-Identifier: Apache-2.0
#include "character/rig_reader.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "character/asset_path.h"
#include "character/rig_generated.h"
#include "character/rig_reference_pose.h"
#include "wrinkle/rig_check.h"
#include "wrinkle/rig_field.h"

namespace furrow::character {
namespace {

using flatbuffers::Offset;
using flatbuffers::String;
using flatbuffers::Vector;
using wrinkle::FieldAt;
using wrinkle::InvalidField;

template <class T>
using List = Vector<Offset<T>>;

std::string Text(const String* text) { return text == nullptr ? std::string() : text->str(); }

glm::vec3 ToVec3(const schema::Vec3& v) { return {v.x(), v.y(), v.z()}; }

// The schema's enumerations name the same things in the same order as wrinkle/rig.h's. JSON may
// also state one by number, and nobody has checked that number yet.
template <class To, class From>
Status Enum(From from, To* to, const std::string& where) {
  if (from < From::MIN || from > From::MAX) return InvalidField("there is no such choice", where);
  *to = static_cast<To>(from);
  return {};
}

// `each(entry, path)` for a list that may be absent; stops at the first failure.
template <class T, class Each>
Status ForEach(const List<T>* list, const std::string& path, Each each) {
  if (list == nullptr) return {};
  for (flatbuffers::uoffset_t i = 0; i < list->size(); ++i) {
    if (Status status = each(*list->Get(i), FieldAt(path, i)); !status.ok()) return status;
  }
  return {};
}

// Reference poses in the order of the file; mixes wait until their parts are known.
class PoseReader {
 public:
  PoseReader(const List<schema::ReferencePose>* list, const std::filesystem::path& folder,
             const wrinkle::PoseSource& source)
      : list_(list), folder_(folder), source_(source) {}

  Status Run(std::vector<wrinkle::ReferencePose>* poses) {
    const std::size_t count = list_ == nullptr ? 0 : list_->size();
    if (count > wrinkle::kMaxReferencePoses) {
      return {StatusCode::kLimit,
              "more than " + std::to_string(wrinkle::kMaxReferencePoses) + " poses",
              "reference_poses"};
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!index_.emplace(list_->Get(i)->name()->str(), i).second) {
        return InvalidField("the name '" + list_->Get(i)->name()->str() + "' is given twice",
                            FieldAt("reference_poses", i) + ".name");
      }
    }
    poses_.resize(count);
    state_.resize(count, State::kUntouched);
    for (std::size_t i = 0; i < count; ++i) {
      if (Status status = Resolve(i); !status.ok()) return status;
    }
    *poses = std::move(poses_);
    return {};
  }

 private:
  enum class State { kUntouched, kOpen, kDone };

  Status Resolve(std::size_t i) {
    if (state_[i] == State::kDone) return {};
    state_[i] = State::kOpen;
    const schema::ReferencePose& pose = *list_->Get(i);
    const std::string at = FieldAt("reference_poses", i);
    const int ways =
        (pose.joints() != nullptr) + (pose.file() != nullptr) + (pose.mix() != nullptr);
    if (ways != 1) {
      return InvalidField(
          "a reference pose has exactly one of joints, file and mix, not " + std::to_string(ways),
          at);
    }
    Status status = pose.joints() != nullptr ? ReadJoints(pose, at, &poses_[i])
                    : pose.file() != nullptr ? ReadFrame(pose, at, &poses_[i])
                                             : ReadMix(pose, at, &poses_[i]);
    state_[i] = State::kDone;
    return status;
  }

  static Status ReadJoints(const schema::ReferencePose& from, const std::string& at,
                           wrinkle::ReferencePose* to) {
    to->name = from.name()->str();
    to->source_size = from.source_size();
    return ForEach(from.joints(), at + ".joints",
                   [&](const schema::JointPose& joint, const std::string& where) -> Status {
                     wrinkle::JointDelta delta;
                     delta.joint = joint.joint()->str();
                     if (joint.rotation() != nullptr && joint.euler_degrees() != nullptr) {
                       return InvalidField("rotation and euler_degrees are both stated",
                                           where + ".euler_degrees", "leave one out");
                     }
                     if (const schema::Quat* q = joint.rotation()) {
                       delta.rotation = glm::quat(q->w(), q->x(), q->y(), q->z());
                       const float square = glm::dot(delta.rotation, delta.rotation);
                       const bool hand_rounded = std::abs(square - 1.0f) > 1e-6f;
                       // Near enough to a unit: CheckRig() judges. Exactly as written where it is
                       // one.
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

  Result<wrinkle::PoseFrame> Frame(const std::filesystem::path& path, int frame,
                                   const std::string& where) {
    if (frame < 0) return InvalidField("frames count from 0", where);
    Result<wrinkle::PoseFrame> result = source_(path, frame);
    if (result.ok()) return result;
    const Status s = result.status();
    const std::string what = s.where().empty() ? s.what() : s.where() + ": " + s.what();
    return Status(s.code(), what, where, s.todo());
  }

  Status ReadFrame(const schema::ReferencePose& from, const std::string& at,
                   wrinkle::ReferencePose* to) {
    if (!source_) {
      return {StatusCode::kUnsupported, "this program reads no recordings, so no pose from a file",
              at + ".file", "write the pose out as joints"};
    }
    const Result<std::filesystem::path> path = FindAsset(from.file()->string_view(), folder_);
    if (!path.ok()) {
      const Status s = path.status();
      return {s.code(), s.what(), at + ".file", s.todo()};
    }
    const Result<wrinkle::PoseFrame> frame = Frame(*path, from.frame(), at + ".frame");
    if (!frame.ok()) return frame.status();
    Result<wrinkle::PoseFrame> rest = Status(StatusCode::kNotFound, {});
    if (from.rest_frame() >= 0) {
      rest = Frame(*path, from.rest_frame(), at + ".rest_frame");
      if (!rest.ok()) return rest.status();
    }
    Result<wrinkle::ReferencePose> pose =
        ReferencePoseFromFrame(from.name()->str(), *frame, rest.ok() ? &*rest : nullptr);
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
        return {StatusCode::kCyclic,
                "the mix contains itself, by way of '" + part.pose()->str() + "'", where + ".pose"};
      }
      if (!(std::abs(part.weight()) <= 10.0f)) {
        return InvalidField("the weight is not a number in [-10, 10]", where + ".weight");
      }
      parts.push_back(found->second);
      weights.push_back(part.weight());
      return Resolve(found->second);
    };
    if (Status s = ForEach(from.mix(), at + ".mix", resolve); !s.ok()) return s;
    if (parts.empty()) return InvalidField("a mix needs a part", at + ".mix");
    std::vector<WeightedPose> weighted;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      weighted.push_back({&poses_[parts[i]], weights[i]});
    }
    *to = MixReferencePoses(from.name()->str(), weighted);
    return {};
  }

  const List<schema::ReferencePose>* list_;
  const std::filesystem::path& folder_;
  const wrinkle::PoseSource& source_;
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<wrinkle::ReferencePose> poses_;
  std::vector<State> state_;
};

Status ReadPoseDriver(const schema::PoseDriver& from, const std::string& at,
                      wrinkle::PoseDriver* to) {
  to->falloff = from.falloff();
  for (const schema::PoseValue* value : *from.values()) {
    to->values.push_back({value->name()->str(), value->reference_pose()->str()});
  }
  if (Status s = Enum(from.solve(), &to->solve, at + ".solve"); !s.ok()) return s;
  return ForEach(from.points(), at + ".points",
                 [&](const schema::ControlPoint& point, const std::string& where) {
                   wrinkle::ControlPoint& added = to->points.emplace_back();
                   added.joint = point.joint()->str();
                   if (point.offset() != nullptr) added.offset = ToVec3(*point.offset());
                   added.offset_size = point.offset_size();
                   return Enum(point.kind(), &added.kind, where + ".kind");
                 });
}

void ReadHinge(const schema::HingeDriver& from, wrinkle::HingeDriver* to) {
  to->parent = from.parent()->str();
  to->joint = from.joint()->str();
  to->end = Text(from.end());
  if (from.axis() != nullptr) to->axis = ToVec3(*from.axis());
  to->beta_degrees = from.beta_degrees();
}

Status ReadBall(const schema::BallDriver& from, const std::string& at, wrinkle::BallDriver* to) {
  to->parent = from.parent()->str();
  to->joint = from.joint()->str();
  to->end = Text(from.end());
  if (from.bone() != nullptr) to->bone = ToVec3(*from.bone());
  if (from.forward() != nullptr) to->forward = ToVec3(*from.forward());
  to->beta_degrees = from.beta_degrees();
  return Enum(from.mode(), &to->mode, at + ".mode");
}

void ReadTwist(const schema::TwistDriver& from, wrinkle::TwistDriver* to) {
  to->joint = from.joint()->str();
  if (from.axis() != nullptr) to->axis = ToVec3(*from.axis());
  to->full_degrees = from.full_degrees();
  if (from.through() == nullptr) return;
  for (const String* joint : *from.through()) to->through.push_back(joint->str());
}

Status ReadDriver(const schema::Driver& from, const std::string& at, wrinkle::Driver* to) {
  to->name = from.name()->str();
  const int kinds = (from.pose() != nullptr) + (from.hinge() != nullptr) +
                    (from.ball() != nullptr) + (from.twist() != nullptr) +
                    (from.blend_shape() != nullptr);
  if (kinds != 1) {
    return InvalidField(
        "a driver has exactly one of pose, hinge, ball, twist and blend_shape, not " +
            std::to_string(kinds),
        at);
  }
  using Kind = wrinkle::Driver::Kind;
  if (from.pose() != nullptr) {
    to->kind = Kind::kPose;
    return ReadPoseDriver(*from.pose(), at + ".pose", &to->pose);
  }
  if (from.hinge() != nullptr) {
    to->kind = Kind::kHinge;
    ReadHinge(*from.hinge(), &to->hinge);
  } else if (from.ball() != nullptr) {
    to->kind = Kind::kBall;
    return ReadBall(*from.ball(), at + ".ball", &to->ball);
  } else if (from.twist() != nullptr) {
    to->kind = Kind::kTwist;
    ReadTwist(*from.twist(), &to->twist);
  } else {
    to->kind = Kind::kBlendShape;
    to->blend_shape = {from.blend_shape()->blend_shape()->str(), from.blend_shape()->neutral(),
                       from.blend_shape()->full()};
  }
  return {};
}

Status ReadFeed(const schema::Feed& from, const std::string& at, wrinkle::Feed* to) {
  to->map = from.map()->str();
  return ForEach(
      from.sources(), at + ".sources",
      [&](const schema::Source& source, const std::string& where) -> Status {
        const std::string name = source.from()->str();
        const std::size_t dot = name.rfind('.');
        if (dot == std::string::npos) {
          return InvalidField("'" + name + "' is not a driver's value", where + ".from",
                              "write \"<driver>.<value>\"");
        }
        to->sources.push_back({name.substr(0, dot), name.substr(dot + 1), source.gain()});
        return {};
      });
}

Status ReadRegion(const schema::Region& from, const std::string& at, wrinkle::Region* to) {
  to->name = from.name()->str();
  const schema::Mask& mask = *from.mask();
  to->mask.texture = Text(mask.texture());
  to->mask.smooth_width = mask.smooth_width();
  to->mask.channel = static_cast<int>(mask.channel());
  if (Status s = Enum(mask.kind(), &to->mask.kind, at + ".mask.kind"); !s.ok()) return s;
  if (Status s = Enum(mask.lambda(), &to->mask.lambda, at + ".mask.lambda"); !s.ok()) return s;
  if (Status s = Enum(from.combine(), &to->combine, at + ".combine"); !s.ok()) return s;
  if (Status s = Enum(from.modulation(), &to->modulation, at + ".modulation"); !s.ok()) return s;
  if (from.neighbours() != nullptr) {
    for (const String* name : *from.neighbours()) to->neighbours.push_back(name->str());
  }
  return ForEach(from.feeds(), at + ".feeds",
                 [&](const schema::Feed& feed, const std::string& where) {
                   return ReadFeed(feed, where, &to->feeds.emplace_back());
                 });
}

Status ReadExports(const List<schema::ExportProfile>* list, std::vector<wrinkle::Export>* exports) {
  std::unordered_set<std::string> profiles;
  return ForEach(
      list, "export", [&](const schema::ExportProfile& from, const std::string& where) -> Status {
        if (!profiles.insert(from.profile()->str()).second) {
          return InvalidField("the profile '" + from.profile()->str() + "' is given twice",
                              where + ".profile");
        }
        if (from.names()->size() == 0) {
          return InvalidField("a profile needs a name", where + ".names");
        }
        for (const schema::ExportName* name : *from.names()) {
          exports->push_back({from.profile()->str(), name->weight()->str(), name->name()->str()});
        }
        return {};
      });
}

void ReadFilter(const schema::Filter* from, wrinkle::Filter* to) {
  if (from == nullptr) return;
  to->enabled = from->enabled();
  to->min_cutoff_hz = from->min_cutoff_hz();
  to->beta = from->beta();
  to->derivative_cutoff_hz = from->derivative_cutoff_hz();
  to->slew_per_second = from->slew_per_second();
  to->hold_seconds = from->hold_seconds();
  to->decay_seconds = from->decay_seconds();
}

void ReadMaps(const List<schema::WrinkleMap>* list, std::vector<wrinkle::WrinkleMap>* maps) {
  if (list == nullptr) return;
  for (const schema::WrinkleMap* from : *list) {
    maps->push_back({from->name()->str(), Text(from->normal()), Text(from->derivative()),
                     Text(from->colour()), Text(from->cavity()), from->amplitude(),
                     Text(from->opposes())});
  }
}

}  // namespace

Result<wrinkle::Rig> ReadRigTables(const schema::Rig& tables, const std::filesystem::path& folder,
                                   const wrinkle::PoseSource& poses) {
  if (tables.version() != 1) {
    return Status(
        StatusCode::kUnsupported,
        "the rig is of version " + std::to_string(tables.version()) + ", this is version 1",
        "version");
  }
  wrinkle::Rig rig;
  rig.name = tables.name()->str();
  rig.anchor = Text(tables.anchor());
  Status status = PoseReader(tables.reference_poses(), folder, poses).Run(&rig.reference_poses);
  if (!status.ok()) return status;
  status = ForEach(tables.drivers(), "drivers",
                   [&](const schema::Driver& driver, const std::string& where) {
                     return ReadDriver(driver, where, &rig.drivers.emplace_back());
                   });
  if (!status.ok()) return status;
  status = ForEach(tables.regions(), "regions",
                   [&](const schema::Region& region, const std::string& where) {
                     return ReadRegion(region, where, &rig.regions.emplace_back());
                   });
  if (!status.ok()) return status;
  ReadMaps(tables.wrinkle_maps(), &rig.wrinkle_maps);
  ReadFilter(tables.filter(), &rig.filter);
  status = ReadExports(tables.export_(), &rig.exports);
  if (!status.ok()) return status;
  return rig;
}

void DropBuildingBlocks(const schema::Rig& tables, wrinkle::Rig* rig) {
  if (tables.reference_poses() == nullptr) return;
  std::unordered_set<std::string> blocks;
  for (const schema::ReferencePose* pose : *tables.reference_poses()) {
    if (pose->mix() == nullptr) continue;
    for (const schema::MixPart* part : *pose->mix()) blocks.insert(part->pose()->str());
  }
  for (const wrinkle::Driver& driver : rig->drivers) {
    for (const auto& value : driver.pose.values) blocks.erase(value.reference_pose);
  }
  std::erase_if(rig->reference_poses,
                [&](const wrinkle::ReferencePose& pose) { return blocks.count(pose.name) > 0; });
}

}  // namespace furrow::character
