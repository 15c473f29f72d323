// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "recording/take_reader.h"

namespace furrow::recording {

// The poses of one subject of a take, exactly as they were received. `furrow play` sends them again
// unchanged.
class TakePoses {
 public:
  // Loads one subject. An empty `subject` means the only one in the take. Unreadable poses, and
  // poses of a skeleton other than the subject's first, are skipped with a warning in `report`.
  //
  // Errors: kNotFound (no such subject, or no poses), kInvalidArgument (`subject` is empty and the
  // take has several; the message lists them), kLimit, and those of TakeReader::ForEach().
  [[nodiscard]] static Result<TakePoses> Load(TakeReader& take, std::string_view subject,
                                              motion::ClipReport* report);
  // Loads one subject, or all if `subject` is empty, in order of their first poses. The result has
  // at least one entry. Errors: Load()'s except kInvalidArgument.
  [[nodiscard]] static Result<std::vector<TakePoses>> LoadAll(TakeReader& take,
                                                              std::string_view subject,
                                                              motion::ClipReport* report);

  [[nodiscard]] const protocol::SkeletonOffer& offer() const { return offer_; }
  // The arrival of the first pose, in seconds since the earliest first pose of all subjects that
  // were loaded together.
  [[nodiscard]] double start() const { return start_; }
  [[nodiscard]] std::size_t size() const { return times_.size(); }
  // Seconds since the first pose, increasing. Steps are differences of capture times. If capture
  // times go back or leap (a clock was set), or a sender was restarted, the step is the difference
  // of arrival times instead.
  [[nodiscard]] std::span<const double> times() const { return times_; }
  // Decodes pose `index`, which must be below size(). Loading has verified it.
  void Get(std::size_t index, protocol::PoseFrame* pose) const;

 private:
  class Loader;
  // `only_one`: several subjects are an error if `subject` is empty.
  [[nodiscard]] static Result<std::vector<TakePoses>> LoadOf(TakeReader& take,
                                                             std::string_view subject,
                                                             bool only_one,
                                                             motion::ClipReport* report);
  void Add(const TakeMessage& message);
  [[nodiscard]] std::int64_t StepTo(const TakeStamp& stamp) const;

  protocol::SkeletonOffer offer_;
  double start_ = 0.0;
  std::vector<double> times_;
  std::vector<std::size_t> ends_;  // of each pose's payload in `bytes_`
  std::vector<std::uint8_t> bytes_;
  TakeStamp last_;
  std::int64_t elapsed_us_ = 0;
};

// Returns true if a path has the extension of a take, ".mcap" in any case, with or without "#NAME".
[[nodiscard]] bool IsTakePath(const std::string& path);
// Splits "take.mcap#ada" into file and subject. If a file with the whole name exists, `subject`
// stays empty.
void SplitTakePath(const std::string& path, std::string* file, std::string* subject);

}  // namespace furrow::recording
