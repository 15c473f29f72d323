// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/messages/limits.h"

// The messages of the wire as plain structs: what STANDARD.md section 5 onwards describes, decoded.
//
// All of them are meant to be kept and reused: decoding into the same object again does not
// allocate once its vectors have grown. Text is UTF-8. Spaces are right-handed, Y up, +Z forward.
namespace furrow::protocol {

struct Vec3 {
  float x = 0.0f, y = 0.0f, z = 0.0f;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

// A rotation, unit length, x y z w as on the wire.
struct Quat {
  float x = 0.0f, y = 0.0f, z = 0.0f, w = 1.0f;
  friend bool operator==(const Quat&, const Quat&) = default;
};

// What the envelope carries with every message.
struct Header {
  std::uint64_t session = 0;  // random, not 0; new at every start of the one who sends
  // Offers, poses, their answers: the publisher's number of its subject. Weights, pictures, their
  // replies and errors: the subscription. Else 0.
  std::uint16_t stream = 0;
  // Poses: counts from 0 by one per stream. Weights and pictures: the pose's. Requests: any number
  // that the client chooses; the answer repeats it.
  std::uint32_t sequence = 0;
  // Poses: when they were captured, microseconds on the publisher's own clock (any epoch, never
  // backwards within a session). Weights and pictures: the pose's. Else 0.
  std::int64_t capture_time_us = 0;
  friend bool operator==(const Header&, const Header&) = default;
};

// --- Meeting ------------------------------------------------------------------------------------

// Client to server. Over UDP a subscriber says Hello twice: with
// token 0, then with Welcome's token, which proves that it receives
// at its address. Padded by the encoder (see STANDARD.md section 4).
struct Hello {
  std::string client;  // program and version, for logs
  std::uint64_t token = 0;
  bool bundles = false;  // UDP: takes several messages in a datagram (bundle.h)
};

struct Welcome {
  std::string server;       // program and version
  std::uint64_t token = 0;  // send it back in Hello; 0 once proven, and on TCP
};

// Either way; answered by Pong at once. Keeps a UDP subscription alive.
struct Ping {
  std::int64_t time_us = 0;  // on the asker's clock
};

struct Pong {
  std::int64_t time_us = 0;         // Ping's, unchanged
  std::int64_t server_time_us = 0;  // on the answerer's clock
};

enum class GoodbyeReason : std::uint8_t {
  kDone = 0,         // the sender ends this stream or subscription of its own will
  kSubjectGone = 1,  // to a subscriber: the subject it watched has left
  kDraining = 2,     // the server shuts down
  kTimedOut = 3,     // nothing was heard for too long
};

// header.stream names what ends; stream 0 with kDraining means everything.
struct Goodbye {
  GoodbyeReason reason = GoodbyeReason::kDone;
};

enum class ErrorCode : std::uint16_t {
  kMalformed = 1,  // the bytes are not a message, or its content contradicts itself
  kUnsupportedVersion = 2,
  kUnsupported = 3,  // a valid message that this end does not serve
  kUnknownSubject = 4,
  kNoMatch = 5,           // the pattern names no weight
  kLimit = 6,             // too large, too many, too often
  kBadSkeleton = 7,       // see SkeletonReply, which is the usual answer
  kNotRendering = 8,      // pictures asked of a server that draws none
  kBadPicture = 9,        // size, view or camera that cannot be had
  kNeedsTcp = 10,         // pictures asked over UDP
  kUnprovenAddress = 11,  // UDP subscription without Hello's token
  kDraining = 12,
  kInternal = 13,
};

// header.sequence: that of the request that failed; header.stream: its stream or subscription.
struct ErrorMessage {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;  // one sentence for people: what, and what to do
};

// --- Publishing ---------------------------------------------------------------------------------

struct OfferedJoint {
  std::string name;          // unique in its skeleton, not empty
  std::int16_t parent = -1;  // index of an earlier joint; -1 for a root
  Vec3 rest_translation;     // local: relative to the parent
  Quat rest_rotation;
  Vec3 rest_scale{1.0f, 1.0f, 1.0f};
  bool has_tail = false;
  Vec3 tail;  // local end of a joint, where the source states one (BVH's End Site)
  friend bool operator==(const OfferedJoint&, const OfferedJoint&) = default;
};

// What a stream's poses mean. Sent before the first pose, and again until a SkeletonReply comes.
struct SkeletonOffer {
  std::string subject;                         // who is captured; not empty
  std::uint64_t skeleton_hash = 0;             // SkeletonHash() of this offer (hash.h)
  float metres_per_unit = 1.0f;                // of all translations
  std::vector<OfferedJoint> joints;            // parents first; may be empty if there are shapes
  std::vector<std::string> blend_shape_names;  // unique
  friend bool operator==(const SkeletonOffer&, const SkeletonOffer&) = default;
};

enum class SkeletonStatus : std::uint8_t {
  kAccepted = 0,
  kRejected = 1,  // `message` says why; sending it again will not help
  kNeeded = 2,    // poses came with a hash that the server does not know: send the offer
};

struct SkeletonReply {
  std::uint64_t skeleton_hash = 0;
  SkeletonStatus status = SkeletonStatus::kAccepted;
  std::string message;
};

// One pose. Lists of indices are strictly ascending and parallel to their values.
//
// Joints (and blend shapes) not listed are at rest (0), or, where `partial`, as in the last
// accepted pose of the stream. Translations are *offsets from the rest translation*, in the
// parent's space; rotations and scales are whole local values.
struct PoseFrame {
  std::uint64_t skeleton_hash = 0;
  bool partial = false;
  std::uint16_t num_joints = 0;        // of the skeleton; 0 for a face of shapes alone
  std::uint16_t num_blend_shapes = 0;  // of the skeleton offer
  std::vector<std::uint16_t> rotation_joints;
  std::vector<Quat> rotations;
  std::vector<std::uint16_t> translation_joints;
  std::vector<Vec3> translations;
  std::vector<std::uint16_t> scale_joints;
  std::vector<Vec3> scales;
  std::vector<std::uint16_t> blend_shape_indices;
  std::vector<float> blend_shapes;
};

// --- Subscribing --------------------------------------------------------------------------------

enum class WeightFormat : std::uint8_t {
  kF32 = 0,
  kU8 = 1,  // round(255 * value): half a step, 1/510, is the largest error
};

enum class WeightSource : std::uint8_t {
  kWrinkleWeights = 0,  // "<region>.<map>"
  kDriverValues = 1,    // "<driver>.<value>", before modulation and filter
};

// Sending the same request again (session and sequence equal) is harmless: the same subscription
// answers with another SubscribeReply. Used when that reply, or its names, were lost.
struct SubscribeWeights {
  std::string subject;        // empty: the subject that has been there longest
  bool wait = false;          // true: no error when the subject is not there yet; wait for it
  std::string pattern = "*";  // comma list of globs over weight names, see pattern.h
  float max_rate_hz = 0.0f;   // 0: every pose
  WeightFormat format = WeightFormat::kF32;
  WeightSource source = WeightSource::kWrinkleWeights;
  bool every = false;  // TCP: as for poses
};

// Answered by SubscribeReply and the SkeletonOffer that says what the poses mean; both come again,
// before the first pose that they concern, when another sender or another skeleton takes over.
struct SubscribePoses {
  std::string subject;  // as for weights
  bool wait = false;
  float max_rate_hz = 0.0f;
  // TCP: what is late waits in line instead of giving way to what is newer. Beyond 8 MiB a
  // connection the newest are left out, which Dropped tells.
  bool every = false;
};

enum class ImageFormat : std::uint8_t {
  kJpeg = 0,
  kPng = 1,
};

// An explicit camera, in metres in the character's model space.
struct Camera {
  Vec3 eye{0.0f, 1.6f, 2.0f};
  Vec3 target{0.0f, 1.6f, 0.0f};
  float vertical_fov_degrees = 30.0f;  // (1, 170)
};

struct SubscribePictures {
  std::string subject;  // as for weights
  bool wait = false;
  std::uint16_t width = 640;
  std::uint16_t height = 480;
  float max_rate_hz = 0.0f;
  ImageFormat format = ImageFormat::kJpeg;
  std::uint8_t quality = 80;   // JPEG, 1 to 100
  std::string view = "final";  // final, normal, mask_dynamic, mask_texture, weights, wireframe
  std::string camera_preset;   // empty: the server's default, unless has_camera
  bool has_camera = false;     // true: `camera` counts and camera_preset must be empty
  Camera camera;
  // Flow control: at most two pictures are under way until FrameAck comes (STANDARD.md section 9).
  bool acknowledged = false;
  std::vector<std::string> settings;  // "name=value", over the server's own
  // The explicit camera goes with the subject, and its angle counts across the picture's shorter
  // side: as presets' do.
  bool camera_follows = false;
};

// header.stream names a subscription of pictures; all of its view is replaced. Answered where it is
// refused alone. subject, wait and acknowledged are not read.
struct UpdatePictures {
  SubscribePictures pictures;
};

// header.stream names the subscription: this picture and all before it were shown.
struct FrameAck {
  std::uint32_t number = 0;  // ImageFrame::number, from 1
};

// header.stream names the subscription.
struct Unsubscribe {};

// header.stream: the subscription's id; header.sequence: the
// request's. Sent again of its own accord whenever the names change
// (another rig or skeleton), before the first frame that uses them.
struct SubscribeReply {
  std::string subject;             // who was chosen; empty while waiting for one
  std::uint64_t names_hash = 0;    // NamesHash(names); 0 while unknown, and for pictures
  std::vector<std::string> names;  // of the values of a WeightFrame, in their order
  // Poses: the session of who publishes, so that a restart is told from a leap; else 0.
  std::uint64_t publisher_session = 0;
};

// Who is there? Over TCP.
struct ListSubjects {
  bool follow = false;  // answered again whenever it changes
};

// header.sequence: the request's.
struct Subjects {
  std::vector<std::string> names;  // in order of arrival; at most kMaxListedSubjects
  std::uint32_t total = 0;         // how many there are, beyond those named
};

// header.stream: a subscription to every frame. At most once a second, while it grows.
struct Dropped {
  std::uint64_t frames = 0;  // that were left out since the subscription began
};

// header.stream: the subscription; header.sequence and capture_time_us: the pose's.
struct WeightFrame {
  std::uint64_t names_hash = 0;  // equal to the last SubscribeReply's, or the frame cannot be read
  std::int64_t age_us = 0;       // time without a pose since: > 0 while weights hold and decay
  WeightFormat format = WeightFormat::kF32;
  std::vector<float> values;  // decoded to [0, 1] whatever the format
};

// TCP and WebSocket. header as in WeightFrame.
struct ImageFrame {
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  ImageFormat format = ImageFormat::kJpeg;
  std::int64_t age_us = 0;
  std::vector<std::uint8_t> bytes;  // the encoded file
  std::uint32_t number = 0;         // counts from 1 where acknowledged, else 0
  std::uint8_t tier = 0;            // 0 best, below kNumPictureTiers
  bool still = false;               // the refined picture of a pose at rest
  std::uint32_t dropped = 0;        // poses not shown for want of acknowledgements, so far
  std::int64_t received_us = 0;     // when the server got the pose, on Pong's clock
  std::uint32_t view_request = 0;   // sequence of the request whose view this is
};

}  // namespace furrow::protocol
