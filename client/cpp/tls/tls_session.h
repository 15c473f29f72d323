// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <openssl/types.h>

namespace furrow::client {

// The client's end of a TLS connection, without a socket: bytes of the peer go in, bytes for the
// peer come out. The owner of the socket does all I/O.
class TlsSession {
 public:
  // `context`: MakeTlsContext(). `host`: the name or numeric address that the peer's
  // certificate must be for.
  TlsSession(SSL_CTX* context, const std::string& host);

  enum class Progress { kDone, kNeedsMore, kFailed };
  // Continues the handshake with what has been fed. Send outgoing() after each call. kFailed:
  // failure() says why.
  [[nodiscard]] Progress Handshake();

  // Takes bytes that arrived from the peer.
  void Feed(std::span<const std::uint8_t> bytes);
  // Replaces `plain` by all data that has been fed so far. False: the peer broke the protocol or
  // ended the connection; `plain` then holds what came before.
  [[nodiscard]] bool Decrypt(std::vector<std::uint8_t>* plain);
  // Adds the encrypted `bytes` to outgoing(). Precondition: the handshake is done.
  void Encrypt(std::span<const std::uint8_t> bytes);
  // Moves the bytes for the peer to `bytes`.
  void TakeOutgoing(std::vector<std::uint8_t>* bytes);

  // Why the handshake, or Decrypt(), failed: part of a sentence; empty if the connection ended.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  struct Free {
    void operator()(SSL* ssl) const;
  };
  void Fail();

  std::unique_ptr<SSL, Free> ssl_;  // null: it cannot check the host
  BIO* in_ = nullptr;               // owned by ssl_, like out_
  BIO* out_ = nullptr;
  std::string failure_;
};

}  // namespace furrow::client
