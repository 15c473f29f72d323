// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_mailbox.h"

#include <algorithm>
#include <utility>

namespace furrow::server {
namespace {

void MergeTickets(const std::vector<PictureTicket>& from, std::vector<PictureTicket>* into) {
  for (const PictureTicket& ticket : from) {
    const auto is_same = [&](const PictureTicket& other) {
      return other.subscription == ticket.subscription;
    };
    if (std::none_of(into->begin(), into->end(), is_same)) into->push_back(ticket);
  }
}

}  // namespace

bool PictureSpec::operator==(const PictureSpec& other) const {
  return view == other.view && settings == other.settings && width == other.width &&
         height == other.height && camera.position == other.camera.position &&
         camera.target == other.camera.target &&
         camera.fov_y_degrees == other.camera.fov_y_degrees &&
         camera.fit_shorter_side == other.camera.fit_shorter_side &&
         camera.follow_joint == other.camera.follow_joint;
}

RenderMailbox::PutResult RenderMailbox::Put(RenderJob&& job) {
  const std::lock_guard lock(mutex_);
  if (closed_) return PutResult::kFull;
  const auto waiting = std::find_if(jobs_.begin(), jobs_.end(), [&](const RenderJob& other) {
    return other.subject == job.subject && other.spec == job.spec;
  });
  if (waiting != jobs_.end()) {
    MergeTickets(waiting->tickets, &job.tickets);
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
  RenderJob job = std::move(jobs_.front());
  jobs_.pop_front();
  return job;
}

void RenderMailbox::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  jobs_.clear();
  changed_.notify_all();
}

bool RenderMailbox::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace furrow::server
