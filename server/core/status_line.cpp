// SPDX-License-Identifier: Apache-2.0
#include "server/core/status_line.h"

#include <cmath>
#include <string_view>
#include <utility>

namespace furrow::server {
namespace {

// Shown in each line, per second.
constexpr std::pair<Counter, std::string_view> kRates[] = {
    {Counter::kPosesReceived, "poses"},
    {Counter::kWeightsSent, "weights"},
    {Counter::kPicturesSent, "pictures"},
};

// Shown only if they have changed since the last line.
constexpr std::pair<Counter, std::string_view> kDrops[] = {
    {Counter::kDatagramsOverrun, "datagrams lost in the full socket buffer"},
    {Counter::kDatagramsMalformed, "malformed datagrams"},
    {Counter::kDatagramsUnsendable, "unsendable datagrams"},
    {Counter::kDatagramsUnproven, "datagrams from unproven addresses"},
    {Counter::kFragmentsMalformed, "malformed fragments"},
    {Counter::kFragmentsRefused, "fragments over the limits"},
    {Counter::kFragmentsExpired, "incomplete fragmented messages"},
    {Counter::kAcceptsFailed, "failed attempts to accept connections"},
    {Counter::kConnectionsRefused, "connections over the limit"},
    {Counter::kConnectionsMalformed, "malformed connections"},
    {Counter::kConnectionsOverrun, "connections that did not read"},
    {Counter::kWaitingRefused, "for hosts without room for what waits"},
    {Counter::kConnectionsIdle, "idle connections"},
    {Counter::kConnectionsGaveWay, "connections that gave way"},
    {Counter::kMessagesMalformed, "malformed messages"},
    {Counter::kMessagesThrottled, "throttled messages"},
    {Counter::kRequestsThrottled, "throttled requests"},
    {Counter::kMessagesRefused, "refused messages"},
    {Counter::kRepliesWithoutConsent, "replies without consent"},
    {Counter::kSkeletonsRejected, "rejected skeletons"},
    {Counter::kSkeletonsThrottled, "skeletons offered too fast"},
    {Counter::kSubjectsContested, "offers of subjects that others send"},
    {Counter::kAllocationsFailed, "failed allocations"},
    {Counter::kPosesInvalid, "invalid poses"},
    {Counter::kPosesLate, "late poses"},
    {Counter::kPosesDuplicate, "repeated poses"},
    {Counter::kPosesUnknownStream, "poses without a skeleton"},
    {Counter::kWeightsDroppedSlow, "weights to slow subscribers"},
    {Counter::kPicturesDroppedSlow, "pictures to slow subscribers"},
    {Counter::kPicturesFailed, "failed pictures"},
    {Counter::kPicturesCrowded, "pictures over the share of their host"},
    {Counter::kMocapMalformed, "malformed mocap packets"},
    {Counter::kMocapReordered, "late mocap frames"},
    {Counter::kMocapStale, "mocap frames without tracking"},
    {Counter::kMocapLockedOut, "mocap packets from rejected senders"},
    {Counter::kMocapRefused, "frames of refused mocap subjects"},
    {Counter::kHttpRefused, "refused web requests"},
    {Counter::kHttpThrottled, "API requests over the share of their host"},
    {Counter::kHttpSlowed, "slowed web requests"},
    {Counter::kOscPacketsUnsendable, "unsendable OSC packets"},
};

// "1 subject", "2 subjects".
std::string Count(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

// The increase since the last call for this counter.
std::uint64_t StatusLine::CountSinceLastLine(Counter counter) {
  std::uint64_t& last = last_[static_cast<std::size_t>(counter)];
  const std::uint64_t value = metrics_->Get(counter);
  return value - std::exchange(last, value);
}

std::string StatusLine::Next(std::size_t subjects, std::size_t subscriptions, Time now) {
  // The first line has no interval; the daemon prints it after about a second.
  const double seconds = last_time_ == Time{0} ? 1.0 : ToSeconds(now - last_time_);
  last_time_ = now;
  std::string line = Count(subjects, "subject") + ", " + Count(subscriptions, "subscription");
  for (const auto& [counter, name] : kRates) {
    const double rate = static_cast<double>(CountSinceLastLine(counter)) / seconds;
    line += ", " + std::to_string(std::llround(rate)) + " " + std::string(name) + "/s";
  }
  std::string_view separator = "; dropped: ";
  for (const auto& [counter, name] : kDrops) {
    const std::uint64_t count = CountSinceLastLine(counter);
    if (count == 0) continue;
    line += std::string(separator) + std::to_string(count) + " " + std::string(name);
    separator = ", ";
  }
  return line;
}

}  // namespace furrow::server
