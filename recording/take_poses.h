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

// The poses of one subject of a take, as they were received: what `furrow play` sends again, number
// for number.
class TakePoses {
 public:
  // `subject` empty: the only one there is. Left out, with a warning in `report`: poses that cannot
  // be read, and those of another skeleton than the subject's first.
  //
  // Errors: kNotFound (no such subject, or one without poses), kInvalidArgument (no subject is
  // named and there are several; the message names them), kLimit, the reader's.
  [[nodiscard]] static Result<TakePoses> Load(TakeReader& take, std::string_view subject,
                                              motion::ClipReport* report);
  // `subject` empty: all there are, in the order of their first poses; at least one. Errors: as
  // Load()'s, but for several subjects.
  [[nodiscard]] static Result<std::vector<TakePoses>> LoadAll(TakeReader& take,
                                                              std::string_view subject,
                                                              motion::ClipReport* report);

  [[nodiscard]] const protocol::SkeletonOffer& offer() const { return offer_; }
  // When its first pose arrived: seconds since the first one of all that were loaded with it.
  [[nodiscard]] double start() const { return start_; }
  [[nodiscard]] std::size_t size() const { return times_.size(); }
  // Seconds since the first pose, increasing: the differences of the capture times. Where those go
  // back, leap (a clock that was set) or a sender was restarted, the differences of the times of
  // arrival.
  [[nodiscard]] std::span<const double> times() const { return times_; }
  // Decodes pose `index` < size(); it was checked when it was loaded.
  void Get(std::size_t index, protocol::PoseFrame* pose) const;

 private:
  class Loader;
  // `only_one`: as Load(), else as LoadAll().
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

// Whether a path names a take by its extension, ".mcap" in any case; "take.mcap#NAME" names one
// subject of it.
[[nodiscard]] bool IsTakePath(const std::string& path);
// "take.mcap#ada" apart; a file that is really called so stays whole.
void SplitTakePath(const std::string& path, std::string* file, std::string* subject);

}  // namespace furrow::recording
