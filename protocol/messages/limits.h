// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// Every bound of the wire in one place; STANDARD.md section 11 is the same table in words.
namespace furrow::protocol {

inline constexpr std::uint16_t kDefaultTcpPort = 7400;
inline constexpr std::uint16_t kDefaultUdpPort = 7401;

inline constexpr std::size_t kMaxDatagramBytes = 1200;
inline constexpr std::size_t kMaxUdpMessageBytes = 128 * 1024;   // reassembled, envelope included
inline constexpr std::size_t kMaxRequestBytes = 512 * 1024;      // TCP, client to server
inline constexpr std::size_t kMaxReplyBytes = 16 * 1024 * 1024;  // TCP, server to client (pictures)

inline constexpr int kMaxJoints = 1024;
inline constexpr int kMaxBlendShapes = 512;
inline constexpr int kMaxWeights = 2048;       // names of one subscription
inline constexpr int kMaxNameBytes = 255;      // joint, blend shape, subject, weight, view, camera
inline constexpr int kMaxProgramBytes = 64;    // Hello's client, Welcome's server
inline constexpr int kMaxPatternBytes = 4096;  // comma list of globs
inline constexpr int kMaxListedSubjects = 16384;
inline constexpr int kMaxPictureSettings = 128;
inline constexpr int kNumPictureTiers = 3;
inline constexpr int kMaxTextBytes = 1024;  // messages for people
inline constexpr int kMaxImageSize = 4096;  // pixels a side
inline constexpr int kMinImageSize = 16;
inline constexpr float kMaxRateHz = 1000.0f;
inline constexpr float kMaxMagnitude = 1e6f;  // of any coordinate, scale or coefficient

// A Hello has at least this many bytes, a Welcome at most: the answer never exceeds the question.
inline constexpr std::size_t kHelloBytes = 256;

// Of frames that a subscriber to every one of them has not taken yet, over a connection.
inline constexpr std::size_t kMaxWaitingFrameBytes = 8 * 1024 * 1024;

inline constexpr int kMaxVerifierDepth = 8;  // FlatBuffers nesting
inline constexpr int kMaxVerifierTables = 256;

// A UDP subscription lapses after this long without any datagram from its owner.
inline constexpr std::int64_t kUdpLeaseMicroseconds = 5'000'000;
// A publisher resends its offer this often until it is answered.
inline constexpr std::int64_t kOfferResendMicroseconds = 200'000;
// A server asks one stream for its skeleton at most this often.
inline constexpr std::int64_t kNeedSkeletonMicroseconds = 200'000;

}  // namespace furrow::protocol
