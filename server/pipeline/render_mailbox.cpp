// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_mailbox.h"

#include <algorithm>
#include <utility>

namespace furrow::server {
namespace {

constexpr int kStillQuality = 92;  // the encoder subsamples chroma below 90

// Adds the recipients of `from` to the newer job `into`, which replaces it. A subscription in both
// keeps its newer ticket. A still becomes a normal picture if the subject has moved since.
void MergeTickets(const RenderJob& from, RenderJob* into) {
  const bool rests = from.moved_at == into->moved_at;
  for (PictureTicket ticket : from.tickets) {
    ticket.still &= rests;
    const auto same =
        std::ranges::find(into->tickets, ticket.subscription, &PictureTicket::subscription);
    if (same == into->tickets.end()) into->tickets.push_back(ticket);
  }
}

// True if one picture serves both jobs; the pose may differ, since the newest wins.
bool IsSamePicture(const RenderJob& a, const RenderJob& b) {
  return a.subject == b.subject && a.spec == b.spec;
}

}  // namespace

bool PictureSpec::operator==(const PictureSpec& other) const {
  return view == other.view && settings == other.settings && width == other.width &&
         height == other.height && camera.position == other.camera.position &&
         camera.target == other.camera.target &&
         camera.fov_y_degrees == other.camera.fov_y_degrees &&
         camera.fit_shorter_side == other.camera.fit_shorter_side &&
         camera.follow_joint == other.camera.follow_joint &&
         camera.turn_joint == other.camera.turn_joint;
}

Encoding EncodingOf(const PictureTicket& ticket) {
  Encoding encoding = ticket.encoding;
  if (ticket.still && encoding.format == render::ImageFormat::kJpeg) {
    encoding.quality = kStillQuality;
  }
  return encoding;
}

bool RenderJob::IsStill() const { return std::ranges::any_of(tickets, &PictureTicket::still); }

// A viewer that changes its view faster than pictures are rendered occupies one place only.
void RenderMailbox::DropOlderTickets(const RenderJob& job) {
  if (job.tickets.empty()) return;
  const auto is_superseded = [&job](const PictureTicket& ticket) {
    return std::ranges::find(job.tickets, ticket.subscription, &PictureTicket::subscription) !=
           job.tickets.end();
  };
  // Also erases jobs that have lost their last ticket: nobody would see them.
  std::erase_if(jobs_, [&](RenderJob& other) {
    if (IsSamePicture(other, job)) return false;
    return std::erase_if(other.tickets, is_superseded) > 0 && other.tickets.empty();
  });
}

RenderMailbox::PutResult RenderMailbox::Put(RenderJob&& job) {
  const std::lock_guard lock(mutex_);
  if (closed_) return PutResult::kFull;
  DropOlderTickets(job);
  // At most `capacity` jobs wait, so a search is fast enough.
  const auto waiting = std::find_if(jobs_.begin(), jobs_.end(), [&](const RenderJob& other) {
    return IsSamePicture(other, job);
  });
  if (waiting != jobs_.end()) {
    // The new job takes the old one's place in the queue. At the back, a subject that moves all the
    // time would never be rendered.
    MergeTickets(*waiting, &job);
    *waiting = std::move(job);
    return PutResult::kReplaced;
  }
  if (job.tickets.empty()) return PutResult::kNotWanted;
  if (jobs_.size() >= capacity_) return PutResult::kFull;
  jobs_.push_back(std::move(job));
  changed_.notify_one();
  return PutResult::kQueued;
}

std::optional<RenderJob> RenderMailbox::Take(bool wait) {
  std::unique_lock lock(mutex_);
  if (wait) changed_.wait(lock, [this] { return closed_ || !jobs_.empty(); });
  if (closed_ || jobs_.empty()) return std::nullopt;
  // A still takes longer (more samples), and nothing moves in it, so it can wait.
  auto next = std::ranges::find_if_not(jobs_, &RenderJob::IsStill);
  if (next == jobs_.end() || passed_over_ >= kMaxPassedOver) next = jobs_.begin();
  // Counts how often the oldest job was passed, so that a moving subject cannot starve stills.
  passed_over_ = next == jobs_.begin() ? 0 : passed_over_ + 1;
  RenderJob job = std::move(*next);
  jobs_.erase(next);
  return job;
}

bool RenderMailbox::WithdrawStill(std::uint64_t subscription) {
  const std::lock_guard lock(mutex_);
  const auto is_still_of = [subscription](const PictureTicket& ticket) {
    return ticket.still && ticket.subscription == subscription;
  };
  for (auto job = jobs_.begin(); job != jobs_.end(); ++job) {
    // A subscription has at most one waiting ticket, so the search ends with the first.
    if (std::erase_if(job->tickets, is_still_of) == 0) continue;
    if (job->tickets.empty()) jobs_.erase(job);
    return true;
  }
  return false;
}

void RenderMailbox::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  jobs_.clear();
  // Take() returns without a job, and the render thread ends.
  changed_.notify_all();
}

bool RenderMailbox::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace furrow::server
