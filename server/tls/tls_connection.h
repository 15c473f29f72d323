// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <openssl/types.h>

namespace furrow::server {

// The server's end of a TLS connection over a TCP socket, without waiting: each call reads and
// writes what the socket takes at once, and says what to wait for. OpenSSL uses the socket itself,
// so the connection has no buffers of its own.
//
// The client is a stranger until SetTrusting(). The connection then leaves a record in the kernel
// until the whole record has arrived, and writes small records. So a stranger that sends half a
// record, or does not read, makes the daemon hold next to nothing.
//
// The caller passes the socket to each call, because a closed socket's number may soon belong to
// another connection; -1: it is closed. A write that needs output must be repeated with the same
// bytes, which may have moved, before another write.
class TlsConnection {
 public:
  enum class Progress {
    kDone,
    kNeedsInput,   // wait until the socket can be read
    kNeedsOutput,  // wait until the socket can be written
    kNeedsTime,    // the socket can be read, but its record is not whole: wait for a moment
    kEnded,        // the client has ended TLS
    kTruncated,    // the client has closed the socket without that
    kFailed,       // OpenSSL: `code` is its error
    kBroken,       // the socket: `code` is its errno
  };
  struct Outcome {
    Progress progress = Progress::kDone;
    std::size_t size = 0;  // bytes that Read() or Write() has moved
    unsigned long code = 0;
  };

  // Throws std::bad_alloc. `context`: of a server.
  explicit TlsConnection(SSL_CTX* context);
  ~TlsConnection();
  TlsConnection(const TlsConnection&) = delete;
  TlsConnection& operator=(const TlsConnection&) = delete;

  [[nodiscard]] Outcome Handshake(int socket);
  // `bytes`: not empty, as of Write().
  [[nodiscard]] Outcome Read(int socket, std::span<std::uint8_t> bytes);
  // Writes the beginning of the bytes, at most kRecordBytes, as one record. A stranger gets smaller
  // ones.
  [[nodiscard]] Outcome Write(int socket, std::span<const std::uint8_t> bytes);
  // Tells the client that nothing follows. `awaits_client`: done when the client has said the same.
  [[nodiscard]] Outcome End(int socket, bool awaits_client);
  static constexpr std::size_t kRecordBytes = 16 * 1024;

  // Call it when the client has shown who it is. From then on, or from the end of a write that
  // waits for output, OpenSSL may hold parts of records of full size, and needs fewer system calls.
  void SetTrusting(int socket);
  // True if the client has shown a certificate, which is then valid.
  [[nodiscard]] bool has_client_certificate() const;

 private:
  struct Io;  // what OpenSSL calls to read and write

  [[nodiscard]] Outcome Judge(int result);
  void Begin(int socket);
  void RaiseRecordSize();

  // Of the call that goes on.
  int socket_ = -1;
  int errno_ = 0;
  bool truncated_ = false;
  bool waits_for_record_ = false;  // the record is not whole
  bool is_stuck_ = false;          // ... although the socket has woken its reader

  bool is_wary_ = true;
  bool has_write_buffer_ = false;  // OpenSSL: until a record has taken all bytes of a Write()
  bool raises_later_ = false;      // the size of records, when that is so
  int low_water_ = 1;              // SO_RCVLOWAT of the socket
  // The last looks at a record that is not whole: its bytes, and how often these have not changed.
  int arrived_ = 0;
  int same_looks_ = 0;
  std::size_t record_bytes_ = 0;  // left of a record that OpenSSL reads
  struct Free {
    void operator()(SSL* ssl) const;
  };
  const std::unique_ptr<SSL, Free> ssl_;
};

}  // namespace furrow::server
