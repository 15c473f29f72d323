// SPDX-License-Identifier: Apache-2.0
#include "render/graph/frame_graph.h"

#include <algorithm>

namespace furrow::render {

std::size_t TextureBytes(const TextureDesc& desc) {
  std::size_t bytes = 0;  // per sample
  switch (desc.format) {
    case PixelFormat::kR8: bytes = 1; break;
    case PixelFormat::kRgba8:
    case PixelFormat::kR32F:
    case PixelFormat::kDepth32F: bytes = 4; break;
    case PixelFormat::kRgba16F: bytes = 8; break;
    case PixelFormat::kRgba32F: bytes = 16; break;
  }
  return bytes * static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height) *
         static_cast<std::size_t>(desc.samples);
}

bool KeptTexture::Prepare(const TextureDesc& wanted, FrameGraphDevice* device) {
  if (texture != 0 && desc == wanted) return false;
  Release(device);
  *this = {wanted, device->CreateTexture(wanted)};
  return true;
}

void KeptTexture::Release(FrameGraphDevice* device) {
  if (texture != 0) device->DestroyTexture(texture);
  texture = 0;
}

TransientPool::~TransientPool() {
  for (const Entry& entry : entries_) device_->DestroyTexture(entry.texture);
}

// A linear search is enough: a frame has a few dozen textures.
TextureId TransientPool::Acquire(const TextureDesc& desc) {
  const auto fits = [&](const Entry& entry) { return !entry.in_use && entry.desc == desc; };
  auto found = std::find_if(entries_.begin(), entries_.end(), fits);
  if (found == entries_.end()) {
    MakeRoom(TextureBytes(desc));
    entries_.push_back({desc, device_->CreateTexture(desc), false, 0, 0});
    num_bytes_ += TextureBytes(desc);
    found = entries_.end() - 1;
  }
  found->in_use = true;
  found->idle_frames = 0;
  return found->texture;
}

// The texture keeps its contents until another pass acquires it.
void TransientPool::Release(TextureId texture) {
  for (Entry& entry : entries_) {
    if (entry.texture != texture) continue;
    entry.in_use = false;
    entry.released = ++num_released_;
  }
}

void TransientPool::Destroy(const Entry& entry) {
  device_->DestroyTexture(entry.texture);
  num_bytes_ -= TextureBytes(entry.desc);
}

// Destroys unused textures until `bytes` fit. What is in use stays, however much that is.
void TransientPool::MakeRoom(std::size_t bytes) {
  while (num_bytes_ + bytes > max_bytes_) {
    auto oldest = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      if (entry->in_use) continue;
      if (oldest == entries_.end() || entry->released < oldest->released) oldest = entry;
    }
    if (oldest == entries_.end()) return;
    Destroy(*oldest);
    entries_.erase(oldest);
  }
}

// Destroys textures that no frame has used for a while, such as those of a former picture size.
void TransientPool::EndFrame() {
  for (Entry& entry : entries_) {
    if (!entry.in_use && ++entry.idle_frames > kKeepFrames) Destroy(entry);
  }
  std::erase_if(entries_, [](const Entry& entry) { return entry.idle_frames > kKeepFrames; });
}

TextureId FrameGraph::Resources::Get(Handle handle) const {
  return graph_->textures_[graph_->versions_[handle.version].texture].id;
}

const TextureDesc& FrameGraph::Resources::Desc(Handle handle) const {
  return graph_->textures_[graph_->versions_[handle.version].texture].desc;
}

// A handle names a version of a texture. The first version has no writer, so a pass may write it
// but not read it.
FrameGraph::Handle FrameGraph::Builder::Create(std::string_view name, const TextureDesc& desc) {
  const int version = static_cast<int>(graph_->versions_.size());
  graph_->versions_.push_back({static_cast<int>(graph_->textures_.size()), -1, -1});
  graph_->textures_.push_back({.name = std::string(name), .desc = desc, .newest = version});
  return {version};
}

// All mistakes of declarations are recorded here and reported by Compile(), so that `setup`
// functions need no error handling.
void FrameGraph::Builder::Read(Handle handle) {
  if (handle.version < 0) return graph_->Fail(pass_, handle.version, "reads");
  const Version& version = graph_->versions_[handle.version];
  if (version.writer < 0 && !graph_->textures_[version.texture].imported)
    return graph_->Fail(pass_, handle.version, "reads the unwritten texture");
  if (graph_->textures_[version.texture].newest != handle.version) {
    return graph_->Fail(pass_, handle.version, "reads an overwritten version of texture");
  }
  graph_->passes_[pass_].reads.push_back(handle.version);
}

// A write makes a new version of the texture. The old version remains readable only for passes that
// were added before, because passes run in the order in which they were added.
FrameGraph::Handle FrameGraph::Builder::Write(Handle handle) {
  if (handle.version < 0) {
    graph_->Fail(pass_, handle.version, "writes");
    return handle;
  }
  const Version old = graph_->versions_[handle.version];
  if (graph_->textures_[old.texture].newest != handle.version) {
    graph_->Fail(pass_, handle.version, "writes to an overwritten version of texture");
  }
  const int version = static_cast<int>(graph_->versions_.size());
  graph_->versions_.push_back({old.texture, pass_, handle.version});
  graph_->textures_[old.texture].newest = version;
  graph_->passes_[pass_].writes.push_back(version);
  return {version};
}

void FrameGraph::Builder::SideEffect() { graph_->passes_[pass_].side_effect = true; }

// The caller owns the texture, which has contents already: reading it is allowed before any pass
// writes it, and the pool never touches it.
FrameGraph::Handle FrameGraph::Import(std::string_view name, const TextureDesc& desc,
                                      TextureId texture) {
  const int version = static_cast<int>(versions_.size());
  versions_.push_back({static_cast<int>(textures_.size()), -1, -1});
  textures_.push_back({.name = std::string(name),
                       .desc = desc,
                       .newest = version,
                       .id = texture,
                       .imported = true});
  return {version};
}

int FrameGraph::BeginPass(std::string_view name) {
  passes_.emplace_back().name = name;
  return static_cast<int>(passes_.size()) - 1;
}

// Keeps the first error only. Later errors often follow from it.
void FrameGraph::Fail(int pass, int version, std::string_view why) {
  if (!error_.ok()) return;
  const std::string texture =
      version < 0 ? "no texture" : "'" + textures_[versions_[version].texture].name + "'";
  error_ = Status(StatusCode::kInternal,
                  "pass '" + passes_[pass].name + "' " + std::string(why) + " " + texture,
                  "frame graph");
}

Status FrameGraph::Compile() {
  if (!error_.ok()) return error_;
  Cull();
  ComputeLifetimes();
  return {};
}

// Walks backwards from the passes with side effects: whatever a needed pass reads, or draws on top
// of, is needed too.
void FrameGraph::Cull() {
  for (Pass& pass : passes_) pass.needed = pass.side_effect;
  for (auto pass = passes_.rbegin(); pass != passes_.rend(); ++pass) {
    if (!pass->needed) continue;
    // A created texture without a writer, or an imported one, needs no earlier pass.
    const auto need = [&](int version) {
      if (versions_[version].writer >= 0) passes_[versions_[version].writer].needed = true;
    };
    for (const int version : pass->reads) need(version);
    for (const int version : pass->writes) need(versions_[version].previous);
  }
}

// Culled passes do not extend lifetimes.
void FrameGraph::ComputeLifetimes() {
  for (int pass = 0; pass < static_cast<int>(passes_.size()); ++pass) {
    if (!passes_[pass].needed) continue;
    const auto touch = [&](int version) {
      Texture& texture = textures_[versions_[version].texture];
      if (texture.first_pass < 0) texture.first_pass = pass;
      texture.last_pass = pass;
    };
    for (const int version : passes_[pass].reads) touch(version);
    for (const int version : passes_[pass].writes) touch(version);
  }
}

Status FrameGraph::Run(const Pass& pass, FrameGraphObserver* observer) const {
  if (observer != nullptr) observer->BeforePass(pass.name);
  // A failure is reported together with the pass that caused it.
  Status status = pass.execute(Resources(this)).At(pass.name);
  if (observer == nullptr || !status.ok()) return status;
  std::vector<FrameGraphObserver::Written> written;
  for (const int version : pass.writes) {
    const Texture& texture = textures_[versions_[version].texture];
    written.push_back({texture.name, texture.desc, texture.id});
  }
  observer->AfterPass(pass.name, written);
  return status;
}

Status FrameGraph::Execute(TransientPool* pool, FrameGraphObserver* observer) {
  Status status;
  if (observer != nullptr) {
    observer->BeginFrame(static_cast<int>(std::ranges::count_if(passes_, &Pass::needed)));
  }
  for (int index = 0; index < static_cast<int>(passes_.size()) && status.ok(); ++index) {
    if (!passes_[index].needed) continue;
    if (observer != nullptr && !observer->Continues()) {
      status = Status(StatusCode::kUnavailable, "the frame was abandoned", passes_[index].name);
      break;
    }
    // Textures are acquired as late and released as early as possible, so that passes of one frame
    // share memory.
    for (Texture& texture : textures_) {
      if (texture.imported) continue;
      if (texture.first_pass == index) texture.id = pool->Acquire(texture.desc);
    }
    status = Run(passes_[index], observer);
    for (Texture& texture : textures_) {
      if (texture.imported) continue;
      if (texture.last_pass == index) pool->Release(std::exchange(texture.id, 0));
    }
  }
  // After a failure, some textures are still held.
  for (Texture& texture : textures_) {
    if (texture.id != 0 && !texture.imported) pool->Release(std::exchange(texture.id, 0));
  }
  return status;
}

std::size_t FrameGraph::PeakBytes() const {
  std::size_t peak = 0;
  for (int pass = 0; pass < static_cast<int>(passes_.size()); ++pass) {
    std::size_t alive = 0;
    for (const Texture& texture : textures_) {
      if (texture.imported || texture.first_pass < 0) continue;
      if (texture.first_pass <= pass && pass <= texture.last_pass) {
        alive += TextureBytes(texture.desc);
      }
    }
    peak = std::max(peak, alive);
  }
  return peak;
}

bool FrameGraph::IsCulled(std::string_view pass) const {
  return std::any_of(passes_.begin(), passes_.end(),
                     [&](const Pass& p) { return p.name == pass && !p.needed; });
}

}  // namespace furrow::render
