// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_streams.h"

#include <algorithm>

#include "render/request/frame_request.h"

namespace furrow::server {

PictureStreams::Place PictureStreams::Find(const RenderJob& job) {
  if (job.tickets.empty()) return {kPreparation, render::kMinScale};
  const std::uint64_t viewer =
      std::ranges::min_element(job.tickets, {}, &PictureTicket::subscription)->subscription;
  if (!streams_.contains(viewer) && streams_.size() >= kMaxStreams) ForgetOldest();
  Stream& stream = streams_[viewer];
  if (stream.number == 0 || stream.subject != job.subject) {
    stream = {.number = ++last_number_, .subject = job.subject};
  }
  stream.used = ++num_jobs_;
  return {stream.number, stream.scale.scale()};
}

void PictureStreams::OnDrawn(std::uint64_t stream, Time busy, Time now) {
  for (auto& [viewer, each] : streams_) {
    if (each.number != stream) continue;
    if (each.has_drawn) each.scale.Observe(busy - each.busy, now - each.drawn);
    each.has_drawn = true;
    each.busy = busy;
    each.drawn = now;
  }
}

void PictureStreams::ForgetOldest() {
  streams_.erase(
      std::ranges::min_element(streams_, {}, [](const auto& item) { return item.second.used; }));
}

}  // namespace furrow::server
