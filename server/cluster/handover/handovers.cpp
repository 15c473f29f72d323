// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/handovers.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/limits.h"

namespace furrow::server {

// No wait outlasts the end by much.
Time Handovers::Patience(Time most, Time now) const {
  constexpr Time kLeast = std::chrono::milliseconds(50);
  return end_ ? std::clamp(*end_ - now, kLeast, most) : most;
}

void Handovers::Begin() {
  subjects_->TakeNothingNew();
  BeginRound();
}

void Handovers::BeginRound() {
  silent_.clear();
  any_has_left_ = false;
  round_ = subjects_->SubjectNames();
  std::ranges::reverse(round_);
  step_ = round_.empty() ? Step::kLastAnswers : Step::kNextSubject;
}

void Handovers::Tick(Time now) {
  Repeat(now);
  while (Advance(now)) {
  }
}

// One step. False: there is nothing to do before the next event.
bool Handovers::Advance(Time now) {
  switch (step_) {
    case Step::kIdle: return false;
    case Step::kNextSubject: return NextSubject(now);
    case Step::kChoose: return Choose(now);
    case Step::kConnect: return Connect(now);
    case Step::kAsk: return Ask(now);
    case Step::kPause:
      if (now < next_round_ && !IsOver(now)) return false;
      BeginRound();
      return true;
    case Step::kLastAnswers:
      if (!sent_.empty()) return false;  // for at most kAnswerPatience
      while (!open_.empty()) Unlink(open_.begin()->first);
      step_ = Step::kIdle;
      return false;
  }
  return false;
}

bool Handovers::NextSubject(Time now) {
  if (IsOver(now)) {
    step_ = Step::kLastAnswers;
  } else if (round_.empty()) {
    EndRound(now);
  } else {
    subject_ = std::move(round_.back());
    round_.pop_back();
    without_ = silent_;
    failure_ = Status();
    step_ = Step::kChoose;
  }
  return true;
}

void Handovers::EndRound(Time now) {
  if (any_has_left_) return BeginRound();
  step_ = end_ ? Step::kLastAnswers : Step::kPause;
  next_round_ = now + kNextRound;
}

// The node with the most room; if that one does not take the subject, the next one.
bool Handovers::Choose(Time now) {
  if (IsOver(now)) {
    EndSubject(failure_.ok() ? Status(StatusCode::kUnavailable, "the time is over") : failure_);
    return true;
  }
  const Place place = subjects_->SuccessorOf(subject_, now, without_);
  // A lease may name a node that has refused.
  if (place.kind != Place::Kind::kElsewhere || without_.contains(place.node.name)) {
    const std::string why = place.why.empty() ? "no other node answers" : place.why;
    EndSubject(failure_.ok() ? Status(StatusCode::kUnavailable, why) : failure_);
    return true;
  }
  node_ = place.node;
  step_ = Step::kConnect;
  if (open_.try_emplace(node_.name).second) {
    links_->Open(node_, Patience(kConnectPatience, now));
  }
  return true;
}

void Handovers::OnLink(const std::string& node, const Status& status) {
  if (const auto known = open_.find(node); known != open_.end()) known->second = status;
}

bool Handovers::Connect(Time now) {
  const std::optional<Status>& result = open_.at(node_.name);
  if (!result) return false;
  if (result->ok()) {
    AskNode(now);
    return true;
  }
  Status failure = *result;
  Unlink(node_.name);
  silent_.insert(node_.name);
  PassOver(std::move(failure));
  return true;
}

void Handovers::AskNode(Time now) {
  std::vector<std::uint8_t> message;
  number_ = next_number_++;
  answer_.reset();
  if (!subjects_->WriteState(subject_, number_, message)) {
    return EndSubject(Status(StatusCode::kNotFound, "it has left"));
  }
  if (message.size() > protocol::kMaxUdpMessageBytes) {
    return EndSubject(Status(StatusCode::kLimit, "its state has " + std::to_string(message.size()) +
                                                     " bytes, more than the " +
                                                     std::to_string(protocol::kMaxUdpMessageBytes) +
                                                     " that fit"));
  }
  Send(node_.name, number_, std::move(message), now);
  step_ = Step::kAsk;
}

bool Handovers::Ask(Time now) {
  if (answer_ && answer_->accepted) {
    OnAccepted(now);
  } else if (answer_) {
    if (links_->HasFailed(node_.name)) Unlink(node_.name);
    PassOver(Status(StatusCode::kUnavailable,
                    "the node '" + node_.name + "' refuses it: " + answer_->why));
  } else if (!sent_.contains(number_)) {
    Unlink(node_.name);  // it may have another address by now
    silent_.insert(node_.name);
    PassOver(Status(StatusCode::kUnavailable, "the node '" + node_.name + "' does not answer"));
  } else {
    return false;
  }
  return true;
}

void Handovers::OnAccepted(Time now) {
  std::vector<std::uint8_t> message;
  const std::uint32_t last = next_number_++;
  const Status status = subjects_->HandOver(subject_, node_, last, message, now);
  if (status.ok()) Send(node_.name, last, std::move(message), now);
  // Another node may take it.
  if (status.code() == StatusCode::kUnavailable) return PassOver(status);
  EndSubject(status);
}

void Handovers::PassOver(Status failure) {
  failure_ = std::move(failure);
  without_.insert(node_.name);
  step_ = Step::kChoose;
}

void Handovers::EndSubject(const Status& status) {
  step_ = Step::kNextSubject;
  const bool has_left = status.code() == StatusCode::kNotFound;
  any_has_left_ |= status.ok() || has_left;
  if (has_left) return;
  if (status.ok()) {
    ++progress_.moved;  // others may still stay
    return;
  }
  progress_.stays = subject_;
  progress_.why = status.what();
}

void Handovers::Send(const std::string& node, std::uint32_t number,
                     std::vector<std::uint8_t> message, Time now) {
  links_->Send(node, message);
  sent_.insert_or_assign(number, Sent{.node = node,
                                      .message = std::move(message),
                                      .sent = now,
                                      .give_up = now + Patience(kAnswerPatience, now)});
}

void Handovers::OnAnswer(const std::string& node, std::uint32_t number, bool accepted,
                         const std::string& why) {
  const auto found = sent_.find(number);
  if (found == sent_.end() || found->second.node != node) return;
  if (number == number_) answer_ = Answer{accepted, why};
  sent_.erase(found);
}

void Handovers::Repeat(Time now) {
  std::erase_if(sent_, [now](const auto& each) { return now >= each.second.give_up; });
  for (auto& [number, sent] : sent_) {
    if (now - sent.sent < kRepeat) continue;
    sent.sent = now;
    links_->Send(sent.node, sent.message);
  }
}

void Handovers::Unlink(const std::string& node) {
  links_->Close(node);
  open_.erase(node);
}

}  // namespace furrow::server
