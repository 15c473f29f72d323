// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reader.h"

#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/status.h"
#include "rig/json/described_table.h"
#include "rig/json/field_reader.h"
#include "rig/json/rig_tables.h"
#include "rig/rig_pose_reader.h"
#include "rig/rig_schema_text.h"
#include "wrinkle/rig/rig_joints.h"

namespace furrow::rig {
namespace {

using flatbuffers::String;
using wrinkle::InvalidField;

// Lists the driver kinds for an error message: "pose, hinge, ball, twist, blend_shape and strain".
std::string ListOfKinds() {
  std::vector<std::string_view> names;
#define FURROW_KIND_LIST(Name, field) names.push_back(#field);
  FURROW_DRIVER_KINDS(FURROW_KIND_LIST)
#undef FURROW_KIND_LIST
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " and " : ", ";
    list += names[i];
  }
  return list;
}

const SchemaTypes& RigTypes() {
  static const SchemaTypes types(kRigSchemaText);
  return types;
}

// A driver's kind is the one field that is present. FlatBuffers unions would need a second field in
// the JSON.
Status ReadDriver(const schema::Driver& from, const std::string& at, wrinkle::Driver* to) {
  to->name = from.name()->str();
  int kinds = 0;
#define FURROW_KIND_COUNT(Name, field) kinds += from.field() != nullptr ? 1 : 0;
  FURROW_DRIVER_KINDS(FURROW_KIND_COUNT)
#undef FURROW_KIND_COUNT
  if (kinds != 1) {
    return InvalidField(
        "a driver needs exactly one of " + ListOfKinds() + ", not " + std::to_string(kinds), at);
  }
#define FURROW_KIND_READ(Name, field)                                                         \
  if (from.field() != nullptr) {                                                              \
    to->kind = wrinkle::Driver::Kind::k##Name;                                                \
    return ReadFields(RigTypes().Describe(from.field(), "furrow.rig.schema." #Name "Driver"), \
                      at + "." #field, &to->field);                                           \
  }
  FURROW_DRIVER_KINDS(FURROW_KIND_READ)
#undef FURROW_KIND_READ
  return {};
}

// The modulation of a region or of one of its maps. `from` and `to` are a Region or a Feed.
template <class From, class To>
Status ReadModulation(const From& from, const std::string& at, To* to) {
  const auto* curve = from.curve();
  if (curve != nullptr && from.modulation()) {
    return InvalidField("modulation and curve exclude each other", at + ".curve",
                        "remove one of them");
  }
  if (curve != nullptr && curve->size() == 0) {
    return InvalidField("a curve needs at least two points", at + ".curve");
  }
  if (from.modulation()) {
    wrinkle::Modulation modulation{};
    FURROW_RETURN_IF_ERROR(ReadEnum(*from.modulation(), &modulation, at + ".modulation"));
    to->modulation = modulation;
  }
  for (flatbuffers::uoffset_t i = 0; curve != nullptr && i < curve->size(); ++i) {
    to->curve.push_back({curve->Get(i)->x(), curve->Get(i)->y()});
  }
  return {};
}

// `to` has its modulation already.
Status ReadAngles(const schema::Feed& from, const std::string& at, wrinkle::Feed* to) {
  if (from.angles() == nullptr) return {};
  if (to->modulation || !to->curve.empty()) {
    return InvalidField("angles excludes modulation and curve", at + ".angles",
                        "remove one of them");
  }
  if (from.angles()->size() == 0) {
    return InvalidField("a curve needs at least two points", at + ".angles");
  }
  for (const schema::AnglePoint* point : *from.angles()) {
    to->angles.push_back({point->degrees(), point->weight()});
  }
  return {};
}

Status ReadFeed(const schema::Feed& from, const std::string& at, wrinkle::Feed* to) {
  to->map = from.map()->str();
  FURROW_RETURN_IF_ERROR(ReadModulation(from, at, to));
  FURROW_RETURN_IF_ERROR(ReadAngles(from, at, to));
  return ForEach(
      from.sources(), at + ".sources",
      [&](const schema::Source& source, const std::string& where) -> Status {
        const std::string name = source.from()->str();
        // The last dot, because neither names of drivers nor names of values contain one.
        const std::size_t dot = name.rfind('.');
        if (dot == std::string::npos) {
          return InvalidField("'" + name + "' is not a driver value", where + ".from",
                              "write \"<driver>.<value>\"");
        }
        to->sources.push_back({name.substr(0, dot), name.substr(dot + 1), source.gain()});
        return {};
      });
}

Status ReadRegion(const schema::Region& from, const std::string& at, wrinkle::Region* to) {
  to->name = from.name()->str();
  // CheckedJson guarantees the fields that rig.fbs marks as required.
  const schema::Mask& mask = *from.mask();
  to->mask.texture = Text(mask.texture());
  to->mask.smooth_width = mask.smooth_width();
  to->mask.channel = static_cast<int>(mask.channel());
  if (mask.driver() != nullptr && mask.ball() != nullptr) {
    return InvalidField("ball is the former name of driver", at + ".mask.ball", "remove it");
  }
  to->mask.driver = Text(mask.driver() != nullptr ? mask.driver() : mask.ball());
  to->mask.spread_degrees = mask.spread_degrees();
  to->mask.above = mask.above();
  to->mask.below = mask.below();
  to->mask.radius = mask.radius();
  FURROW_RETURN_IF_ERROR(ReadEnum(mask.kind(), &to->mask.kind, at + ".mask.kind"));
  FURROW_RETURN_IF_ERROR(ReadEnum(mask.lambda(), &to->mask.lambda, at + ".mask.lambda"));
  FURROW_RETURN_IF_ERROR(ReadEnum(from.combine(), &to->combine, at + ".combine"));
  FURROW_RETURN_IF_ERROR(ReadModulation(from, at, to));
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
          return InvalidField("a profile needs at least one name", where + ".names");
        }
        for (const schema::ExportName* name : *from.names()) {
          exports->push_back({from.profile()->str(), name->weight()->str(), name->name()->str()});
        }
        return {};
      });
}

Status ReadSizeReference(const schema::SizeReference* from,
                         std::shared_ptr<const wrinkle::SizeReference>* to) {
  if (from == nullptr) return {};
  wrinkle::SizeReference reference;
  reference.size = from->size();
  const Status status =
      ForEach(from->joints(), "size_reference.joints",
              [&](const schema::JointPlace& joint, const std::string&) -> Status {
                reference.joints.push_back({joint.joint()->str(), ToVec3(*joint.position())});
                return {};
              });
  FURROW_RETURN_IF_ERROR(status);
  *to = std::make_shared<const wrinkle::SizeReference>(std::move(reference));
  return {};
}

// Poses from frames bring the skeleton of their lengths along.
void MeasureOn(const wrinkle::Skeleton& recorded, wrinkle::Rig* rig) {
  if (rig->size_reference == nullptr) {
    wrinkle::SizeReference reference =
        wrinkle::MakeSizeReference(recorded, wrinkle::JointsOf(*rig));
    if (reference.joints.size() > 1 && reference.size > 0.0f) {
      rig->size_reference = std::make_shared<const wrinkle::SizeReference>(std::move(reference));
    }
  }
  for (wrinkle::ReferencePose& pose : rig->reference_poses) {
    pose.size_reference = rig->size_reference;
  }
}

// Of the joints that pose drivers measure. The first driver of a joint counts.
PoseAnchors AnchorsOf(const schema::Rig& tables) {
  PoseAnchors anchors;
  if (tables.drivers() == nullptr) return anchors;
  for (const schema::Driver* driver : *tables.drivers()) {
    const schema::PoseDriver* const pose = driver->pose();
    if (pose == nullptr) continue;
    const std::string anchor = Text(pose->anchor() != nullptr ? pose->anchor() : tables.anchor());
    if (anchor.empty()) continue;
    for (const schema::ControlPoint* point : *pose->points()) {
      if (point->joint() != nullptr) anchors.emplace(point->joint()->str(), anchor);
    }
  }
  return anchors;
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
  return ReadEnum(from.surface(), &to->surface, at + ".surface");
}

}  // namespace

Result<wrinkle::Rig> ReadRigTables(const schema::Rig& tables, const std::filesystem::path& folder,
                                   const wrinkle::PoseSource& poses,
                                   std::set<std::string>* missing) {
  if (tables.version() != 1) {
    return Status(StatusCode::kUnsupported,
                  "unsupported version " + std::to_string(tables.version()) +
                      "; this program reads version 1",
                  "version");
  }
  wrinkle::Rig rig;
  rig.name = tables.name()->str();
  rig.anchor = Text(tables.anchor());
  Status status = ReadSizeReference(tables.size_reference(), &rig.size_reference);
  if (!status.ok()) return status;
  wrinkle::Skeleton recorded;
  status = ReadReferencePoses(tables.reference_poses(), folder, poses, &rig.reference_poses,
                              &recorded, missing, AnchorsOf(tables));
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
  MeasureOn(recorded, &rig);
  ReadFilter(tables.filter(), &rig.filter);
  status = ReadExports(tables.export_(), &rig.exports);
  if (!status.ok()) return status;
  return rig;
}

// A part of a mix is usually a recorded unit pose that no driver reads itself. Binding would apply
// it to every skeleton for nothing.
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

}  // namespace furrow::rig
