// SPDX-License-Identifier: Apache-2.0
#include "server/tls/tls_connection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>
#include <utility>

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "server/tls/record_head.h"

namespace furrow::server {
namespace {

// The most that a record for a stranger contains: OpenSSL allocates this much for writing, and
// keeps it while the client does not read. A handshake sends 1 to 4 kB.
constexpr long kStrangerRecordBytes = 2 * 1024;

// A record that is larger than the socket's buffer never arrives as a whole. OpenSSL reads what has
// arrived after this many looks without anything new.
constexpr int kMostSameLooks = 5;

}  // namespace

// The functions of a BIO, the input and output of OpenSSL.
struct TlsConnection::Io {
  static TlsConnection& Of(BIO* bio) { return *static_cast<TlsConnection*>(BIO_get_data(bio)); }

  static int Write(BIO* bio, const char* bytes, int size) {
    TlsConnection& tls = Of(bio);
    BIO_clear_retry_flags(bio);
    const ssize_t sent =
        send(tls.socket_, bytes, static_cast<std::size_t>(size), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0) return static_cast<int>(sent);
    if (MayRetry(errno)) {
      BIO_set_retry_write(bio);
    } else {
      tls.errno_ = errno;
    }
    return -1;
  }

  static int Read(BIO* bio, char* bytes, int size) {
    TlsConnection& tls = Of(bio);
    BIO_clear_retry_flags(bio);
    std::size_t most = static_cast<std::size_t>(size);
    if (tls.is_wary_) {
      if (tls.record_bytes_ == 0 && !BeginRecord(tls)) {
        if (tls.waits_for_record_) BIO_set_retry_read(bio);
        return tls.truncated_ ? 0 : -1;
      }
      most = std::min(most, tls.record_bytes_);
    }
    const ssize_t got = recv(tls.socket_, bytes, most, MSG_DONTWAIT);
    if (got > 0) {
      if (tls.is_wary_) tls.record_bytes_ -= static_cast<std::size_t>(got);
      return static_cast<int>(got);
    }
    if (got == 0) {
      tls.truncated_ = true;
    } else if (MayRetry(errno)) {
      BIO_set_retry_read(bio);
    } else {
      tls.errno_ = errno;
    }
    return static_cast<int>(got);
  }

  // OpenSSL flushes its output. It must not take the end of the input for a fatal error, because a
  // client that has closed one direction may still read.
  static long Control(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
    return command == BIO_CTRL_FLUSH ? 1 : 0;
  }

  // True: a whole record has arrived, or the rest of the input. False: one of `waits_for_record_`,
  // `truncated_` and `errno_` says why not.
  static bool BeginRecord(TlsConnection& tls) {
    std::array<std::uint8_t, kRecordHeadBytes> head{};
    const ssize_t got = recv(tls.socket_, head.data(), head.size(), MSG_PEEK | MSG_DONTWAIT);
    tls.truncated_ = got == 0;
    if (got < 0 && !MayRetry(errno)) tls.errno_ = errno;
    if (got == 0 || tls.errno_ != 0) return false;
    const std::size_t size = RecordBytes(std::span(head).first(got < 0 ? 0 : got));
    int arrived = 0;
    if (got > 0) ioctl(tls.socket_, FIONREAD, &arrived);
    if (static_cast<std::size_t>(arrived) >= size ||
        (got > 0 && (HasEnded(tls.socket_) || FillsSocket(tls, arrived)))) {
      SetLowWater(tls, 1);
      tls.same_looks_ = 0;
      tls.record_bytes_ = std::max<std::size_t>(size, 1);
      return true;
    }
    tls.waits_for_record_ = true;
    // Without input, any byte may wake the reader: the header says what to wait for.
    if (got > 0) {
      tls.is_stuck_ = !SetLowWater(tls, static_cast<int>(size)) && IsReadable(tls.socket_);
    }
    return false;
  }

  // The socket has woken its reader for less than its low-water mark, and nothing more arrives.
  static bool FillsSocket(TlsConnection& tls, int arrived) {
    const bool is_same = arrived == std::exchange(tls.arrived_, arrived);
    tls.same_looks_ = is_same && IsReadable(tls.socket_) ? tls.same_looks_ + 1 : 0;
    return tls.same_looks_ >= kMostSameLooks;
  }

  // The kernel wakes the reader when this much has arrived. False: that was so before.
  static bool SetLowWater(TlsConnection& tls, int bytes) {
    if (tls.low_water_ == bytes) return false;
    tls.low_water_ = bytes;
    setsockopt(tls.socket_, SOL_SOCKET, SO_RCVLOWAT, &bytes, sizeof(bytes));
    return true;
  }

  static bool IsReadable(int socket) {
    pollfd watched{socket, POLLIN, 0};
    return poll(&watched, 1, 0) > 0;
  }

  // No more bytes can arrive.
  static bool HasEnded(int socket) {
    pollfd watched{socket, POLLRDHUP, 0};
    return poll(&watched, 1, 0) > 0;
  }

  static bool MayRetry(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
  }

  static const BIO_METHOD* Method() {
    static const BIO_METHOD* const method = [] {
      BIO_METHOD* const made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "furrow");
      if (made == nullptr) throw std::bad_alloc();
      BIO_meth_set_write(made, &Write);
      BIO_meth_set_read(made, &Read);
      BIO_meth_set_ctrl(made, &Control);
      return made;
    }();
    return method;
  }
};

void TlsConnection::Free::operator()(SSL* ssl) const { SSL_free(ssl); }

TlsConnection::TlsConnection(SSL_CTX* context) : ssl_(SSL_new(context)) {
  BIO* const bio = ssl_ == nullptr ? nullptr : BIO_new(Io::Method());
  if (bio == nullptr) throw std::bad_alloc();
  BIO_set_data(bio, this);
  BIO_set_init(bio, 1);
  SSL_set_bio(ssl_.get(), bio, bio);
  SSL_set_accept_state(ssl_.get());
  SSL_set_mode(ssl_.get(), SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                               SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_set_max_send_fragment(ssl_.get(), kStrangerRecordBytes);
}

TlsConnection::~TlsConnection() = default;

// OpenSSL looks at its list of errors after each call, also at those that others have left.
void TlsConnection::Begin(int socket) {
  ERR_clear_error();
  socket_ = socket;
  errno_ = 0;
  truncated_ = waits_for_record_ = is_stuck_ = false;
}

TlsConnection::Outcome TlsConnection::Judge(int result) {
  if (result > 0) return {};
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {.progress = is_stuck_ ? Progress::kNeedsTime : Progress::kNeedsInput};
    case SSL_ERROR_WANT_WRITE: return {.progress = Progress::kNeedsOutput};
    case SSL_ERROR_ZERO_RETURN: return {.progress = Progress::kEnded};
    case SSL_ERROR_SYSCALL:
      if (errno_ != 0) {
        return {.progress = Progress::kBroken, .code = static_cast<unsigned long>(errno_)};
      }
      return {.progress = Progress::kTruncated};
    default: break;
  }
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  return {.progress = Progress::kFailed, .code = code};
}

TlsConnection::Outcome TlsConnection::Handshake(int socket) {
  Begin(socket);
  return Judge(SSL_do_handshake(ssl_.get()));
}

TlsConnection::Outcome TlsConnection::Read(int socket, std::span<std::uint8_t> bytes) {
  Begin(socket);
  std::size_t size = 0;
  Outcome outcome = Judge(SSL_read_ex(ssl_.get(), bytes.data(), bytes.size(), &size));
  outcome.size = size;
  return outcome;
}

TlsConnection::Outcome TlsConnection::Write(int socket, std::span<const std::uint8_t> bytes) {
  Begin(socket);
  const std::size_t most = std::min(bytes.size(), kRecordBytes);
  std::size_t size = 0;
  Outcome outcome = Judge(SSL_write_ex(ssl_.get(), bytes.data(), most, &size));
  outcome.size = size;
  has_write_buffer_ = size < most;
  if (!has_write_buffer_ && std::exchange(raises_later_, false)) RaiseRecordSize();
  return outcome;
}

TlsConnection::Outcome TlsConnection::End(int socket, bool awaits_client) {
  Begin(socket);
  int result = SSL_shutdown(ssl_.get());
  if (result != 0 || !awaits_client) return result == 0 ? Outcome() : Judge(result);
  // Sent. The next call reads.
  result = SSL_shutdown(ssl_.get());
  return Judge(result);
}

void TlsConnection::SetTrusting(int socket) {
  if (!is_wary_) return;
  is_wary_ = false;
  socket_ = socket;
  Io::SetLowWater(*this, 1);
  SSL_set_read_ahead(ssl_.get(), 1);  // a header and its record with one call
  // OpenSSL fails if a record exceeds the buffer that it has made for the former size.
  raises_later_ = has_write_buffer_;
  if (!raises_later_) RaiseRecordSize();
}

void TlsConnection::RaiseRecordSize() {
  SSL_set_max_send_fragment(ssl_.get(), kRecordBytes);
  SSL_set_split_send_fragment(ssl_.get(), kRecordBytes);  // lowered together with the other one
}

bool TlsConnection::has_client_certificate() const {
  return SSL_get0_peer_certificate(ssl_.get()) != nullptr;
}

}  // namespace furrow::server
