// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_streams.h"

#include <algorithm>

#include "render/request/frame_request.h"

namespace furrow::server {

PictureStreams::Place PictureStreams::Find(const RenderJob& job) {
  if (job.tickets.empty()) return {job.stream, job.stream == 0 ? 1.0f : render::kMinScale};
  Stream* stream = nullptr;
  for (const PictureTicket& ticket : job.tickets) {
    if (!ticket.acknowledges) return {};
    const auto found = streams_.find(ticket.subscription);
    if (found == streams_.end() || found->second.subject != job.subject) continue;
    if (stream == nullptr || found->second.used > stream->used) stream = &found->second;
  }
  if (stream == nullptr) stream = &Begin(job);
  stream->used = ++num_jobs_;
  return {stream->number, stream->scale.scale()};
}

PictureStreams::Stream& PictureStreams::Begin(const RenderJob& job) {
  const std::uint64_t viewer =
      std::ranges::min_element(job.tickets, {}, &PictureTicket::subscription)->subscription;
  if (!streams_.contains(viewer) && streams_.size() >= kMaxStreams) ForgetOldest();
  Stream& stream = streams_[viewer];
  stream = {.number = ++last_number_, .subject = job.subject};
  return stream;
}

void PictureStreams::OnDrawn(std::uint64_t stream, Time busy, Time now) {
  const Time own = busy - busy_;
  busy_ = busy;
  ++num_drawn_;
  const auto found = std::ranges::find_if(
      streams_, [stream](const auto& item) { return item.second.number == stream; });
  if (found == streams_.end()) {
    other_drawn_ = num_drawn_;
    return;
  }
  Stream& drawn = found->second;
  if (drawn.drawn != 0) {
    const auto others = std::ranges::count_if(
        streams_, [&](const auto& item) { return item.second.drawn > drawn.drawn; });
    const int more = other_drawn_ > drawn.drawn ? 1 : 0;
    drawn.scale.Observe({.own = own,
                         .busy = busy - drawn.busy,
                         .passed = now - drawn.drawn_at,
                         .num_streams = 1 + static_cast<int>(others) + more});
  }
  drawn.drawn = num_drawn_;
  drawn.busy = busy;
  drawn.drawn_at = now;
}

void PictureStreams::ForgetOldest() {
  streams_.erase(
      std::ranges::min_element(streams_, {}, [](const auto& item) { return item.second.used; }));
}

}  // namespace furrow::server
