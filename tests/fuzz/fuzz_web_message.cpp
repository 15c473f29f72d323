// SPDX-License-Identifier: Apache-2.0
// WebSocket messages from a viewer to the hub. The input is a sequence of messages (u16 length,
// then bytes). The hub must survive every message that passes the checks.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "server/http/socket/web_message.h"
#include "server/session/hub.h"
#include "tests/fuzz/fuzz_link.h"

namespace furrow::server {
namespace {

class Pictures : public PictureSource {
 public:
  void Submit(RenderJob job) override { last = std::move(job); }
  bool WithdrawStill(std::uint64_t) override { return true; }
  void Withdraw(std::uint64_t) override {}
  bool OpenVideo(std::uint64_t, const std::string&, const render::VideoFormat&) override {
    return true;
  }
  Result<render::Camera> Preset(std::string_view) const override { return render::Camera(); }
  RenderJob last;
};

void Feed(std::span<const std::uint8_t> bytes) {
  Metrics metrics;
  Pictures pictures;
  fuzz::QuietLink link;
  Hub::Parts parts;
  parts.rig = std::make_shared<const wrinkle::Rig>();
  parts.pictures = &pictures;
  parts.metrics = &metrics;
  parts.random = [] { return 1; };
  Hub hub(std::move(parts));
  Time now = FromSeconds(1);
  const PeerId peer = hub.AddPeer(Transport::kWeb, "fuzz", &link, now);
  while (bytes.size() >= 2) {
    const std::size_t size =
        std::min<std::size_t>(bytes.size() - 2, bytes[0] | std::size_t{bytes[1]} << 8);
    const auto message = bytes.subspan(2, size);
    bytes = bytes.subspan(2 + size);
    if (IsWebMessage(message)) hub.OnMessage(peer, message, now);
    now += FromSeconds(0.02);
    hub.Tick(now);
    // As video where the viewer gets one, and each third one as a key picture.
    const auto& tickets = pictures.last.tickets;
    const bool is_video = !tickets.empty() && tickets.front().video.has_value();
    hub.OnPicture({.bytes = {1},
                   .codec = is_video ? "avc1.42c01e" : "",
                   .key = is_video && size % 3 == 0,
                   .tickets = tickets},
                  now);
    pictures.last = {};
  }
}

}  // namespace
}  // namespace furrow::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  furrow::server::Feed({data, size});
  return 0;
}
