// SPDX-License-Identifier: Apache-2.0
#include "motion/clip_file.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

#include "base/ascii.h"
#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "gltf/limits.h"
#include "motion/bvh/bvh.h"
#include "motion/clip/limits.h"
#include "motion/clip/up_axis.h"
#include "motion/gltf/gltf_animation.h"
#include "motion/livelink/livelink_csv.h"

namespace furrow::motion {
namespace {

enum class Format { kUnknown, kBvh, kGlb, kGltf, kVrma, kCsv };

Format FormatOf(const std::filesystem::path& path) {
  const std::string extension = AsciiLower(path.extension().string());
  if (extension == ".bvh") return Format::kBvh;
  if (extension == ".glb") return Format::kGlb;
  if (extension == ".gltf") return Format::kGltf;
  if (extension == ".vrma") return Format::kVrma;
  if (extension == ".csv") return Format::kCsv;
  return Format::kUnknown;
}

Status UnknownFormat(const std::filesystem::path& path, std::string todo) {
  const std::string extension = path.extension().string();
  return {StatusCode::kUnsupported,
          extension.empty() ? "the file name has no extension, which decides the format"
                            : "unknown recording format " + Quoted(extension),
          path.string(), std::move(todo)};
}

// By the extension alone: BVH and CSV have no magic bytes.
Result<Clip> Parse(Format format, std::string_view bytes, const std::filesystem::path& path,
                   const LoadOptions& options, ClipReport* report) {
  const std::string name = path.string();
  if (bytes.empty()) return Status(StatusCode::kParse, "the file is empty", name);
  switch (format) {
    case Format::kBvh: return ParseBvh(bytes, name, options, report);
    case Format::kCsv: return ParseLiveLinkCsv(bytes, name, options, report);
    default:
      return ParseGltfAnimation(bytes, name, {.load = options, .folder = path.parent_path()},
                                report);
  }
}

// Turns a BVH clip to Y up. glTF is Y up by definition.
Status SetUpright(UpAxis up, Clip* clip) {
  if (up == UpAxis::kAuto) up = FindUpAxis(clip->skeleton);
  return up == UpAxis::kZ ? TurnZUpToYUp(clip) : Status();
}

// Moves roots to their OFFSET if their position is 0 in every frame. MakeHuman writes such files:
// its position channels add to the OFFSET.
void KeepRootsAtOffset(Clip* clip) {
  const auto joints = static_cast<std::size_t>(clip->skeleton.num_joints());
  for (std::size_t j = 0; j < joints; ++j) {
    if (clip->skeleton.joint_parents()[j] != wrinkle::kNoJoint) continue;
    bool moves = false;
    for (std::size_t at = j; at < clip->locals.size(); at += joints)
      moves = moves || clip->locals[at].translation != glm::vec3(0.0f);
    if (moves) continue;
    for (std::size_t at = j; at < clip->locals.size(); at += joints)
      clip->locals[at].translation = clip->skeleton.rest_pose()[j].translation;
  }
}

// Writers index by these counts, so a caller's inconsistent clip must not reach them.
Status CheckSizes(const Clip& clip) {
  const std::size_t frames = clip.times.size();
  if (clip.locals.size() == frames * static_cast<std::size_t>(clip.skeleton.num_joints()) &&
      clip.blend_shapes.size() == frames * clip.blend_shape_names.size() &&
      std::is_sorted(clip.times.begin(), clip.times.end(), std::less_equal<>())) {
    return {};
  }
  return {StatusCode::kInvalidArgument,
          "the clip's frames, joints and blend shapes have different counts"};
}

}  // namespace

Result<Clip> LoadClip(const std::filesystem::path& path, const LoadOptions& options,
                      ClipReport* report) {
  const Format format = FormatOf(path);
  if (format == Format::kUnknown) {
    return UnknownFormat(path, "use .bvh, .glb, .gltf, .vrma or .csv");
  }
  const bool is_text = format == Format::kBvh || format == Format::kCsv;
  const Result<std::string> bytes = ReadFile(path, is_text ? kMaxFileBytes : gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  Result<Clip> clip = Parse(format, *bytes, path, options, report);
  if (!clip.ok()) return clip.status().At(path.string());
  if (format == Format::kBvh) {
    KeepRootsAtOffset(&*clip);
    if (Status status = SetUpright(options.up_axis, &*clip); !status.ok())
      return status.At(path.string());
  }
  if (clip->name.empty()) clip->name = path.stem().string();
  return clip;
}

Status SaveClip(const Clip& clip, const std::filesystem::path& path, ClipReport* report) {
  if (Status status = CheckSizes(clip); !status.ok()) return status.At(path.string());
  Result<std::string> bytes = std::string();
  switch (FormatOf(path)) {
    case Format::kBvh: bytes = BvhToText(clip, report); break;
    case Format::kCsv: bytes = LiveLinkCsvToText(clip, report); break;
    case Format::kGlb: bytes = ClipToGlb(clip); break;
    default: return UnknownFormat(path, "use .bvh, .glb or .csv");
  }
  if (!bytes.ok()) return bytes.status().At(path.string());
  return WriteFileAtomically(path, *bytes);
}

}  // namespace furrow::motion
