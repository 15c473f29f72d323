// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "render/renderer.h"
#include "render/settings/settings.h"
#include "server/pipeline/render_mailbox.h"
#include "wrinkle/rig/rig.h"

namespace furrow::server {

// Jobs for RenderThread::Prepare(): small pictures of `character` at rest, which compile the
// programs of the pictures that viewers see first, in order of need: with all wrinkles, those of
// one map, or none; first full pictures, then those of a stream that are completed from former
// ones. Programs do not depend on the size of a picture or on its pose.
//
// Stills and other shading are left to those who ask for them. A pass that compiles for seconds
// cannot be interrupted, so preparing them would make the first viewer wait. Errors: those of
// RigBinding::Create().
[[nodiscard]] Result<std::vector<RenderJob>> Preparations(const character::Character& character,
                                                          const wrinkle::Rig& rig,
                                                          const render::Settings& settings,
                                                          const render::Camera& camera);

// Draws small pictures as Preparations() describes them, with all wrinkles, on the calling thread,
// which must be that of `renderer`. What they compile is in the driver's cache afterwards, for
// other renderers, too. Errors: those of Renderer::Preset(), RigBinding::Create() and
// Renderer::Render().
[[nodiscard]] Status WarmUp(render::Renderer* renderer, const character::Character& character,
                            const wrinkle::Rig& rig, const render::Settings& settings);

}  // namespace furrow::server
