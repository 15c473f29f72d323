// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// All limits of the wire. STANDARD.md section 11 states the same table.
namespace furrow::protocol {

inline constexpr std::uint16_t kDefaultTcpPort = 7400;
inline constexpr std::uint16_t kDefaultUdpPort = 7401;

// Fits the smallest IPv6 link (1,280 bytes) with all headers, so that no router cuts a datagram.
inline constexpr std::size_t kMaxDatagramBytes = 1200;
inline constexpr std::size_t kMaxUdpMessageBytes = 128 * 1024;   // reassembled, envelope included
inline constexpr std::size_t kMaxRequestBytes = 512 * 1024;      // TCP, client to server
inline constexpr std::size_t kMaxReplyBytes = 16 * 1024 * 1024;  // TCP, server to client (pictures)

inline constexpr int kMaxJoints = 1024;
inline constexpr int kMaxBlendShapes = 512;
inline constexpr int kMaxWeights = 2048;       // names per subscription
inline constexpr int kMaxNameBytes = 255;      // joint, blend shape, subject, weight, view, camera
inline constexpr int kMaxProgramBytes = 64;    // Hello's client, Welcome's server
inline constexpr int kMaxAccessBytes = 512;    // Hello's access: a connect token as text
inline constexpr int kMaxPatternBytes = 4096;  // comma-separated globs
inline constexpr int kMaxListedSubjects = 16384;
inline constexpr int kMaxPictureSettings = 128;
inline constexpr int kMaxPictureCodecs = 8;
inline constexpr int kMaxCodecBytes = 32;  // of one name, such as avc1.42c01f
inline constexpr int kNumPictureTiers = 3;
inline constexpr int kMaxOthers = 8;       // servers in a Welcome
inline constexpr int kMaxHostBytes = 255;  // of a server to ask instead
inline constexpr int kMaxCaptureBytes =
    64 * 1024;                              // captured reference poses of a subject that moves
inline constexpr int kMaxLeftNames = 32;    // in a DrainState
inline constexpr int kMaxTextBytes = 1024;  // human-readable messages
inline constexpr int kMaxImageSize = 4096;  // pixels per side
inline constexpr int kMinImageSize = 16;
inline constexpr float kMaxRateHz = 1000.0f;
inline constexpr float kMaxMagnitude = 1e6f;  // largest absolute coordinate, scale or coefficient

// Minimum size of a Hello and maximum size of a Welcome. A reply is never larger than the request,
// so the server cannot be used to amplify traffic.
inline constexpr std::size_t kHelloBytes = 256;

// Bytes of frames that may wait on one connection for subscriptions with `every`.
inline constexpr std::size_t kMaxWaitingFrameBytes = 8 * 1024 * 1024;

inline constexpr int kMaxVerifierDepth = 8;  // FlatBuffers nesting
inline constexpr int kMaxVerifierTables = 256;

// A UDP subscription ends after this time without an answer to a challenge.
inline constexpr std::int64_t kUdpLeaseMicroseconds = 5'000'000;
// Interval at which a publisher repeats its offer until the server replies.
inline constexpr std::int64_t kOfferResendMicroseconds = 200'000;
// Minimum interval between two requests of the server for the skeleton of one stream.
inline constexpr std::int64_t kNeedSkeletonMicroseconds = 200'000;

}  // namespace furrow::protocol
