// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "protocol/messages/cluster_messages.h"
#include "protocol/messages/messages.h"
#include "protocol/vectors/json.h"

// Converts messages to pairs (field name, value as JSON text), for the JSON file beside each
// example message of protocol/vectors/.
namespace furrow::protocol::vectors {

inline Fields FieldsOf(const Hello& m) {
  return {{"client", Json(m.client)},
          {"token", JsonHex(m.token)},
          {"bundles", Json(m.bundles)},
          {"access", Json(m.access)}};
}
inline Fields FieldsOf(const Welcome& m) {
  Fields fields = {{"server", Json(m.server)}, {"token", JsonHex(m.token)}};
  if (!m.others.empty()) fields.emplace_back("others", Json(m.others));
  return fields;
}
inline Fields FieldsOf(const Ping& m) { return {{"time_us", Json(m.time_us)}}; }
inline Fields FieldsOf(const Pong& m) {
  return {{"time_us", Json(m.time_us)}, {"server_time_us", Json(m.server_time_us)}};
}
inline Fields FieldsOf(const Goodbye& m) { return {{"reason", Json(static_cast<int>(m.reason))}}; }
inline Fields FieldsOf(const ErrorMessage& m) {
  Fields fields = {{"code", Json(static_cast<int>(m.code))}, {"message", Json(m.message)}};
  if (!m.host.empty()) {
    fields.emplace_back("host", Json(m.host));
    fields.emplace_back("tcp", Json(static_cast<int>(m.tcp)));
    fields.emplace_back("udp", Json(static_cast<int>(m.udp)));
  }
  if (!m.host.empty() && m.web != 0) {
    fields.emplace_back("web", Json(static_cast<int>(m.web)));
    fields.emplace_back("web_tls", Json(m.web_tls));
  }
  return fields;
}

inline std::string JointJson(const OfferedJoint& joint) {
  Fields fields = {{"name", Json(joint.name)},
                   {"parent", Json(static_cast<int>(joint.parent))},
                   {"rest_translation", Json(joint.rest_translation)},
                   {"rest_rotation", Json(joint.rest_rotation)},
                   {"rest_scale", Json(joint.rest_scale)}};
  if (joint.has_tail) fields.emplace_back("tail", Json(joint.tail));
  return Json(fields, "    ");
}

inline Fields FieldsOf(const SkeletonOffer& m) {
  std::string joints = "[";
  for (const OfferedJoint& joint : m.joints)
    joints += (joints.size() > 1 ? ", " : "") + JointJson(joint);
  return {{"subject", Json(m.subject)},
          {"skeleton_hash", JsonHex(m.skeleton_hash)},
          {"metres_per_unit", Json(m.metres_per_unit)},
          {"joints", joints + "]"},
          {"blend_shape_names", Json(m.blend_shape_names)}};
}
inline Fields FieldsOf(const SkeletonReply& m) {
  return {{"skeleton_hash", JsonHex(m.skeleton_hash)},
          {"status", Json(static_cast<int>(m.status))},
          {"message", Json(m.message)}};
}
inline void AddTimecode(const std::optional<Timecode>& timecode, Fields& fields) {
  if (!timecode) return;
  fields.emplace_back(
      "timecode",
      Json(Fields{{"frame", Json(static_cast<std::int64_t>(timecode->frame))},
                  {"rate_numerator", Json(static_cast<std::int64_t>(timecode->rate_numerator))},
                  {"rate_denominator", Json(int{timecode->rate_denominator})},
                  {"subframe", Json(int{timecode->subframe})},
                  {"drop_frame", Json(timecode->drop_frame)},
                  {"text", Json(TimecodeText(*timecode))}},
           "    "));
}
inline Fields FieldsOf(const PoseFrame& m) {
  Fields fields = {{"skeleton_hash", JsonHex(m.skeleton_hash)},
                   {"partial", Json(m.partial)},
                   {"num_joints", Json(int{m.num_joints})},
                   {"num_blend_shapes", Json(int{m.num_blend_shapes})},
                   {"rotation_joints", Json(m.rotation_joints)},
                   {"rotations", Json(m.rotations)},
                   {"translation_joints", Json(m.translation_joints)},
                   {"translations", Json(m.translations)},
                   {"scale_joints", Json(m.scale_joints)},
                   {"scales", Json(m.scales)},
                   {"blend_shape_indices", Json(m.blend_shape_indices)},
                   {"blend_shapes", Json(m.blend_shapes)}};
  if (!m.previous.empty()) {
    fields.emplace_back("previous", Json(m.previous));
    fields.emplace_back("previous_age_us", Json(static_cast<std::int64_t>(m.previous_age_us)));
  }
  AddTimecode(m.timecode, fields);
  return fields;
}
inline Fields FieldsOf(const SubscribeWeights& m) {
  return {{"subject", Json(m.subject)},
          {"wait", Json(m.wait)},
          {"pattern", Json(m.pattern)},
          {"max_rate_hz", Json(m.max_rate_hz)},
          {"format", Json(static_cast<int>(m.format))},
          {"source", Json(static_cast<int>(m.source))},
          {"every", Json(m.every)}};
}
inline Fields FieldsOf(const SubscribePictures& m) {
  Fields fields = {{"subject", Json(m.subject)},
                   {"wait", Json(m.wait)},
                   {"width", Json(int{m.width})},
                   {"height", Json(int{m.height})},
                   {"max_rate_hz", Json(m.max_rate_hz)},
                   {"format", Json(static_cast<int>(m.format))},
                   {"quality", Json(int{m.quality})},
                   {"view", Json(m.view)},
                   {"camera_preset", Json(m.camera_preset)}};
  if (m.has_camera) {
    fields.emplace_back("eye", Json(m.camera.eye));
    fields.emplace_back("target", Json(m.camera.target));
    fields.emplace_back("vertical_fov_degrees", Json(m.camera.vertical_fov_degrees));
  }
  fields.emplace_back("acknowledged", Json(m.acknowledged));
  fields.emplace_back("settings", Json(m.settings));
  fields.emplace_back("camera_follows", Json(m.camera_follows));
  fields.emplace_back("codecs", Json(m.codecs));
  return fields;
}
inline Fields FieldsOf(const UpdatePictures& m) { return FieldsOf(m.pictures); }
inline Fields FieldsOf(const FrameAck& m) {
  return {{"number", Json(static_cast<std::int64_t>(m.number))},
          {"needs_key", Json(m.needs_key)},
          {"held_us", Json(static_cast<std::int64_t>(m.held_us))}};
}
inline Fields FieldsOf(const SubscribePoses& m) {
  return {{"subject", Json(m.subject)},
          {"wait", Json(m.wait)},
          {"max_rate_hz", Json(m.max_rate_hz)},
          {"every", Json(m.every)}};
}
inline Fields FieldsOf(const Dropped& m) {
  return {{"frames", Json(static_cast<std::int64_t>(m.frames))}};
}
inline Fields FieldsOf(const ListSubjects& m) { return {{"follow", Json(m.follow)}}; }
inline Fields FieldsOf(const Subjects& m) {
  return {{"names", Json(m.names)}, {"total", Json(static_cast<std::int64_t>(m.total))}};
}
inline Fields FieldsOf(const SubjectState& m) {
  Fields fields = {{"subject", Json(m.subject)},
                   {"skeleton_hash", JsonHex(m.skeleton_hash)},
                   {"publisher_session", JsonHex(m.publisher_session)},
                   {"run", JsonHex(m.run)},
                   {"newest_sequence", Json(static_cast<std::int64_t>(m.newest_sequence))},
                   {"values_hash", JsonHex(m.values_hash)},
                   {"num_drivers", Json(static_cast<std::int64_t>(m.num_drivers))},
                   {"filtered", Json(m.filtered)},
                   {"inputs", Json(m.inputs)},
                   {"speeds", Json(m.speeds)},
                   {"since_input_s", Json(static_cast<float>(m.since_input_s))},
                   {"captures", Json(m.captures)}};
  if (m.has_pose) fields.emplace_back("pose", Json(FieldsOf(m.pose), "    "));
  if (m.has_neutral) fields.emplace_back("neutral", Json(FieldsOf(m.neutral), "    "));
  return fields;
}
inline Fields FieldsOf(const Drain& m) { return {{"begin", Json(m.begin)}}; }
inline Fields FieldsOf(const DrainState& m) {
  return {{"draining", Json(m.draining)},
          {"moved", Json(static_cast<std::int64_t>(m.moved))},
          {"left", Json(static_cast<std::int64_t>(m.left))},
          {"names", Json(m.names)},
          {"why", Json(m.why)}};
}
inline Fields FieldsOf(const Unsubscribe&) { return {}; }
inline Fields FieldsOf(const SubscribeReply& m) {
  Fields fields = {{"subject", Json(m.subject)},
                   {"names_hash", JsonHex(m.names_hash)},
                   {"names", Json(m.names)},
                   {"publisher_session", JsonHex(m.publisher_session)}};
  if (m.epoch != 0) fields.emplace_back("epoch", JsonHex(m.epoch));
  return fields;
}
inline Fields FieldsOf(const WeightFrame& m) {
  Fields fields = {{"names_hash", JsonHex(m.names_hash)},
                   {"age_us", Json(m.age_us)},
                   {"format", Json(static_cast<int>(m.format))},
                   {"values", Json(m.values)}};
  AddTimecode(m.timecode, fields);
  return fields;
}
inline Fields FieldsOf(const ImageFrame& m) {
  return {{"width", Json(int{m.width})},
          {"height", Json(int{m.height})},
          {"format", Json(static_cast<int>(m.format))},
          {"age_us", Json(m.age_us)},
          {"bytes", Json(m.bytes)},
          {"number", Json(static_cast<std::int64_t>(m.number))},
          {"tier", Json(int{m.tier})},
          {"still", Json(m.still)},
          {"dropped", Json(static_cast<std::int64_t>(m.dropped))},
          {"received_us", Json(m.received_us)},
          {"view_request", Json(static_cast<std::int64_t>(m.view_request))},
          {"codec", Json(m.codec)},
          {"key", Json(m.key)},
          {"drawn_percent", Json(int{m.drawn_percent})}};
}

}  // namespace furrow::protocol::vectors
