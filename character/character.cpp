// SPDX-License-Identifier: Apache-2.0
#include "character/character.h"

namespace furrow::character {

int Character::FindRigPicture(std::string_view picture_name) const {
  for (const auto& [known, index] : rig_pictures) {
    if (known == picture_name) return index;
  }
  return -1;
}

}  // namespace furrow::character
