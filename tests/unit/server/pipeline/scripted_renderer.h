// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <latch>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "render/renderer.h"

namespace furrow::server {

// The results of the fake renderers in the order of the calls; further calls succeed. Used by the
// render thread only.
struct Script {
  std::deque<Status> create;
  std::deque<Status> submit;
  std::deque<Status> poll;
  std::latch* hold_first_submit = nullptr;
  std::latch* in_first_submit = nullptr;  // counted down when it holds
  int passes = 0;                         // of each picture, for the observer
  std::function<void(int)> on_pass;       // called in each pass
  int out_of_memory_submits = 0;          // the next calls throw
  int out_of_memory_polls = 0;
  std::deque<int> samples;                 // of the rendered requests
  std::deque<bool> moving;                 // the same
  std::deque<std::uint64_t> streams;       // the same
  std::vector<std::vector<float>> shapes;  // of the same
  int num_created = 0;
  bool is_software = false;

  static Status Next(std::deque<Status>* of) {
    if (of->empty()) return {};
    const Status status = of->front();
    of->pop_front();
    return status;
  }
};

class ScriptedRenderer : public render::Renderer {
 public:
  explicit ScriptedRenderer(Script* script) : script_(script) {}
  Status Submit(const render::FrameRequest& request) override {
    if (auto* latch = std::exchange(script_->in_first_submit, nullptr)) latch->count_down();
    if (auto* latch = std::exchange(script_->hold_first_submit, nullptr)) latch->wait();
    if (script_->out_of_memory_submits > 0) {
      --script_->out_of_memory_submits;
      throw std::bad_alloc();
    }
    FURROW_RETURN_IF_ERROR(DrawPasses());
    Status status = Script::Next(&script_->submit);
    if (status.ok()) ++in_flight_;
    if (status.ok()) script_->samples.push_back(request.settings.anti_aliasing.samples);
    if (status.ok()) script_->moving.push_back(request.is_moving);
    if (status.ok()) script_->streams.push_back(request.stream);
    if (status.ok()) script_->shapes.emplace_back(request.shapes.begin(), request.shapes.end());
    return status;
  }
  Result<render::Image> Poll(bool) override {
    if (script_->out_of_memory_polls > 0) {
      --script_->out_of_memory_polls;
      throw std::bad_alloc();
    }
    FURROW_RETURN_IF_ERROR(Script::Next(&script_->poll));
    if (in_flight_ == 0) return render::Image();
    --in_flight_;
    return render::Image{16, 16, std::vector<std::uint8_t>(16 * 16 * 3), 0, 75};
  }
  int in_flight() const override { return in_flight_; }
  bool is_software() const override { return script_->is_software; }
  void SetObserver(render::FrameGraphObserver* observer) override { observer_ = observer; }
  std::string description() const override { return "scripted"; }
  Result<render::Camera> Preset(std::string_view) const override { return render::Camera(); }

 private:
  Status DrawPasses() {
    if (script_->passes == 0) return {};
    observer_->BeginFrame(script_->passes);
    for (int pass = 0; pass < script_->passes; ++pass) {
      if (!observer_->Continues()) return {StatusCode::kUnavailable, "abandoned"};
      observer_->BeforePass("pass");
      if (script_->on_pass) script_->on_pass(pass);
      observer_->AfterPass("pass", {});
    }
    return {};
  }

  Script* script_;
  render::FrameGraphObserver* observer_ = nullptr;
  int in_flight_ = 0;
};

}  // namespace furrow::server
