// SPDX-License-Identifier: Apache-2.0
// What whoever runs the session changes while it runs: the rig, a subject's neutral, the settings.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "server/session/hub.h"

namespace furrow::server {

Subject* Hub::EvaluateInFull(std::string_view name) {
  Subject* subject = name.empty() ? subjects_.First() : subjects_.Find(name);
  if (subject == nullptr) return nullptr;
  subject->in_full = true;
  subject->pipeline->SetLevel(wrinkle::kAllDrivers);
  return subject;
}

std::string_view Hub::SourceOf(const Subject& subject) {
  const Peer* peer = LaneOf(subject.owner.peer).peers.Find(subject.owner.peer);
  return peer == nullptr ? std::string_view() : std::string_view(peer->name);
}

Status Hub::SetRig(std::shared_ptr<const wrinkle::Rig> rig, Time now) {
  const std::shared_ptr<const wrinkle::Rig> former = definitions_.shared_rig();
  definitions_.SetRig(std::move(rig));
  std::vector<std::shared_ptr<const StreamDefinition>> made;
  for (const auto& subject : subjects_.all()) {
    auto definition = definitions_.Remake(subject->pipeline->stream());
    if (!definition.ok()) {
      definitions_.SetRig(former);
      return definition.status().At(subject->name);
    }
    made.push_back(*std::move(definition));
  }
  for (std::size_t i = 0; i < made.size(); ++i) {
    Subject& subject = *subjects_.all()[i];
    subject.pipeline->SetStream(std::move(made[i]));
    subscribers_.OnSubjectReady(subject);
    Reweighted(subject, now);
  }
  return {};
}

void Hub::SetNeutral(Subject& subject, std::optional<wrinkle::LocalPose> neutral, Time now) {
  if (subject.pipeline->SetNeutral(std::move(neutral))) Reweighted(subject, now);
}

// Other weights of the pose that was there: never of age 0, as only a new pose is.
void Hub::Reweighted(Subject& subject, Time now) {
  if (!subject.pipeline->has_pose()) return;
  Weighted(*lanes_.front(), subject, {},
           std::max<std::int64_t>(1, ToMicroseconds(now - subject.last_pose)), now);
}

}  // namespace furrow::server
