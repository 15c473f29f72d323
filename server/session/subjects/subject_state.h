// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/status.h"
#include "protocol/messages/cluster_messages.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// A subject as it moves to another node (STANDARD.md section 10).

// The header of the state. `number`: which the answer repeats.
[[nodiscard]] protocol::Header StateHeader(const Subject& subject, std::uint32_t number);
// Everything that another node needs to go on with the subject. Poses must not be in a batch.
[[nodiscard]] protocol::SubjectState StateOf(const Subject& subject);

// The reference poses that were captured from the subject, as a rig file in one line; empty if
// there are none. Poses that do not fit the state are left out.
[[nodiscard]] std::string CapturesOf(const Subject& subject);
// The rig with these captures; nothing if it has them already. Errors: those of rig::ParseRig(),
// and kLimit: they would add more than `most` poses.
[[nodiscard]] Result<std::optional<wrinkle::Rig>> WithCaptures(const wrinkle::Rig& rig,
                                                               const std::string& captures,
                                                               std::size_t most);

// Lets the subject, which has just been offered here, go on from the state of another node. The
// neutral pose belongs to the performer; poses, filter and sequence belong to the publisher's
// session. A part that does not fit the skeleton or the rig of this node is left out.
void ResumeFrom(const protocol::Header& header, const protocol::SubjectState& state,
                Subject* subject);

}  // namespace furrow::server
