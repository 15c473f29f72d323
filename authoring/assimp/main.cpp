// SPDX-License-Identifier: Apache-2.0
// furrow-assimp: reads a model or an animation with assimp and writes glTF. `furrow`, `furrowd` and
// `furrow-author` start it with limits on memory and time, because assimp is not made for hostile
// files; see base/process/helper_call.h.
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/Importer.hpp>

#include "authoring/assimp/clip_reader.h"
#include "authoring/assimp/model_writer.h"
#include "authoring/assimp/scene_file.h"
#include "base/process/helper_call.h"
#include "base/status.h"
#include "motion/foreign/foreign_clip.h"
#include "motion/gltf/gltf_animation.h"

namespace furrow::authoring {
namespace {

Result<HelperReply> ConvertModel(std::string_view bytes, const std::string& extension) {
  Assimp::Importer importer;
  const Result<const aiScene*> scene = ReadScene(bytes, extension, Purpose::kModel, &importer);
  FURROW_RETURN_IF_ERROR(scene);
  HelperReply reply;
  Result<std::string> glb = WriteModel(**scene, &reply.notes);
  FURROW_RETURN_IF_ERROR(glb);
  for (std::string& note : reply.notes) note = OneLine(std::move(note));
  reply.payload = std::move(*glb);
  return reply;
}

Result<HelperReply> ConvertClip(std::string_view bytes, const std::string& extension,
                                const std::string& animation) {
  motion::ClipReport report;
  Result<std::string> glb = std::string();
  {
    Assimp::Importer importer;
    const Result<const aiScene*> scene =
        ReadScene(bytes, extension, Purpose::kAnimation, &importer);
    FURROW_RETURN_IF_ERROR(scene);
    const Result<motion::Clip> clip = ReadClip(**scene, animation, &report);
    FURROW_RETURN_IF_ERROR(clip);
    importer.FreeScene();  // the GLB needs the memory
    glb = motion::ClipToGlb(*clip);
  }
  FURROW_RETURN_IF_ERROR(glb);
  return HelperReply{motion::NotesOf(report), std::move(*glb)};
}

int Run(int argc, char** argv) {
  const std::string_view what = argc > 2 ? argv[1] : "";
  if (what == "model" && argc == 3) {
    return AnswerCall([&](std::string_view input) { return ConvertModel(input, argv[2]); });
  }
  if (what == "clip" && (argc == 3 || argc == 4)) {
    return AnswerCall([&](std::string_view input) {
      return ConvertClip(input, argv[2], argc == 4 ? argv[3] : "");
    });
  }
  std::fprintf(stderr,
               "usage: furrow-assimp model|clip EXTENSION [ANIMATION] <FILE\n"
               "A part of furrow, which starts it to read FBX, Collada and other models.\n");
  return 2;
}

}  // namespace
}  // namespace furrow::authoring

int main(int argc, char** argv) { return furrow::authoring::Run(argc, argv); }
