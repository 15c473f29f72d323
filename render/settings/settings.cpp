// SPDX-License-Identifier: Apache-2.0
#include "render/settings/settings.h"

namespace furrow::render {

bool NeedsSkinPipeline(View view, const Settings& settings) {
  return view >= View::kShadow || (view == View::kFinal && settings.shading == Shading::kSkin);
}

}  // namespace furrow::render
