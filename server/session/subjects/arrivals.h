// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/codec/codec.h"
#include "server/core/time.h"
#include "server/session/peers/peer.h"

namespace furrow::server {

// States of subjects that other nodes have handed over, until their publishers offer them here, and
// publishers that wait for the place of their subject. All functions require the hub's exclusive
// lock. Bounded in bytes; what does not fit is refused.
class Arrivals {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{16} * 1024 * 1024;
  static constexpr std::size_t kMaxWaiting = 4096;
  // A publisher that lost its way needs time to find this node.
  static constexpr Time kPatience = std::chrono::seconds(10);

  // For this long after the newest state of a subject, only its publisher may offer it here.
  static constexpr Time kReserved = std::chrono::seconds(1);

  // Keeps a state that Decode() has read from `view`, instead of the one that is kept of the
  // subject, if any. A late copy changes nothing: a state with a lower sequence in the same
  // session, or in another session one of the same publisher with an earlier newest pose. False:
  // there is too little room, or the state is larger than a message over UDP.
  [[nodiscard]] bool Add(const protocol::SubjectState& state, const protocol::MessageView& view,
                         Time now);
  // True if the subject is on its way here with a publisher of another session, which had no time
  // to follow it yet.
  [[nodiscard]] bool IsReserved(std::string_view subject, std::uint64_t session, Time now) const;
  // Forgets the state of the subject.
  void Drop(std::string_view subject);
  struct Arrived {
    protocol::Header header;
    protocol::SubjectState state;
  };
  // The state of the subject, which is then forgotten; nothing if there is none.
  [[nodiscard]] std::optional<Arrived> Take(std::string_view subject, Time now);

  // The publisher has offered a subject that has no place here yet.
  void Await(const std::string& subject, PeerId peer, const protocol::Header& offer,
             std::uint64_t skeleton_hash, Time now);
  struct Waiting {
    PeerId peer = 0;
    protocol::Header offer;
    std::uint64_t skeleton_hash = 0;
    Time until{0};
  };
  [[nodiscard]] const std::map<std::string, Waiting, std::less<>>& waiting() const {
    return waiting_;
  }
  void StopWaiting(std::string_view subject);

  // Forgets what nobody has come for.
  void Expire(Time now);
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Kept {
    protocol::Header header;
    std::vector<std::uint8_t> payload;
    std::uint64_t publisher_session = 0;
    std::uint32_t newest_sequence = 0;
    Time reserved_until{0};
    Time until{0};
  };
  using States = std::map<std::string, Kept, std::less<>>;
  [[nodiscard]] static bool IsOlder(const protocol::SubjectState& state,
                                    const protocol::Header& header, const Kept& kept);
  [[nodiscard]] static std::size_t BytesOf(const States::value_type& kept);
  States::iterator Forget(States::iterator kept);

  States states_;
  std::size_t bytes_ = 0;
  std::map<std::string, Waiting, std::less<>> waiting_;
};

}  // namespace furrow::server
