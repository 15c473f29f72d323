// SPDX-License-Identifier: Apache-2.0
#include "client/load/checker.h"

#include <algorithm>

#include "client/load/replay.h"

namespace furrow::load {
namespace {

// Rows beyond it are not settled but counted as unchecked: a server that is all wrong need not be
// proved so a million times.
constexpr std::size_t kMaxDisputedValues = std::size_t{8} << 20;

}  // namespace

Checker::Checker(const Plan& plan, const Expected* expected, const CheckOptions& options)
    : plan_(plan), expected_(expected), options_(options), windows_(kWindows) {
  const auto subjects = static_cast<std::size_t>(plan.num_subjects());
  sent_.resize(subjects);
  tracks_.resize(subjects * static_cast<std::size_t>(options.watchers));
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const std::uint32_t count = plan.count(static_cast<std::uint32_t>(i % subjects));
    tracks_[i].seen.resize(count);
    if (i < subjects) sent_[i].resize(count);
  }
}

void Checker::OnSent(std::uint32_t subject, std::uint32_t pose, bool left) {
  ++tally_.offered;
  if (!left) return;
  ++tally_.sent;
  tally_.expected += static_cast<std::uint64_t>(options_.watchers);
  sent_[subject][pose] = true;
}

void Checker::OnWeights(int watcher, std::uint32_t subject, std::uint32_t sequence,
                        std::span<const float> values, bool readable, std::int64_t now_us) {
  if (sequence >= sent_[subject].size() || !sent_[subject][sequence]) {
    ++tally_.never_sent;
    return;
  }
  Track& track = tracks_[static_cast<std::size_t>(watcher) * sent_.size() + subject];
  if (track.seen[sequence]) {
    ++tally_.duplicates;
    return;
  }
  track.seen[sequence] = true;
  ++tally_.received;
  if (sequence < track.newest) ++tally_.reordered;
  track.newest = std::max<std::int64_t>(track.newest, sequence);
  const std::int64_t due_us = plan_.DueUs(subject, sequence);
  const std::int64_t latency_us = now_us - due_us;
  if (latency_us > options_.late_us) ++tally_.late;
  latency_.Record(latency_us * 1000);
  const double share = static_cast<double>(due_us) * 1e-6 / options_.seconds;
  const auto window = static_cast<std::size_t>(share * static_cast<double>(kWindows));
  windows_[std::min(window, kWindows - 1)].Record(latency_us * 1000);
  if (readable && expected_ != nullptr) {
    Compare(track, subject, sequence, values);
  } else {
    ++tally_.unchecked;
  }
}

void Checker::Compare(Track& track, std::uint32_t subject, std::uint32_t pose,
                      std::span<const float> values) {
  const float difference = Distance(values, expected_->Row(plan_.phase_of(subject), pose));
  if (difference <= options_.tolerance) {
    ++tally_.checked;
    tally_.largest_difference = std::max(tally_.largest_difference, difference);
  } else if (dispute_values_.size() + values.size() > kMaxDisputedValues) {
    ++tally_.unchecked;
  } else {
    track.disputes.push_back({pose, dispute_values_.size()});
    dispute_values_.insert(dispute_values_.end(), values.begin(), values.end());
  }
}

// `difference`: from the nearest that the solver could have said.
void Checker::Judge(std::span<const float> values, float difference) {
  ++tally_.checked;
  if (difference <= options_.tolerance) {
    tally_.largest_difference = std::max(tally_.largest_difference, difference);
    return;
  }
  ++tally_.wrong;
  if (expected_->Find(values, options_.tolerance)) ++tally_.swapped;
}

void Checker::Settle(const Performance& performance) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    if (track.disputes.empty()) continue;
    std::ranges::sort(track.disputes, {}, &Dispute::pose);
    Replay replay(performance, plan_, static_cast<std::uint32_t>(i % sent_.size()), *expected_,
                  options_.tolerance);
    auto dispute = track.disputes.begin();
    for (std::uint32_t pose = 0; pose < track.seen.size(); ++pose) {
      if (!track.seen[pose]) {
        replay.Missing(pose);
      } else if (dispute == track.disputes.end()) {
        break;  // the rest was found equal
      } else if (dispute->pose != pose) {
        replay.Agreed(pose);
      } else {
        const std::span<const float> values =
            std::span(dispute_values_)
                .subspan(dispute->row, performance.binding->weight_names().size());
        const auto difference = replay.Disputed(pose, values);
        if (difference) {
          Judge(values, *difference);
        } else {
          ++tally_.unchecked;
        }
        ++dispute;
      }
    }
  }
}

}  // namespace furrow::load
