// SPDX-License-Identifier: Apache-2.0
#include "server/session/trace/pose_tracer.h"

#include <utility>

#include "protocol/framing/sequence.h"

namespace furrow::server {

void PoseTracer::Request(std::uint64_t subject, std::string name) {
  trace_ = {.subject = std::move(name)};
  subject_ = subject;
  state_ = State::kWaiting;
  wanted_.store(subject, std::memory_order_relaxed);
}

void PoseTracer::OnAccepted(const PoseTrace& trace) {
  wanted_.store(0, std::memory_order_relaxed);
  std::string name = std::move(trace_.subject);
  trace_ = trace;
  trace_.subject = std::move(name);
  trace_.accepted = clock_();
}

void PoseTracer::OnSolving(std::size_t batch) {
  trace_.batch = batch;
  trace_.solving = clock_();
}

void PoseTracer::OnRefused() { Request(subject_, std::move(trace_.subject)); }

void PoseTracer::OnSent() {
  if (trace_.published == Time{0}) return;  // another trace was requested meanwhile
  trace_.sent = clock_();
  state_ = State::kDone;
}

void PoseTracer::OnPicture(const FinishedPicture& picture) {
  if (state_ != State::kDone || trace_.picture || picture.subject != subject_) return;
  const bool shows_it =
      picture.sequence == trace_.sequence || protocol::IsNewer(picture.sequence, trace_.sequence);
  if (!shows_it || picture.submitted < trace_.received || picture.bytes.empty()) return;
  trace_.picture = {.sequence = picture.sequence,
                    .submitted = picture.submitted,
                    .taken = picture.taken,
                    .drawn = picture.drawn,
                    .encoded = picture.encoded,
                    .sent = clock_(),
                    .width = picture.width,
                    .height = picture.height,
                    .bytes = picture.bytes.size(),
                    .viewers = picture.tickets.size(),
                    .is_video = !picture.codec.empty()};
}

}  // namespace furrow::server
