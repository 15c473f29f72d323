// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/cpp/transport.h"
#include "protocol/codec/codec.h"

namespace furrow::client {

// Introduces this program to the daemon. Over UDP that proves the address (STANDARD.md section 4):
// a first Hello asks for a token, and a second one returns it. Over TCP one Hello names the
// program, and nothing is to be proven.
//
// Also answers the daemon's challenges, which ask whether the address still wants what is sent.
class Introduction {
 public:
  // `transport`: not null; outlives this object. `program`: for the daemon's log, at most
  // kMaxProgramBytes. `session`: of all messages of this program on this transport.
  Introduction(Transport* transport, std::string program, std::uint64_t session);

  // True if the daemon may be sent anything but a Hello.
  [[nodiscard]] bool proven() const { return proven_; }

  // Sends the Hello that is due: call it at first, and again every 200 ms until proven().
  void SendHello();
  // Starts again, because the daemon has forgotten the address or the connection is another one.
  void Restart();

  // Handles a Welcome, and sends the second Hello if one is needed. True: the address is proven now
  // and was not before.
  bool OnWelcome(const protocol::Welcome& welcome);
  // Answers a challenge.
  void OnPing(const protocol::Ping& ping);

 private:
  Transport* const transport_;
  const std::string program_;
  const std::uint64_t session_;
  bool proven_;
  std::uint64_t token_ = 0;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> bytes_;
};

// True if the error names the server that has the subject.
[[nodiscard]] bool SendsElsewhere(const protocol::ErrorMessage& error);

// Lets the transport know the servers of a Welcome, once the daemon is proven.
void RememberOthers(const protocol::Welcome& welcome, const Introduction& introduction,
                    Transport& transport);

}  // namespace furrow::client
