// SPDX-License-Identifier: Apache-2.0
#include "server/tls/tls_identity.h"

#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {

TlsWatches WatchTlsFiles(const TlsFiles& files) {
  TlsWatches watches = {FileWatch(files.certificate), FileWatch(files.key),
                        FileWatch(files.client_authority)};
  for (FileWatch& watch : watches) (void)watch.Changed();  // notes the file as it is now
  return watches;
}

TlsIdentity::TlsIdentity(TlsFiles files)
    : files_(std::move(files)),
      enabled_(files_.enabled()),
      asks_clients_(!files_.client_authority.empty()),
      watches_(WatchTlsFiles(files_)) {}

void TlsIdentity::Replace(TlsFiles files, TlsWatches watches, TlsContexts contexts) {
  files_ = std::move(files);
  watches_ = std::move(watches);
  changed_ = false;
  Use(std::move(contexts));
}

bool TlsIdentity::FilesChanged() {
  bool changed = false;
  for (FileWatch& watch : watches_) changed |= watch.Changed();  // each notes its file
  return changed;
}

Status TlsIdentity::Load() {
  if (!enabled()) return {};
  (void)FilesChanged();  // before they are read, so that no change is missed
  auto contexts = LoadTlsContexts(files_);
  FURROW_RETURN_IF_ERROR(contexts);
  Use(*std::move(contexts));
  return {};
}

void TlsIdentity::ReadIfChanged() {
  if (FilesChanged()) {
    changed_ = true;
    return;
  }
  if (!std::exchange(changed_, false)) return;
  auto contexts = LoadTlsContexts(files_);
  if (!contexts.ok()) {
    spdlog::error("the certificate stays as it was: {}", contexts.status().ToString());
    return;
  }
  Use(*std::move(contexts));
  spdlog::info("read the certificate {}", files_.certificate.string());
}

void TlsIdentity::Use(TlsContexts contexts) {
  if (!contexts.warning.empty()) spdlog::warn("{}", contexts.warning);
  const std::lock_guard lock(mutex_);
  contexts_ = std::move(contexts);
}

TlsContext TlsIdentity::for_messages() const {
  const std::lock_guard lock(mutex_);
  return contexts_.messages;
}

TlsContext TlsIdentity::for_web() const {
  const std::lock_guard lock(mutex_);
  return contexts_.web;
}

}  // namespace furrow::server
