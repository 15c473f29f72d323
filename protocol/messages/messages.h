// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time/timecode.h"
#include "protocol/messages/limits.h"

// The messages of the wire as plain structs (STANDARD.md, section 4 and later).
//
// Reuse them: decoding into the same object stops allocating once its vectors have grown. Text is
// UTF-8. Spaces are right-handed, Y up, +Z forward.
namespace furrow::protocol {

struct Vec3 {
  float x = 0.0f, y = 0.0f, z = 0.0f;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

// A rotation of unit length, stored x y z w as on the wire.
struct Quat {
  float x = 0.0f, y = 0.0f, z = 0.0f, w = 1.0f;
  friend bool operator==(const Quat&, const Quat&) = default;
};

// The fields of the envelope, which every message carries.
struct Header {
  std::uint64_t session = 0;  // random, never 0, new at every start of the sending program
  // Offers, poses and replies to them: the publisher's number for the subject. Weights, pictures
  // and replies and errors about them: the subscription. Otherwise 0.
  std::uint16_t stream = 0;
  // Poses: counts up from 0 per stream. Weights and pictures: the sequence of their pose. Requests:
  // any number the client chooses; the reply repeats it.
  std::uint32_t sequence = 0;
  // Poses: capture time in microseconds on the publisher's clock (any epoch, never backwards within
  // a session). Weights and pictures: the capture time of their pose. Otherwise 0.
  std::int64_t capture_time_us = 0;
  friend bool operator==(const Header&, const Header&) = default;
};

// --- Connecting ---------------------------------------------------------------------------------

// Client to server. Over UDP a subscriber sends Hello twice: first with token 0, then with the
// token from Welcome, which proves that the client receives at its address. The encoder pads the
// message (STANDARD.md section 4).
struct Hello {
  std::string client;  // program and version, for logs
  std::uint64_t token = 0;
  bool bundles = false;  // UDP: accepts several messages per datagram (bundle.h)
  std::string access;    // TCP: a connect token in text form (STANDARD.md section 14); may be empty
};

// Server to client: the reply to Hello.
struct Welcome {
  std::string server;       // program and version
  std::uint64_t token = 0;  // to be returned in Hello; 0 once the address is proven, and on TCP
  // Further servers of its cluster, "HOST:TCP:UDP", for a client that loses this one; at most
  // kMaxOthers. Only with token 0.
  std::vector<std::string> others = {};
};

// Either direction. The receiver replies with Pong at once. Keeps a UDP subscription alive.
struct Ping {
  std::int64_t time_us = 0;  // on the sender's clock
};

// The reply to Ping.
struct Pong {
  std::int64_t time_us = 0;         // copied from Ping
  std::int64_t server_time_us = 0;  // on the replying side's clock
};

enum class GoodbyeReason : std::uint8_t {
  kDone = 0,         // the sender ends this stream or subscription
  kSubjectGone = 1,  // to a subscriber: the subject has left
  kDraining = 2,     // the server is shutting down
  kTimedOut = 3,     // nothing was received for too long
};

// Announces the end of a stream or subscription: the one in header.stream. Stream 0 with kDraining
// means all of the connection.
struct Goodbye {
  GoodbyeReason reason = GoodbyeReason::kDone;
};

enum class ErrorCode : std::uint16_t {
  kMalformed = 1,  // not a message, or contradictory content
  kUnsupportedVersion = 2,
  kUnsupported = 3,  // a valid message that the receiver does not serve
  kUnknownSubject = 4,
  kNoMatch = 5,           // the pattern matches no weight
  kLimit = 6,             // too large, too many or too often
  kBadSkeleton = 7,       // usually sent as SkeletonReply instead
  kNotRendering = 8,      // a picture request to a server that does not render
  kBadPicture = 9,        // unavailable size, view or camera
  kNeedsTcp = 10,         // a picture or list request over UDP
  kUnprovenAddress = 11,  // a UDP address without a token from Hello
  kDraining = 12,
  kInternal = 13,
  kSubjectTaken = 14,  // another publisher is sending the subject
  kNeedsToken = 15,    // the server requires a connect token, or refuses the one that it was shown
  kNotPermitted = 16,  // the token does not allow this
};

// Reports that a request failed. header.sequence and header.stream are those of the request.
struct ErrorMessage {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;  // one human-readable sentence: what went wrong and what to do
  // The server that the client must ask instead; empty: none.
  std::string host = {};  // a name or a numeric address, without brackets; at most kMaxHostBytes
  std::uint16_t tcp = 0;  // ports; not 0 with a host
  std::uint16_t udp = 0;
  std::uint16_t web = 0;  // of its web server; 0: it has none
  bool web_tls = false;   // HTTPS, not HTTP
};

// --- Publishing ---------------------------------------------------------------------------------

// A joint of a SkeletonOffer. Lengths are in the offer's unit (metres_per_unit).
struct OfferedJoint {
  std::string name;          // unique in the skeleton, not empty
  std::int16_t parent = -1;  // index of an earlier joint; -1 for a root
  Vec3 rest_translation;     // local: relative to the parent
  Quat rest_rotation;
  Vec3 rest_scale{1.0f, 1.0f, 1.0f};
  bool has_tail = false;
  Vec3 tail;  // if has_tail: end of the joint in its local space (End Site in BVH)
  friend bool operator==(const OfferedJoint&, const OfferedJoint&) = default;
};

// Describes the skeleton of a stream, which gives its poses their meaning. A publisher sends it
// before the first pose and repeats it until a SkeletonReply arrives.
struct SkeletonOffer {
  std::string subject;               // name of the captured subject; not empty
  std::uint64_t skeleton_hash = 0;   // SkeletonHash() of this offer (hash.h)
  float metres_per_unit = 1.0f;      // unit of all translations and tails, also of poses
  std::vector<OfferedJoint> joints;  // parents first; may be empty if there are blend shapes
  std::vector<std::string> blend_shape_names;  // unique
  friend bool operator==(const SkeletonOffer&, const SkeletonOffer&) = default;
};

enum class SkeletonStatus : std::uint8_t {
  kAccepted = 0,
  kRejected = 1,  // `message` states the reason; sending the offer again does not help
  kNeeded = 2,    // the server does not know the hash of the poses: send the offer
};

// Server to publisher: what became of the skeleton with this hash.
struct SkeletonReply {
  std::uint64_t skeleton_hash = 0;
  SkeletonStatus status = SkeletonStatus::kAccepted;
  std::string message;
};

// One pose. Each list of indices is strictly ascending; entry i belongs to entry i of the list of
// values after it.
//
// Joints that are not listed are at rest and blend shapes that are not listed are 0. If `partial`,
// both keep their value from the last accepted pose of the stream instead. Translations are
// *offsets from the rest translation*, in the parent's space. Rotations and scales are complete
// local values.
struct PoseFrame {
  std::uint64_t skeleton_hash = 0;  // SkeletonHash() of the offer
  bool partial = false;
  std::uint16_t num_joints = 0;        // of the skeleton; 0 if it has only blend shapes
  std::uint16_t num_blend_shapes = 0;  // of the skeleton
  std::vector<std::uint16_t> rotation_joints;
  std::vector<Quat> rotations;
  std::vector<std::uint16_t> translation_joints;
  std::vector<Vec3> translations;
  std::vector<std::uint16_t> scale_joints;
  std::vector<Vec3> scales;
  std::vector<std::uint16_t> blend_shape_indices;
  std::vector<float> blend_shapes;
  // The encoded payload of the stream's previous pose, in case that its own datagram is lost
  // (DecodePrevious()); at most kMaxDatagramBytes; empty: not repeated.
  std::vector<std::uint8_t> previous;
  std::uint32_t previous_age_us = 0;  // capture time of this pose minus that of the previous one
  // The source's timecode, if it sends one. It is only a label: times come from the capture time.
  std::optional<Timecode> timecode;
};

// --- Subscribing --------------------------------------------------------------------------------

enum class WeightFormat : std::uint8_t {
  kF32 = 0,
  kU8 = 1,  // round(255 * value), error up to 1/510
};

enum class WeightSource : std::uint8_t {
  kWrinkleWeights = 0,  // "<region>.<map>"
  kDriverValues = 1,    // "<driver>.<value>", before modulation and filter
};

// Requests the wrinkle weights or driver values of a subject. A repeated request (same session and
// sequence) does not create a second subscription; the server sends the SubscribeReply again.
// Clients repeat the request if the reply or its names were lost.
struct SubscribeWeights {
  std::string subject;        // empty: the oldest live subject
  bool wait = false;          // true: wait for an absent subject instead of failing
  std::string pattern = "*";  // comma-separated globs over weight names (pattern.h)
  float max_rate_hz = 0.0f;   // 0: every pose
  WeightFormat format = WeightFormat::kF32;
  WeightSource source = WeightSource::kWrinkleWeights;
  bool every = false;  // TCP: send every frame; see SubscribePoses
};

// Requests the poses of a subject. The server replies with SubscribeReply and the SkeletonOffer of
// the poses. It sends both again before the first pose of another sender or another skeleton.
struct SubscribePoses {
  std::string subject;  // the first three as in SubscribeWeights
  bool wait = false;
  float max_rate_hz = 0.0f;
  // TCP: late frames queue instead of being replaced by newer ones. If more than 8 MiB queue on a
  // connection, or more than the server grants to its host, the server drops the newest frames and
  // reports their number in Dropped.
  bool every = false;
};

enum class ImageFormat : std::uint8_t {
  kJpeg = 0,
  kPng = 1,
};

// An explicit camera in the character's model space, in metres.
struct Camera {
  Vec3 eye{0.0f, 1.6f, 2.0f};
  Vec3 target{0.0f, 1.6f, 0.0f};
  float vertical_fov_degrees = 30.0f;  // above 1 and below 170
};

// Requests rendered pictures of a subject. TCP and WebSocket only.
struct SubscribePictures {
  std::string subject;  // as in SubscribeWeights, like wait and max_rate_hz
  bool wait = false;
  std::uint16_t width = 640;  // pixels, [kMinImageSize, kMaxImageSize]; height too
  std::uint16_t height = 480;
  float max_rate_hz = 0.0f;
  ImageFormat format = ImageFormat::kJpeg;
  std::uint8_t quality = 80;   // JPEG, 1 to 100
  std::string view = "final";  // final, normal, mask_dynamic, ...: what the picture shows
  std::string camera_preset;   // empty: the server's default, unless has_camera
  bool has_camera = false;     // true: use `camera`; camera_preset must be empty
  Camera camera;
  // Flow control: the server sends a picture only while at most one earlier picture is without a
  // FrameAck. False: as fast as the connection takes them.
  bool acknowledged = false;
  std::vector<std::string> settings;  // "name=value", override the server's settings
  // The explicit camera moves with the subject, and its field of view applies to the shorter side
  // of the picture, as with camera presets.
  bool camera_follows = false;
  // The video codecs that the client decodes (kH264). With `acknowledged`, the server may send
  // moving pictures in one of them instead of `format`. Unknown names are ignored.
  std::vector<std::string> codecs;
};

// The name of H.264 in SubscribePictures::codecs: constrained baseline, Annex B, every picture
// shown at once.
inline constexpr std::string_view kH264 = "h264";

// Replaces the complete view of the picture subscription in header.stream. The server replies only
// on failure. Ignores subject, wait and acknowledged.
struct UpdatePictures {
  SubscribePictures pictures;
};

// Client to server: the client has shown this picture and all earlier ones. header.stream is the
// subscription.
struct FrameAck {
  std::uint32_t number = 0;  // ImageFrame::number, from 1
  // The client cannot decode the pictures that follow until one with ImageFrame::key.
  bool needs_key = false;
  // Time between the arrival of the picture and this message, in microseconds, so that the server
  // does not mistake a slow client for a slow network.
  std::uint32_t held_us = 0;
};

// Ends the subscription in header.stream.
struct Unsubscribe {};

// Confirms a subscription. header.stream is the id of the subscription and header.sequence that of
// the request. The server sends it again when the names change (another rig or skeleton), before
// the first frame that uses them.
struct SubscribeReply {
  std::string subject;             // the chosen subject; empty while waiting
  std::uint64_t names_hash = 0;    // NamesHash(names); 0 while unknown, and for pictures
  std::vector<std::string> names;  // of the values of a WeightFrame, in the same order
  // Poses: the publisher's session, which tells a restart from a jump in the sequence. Otherwise 0.
  std::uint64_t publisher_session = 0;
  // Of the server's right to serve the subject, in a cluster: a client drops what comes from a
  // lower one. 0 without a cluster.
  std::uint64_t epoch = 0;
};

// Requests the list of live subjects. TCP only.
struct ListSubjects {
  bool follow = false;  // true: send the list again whenever it changes
};

// The list of live subjects: the reply to ListSubjects. header.sequence is that of the request.
struct Subjects {
  std::vector<std::string> names;  // in order of arrival; at most kMaxListedSubjects
  std::uint32_t total = 0;         // number of live subjects, including those not listed
};

// Tells a subscription with `every` (header.stream) how many frames it has lost. Sent at most once
// per second while the number grows.
struct Dropped {
  std::uint64_t frames = 0;  // frames dropped since the subscription began
};

// The values of a weight subscription for one pose. header.stream is the subscription;
// header.sequence and capture_time_us are those of the pose.
struct WeightFrame {
  std::uint64_t names_hash = 0;  // the last SubscribeReply with this hash names the values
  std::int64_t age_us = 0;       // 0 for a new pose; without new poses, time since the last one
  WeightFormat format = WeightFormat::kF32;
  std::vector<float> values;              // decoded to [0, 1] in both formats
  std::optional<Timecode> timecode = {};  // of the pose
};

// A picture of a subscription. TCP and WebSocket only. The header is as for WeightFrame.
struct ImageFrame {
  std::uint16_t width = 0;  // pixels
  std::uint16_t height = 0;
  ImageFormat format = ImageFormat::kJpeg;
  std::int64_t age_us = 0;          // as in WeightFrame
  std::vector<std::uint8_t> bytes;  // the encoded file
  std::uint32_t number = 0;         // from 1, for subscriptions with acknowledged; otherwise 0
  std::uint8_t tier = 0;            // quality: 0 is best; below kNumPictureTiers
  bool still = false;               // the refined picture of a pose at rest
  std::uint32_t dropped = 0;        // poses not drawn so far because acknowledgements were missing
  std::int64_t received_us = 0;     // arrival of the pose, on the clock of Pong::server_time_us
  std::uint32_t view_request = 0;   // sequence of the SubscribePictures or UpdatePictures it obeys
  // RFC 6381, such as "avc1.42c01f": `bytes` are one access unit of this video. Empty: `bytes` are
  // a file of `format`.
  std::string codec;
  bool key = false;  // a video picture that needs no earlier one
  // Share of the width and height at which the scene was drawn, [1, 100]. Below 100, the picture is
  // enlarged, with the help of former pictures if there are any.
  std::uint8_t drawn_percent = 100;
};

}  // namespace furrow::protocol
