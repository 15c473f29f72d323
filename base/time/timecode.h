// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace furrow {

// A SMPTE timecode (ST 12-1): the time of day that a source gives to a frame, as a count of frames
// since 00:00:00:00. It labels frames: it may repeat or jump, and it starts again at midnight.
//
// Drop-frame timecode leaves out frame *numbers*, so that its text follows the clock: ;00 and ;01
// of each minute that is not a multiple of ten, at 29.97 frames per second, and ;00 to ;03
// at 59.94. `frame` counts frames, so it has no such gaps.
struct Timecode {
  std::uint32_t frame = 0;            // below TimecodeFramesPerDay()
  std::uint32_t rate_numerator = 30;  // frames per second: numerator / denominator
  std::uint16_t rate_denominator = 1;
  std::uint8_t subframe = 0;  // part of the frame that has passed, in 1/256 of a frame
  bool drop_frame = false;    // only if HasDropFrame()
  friend bool operator==(const Timecode&, const Timecode&) = default;
};

// The fastest timecode, in frames per second.
inline constexpr int kMaxTimecodeRate = 240;

// Frame numbers per second: the rate, rounded up, 30 for 29.97. Timecodes have 1 to
// kMaxTimecodeRate frames per second, or up to 0.2% less than a whole number, such as 30000/1001
// and 23.976. Returns 0 for any other rate.
[[nodiscard]] int NominalTimecodeRate(std::uint32_t numerator, std::uint32_t denominator);
// True for rates that have drop-frame timecode: up to 0.2% below 30 or 60 frames per second, such
// as 30000/1001, 2997/100 and 60000/1001.
[[nodiscard]] bool HasDropFrame(std::uint32_t numerator, std::uint32_t denominator);

// The number of frames before 24:00:00:00. 0: the rate, or drop_frame, is invalid.
[[nodiscard]] std::uint32_t TimecodeFramesPerDay(const Timecode& timecode);
// False for a rate or frame that is out of range. Functions below need valid timecodes.
[[nodiscard]] bool IsValid(const Timecode& timecode);

// Makes the timecode of a qualified frame time, as phones and engines send it: a count of frames
// since midnight, a part of a frame in [0, 1), and the rate. Timecodes of 29.97 and 59.94
// frames per second are drop-frame, as in Unreal Engine. A count that runs on after midnight starts
// again.
//
// Returns nullopt for a count that is negative or two days or more, an invalid rate, and a subframe
// that is not finite. A subframe outside [0, 1) is clamped.
[[nodiscard]] std::optional<Timecode> MakeTimecode(std::int64_t frame, double subframe,
                                                   std::int64_t rate_numerator,
                                                   std::int64_t rate_denominator);

// "HH:MM:SS:FF", with ';' before the frames of drop-frame timecode. Above 100 frames per second, FF
// has three digits. The subframe is left out.
[[nodiscard]] std::string TimecodeText(const Timecode& timecode);

// What the text of a timecode says by itself, without a rate.
struct TimecodeFields {
  int seconds = 0;      // HH:MM:SS, below 86400
  double frames = 0.0;  // FF and the part of a frame, below kMaxTimecodeRate
  bool drop_frame = false;
  friend bool operator==(const TimecodeFields&, const TimecodeFields&) = default;
};
// Reads the text of TimecodeText(). A part of a frame may follow, as apps write it: "07.123".
// Fields consist of digits. Returns nullopt for any other text.
[[nodiscard]] std::optional<TimecodeFields> ParseTimecodeFields(std::string_view text);
// Drop-frame means 29.97 or 59.94 frames per second, also if the rate is given as 30 or 60, because
// files do not always distinguish the two. Returns nullopt if the rate is invalid, or the fields
// are not a timecode of this rate, such as 00:01:00;00, which drop-frame leaves out.
[[nodiscard]] std::optional<Timecode> MakeTimecode(const TimecodeFields& fields,
                                                   std::uint32_t rate_numerator,
                                                   std::uint16_t rate_denominator = 1);
// ParseTimecodeFields(), then MakeTimecode().
[[nodiscard]] std::optional<Timecode> ParseTimecode(std::string_view text,
                                                    std::uint32_t rate_numerator,
                                                    std::uint16_t rate_denominator = 1);

}  // namespace furrow
