// SPDX-License-Identifier: Apache-2.0
#include "render/graph/frame_graph.h"

#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/render/null_device.h"

namespace furrow::render {
namespace {

constexpr TextureDesc kSmall{64, 64, PixelFormat::kRgba8, 1};
constexpr TextureDesc kLarge{128, 64, PixelFormat::kRgba16F, 4};

struct PassData {
  FrameGraph::Handle in;
  FrameGraph::Handle out;
};

class FrameGraphTest : public testing::Test {
 protected:
  // A pass that reads `in` (if any), writes a new texture, and records its name when it runs.
  FrameGraph::Handle AddStep(const std::string& name, std::optional<FrameGraph::Handle> in,
                             const TextureDesc& desc = kSmall) {
    return graph_
        .AddPass<PassData>(
            name,
            [&](FrameGraph::Builder& builder, PassData& data) {
              if (in) builder.Read(*in);
              data.out = builder.Write(builder.Create(name + " target", desc));
            },
            [this, name](const FrameGraph::Resources& resources, const PassData& data) {
              ran_.push_back(name);
              ids_.push_back(resources.Get(data.out));
              return Status();
            })
        .out;
  }
  void AddSink(FrameGraph::Handle in) {
    graph_.AddPass<PassData>(
        "sink",
        [&](FrameGraph::Builder& builder, PassData& data) {
          data.in = in;
          builder.Read(in);
          builder.SideEffect();
        },
        [this](const FrameGraph::Resources& resources, const PassData& data) {
          ran_.push_back("sink");
          EXPECT_NE(resources.Get(data.in), 0u);
          return Status();
        });
  }
  void RunAll(FrameGraphObserver* observer = nullptr) {
    ASSERT_TRUE(graph_.Compile().ok());
    ASSERT_TRUE(graph_.Execute(&pool_, observer).ok());
    pool_.EndFrame();
  }

  test::NullDevice device_;
  TransientPool pool_{&device_};
  FrameGraph graph_;
  std::vector<std::string> ran_;
  std::vector<TextureId> ids_;
};

TEST_F(FrameGraphTest, RunsInPipelineOrder) {
  AddSink(AddStep("b", AddStep("a", {})));
  RunAll();
  EXPECT_EQ(ran_, (std::vector<std::string>{"a", "b", "sink"}));
}

TEST_F(FrameGraphTest, CullsPassesWithUnreadResults) {
  const FrameGraph::Handle used = AddStep("used", {});
  const FrameGraph::Handle unused = AddStep("unused", {});
  AddStep("reads the unused", unused);
  AddSink(used);
  RunAll();
  EXPECT_EQ(ran_, (std::vector<std::string>{"used", "sink"}));
  EXPECT_TRUE(graph_.IsCulled("unused"));
  EXPECT_TRUE(graph_.IsCulled("reads the unused"));
  EXPECT_FALSE(graph_.IsCulled("used"));
  EXPECT_EQ(device_.num_created(), 1);
}

TEST_F(FrameGraphTest, KeepsAPassThatAnotherDrawsOnTopOf) {
  const FrameGraph::Handle first = AddStep("first", {});
  FrameGraph::Handle second;
  graph_.AddPass<PassData>(
      "over", [&](FrameGraph::Builder& builder, PassData&) { second = builder.Write(first); },
      [this](const FrameGraph::Resources&, const PassData&) {
        ran_.push_back("over");
        return Status();
      });
  AddSink(second);
  RunAll();
  EXPECT_EQ(ran_, (std::vector<std::string>{"first", "over", "sink"}));
  EXPECT_EQ(device_.num_created(), 1);
}

TEST_F(FrameGraphTest, AnImportedTextureKeepsItsContents) {
  const TextureId mine = device_.CreateTexture(kSmall);
  const FrameGraph::Handle imported = graph_.Import("mine", kSmall, mine);
  AddSink(AddStep("reads", imported));
  RunAll();
  EXPECT_EQ(ran_, (std::vector<std::string>{"reads", "sink"}));
  EXPECT_NE(ids_[0], mine);
  for (int frame = 0; frame < 2 * TransientPool::kKeepFrames; ++frame) pool_.EndFrame();
  EXPECT_EQ(device_.num_alive(), 1);  // it does not belong to the pool
}

TEST_F(FrameGraphTest, APassWritesOverAnImportedTexture) {
  const TextureId mine = device_.CreateTexture(kSmall);
  const FrameGraph::Handle imported = graph_.Import("mine", kSmall, mine);
  FrameGraph::Handle over;
  graph_.AddPass<PassData>(
      "over",
      [&](FrameGraph::Builder& builder, PassData& data) {
        over = data.out = builder.Write(imported);
      },
      [&, this](const FrameGraph::Resources& resources, const PassData& data) {
        ran_.push_back("over");
        EXPECT_EQ(resources.Get(data.out), mine);
        return Status();
      });
  AddSink(over);
  RunAll();
  EXPECT_EQ(ran_, (std::vector<std::string>{"over", "sink"}));
}

TEST_F(FrameGraphTest, TexturesWithDisjointLifetimesShareMemory) {
  AddSink(AddStep("c", AddStep("b", AddStep("a", {}))));
  RunAll();
  ASSERT_EQ(ids_.size(), 3u);
  EXPECT_NE(ids_[0], ids_[1]);
  EXPECT_EQ(ids_[0], ids_[2]);
  EXPECT_EQ(device_.num_created(), 2);
}

TEST_F(FrameGraphTest, OnlyEqualDescriptionsShareMemory) {
  AddSink(AddStep("c", AddStep("b", AddStep("a", {}), kLarge), kSmall));
  RunAll();
  EXPECT_EQ(ids_[0], ids_[2]);
  EXPECT_NE(ids_[0], ids_[1]);
}

TEST_F(FrameGraphTest, TheNextFrameReusesTheTextures) {
  AddSink(AddStep("a", {}));
  RunAll();
  graph_ = FrameGraph();
  AddSink(AddStep("a", {}));
  RunAll();
  EXPECT_EQ(device_.num_created(), 1);
}

TEST_F(FrameGraphTest, IdleTexturesAreDestroyedOnce) {
  AddSink(AddStep("a", {}));
  RunAll();
  for (int frame = 0; frame < TransientPool::kKeepFrames - 1; ++frame) pool_.EndFrame();
  EXPECT_EQ(device_.num_alive(), 1);
  pool_.EndFrame();
  EXPECT_EQ(device_.num_alive(), 0);
  EXPECT_EQ(device_.num_bad_destroys(), 0);
}

// Records what the observer receives, and how many passes had run by then.
class Notes final : public FrameGraphObserver {
 public:
  explicit Notes(const std::vector<std::string>* ran) : ran_(ran) {}
  void BeforePass(std::string_view pass) override {
    lines.push_back("before " + std::string(pass) + " " + std::to_string(ran_->size()));
  }
  void AfterPass(std::string_view pass, const std::vector<Written>& written) override {
    lines.push_back("after " + std::string(pass) + " " + std::to_string(ran_->size()));
    for (const Written& texture : written) {
      lines.push_back(std::string(texture.name));
      EXPECT_NE(texture.texture, 0u);
      EXPECT_EQ(texture.desc, kSmall);
    }
  }
  std::vector<std::string> lines;

 private:
  const std::vector<std::string>* ran_;
};

TEST_F(FrameGraphTest, AnObserverSeesEveryPassAndItsOutput) {
  (void)AddStep("culled", {});
  AddSink(AddStep("a", {}));
  Notes notes(&ran_);
  RunAll(&notes);
  EXPECT_EQ(notes.lines, (std::vector<std::string>{"before a 0", "after a 1", "a target",
                                                   "before sink 1", "after sink 2"}));
}

TEST_F(FrameGraphTest, AnObserverCanEndTheFrame) {
  class Impatient : public FrameGraphObserver {
   public:
    void BeginFrame(int number) override { passes = number; }
    bool Continues() override { return asked++ < 1; }
    void BeforePass(std::string_view) override {}
    void AfterPass(std::string_view, const std::vector<Written>&) override {}
    int passes = 0;
    int asked = 0;
  };
  (void)AddStep("culled", {});
  AddSink(AddStep("b", AddStep("a", {})));
  ASSERT_TRUE(graph_.Compile().ok());
  Impatient observer;
  const Status status = graph_.Execute(&pool_, &observer);
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_EQ(status.where(), "b");
  EXPECT_EQ(observer.passes, 3) << "without the culled one";
  EXPECT_EQ(ran_, (std::vector<std::string>{"a"}));
  for (int frame = 0; frame <= TransientPool::kKeepFrames; ++frame) pool_.EndFrame();
  EXPECT_EQ(device_.num_alive(), 0);
}

TEST_F(FrameGraphTest, ReadingAnUnwrittenTextureIsAnError) {
  graph_.AddPass<PassData>(
      "early",
      [&](FrameGraph::Builder& builder, PassData&) {
        builder.Read(builder.Create("colour", kSmall));
      },
      [](const FrameGraph::Resources&, const PassData&) { return Status(); });
  const Status status = graph_.Compile();
  EXPECT_EQ(status.code(), StatusCode::kInternal);
  EXPECT_NE(status.what().find("'early'"), std::string::npos) << status.what();
  EXPECT_NE(status.what().find("'colour'"), std::string::npos) << status.what();
}

TEST_F(FrameGraphTest, ReadingAnOverwrittenVersionIsAnError) {
  const FrameGraph::Handle old = AddStep("first", {});
  graph_.AddPass<PassData>(
      "over", [&](FrameGraph::Builder& builder, PassData& data) { data.out = builder.Write(old); },
      [](const FrameGraph::Resources&, const PassData&) { return Status(); });
  AddSink(old);
  const Status status = graph_.Compile();
  EXPECT_EQ(status.code(), StatusCode::kInternal);
  EXPECT_NE(status.what().find("overwritten"), std::string::npos) << status.what();
}

TEST_F(FrameGraphTest, AFailureStopsTheFrameAndLeaksNothing) {
  FrameGraph::Handle out;
  graph_.AddPass<PassData>(
      "broken",
      [&](FrameGraph::Builder& builder, PassData&) {
        out = builder.Write(builder.Create("colour", kSmall));
      },
      [](const FrameGraph::Resources&, const PassData&) {
        return Status(StatusCode::kUnavailable, "no");
      });
  AddSink(out);
  ASSERT_TRUE(graph_.Compile().ok());
  const Status status = graph_.Execute(&pool_);
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_EQ(status.where(), "broken");
  EXPECT_TRUE(ran_.empty());
  for (int frame = 0; frame <= TransientPool::kKeepFrames; ++frame) pool_.EndFrame();
  EXPECT_EQ(device_.num_alive(), 0);
}

TEST_F(FrameGraphTest, KnowsHowManyBytesAFrameNeeds) {
  // 64 x 64 x 4 bytes, and 128 x 64 x 8 bytes x 4 samples.
  EXPECT_EQ(TextureBytes(kSmall), 16'384u);
  EXPECT_EQ(TextureBytes(kLarge), 262'144u);
  // "a" and "b" live at the same time, then "b" and "c".
  const FrameGraph::Handle a = AddStep("a", {}, kLarge);
  const FrameGraph::Handle b = AddStep("b", a, kSmall);
  AddSink(AddStep("c", b, kSmall));
  AddStep("unused", {}, kLarge);
  ASSERT_TRUE(graph_.Compile().ok());
  EXPECT_EQ(graph_.PeakBytes(), TextureBytes(kLarge) + TextureBytes(kSmall));
}

TEST(TransientPool, PicturesOfManySizesDoNotFillTheMemory) {
  test::NullDevice device;
  constexpr std::size_t kMaxBytes = 1 << 20;
  TransientPool pool(&device, kMaxBytes);
  for (int size = 64; size < 512; ++size) {
    const TextureId texture = pool.Acquire({size, size, PixelFormat::kRgba8, 1});
    pool.Release(texture);
    pool.EndFrame();
    ASSERT_LE(pool.num_bytes(), kMaxBytes) << size;
  }
  EXPECT_EQ(device.num_bad_destroys(), 0);
}

TEST(TransientPool, TheLongestUnusedTextureGoesFirst) {
  test::NullDevice device;
  const TextureDesc other{32, 128, PixelFormat::kRgba8, 1};
  TransientPool pool(&device, 2 * TextureBytes(kSmall));
  const TextureId old = pool.Acquire(kSmall);
  const TextureId recent = pool.Acquire(other);
  pool.Release(old);
  pool.Release(recent);
  pool.Release(pool.Acquire({64, 32, PixelFormat::kRgba16F, 1}));
  EXPECT_EQ(pool.Acquire(other), recent);
  EXPECT_NE(pool.Acquire(kSmall), old);
}

TEST(TransientPool, TexturesInUseStayWhateverTheirSize) {
  test::NullDevice device;
  TransientPool pool(&device, 1);
  const TextureId first = pool.Acquire(kSmall);
  const TextureId second = pool.Acquire(kSmall);
  EXPECT_NE(first, second);
  EXPECT_EQ(device.num_alive(), 2);
}

}  // namespace
}  // namespace furrow::render
