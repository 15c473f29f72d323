// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/chaos/link.h"
#include "client/chaos/tcp_relay.h"

namespace furrow::chaos {

// The requested and the injected faults of one direction.
struct Outcome {
  Faults options;
  FaultCounts counts;
  RelayCounts stream_counts;  // of TCP
};

// Returns "up: 1000 datagrams, lost 3 (2 with readable poses or weights), ...", with a count for
// each requested fault. Readable are whole messages that are not encrypted. `direction`: the word
// before the colon. If there were TCP connections, a second line follows: "up over TCP: 2
// connections, 5000 bytes, ...".
[[nodiscard]] std::string ToText(const std::string& direction, const Outcome& outcome);

// Returns a line that lists the requested faults that were injected in neither direction; empty if
// there are none. Jitter applies to every packet and is never listed.
[[nodiscard]] std::string NothingInjected(const Outcome& up, const Outcome& down);

// The requested faults that apply to datagrams only, as command-line options: "--loss, --swap".
[[nodiscard]] std::string DatagramFaults(const Faults& options);

// Returns the requested faults as a JSON object.
[[nodiscard]] nlohmann::json ToJson(const Faults& options);
// Returns the counts, without the requested faults, as a JSON object.
[[nodiscard]] nlohmann::json ToJson(const Outcome& outcome);

}  // namespace furrow::chaos
