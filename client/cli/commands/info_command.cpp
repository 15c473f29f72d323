// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <map>
#include <memory>

#include "base/joined.h"
#include "base/text.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/command.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "motion/clip/clip.h"
#include "recording/take_poses.h"
#include "recording/take_summary.h"

namespace furrow::cli {
namespace {

using recording::SubjectSummary;
using recording::TakeReader;

// Lists the animations of a file, of which "FILE#NAME" or "FILE#INDEX" chooses one.
void PrintAnimations(const std::vector<motion::AnimationInfo>& animations) {
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const std::string& name = animations[i].name;
    std::printf("  animation   %zu: %s, %.3f s\n", i, name.empty() ? "(no name)" : name.c_str(),
                animations[i].seconds);
  }
}

// What the names of the blend shapes mean, as the shipped shape maps know them.
void PrintVocabulary(const std::vector<std::string>& names) {
  if (names.empty()) return;
  const auto matcher = LoadShapeMatcher("");
  if (!matcher.ok()) return;
  const rig::ShapeVocabulary* vocabulary = matcher->VocabularyOf(names);
  if (vocabulary == nullptr) {
    std::printf("  shape map   none fits; write one with furrow shape-map propose\n");
    return;
  }
  const rig::VocabularyFit fit = vocabulary->Fit(names);
  std::printf("  shape map   '%s' knows %d of %s\n", vocabulary->map().name.c_str(), fit.explained,
              Counted(names.size(), "blend shape").c_str());
}

int DescribeClip(const std::string& path, const motion::LoadOptions& read, const std::string& map) {
  motion::ClipReport report;
  const auto clip = LoadClipArgument(path, read, &report);
  if (!clip.ok()) return Fail(clip.status());
  double longest = 0.0;
  for (std::size_t i = 1; i < clip->times.size(); ++i)
    longest = std::max(longest, clip->times[i] - clip->times[i - 1]);
  // The average rate; the longest gap shows whether the frames are even.
  const double rate =
      clip->duration() > 0.0 ? static_cast<double>(clip->num_frames() - 1) / clip->duration() : 0.0;
  std::printf("%s\n", path.c_str());
  std::printf("  subject     %s\n", clip->name.c_str());
  std::printf("  skeleton    %s, %s\n", Counted(clip->skeleton.num_joints(), "joint").c_str(),
              Counted(clip->blend_shape_names.size(), "blend shape").c_str());
  PrintVocabulary(clip->blend_shape_names);
  if (clip->skeleton.num_joints() > 0) {
    const auto matcher = LoadSkeletonMatcher(map);
    if (!matcher.ok()) return Fail(matcher.status());
    // Without a rig, the match has the roles and the axes alone.
    const rig::SkeletonMatch match = matcher->Match(clip->skeleton, wrinkle::Rig(), nullptr);
    PrintWarnings(rig::WarningsOf(match));
    std::printf("  joints      %s\n", rig::Describe(match).c_str());
  }
  std::printf("  frames      %d in %.3f s, %.2f Hz, longest gap %.3f s\n", clip->num_frames(),
              clip->duration(), rate, longest);
  PrintAnimations(report.animations);
  return kDone;
}

void PrintFile(const TakeReader& take) {
  const motion::mcap::Reader& file = take.file();
  std::map<std::string, int> compressions;
  std::size_t num_chunks = 0;
  for (const motion::mcap::ChunkInfo& chunk : file.chunks()) {
    // Messages outside of chunks have no compression to count.
    if (chunk.compression == motion::mcap::kLooseMessages) continue;
    ++compressions[chunk.compression.empty() ? "uncompressed" : chunk.compression];
    ++num_chunks;
  }
  std::printf("  file        %" PRIu64 " bytes, written by '%s', %s\n", file.file_bytes(),
              file.library().c_str(),
              file.complete() ? "complete" : "cut short, readable up to the last whole chunk");
  std::printf("  chunks      %zu", num_chunks);
  for (const auto& [name, count] : compressions) std::printf(", %d %s", count, name.c_str());
  if (file.warnings().empty()) {
    std::printf("; all checksums are correct\n");
  } else {
    std::printf("; %s, see below\n", file.complete() ? "damaged" : "incomplete");
  }
  for (const motion::mcap::AttachmentInfo& info : file.attachments())
    std::printf("  attachment  %s, %s, %" PRIu64 " bytes\n", info.name.c_str(),
                info.media_type.c_str(), info.size);
}

void PrintSubject(const std::string& name, const SubjectSummary& subject) {
  std::printf("  subject     %s: %s, %s; skeletons: %zu, senders: %zu\n", name.c_str(),
              Counted(subject.joints, "joint").c_str(),
              Counted(subject.blend_shapes, "blend shape").c_str(), subject.skeletons,
              subject.sessions.size());
  std::printf("    poses     %zu in %.3f s, %.2f Hz, %" PRIu64 " missing, longest gap %.3f s\n",
              subject.poses, static_cast<double>(subject.last_ns - subject.first_ns) * 1e-9,
              subject.rate(), subject.missing, subject.longest_gap);
  std::printf("    weights   %s, each of %s\n", Counted(subject.weights, "frame").c_str(),
              Counted(subject.weight_names, "name").c_str());
  if (subject.unreadable > 0)
    std::printf("    unreadable %s\n", Counted(subject.unreadable, "message").c_str());
}

// The topics of other programs. A foreign file may have thousands, so the list has a limit.
void PrintForeign(const recording::TakeSummary& summary) {
  constexpr std::size_t kListed = 32;
  std::size_t listed = 0;
  for (const auto& [name, topic] : summary.foreign) {
    if (++listed > kListed) break;
    std::printf("  foreign     %s: %s, encoding %s%s%s\n", name.c_str(),
                Counted(topic.messages, "message").c_str(),
                topic.encoding.empty() ? "unknown" : topic.encoding.c_str(),
                topic.schema.empty() ? "" : ", schema ", topic.schema.c_str());
  }
  if (summary.foreign.size() > kListed)
    std::printf("  foreign     %zu topics more\n", summary.foreign.size() - kListed);
}

int DescribeTake(const std::string& path) {
  std::string only;
  const auto take = OpenTakeArgument(path, &only);
  if (!take.ok()) return Fail(take.status());
  const std::string file = (*take)->path().string();
  const auto summary = recording::Summarise(**take);
  if (!summary.ok()) return Fail(summary.status());
  if (!only.empty() && !summary->subjects.contains(only)) {
    const std::string names = Joined(std::views::keys(summary->subjects));
    return Fail({StatusCode::kNotFound, "the take has no subject '" + only + "'", file,
                 "subjects: " + (names.empty() ? "none" : names)});
  }
  std::printf("%s\n", file.c_str());
  PrintFile(**take);
  std::size_t messages = summary->messages;
  for (const auto& [name, topic] : summary->foreign) messages += topic.messages;
  std::printf("  messages    %zu in %.3f s; datagrams: %zu\n", messages, summary->seconds(),
              summary->datagrams);
  PrintForeign(*summary);
  for (const auto& [name, subject] : summary->subjects)
    if (only.empty() || only == name) PrintSubject(name, subject);
  PrintWarnings((*take)->file().warnings());
  return kDone;
}

}  // namespace

void AddInfo(CLI::App& app, Action& action) {
  auto path = std::make_shared<std::string>();
  auto read = std::make_shared<motion::LoadOptions>();
  auto map = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "info", "Describe a recording: subjects, rates, gaps, duration and completeness");
  command
      ->add_option("FILE", *path,
                   "Recording: .bvh, .glb, .gltf, .vrma, .fbx, .dae, .csv, .mhpose or .mcap")
      ->required();
  AddReadOptions(*command, *read);
  AddSkeletonMap(*command, *map);
  command->callback([path, read, map, &action] {
    action = [path, read, map] {
      return recording::IsTakePath(*path) ? DescribeTake(*path) : DescribeClip(*path, *read, *map);
    };
  });
}

}  // namespace furrow::cli
