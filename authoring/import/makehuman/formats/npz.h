// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::authoring {

// A ZIP archive in memory, such as NumPy's .npz: stored and deflated entries, without encryption.
class NpzArchive {
 public:
  // Larger archives, and archives with more entries or a larger entry, are errors. MakeHuman's
  // targets.npz has 40 MB and some 3,000 entries of at most 120 kB.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20;
  static constexpr std::size_t kMaxEntries = 100'000;
  static constexpr std::size_t kMaxEntryBytes = std::size_t{8} << 20;

  // Reads the archive's table of contents. `source`: the file name in errors. Errors: kParse (no
  // ZIP archive), kLimit.
  [[nodiscard]] static Result<NpzArchive> Open(std::string bytes, std::string source);
  NpzArchive(NpzArchive&&) noexcept;
  NpzArchive& operator=(NpzArchive&&) noexcept;
  ~NpzArchive();

  // Calls `visit` with the name of each entry, sorted. Names are as the archive states them, with
  // forward slashes; they prove nothing and must not be used as paths.
  void ForEachName(const std::function<void(const std::string&)>& visit) const;
  [[nodiscard]] bool Has(const std::string& name) const;
  // Unpacks an entry. Errors name "source: entry": kNotFound, kLimit (larger than kMaxEntryBytes),
  // kParse (damaged), kUnsupported (encrypted, or another compression).
  [[nodiscard]] Result<std::string> Read(const std::string& name) const;

 private:
  struct Memory;
  struct Place {
    std::uint64_t offset = 0;  // in the table of contents
    std::uint64_t index = 0;
  };

  NpzArchive(std::unique_ptr<Memory> memory, std::string source);
  [[nodiscard]] Status ListEntries();
  [[nodiscard]] Result<std::string> ReadCurrent() const;

  std::unique_ptr<Memory> memory_;
  std::string source_;
  std::map<std::string, Place> places_;
};

}  // namespace furrow::authoring
