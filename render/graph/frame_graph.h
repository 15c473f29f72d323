// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

// A frame as a list of passes that declare what they read and write, then only draw (the idea of
// filament's FrameGraph). Knows nothing of OpenGL: textures come from a FrameGraphDevice.
namespace furrow::render {

enum class PixelFormat { kRgba8, kRgba16F, kRgba32F, kR32F, kR8, kDepth32F };

struct TextureDesc {
  int width = 0;  // pixels
  int height = 0;
  PixelFormat format = PixelFormat::kRgba8;
  int samples = 1;

  friend bool operator==(const TextureDesc&, const TextureDesc&) = default;
};

using TextureId = std::uint32_t;  // the device's name of a texture; 0: none

// Who makes textures.
class FrameGraphDevice {
 public:
  virtual ~FrameGraphDevice() = default;
  [[nodiscard]] virtual TextureId CreateTexture(const TextureDesc& desc) = 0;
  virtual void DestroyTexture(TextureId texture) = 0;
};

// What is told of every pass that runs, as it runs: for timing, and for looking at what it wrote.
class FrameGraphObserver {
 public:
  struct Written {
    std::string_view name;  // of the texture, as it was created
    TextureDesc desc;
    TextureId texture = 0;  // holds what the pass left there until AfterPass() returns
  };
  virtual ~FrameGraphObserver() = default;
  virtual void BeforePass(std::string_view pass) = 0;
  virtual void AfterPass(std::string_view pass, const std::vector<Written>& written) = 0;
};

// Keeps released textures for the next frame, or the next pass of the same frame, that wants one
// alike.
class TransientPool {
 public:
  static constexpr int kKeepFrames = 8;  // a texture unused for so many frames is destroyed

  explicit TransientPool(FrameGraphDevice* device) : device_(device) {}
  ~TransientPool();
  TransientPool(const TransientPool&) = delete;
  TransientPool& operator=(const TransientPool&) = delete;

  [[nodiscard]] TextureId Acquire(const TextureDesc& desc);
  void Release(TextureId texture);
  void EndFrame();
  [[nodiscard]] int num_textures() const { return static_cast<int>(entries_.size()); }

 private:
  struct Entry {
    TextureDesc desc;
    TextureId texture = 0;
    bool in_use = false;
    int idle_frames = 0;
  };
  FrameGraphDevice* device_;
  std::vector<Entry> entries_;
};

// One frame. Add passes in pipeline order, Compile(), Execute().
//
// - A handle names one *version* of a texture: Write() gives a new one, so a pass that reads a
//   stale picture is a mistake that Compile() reports, by the names of pass and texture.
// - A pass whose results nobody reads is culled, unless it has a side effect.
// - A transient texture lives from the first to the last pass that uses it; two whose lives do not
//   overlap may share memory. Its contents are undefined before the first write.
class FrameGraph {
 public:
  struct Handle {
    int version = -1;  // index of the version in the graph; -1: none
  };

  // What a pass may touch while it draws: what it declared.
  class Resources {
   public:
    [[nodiscard]] TextureId Get(Handle handle) const;
    [[nodiscard]] const TextureDesc& Desc(Handle handle) const;

   private:
    friend class FrameGraph;
    explicit Resources(const FrameGraph* graph) : graph_(graph) {}
    const FrameGraph* graph_;
  };

  // What a pass says of itself while it is added.
  class Builder {
   public:
    [[nodiscard]] Handle Create(std::string_view name, const TextureDesc& desc);
    void Read(Handle handle);
    [[nodiscard]] Handle Write(Handle handle);
    void SideEffect();  // never culled: it leaves the graph (read-back, a swap)

   private:
    friend class FrameGraph;
    Builder(FrameGraph* graph, int pass) : graph_(graph), pass_(pass) {}
    FrameGraph* graph_;
    int pass_;
  };

  // A texture that outlives the frame, with what it holds: passes may read it, or write over it.
  [[nodiscard]] Handle Import(std::string_view name, const TextureDesc& desc, TextureId texture);

  // `setup(Builder&, Data&)` declares, now; `execute(const Resources&, const Data&)` draws, later,
  // and returns a Status. Data is what one tells the other: its handles. Returns it, for the next
  // pass.
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

  // kInternal: a pass reads what nobody wrote, or a version that was written over.
  [[nodiscard]] Status Compile();
  // Runs the passes that were not culled, in order; stops at the first failure. After Compile().
  [[nodiscard]] Status Execute(TransientPool* pool, FrameGraphObserver* observer = nullptr);

  [[nodiscard]] bool IsCulled(std::string_view pass) const;  // after Compile(); false when unknown

 private:
  struct Texture {
    std::string name;
    TextureDesc desc;
    int newest = -1;      // version
    int first_pass = -1;  // among those not culled
    int last_pass = -1;
    TextureId id = 0;
    bool imported = false;
  };
  struct Version {
    int texture = -1;
    int writer = -1;    // pass; -1: created, not yet written; or imported
    int previous = -1;  // version that it was written over
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
  Status error_;  // of the declarations; the first one
};

}  // namespace furrow::render
