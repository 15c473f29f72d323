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
#include "client/load/net/socket.h"
#include "client/load/schedule/senders.h"

namespace furrow::load {

// Subscribers that are measured: each watches every subject, on as many sockets as a server's limit
// of subscriptions for one peer asks for.
class Watchers {
 public:
  // What came: weights of a subject for a watcher. `readable`: their names are `names`.
  struct Arrival {
    int watcher = 0;
    std::uint32_t subject = 0;
    std::uint32_t sequence = 0;
    std::int64_t arrived_ns = 0;  // as Socket::arrived_ns()
    std::span<const float> values;
    bool readable = false;
  };

  // Opens the sockets; kUnavailable where that fails. `names`: of the weights that can be checked.
  [[nodiscard]] static Result<Watchers> Open(const OpenSocket& open, int watchers, int subjects,
                                             std::span<const std::string> names);

  // Subscribes to everything and waits for the answers. Errors: kUnavailable (nobody answers),
  // kInvalidArgument (refused, and why).
  [[nodiscard]] Status Subscribe(const std::function<bool()>& go_on);

  // Reads what came for socket `i`, and calls `use` for each weights message. Leases are kept by it
  // too: call it about once a second also where nothing comes.
  [[nodiscard]] client::IoStatus Read(std::size_t i,
                                      const std::function<void(const Arrival&)>& use);

  [[nodiscard]] std::size_t num_sockets() const { return links_.size(); }
  [[nodiscard]] Socket& socket(std::size_t i) { return *links_[i].socket; }
  // Of the names that the daemon sends: whether they are those that can be checked.
  [[nodiscard]] bool names_match() const { return names_match_; }
  [[nodiscard]] std::uint64_t malformed() const;
  // What the daemon complained about last; empty: nothing.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  struct Link {
    int watcher = 0;
    std::vector<std::uint32_t> subjects;
    Socket* socket = nullptr;  // the subscriber's
    std::unique_ptr<client::Subscriber> subscriber;
    std::unordered_map<std::uint32_t, std::uint32_t> asked;          // request -> subject
    std::unordered_map<std::uint16_t, std::uint32_t> subscriptions;  // -> subject
  };

  [[nodiscard]] Status WaitForReplies(Link& link, const std::function<bool()>& go_on);
  void OnReply(Link& link, const protocol::Header& header);
  void OnWeights(Link& link, const protocol::Header& header,
                 const std::function<void(const Arrival&)>& use);

  std::uint64_t names_hash_ = 0;
  bool names_match_ = true;
  std::string complaint_;
  std::vector<Link> links_;
};

}  // namespace furrow::load
