// SPDX-License-Identifier: Apache-2.0
#include "server/playback/playback.h"

#include <string>
#include <utility>

namespace furrow::server {

void Playback::Start(Hub* hub, Time now, std::function<void()> on_change,
                     std::function<void(std::unique_ptr<Player>)> release) {
  hub_ = hub;
  on_change_ = std::move(on_change);
  release_ = std::move(release);
  if (Player* const first = this->player(); first != nullptr) first->Start(hub_, now);
}

Status Playback::Play(std::unique_ptr<Player> player, Time now) {
  Player* const former = this->player();
  // Otherwise this daemon would contest the subject itself.
  const bool same_subject = former != nullptr && former->subject() == player->subject();
  if (same_subject) former->Stop(now);
  player->Start(hub_, now);
  if (const std::string why = player->refusal(); !why.empty()) {
    player->Stop(now);
    if (same_subject) former->Start(hub_, now);
    release_(std::move(player));
    return Status(StatusCode::kUnavailable, why);
  }
  if (former != nullptr && !same_subject) former->Stop(now);
  std::swap(uploaded_, player);
  if (player != nullptr) release_(std::move(player));
  if (on_change_) on_change_();
  return {};
}

bool Playback::Close(Time now) {
  if (uploaded_ == nullptr) return false;
  uploaded_->Stop(now);
  release_(std::move(uploaded_));
  uploaded_.reset();
  if (configured_ != nullptr) configured_->Start(hub_, now);
  if (on_change_) on_change_();
  return true;
}

Time Playback::Advance(Time now) {
  Player* const current = player();
  return current != nullptr ? current->Advance(now) : kNever;
}

}  // namespace furrow::server
