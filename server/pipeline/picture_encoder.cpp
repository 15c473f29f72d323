// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_encoder.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/status.h"
#include "server/core/within_memory.h"

namespace furrow::server {
namespace {

// The picture of a job without what an encoding adds.
FinishedPicture FinishedOf(const render::Image& image, const RenderJob& job, Time encoded,
                           std::vector<PictureTicket> tickets) {
  return {.subject = job.subject,
          .sequence = job.snapshot->sequence,
          .capture_time_us = job.snapshot->capture_time_us,
          .age_us = job.snapshot->age_us,
          .received_us = job.snapshot->received_us,
          .submitted = job.submitted,
          .taken = job.taken,
          .drawn = job.drawn,
          .encoded = encoded,
          .width = image.width,
          .height = image.height,
          .drawn_percent = image.drawn_percent,
          .encoding = {},
          .bytes = {},
          .codec = {},
          .key = false,
          .tickets = std::move(tickets)};
}

}  // namespace

// Viewers with equal encodings share the bytes.
void PictureEncoder::Encode(const render::Image& image, RenderJob job) {
  EncodeVideos(image, &job);
  std::vector<std::pair<Encoding, std::vector<PictureTicket>>> groups;
  for (const PictureTicket& ticket : job.tickets) {
    const Encoding wanted = EncodingOf(ticket);
    auto group = groups.end();
    for (auto it = groups.begin(); it != groups.end(); ++it) {
      if (it->first.format != wanted.format) continue;
      const auto distance = [&wanted](const auto& to) {
        return std::abs(to->first.quality - wanted.quality);
      };
      if (group == groups.end() || distance(it) < distance(group)) group = it;
    }
    const bool is_new =
        group == groups.end() || (group->first != wanted && groups.size() < kMaxEncodings);
    if (is_new) group = groups.insert(groups.end(), {wanted, {}});
    group->second.push_back(ticket);
  }
  for (auto& [encoding, tickets] : groups) EncodeFile(image, job, encoding, std::move(tickets));
}

// Delivers the picture to the viewers with video. The others stay in `job`.
void PictureEncoder::EncodeVideos(const render::Image& image, RenderJob* job) {
  const auto wants_video = [](const PictureTicket& ticket) {
    return ticket.video && !ticket.still;
  };
  if (video_ == nullptr || std::ranges::none_of(job->tickets, wants_video)) return;
  // Once for all of them.
  const Status status =
      OrOutOfMemory(metrics_, "renderer", [&] { return render::ToPlanes(image, &planes_); });
  if (!status.ok()) return;
  std::erase_if(job->tickets, [&](const PictureTicket& ticket) {
    return wants_video(ticket) && EncodeVideo(image, *job, ticket);
  });
}

// False: the viewer gets a file.
bool PictureEncoder::EncodeVideo(const render::Image& image, const RenderJob& job,
                                 const PictureTicket& ticket) {
  const Time begun = clock_();
  auto picture = OrOutOfMemory(metrics_, "renderer", [&] {
    return video_->Encode(ticket.subscription, planes_, *ticket.video);
  });
  const Time encoded = clock_();
  metrics_->Observe(Timing::kPictureEncode, encoded - begun);
  if (!picture.ok()) {
    if (picture.status().code() != StatusCode::kNotFound) {
      spdlog::warn("a viewer gets JPEG instead of H.264: {}", picture.status().ToString());
    }
    return false;
  }
  metrics_->Add(Counter::kPicturesEncoded);
  metrics_->Add(Counter::kVideoPictures);
  if (picture->key) metrics_->Add(Counter::kVideoKeyPictures);
  picture->bytes.shrink_to_fit();  // they may wait in queues
  // No decoder could follow a video whose picture was lost without a gap in the numbers.
  const bool delivered = WithinMemory(metrics_, [&] {
    FinishedPicture finished = FinishedOf(image, job, encoded, {ticket});
    finished.bytes = std::move(picture->bytes);
    finished.codec = std::move(picture->codec);
    finished.key = picture->key;
    (*deliver_)(std::move(finished));
  });
  if (!delivered) video_->Restart(ticket.subscription);
  return true;
}

void PictureEncoder::EncodeFile(const render::Image& image, const RenderJob& job,
                                const Encoding& encoding, std::vector<PictureTicket> tickets) {
  const Time begun = clock_();
  auto bytes = OrOutOfMemory(metrics_, "renderer", [&] {
    return render::EncodeImage(image, encoding.format, encoding.quality);
  });
  const Time encoded = clock_();
  metrics_->Observe(Timing::kPictureEncode, encoded - begun);
  metrics_->Add(bytes.ok() ? Counter::kPicturesEncoded : Counter::kPicturesFailed);
  if (!bytes.ok()) {
    spdlog::warn("cannot encode a picture: {}", bytes.status().ToString());
    // Without bytes the picture reports a failure to its viewers.
    bytes = std::vector<std::uint8_t>();
  }
  bytes->shrink_to_fit();  // they may wait in queues
  FinishedPicture finished = FinishedOf(image, job, encoded, std::move(tickets));
  finished.encoding = encoding;
  finished.bytes = *std::move(bytes);
  WithinMemory(metrics_, [&] { (*deliver_)(std::move(finished)); });
}

}  // namespace furrow::server
