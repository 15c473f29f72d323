// SPDX-License-Identifier: Apache-2.0
// Writes the example messages of protocol/vectors. Usage: furrow-make-vectors [--check] FOLDER.
// --check writes nothing and fails if a committed file differs from the encoder's output.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <span>

#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/bytes.h"
#include "protocol/messages/hash.h"
#include "protocol/vectors/fields.h"
#include "protocol/vectors/json.h"
#include "protocol/vectors/vector_files.h"

namespace furrow::protocol::vectors {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Header kHeader{0x0123456789abcdefULL, 3, 41, 1'700'000'000'123'456};

std::string Text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

std::string Document(const std::string& container, const MessageView& view, const Fields& fields) {
  const Header& header = view.header;
  return Json(Fields{{"container", Json(container)},
                     {"kind", Json(MessageKindName(view.kind))},
                     {"session", JsonHex(header.session)},
                     {"stream", Json(int{header.stream})},
                     {"sequence", Json(static_cast<std::int64_t>(header.sequence))},
                     {"capture_time_us", Json(header.capture_time_us)},
                     {"message", Json(fields, "  ")}}) +
         "\n";
}

// Encodes a message, decodes it and adds both files. The JSON states the decoded message, so packed
// numbers have the values that a receiver gets. Exits if an example does not decode.
template <class Message, class... Options>
Bytes AddWithHeader(Files& files, const std::string& name, const Header& header,
                    const Message& message, const Options&... options) {
  Encoder encoder;
  Bytes bytes;
  encoder.Encode(header, message, bytes, options...);
  MessageView view;
  Message decoded;
  DecodeStatus status = OpenMessage(bytes, view);
  if (status == DecodeStatus::kOk) status = Decode(view, decoded);
  if (status != DecodeStatus::kOk) {
    std::cerr << name << ": " << DecodeStatusName(status) << "\n";
    std::exit(1);
  }
  files[name + ".bin"] = Text(bytes);
  files[name + ".json"] = Document("message", view, FieldsOf(decoded));
  return bytes;
}

template <class Message, class... Options>
Bytes Add(Files& files, const std::string& name, const Message& message,
          const Options&... options) {
  return AddWithHeader(files, name, kHeader, message, options...);
}

// Literal numbers, because sine and cosine would tie the files to one C library.
constexpr std::array<Quat, 5> kTurns = {{{0.0f, 0.0f, 0.0f, 1.0f},
                                         {0.2f, 0.4f, -0.4f, 0.8f},
                                         {0.5f, -0.5f, 0.5f, -0.5f},
                                         {-0.1f, 0.7f, -0.5f, 0.5f},
                                         {0.0f, 0.0f, -0.6f, 0.8f}}};

SkeletonOffer SmallOffer() {
  SkeletonOffer offer;
  offer.subject = "\u00c5nna \"1\"";
  offer.metres_per_unit = 0.01f;
  offer.joints.resize(5);
  const char* names[] = {"hips", "spine", "head", "jaw", "eye_l"};
  for (std::size_t i = 0; i < offer.joints.size(); ++i) {
    offer.joints[i].name = names[i];
    offer.joints[i].parent = static_cast<std::int16_t>(i == 4 ? 2 : static_cast<int>(i) - 1);
    offer.joints[i].rest_translation = {0.5f * static_cast<float>(i), 10.0f, -0.25f};
  }
  offer.joints[2].rest_rotation = kTurns[1];
  offer.joints[3].has_tail = offer.joints[4].has_tail = true;
  offer.joints[3].tail = {0.0f, -2.0f, 6.0f};
  offer.joints[4].tail = {0.0f, 0.0f, 1.5f};
  offer.blend_shape_names = {"jawOpen", "browInnerUp", "cheekPuff"};
  return offer;
}

SkeletonOffer LargeOffer() {
  SkeletonOffer offer;
  offer.subject = "large";
  offer.joints.resize(163);
  for (std::size_t i = 0; i < offer.joints.size(); ++i) {
    offer.joints[i].name = "joint_with_a_long_name." + std::to_string(i);
    offer.joints[i].parent = static_cast<std::int16_t>(static_cast<int>(i + 1) / 2 - 1);
    offer.joints[i].rest_translation = {0.0f, 0.125f * static_cast<float>(i % 8), 0.0f};
  }
  offer.joints[7].rest_scale = {1.0f, 2.0f, 1.0f};
  return offer;
}

PoseFrame SmallPose() {
  PoseFrame pose;
  pose.skeleton_hash = SkeletonHash(SmallOffer());
  pose.num_joints = 5;
  pose.num_blend_shapes = 3;
  for (int i = 0; i < 5; ++i) {
    pose.rotation_joints.push_back(static_cast<std::uint16_t>(i));
    pose.rotations.push_back(kTurns[static_cast<std::size_t>(i)]);
  }
  pose.translation_joints = {0, 3};
  pose.translations = {{12.5f, -1.0f, 300.0f}, {0.0f, -0.75f, 0.125f}};
  pose.blend_shape_indices = {0, 1, 2};
  pose.blend_shapes = {0.5f, 0.0f, 1.0f};
  return pose;
}

// Repeats the pose before it, which is at rest but for one joint.
PoseFrame RepeatingPose() {
  PoseFrame before;
  before.skeleton_hash = SkeletonHash(SmallOffer());
  before.num_joints = 5;
  before.num_blend_shapes = 3;
  before.rotation_joints = {1};
  before.rotations = {kTurns[1]};
  Encoder encoder;
  std::vector<std::uint8_t> message;
  encoder.Encode({.session = 1}, before, message, PoseEncoding::Small());
  PoseFrame pose = SmallPose();
  pose.previous.assign(message.begin() + kEnvelopeBytes, message.end());
  pose.previous_age_us = 16'667;
  return pose;
}

// Frame 17,982 of drop-frame timecode is 00:10:00;00.
constexpr Timecode kTenMinutes{.frame = 17'982,
                               .rate_numerator = 30'000,
                               .rate_denominator = 1001,
                               .subframe = 64,
                               .drop_frame = true};

PoseFrame PoseWithTimecode(const Timecode& timecode) {
  PoseFrame pose = SmallPose();
  pose.timecode = timecode;
  return pose;
}

PoseFrame PartialPose() {
  PoseFrame pose = SmallPose();
  pose.partial = true;
  pose.rotation_joints = {1, 4};
  pose.rotations = {kTurns[3], kTurns[4]};
  pose.scale_joints = {2};
  pose.scales = {{1.0f, 1.25f, 1.0f}};
  pose.blend_shape_indices = {1};
  pose.blend_shapes = {-0.375f};
  return pose;
}

SubscribePictures PicturesWithCamera() {
  SubscribePictures pictures;
  pictures.subject = "anna";
  pictures.width = 1280;
  pictures.height = 720;
  pictures.max_rate_hz = 25.0f;
  pictures.format = ImageFormat::kPng;
  pictures.view = "weights";
  pictures.has_camera = true;
  pictures.camera = {{0.5f, 1.5f, 3.0f}, {0.0f, 1.5f, 0.0f}, 24.0f};
  return pictures;
}

SubscribePictures ViewersPictures() {
  SubscribePictures pictures = PicturesWithCamera();
  pictures.format = ImageFormat::kJpeg;
  pictures.acknowledged = true;
  pictures.settings = {"shading=skin", "wrinkles=off"};
  pictures.camera_follows = true;
  return pictures;
}

void AddMeeting(Files& files) {
  Add(files, "hello", Hello{"example/1.0", 0});
  Add(files, "hello_token", Hello{"example/1.0", 0xfedcba9876543210ULL});
  Add(files, "hello_bundles", Hello{"example/1.0", 0xfedcba9876543210ULL, true});
  Add(files, "hello_access", Hello{"example/1.0", 0, false, "frw1_an_example_that_is_no_token"});
  Add(files, "welcome", Welcome{"furrowd/0.1.0", 0xfedcba9876543210ULL});
  Add(files, "welcome_others",
      Welcome{"furrowd/0.1.0", 0, {"10.0.0.2:7400:7401", "node-c:7400:7401"}});
  Add(files, "ping", Ping{-5});
  Add(files, "pong", Pong{-5, 1'234'567'890'123});
  Add(files, "goodbye", Goodbye{GoodbyeReason::kSubjectGone});
  Add(files, "error", ErrorMessage{ErrorCode::kUnknownSubject, "no subject 'bob'; there is: anna"});
  Add(files, "error_elsewhere",
      ErrorMessage{ErrorCode::kUnknownSubject, "'anna' is served by the node 'b'", "10.0.0.2", 7400,
                   7401});
  Add(files, "error_elsewhere_web",
      ErrorMessage{ErrorCode::kUnknownSubject, "'anna' is served by the node 'b'", "node-b", 7400,
                   7401, 7480, true});
}

void AddPublishing(Files& files) {
  Add(files, "skeleton_offer", SmallOffer());
  SkeletonOffer shapes;
  shapes.subject = "phone";
  shapes.blend_shape_names = {"jawOpen"};
  Add(files, "skeleton_offer_shapes", shapes);
  Add(files, "skeleton_reply", SkeletonReply{7, SkeletonStatus::kRejected, "too many joints"});
  Add(files, "skeleton_needed", SkeletonReply{7, SkeletonStatus::kNeeded, ""});
  Add(files, "pose", SmallPose());
  Add(files, "pose_packed", SmallPose(), PoseEncoding::Small());
  Add(files, "pose_previous", RepeatingPose(), PoseEncoding::Small());
  Add(files, "pose_timecode", PoseWithTimecode(kTenMinutes), PoseEncoding::Small());
  // Invalid timecodes, which receivers ignore: a frame after midnight, and a rate of 0.
  Add(files, "pose_timecode_frame", PoseWithTimecode({.frame = 30 * 86'400}));
  Add(files, "pose_timecode_rate", PoseWithTimecode({.rate_numerator = 0}));
  Add(files, "pose_partial", PartialPose());
  Add(files, "pose_partial_packed", PartialPose(), PoseEncoding::Small());
}

// Between servers, and to a server that gives its subjects away.
void AddMoving(Files& files) {
  SubjectState state;
  state.subject = "anna";
  state.skeleton_hash = SmallPose().skeleton_hash;
  state.publisher_session = 0xfedcba9876543210ULL;
  state.run = 0x0123456789abcdefULL;
  const std::vector<std::string> values = {"brow_l.stretch", "brow_l.squash"};
  state.values_hash = NamesHash(values);
  Add(files, "subject_state_new", state);
  state.has_pose = state.has_neutral = true;
  state.pose = state.neutral = SmallPose();
  state.newest_sequence = 4'000'000'000;
  state.num_drivers = kAllDriversOnWire;
  state.filtered = {0.25f, 1.0f};
  state.inputs = {0.5f, 1.0f};
  state.speeds = {-1.5f, 0.0f};
  state.since_input_s = 0.25;
  state.captures = "{\"version\": 1}";
  Add(files, "subject_state", state);
  Add(files, "drain", Drain{true});
  Add(files, "drain_state", DrainState{true, 3, 2, {"anna", "bob"}, "no other node has room"});
}

void AddSubscribing(Files& files) {
  Add(files, "subscribe_weights", SubscribeWeights{});
  Add(files, "subscribe_weights_all",
      SubscribeWeights{"anna", true, "brow_*, knee_?.folds", 30.0f, WeightFormat::kU8,
                       WeightSource::kDriverValues, true});
  Add(files, "subscribe_pictures", SubscribePictures{});
  Add(files, "subscribe_pictures_camera", PicturesWithCamera());
  Add(files, "subscribe_poses", SubscribePoses{});
  Add(files, "subscribe_poses_every", SubscribePoses{"anna", true, 30.0f, true});
  Add(files, "unsubscribe", Unsubscribe{});
  Add(files, "subscribe_reply", SubscribeReply{"anna", 0, {"brow_l.stretch", "brow_l.squash"}});
  Add(files, "subscribe_reply_waiting", SubscribeReply{});
  Add(files, "subscribe_reply_poses", SubscribeReply{"anna", 0, {}, 0xfedcba9876543210ULL});
  Add(files, "subscribe_reply_epoch",
      SubscribeReply{"anna", 0, {"brow_l.stretch"}, 0, 1'700'000'000'001});
  const std::vector<std::string> names = {"brow_l.stretch", "brow_l.squash", "nose.squash"};
  WeightFrame frame{NamesHash(names), 0, WeightFormat::kF32, {0.0f, 0.3f, 1.0f}};
  Add(files, "weights", frame);
  frame.format = WeightFormat::kU8;
  frame.age_us = 250'000;
  Add(files, "weights_u8", frame);
  frame.timecode = Timecode{.frame = 1'234'567, .rate_numerator = 60};
  Add(files, "weights_timecode", frame);
  Add(files, "dropped", Dropped{1234});
  Add(files, "list_subjects", ListSubjects{true});
  Add(files, "subjects", Subjects{{"anna", "bob"}, 2});
  Add(files, "image", ImageFrame{640, 480, ImageFormat::kJpeg, 0, {0xFF, 0xD8, 0xFF, 0xD9}});
}

ImageFrame VideoPicture() {
  ImageFrame image{640, 480, ImageFormat::kJpeg, 0, {0, 0, 0, 1, 0x65, 0x88}};
  image.number = 13;
  image.received_us = 1'700'000'000'123'999;
  image.view_request = 5;
  image.codec = "avc1.42c01e";
  image.key = true;
  image.drawn_percent = 75;
  return image;
}

void AddViewing(Files& files) {
  Add(files, "subscribe_pictures_viewer", ViewersPictures());
  Add(files, "update_pictures", UpdatePictures{ViewersPictures()});
  SubscribePictures video = ViewersPictures();
  video.codecs = {std::string(kH264)};
  Add(files, "subscribe_pictures_video", video);
  Add(files, "frame_ack", FrameAck{12});
  Add(files, "frame_ack_video", FrameAck{13, true, 4200});
  Add(files, "image_video", VideoPicture());
  Add(files, "image_viewer",
      ImageFrame{640,
                 480,
                 ImageFormat::kJpeg,
                 0,
                 {0xFF, 0xD8, 0xFF, 0xD9},
                 12,
                 2,
                 true,
                 7,
                 1'700'000'000'123'999,
                 5});
}

// A message in fragments. The last fragment is first; a length precedes each datagram, as on TCP.
void AddFragments(Files& files) {
  Files ignored;
  const Bytes message = Add(ignored, "large", LargeOffer());
  std::string all;
  std::array<std::uint8_t, kMaxDatagramBytes> datagram;
  for (std::size_t i = NumDatagrams(message.size()); i-- > 0;) {
    const std::size_t size = WriteDatagram(message, 77, i, datagram);
    const auto prefix = FramePrefix(size);
    all.append(prefix.begin(), prefix.end());
    all.append(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(size));
  }
  files["fragments.bin"] = all;
  std::string json = ignored["large.json"];
  const std::string from = "\"message\",";
  json.replace(json.find(from), from.size(), "\"datagrams\",");
  files["fragments.json"] = json;
}

void Refuse(Files& files, const std::string& name, const Bytes& bytes, const std::string& why) {
  files["refuse_" + name + ".bin"] = Text(bytes);
  files["refuse_" + name + ".json"] =
      Json(Fields{{"container", Json(std::string_view("refuse"))}, {"why", Json(why)}}) + "\n";
}

// Messages that share a datagram, and bundles that decoders must reject. The JSON lists the
// messages as if they had been sent alone.
void AddBundles(Files& files) {
  Files alone;
  const std::vector<std::string> names = {"brow_l.stretch", "brow_l.squash", "nose.squash"};
  const WeightFrame frame{NamesHash(names), 0, WeightFormat::kF32, {0.0f, 0.25f, 1.0f}};
  const std::vector<Bytes> messages = {Add(alone, "0", frame), Add(alone, "1", Pong{-5, 7}),
                                       Add(alone, "2", frame)};
  Bytes bundle;
  if (!WriteBundle(messages, bundle)) std::exit(1);
  files["bundle.bin"] = Text(bundle);
  std::string list;
  for (const char* name : {"0.json", "1.json", "2.json"}) {
    list += (list.empty() ? "" : ",\n") + alone[name].substr(0, alone[name].size() - 1);
  }
  files["bundle.json"] = "{\n\"container\": \"bundle\",\n\"messages\": [\n" + list + "\n]\n}\n";
  const auto refuse = [&](const std::string& name, const Bytes& bytes, const std::string& why) {
    Refuse(files, "bundle_" + name, bytes, why);
  };
  Bytes bad = bundle;
  bad.push_back(0);
  refuse("trailing", bad, "a byte after its last message");
  bad = bundle;
  bad.resize(messages[0].size() + messages[1].size());
  refuse("cut", bad, "a message that should be followed and is not");
  bad = bundle;
  bad[messages[0].size() + 5] = kFlagFragment;
  refuse("fragment", bad, "a fragment inside");
  bad = bundle;
  bad[messages[0].size() + 8] ^= 1;
  refuse("session", bad, "messages of two sessions");
  bad = bundle;
  bad[20] = 0xF0;
  refuse("length", bad, "a first message that ends inside the third");
}

// The datagrams of the worked session in STANDARD.md section 13: a publisher sends a skeleton and
// two poses over UDP, and a subscriber proves its address and receives weights. The order follows
// the file names.
void AddSession(Files& files) {
  constexpr std::uint64_t kPublisher = 0x1111111111111111ULL;
  constexpr std::uint64_t kSubscriber = 0x2222222222222222ULL;
  constexpr std::uint64_t kServer = 0x3333333333333333ULL;
  constexpr std::uint64_t kToken = 0x0123456789abcdefULL;
  SkeletonOffer offer;
  offer.subject = "anna";
  offer.joints.resize(2);
  offer.joints[0].name = "neck";
  offer.joints[0].rest_translation = {0.0f, 1.5f, 0.0f};
  offer.joints[1].name = "head";
  offer.joints[1].parent = 0;
  offer.joints[1].rest_translation = {0.0f, 0.125f, 0.0f};
  PoseFrame pose;
  pose.skeleton_hash = SkeletonHash(offer);
  pose.num_joints = 2;
  pose.rotation_joints = {0, 1};
  pose.rotations = {kTurns[0], kTurns[0]};
  const std::vector<std::string> names = {"neck.squash", "neck.stretch"};
  const auto add = [&files](const std::string& name, const Header& header, const auto& message,
                            const auto&... options) {
    AddWithHeader(files, "session_" + name, header, message, options...);
  };
  add("01_skeleton_offer", {.session = kPublisher}, offer);
  add("02_skeleton_reply", {.session = kServer},
      SkeletonReply{pose.skeleton_hash, SkeletonStatus::kAccepted, {}});
  add("03_pose", {.session = kPublisher, .capture_time_us = 1'000'000}, pose,
      PoseEncoding::Small());
  add("04_hello", {.session = kSubscriber}, Hello{"example/1.0", 0});
  add("05_welcome", {.session = kServer}, Welcome{"furrowd", kToken});
  add("06_hello_token", {.session = kSubscriber}, Hello{"example/1.0", kToken});
  add("07_welcome_proven", {.session = kServer}, Welcome{"furrowd", 0});
  add("08_subscribe_weights", {.session = kSubscriber, .sequence = 1},
      SubscribeWeights{.subject = "anna", .pattern = "neck.*", .format = WeightFormat::kU8});
  add("09_subscribe_reply", {.session = kServer, .stream = 1, .sequence = 1},
      SubscribeReply{"anna", 0, names});
  // The turn that makes the neck bend: 0.6 is the sine of half the angle, 0.8 its cosine.
  pose.partial = true;
  pose.rotation_joints = {0};
  pose.rotations = {{0.6f, 0.0f, 0.0f, 0.8f}};
  add("10_pose_partial", {.session = kPublisher, .sequence = 1, .capture_time_us = 1'016'667}, pose,
      PoseEncoding::Small());
  add("11_weights", {.session = kServer, .stream = 1, .sequence = 1, .capture_time_us = 1'016'667},
      WeightFrame{NamesHash(names), 0, WeightFormat::kU8, {0.6f, 0.0f}});
  add("12_goodbye", {.session = kPublisher, .sequence = 2}, Goodbye{});
  add("13_goodbye_subject", {.session = kServer, .stream = 1, .sequence = 1},
      Goodbye{GoodbyeReason::kSubjectGone});
}

// Messages that decoders must reject. Each differs from a good message in one place.
void AddRefused(Files& files) {
  const Bytes pose = Add(files, "pose", SmallPose());
  const auto add = [&files](const std::string& name, const Bytes& bytes, const std::string& why) {
    Refuse(files, name, bytes, why);
  };
  Bytes bytes = pose;
  bytes[0] = 'X';
  add("magic", bytes, "another magic");
  bytes = pose;
  bytes[4] = 2;
  add("version", bytes, "another version");
  bytes = pose;
  bytes[5] = 4;
  add("flags", bytes, "a flag that version 1 does not define");
  bytes = pose;
  std::fill(bytes.begin() + 8, bytes.begin() + 16, std::uint8_t{0});
  add("session", bytes, "session 0");
  bytes = pose;
  bytes.pop_back();
  add("truncated", bytes, "fewer bytes than the payload size says");
  PoseFrame bad = SmallPose();
  Encoder encoder;
  bad.rotations[2].y = std::nanf("");
  encoder.Encode(kHeader, bad, bytes);
  add("nan", bytes, "a rotation that is not a number");
  bad = SmallPose();
  bad.rotations[2].w += 0.25f;
  encoder.Encode(kHeader, bad, bytes);
  add("not_unit", bytes, "a rotation that is not of unit length");
  bad = SmallPose();
  bad.rotations.pop_back();
  bad.rotation_joints.clear();
  encoder.Encode(kHeader, bad, bytes);
  add("count", bytes, "four rotations for five joints, and no mask");
  const Bytes offer = Add(files, "skeleton_offer", SmallOffer());
  bytes = offer;
  const std::string name = "spine";
  *std::search(bytes.begin(), bytes.end(), name.begin(), name.end()) = 'S';
  add("hash", bytes, "an offer whose hash is not that of its content");
  ImageFrame image = VideoPicture();
  image.drawn_percent = 0;
  encoder.Encode(kHeader, image, bytes);
  add("drawn_0", bytes, "a picture of which no share was drawn");
  image.drawn_percent = 101;
  encoder.Encode(kHeader, image, bytes);
  add("drawn_101", bytes, "a picture of which more than all was drawn");
}

}  // namespace

Files MakeFiles() {
  Files files;
  AddMeeting(files);
  AddPublishing(files);
  AddMoving(files);
  AddSubscribing(files);
  AddViewing(files);
  AddFragments(files);
  AddBundles(files);
  AddSession(files);
  AddRefused(files);
  return files;
}

}  // namespace furrow::protocol::vectors

int main(int argc, char** argv) {
  return furrow::protocol::vectors::MakeOrCheck("furrow-make-vectors",
                                                {argv, static_cast<std::size_t>(argc)},
                                                furrow::protocol::vectors::MakeFiles);
}
