// SPDX-License-Identifier: Apache-2.0
#include "server/session/live_rig.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "server/session/subjects/subject_state.h"

namespace furrow::server {

Status LiveRig::Set(std::shared_ptr<const wrinkle::Rig> rig, Time now) {
  StreamDefinitions& definitions = *parts_.definitions;
  const std::shared_ptr<const wrinkle::Rig> former = definitions.shared_rig();
  definitions.SetRig(std::move(rig));
  // Bind every subject first, so that an error changes nothing.
  std::vector<std::shared_ptr<const StreamDefinition>> bound;
  for (const auto& subject : parts_.subjects->all()) {
    auto definition = definitions.Rebind(subject->pipeline->stream());
    if (!definition.ok()) {
      definitions.SetRig(former);
      return definition.status().At(subject->name);
    }
    // Subjects with equal streams share the definition that the first of them made.
    bound.push_back(*std::move(definition));
  }
  // From here on nothing can fail.
  const auto& subjects = parts_.subjects->all();
  for (std::size_t i = 0; i < bound.size(); ++i) {
    subjects[i]->pipeline->SetStream(std::move(bound[i]));
  }
  if (parts_.recording != nullptr) {
    parts_.recording->OnRig(definitions.rig(), *parts_.subjects, now);
  }
  for (const auto& subject : subjects) {
    parts_.subscribers->OnSubjectReady(*subject);
    Republish(*subject, now);
  }
  return {};
}

Status LiveRig::SetWithMaps(std::shared_ptr<const wrinkle::Rig> rig, StreamMaps maps, Time now) {
  const bool is_other = rig != parts_.definitions->shared_rig();
  StreamMaps former = parts_.definitions->SetMaps(std::move(maps));
  Status status = Set(std::move(rig), now);
  if (!status.ok()) {
    (void)parts_.definitions->SetMaps(std::move(former));
  } else if (is_other) {
    own_ = parts_.definitions->shared_rig();
    ++num_replacements_;
    // The captured poses have gone with the former rig.
    num_added_poses_ = 0;
    for (const auto& subject : parts_.subjects->all()) subject->captures.clear();
  }
  return status;
}

void LiveRig::SetNeutral(Subject& subject, std::optional<wrinkle::LocalPose> neutral, Time now) {
  if (subject.pipeline->SetNeutral(std::move(neutral))) Republish(subject, now);
}

// The age is at least 1: only a new pose has age 0.
void LiveRig::Republish(Subject& subject, Time now) {
  if (!subject.pipeline->has_pose()) return;
  parts_.router->PublishAged(parts_.shards->at(0), subject,
                             std::max<std::int64_t>(1, ToMicroseconds(now - subject.last_pose)),
                             now);
}

void LiveRig::AdoptCaptures(const protocol::SubjectState& state, int most, Time now) {
  const wrinkle::Rig& rig = parts_.definitions->rig();
  auto changed =
      WithCaptures(rig, state.captures, static_cast<std::size_t>(most - num_added_poses_));
  Status status = changed.status();
  int added = 0;
  if (changed.ok()) {
    if (!changed->has_value()) return;
    added = static_cast<int>((*changed)->reference_poses.size() - rig.reference_poses.size());
    status = Set(std::make_shared<const wrinkle::Rig>(**std::move(changed)), now);
  }
  if (status.ok()) {
    num_added_poses_ += added;
    ++num_replacements_;
    spdlog::info("took over the captured poses of subject '{}'", state.subject);
  } else {
    spdlog::warn("cannot take over the captured poses of subject '{}': {}", state.subject,
                 status.ToString());
  }
}

}  // namespace furrow::server
