// SPDX-License-Identifier: Apache-2.0
#include "bench/preview/viewers.h"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "server/net/clock.h"

namespace furrow::bench {

Viewer::Viewer(std::uint16_t port, int width, int height, bool acknowledged, int quality)
    : client_(port) {
  (void)client_.Upgrade();
  client_.Send(protocol::SubscribePictures{.width = static_cast<std::uint16_t>(width),
                                           .height = static_cast<std::uint16_t>(height),
                                           .quality = static_cast<std::uint8_t>(quality),
                                           .acknowledged = acknowledged},
               0, 1);
  protocol::Header header;
  (void)client_.Await<protocol::SubscribeReply>(&header);
  stream_ = header.stream;
}

Received Viewer::Next() {
  std::optional<protocol::ImageFrame> image = client_.Await<protocol::ImageFrame>();
  if (!image) {
    std::fprintf(stderr, "bench_preview: a viewer lost its connection\n");
    std::exit(1);
  }
  const server::Time now = server::ReadClock();
  std::vector<std::uint8_t>().swap(image->bytes);
  return Received{*std::move(image), now};
}

void Viewer::Acknowledge(std::uint32_t number) {
  client_.Send(protocol::FrameAck{number}, stream_);
}

void Viewer::Watch(double seconds) {
  const server::Time end = server::ReadClock() + server::FromSeconds(seconds);
  while (server::ReadClock() < end) Acknowledge(Next().image.number);
}

double Viewer::RoundTrip() {
  const server::Time sent = server::ReadClock();
  client_.Send(protocol::Ping{1});
  (void)client_.Await<protocol::Pong>();
  return server::ToSeconds(server::ReadClock() - sent);
}

// Replies overtake waiting pictures. The ping is repeated until no picture precedes the reply.
std::vector<std::size_t> Viewer::DrainInFlight() {
  std::vector<std::size_t> pictures;
  for (int answers_in_a_row = 0; answers_in_a_row < 3;) {
    client_.Send(protocol::Ping{1});
    ++answers_in_a_row;
    while (const auto frame = client_.Next()) {
      protocol::MessageView view;
      if (protocol::OpenMessage(frame->payload, view, protocol::kMaxReplyBytes) !=
              protocol::DecodeStatus::kOk ||
          view.kind == protocol::MessageKind::kPong) {
        break;
      }
      if (view.kind != protocol::MessageKind::kImage) continue;
      pictures.push_back(frame->payload.size());
      answers_in_a_row = 0;
    }
  }
  return pictures;
}

}  // namespace furrow::bench
