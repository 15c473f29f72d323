// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/status.h"
#include "client/cpp/subscriber.h"
#include "client/load/run/senders.h"
#include "client/net/socket.h"

namespace furrow::load {

// The measured subscribers. Each watcher subscribes to every subject, over several sockets because
// the server limits the subscriptions per peer.
class Watchers {
 public:
  // Weights of one subject that arrived for one watcher. `readable`: they have the expected names.
  // `aged`: they belong to no new pose; the daemon holds or decays weights without one.
  struct Arrival {
    int watcher = 0;
    std::uint32_t subject = 0;
    std::uint32_t sequence = 0;
    std::int64_t arrived_ns = 0;  // as net::Socket::arrived_ns()
    std::span<const float> values;
    bool readable = false;
    bool aged = false;
  };

  // Opens the sockets of `watchers` watchers, each for all of `subjects` subjects. `first`: the
  // number in the name of the first one. `names`: the expected weight names. Errors: those of
  // `open`.
  [[nodiscard]] static Result<Watchers> Open(const SocketOpener& open, int watchers,
                                             std::uint32_t first, int subjects,
                                             std::span<const std::string> names);

  // Subscribes to all subjects and waits for the answers; `keep_going` cancels the wait by
  // returning false. Errors: kUnavailable (no answer), kInvalidArgument (rejected, with the
  // reason).
  [[nodiscard]] Status Subscribe(const std::function<bool()>& keep_going);

  // Reads the messages of socket `i` and calls `use` for each weights message. It also renews
  // leases, so call it at least once per second.
  [[nodiscard]] client::IoStatus Read(std::size_t i,
                                      const std::function<void(const Arrival&)>& use);

  [[nodiscard]] std::size_t num_sockets() const { return links_.size(); }
  [[nodiscard]] net::Socket& socket(std::size_t i) { return *links_[i].socket; }
  // True if the daemon's weight names equal the expected names.
  [[nodiscard]] bool names_match() const { return names_match_; }
  // Number of messages that could not be decoded.
  [[nodiscard]] std::uint64_t malformed() const;
  // The last error reported by the daemon; empty if there is none.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  struct Link {
    int watcher = 0;
    std::vector<std::uint32_t> subjects;
    net::Socket* socket = nullptr;  // owned by `subscriber`
    std::unique_ptr<client::Subscriber> subscriber;
    std::unordered_map<std::uint32_t, std::uint32_t> asked;          // request -> subject
    std::unordered_map<std::uint16_t, std::uint32_t> subscriptions;  // -> subject
  };

  [[nodiscard]] Status WaitForReplies(Link& link, const std::function<bool()>& keep_going);
  void OnReply(Link& link, const protocol::Header& header);
  void OnWeights(Link& link, const protocol::Header& header,
                 const std::function<void(const Arrival&)>& use);

  std::uint32_t first_ = 0;  // the number in the name of subject 0
  std::uint64_t names_hash_ = 0;
  bool names_match_ = true;
  std::string complaint_;
  std::vector<Link> links_;
};

}  // namespace furrow::load
