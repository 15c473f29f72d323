// SPDX-License-Identifier: Apache-2.0
#include "motion/livelink/livelink_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/ascii.h"
#include "base/numbers.h"
#include "base/status.h"
#include "base/text.h"
#include "base/text_cursor.h"
#include "base/time/timecode.h"
#include "motion/clip/limits.h"
#include "motion/clip/resample.h"

namespace furrow::motion {
namespace {

// Frame rates of cameras, in ascending order. The timecode does not state its rate; the highest
// frame number of a second reveals it.
constexpr int kRates[] = {24, 25, 30, 48, 50, 60, 100, 120, 240};
constexpr double kDefaultRate = 60.0;  // the app's default
constexpr double kSecondsADay = 86400.0;

// A cell of the column Timecode.
struct TimeCell {
  int seconds = 0;      // since midnight
  double frames = 0.0;  // within the second
  std::string_view text;
};

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::size_t CountCells(std::string_view line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

// Splits off the first `most` cells, so that a line of commas cannot become a list of millions.
std::vector<std::string_view> SplitCells(std::string_view line, std::size_t most) {
  std::vector<std::string_view> cells;
  while (cells.size() < most) {
    const std::size_t comma = line.find(',');
    cells.push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  return cells;
}

// "HH:MM:SS:FF.mmm"; drop-frame timecodes have a ';' before the frames.
Result<TimeCell> ParseTimeCell(std::string_view text, const TextCursor& cursor) {
  double field[4] = {};
  std::string_view rest = text;
  bool good = true;
  for (int i = 0; i < 4; ++i) {
    const std::size_t end = i < 3 ? rest.find_first_of(i < 2 ? ":" : ":;") : rest.size();
    good = good && end != std::string_view::npos && TryParseNumber(rest.substr(0, end), &field[i]);
    if (good && i < 3) rest.remove_prefix(end + 1);
  }
  for (int i = 0; i < 3; ++i) {
    good = good && field[i] >= 0.0 && field[i] < (i == 0 ? 24.0 : 60.0) &&
           field[i] == std::floor(field[i]);
  }
  if (!good || field[3] < 0.0 || field[3] >= kRates[std::size(kRates) - 1]) {
    return cursor.Error(StatusCode::kParse, "the timecode is not HH:MM:SS:FF.mmm");
  }
  return TimeCell{static_cast<int>((field[0] * 60.0 + field[1]) * 60.0 + field[2]), field[3], text};
}

class TakeReader {
 public:
  TakeReader(std::string_view text, std::string_view source_name, const LoadOptions& options,
             ClipReport* report)
      : cursor_(text, source_name), options_(options), report_(report) {}

  Result<Clip> Run() {
    std::string_view line;
    if (!cursor_.NextLine(&line)) return cursor_.Error(StatusCode::kParse, "the file is empty");
    FURROW_RETURN_IF_ERROR(ReadHeader(line));
    while (cursor_.NextLine(&line)) {
      FURROW_RETURN_IF_ERROR(ReadRow(line));
    }
    if (clip_.times.empty()) {
      return cursor_.Error(StatusCode::kParse, "no row has a face");
    }
    FURROW_RETURN_IF_ERROR(SetTimes());
    WarnSkipped(rows_without_face_, "without a face");
    WarnSkipped(rows_repeated_, "with a repeated timecode");
    return std::move(clip_);
  }

 private:
  // Columns without a blend shape, below all indices.
  static constexpr int kIgnored = -1;
  static constexpr int kTimecode = -2;
  static constexpr int kCount = -3;

  Status ReadHeader(std::string_view line) {
    if (CountCells(line) > kMaxBlendShapes) {
      return cursor_.Error(StatusCode::kLimit,
                           "more than " + std::to_string(kMaxBlendShapes) + " columns");
    }
    std::unordered_set<std::string> seen;
    for (const std::string_view cell : SplitCells(line, kMaxBlendShapes)) {
      if (!cell.empty() && !seen.insert(std::string(cell)).second) {
        return cursor_.Error(StatusCode::kParse, "column '" + std::string(cell) + "' occurs twice");
      }
      if (EqualsIgnoreCase(cell, "Timecode")) {
        columns_.push_back(kTimecode);
      } else if (EqualsIgnoreCase(cell, "BlendShapeCount")) {
        columns_.push_back(kCount);
      } else if (cell.empty()) {  // some files end every line with a comma
        columns_.push_back(kIgnored);
      } else {
        columns_.push_back(static_cast<int>(clip_.blend_shape_names.size()));
        clip_.blend_shape_names.emplace_back(cell);
      }
    }
    if (std::count(columns_.begin(), columns_.end(), kTimecode) != 1) {
      return cursor_.Error(StatusCode::kParse, "the header has no column Timecode",
                           "the first line of a Live Link Face recording must name its columns");
    }
    if (clip_.blend_shape_names.empty()) {
      return cursor_.Error(StatusCode::kParse, "the header has no blend shape");
    }
    return {};
  }

  Status ReadRow(std::string_view line) {
    // A row without a face may be shorter than the header, so its cells are counted only
    // afterwards.
    const std::vector<std::string_view> cells = SplitCells(line, columns_.size());
    const std::string_view timecode = cells[TimecodeColumn(cells.size())];
    if (HasNoFace(cells)) {
      ++rows_without_face_;
      return {};
    }
    if (const std::size_t count = CountCells(line); count != columns_.size()) {
      return cursor_.Error(StatusCode::kParse,
                           "the row has " + std::to_string(count) + " cells, the header has " +
                               std::to_string(columns_.size()),
                           cursor_.line_was_ended() ? "" : "the file seems to be cut off");
    }
    const Result<TimeCell> time = ParseTimeCell(timecode, cursor_);
    FURROW_RETURN_IF_ERROR(time);
    const std::size_t num_shapes = clip_.blend_shape_names.size();
    if (clip_.times.size() >= kMaxFrames ||
        (clip_.times.size() + 1) * num_shapes > kMaxBlendShapeValues) {
      return cursor_.Error(StatusCode::kLimit, "too many rows");
    }
    clip_.blend_shapes.resize(clip_.blend_shapes.size() + num_shapes);
    float* values = clip_.blend_shapes.data() + clip_.blend_shapes.size() - num_shapes;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns_[i] < 0) continue;
      double number = 0.0;
      if (!TryParseNumber(cells[i], &number))
        return ParseNumber(cells[i], cursor_.Where()).status();
      values[columns_[i]] = static_cast<float>(number);
    }
    cells_.push_back(*time);
    lines_.push_back(cursor_.line());
    clip_.times.push_back(0.0);
    return {};
  }

  [[nodiscard]] std::size_t TimecodeColumn(std::size_t num_cells) const {
    const auto found = std::find(columns_.begin(), columns_.end(), kTimecode);
    return std::min(static_cast<std::size_t>(found - columns_.begin()), num_cells - 1);
  }

  // While the app sees no face, it writes "timecode,0" and then nothing, or empty cells.
  [[nodiscard]] bool HasNoFace(const std::vector<std::string_view>& cells) const {
    for (std::size_t i = 0; i < std::min(cells.size(), columns_.size()); ++i) {
      double count = 1.0;
      if (columns_[i] == kCount && TryParseNumber(cells[i], &count) && count == 0.0) return true;
    }
    return false;
  }

  [[nodiscard]] double Rate() {
    if (options_.timecode_rate > 0.0) return options_.timecode_rate;
    double highest = 0.0;
    bool second_ended = false;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      highest = std::max(highest, cells_[i].frames);
      // Only a second that ended shows all of its frame numbers.
      second_ended = second_ended || cells_[i].seconds != cells_[0].seconds;
    }
    if (!second_ended && highest < kDefaultRate) {
      if (report_ != nullptr && cells_.size() > 1) {
        report_->warnings.push_back(cursor_.Where() + ": the recording is too short to infer " +
                                    "the timecode's rate; 60 frames per second are assumed");
      }
      return kDefaultRate;
    }
    const auto above = std::find_if(std::begin(kRates), std::end(kRates),
                                    [&](int rate) { return rate > highest; });
    return *above;  // ParseTimeCell() rejects frames above the last rate
  }

  void ReadTimecodes(double rate) {
    // A rate that the user states may have a fraction, 29.97. Its numerator then is that of a
    // nominal rate, as all fractions of timecodes.
    const double nominal = std::ceil(rate);
    const bool is_whole = nominal == rate;
    if (nominal < 1.0 || nominal > kMaxTimecodeRate) {
      clip_.timecodes.assign(cells_.size(), std::nullopt);
      return;
    }
    const auto numerator = static_cast<std::uint32_t>(is_whole ? nominal : nominal * 1000.0);
    for (const TimeCell& cell : cells_) {
      clip_.timecodes.push_back(ParseTimecode(cell.text, numerator, is_whole ? 1 : 1001));
    }
  }

  // Since midnight. The numbers of drop-frame timecodes have gaps, and their frames have none.
  [[nodiscard]] double SecondsOf(std::size_t row, double rate) const {
    const std::optional<Timecode>& timecode = clip_.timecodes[row];
    const double frames = cells_[row].frames;
    if (timecode && timecode->drop_frame) {
      const double part = frames - std::floor(frames);
      return (timecode->frame + part) * timecode->rate_denominator / timecode->rate_numerator;
    }
    return cells_[row].seconds + frames / rate;
  }

  Status SetTimes() {
    const double rate = Rate();
    ReadTimecodes(rate);
    double midnight = 0.0;
    double previous = 0.0;
    std::size_t kept = 0;
    const std::size_t num_shapes = clip_.blend_shape_names.size();
    const double first = SecondsOf(0, rate);
    // A day of drop-frame timecodes is 86 ms shorter.
    const std::optional<Timecode>& start = clip_.timecodes[0];
    const double day = start && start->drop_frame
                           ? static_cast<double>(TimecodeFramesPerDay(*start)) *
                                 start->rate_denominator / start->rate_numerator
                           : kSecondsADay;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      double time = SecondsOf(i, rate) - first + midnight;
      // A jump back by more than half a day is midnight.
      if (time < previous - kSecondsADay / 2) {
        midnight += day;
        time += day;
      }
      // A step back of at most 1 second counts as a repetition, and the row is skipped.
      if (i > 0 && time <= previous) {
        if (time < previous - 1.0) {
          return Status(StatusCode::kParse, "the timecode goes backwards", WhereOf(lines_[i]));
        }
        ++rows_repeated_;
        continue;
      }
      // Moves the row to the front, over skipped rows.
      previous = clip_.times[kept] = time;
      clip_.timecodes[kept] = clip_.timecodes[i];
      std::copy_n(clip_.blend_shapes.begin() + static_cast<std::ptrdiff_t>(i * num_shapes),
                  num_shapes,
                  clip_.blend_shapes.begin() + static_cast<std::ptrdiff_t>(kept * num_shapes));
      ++kept;
    }
    clip_.times.resize(kept);
    clip_.timecodes.resize(kept);
    clip_.blend_shapes.resize(kept * num_shapes);
    return {};
  }

  [[nodiscard]] std::string WhereOf(std::size_t line) const {
    const std::string here = cursor_.Where();
    return here.substr(0, here.rfind(':') + 1) + std::to_string(line);
  }

  void WarnSkipped(std::size_t count, std::string_view which) {
    if (count == 0 || report_ == nullptr) return;
    const std::string here = cursor_.Where();
    report_->warnings.push_back(here.substr(0, here.rfind(':')) + ": skipped " +
                                Counted(count, "row") + " " + std::string(which));
  }

  TextCursor cursor_;
  const LoadOptions& options_;
  ClipReport* report_;
  Clip clip_;
  std::vector<int> columns_;     // index into blend_shape_names, or one of the constants above
  std::vector<TimeCell> cells_;  // of the column Timecode
  std::vector<std::size_t> lines_;
  std::size_t rows_without_face_ = 0;
  std::size_t rows_repeated_ = 0;
};

// The smallest common rate with frames that are no longer than the clip's.
int WritingRate(const Clip& clip) {
  const double step = MeanFrameTime(clip);
  if (step <= 0.0) return static_cast<int>(kDefaultRate);
  for (const int rate : kRates) {
    if (rate >= 0.999 / step) return rate;
  }
  return kRates[std::size(kRates) - 1];
}

void AppendTimecode(double seconds, int rate, std::string* text) {
  const std::int64_t a_second = std::int64_t{rate} * 1000;
  const std::int64_t total = std::llround(seconds * static_cast<double>(a_second));
  const std::int64_t s = total / a_second;
  const std::int64_t part = total % a_second;
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%02d:%02d:%02d:%02d.%03d", static_cast<int>(s / 3600),
                static_cast<int>(s / 60 % 60), static_cast<int>(s % 60),
                static_cast<int>(part / 1000), static_cast<int>(part % 1000));
  text->append(buffer);
}

// True if the recording can have the timecodes of the clip's source: the reader needs one rate, and
// times that rise.
bool HasTimecodes(const Clip& clip) {
  const auto& all = clip.timecodes;
  if (all.empty() || !all.front()) return false;
  int midnights = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (!all[i]) return false;
    const Timecode& before = *all[i - 1];
    const Timecode& now = *all[i];
    if (std::tie(now.rate_numerator, now.rate_denominator, now.drop_frame) !=
        std::tie(before.rate_numerator, before.rate_denominator, before.drop_frame)) {
      return false;
    }
    if (std::tie(now.frame, now.subframe) > std::tie(before.frame, before.subframe)) continue;
    // Otherwise the clock passed midnight, or the timecode repeats or jumps back.
    const bool is_midnight = before.frame - now.frame > TimecodeFramesPerDay(now) / 3 * 2;
    if (now.frame >= before.frame || !is_midnight || ++midnights > 1) return false;
  }
  return true;
}

void AppendTimecode(const Timecode& timecode, std::string* text) {
  // Rounded up, so that the reader gets the same 256th again.
  const int thousandths = (timecode.subframe * 1000 + 255) / 256;
  char part[8];
  std::snprintf(part, sizeof(part), ".%03d", thousandths);
  text->append(TimecodeText(timecode)).append(part);
}

}  // namespace

Result<Clip> ParseLiveLinkCsv(std::string_view text, std::string_view source_name,
                              const LoadOptions& options, ClipReport* report) {
  return TakeReader(text, source_name, options, report).Run();
}

Result<std::string> LiveLinkCsvToText(const Clip& clip, ClipReport* report) {
  const std::size_t num_shapes = clip.blend_shape_names.size();
  if (num_shapes == 0) {
    return Status(
        StatusCode::kUnsupported,
        "the clip has no blend shapes, and a Live Link Face CSV can express nothing else");
  }
  if (clip.num_frames() == 0) return Status(StatusCode::kInvalidArgument, "the clip has no frames");
  // The last second stays unused because a time may round up to midnight.
  if (clip.duration() >= kSecondsADay - 1.0)
    return Status(StatusCode::kLimit, "the clip has " + std::to_string(clip.duration()) +
                                          " s; timecodes end before one day");
  if (clip.skeleton.num_joints() > 0 && report != nullptr) {
    report->warnings.emplace_back("a Live Link Face CSV has no joints: they are dropped");
  }
  std::string text = "Timecode,BlendShapeCount";
  for (const std::string& name : clip.blend_shape_names) {
    if (name.empty() || name.find_first_of(",\r\n") != std::string::npos) {
      return Status(StatusCode::kInvalidArgument, "CSV cannot express the name '" + name + "'");
    }
    text += "," + name;
  }
  text += '\n';
  const int rate = WritingRate(clip);
  const bool has_timecodes = HasTimecodes(clip);
  for (std::size_t f = 0; f < clip.times.size(); ++f) {
    if (has_timecodes) {
      AppendTimecode(*clip.timecodes[f], &text);
    } else {
      AppendTimecode(clip.times[f] - clip.times[0], rate, &text);
    }
    text += "," + std::to_string(num_shapes);
    for (std::size_t s = 0; s < num_shapes; ++s) {
      text += ',';
      AppendShortest(clip.blend_shapes[f * num_shapes + s], &text);
    }
    text += '\n';
  }
  return text;
}

}  // namespace furrow::motion
