// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_state.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"
#include "rig/rig_file.h"
#include "server/pipeline/wire_adapter.h"

namespace furrow::server {
namespace {

std::uint64_t ValuesHash(const SubjectPipeline& pipeline) {
  return protocol::NamesHash(pipeline.stream().binding->driver_value_names());
}

// Names of JSON contain no line break.
std::string InOneLine(std::string json) {
  std::ranges::replace_if(
      json, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return json;
}

std::string AsText(const wrinkle::ReferencePose& pose) {
  wrinkle::Rig rig;
  rig.name = "pose";
  rig.reference_poses.push_back(pose);
  return rig::RigToJson(rig);
}

void ToWire(const SubjectPipeline& pipeline, const wrinkle::LocalPose& pose,
            std::uint64_t skeleton_hash, protocol::PoseFrame* frame) {
  ToWholePose(pose, pipeline.stream(), frame);
  frame->skeleton_hash = skeleton_hash;
}

// A pose of the subject's stream; nothing if it is of another one.
std::optional<wrinkle::LocalPose> FromWire(const SubjectPipeline& pipeline,
                                           const protocol::PoseFrame& frame) {
  const StreamDefinition& stream = pipeline.stream();
  if (!PoseFits(frame, stream)) return std::nullopt;
  wrinkle::LocalPose pose = pipeline.pose();
  ApplyPose(frame, stream, &pose);
  stream.shapes.Extend(&pose);
  return pose;
}

}  // namespace

protocol::Header StateHeader(const Subject& subject, std::uint32_t number) {
  return {
      .stream = 0,
      .sequence = number,
      .capture_time_us = subject.pipeline->has_pose() ? subject.pipeline->capture_time_us() : 0};
}

std::string CapturesOf(const Subject& subject) {
  wrinkle::Rig captured;
  captured.name = "captures";  // a rig file must have a name
  std::string text;
  for (const wrinkle::ReferencePose& pose :
       subject.pipeline->stream().binding->rig().reference_poses) {
    if (!subject.captures.contains(pose.name)) continue;
    captured.reference_poses.push_back(pose);
    std::string next = InOneLine(rig::RigToJson(captured));
    if (next.size() > protocol::kMaxCaptureBytes) {
      spdlog::warn("the captured pose '{}' of subject '{}' is too large to move", pose.name,
                   subject.name);
      captured.reference_poses.pop_back();
    } else {
      text = std::move(next);
    }
  }
  return text;
}

Result<std::optional<wrinkle::Rig>> WithCaptures(const wrinkle::Rig& rig,
                                                 const std::string& captures, std::size_t most) {
  auto captured = rig::ParseRig(captures, "captures", {});
  FURROW_RETURN_IF_ERROR(captured);
  wrinkle::Rig changed = rig;
  bool differs = false;
  for (wrinkle::ReferencePose& pose : captured->reference_poses) {
    const auto known =
        std::ranges::find(changed.reference_poses, pose.name, &wrinkle::ReferencePose::name);
    if (known == changed.reference_poses.end()) {
      changed.reference_poses.push_back(std::move(pose));
      differs = true;
    } else if (AsText(*known) != AsText(pose)) {
      *known = std::move(pose);
      differs = true;
    }
  }
  if (changed.reference_poses.size() - rig.reference_poses.size() > most) {
    return Status(StatusCode::kLimit, "too many reference poses were captured", "captures");
  }
  if (!differs) return std::optional<wrinkle::Rig>();
  return std::optional(std::move(changed));
}

protocol::SubjectState StateOf(const Subject& subject) {
  const SubjectPipeline& pipeline = *subject.pipeline;
  protocol::SubjectState state;
  state.subject = subject.name;
  state.skeleton_hash = subject.skeleton_hash;
  state.publisher_session = subject.owner.session;
  state.run = subject.run;
  state.captures = CapturesOf(subject);
  state.has_neutral = pipeline.neutral_pose().has_value();
  if (state.has_neutral) {
    ToWire(pipeline, *pipeline.neutral_pose(), subject.skeleton_hash, &state.neutral);
  }
  // A window without a pose: the last one is of the publisher before.
  state.has_pose = pipeline.has_pose() && subject.window.started();
  if (!state.has_pose) return state;
  ToWire(pipeline, pipeline.pose(), subject.skeleton_hash, &state.pose);
  state.pose.timecode = subject.timecode;
  SubjectPipeline::Memory memory = pipeline.memory();
  state.newest_sequence = subject.window.newest();
  state.values_hash = ValuesHash(pipeline);
  state.num_drivers =
      static_cast<std::uint32_t>(std::min<std::size_t>(memory.level, protocol::kAllDriversOnWire));
  state.filtered = std::move(memory.solver.filtered);
  state.inputs = std::move(memory.solver.inputs);
  state.speeds = std::move(memory.solver.speeds);
  for (float& speed : state.speeds) {
    speed = std::clamp(speed, -protocol::kMaxMagnitude, protocol::kMaxMagnitude);
  }
  state.since_input_s = std::min(memory.solver.since_input, double{protocol::kMaxMagnitude});
  return state;
}

void ResumeFrom(const protocol::Header& header, const protocol::SubjectState& state,
                Subject* subject) {
  SubjectPipeline& pipeline = *subject->pipeline;
  if (!state.captures.empty()) {
    if (const auto captured = rig::ParseRig(state.captures, "captures", {}); captured.ok()) {
      for (const auto& pose : captured->reference_poses) subject->captures.insert(pose.name);
    }
  }
  if (state.skeleton_hash != subject->skeleton_hash) return;
  if (state.has_neutral) pipeline.SetNeutral(FromWire(pipeline, state.neutral));
  // Another session of the publisher has another clock and counts from anywhere.
  if (state.publisher_session != subject->owner.session) return;
  subject->run = state.run;
  if (!state.has_pose) return;
  subject->window = protocol::SequenceWindow::After(state.publisher_session, state.newest_sequence);
  const auto pose = FromWire(pipeline, state.pose);
  if (!pose || state.values_hash != ValuesHash(pipeline)) return;
  const std::size_t level = state.num_drivers == protocol::kAllDriversOnWire
                                ? wrinkle::kAllDrivers
                                : std::size_t{state.num_drivers};
  const bool resumes = pipeline.Resume(*pose, {.sequence = state.newest_sequence,
                                               .capture_time_us = header.capture_time_us,
                                               .level = level,
                                               .solver = {.filtered = state.filtered,
                                                          .inputs = state.inputs,
                                                          .speeds = state.speeds,
                                                          .since_input = state.since_input_s}});
  if (resumes) subject->timecode = state.pose.timecode;
}

}  // namespace furrow::server
