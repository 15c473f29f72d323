// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/error_text.h"

namespace furrow::protocol {
namespace {

const char* GeneralSentence(ErrorCode code) {
  switch (code) {
    case ErrorCode::kMalformed: return "the daemon could not read the message";
    case ErrorCode::kUnsupportedVersion: return "the daemon speaks another version of the protocol";
    case ErrorCode::kUnsupported: return "the daemon does not serve this request";
    case ErrorCode::kUnknownSubject: return "the daemon does not have the subject";
    case ErrorCode::kNoMatch: return "the pattern matches no weight";
    case ErrorCode::kLimit: return "a limit of the daemon is reached";
    case ErrorCode::kBadSkeleton: return "the daemon refuses the skeleton";
    case ErrorCode::kNotRendering: return "the daemon does not draw pictures";
    case ErrorCode::kBadPicture: return "the daemon does not have this size, view or camera";
    case ErrorCode::kNeedsTcp: return "the daemon serves this over TCP only";
    case ErrorCode::kUnprovenAddress: return "the daemon does not know this address";
    case ErrorCode::kDraining: return "the daemon is shutting down";
    case ErrorCode::kInternal: break;
    case ErrorCode::kSubjectTaken: return "another publisher is sending the subject";
    case ErrorCode::kNeedsToken: return "the daemon requires a token";
    case ErrorCode::kNotPermitted: return "the token does not allow this";
  }
  return "an internal error of the daemon; see its log";
}

}  // namespace

std::string SentenceOf(const ErrorMessage& error) {
  return error.message.empty() ? GeneralSentence(error.code) : error.message;
}

}  // namespace furrow::protocol
