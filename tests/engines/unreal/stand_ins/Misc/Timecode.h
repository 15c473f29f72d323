// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"

struct FFrameNumber {
  int32 Value = 0;
};
struct FFrameRate {
  FFrameRate() = default;
  FFrameRate(std::uint32_t numerator, std::uint32_t denominator)
      : Numerator(static_cast<int32>(numerator)), Denominator(static_cast<int32>(denominator)) {}
  int32 Numerator = 60000;
  int32 Denominator = 1001;
};
struct FTimecode {
  FTimecode(int32 hours, int32 minutes, int32 seconds, int32 frames, bool drop)
      : Hours(hours), Minutes(minutes), Seconds(seconds), Frames(frames), bDropFrameFormat(drop) {}
  // Frame numbers that drop-frame leaves out do not count: two, or four at 59.94, of each minute but the tenth.
  FFrameNumber ToFrameNumber(const FFrameRate& rate) const {
    const int32 nominal = (rate.Numerator + rate.Denominator - 1) / rate.Denominator;
    const int32 minutes = 60 * Hours + Minutes;
    const int32 dropped = bDropFrameFormat ? nominal / 15 * (minutes - minutes / 10) : 0;
    return {(60 * minutes + Seconds) * nominal + Frames - dropped};
  }
  int32 Hours, Minutes, Seconds, Frames;
  bool bDropFrameFormat;
};
