// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#include "server/core/metrics.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// Limits the memory of what waits for clients that read slowly: of all together, and shared between
// hosts (FairShare), so that one host alone gets half. The first kFree bytes of each account are
// not counted, because the number of clients bounds them; clients that keep up never come here.
// Thread-safe.
class WaitingBytes {
 public:
  static constexpr std::size_t kFree = std::size_t{64} << 10;
  static constexpr std::size_t kChunk = std::size_t{64} << 10;  // what hosts take and give back

  // `most`: bytes. `metrics`: not null; outlives this object; counts what accounts report.
  WaitingBytes(std::size_t most, Metrics* metrics) : metrics_(metrics), shares_(most / kChunk) {}
  // From now on. What waits already goes on waiting.
  void SetMost(std::size_t most);
  // The bytes of all chunks that are taken.
  [[nodiscard]] std::size_t taken() const;

  // What waits for one client. Not thread-safe. Without a budget, everything has room.
  class Account {
   public:
    Account() = default;
    // `budget`: outlives the account.
    Account(WaitingBytes* budget, std::string host) : budget_(budget), host_(std::move(host)) {}
    ~Account() { (void)Hold(0); }
    Account(Account&& other) noexcept
        : budget_(std::exchange(other.budget_, nullptr)),
          host_(std::move(other.host_)),
          chunks_(std::exchange(other.chunks_, 0)) {}
    Account& operator=(Account&&) = delete;

    // States how many bytes wait. False: there is no room for more than before, and the account
    // stays as it was. Fewer bytes always have room.
    [[nodiscard]] bool Hold(std::size_t bytes) {
      const std::size_t chunks = bytes <= kFree ? 0 : (bytes - kFree + kChunk - 1) / kChunk;
      return chunks == chunks_ || budget_ == nullptr || budget_->Change(host_, &chunks_, chunks);
    }

    // Counts that a message or a reply had no room.
    void CountRefusal() {
      if (budget_ != nullptr) budget_->metrics_->Add(Counter::kWaitingRefused);
    }

   private:
    WaitingBytes* budget_ = nullptr;
    std::string host_;
    std::size_t chunks_ = 0;
  };

 private:
  [[nodiscard]] bool Change(const std::string& host, std::size_t* held, std::size_t wanted);

  Metrics* const metrics_;
  mutable std::mutex mutex_;
  FairShare shares_;  // of chunks
};

}  // namespace furrow::server
