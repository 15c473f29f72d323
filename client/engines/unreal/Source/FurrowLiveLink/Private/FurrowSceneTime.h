// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "Misc/QualifiedFrameTime.h"
#include "Misc/Timecode.h"

#include "furrow/furrow.h"

// The timecode of a frame, for recordings and for Live Link's synchronisation by timecode. Default: it has none.
inline FQualifiedFrameTime SceneTimeOf(const furrow_frame& Frame)
{
	int Hours, Minutes, Seconds, Frames;
	char Separator;
	// An older library passes a shorter struct.
	if (Frame.struct_size < sizeof Frame) return {};
	if (std::sscanf(Frame.timecode, "%d:%d:%d%c%d", &Hours, &Minutes, &Seconds, &Separator, &Frames) != 5) return {};
	const FFrameRate Rate(Frame.timecode_rate_numerator, Frame.timecode_rate_denominator);
	return FQualifiedFrameTime(FTimecode(Hours, Minutes, Seconds, Frames, Separator == ';').ToFrameNumber(Rate), Rate);
}
