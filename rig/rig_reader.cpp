// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reader.h"

#include <string>
#include <unordered_set>
#include <vector>

#include "base/status.h"
#include "rig/rig_pose_reader.h"
#include "rig/rig_tables.h"

namespace furrow::character {
namespace {

using flatbuffers::String;
using wrinkle::InvalidField;

// The schema's enumerations name the same things in the same order as wrinkle/rig/rig.h's. JSON may
// also state one by number, and nobody has checked that number yet.
template <class To, class From>
Status Enum(From from, To* to, const std::string& where) {
  if (from < From::MIN || from > From::MAX) return InvalidField("there is no such choice", where);
  *to = static_cast<To>(from);
  return {};
}

Status ReadPoseDriver(const schema::PoseDriver& from, const std::string& at,
                      wrinkle::PoseDriver* to) {
  to->falloff = from.falloff();
  for (const schema::PoseValue* value : *from.values()) {
    to->values.push_back({value->name()->str(), value->reference_pose()->str()});
  }
  FURROW_RETURN_IF_ERROR(Enum(from.solve(), &to->solve, at + ".solve"));
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

void ReadStrain(const schema::StrainDriver& from, wrinkle::StrainDriver* to) {
  to->joint = from.joint()->str();
  for (const String* joint : *from.joints()) to->joints.push_back(joint->str());
  for (const schema::PatchVertex* vertex : *from.vertices()) {
    wrinkle::StrainDriver::Vertex& added = to->vertices.emplace_back();
    added.position = ToVec3(*vertex->position());
    added.joints.assign(vertex->joints()->begin(), vertex->joints()->end());
    added.skin_weights.assign(vertex->skin_weights()->begin(), vertex->skin_weights()->end());
  }
  to->triangles.assign(from.triangles()->begin(), from.triangles()->end());
  to->direction = ToVec3(*from.direction());
  to->full_compression = from.full_compression();
  to->size = from.size();
}

Status ReadDriver(const schema::Driver& from, const std::string& at, wrinkle::Driver* to) {
  to->name = from.name()->str();
  const int kinds = (from.pose() != nullptr) + (from.hinge() != nullptr) +
                    (from.ball() != nullptr) + (from.twist() != nullptr) +
                    (from.blend_shape() != nullptr) + (from.strain() != nullptr);
  if (kinds != 1) {
    return InvalidField(
        "a driver has exactly one of pose, hinge, ball, twist, blend_shape and strain, not " +
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
  } else if (from.strain() != nullptr) {
    to->kind = Kind::kStrain;
    ReadStrain(*from.strain(), &to->strain);
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
  to->mask.ball = Text(mask.ball());
  to->mask.spread_degrees = mask.spread_degrees();
  to->mask.above = mask.above();
  to->mask.below = mask.below();
  to->mask.radius = mask.radius();
  FURROW_RETURN_IF_ERROR(Enum(mask.kind(), &to->mask.kind, at + ".mask.kind"));
  FURROW_RETURN_IF_ERROR(Enum(mask.lambda(), &to->mask.lambda, at + ".mask.lambda"));
  FURROW_RETURN_IF_ERROR(Enum(from.combine(), &to->combine, at + ".combine"));
  FURROW_RETURN_IF_ERROR(Enum(from.modulation(), &to->modulation, at + ".modulation"));
  if (from.neighbours() != nullptr) {
    for (const String* name : *from.neighbours()) to->neighbours.push_back(name->str());
  }
  return ForEach(from.feeds(), at + ".feeds",
                 [&](const schema::Feed& feed, const std::string& where) {
                   return ReadFeed(feed, where, &to->feeds.emplace_back());
                 });
}

Status ReadExports(const TableList<schema::ExportProfile>* list,
                   std::vector<wrinkle::Export>* exports) {
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

Status ReadMap(const schema::WrinkleMap& from, const std::string& at, wrinkle::WrinkleMap* to) {
  to->name = from.name()->str();
  to->normal = Text(from.normal());
  to->derivative = Text(from.derivative());
  to->derivative_scale = from.derivative_scale();
  to->height = Text(from.height());
  to->height_mm = from.height_mm();
  to->colour = Text(from.colour());
  to->colour_scale = from.colour_scale();
  to->cavity = Text(from.cavity());
  to->amplitude = from.amplitude();
  to->opposes = Text(from.opposes());
  return Enum(from.surface(), &to->surface, at + ".surface");
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
  Status status = ReadReferencePoses(tables.reference_poses(), folder, poses, &rig.reference_poses);
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
  status = ForEach(tables.wrinkle_maps(), "wrinkle_maps",
                   [&](const schema::WrinkleMap& map, const std::string& where) {
                     return ReadMap(map, where, &rig.wrinkle_maps.emplace_back());
                   });
  if (!status.ok()) return status;
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
