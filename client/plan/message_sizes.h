// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/plan/demand.h"

namespace furrow::plan {

// What one message needs on an Ethernet link: the datagrams that it is cut into, with the headers
// of the wire, UDP, IPv4 and Ethernet.
struct MessageSize {
  int datagrams = 0;
  double bytes = 0.0;
};

// A whole pose of the demand, and the weights of it to one subscriber, as the encoder writes them.
// Each message goes alone; daemons bundle the weights of several subjects where they can. Every
// joint has a rotation, and the first one an offset, too.
[[nodiscard]] MessageSize PoseSize(const Demand& demand);
[[nodiscard]] MessageSize WeightsSize(const Demand& demand);

}  // namespace furrow::plan
