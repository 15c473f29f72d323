// SPDX-License-Identifier: Apache-2.0
// ListSubjects and Subjects: STANDARD.md section 8.
#include "protocol/codec/codec_internal.h"
#include "protocol/schema/list_subjects_generated.h"
#include "protocol/schema/subjects_generated.h"

namespace furrow::protocol {

using internal::Builder;
using internal::Finish;
using internal::Verify;

DecodeStatus Decode(const MessageView& view, ListSubjects& message) {
  const wire::ListSubjects* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kListSubjects, root));
  message.follow = root->follow();
  return DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const ListSubjects& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  Finish(builder, wire::CreateListSubjects(builder, message.follow), header,
         MessageKind::kListSubjects, out);
}

DecodeStatus Decode(const MessageView& view, Subjects& message) {
  const wire::Subjects* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kSubjects, root));
  FURROW_CHECK_DECODE(internal::ReadNames(root->names(), kMaxListedSubjects, message.names));
  message.total = root->total();
  return message.total < message.names.size() ? DecodeStatus::kBadCount : DecodeStatus::kOk;
}

void Encoder::Encode(const Header& header, const Subjects& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  flatbuffers::Offset<internal::TextVector> names = 0;
  if (!message.names.empty()) names = builder.CreateVectorOfStrings(message.names);
  Finish(builder, wire::CreateSubjects(builder, names, message.total), header,
         MessageKind::kSubjects, out);
}

}  // namespace furrow::protocol
