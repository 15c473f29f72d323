// SPDX-License-Identifier: Apache-2.0
#include "client/c/include/furrow/furrow.h"

const char* furrow_status_text(furrow_status status) {
  switch (static_cast<int>(status)) {
    case FURROW_OK: return "done";
    case FURROW_TIMEOUT: return "nothing happened in time";
    case FURROW_NO_DATA: return "nothing has arrived yet";
    case FURROW_CLOSED: return "a callback closed the connection";
    case FURROW_INVALID_ARGUMENT: return "an argument is invalid";
    case FURROW_INVALID_ADDRESS: return "the address is invalid";
    case FURROW_UNSUPPORTED: return "this version does not support the feature";
    case FURROW_BUFFER_TOO_SMALL: return "the buffer is too small";
    case FURROW_NOT_FOUND: return "there is no such subject, weight or stream";
    case FURROW_LIMIT: return "a limit is exceeded";
    case FURROW_WRONG_CALL: return "this function must not be called inside a callback";
    case FURROW_NO_CONNECTION: return "there is no connection to the daemon at present";
    case FURROW_REJECTED: return "the daemon rejected the request";
    case FURROW_NO_MATCH: return "the pattern matches no weight of the daemon's wrinkle rig";
    case FURROW_OUT_OF_MEMORY: return "there is not enough memory";
    case FURROW_INTERNAL: return "internal error";
    case FURROW_UNAUTHENTICATED: return "the daemon requires a valid token";
    case FURROW_FORBIDDEN: return "the token does not permit this";
    case FURROW_WRONG_SERVER_KEY: return "the daemon does not own the expected key";
    case FURROW_TLS_FAILED: return "the encrypted connection failed";
    case FURROW_REDIRECTED: return "the subject lives on another daemon";
    default: return "unknown status";
  }
}
