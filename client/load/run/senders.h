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
#include "client/load/schedule/plan.h"
#include "client/load/schedule/workload.h"
#include "client/net/socket.h"

namespace furrow::load {

// Opens the i-th socket of a set; i counts from 0.
using SocketOpener = std::function<Result<std::unique_ptr<net::Socket>>(int i)>;

// The name of a subject: "load-000017".
[[nodiscard]] std::string SubjectName(std::uint32_t number);

// Publishes the subjects of a plan, spread over several sockets because the server limits the
// message rate per peer.
class Senders {
 public:
  // Opens `sockets` sockets. `workload` must outlive this object. Errors: those of `open`.
  [[nodiscard]] static Result<Senders> Open(const SocketOpener& open, int sockets,
                                            const Workload& workload);

  // Offers the subjects [0, count) and waits until all are accepted or `keep_going` returns false.
  // An echo server does not answer offers and needs none. Errors: kUnavailable (no answer),
  // kInvalidArgument (rejected, with the reason).
  // `first`: the number in the name of the first one.
  [[nodiscard]] Status Offer(std::uint32_t first, int count,
                             const std::function<bool()>& keep_going);

  // From now on, datagrams repeat the previous pose where both fit. `plan`: of the poses.
  void RepeatPrevious(const Plan& plan);

  // Sends frame `frame` of the recording as pose number `pose` of a subject. kTimeout: the send
  // buffer is full and the pose was not sent.
  [[nodiscard]] client::IoStatus Send(std::uint32_t subject, std::uint32_t pose, int frame,
                                      std::int64_t capture_time_us);

  // Reads the messages of socket `i`, which are answers to offers.
  [[nodiscard]] client::IoStatus Read(std::size_t i);

  // Sends a goodbye for every subject.
  void Close();

  [[nodiscard]] std::size_t num_sockets() const { return senders_.size(); }
  // Socket `i`, in [0, num_sockets()); owned by this object.
  [[nodiscard]] net::Socket& socket(std::size_t i) { return *senders_[i].socket; }
  // The subject of stream `stream` of socket `i`.
  [[nodiscard]] std::uint32_t subject(std::size_t i, std::uint16_t stream) const {
    return static_cast<std::uint32_t>(stream * senders_.size() + i);
  }

 private:
  struct Sender {
    net::Socket* socket = nullptr;  // owned by `publisher`
    std::unique_ptr<client::Publisher> publisher;
  };

  explicit Senders(const Workload& workload) : workload_(&workload), messages_(workload.messages) {}

  const Workload* workload_;
  std::vector<std::vector<std::uint8_t>> messages_;  // Send() rewrites the envelopes
  // The same with the previous pose, for all poses of a subject but the first; empty: not wanted.
  std::vector<std::vector<std::uint8_t>> repeating_;
  std::vector<Sender> senders_;
};

}  // namespace furrow::load
