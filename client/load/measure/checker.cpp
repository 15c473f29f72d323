// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/checker.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "client/load/measure/replay.h"

namespace furrow::load {
namespace {

// Limit of the values kept of mismatches, 512 MiB; later mismatches count as unchecked. It bounds
// memory and time if every message of a server is wrong.
constexpr std::size_t kMaxMismatchValues = std::size_t{128} << 20;
// Number of wrong messages that are searched for in the whole table.
constexpr std::uint64_t kMaxClassified = 10'000;
// A replay that starts late is exact if it agrees with the table within this difference.
constexpr float kExact = 1e-6f;

}  // namespace

// Allocates the flags of all poses in advance, so that the run itself seldom allocates.
Checker::Checker(const Plan& plan, const ExpectedWeights* expected, const CheckOptions& options)
    : plan_(plan), expected_(expected), options_(options), windows_(kWindows) {
  const auto subjects = static_cast<std::size_t>(plan.num_subjects());
  sent_.resize(subjects);
  tracks_.resize(subjects * static_cast<std::size_t>(options.watchers));
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    tracks_[i].subject = static_cast<std::uint32_t>(i % subjects);
    const std::uint32_t count = plan.count(tracks_[i].subject);
    tracks_[i].seen.resize(count);
    if (i < subjects) sent_[i].resize(count);
  }
}

void Checker::OnDue(std::uint32_t subject, std::uint32_t pose, bool sent) {
  ++tally_.offered;
  if (!sent) return;
  ++tally_.sent;
  tally_.expected += static_cast<std::uint64_t>(options_.watchers);
  // Remembered per pose: a message for a pose that was not sent is an error of the server.
  sent_[subject][pose] = true;
}

void Checker::OnWeights(int watcher, std::uint32_t subject, std::uint32_t sequence,
                        std::span<const float> values, bool readable, std::int64_t now_us) {
  // Both numbers come from the network.
  if (subject >= sent_.size() || sequence >= sent_[subject].size() || !sent_[subject][sequence]) {
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
  // Coordinated omission: a tester that waits for a stalled server sends less, and measured from
  // the send time the stall would hardly show. From the due time, every pose of the stall counts.
  const std::int64_t latency_us = now_us - due_us;
  if (latency_us > options_.late_us) ++tally_.late;
  if (latency_us < 0) ++tally_.early;
  latency_.Record(latency_us * 1000);
  // By due time, so that a message that arrives late belongs to the moment that delayed it.
  const double share = static_cast<double>(due_us) * 1e-6 / options_.seconds;
  const auto window = static_cast<std::size_t>(share * static_cast<double>(kWindows));
  windows_[std::min(window, kWindows - 1)].Record(latency_us * 1000);
  if (readable && expected_ != nullptr) {
    Compare(track, subject, sequence, values);
  } else {
    ++tally_.unchecked;
  }
}

void Checker::OnAged(int watcher, std::uint32_t subject, std::uint32_t sequence,
                     std::int64_t now_us) {
  if (subject >= sent_.size() || sequence >= sent_[subject].size()) return;
  // Every subject is silent after its last pose.
  const std::uint32_t last = plan_.count(subject) - 1;
  if (now_us >= plan_.DueUs(subject, last)) return;
  ++tally_.aged;
  Track& track = tracks_[static_cast<std::size_t>(watcher) * sent_.size() + subject];
  // A decay takes many messages.
  if (track.decayed.empty() || track.decayed.back() != sequence) track.decayed.push_back(sequence);
}

void Checker::Compare(Track& track, std::uint32_t subject, std::uint32_t pose,
                      std::span<const float> values) {
  const auto row = expected_->Row(plan_.phase_of(subject), pose);
  const float difference = Distance(values, row);
  // The names agreed, so another number of values is wrong in any case.
  if (values.size() != row.size()) {
    ++tally_.checked;
    ++tally_.wrong;
  } else if (difference <= options_.tolerance) {
    // The usual case: the server received every pose. One comparison decides.
    ++tally_.checked;
    tally_.largest_difference = std::max(tally_.largest_difference, difference);
  } else if (mismatch_values_.size() + values.size() > kMaxMismatchValues) {
    ++tally_.unchecked;
    ++tally_.unfollowed;
    track.unfollowed.push_back(pose);
  } else {
    track.mismatches.push_back({pose, mismatch_values_.size()});
    mismatch_values_.insert(mismatch_values_.end(), values.begin(), values.end());
  }
}

// `difference`: distance from the nearest weights that a correct server could have sent.
void Checker::Classify(std::span<const float> values, float difference) {
  ++tally_.checked;
  if (difference <= options_.tolerance) {
    tally_.largest_difference = std::max(tally_.largest_difference, difference);
    return;
  }
  ++tally_.wrong;
  if (tally_.wrong > kMaxClassified) {
    ++tally_.unclassified;
  } else if (expected_->Find(values, options_.tolerance)) {
    // The values are right for another pose or subject, so the contents were mixed up.
    ++tally_.swapped;
  }
}

// Replays one track up to each mismatch.
class Checker::MismatchResolver {
 public:
  MismatchResolver(const Checker& checker, const Workload& workload, const Track& track)
      : checker_(checker),
        workload_(workload),
        track_(track),
        phase_(checker.plan_.phase_of(track.subject)),
        replay_(Begin(0)) {
    for (const std::uint32_t pose : track.decayed) {
      const auto count = static_cast<std::uint32_t>(track.seen.size());
      std::uint32_t first = pose + 1;
      while (first < count && !track.seen[first]) ++first;
      if (first < count) resumed_us_.push_back(checker.plan_.CaptureUs(phase_, first));
    }
  }

  // Distance of the values of a mismatch from the possible weights, as Replay::Mismatched(). Call
  // it in the order of the poses.
  std::optional<float> Distance(const Mismatch& mismatch, std::span<const float> values) {
    while (next_ < mismatch.pose) {
      if (track_.seen[next_]) {
        Agree(NextGap(mismatch.pose));
      } else {
        replay_->Missing(next_++);
      }
    }
    const std::optional<float> distance = replay_->Mismatched(next_++, values);
    const bool is_wrong = distance && *distance > checker_.options_.tolerance;
    return is_wrong && FollowsDecay(mismatch.pose) ? std::nullopt : distance;
  }

 private:
  // A replay with a filter in its initial state, from pose `first` on.
  [[nodiscard]] Replay Begin(std::uint32_t first) const {
    return {
        workload_, checker_.plan_, track_.subject, *checker_.expected_, checker_.options_.tolerance,
        first};
  }
  // True if the filter of the server still depends on a decay before this pose.
  [[nodiscard]] bool FollowsDecay(std::uint32_t pose) const {
    const std::int64_t at_us = checker_.plan_.CaptureUs(phase_, pose);
    return std::ranges::any_of(resumed_us_, [at_us](std::int64_t resumed_us) {
      return at_us >= resumed_us && at_us < resumed_us + kForgottenUs;
    });
  }
  // The first pose in [next_, end) whose weights did not arrive; `end` if there is none.
  [[nodiscard]] std::uint32_t NextGap(std::uint32_t end) const {
    std::uint32_t pose = next_;
    while (pose < end && track_.seen[pose]) ++pose;
    return pose;
  }
  // All weights before `end` arrived and were correct. If that span is longer than the memory of
  // the filter, a new replay of its last seconds replaces the full replay, provided that it proves
  // exact.
  void Agree(std::uint32_t end) {
    const Plan& plan = checker_.plan_;
    const std::int64_t from_us = plan.CaptureUs(phase_, end) - kFilterMemoryUs;
    // Solving a long run again for each mismatch would take longer than the run. The filter
    // forgets, so its last seconds suffice, which the comparison with the table proves.
    if (forgets_ && from_us > plan.CaptureUs(phase_, next_)) {
      std::uint32_t pose = end;
      while (plan.CaptureUs(phase_, pose - 1) >= from_us) --pose;
      Replay late = Begin(pose);
      float worst = 0.0f;  // in the last fifth of the span
      for (; pose < end; ++pose) {
        const float difference = late.Agreed(pose);
        if (plan.CaptureUs(phase_, pose) > from_us + kFilterMemoryUs / 5 * 4)
          worst = std::max(worst, difference);
      }
      // A very slow filter does not forget in time. Then all replays of this track are complete
      // ones.
      forgets_ = worst <= kExact;
      if (forgets_) {
        replay_.emplace(std::move(late));
        next_ = end;
      }
    }
    while (next_ < end) replay_->Agreed(next_++);
  }

  const Checker& checker_;
  const Workload& workload_;
  const Track& track_;
  int phase_;
  std::optional<Replay> replay_;
  std::vector<std::int64_t> resumed_us_;  // capture times of the first poses after decays
  std::uint32_t next_ = 0;
  bool forgets_ = true;
};

bool Checker::ResolveMismatches(const Workload& workload,
                                const std::function<bool(double share)>& progress) {
  std::size_t total = 0;
  for (const Track& track : tracks_) total += track.mismatches.size();
  std::size_t done = 0;
  for (Track& track : tracks_) {
    if (track.mismatches.empty()) continue;
    // UDP may reorder messages; a replay must go through the poses in order.
    std::ranges::sort(track.mismatches, {}, &Mismatch::pose);
    // The values of these messages were not kept, so treat them as missing.
    for (const std::uint32_t pose : track.unfollowed) track.seen[pose] = false;
    MismatchResolver resolver(*this, workload, track);
    for (const Mismatch& mismatch : track.mismatches) {
      if (!progress(static_cast<double>(done) / static_cast<double>(total))) {
        tally_.unchecked += total - done;
        return false;
      }
      const std::span<const float> values =
          std::span(mismatch_values_)
              .subspan(mismatch.row, workload.binding->weight_names().size());
      if (const auto difference = resolver.Distance(mismatch, values)) {
        Classify(values, *difference);
      } else {
        ++tally_.unchecked;
      }
      ++done;
    }
  }
  return true;
}

}  // namespace furrow::load
