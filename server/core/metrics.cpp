// SPDX-License-Identifier: Apache-2.0
#include "server/core/metrics.h"

namespace furrow::server {

std::string_view CounterName(Counter counter) {
  switch (counter) {
    case Counter::kDatagramsReceived: return "furrow_datagrams_received_total";
    case Counter::kDatagramsSent: return "furrow_datagrams_sent_total";
    case Counter::kDatagramsOverrun: return "furrow_datagrams_overrun_total";
    case Counter::kDatagramsMalformed: return "furrow_datagrams_malformed_total";
    case Counter::kDatagramsUnsendable: return "furrow_datagrams_unsendable_total";
    case Counter::kDatagramsUnproven: return "furrow_datagrams_unproven_total";
    case Counter::kFragmentsMalformed: return "furrow_fragments_malformed_total";
    case Counter::kFragmentsRefused: return "furrow_fragments_refused_total";
    case Counter::kFragmentsExpired: return "furrow_fragments_expired_total";
    case Counter::kConnectionsAccepted: return "furrow_connections_accepted_total";
    case Counter::kConnectionsRefused: return "furrow_connections_refused_total";
    case Counter::kConnectionsMalformed: return "furrow_connections_malformed_total";
    case Counter::kConnectionsOverrun: return "furrow_connections_overrun_total";
    case Counter::kConnectionsIdle: return "furrow_connections_idle_total";
    case Counter::kMessagesBundled: return "furrow_messages_bundled_total";
    case Counter::kMessagesReceived: return "furrow_messages_received_total";
    case Counter::kMessagesThrottled: return "furrow_messages_throttled_total";
    case Counter::kMessagesMalformed: return "furrow_messages_malformed_total";
    case Counter::kMessagesRefused: return "furrow_messages_refused_total";
    case Counter::kPosesReceived: return "furrow_poses_received_total";
    case Counter::kPosesLate: return "furrow_poses_late_total";
    case Counter::kPosesDuplicate: return "furrow_poses_duplicate_total";
    case Counter::kPosesInvalid: return "furrow_poses_invalid_total";
    case Counter::kPosesUnknownStream: return "furrow_poses_unknown_stream_total";
    case Counter::kPosesRetiredSession: return "furrow_poses_retired_session_total";
    case Counter::kSkeletonsOffered: return "furrow_skeletons_offered_total";
    case Counter::kSkeletonsRejected: return "furrow_skeletons_rejected_total";
    case Counter::kSkeletonsRequested: return "furrow_skeletons_requested_total";
    case Counter::kSkeletonsThrottled: return "furrow_skeletons_throttled_total";
    case Counter::kSubjectsRestarted: return "furrow_subjects_restarted_total";
    case Counter::kSubjectsLost: return "furrow_subjects_lost_total";
    case Counter::kSubscriptionsAccepted: return "furrow_subscriptions_accepted_total";
    case Counter::kSubscriptionsRefused: return "furrow_subscriptions_refused_total";
    case Counter::kWeightsSent: return "furrow_weights_sent_total";
    case Counter::kFramesSkippedRate: return "furrow_frames_skipped_rate_total";
    case Counter::kWeightsDroppedSlow: return "furrow_weights_dropped_slow_total";
    case Counter::kPosesRelayed: return "furrow_poses_relayed_total";
    case Counter::kPosesDroppedSlow: return "furrow_poses_dropped_slow_total";
    case Counter::kPicturesRendered: return "furrow_pictures_rendered_total";
    case Counter::kPicturesEncoded: return "furrow_pictures_encoded_total";
    case Counter::kPicturesSent: return "furrow_pictures_sent_total";
    case Counter::kPicturesDroppedSlow: return "furrow_pictures_dropped_slow_total";
    case Counter::kPicturesFailed: return "furrow_pictures_failed_total";
    case Counter::kSnapshotsReplaced: return "furrow_snapshots_replaced_total";
    case Counter::kRendererRestarts: return "furrow_renderer_restarts_total";
    case Counter::kMocapPackets: return "furrow_mocap_packets_total";
    case Counter::kMocapMalformed: return "furrow_mocap_malformed_total";
    case Counter::kMocapReordered: return "furrow_mocap_reordered_total";
    case Counter::kMocapIncomplete: return "furrow_mocap_incomplete_total";
    case Counter::kMocapStale: return "furrow_mocap_stale_total";
    case Counter::kMocapFrames: return "furrow_mocap_frames_total";
    case Counter::kMocapLockedOut: return "furrow_mocap_locked_out_total";
    case Counter::kMocapRefused: return "furrow_mocap_refused_total";
    case Counter::kOscPacketsSent: return "furrow_osc_packets_sent_total";
    case Counter::kOscPacketsUnsendable: return "furrow_osc_packets_unsendable_total";
    case Counter::kHttpConnections: return "furrow_http_connections_accepted_total";
    case Counter::kHttpRequests: return "furrow_http_requests_total";
    case Counter::kHttpRefused: return "furrow_http_refused_total";
    case Counter::kWebSocketsAccepted: return "furrow_web_sockets_accepted_total";
    case Counter::kRecordingMessages: return "furrow_recording_messages_total";
    case Counter::kRecordingDropped: return "furrow_recording_dropped_total";
    case Counter::kRecordingFailures: return "furrow_recording_failures_total";
    case Counter::kCount: break;
  }
  return "";
}

}  // namespace furrow::server
