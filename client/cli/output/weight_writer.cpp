// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/weight_writer.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>

#include "base/numbers.h"

namespace furrow::cli {
namespace {

// Each row is flushed, so that a reader of the pipe sees it live. False: the pipe is closed or the
// disk is full.
bool Flush() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

class CsvWriter : public WeightWriter {
 public:
  explicit CsvWriter(bool timecodes) : timecodes_(timecodes) {}

  void Names(std::span<const std::string> names) override {
    std::fputs("frame,time", stdout);
    for (const std::string& name : names) std::printf(",%s", name.c_str());
    std::fputs(timecodes_ ? ",timecode\n" : "\n", stdout);
  }

  bool Row(const RowLabel& label, std::span<const float> values) override {
    std::printf("%" PRId64 ",%.6f", label.frame, label.seconds);
    for (const float value : values) std::printf(",%.6f", static_cast<double>(value));
    if (timecodes_) {
      std::fputc(',', stdout);
      if (label.timecode) std::fputs(TimecodeText(*label.timecode).c_str(), stdout);
    }
    std::fputc('\n', stdout);
    return Flush();
  }

 private:
  bool timecodes_;
};

// One JSON object per line, for programs that read a stream. Written by hand: a JSON library writes
// floats as doubles, so that 0.0333 becomes 0.033300001174211502.
class JsonlWriter : public WeightWriter {
 public:
  void Names(std::span<const std::string> names) override {
    keys_.clear();
    // Names come from the network; dump() would throw on bytes that are not UTF-8.
    constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
    for (const std::string& name : names) {
      keys_.push_back(nlohmann::json(name).dump(-1, ' ', false, kReplace) + ":");
    }
  }

  bool Row(const RowLabel& label, std::span<const float> values) override {
    line_ = "{\"frame\":" + std::to_string(label.frame) +
            ",\"time\":" + nlohmann::json(label.seconds).dump();
    if (label.timecode) line_ += ",\"timecode\":\"" + TimecodeText(*label.timecode) + '"';
    line_ += ",\"weights\":{";
    for (std::size_t i = 0; i < std::min(keys_.size(), values.size()); ++i) {
      if (i > 0) line_ += ',';
      line_ += keys_[i];
      AppendShortest(values[i], &line_);
    }
    line_ += "}}\n";
    std::fputs(line_.c_str(), stdout);
    return Flush();
  }

 private:
  std::vector<std::string> keys_;  // the names as JSON, each with its colon
  std::string line_;
};

// The largest weights of each frame with bars, for people.
class TableWriter : public WeightWriter {
 public:
  void Names(std::span<const std::string> names) override {
    names_.assign(names.begin(), names.end());
    order_.resize(names_.size());
  }

  bool Row(const RowLabel& label, std::span<const float> values) override {
    constexpr std::size_t kRows = 8;
    constexpr int kBar = 30;
    const std::size_t count = std::min(kRows, std::min(order_.size(), values.size()));
    std::iota(order_.begin(), order_.end(), 0);
    // Equal values stay in the order of the rig, so that rows do not jump.
    std::partial_sort(
        order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count), order_.end(),
        [&](int a, int b) { return values[a] > values[b] || (values[a] == values[b] && a < b); });
    std::printf("frame %" PRId64 "  %.3f s", label.frame, label.seconds);
    if (label.timecode) std::printf("  %s", TimecodeText(*label.timecode).c_str());
    std::fputc('\n', stdout);
    for (std::size_t i = 0; i < count; ++i) {
      const float value = values[order_[i]];
      // Too small to matter; the values are sorted, so all others are smaller.
      if (value < 0.005f) break;
      const std::string bar(static_cast<std::size_t>(value * kBar + 0.5f), '#');
      std::printf("  %-28s %.3f %s\n", names_[order_[i]].c_str(), static_cast<double>(value),
                  bar.c_str());
    }
    return Flush();
  }

 private:
  std::vector<std::string> names_;
  std::vector<int> order_;
};

}  // namespace

std::unique_ptr<WeightWriter> WeightWriter::Create(TableFormat format, bool timecodes) {
  switch (format) {
    case TableFormat::kCsv: return std::make_unique<CsvWriter>(timecodes);
    case TableFormat::kJsonl: return std::make_unique<JsonlWriter>();
    case TableFormat::kTable: break;
  }
  return std::make_unique<TableWriter>();
}

}  // namespace furrow::cli
