// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/capture_api.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "base/ascii.h"
#include "base/status.h"
#include "rig/rig_reference_pose.h"
#include "rig/shapes/rig_shapes.h"

namespace furrow::server {
namespace {

constexpr char kNeutral[] = "neutral";
// Enough to undo a guided capture of all poses of a face. Each entry may hold a whole rig (half a
// megabyte for the default one), so the history is bounded; the oldest entry goes first.
constexpr std::size_t kMaxUndo = 64;
// The name becomes part of the rig file.
constexpr std::size_t kMaxPoseName = 64;

using Values = std::vector<float>;

// The weights that subscribers see now, after the filter.
Values WeightsOf(const Subject& subject) {
  const auto weights = subject.pipeline->wrinkle_weights();
  return {weights.begin(), weights.end()};
}

// The weights that the pose would have, solved in a pipeline of its own so that the live subject
// and its filter do not change. nullopt: the solver refused the pose.
std::optional<Values> SolvePreview(std::shared_ptr<const StreamDefinition> stream,
                                   const wrinkle::LocalPose& pose,
                                   const std::optional<wrinkle::LocalPose>& neutral) {
  SubjectPipeline trial(std::move(stream));
  *trial.mutable_pose() = pose;
  // A new pipeline has an empty filter, so the result shows the pose alone.
  if (!trial.SetNeutral(neutral) || trial.Solve(0, 0) != wrinkle::JobStatus::kOk) return {};
  const auto weights = trial.wrinkle_weights();
  return Values(weights.begin(), weights.end());
}

// All weights before and after a capture.
Json ChangesJson(std::span<const std::string> names, const Values& before, const Values& after) {
  Json list = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    list.push_back({{"name", names[i]}, {"before", before[i]}, {"after", after[i]}});
  }
  return list;
}

// Replaces joint names of the stream by those of the rig, which a rig file must contain.
void UseJointNamesOfRig(const StreamDefinition& stream, wrinkle::ReferencePose* pose) {
  for (wrinkle::JointDelta& delta : pose->joints) {
    const auto& aliases = stream.match.aliases;
    const auto alias =
        std::ranges::find(aliases, delta.joint, &std::pair<std::string, std::string>::second);
    if (alias != aliases.end()) delta.joint = alias->first;
  }
}

// The names under which a pose stores the stream's coefficients; "" for those that it omits. If a
// map translates the stream's own names, the names of ARKit and of the rig go into the file, so
// that the pose means the same for every stream.
std::vector<std::string> ShapeNamesToStore(const StreamDefinition& stream,
                                           const wrinkle::Rig& rig) {
  const auto names = stream.shapes.driver_names();
  std::vector<std::string> stored(names.begin(), names.end());
  if (stream.shapes.drivers().num_mapped() == 0) return stored;
  const std::vector<std::string> known = rig::ArkitAndRigShapes(rig);
  for (std::string& name : stored) {
    const auto is_same = [&](const std::string& other) { return EqualsIgnoreCase(name, other); };
    if (std::ranges::none_of(known, is_same)) name.clear();
  }
  return stored;
}

// A stream without joints knows nothing about the joints of a pose, and one without blend shapes
// nothing about its shapes: what it replaces keeps them.
void KeepUnseenParts(const StreamDefinition& stream, const wrinkle::ReferencePose& before,
                     wrinkle::ReferencePose* captured) {
  if (stream.skeleton.num_joints() == 0) {
    captured->joints = before.joints;
    captured->source_size = before.source_size;
  }
  if (stream.shapes.source_names().empty()) captured->shapes = before.shapes;
}

// The rig with the subject's pose as the named reference pose. `added`: the rig had no such pose.
Result<wrinkle::Rig> WithReferencePose(const wrinkle::Rig& rig, const Subject& subject,
                                       const std::string& pose, bool* added) {
  const SubjectPipeline& pipeline = *subject.pipeline;
  // Reference poses are in Furrow's model axes, which may not be those of the stream.
  const glm::quat turn = pipeline.stream().match.turn();
  wrinkle::PoseFrame frame{wrinkle::TurnRoots(pipeline.stream().skeleton, turn),
                           pipeline.solved_pose(), ShapeNamesToStore(pipeline.stream(), rig)};
  wrinkle::TurnRoots(frame.skeleton, turn, frame.pose.joints);
  auto captured = rig::ReferencePoseFromFrame(pose, frame);
  FURROW_RETURN_IF_ERROR(captured);
  UseJointNamesOfRig(pipeline.stream(), &*captured);
  // A copy: other subjects read the present rig until SetRig() replaces it.
  wrinkle::Rig changed = rig;
  const auto known =
      std::ranges::find(changed.reference_poses, pose, &wrinkle::ReferencePose::name);
  *added = known == changed.reference_poses.end();
  if (*added) {
    changed.reference_poses.push_back(*std::move(captured));
  } else {
    KeepUnseenParts(pipeline.stream(), *known, &*captured);
    *known = *std::move(captured);
  }
  return changed;
}

// Letters, digits, '_' and '-'. The name comes from the network and goes into files and the log.
bool IsPoseName(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kMaxPoseName && std::ranges::all_of(name, is_plain);
}

}  // namespace

Json CaptureApi::History(const Hub& hub) const {
  Json list = Json::array();
  for (const Capture& capture : captures_) {
    if (capture.replacements != hub.num_rig_replacements()) continue;
    list.push_back({{"pose", capture.pose}, {"subject", capture.subject}});
  }
  return list;
}

void CaptureApi::Remember(Capture capture) {
  if (captures_.size() >= kMaxUndo) captures_.erase(captures_.begin());
  captures_.push_back(std::move(capture));
}

ApiReply CaptureApi::PostCapture(const ApiRequest& request, Hub& hub, Time now) {
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  const Json subject_name = object->value("subject", Json(""));
  const Json pose = object->value("pose", Json());
  const Json preview = object->value("preview", Json(false));
  const Json part_name = object->value("part", Json());
  if (!subject_name.is_string()) return ErrorReply(400, "schema", "subject", "must be text");
  if (!preview.is_boolean()) return ErrorReply(400, "schema", "preview", "must be true or false");
  if (!pose.is_string() || !IsPoseName(pose.get<std::string>())) {
    return ErrorReply(400, "schema", "pose",
                      "must be 'neutral' or a name of letters, digits, '_' and '-'");
  }
  std::optional<NeutralPart> part;
  if (!part_name.is_null()) {
    if (part_name.is_string()) part = ParseNeutralPart(part_name.get<std::string>());
    if (!part || pose != kNeutral) {
      return ErrorReply(400, "schema", "part",
                        "must be 'face', 'body' or 'both', and belongs to the pose 'neutral'");
    }
  }
  // The reply shows all weights, not only those that somebody subscribes to.
  const auto name = subject_name.get<std::string>();
  Subject* subject = hub.RequireAllDrivers(name, request.access);
  if (subject == nullptr) return NoSuchSubject(hub, name, request.access);
  if (!subject->pipeline->has_pose()) {
    return ErrorReply(409, "conflict", "subject", "the subject has sent no pose yet");
  }
  if (pose == kNeutral) return CaptureNeutral(hub, *subject, part, preview.get<bool>(), now);
  return CapturePose(hub, *subject, pose.get<std::string>(), preview.get<bool>(), now);
}

ApiReply CaptureApi::CaptureNeutral(Hub& hub, Subject& subject, std::optional<NeutralPart> wanted,
                                    bool preview, Time now) {
  const SubjectPipeline& pipeline = *subject.pipeline;
  const NeutralPart part = wanted.value_or(DefaultNeutralPart(pipeline.stream()));
  const wrinkle::LocalPose neutral =
      CaptureNeutralPart(part, pipeline.stream(), pipeline.pose(), pipeline.neutral_pose());
  const Values before = WeightsOf(subject);
  const std::optional<Values> after =
      // The part measured from itself: what remains are the weights of a relaxed performer.
      SolvePreview(pipeline.shared_stream(), pipeline.pose(), neutral);
  if (!after)
    return ErrorReply(500, "internal", "", "the solver refused the pose as its own neutral pose");
  if (!preview) {
    // Taken before SetNeutral() replaces it; Undo() puts it back.
    std::optional<wrinkle::LocalPose> former = pipeline.neutral_pose();
    hub.SetNeutral(subject, neutral, now);
    Remember({kNeutral, subject.name, subject.skeleton_hash, std::move(former), nullptr, false,
              hub.num_rig_replacements()});
  }
  return JsonReply(
      {{"pose", kNeutral},
       {"part", ToString(part)},
       {"preview", preview},
       {"added", false},
       {"weights", ChangesJson(pipeline.stream().binding->weight_names(), before, *after)},
       {"captures", History(hub)}});
}

ApiReply CaptureApi::CapturePose(Hub& hub, Subject& subject, const std::string& pose, bool preview,
                                 Time now) {
  bool added = false;
  Result<wrinkle::Rig> changed = WithReferencePose(hub.rig(), subject, pose, &added);
  if (!changed.ok()) return ErrorReply(changed.status());
  if (added && hub.num_added_poses() >= Hub::kMaxAddedPoses) {
    return ErrorReply(409, "limit", "pose",
                      "the rig has " + std::to_string(Hub::kMaxAddedPoses) +
                          " poses that were captured since the start; capture one of them again");
  }
  const SubjectPipeline& pipeline = *subject.pipeline;
  // Binding checks the changed rig before anything is replaced, and serves the preview.
  auto bound = wrinkle::RigBinding::Create(*changed, pipeline.stream().skeleton,
                                           pipeline.stream().shapes.driver_names(),
                                           pipeline.stream().match.Options(/*allow_missing=*/true));
  if (!bound.ok()) return ErrorReply(bound.status());
  const Values before = WeightsOf(subject);
  auto stream = std::make_shared<StreamDefinition>(pipeline.stream());
  stream->binding = std::make_shared<const wrinkle::RigBinding>(*std::move(bound));
  const auto after = SolvePreview(std::move(stream), pipeline.pose(), pipeline.neutral_pose());
  if (!after) {
    return ErrorReply(500, "internal", "", "the solver refused the pose with the changed rig");
  }
  Json changes = ChangesJson(pipeline.stream().binding->weight_names(), before, *after);
  if (!preview) {
    std::shared_ptr<const wrinkle::Rig> former = hub.shared_rig();
    if (Status status = hub.SetRig(std::make_shared<const wrinkle::Rig>(*std::move(changed)), now);
        !status.ok()) {
      return ErrorReply(status);
    }
    spdlog::info("captured reference pose '{}' from '{}'", pose, subject.name);
    hub.AddToAddedPoses(added ? 1 : 0);
    subject.captures.insert(pose);
    Remember({pose, subject.name, subject.skeleton_hash, std::nullopt, std::move(former), added,
              hub.num_rig_replacements()});
  }
  return JsonReply({{"pose", pose},
                    {"preview", preview},
                    {"added", added},
                    {"weights", std::move(changes)},
                    {"captures", History(hub)}});
}

// An earlier capture of the same pose stays with its subject.
void CaptureApi::Forget(const Capture& last, Hub& hub) {
  const auto is_same = [&last](const Capture& other) {
    return &other != &last && other.pose == last.pose && other.subject == last.subject;
  };
  Subject* const subject = hub.FindSubject(last.subject);
  if (subject != nullptr && std::ranges::none_of(captures_, is_same)) {
    subject->captures.erase(last.pose);
  }
}

ApiReply CaptureApi::Undo(Hub& hub, Time now) {
  std::erase_if(captures_, [&hub](const Capture& capture) {
    return capture.replacements != hub.num_rig_replacements();
  });
  if (captures_.empty()) return ErrorReply(409, "conflict", "", "there is nothing to undo");
  const Capture& last = captures_.back();
  // Entries are undone in reverse order, so the rig before this capture is the right one.
  if (last.rig != nullptr) {
    if (Status status = hub.SetRig(last.rig, now); !status.ok()) return ErrorReply(status);
    hub.AddToAddedPoses(last.added ? -1 : 0);
    Forget(last, hub);
  } else if (Subject* subject = hub.RequireAllDrivers(last.subject);
             subject != nullptr && subject->skeleton_hash == last.skeleton_hash) {
    hub.SetNeutral(*subject, last.neutral, now);
  }
  // Also if the subject has left or has another skeleton: its neutral has gone with it.
  captures_.pop_back();
  return JsonReply({{"captures", History(hub)}});
}

}  // namespace furrow::server
