// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

// A frame is a list of passes that first declare what they read and write and then only draw. The
// design follows filament's FrameGraph. Nothing here depends on OpenGL: a FrameGraphDevice creates
// the textures.
namespace furrow::render {

enum class PixelFormat { kRgba8, kRgba16F, kRgba32F, kR32F, kR8, kDepth32F };

struct TextureDesc {
  int width = 0;  // pixels
  int height = 0;
  PixelFormat format = PixelFormat::kRgba8;
  int samples = 1;

  friend bool operator==(const TextureDesc&, const TextureDesc&) = default;
};

// The memory of a texture without the driver's own overhead.
[[nodiscard]] std::size_t TextureBytes(const TextureDesc& desc);

using TextureId = std::uint32_t;  // the device's name for a texture; 0: none

// Creates and destroys textures for a frame graph. The caller of CreateTexture() owns the texture.
class FrameGraphDevice {
 public:
  virtual ~FrameGraphDevice() = default;
  [[nodiscard]] virtual TextureId CreateTexture(const TextureDesc& desc) = 0;
  virtual void DestroyTexture(TextureId texture) = 0;
};

// A texture that outlives the frame. Its owner calls Release().
struct KeptTexture {
  TextureDesc desc;
  TextureId texture = 0;  // 0: none yet

  // Replaces the texture unless it is of `wanted`. True: it is new, and its content undefined.
  bool Prepare(const TextureDesc& wanted, FrameGraphDevice* device);
  void Release(FrameGraphDevice* device);
  [[nodiscard]] std::size_t num_bytes() const { return texture == 0 ? 0 : TextureBytes(desc); }
};

// Receives every pass that runs, for timing and for inspecting what the pass wrote.
class FrameGraphObserver {
 public:
  struct Written {
    std::string_view name;  // as passed to Builder::Create() or Import()
    TextureDesc desc;
    TextureId texture = 0;  // holds the pass's output until AfterPass() returns
  };
  virtual ~FrameGraphObserver() = default;
  // The frame begins, with this number of passes.
  virtual void BeginFrame(int /*passes*/) {}
  // Asked before every pass. False: nobody wants the frame any more, so it ends here.
  [[nodiscard]] virtual bool Continues() { return true; }
  virtual void BeforePass(std::string_view pass) = 0;
  virtual void AfterPass(std::string_view pass, const std::vector<Written>& written) = 0;
};

// Lends textures to passes, and keeps those that are given back for later passes and frames that
// need the same TextureDesc. Pictures of many sizes would fill the memory, so textures that are not
// in use are destroyed, the longest unused first, before the pool holds more than `max_bytes`.
class TransientPool {
 public:
  static constexpr int kKeepFrames = 8;  // a texture unused for this many frames is destroyed
  static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

  // `device` must outlive the pool.
  explicit TransientPool(FrameGraphDevice* device, std::size_t max_bytes = kNoLimit)
      : device_(device), max_bytes_(max_bytes) {}
  ~TransientPool();
  TransientPool(const TransientPool&) = delete;
  TransientPool& operator=(const TransientPool&) = delete;

  // Returns a texture that nobody else uses until Release(). Its contents are undefined.
  [[nodiscard]] TextureId Acquire(const TextureDesc& desc);
  void Release(TextureId texture);
  // Call once per frame: destroys the textures that were unused for kKeepFrames frames.
  void EndFrame();
  [[nodiscard]] std::size_t num_bytes() const { return num_bytes_; }
  [[nodiscard]] std::size_t max_bytes() const { return max_bytes_; }

 private:
  struct Entry {
    TextureDesc desc;
    TextureId texture = 0;
    bool in_use = false;
    int idle_frames = 0;
    std::uint64_t released = 0;  // counts up with each Release()
  };
  void MakeRoom(std::size_t bytes);
  void Destroy(const Entry& entry);

  FrameGraphDevice* device_;
  const std::size_t max_bytes_;
  std::size_t num_bytes_ = 0;
  std::uint64_t num_released_ = 0;
  std::vector<Entry> entries_;
};

// One frame. Add passes in pipeline order, then call Compile() and Execute().
//
// - A handle names one *version* of a texture, and Write() returns a new version. A pass that reads
//   an outdated version is a mistake, which Compile() reports with the names of pass and texture.
// - A pass is culled if no other pass reads its results and it has no side effect.
// - A transient texture lives from the first to the last pass that uses it. Textures with disjoint
//   lifetimes may share memory, so the contents are undefined before the first write.
class FrameGraph {
 public:
  // One version of a texture of this graph.
  struct Handle {
    int version = -1;  // index in the graph; -1: an empty handle, which names no texture
  };

  // Gives a drawing pass access to the textures that it declared.
  class Resources {
   public:
    [[nodiscard]] TextureId Get(Handle handle) const;
    [[nodiscard]] const TextureDesc& Desc(Handle handle) const;

   private:
    friend class FrameGraph;
    explicit Resources(const FrameGraph* graph) : graph_(graph) {}
    const FrameGraph* graph_;
  };

  // Declares what a pass creates, reads and writes.
  class Builder {
   public:
    // Declares a new transient texture. Its contents are undefined until Write().
    [[nodiscard]] Handle Create(std::string_view name, const TextureDesc& desc);
    void Read(Handle handle);
    // Returns the version that the pass writes. `handle` is outdated from then on.
    [[nodiscard]] Handle Write(Handle handle);
    void SideEffect();  // never cull the pass: its result leaves the graph (read-back)

   private:
    friend class FrameGraph;
    Builder(FrameGraph* graph, int pass) : graph_(graph), pass_(pass) {}
    FrameGraph* graph_;
    int pass_;
  };

  // Adds a texture of the caller that outlives the frame. Passes may read its contents or overwrite
  // them.
  [[nodiscard]] Handle Import(std::string_view name, const TextureDesc& desc, TextureId texture);

  // Adds a pass. `setup(Builder&, Data&)` runs immediately and declares; `execute(const Resources&,
  // const Data&)` draws later and returns a Status. Data passes handles from `setup` to `execute`,
  // and is returned so that later passes can use them.
  template <class Data, class Setup, class Execute>
  Data AddPass(std::string_view name, Setup&& setup, Execute execute) {
    const auto data = std::make_shared<Data>();
    const int pass = BeginPass(name);
    Builder builder(this, pass);
    setup(builder, *data);
    passes_[static_cast<std::size_t>(pass)].execute = [data, execute](const Resources& resources) {
      return execute(resources, *data);
    };
    return *data;
  }

  // Checks the declarations, culls passes and computes lifetimes. Error: kInternal (a pass reads a
  // texture that no pass wrote, or a version that was overwritten).
  [[nodiscard]] Status Compile();
  // Runs the passes that were not culled, in order. Stops at the first failure and returns it.
  // Requires Compile(). `observer` may be null. Error besides those of the passes: kUnavailable if
  // the observer ends the frame.
  [[nodiscard]] Status Execute(TransientPool* pool, FrameGraphObserver* observer = nullptr);

  // The most bytes of transient textures that Execute() needs at a time. Requires Compile().
  [[nodiscard]] std::size_t PeakBytes() const;

  [[nodiscard]] bool IsCulled(std::string_view pass) const;  // requires Compile(); false for
                                                             // unknown names

 private:
  struct Texture {
    std::string name;
    TextureDesc desc;
    int newest = -1;      // version
    int first_pass = -1;  // among passes that were not culled
    int last_pass = -1;
    TextureId id = 0;
    bool imported = false;
  };
  struct Version {
    int texture = -1;
    int writer = -1;    // pass; -1: imported, or created and not yet written
    int previous = -1;  // the version that this one overwrote
  };
  struct Pass {
    std::string name;
    std::function<Status(const Resources&)> execute;
    std::vector<int> reads;
    std::vector<int> writes;
    bool side_effect = false;
    bool needed = false;
  };

  [[nodiscard]] int BeginPass(std::string_view name);
  void Fail(int pass, int version, std::string_view why);
  void Cull();
  void ComputeLifetimes();
  [[nodiscard]] Status Run(const Pass& pass, FrameGraphObserver* observer) const;

  std::vector<Texture> textures_;
  std::vector<Version> versions_;
  std::vector<Pass> passes_;
  Status error_;  // the first error of a declaration
};

}  // namespace furrow::render
