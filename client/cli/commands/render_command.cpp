// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "character/package/package.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/progress.h"
#include "client/cli/render/picture_settings.h"
#include "client/cli/render/pose_clip.h"
#include "client/cli/render/subject_group.h"
#include "motion/clip/clip.h"
#include "render/gl/pass_timer.h"
#include "render/renderer.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::vector<std::string> files;
  std::string pose;
  std::string out;
  std::string character;
  std::string rig;
  std::string skeleton_map;
  std::string shape_map;
  motion::LoadOptions read;
  std::string frames;
  std::string size = "640x640";
  std::string camera = "face";
  std::string format = "png";
  std::string device;
  PictureOptions picture;
  GroupOptions group;
  bool timings = false;
  int quality = 90;
};

// Parses "A:B", both included, or "A".
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

// A validator of CLI11: an empty text means that the value is valid.
std::string CheckRange(std::string& text) {
  int first = 0;
  int last = 0;
  if (ParseRange(text, &first, &last)) return {};
  return "'" + text + "' is not A:B or A; frames are counted from 0, and B is included";
}

using Clips = std::vector<std::shared_ptr<const motion::Clip>>;

// Loads one clip per file. --pose gives a clip with one frame.
Result<Clips> LoadClips(const RenderOptions& options, const character::Character& character) {
  Clips clips;
  const auto add = [&](Result<motion::Clip> clip) {
    if (clip.ok()) clips.push_back(std::make_shared<const motion::Clip>(std::move(*clip)));
    return clip.status();
  };
  if (!options.pose.empty()) {
    FURROW_RETURN_IF_ERROR(add(PoseClip(character, options.pose)));
  }
  for (const std::string& file : options.files) {
    FURROW_RETURN_IF_ERROR(add(LoadClipArgument(file, options.read)));
  }
  return clips;
}

// Writes pictures when the renderer returns them. Two pictures stay in flight while the next frame
// is solved.
class PictureSink {
 public:
  PictureSink(render::Renderer& renderer, const RenderOptions& options)
      : renderer_(renderer), options_(options) {}

  Status Submit(const render::FrameRequest& request) {
    // The limit of the renderer.
    if (renderer_.in_flight() >= 2) {
      FURROW_RETURN_IF_ERROR(WriteOldest());
    }
    return renderer_.Submit(request);
  }

  Status Finish() {
    while (renderer_.in_flight() > 0) {
      FURROW_RETURN_IF_ERROR(WriteOldest());
    }
    return {};
  }

 private:
  Status WriteOldest() {
    const auto image = renderer_.Poll(true);
    FURROW_RETURN_IF_ERROR(image);
    const bool jpeg = options_.format == "jpeg";
    const auto bytes = render::EncodeImage(
        *image, jpeg ? render::ImageFormat::kJpeg : render::ImageFormat::kPng, options_.quality);
    FURROW_RETURN_IF_ERROR(bytes);
    char name[32];
    std::snprintf(name, sizeof name, "%06" PRIu64 ".%s", image->token, jpeg ? "jpg" : "png");
    return WriteFileAtomically(fs::path(options_.out) / name, AsText(*bytes), Flush::kNone);
  }

  render::Renderer& renderer_;
  const RenderOptions& options_;
};

// The median ignores single slow frames.
double TakeMedian(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Prints a table of the passes in their order: medians over the frames, and their sums.
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

Result<std::unique_ptr<SubjectGroup>> MakeGroup(const RenderOptions& options,
                                                const character::Character& character) {
  const auto clips = LoadClips(options, character);
  FURROW_RETURN_IF_ERROR(clips);
  const auto matcher = LoadSkeletonMatcher(options.skeleton_map, &character);
  FURROW_RETURN_IF_ERROR(matcher);
  const auto shapes = LoadShapeMatcher(options.shape_map);
  FURROW_RETURN_IF_ERROR(shapes);
  const std::vector<std::string> names =
      options.files.empty() ? std::vector<std::string>{""} : options.files;
  return SubjectGroup::Create(character, *clips, names, *matcher, *shapes, options.group);
}

// The first and last frame to draw.
Result<std::pair<int, int>> FramesOf(const RenderOptions& options, int num_frames) {
  int first = 0;
  int last = num_frames - 1;
  if (!options.frames.empty()) (void)ParseRange(options.frames, &first, &last);  // checked before
  if (last < num_frames && last >= 0) return std::pair(first, last);
  return Status(StatusCode::kInvalidArgument,
                "there is no frame " + std::to_string(std::max(last, 0)) + "; the recording has " +
                    Counted(num_frames, "frame") + ", counted from 0",
                options.files.empty() ? "" : options.files.front());
}

Status DrawFrames(const RenderOptions& options, const render::Settings& settings,
                  const std::pair<int, int>& frames, SubjectGroup& group,
                  render::Renderer& renderer) {
  PictureSink sink(renderer, options);
  Progress progress("rendering", frames.second + 1);
  // From frame 0 in any case: the filter of the weights depends on all frames before.
  for (int frame = 0; frame <= frames.second; ++frame) {
    FURROW_RETURN_IF_ERROR(group.Advance(frame));
    progress.Set(frame + 1);
    if (frame < frames.first) continue;
    render::FrameRequest request = group.Request();
    request.settings = settings;
    (void)ParseSize(options.size, &request.width, &request.height);  // checked while parsing
    request.token = static_cast<std::uint64_t>(frame);
    FURROW_RETURN_IF_ERROR(sink.Submit(request));
  }
  return sink.Finish();
}

// A picture of a character without a rig looks like one whose wrinkles are broken.
void WarnWithoutRig(const RenderOptions& options, const character::Character& character) {
  if (!character.rig.regions.empty()) return;
  const std::string glb = options.character.empty() ? "default.glb" : options.character;
  const std::string beside = character::RigBeside(character::FindCharacterFile(glb)).string();
  PrintWarnings({options.rig.empty() ? "the character is drawn without wrinkles: there is no rig " +
                                           beside + "; put it there, or choose one by --rig"
                                     : "the character is drawn without wrinkles: the rig " +
                                           options.rig + " has no regions"});
}

int RenderFiles(const RenderOptions& options) {
  const auto settings = SettingsOf(options.picture);
  if (!settings.ok()) return Fail(settings.status());
  const auto character =
      LoadCharacterArgument(options.character, options.rig, options.read, options.skeleton_map);
  if (!character.ok()) return Fail(character.status());
  auto group = MakeGroup(options, *character);
  if (!group.ok()) return Fail(group.status());
  const auto frames = FramesOf(options, (*group)->num_frames());
  if (!frames.ok()) return Fail(frames.status());
  WarnWithoutRig(options, *character);
  auto renderer = render::Renderer::Create(*character, {.device = options.device});
  if (!renderer.ok()) return Fail(renderer.status());
  const auto camera = (*renderer)->Preset(options.camera);
  if (!camera.ok()) return Fail(camera.status());
  int width = 0;
  int height = 0;
  (void)ParseSize(options.size, &width, &height);  // checked while parsing
  (*group)->FrameBy(*camera, static_cast<float>(width) / static_cast<float>(height));
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return Fail({StatusCode::kIo, error.message(), options.out});

  render::PassTimer timer;
  if (options.timings) (*renderer)->SetObserver(&timer);
  if (Status status = DrawFrames(options, *settings, *frames, **group, **renderer); !status.ok()) {
    return Fail(status);
  }
  if (options.timings) PrintTimings(timer.Take());
  return kDone;
}

void AddGroupOptions(CLI::App& command, GroupOptions* options) {
  command
      .add_option(
          "--subjects", options->subjects,
          "Number of subjects in the picture, which take the recordings in turn (default: one "
          "per FILE)")
      ->check(CLI::Range(1, render::kMaxSubjects));
  command
      .add_option("--spacing", options->spacing,
                  "Distance between subjects, in metres (default: chosen from the camera)")
      ->check(Within(0.05, 100.0));
  command
      .add_option(
          "--offset-frames", options->offset_frames,
          "Frames by which each subject is ahead of the previous one (default: subjects with "
          "the same recording are spread evenly)")
      ->check(CLI::Range(0, 1'000'000));
}

}  // namespace

void AddRender(CLI::App& app, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand(
      "render", "Render pictures of a recording or a pose, offline: DIR/000123.png for frame 123");
  CLI::Option* file = command->add_option("FILE", options->files,
                                          "Recordings: BVH, glTF/GLB, VRMA, FBX, Collada, Live "
                                          "Link Face CSV or a take (.mcap), or names of shipped "
                                          "recordings (performance, walk, ...); several "
                                          "files are drawn as several subjects in one picture");
  CLI::Option* pose = command->add_option(
      "--pose", options->pose,
      "Draw one picture of the rig's reference poses and of blend shapes instead of "
      "FILE: NAME[=WEIGHT],... or neutral; the name of a wrinkle map stands for "
      "all poses that feed it, and mouthSmile for both sides");
  file->excludes(pose);
  command->add_option("--out", options->out, "Folder for the pictures, created if missing")
      ->required();
  command->add_option("--character", options->character,
                      std::string(kCharacterHelp) + " (default: default)");
  command->add_option("--rig", options->rig,
                      "Wrinkle rig, by file or shipped name (default: the rig of the package)");
  AddSkeletonMap(*command, options->skeleton_map);
  AddShapeMap(*command, options->shape_map);
  AddReadOptions(*command, options->read);
  command
      ->add_option("--frames", options->frames,
                   "Frames to draw, A:B or A, counted from 0, B included (default: all)")
      ->check(CLI::Validator(CheckRange, ""));
  command->add_option("--size", options->size, "Width and height in pixels, 16 to 4096 each")
      ->check(SizeValidator())
      ->capture_default_str();
  const auto names = render::CameraPresetNames();
  const std::vector<std::string> cameras(names.begin(), names.end());
  command->add_option("--camera", options->camera, "Camera: " + render::ListCameraPresets())
      ->check(CLI::IsMember(cameras))
      ->type_name("")
      ->capture_default_str();
  command->add_option("--format", options->format, "Picture format: png or jpeg")
      ->check(CLI::IsMember({"png", "jpeg"}))
      ->capture_default_str();
  command->add_option("--quality", options->quality, "JPEG quality in percent")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  AddGroupOptions(*command, &options->group);
  AddPictureOptions(*command, &options->picture);
  command->add_flag("--timings", options->timings,
                    "Print the median time of each pass, in milliseconds; slows rendering down");
  command->add_option("--device", options->device,
                      "EGL device: an index or 'surfaceless' (default: the first that works)");
  command->callback([options, &action] {
    if (options->files.empty() && options->pose.empty()) throw CLI::RequiredError("FILE or --pose");
    action = [options] { return RenderFiles(*options); };
  });
}

}  // namespace furrow::cli
