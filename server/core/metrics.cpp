// SPDX-License-Identifier: Apache-2.0
#include "server/core/metrics.h"

#include <algorithm>
#include <iterator>

namespace furrow::server {
namespace {

// Prometheus conventions: snake_case, and counters end with _total.
struct CounterInfo {
  Counter counter;
  std::string_view name;
  std::string_view help;
};

// In the order of the enumeration, which the assertion below checks.
constexpr CounterInfo kCounters[] = {
    {Counter::kDatagramsReceived, "furrow_datagrams_received_total", "UDP datagrams received."},
    {Counter::kDatagramsSent, "furrow_datagrams_sent_total", "UDP datagrams sent."},
    {Counter::kDatagramsOverrun, "furrow_datagrams_overrun_total",
     "Datagrams that the kernel lost because the socket buffer was full."},
    {Counter::kDatagramsMalformed, "furrow_datagrams_malformed_total",
     "Datagrams without a valid envelope."},
    {Counter::kDatagramsUnsendable, "furrow_datagrams_unsendable_total",
     "Datagrams that the kernel did not accept: full send buffer or unreachable address."},
    {Counter::kDatagramsUnproven, "furrow_datagrams_unproven_total",
     "Datagrams from addresses that are not proven, or with another session than their address."},
    {Counter::kHandshakes, "furrow_handshakes_total", "Secure sessions that began."},
    {Counter::kHandshakeRetries, "furrow_handshake_retries_total",
     "Clients asked to prove their address before a handshake."},
    {Counter::kSealedForged, "furrow_sealed_forged_total",
     "Sealed datagrams with a wrong tag, a wrong header or an old key."},
    {Counter::kSealedReplayed, "furrow_sealed_replayed_total",
     "Sealed datagrams received before, or too late to tell."},
    {Counter::kFragmentsMalformed, "furrow_fragments_malformed_total",
     "Fragments with an invalid header."},
    {Counter::kFragmentsRefused, "furrow_fragments_refused_total",
     "Fragments over the limits of reassembly."},
    {Counter::kFragmentsExpired, "furrow_fragments_expired_total",
     "Messages dropped because some of their fragments never arrived, or for lack of memory."},
    {Counter::kConnectionsAccepted, "furrow_connections_accepted_total",
     "TCP connections accepted."},
    {Counter::kConnectionsRefused, "furrow_connections_refused_total",
     "Connections refused because of the connection limit."},
    {Counter::kConnectionsMalformed, "furrow_connections_malformed_total",
     "Connections closed because of an invalid frame."},
    {Counter::kConnectionsOverrun, "furrow_connections_overrun_total",
     "Connections closed because the client did not read its replies, or sent too fast."},
    {Counter::kConnectionsIdle, "furrow_connections_idle_total",
     "Connections closed because the peer neither sent nor read in time."},
    {Counter::kMessagesBundled, "furrow_messages_bundled_total",
     "Messages sent in a datagram together with others."},
    {Counter::kMessagesReceived, "furrow_messages_received_total",
     "Messages received on all transports."},
    {Counter::kMessagesThrottled, "furrow_messages_throttled_total",
     "Messages dropped unread because the peer exceeded its packet rate."},
    {Counter::kMessagesMalformed, "furrow_messages_malformed_total",
     "Messages that could not be read, except poses."},
    {Counter::kMessagesRefused, "furrow_messages_refused_total",
     "Errors sent in reply to messages and connections."},
    {Counter::kRepliesWithoutConsent, "furrow_replies_without_consent_total",
     "Replies not sent because a UDP address had answered no challenge for too long."},
    {Counter::kRefusedNoToken, "furrow_refused_no_token_total",
     "Datagrams, connections and requests refused because they show no token."},
    {Counter::kRefusedUnknownSession, "furrow_refused_unknown_session_total",
     "Sealed datagrams of sessions that have ended or never existed."},
    {Counter::kRefusedUnknownKey, "furrow_refused_unknown_key_total",
     "Tokens refused because their key is not in the key file."},
    {Counter::kRefusedExpired, "furrow_refused_expired_total",
     "Tokens refused because they, or their keys, have expired."},
    {Counter::kRefusedForgedToken, "furrow_refused_forged_token_total",
     "Tokens refused because they were changed or sealed with another key."},
    {Counter::kRefusedWrongServer, "furrow_refused_wrong_server_total",
     "Tokens refused because they are for another server."},
    {Counter::kRefusedTokenInUse, "furrow_refused_token_in_use_total",
     "Tokens refused because another host uses them."},
    {Counter::kRefusedForgedHandshake, "furrow_refused_forged_handshake_total",
     "Handshakes that do not prove the key of their token."},
    {Counter::kRefusedBusy, "furrow_refused_busy_total",
     "Handshakes beyond the budget of a host, of a token, or of all."},
    {Counter::kRefusedFull, "furrow_refused_full_total",
     "Handshakes refused because no session was free."},
    {Counter::kRefusedMalformed, "furrow_refused_malformed_total",
     "Handshakes and tokens that could not be read."},
    {Counter::kRefusedInClear, "furrow_refused_in_clear_total",
     "Tokens refused because they came over the network without encryption."},
    {Counter::kRefusedPublish, "furrow_refused_publish_total",
     "Skeleton offers refused because the token does not allow the subject."},
    {Counter::kRefusedWatch, "furrow_refused_watch_total",
     "Requests for subjects refused because the token does not allow to watch them."},
    {Counter::kRefusedDirect, "furrow_refused_direct_total",
     "Changes refused because the token lacks the role direct."},
    {Counter::kRefusedOperate, "furrow_refused_operate_total",
     "Requests refused because the token lacks the role operate."},
    {Counter::kTokensEnded, "furrow_tokens_ended_total",
     "Peers that were cut off because their token expired or its key was retired."},
    {Counter::kPosesReceived, "furrow_poses_received_total", "Poses received."},
    {Counter::kPosesLate, "furrow_poses_late_total",
     "Poses dropped because a newer one had been used or the subject had ended."},
    {Counter::kPosesDuplicate, "furrow_poses_duplicate_total", "Poses received more than once."},
    {Counter::kPosesInvalid, "furrow_poses_invalid_total",
     "Poses with wrong counts, non-finite numbers or unnormalised quaternions."},
    {Counter::kPosesUnknownStream, "furrow_poses_unknown_stream_total",
     "Poses of streams that have offered no skeleton."},
    {Counter::kPosesRecovered, "furrow_poses_recovered_total",
     "Poses whose own datagram was late or lost, taken from the next one."},
    {Counter::kPosesHeld, "furrow_poses_held_total", "Poses that waited in a jitter buffer."},
    {Counter::kPosesHeldFull, "furrow_poses_held_full_total",
     "Poses that left a jitter buffer before their time because it was full."},
    {Counter::kSkeletonsOffered, "furrow_skeletons_offered_total", "Skeleton offers received."},
    {Counter::kSkeletonsRejected, "furrow_skeletons_rejected_total", "Skeleton offers rejected."},
    {Counter::kSkeletonsRequested, "furrow_skeletons_requested_total",
     "Requests sent for the skeleton of an unknown stream."},
    {Counter::kSkeletonsThrottled, "furrow_skeletons_throttled_total",
     "New skeletons dropped because too many arrived per second; senders offer them again."},
    {Counter::kSubjectsRestarted, "furrow_subjects_restarted_total",
     "Subjects taken over by a new stream."},
    {Counter::kSubjectsContested, "furrow_subjects_contested_total",
     "Skeleton offers refused because another sender is sending the subject."},
    {Counter::kSubjectsLost, "furrow_subjects_lost_total",
     "Subjects that stopped sending and decayed to neutral."},
    {Counter::kSubscriptionsAccepted, "furrow_subscriptions_accepted_total",
     "Subscriptions accepted."},
    {Counter::kSubscriptionsRefused, "furrow_subscriptions_refused_total",
     "Subscriptions refused."},
    {Counter::kWeightsSent, "furrow_weights_sent_total", "Weight frames sent or queued."},
    {Counter::kFramesSkippedRate, "furrow_frames_skipped_rate_total",
     "Frames skipped because of a subscription's maximum rate."},
    {Counter::kWeightsDroppedSlow, "furrow_weights_dropped_slow_total",
     "Weight frames dropped because a subscriber was slow."},
    {Counter::kPosesRelayed, "furrow_poses_relayed_total",
     "Pose frames sent or queued to subscribers of poses."},
    {Counter::kPosesDroppedSlow, "furrow_poses_dropped_slow_total",
     "Pose frames dropped because a subscriber was slow."},
    {Counter::kPicturesRendered, "furrow_pictures_rendered_total", "Pictures rendered."},
    {Counter::kPicturesEncoded, "furrow_pictures_encoded_total",
     "Pictures encoded as JPEG or PNG."},
    {Counter::kPicturesSent, "furrow_pictures_sent_total", "Pictures sent or queued."},
    {Counter::kPicturesDroppedSlow, "furrow_pictures_dropped_slow_total",
     "Pictures dropped because a viewer was slow."},
    {Counter::kPicturesFailed, "furrow_pictures_failed_total",
     "Pictures that could not be rendered, encoded or sent."},
    {Counter::kSnapshotsReplaced, "furrow_snapshots_replaced_total",
     "Render requests replaced by a newer pose before rendering started."},
    {Counter::kRendererRestarts, "furrow_renderer_restarts_total",
     "Renderers lost and created again."},
    {Counter::kAllocationsFailed, "furrow_allocations_failed_total",
     "Datagrams and requests dropped for lack of memory."},
    {Counter::kMocapPackets, "furrow_mocap_packets_total", "Packets received on mocap ports."},
    {Counter::kMocapMalformed, "furrow_mocap_malformed_total",
     "Mocap packets that could not be read."},
    {Counter::kMocapReordered, "furrow_mocap_reordered_total",
     "Mocap frames dropped because a newer one had been used."},
    {Counter::kMocapIncomplete, "furrow_mocap_incomplete_total",
     "Mocap frames used without an end-of-frame mark."},
    {Counter::kMocapStale, "furrow_mocap_stale_total",
     "Mocap frames from senders that reported no tracking."},
    {Counter::kMocapFrames, "furrow_mocap_frames_total", "Mocap frames used."},
    {Counter::kMocapLockedOut, "furrow_mocap_locked_out_total",
     "Mocap packets from senders that the port does not accept."},
    {Counter::kMocapRefused, "furrow_mocap_refused_total",
     "Mocap frames of subjects that were refused."},
    {Counter::kOscPacketsSent, "furrow_osc_packets_sent_total", "OSC packets sent."},
    {Counter::kOscPacketsUnsendable, "furrow_osc_packets_unsendable_total",
     "OSC packets that the kernel did not accept."},
    {Counter::kHttpConnections, "furrow_http_connections_accepted_total",
     "HTTP connections accepted."},
    {Counter::kHttpRequests, "furrow_http_requests_total", "HTTP requests received."},
    {Counter::kHttpRefused, "furrow_http_refused_total",
     "HTTP requests refused: malformed, too large, or with a forbidden Host or Origin."},
    {Counter::kWebSocketsAccepted, "furrow_web_sockets_accepted_total", "WebSockets accepted."},
    {Counter::kRecordingMessages, "furrow_recording_messages_total", "Messages written to a take."},
    {Counter::kRecordingDropped, "furrow_recording_dropped_total",
     "Messages missing from a take because the disk was too slow."},
    {Counter::kRecordingFailures, "furrow_recording_failures_total",
     "Recordings ended by an error."},
};

// The look-ups below use a counter's value as the index.
constexpr bool IsInOrder() {
  std::size_t index = 0;
  return std::ranges::all_of(kCounters, [&](const CounterInfo& info) {
    return static_cast<std::size_t>(info.counter) == index++;
  });
}
static_assert(std::size(kCounters) == static_cast<std::size_t>(Counter::kCount));
static_assert(IsInOrder());

}  // namespace

std::string_view CounterName(Counter counter) {
  return kCounters[static_cast<std::size_t>(counter)].name;
}

std::string_view CounterHelp(Counter counter) {
  return kCounters[static_cast<std::size_t>(counter)].help;
}

}  // namespace furrow::server
