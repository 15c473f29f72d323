// SPDX-License-Identifier: Apache-2.0
#include "motion/clip_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/ascii.h"
#include "base/asset_path.h"
#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "gltf/limits.h"
#include "motion/bvh/bvh.h"
#include "motion/clip/floor.h"
#include "motion/clip/limits.h"
#include "motion/clip/rest_pose.h"
#include "motion/clip/up_axis.h"
#include "motion/foreign/foreign_clip.h"
#include "motion/gltf/gltf_animation.h"
#include "motion/livelink/livelink_csv.h"
#include "motion/makehuman/mhpose.h"

namespace furrow::motion {
namespace {

enum class Format { kUnknown, kBvh, kGlb, kGltf, kVrma, kCsv, kFbx, kCollada, kMhpose };

Format FormatOf(const std::filesystem::path& path) {
  const std::string extension = AsciiLower(path.extension().string());
  if (extension == ".bvh") return Format::kBvh;
  if (extension == ".glb") return Format::kGlb;
  if (extension == ".gltf") return Format::kGltf;
  if (extension == ".vrma") return Format::kVrma;
  if (extension == ".csv") return Format::kCsv;
  if (extension == ".fbx") return Format::kFbx;
  if (extension == ".dae") return Format::kCollada;
  if (extension == ".mhpose") return Format::kMhpose;
  return Format::kUnknown;
}

// How much of a file shows its format. Collada's first element may follow comments.
constexpr std::size_t kSniffed = 1024;

// The format that the first bytes show, or `otherwise`: BVH and CSV have no magic bytes.
Format FormatOf(std::string_view bytes, Format otherwise) {
  bytes = bytes.substr(0, kSniffed);
  if (bytes.starts_with("Kaydara FBX Binary") || bytes.starts_with("; FBX")) return Format::kFbx;
  if (bytes.find("<COLLADA") != bytes.npos) return Format::kCollada;
  return bytes.starts_with("glTF") ? Format::kGlb : otherwise;
}

// A file that is absent or unreadable shows nothing; reading it in full reports why.
Format Sniff(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kSniffed, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return FormatOf(bytes, Format::kUnknown);
}

Status UnknownFormat(const std::filesystem::path& path, std::string todo) {
  const std::string extension = path.extension().string();
  return {StatusCode::kUnsupported,
          extension.empty() ? "the file name has no extension, which decides the format"
                            : "unknown recording format " + Quoted(extension),
          path.string(), std::move(todo)};
}

// A foreign file becomes a GLB, which is then read like any other.
Result<Clip> ParseForeign(Format format, std::string_view bytes, const std::string& name,
                          const LoadOptions& options, ClipReport* report) {
  ClipReport converted;
  const Result<std::string> glb = ForeignClipToGlb(bytes, format == Format::kFbx ? ".fbx" : ".dae",
                                                   options.animation, &converted);
  if (!glb.ok()) return glb.status().At(name);
  if (report != nullptr) {
    for (const std::string& warning : converted.warnings)
      report->warnings.push_back(name + ": " + warning);
    report->animations = std::move(converted.animations);
  }
  LoadOptions rest = options;
  rest.animation.clear();  // the GLB holds the chosen one only
  return ParseGltfAnimation(*glb, name, {.load = rest, .folder = std::nullopt}, report);
}

// Whether a file of this format may hold several animations, of which the reader can choose.
bool HasAnimations(Format format) { return format != Format::kBvh && format != Format::kCsv; }

// `folder`: of the files that a glTF file names; none: they are not opened.
Result<Clip> Parse(Format format, std::string_view bytes, const std::string& name,
                   std::optional<std::filesystem::path> folder, const LoadOptions& options,
                   ClipReport* report) {
  if (bytes.empty()) return Status(StatusCode::kParse, "the file is empty", name);
  if (!options.animation.empty() && !HasAnimations(format)) {
    return Status(StatusCode::kUnsupported,
                  "animation " + Quoted(options.animation) + " cannot be chosen in this format",
                  name, "only .glb, .gltf, .vrma, .fbx and .dae files hold several animations");
  }
  switch (format) {
    case Format::kBvh: return ParseBvh(bytes, name, options, report);
    case Format::kCsv: return ParseLiveLinkCsv(bytes, name, options, report);
    case Format::kFbx:
    case Format::kCollada: return ParseForeign(format, bytes, name, options, report);
    default:
      return ParseGltfAnimation(bytes, name, {.load = options, .folder = std::move(folder)},
                                report);
  }
}

std::uint64_t MaxBytes(Format format) {
  const bool is_gltf = format == Format::kGlb || format == Format::kGltf || format == Format::kVrma;
  return is_gltf ? gltf::kMaxFileBytes : kMaxFileBytes;
}

// Turns a BVH clip to Y up. glTF is Y up by definition.
Status SetUpright(UpAxis up, const std::string& name, Clip* clip, ClipReport* report) {
  const UpAxis wanted = up == UpAxis::kAuto ? FindUpAxis(clip->skeleton) : up;
  if (wanted == UpAxis::kZ) return TurnZUpToYUp(clip);
  if (wanted == UpAxis::kAuto && IsLongestAlongZ(clip->skeleton) && report != nullptr) {
    report->warnings.push_back(name +
                               ": the axis that points up is unknown, because the rest pose has no "
                               "legs and no joint named head; +Y is taken as up (--up-axis z turns "
                               "a Z-up file)");
  }
  if (up == UpAxis::kAuto && MovesAlongZ(*clip)) {
    TurnMotionUpright(clip);
    if (report != nullptr) {
      report->warnings.push_back(name +
                                 ": the rest pose stands along Y, but the motion along Z; the "
                                 "motion was turned upright (--up-axis y keeps it)");
    }
  }
  return {};
}

// Replaces the rest pose by a frame. Some files state none: all bones of LaFAN1 lie along +X.
Status TakeRestFrom(int frame, Clip* clip) {
  if (frame >= clip->num_frames()) {
    return {StatusCode::kInvalidArgument, "there is no frame " + std::to_string(frame) +
                                              " to take the rest pose from; the recording has " +
                                              std::to_string(clip->num_frames()) + " frames"};
  }
  wrinkle::LocalPose pose;
  clip->GetPose(frame, &pose);
  return SetRestPose(pose.joints, clip);
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

// The names of the pose units of an expression, in MakeHuman's folder layout or in
// FURROW_ASSET_PATH.
Result<std::filesystem::path> FindPoseUnits(const std::filesystem::path& expression) {
  constexpr const char* kFile = "face-poseunits.json";
  const std::filesystem::path folder = expression.parent_path();
  Result<std::filesystem::path> found = FindAsset(kFile, folder / ".." / "poseunits");
  if (!found.ok()) found = FindAsset("poseunits/face-poseunits.json", folder);
  if (!found.ok()) found = FindAsset(kFile, folder);
  if (found.ok()) return found;
  return Status(StatusCode::kNotFound,
                "the pose units of the expression were not found (face-poseunits.json)",
                expression.string(),
                "keep the file in the folder expressions of MakeHuman's data, or add the folder "
                "poseunits to FURROW_ASSET_PATH");
}

Result<Clip> LoadExpression(const std::filesystem::path& path, const LoadOptions& options,
                            ClipReport* report) {
  const Result<std::string> text = ReadFile(path, kMaxMhposeBytes);
  FURROW_RETURN_IF_ERROR(text);
  const Result<MhPose> pose = ParseMhpose(*text, path.string(), report);
  FURROW_RETURN_IF_ERROR(pose);
  const Result<std::filesystem::path> names_path = FindPoseUnits(path);
  FURROW_RETURN_IF_ERROR(names_path);
  const Result<std::string> names_text = ReadFile(*names_path, kMaxMhposeBytes);
  FURROW_RETURN_IF_ERROR(names_text);
  const auto names = ParsePoseUnitNames(*names_text, names_path->string());
  FURROW_RETURN_IF_ERROR(names);
  const Result<Clip> units =
      LoadClip(names_path->parent_path() / "face-poseunits.bvh", options, report);
  FURROW_RETURN_IF_ERROR(units);
  Result<Clip> clip = BlendPoseUnits(*pose, *names, *units, path.string());
  if (clip.ok() && clip->name.empty()) clip->name = path.stem().string();
  return clip;
}

// Parses the bytes of a file and turns the clip upright. `folder`: see Parse().
Result<Clip> Read(Format format, std::string_view bytes, const std::filesystem::path& file,
                  std::optional<std::filesystem::path> folder, const LoadOptions& options,
                  ClipReport* report) {
  const std::string name = file.string();
  Result<Clip> clip = Parse(format, bytes, name, std::move(folder), options, report);
  if (!clip.ok()) return clip.status().At(name);
  if (format == Format::kBvh) {
    KeepRootsAtOffset(&*clip);
    if (Status status = SetUpright(options.up_axis, name, &*clip, report); !status.ok())
      return status.At(name);
    const Result<bool> raised = RaiseToFloor(&*clip);
    if (!raised.ok()) return raised.status().At(name);
    if (*raised && report != nullptr) {
      report->warnings.push_back(name +
                                 ": the performer is far below the floor, height 0; the recording "
                                 "was raised onto it");
    }
  }
  if (options.rest_frame >= 0) {
    if (Status status = TakeRestFrom(options.rest_frame, &*clip); !status.ok())
      return status.At(name);
  }
  if (clip->name.empty()) clip->name = file.stem().string();
  return clip;
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

void SplitClipPath(const std::filesystem::path& path, std::filesystem::path* file,
                   std::string* animation) {
  *file = path;
  animation->clear();
  std::error_code error;
  if (std::filesystem::exists(path, error)) return;
  const std::string text = path.string();
  for (std::size_t hash = text.find('#'); hash != text.npos; hash = text.find('#', hash + 1)) {
    const std::filesystem::path before = text.substr(0, hash);
    if (FormatOf(before) == Format::kUnknown) continue;
    *file = before;
    *animation = text.substr(hash + 1);
    return;
  }
}

Result<Clip> LoadClip(const std::filesystem::path& path, const LoadOptions& load_options,
                      ClipReport* report) {
  LoadOptions options = load_options;
  std::filesystem::path file;
  std::string animation;
  SplitClipPath(path, &file, &animation);
  if (!animation.empty()) options.animation = std::move(animation);
  Format format = FormatOf(file);
  if (format == Format::kUnknown) format = Sniff(file);
  if (format == Format::kUnknown) {
    return UnknownFormat(file, "use .bvh, .glb, .gltf, .vrma, .csv, .fbx, .dae or .mhpose");
  }
  if (format == Format::kMhpose) return LoadExpression(file, options, report);
  const Result<std::string> bytes = ReadFile(file, MaxBytes(format));
  FURROW_RETURN_IF_ERROR(bytes);
  return Read(FormatOf(*bytes, format), *bytes, file, file.parent_path(), options, report);
}

Result<Clip> ParseClip(std::string_view bytes, const std::string& name, const LoadOptions& options,
                       ClipReport* report) {
  const std::filesystem::path file = name;
  const Format format = FormatOf(bytes, FormatOf(file));
  if (format == Format::kUnknown) {
    return UnknownFormat(file, "use a .bvh, .glb, .vrma, .csv, .fbx, .dae or .mcap file");
  }
  if (format == Format::kMhpose) {
    return Status(StatusCode::kUnsupported,
                  "an expression of MakeHuman needs the pose units beside its file", name,
                  "convert it with 'furrow convert' to .bvh or .glb");
  }
  if (bytes.size() > MaxBytes(format)) {
    return Status(StatusCode::kLimit,
                  "the file has more than " + std::to_string(MaxBytes(format)) + " bytes", name);
  }
  return Read(format, bytes, file, std::nullopt, options, report);
}

bool NeedsHelperProgram(std::string_view bytes, const std::string& name) {
  const Format format = FormatOf(bytes, FormatOf(std::filesystem::path(name)));
  return format == Format::kFbx || format == Format::kCollada;
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
