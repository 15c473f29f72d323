// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "base/status.h"
#include "character/character.h"
#include "character/source_notes.h"
#include "render/settings/settings.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/render_thread.h"
#include "server/pipeline/video_encoders.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::server {

// The renderer of a daemon with its thread and its video encoders, or none.
class Rendering {
 public:
  using SharedCharacter = std::shared_ptr<const character::Character>;
  // Not empty: Start() does not wait for the renderer.
  struct Later {
    // Loads the character with pictures. Called on several threads at once.
    std::function<Result<SharedCharacter>(character::Pictures)> load;
    // Draws a draft meanwhile, and compiles programs ahead on one more thread.
    bool drafts = false;
    // Called on the render thread: the renderer is there, or has failed. `load` is the status of
    // loading all pictures.
    std::function<void(const Status& load)> on_started;
  };
  struct Parts {
    std::shared_ptr<const character::Character> character;  // not null
    const wrinkle::Skeleton* skeleton = nullptr;  // its own; not null; outlives this object
    std::string device;
    render::Settings settings;  // of the first pictures
    int max_video_encoders = 0;
    WorkBudget::Limits budget;                     // in pixels per second
    bool required = false;                         // without a renderer, Start() fails
    Metrics* metrics = nullptr;                    // not null; outlives this object
    std::function<void(FinishedPicture)> deliver;  // see RenderThread::OnPicture
    Later later;
  };

  // Without OpenGL, nothing is drawn, which is only logged unless a renderer is required.
  [[nodiscard]] Status Start(Parts parts);
  // While nobody watches yet, so that the first viewer does not wait for the shader compiler.
  void Prepare(const wrinkle::Rig& rig, const render::Settings& settings);
  // After RenderThread::Stop(): frees what was drawn with, while other threads go on. That takes
  // the kernel a tenth of a second, which would otherwise belong to the end of the process. False:
  // not yet; call it again soon.
  [[nodiscard]] bool LetGo();
  // Ends the thread. It may be in the middle of a large picture, which nothing can interrupt. From
  // `deadline` on, calls `give_up`, which must end the process; without a deadline, waits.
  void End(std::optional<Time> deadline, const std::function<void()>& give_up);

  // Null: nothing is drawn.
  [[nodiscard]] RenderThread* thread() const { return thread_.get(); }
  [[nodiscard]] const VideoEncoders* video() const { return video_.get(); }

 private:
  [[nodiscard]] RenderThread::Factory MakeFactory(const Parts& parts);
  [[nodiscard]] RenderThread::Factory MakeLateFactory(const Parts& parts);
  void MakeVideo(int max_encoders);

  SharedCharacter character_;
  SharedCharacter loaded_;  // later; written before Later::on_started, like the next
  Status load_status_;
  std::unique_ptr<VideoEncoders> video_;  // used by the thread
  std::unique_ptr<RenderThread> thread_;
  std::future<void> freed_;  // valid: LetGo() has begun
};

}  // namespace furrow::server
