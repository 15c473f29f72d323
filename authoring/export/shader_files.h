// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "authoring/export/engine.h"
#include "authoring/export/export_plan.h"
#include "authoring/export/text_template.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// A text file of an export.
struct TextFile {
  std::string name;  // relative to the export's folder: "shaders/furrow_skin.glsl"
  std::string text;
  int material = -1;  // index into ExportPlan::materials if the file is the shader of one
};

// What the templates of an engine may name, for the whole export. `files`: see WrinklesFile. Its
// list `materials` holds the data of each material, with `textures` ("9 textures"), the lists
// `maps`, `masks`, `weights` and `packs` (four weights each), and for each map `terms`: the weights
// that raise it, as expressions of the engine's language, one vector per mask.
[[nodiscard]] TemplateData ShaderData(const character::Character& character, const ExportPlan& plan,
                                      Engine engine,
                                      const std::map<std::string, std::string>& files);

// The shaders and scripts of an engine: files that are copied, and one file per material. Error:
// kInternal (a template is damaged).
[[nodiscard]] Result<std::vector<TextFile>> ShaderFiles(Engine engine, const TemplateData& data);

// README.md, which tells a technical artist what to do. Error: kInternal.
[[nodiscard]] Result<TextFile> ReadmeFile(Engine engine, const TemplateData& data);

}  // namespace furrow::authoring
