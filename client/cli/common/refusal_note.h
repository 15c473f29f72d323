// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace furrow::cli {

// Prints why the daemon refuses the token of a client that has lost its connection and tries again,
// once per reason.
class RefusalNote {
 public:
  // `refusal`: a sentence without a full stop; empty: the token is not refused.
  void Show(const std::string& refusal);

 private:
  std::set<std::string> shown_;
};

}  // namespace furrow::cli
