// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/plan/costs.h"
#include "client/plan/demand.h"
#include "client/plan/message_sizes.h"

namespace furrow::plan {

// What the daemons need to serve a demand.
struct Capacity {
  MessageSize pose;
  MessageSize weights;        // to one subscriber
  double poses = 0.0;         // per second, of all performers
  double messages_out = 0.0;  // weights per second, to all subscribers
  double bits_in = 0.0;       // per second, on Ethernet
  double bits_out = 0.0;      // weights and pictures
  double pose_us = 0.0;       // processor time of a pose at that load, its weights included
  double busy_cores = 0.0;    // poses alone
  double cores = 0.0;         // whole cores at Machine::load; poses alone
  double bytes = 0.0;         // memory of a daemon with all performers, without pictures
  // Performers that one machine serves, by each of its parts. 0: not even one.
  double by_processor = 0.0;
  double by_network = 0.0;
  double machines = 0.0;  // without spares; 0: a machine does not serve even one performer
  // Pictures of all viewers, beside the machines above.
  double picture_cores = 0.0;  // without GPU: drawing and encoding
  double gpus = 0.0;           // of the kind that was measured; encoding needs encoding_cores
  double encoding_cores = 0.0;

  [[nodiscard]] double per_machine() const;
};

// Performers are spread evenly, and their poses do not come in bursts. The model does not know of
// latency: `furrow load` measures it.
[[nodiscard]] Capacity MakePlan(const Demand& demand, const Costs& costs, const Machine& machine);

}  // namespace furrow::plan
