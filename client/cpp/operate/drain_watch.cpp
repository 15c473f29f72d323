// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/operate/drain_watch.h"

namespace furrow::client {

DrainWatch::Verdict DrainWatch::Judge(const std::optional<protocol::DrainState>& state,
                                      std::int64_t heard_us, std::int64_t now_us) const {
  const std::int64_t passed_us = now_us - start_us_;
  if (!state) return passed_us < kPatienceUs ? Verdict::kGoesOn : Verdict::kNoAnswer;
  if (!waits_) return Verdict::kAgreed;
  if (state->draining && state->left == 0) return Verdict::kEmpty;
  if (now_us - heard_us > kSilenceUs) return Verdict::kSilent;
  return limit_us_ > 0 && passed_us > limit_us_ ? Verdict::kTimedOut : Verdict::kGoesOn;
}

}  // namespace furrow::client
