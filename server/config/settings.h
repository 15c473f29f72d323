// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string_view>

#include "server/config/config.h"

// The settings of the configuration file: one row each, from which reading, listing, checking and
// reloading follow. A new setting needs a field in Config, a row here and a line in
// furrow.example.toml. command_line.cpp declares the flags.
namespace furrow::server {

// The numbers that a setting may have. NaN is in no range.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool excludes_least = false;
  std::string_view words = {};  // the range in messages; empty: "<least> to <most>"
};

// Written so that NaN fails.
constexpr bool Contains(const Range& range, double value) {
  return (range.excludes_least ? value > range.least : value >= range.least) && value <= range.most;
}

inline constexpr Range kPortNumber{.least = 0, .most = 65'535};
inline constexpr Range kThreadCount{.least = 1, .most = kMaxThreads};
inline constexpr Range kBusyPollTime{
    .least = 0, .most = kMaxBusyPollUs, .words = "0 to 100000 microseconds"};
inline constexpr Range kRotation{.least = 0, .most = 1e9, .words = "0 to 1e9"};
// Values from a file are not trusted: zero would refuse everybody, and huge ones overflow durations
// in nanoseconds. 1e9 s still fits into 64 bits.
inline constexpr Range kSomeCount{.least = 1, .most = 1'000'000};
inline constexpr Range kRateOrTime{
    .least = 0, .most = 1e9, .excludes_least = true, .words = "greater than 0 and at most 1e9"};
inline constexpr Range kPixelBudget{
    .least = 0, .most = kMaxMegapixelsPerSecond, .words = "0 (no limit) to 1000000"};
// Part of something.
inline constexpr Range kShare{
    .least = 0, .most = 1, .excludes_least = true, .words = "more than 0 and at most 1"};
// A peer's subscription ids are 16 bits and not 0.
inline constexpr Range kSubscriptionCount{.least = 1, .most = 65'535};
// Not more than HandshakePlaces::kPlaces.
inline constexpr Range kStrangerCount{.least = 1, .most = 256};
// One host alone gets half, in which the largest picture must fit twice: while a snapshot is sent.
inline constexpr Range kWaitingMegabytes{.least = 72, .most = 1'000'000};

// How a setting that names a file is written.
enum class Naming {
  kPath,     // always a file, relative to the folder of the configuration
  kShipped,  // a file if it has a dot or a slash, else the name of something shipped
  kJson,     // a file if it has a slash or ends with ".json", else a name
};

// A setting without its value.
struct Setting {
  std::string_view key;           // in the file: "listen.threads"
  Range range = {};               // of a number
  std::string_view flag = {};     // the name in messages about the range; empty: the key
  Naming naming = Naming::kPath;  // of a path; a string with kPath is plain text
  bool is_live = false;           // a reload changes it; see MustWait() in reload_plan.cpp
};

// These call `visit(setting, field...)` for every setting, with its field in each of the
// configurations: of one to read, list or check it, of two to compare them.
template <class Visit, class... Configs>
void VisitInputs(const Visit& visit, Configs&... c) {
  visit({.key = "character", .naming = Naming::kShipped}, c.character...);
  visit({.key = "rig", .naming = Naming::kJson, .is_live = true}, c.rig...);
  visit({.key = "play", .naming = Naming::kShipped}, c.play...);
  visit({.key = "bvh_positions"}, c.bvh_positions...);
  visit({.key = "up_axis"}, c.up_axis...);
  visit({.key = "rest_frame"}, c.rest_frame...);
  visit({.key = "skeleton_map", .naming = Naming::kJson, .is_live = true}, c.skeleton_map...);
  visit({.key = "shape_map", .naming = Naming::kJson, .is_live = true}, c.shape_map...);
}

template <class Visit, class... Configs>
void VisitNetwork(const Visit& visit, Configs&... c) {
  visit({.key = "listen.bind"}, c.bind...);
  visit({.key = "listen.open"}, c.open...);
  visit({.key = "listen.tcp"}, c.tcp...);
  visit({.key = "listen.udp"}, c.udp...);
  visit({.key = "listen.threads", .range = kThreadCount, .flag = "--threads"}, c.threads...);
  visit({.key = "listen.busy_poll_us", .range = kBusyPollTime, .flag = "--busy-poll"},
        c.busy_poll_us...);
  visit({.key = "listen.jitter_buffer"}, c.jitter...);
  visit({.key = "security.mode"}, c.security.mode...);
  visit({.key = "security.keys", .is_live = true}, c.security.keys...);
  visit({.key = "security.name"}, c.security.name...);
  visit({.key = "security.tokens_in_clear"}, c.security.tokens_in_clear...);
  visit({.key = "security.confine"}, c.security.confine...);
  visit({.key = "tls.certificate", .is_live = true}, c.security.tls.certificate...);
  visit({.key = "tls.key", .is_live = true}, c.security.tls.key...);
  visit({.key = "tls.client_authority", .is_live = true}, c.security.tls.client_authority...);
  visit({.key = "mocap.vmc"}, c.vmc...);
  visit({.key = "mocap.livelink_face"}, c.livelink_face...);
  visit({.key = "mocap.allow", .is_live = true}, c.mocap_allow...);
}

template <class Visit, class... Configs>
void VisitOutputs(const Visit& visit, Configs&... c) {
  visit({.key = "render.enabled"}, c.render...);
  visit({.key = "render.required"}, c.require_render...);
  visit({.key = "render.settings"}, c.render_settings...);
  visit({.key = "render.device"}, c.render_device...);
  visit({.key = "render.max_video_encoders", .range = {.least = 0, .most = 1000}},
        c.max_video_encoders...);
  visit({.key = "render.max_host_megapixels_per_second", .range = kPixelBudget},
        c.max_host_megapixels_per_second...);
  visit({.key = "render.max_megapixels_per_second", .range = kPixelBudget},
        c.max_megapixels_per_second...);
  visit({.key = "osc.out"}, c.osc_out...);
  visit({.key = "osc.prefix"}, c.osc_prefix...);
  visit({.key = "osc.allow", .is_live = true}, c.osc.allow...);
  visit({.key = "osc.target"}, c.osc.targets...);
  visit({.key = "record.dir"}, c.record.folder...);
  visit({.key = "record.rotate_megabytes", .range = kRotation}, c.record.rotate_megabytes...);
  visit({.key = "record.rotate_seconds", .range = kRotation}, c.record.rotate_seconds...);
  visit({.key = "record.datagrams"}, c.record.datagrams...);
}

template <class Visit, class... Configs>
void VisitServices(const Visit& visit, Configs&... c) {
  visit({.key = "http.enabled"}, c.http.enabled...);
  visit({.key = "http.port"}, c.http.port...);
  visit({.key = "http.allow_hosts", .is_live = true}, c.http.allow_hosts...);
  visit({.key = "http.allow_origins", .is_live = true}, c.http.allow_origins...);
  visit({.key = "http.max_connections", .range = kSomeCount, .is_live = true},
        c.http.max_connections...);
  visit({.key = "http.api_share", .range = kShare, .is_live = true}, c.http.api_share...);
  visit({.key = "http.requests_per_second", .range = kSomeCount, .is_live = true},
        c.http.requests_per_second...);
  visit({.key = "http.max_upload_megabytes",
         .range = {.least = 0, .most = HttpConfig::kMostUploadMegabytes},
         .is_live = true},
        c.http.max_upload_megabytes...);
  visit({.key = "http.page"}, c.http.page...);
  visit({.key = "cluster.store"}, c.cluster.store...);
  visit({.key = "cluster.nodes"}, c.cluster.nodes...);
  visit({.key = "cluster.bucket"}, c.cluster.bucket...);
  visit({.key = "cluster.advertise"}, c.cluster.advertise...);
  visit({.key = "cluster.credentials"}, c.cluster.credentials...);
  visit({.key = "cluster.authority"}, c.cluster.authority...);
  visit({.key = "cluster.strict"}, c.cluster.strict...);
  visit({.key = "log.level", .is_live = true}, c.log_level...);
  visit({.key = "log.verbose", .is_live = true}, c.verbose...);
  visit({.key = "log.json"}, c.log_json...);
}

template <class Visit, class... AllLimits>
void VisitLimits(const Visit& visit, AllLimits&... l) {
  const auto live = [&](std::string_view key, const Range& range, auto&... fields) {
    visit({.key = key, .range = range, .is_live = true}, fields...);
  };
  live("limits.max_connections", kSomeCount, l.max_connections...);
  visit({.key = "limits.max_udp_peers", .range = kSomeCount}, l.max_udp_peers...);
  live("limits.max_subjects", kSomeCount, l.max_subjects...);
  live("limits.max_strangers_per_host", kStrangerCount, l.max_strangers_per_host...);
  live("limits.max_skeletons", kSomeCount, l.max_skeletons...);
  live("limits.max_subscriptions", kSubscriptionCount, l.max_subscriptions...);
  live("limits.max_all_subscriptions", kSomeCount, l.max_all_subscriptions...);
  live("limits.packets_per_second", kRateOrTime, l.packets_per_second...);
  live("limits.packet_burst", kRateOrTime, l.packet_burst...);
  live("limits.max_waiting_megabytes", kWaitingMegabytes, l.max_waiting_megabytes...);
  live("limits.outbox_messages", kSomeCount, l.outbox_messages...);
  live("limits.idle_seconds", kRateOrTime, l.idle_seconds...);
  live("limits.loss_seconds", kRateOrTime, l.loss_seconds...);
  live("limits.drain_seconds", kRateOrTime, l.drain_seconds...);
}

// In the order of furrow.example.toml. Settings of one table are neighbours.
template <class Visit, class... Configs>
void VisitSettings(const Visit& visit, Configs&... configs) {
  VisitInputs(visit, configs...);
  VisitNetwork(visit, configs...);
  VisitOutputs(visit, configs...);
  VisitServices(visit, configs...);
  VisitLimits(visit, configs.limits...);
}

}  // namespace furrow::server
