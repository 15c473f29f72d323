// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/cpp/publisher.h"
#include "client/load/net/socket.h"
#include "client/load/schedule/performance.h"
#include "client/load/schedule/plan.h"

namespace furrow::load {

// Opens the i-th socket of a kind; its errors are the caller's to print.
using OpenSocket = std::function<Result<std::unique_ptr<Socket>>(int i)>;

// "load-000017": how subjects are called.
[[nodiscard]] std::string SubjectName(std::uint32_t subject);

// The subjects of a plan, spread over as many sockets as a server's limit for one peer asks for.
class Senders {
 public:
  // Opens `sockets` sockets. kUnavailable where that fails.
  [[nodiscard]] static Result<Senders> Open(const OpenSocket& open, int sockets,
                                            const Performance& performance);

  // Offers subjects 0 to `count` and waits until all are accepted; not needed where nobody answers
  // offers (an echo). `go_on` false ends the waiting. Errors: kUnavailable (nobody answers),
  // kInvalidArgument (refused, and why).
  [[nodiscard]] Status Offer(int count, const std::function<bool()>& go_on);

  // Sends one pose. kTimeout: the system has no room.
  [[nodiscard]] client::IoStatus Send(std::uint32_t subject, std::uint32_t pose, int frame,
                                      std::int64_t capture_time_us);

  // Reads what came for socket `i`: answers to offers.
  [[nodiscard]] client::IoStatus Read(std::size_t i);

  // Says goodbye for every subject.
  void Close();

  [[nodiscard]] std::size_t num_sockets() const { return senders_.size(); }
  [[nodiscard]] Socket& socket(std::size_t i) { return *senders_[i].socket; }
  // Which subject stream `stream` of socket `i` is.
  [[nodiscard]] std::uint32_t subject(std::size_t i, std::uint16_t stream) const {
    return static_cast<std::uint32_t>(stream * senders_.size() + i);
  }

 private:
  struct Sender {
    Socket* socket = nullptr;  // the publisher's
    std::unique_ptr<client::Publisher> publisher;
  };

  explicit Senders(const Performance& performance)
      : performance_(&performance), messages_(performance.messages) {}

  const Performance* performance_;
  std::vector<std::vector<std::uint8_t>> messages_;  // their envelopes are written over
  std::vector<Sender> senders_;
};

}  // namespace furrow::load
