// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/messages/messages.h"

// Messages by which subjects move between the servers of a cluster (STANDARD.md section 10).
namespace furrow::protocol {

// Server to server: everything that the receiver needs to go on with a subject as if nothing had
// happened. header.capture_time_us is that of the newest pose. The receiver answers with a
// SkeletonReply: kAccepted, or kRejected with the reason.
struct SubjectState {
  std::string subject;
  std::uint64_t skeleton_hash = 0;
  // The publisher's session number. It proves who the publisher is, so it is shown only to servers
  // that have proved who they are.
  std::uint64_t publisher_session = 0;
  std::uint64_t run = 0;              // SubscribeReply::publisher_session
  bool has_pose = false;              // the next two are of the newest pose
  std::uint32_t newest_sequence = 0;  // 0 without a pose
  PoseFrame pose;                     // whole: later poses may be partial
  bool has_neutral = false;
  PoseFrame neutral;  // whole; the pose from which weights are measured
  // The filter. `values_hash`: NamesHash() of the driver values, in their order. The lists are
  // empty before the first pose, else each has one number per driver value.
  std::uint64_t values_hash = 0;
  std::uint32_t num_drivers = 0;  // evaluated ones, from the rig's first; all: kAllDriversOnWire
  std::vector<float> filtered;    // [0, 1]
  std::vector<float> inputs;      // before the filter, [0, 1]
  std::vector<float> speeds;      // 1/s
  double since_input_s = 0.0;     // seconds, at least 0; above 0 while the weights decay
  std::string captures;           // a rig file with the reference poses captured from the subject
};
inline constexpr std::uint32_t kAllDriversOnWire = 0xFFFFFFFF;

// Client to server, for holders of the role operate: give all subjects to other servers, then end.
// The server answers with DrainState.
struct Drain {
  bool begin = false;  // false: only say how far it has got
};

// The answer to Drain. header.sequence is that of the request.
struct DrainState {
  bool draining = false;
  std::uint32_t moved = 0;         // subjects that other servers have taken
  std::uint32_t left = 0;          // subjects that are still here
  std::vector<std::string> names;  // of the latter; at most kMaxLeftNames
  std::string why;                 // one of them could not be moved last; may be empty
};

}  // namespace furrow::protocol
