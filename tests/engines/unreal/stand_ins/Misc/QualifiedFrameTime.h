// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "Misc/Timecode.h"

struct FFrameTime {
  FFrameTime() = default;
  FFrameTime(FFrameNumber number) : FrameNumber(number) {}
  FFrameNumber FrameNumber;
};
struct FQualifiedFrameTime {
  FQualifiedFrameTime() = default;
  FQualifiedFrameTime(const FFrameTime& time, const FFrameRate& rate) : Time(time), Rate(rate) {}
  FFrameTime Time;
  FFrameRate Rate;
};
