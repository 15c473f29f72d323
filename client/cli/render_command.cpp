// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "client/cli/command.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_output.h"
#include "client/cli/inputs.h"
#include "client/cli/picture_settings.h"
#include "client/cli/pose_clip.h"
#include "client/cli/progress.h"
#include "motion/clip.h"
#include "render/pass_timer.h"
#include "render/renderer.h"
#include "wrinkle/blend_shape_pose.h"
#include "wrinkle/retarget.h"
#include "wrinkle/solver.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string file;
  std::string pose;
  std::string out;
  std::string character;
  std::string rig;
  std::string skeleton_map;
  std::string frames;
  std::string size = "640x640";
  std::string camera = "face";
  std::string format = "png";
  std::string device;
  PictureOptions picture;
  bool timings = false;
  int quality = 90;
};

// "A:B", both included, or "A".
bool ParseRange(const std::string& text, int* first, int* last) {
  const char* const end = text.data() + text.size();
  const auto a = std::from_chars(text.data(), end, *first);
  if (a.ec != std::errc()) return false;
  *last = *first;
  if (a.ptr != end) {
    if (*a.ptr != ':') return false;
    const auto b = std::from_chars(a.ptr + 1, end, *last);
    if (b.ec != std::errc() || b.ptr != end) return false;
  }
  return *first >= 0 && *first <= *last;
}

std::string CheckRange(std::string& text) {
  int first = 0;
  int last = 0;
  if (ParseRange(text, &first, &last)) return {};
  return "'" + text + "' is not A:B, both included and counted from 0, nor a single A";
}

// The recording, its solver and the character it is drawn on.
class Performance {
 public:
  static Result<std::unique_ptr<Performance>> Create(const RenderOptions& options);

  [[nodiscard]] int num_frames() const { return clip_.num_frames(); }
  [[nodiscard]] const character::Character& character() const { return character_; }
  // Solves frame `frame`, which must follow the one before: the filter remembers.
  Status Advance(int frame);
  // What to draw of the last frame solved; spans point into this object.
  [[nodiscard]] render::FrameRequest Request() const;

 private:
  motion::Clip clip_;
  character::Character character_;
  wrinkle::Retarget retarget_;
  wrinkle::BlendShapePose blend_shape_pose_;
  std::unique_ptr<wrinkle::SubjectSolver> solver_;
  wrinkle::LocalPose pose_;
  std::vector<wrinkle::Transform> local_;
  std::vector<glm::mat4> model_;
};

Result<std::unique_ptr<Performance>> Performance::Create(const RenderOptions& options) {
  auto self = std::make_unique<Performance>();
  auto character = LoadCharacterArgument(options.character, options.rig);
  if (!character.ok()) return character.status();
  self->character_ = std::move(*character);
  auto clip = options.pose.empty() ? LoadClipArgument(options.file)
                                   : PoseClip(self->character_, options.pose);
  if (!clip.ok()) return clip.status();
  self->clip_ = std::move(*clip);

  const auto matcher = LoadSkeletonMatcher(options.skeleton_map);
  if (!matcher.ok()) return matcher.status();
  const auto match =
      matcher->Match(self->clip_.skeleton, self->character_.rig, &self->character_.skeleton);
  auto binding = wrinkle::RigBinding::Create(self->character_.rig, self->clip_.skeleton,
                                             self->clip_.blend_shape_names,
                                             {.allow_missing = true, .aliases = match.aliases});
  if (!binding.ok()) return binding.status();
  WarnOfMissing(*binding, self->clip_);
  self->solver_ = std::make_unique<wrinkle::SubjectSolver>(
      std::make_shared<const wrinkle::RigBinding>(std::move(*binding)));
  self->retarget_ = character::MakeRetarget(match, self->clip_.skeleton, self->character_.skeleton);
  self->blend_shape_pose_ = wrinkle::BlendShapePose::Create(
      self->character_.rig, self->character_.skeleton, self->clip_.blend_shape_names);
  if (self->clip_.blend_shape_names.empty() &&
      self->retarget_.unmatched_source().size() == self->clip_.skeleton.joint_names().size()) {
    return Status(StatusCode::kNotFound, "no joint of the recording is one of the character's",
                  options.file, "name its joints with --skeleton-map, or choose a --character");
  }
  const int joints = self->character_.skeleton.num_joints();
  self->local_.resize(joints);
  self->model_.resize(joints);
  return self;
}

Status Performance::Advance(int frame) {
  clip_.GetPose(frame, &pose_);
  const double dt = frame == 0 ? 0.0 : clip_.times[frame] - clip_.times[frame - 1];
  const bool solved =
      solver_->Update(pose_, dt) == wrinkle::JobStatus::kOk &&
      retarget_.Run(pose_.joints, local_) == wrinkle::JobStatus::kOk &&
      blend_shape_pose_.Run(pose_.blend_shapes, local_) == wrinkle::JobStatus::kOk &&
      wrinkle::LocalToModelJob{&character_.skeleton, local_, model_}.Run() ==
          wrinkle::JobStatus::kOk;
  if (!solved)
    return {StatusCode::kInternal, "frame " + std::to_string(frame) + " could not be solved"};
  return {};
}

render::FrameRequest Performance::Request() const {
  render::FrameRequest request;
  request.model = model_;
  request.binding = &solver_->binding();
  request.wrinkle_weights = solver_->wrinkle_weights();
  request.filtered_values = solver_->filtered_values();
  return request;
}

// Writes pictures as they come back from the renderer: two stay in flight while the next is solved.
class PictureSink {
 public:
  PictureSink(render::Renderer& renderer, const RenderOptions& options)
      : renderer_(renderer), options_(options) {}

  Status Submit(const render::FrameRequest& request) {
    if (renderer_.in_flight() >= 2) {
      if (Status status = WriteOldest(); !status.ok()) return status;
    }
    return renderer_.Submit(request);
  }

  Status Finish() {
    while (renderer_.in_flight() > 0) {
      if (Status status = WriteOldest(); !status.ok()) return status;
    }
    return {};
  }

 private:
  Status WriteOldest() {
    const auto image = renderer_.Poll(true);
    if (!image.ok()) return image.status();
    const bool jpeg = options_.format == "jpeg";
    const auto bytes = render::EncodeImage(
        *image, jpeg ? render::ImageFormat::kJpeg : render::ImageFormat::kPng, options_.quality);
    if (!bytes.ok()) return bytes.status();
    char name[32];
    std::snprintf(name, sizeof name, "%06" PRIu64 ".%s", image->token, jpeg ? "jpg" : "png");
    return WriteFile(fs::path(options_.out) / name, *bytes);
  }

  render::Renderer& renderer_;
  const RenderOptions& options_;
};

double TakeMedian(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// A table of the passes in their order: medians over the frames, and their sums.
void PrintTimings(const std::vector<render::PassTime>& times) {
  struct Samples {
    std::vector<double> wall_ms;
    std::vector<double> cpu_ms;
  };
  std::vector<std::string> order;
  std::map<std::string, Samples> of_pass;
  for (const render::PassTime& time : times) {
    Samples& samples = of_pass[time.pass];
    if (samples.wall_ms.empty()) order.push_back(time.pass);
    samples.wall_ms.push_back(time.wall_ms);
    samples.cpu_ms.push_back(time.cpu_ms);
  }
  std::printf("%-16s %11s %11s\n", "", "wall", "processor");
  double wall = 0.0;
  double cpu = 0.0;
  for (const std::string& pass : order) {
    const double pass_wall = TakeMedian(&of_pass[pass].wall_ms);
    const double pass_cpu = TakeMedian(&of_pass[pass].cpu_ms);
    std::printf("%-16s %8.2f ms %8.2f ms\n", pass.c_str(), pass_wall, pass_cpu);
    wall += pass_wall;
    cpu += pass_cpu;
  }
  std::printf("%-16s %8.2f ms %8.2f ms\n", "frame", wall, cpu);
}

int RenderFile(const RenderOptions& options) {
  const auto settings = SettingsOf(options.picture);
  if (!settings.ok()) return Fail(settings.status());
  auto performance = Performance::Create(options);
  if (!performance.ok()) return Fail(performance.status());
  int first = 0;
  int last = (*performance)->num_frames() - 1;
  if (!options.frames.empty()) (void)ParseRange(options.frames, &first, &last);  // checked before
  if (last >= (*performance)->num_frames() || last < 0) {
    return Fail({StatusCode::kInvalidArgument,
                 "there is no frame " + std::to_string(std::max(last, 0)) + ": the recording has " +
                     std::to_string((*performance)->num_frames()) + ", counted from 0",
                 options.file});
  }
  auto renderer = render::Renderer::Create((*performance)->character(), {.device = options.device});
  if (!renderer.ok()) return Fail(renderer.status());
  const auto camera = (*renderer)->Preset(options.camera);
  if (!camera.ok()) return Fail(camera.status());
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return Fail({StatusCode::kIo, error.message(), options.out});

  render::PassTimer timer;
  if (options.timings) (*renderer)->SetObserver(&timer);
  PictureSink sink(**renderer, options);
  Progress progress("rendering", last + 1);
  for (int frame = 0; frame <= last; ++frame) {
    if (Status status = (*performance)->Advance(frame); !status.ok())
      return Fail(status.At(options.file));
    progress.Set(frame + 1);
    if (frame < first) continue;
    render::FrameRequest request = (*performance)->Request();
    request.settings = *settings;
    request.camera = *camera;
    (void)ParseSize(options.size, &request.width, &request.height);  // checked while parsing
    request.token = static_cast<std::uint64_t>(frame);
    if (Status status = sink.Submit(request); !status.ok()) return Fail(status);
  }
  if (Status status = sink.Finish(); !status.ok()) return Fail(status);
  if (options.timings) PrintTimings(timer.Take());
  return kDone;
}

}  // namespace

void AddRender(CLI::App& app, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand(
      "render", "Pictures of a recording or a pose, no network: DIR/000123.png for frame 123");
  CLI::Option* file =
      command->add_option("FILE", options->file, "BVH, glTF/GLB, VRMA or Live Link Face CSV");
  CLI::Option* pose = command->add_option(
      "--pose", options->pose,
      "Instead of FILE, one picture of the rig's reference poses: NAME[=WEIGHT],... or neutral; a "
      "wrinkle map's name stands for all poses that feed it");
  file->excludes(pose);
  command->add_option("--out", options->out, "Folder for the pictures; made if it is not there")
      ->required();
  command->add_option("--character", options->character,
                      "Character package (.glb); default: the one that ships");
  command->add_option("--rig", options->rig, "Wrinkle rig; default: the package's own");
  AddSkeletonMap(*command, options->skeleton_map);
  command->add_option("--frames", options->frames, "A:B, both included, from 0; default: all")
      ->check(CLI::Validator(CheckRange, ""));
  command->add_option("--size", options->size, "WxH in pixels, 16 to 4096")
      ->check(SizeValidator())
      ->capture_default_str();
  command->add_option("--camera", options->camera, render::ListCameraPresets())
      ->capture_default_str();
  command->add_option("--format", options->format, "png or jpeg")
      ->check(CLI::IsMember({"png", "jpeg"}))
      ->capture_default_str();
  command->add_option("--quality", options->quality, "JPEG quality")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  AddPictureOptions(*command, &options->picture);
  command->add_flag(
      "--timings", options->timings,
      "Print what each pass of a frame takes (medians); pictures take longer with it");
  command->add_option("--device", options->device,
                      "EGL device index or 'surfaceless'; default: the first that works");
  command->callback([options, &action] {
    if (options->file.empty() && options->pose.empty()) throw CLI::RequiredError("FILE or --pose");
    action = [options] { return RenderFile(*options); };
  });
}

}  // namespace furrow::cli
