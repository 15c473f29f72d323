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
static_assert(kRates[std::size(kRates) - 1] == kMaxTimecodeRate);
constexpr int kDefaultRate = 60;  // the app's default
constexpr double kSecondsADay = 86400.0;

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

// What the frame numbers of a recording reveal about its rate.
struct FrameNumbers {
  double highest = 0.0;
  bool second_ended = false;  // only a second that ended shows all of its frame numbers
};

FrameNumbers FrameNumbersOf(const std::vector<TimecodeFields>& cells) {
  FrameNumbers found;
  for (const TimecodeFields& cell : cells) {
    found.highest = std::max(found.highest, cell.frames);
    found.second_ended = found.second_ended || cell.seconds != cells.front().seconds;
  }
  return found;
}

// The smallest common rate above all frame numbers. nullopt: the recording is too short, and the
// reader assumes kDefaultRate.
std::optional<int> InferRate(const FrameNumbers& numbers) {
  if (!numbers.second_ended && numbers.highest < kDefaultRate) return std::nullopt;
  const auto above = std::find_if(std::begin(kRates), std::end(kRates),
                                  [&](int rate) { return rate > numbers.highest; });
  return *above;  // ParseTimecodeFields() rejects frames above the last rate
}

// The column Timecode at one rate.
struct TimeColumn {
  std::vector<std::optional<Timecode>> timecodes;  // nullopt: invalid at this rate
  std::vector<double> seconds;                     // since midnight
  double day = kSecondsADay;                       // from midnight to midnight
};

TimeColumn MakeTimeColumn(const std::vector<TimecodeFields>& cells, double rate) {
  TimeColumn column;
  column.timecodes.resize(cells.size());
  // Rates with a fraction are n * 1000 / 1001.
  const double nominal = std::ceil(rate);
  if (nominal >= 1.0 && nominal <= kMaxTimecodeRate && (nominal - rate) * 500.0 <= nominal) {
    const bool is_whole = nominal == rate;
    const auto numerator = static_cast<std::uint32_t>(is_whole ? nominal : nominal * 1000.0);
    std::transform(cells.begin(), cells.end(), column.timecodes.begin(),
                   [&](const TimecodeFields& cell) {
                     return MakeTimecode(cell, numerator, is_whole ? 1 : 1001);
                   });
  }
  // The numbers of drop-frame timecodes have gaps, and their frames have none. A column of both
  // would not rise, so a column with an invalid timecode counts numbers alone.
  const auto counts_frames = [](const std::optional<Timecode>& timecode) {
    return timecode && timecode->drop_frame;
  };
  const bool all_count_frames = std::ranges::all_of(column.timecodes, counts_frames);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double frames = cells[i].frames;
    if (all_count_frames) {
      const Timecode& timecode = *column.timecodes[i];
      const double part = frames - std::floor(frames);
      column.seconds.push_back((timecode.frame + part) * timecode.rate_denominator /
                               timecode.rate_numerator);
    } else {
      column.seconds.push_back(cells[i].seconds + frames / rate);
    }
  }
  if (all_count_frames && !cells.empty()) {  // 86 ms shorter
    const Timecode& timecode = *column.timecodes.front();
    column.day = static_cast<double>(TimecodeFramesPerDay(timecode)) * timecode.rate_denominator /
                 timecode.rate_numerator;
  }
  return column;
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
    const std::optional<TimecodeFields> time = ParseTimecodeFields(timecode);
    if (!time) return cursor_.Error(StatusCode::kParse, "the timecode is not HH:MM:SS:FF.mmm");
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
    const std::optional<int> inferred = InferRate(FrameNumbersOf(cells_));
    if (!inferred && report_ != nullptr && cells_.size() > 1) {
      report_->warnings.push_back(cursor_.Where() + ": the recording is too short to infer " +
                                  "the timecode's rate; 60 frames per second are assumed");
    }
    return inferred.value_or(kDefaultRate);
  }

  Status SetTimes() {
    const TimeColumn column = MakeTimeColumn(cells_, Rate());
    clip_.timecodes.resize(cells_.size());
    double midnight = 0.0;
    double previous = 0.0;
    std::size_t kept = 0;
    const std::size_t num_shapes = clip_.blend_shape_names.size();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      double time = column.seconds[i] - column.seconds[0] + midnight;
      // A jump back by more than half a day is midnight.
      if (time < previous - kSecondsADay / 2) {
        midnight += column.day;
        time += column.day;
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
      clip_.timecodes[kept] = column.timecodes[i];
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
  std::vector<int> columns_;  // index into blend_shape_names, or one of the constants above
  std::vector<TimecodeFields> cells_;  // of the column Timecode
  std::vector<std::size_t> lines_;
  std::size_t rows_without_face_ = 0;
  std::size_t rows_repeated_ = 0;
};

// A time since the clip's start as a timecode, rounded to a thousandth of a frame.
TimecodeFields FieldsOf(double seconds, int rate) {
  const std::int64_t a_second = std::int64_t{rate} * 1000;
  const std::int64_t total = std::llround(seconds * static_cast<double>(a_second));
  return {.seconds = static_cast<int>(total / a_second),
          .frames = static_cast<double>(total % a_second) / 1000.0};
}

// The smallest common rate with frames that are no longer than the clip's and that the reader will
// infer.
int WritingRate(const Clip& clip) {
  const double step = MeanFrameTime(clip);
  std::vector<TimecodeFields> cells(clip.times.size());
  for (const int rate : kRates) {
    if (step <= 0.0 || rate < 0.999 / step) continue;
    std::transform(clip.times.begin(), clip.times.end(), cells.begin(),
                   [&](double time) { return FieldsOf(time - clip.times[0], rate); });
    if (InferRate(FrameNumbersOf(cells)) == rate) return rate;
  }
  // The reader infers these from any frame numbers below them.
  return FieldsOf(clip.duration(), kDefaultRate).seconds == 0 ? kDefaultRate : kRates[0];
}

void AppendTimecode(const TimecodeFields& fields, std::string* text) {
  const auto thousandths = static_cast<int>(std::lround(fields.frames * 1000.0));
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%02d:%02d:%02d:%02d.%03d", fields.seconds / 3600,
                fields.seconds / 60 % 60, fields.seconds % 60, thousandths / 1000,
                thousandths % 1000);
  text->append(buffer);
}

void AppendTimecode(const Timecode& timecode, std::string* text) {
  // Rounded up, so that the reader gets the same 256th again.
  const int thousandths = (timecode.subframe * 1000 + 255) / 256;
  char part[8];
  std::snprintf(part, sizeof(part), ".%03d", thousandths);
  text->append(TimecodeText(timecode)).append(part);
}

// True if the timecodes have one rate and rise. They may pass midnight once.
bool DoTimecodesRise(const std::vector<std::optional<Timecode>>& all) {
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

// True if the recording can have the timecodes of the clip's source: the reader will infer their
// rate and get the clip's times from them.
bool CanKeepTimecodes(const Clip& clip) {
  const auto& all = clip.timecodes;
  if (!DoTimecodesRise(all)) return false;
  std::vector<TimecodeFields> cells;
  cells.reserve(all.size());
  std::string text;
  for (const std::optional<Timecode>& timecode : all) {
    text.clear();
    AppendTimecode(*timecode, &text);  // what the reader will see
    cells.push_back(ParseTimecodeFields(text).value_or(TimecodeFields()));
  }
  const int rate = InferRate(FrameNumbersOf(cells)).value_or(kDefaultRate);
  if (rate != NominalTimecodeRate(all[0]->rate_numerator, all[0]->rate_denominator)) return false;
  // Capture times jitter, and timecodes of 23.976 frames per second run 0.1% slow.
  const double tolerance = std::max(1.0, 0.002 * clip.duration());
  const TimeColumn column = MakeTimeColumn(cells, rate);
  for (std::size_t i = 0; i < all.size(); ++i) {
    double time = column.seconds[i] - column.seconds[0];
    if (all[i]->frame < all[0]->frame) time += column.day;  // after midnight
    if (std::abs(time - (clip.times[i] - clip.times[0])) >= tolerance) return false;
  }
  return true;
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
  const bool has_timecodes = CanKeepTimecodes(clip);
  const auto is_timecode = [](const std::optional<Timecode>& timecode) { return !!timecode; };
  if (!has_timecodes && report != nullptr && std::ranges::any_of(clip.timecodes, is_timecode)) {
    report->warnings.emplace_back(
        "the timecodes are incomplete, repeat or jump, or their rate cannot be inferred; the file "
        "starts at 00:00:00:00");
  }
  const int rate = has_timecodes ? 0 : WritingRate(clip);
  for (std::size_t f = 0; f < clip.times.size(); ++f) {
    if (has_timecodes) {
      AppendTimecode(*clip.timecodes[f], &text);
    } else {
      AppendTimecode(FieldsOf(clip.times[f] - clip.times[0], rate), &text);
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
