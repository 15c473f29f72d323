file(REMOVE_RECURSE
  "../generated/protocol/schema/common_generated.h"
  "../generated/protocol/schema/error_generated.h"
  "../generated/protocol/schema/goodbye_generated.h"
  "../generated/protocol/schema/hello_generated.h"
  "../generated/protocol/schema/image_generated.h"
  "../generated/protocol/schema/ping_generated.h"
  "../generated/protocol/schema/pong_generated.h"
  "../generated/protocol/schema/pose_generated.h"
  "../generated/protocol/schema/skeleton_offer_generated.h"
  "../generated/protocol/schema/skeleton_reply_generated.h"
  "../generated/protocol/schema/subscribe_pictures_generated.h"
  "../generated/protocol/schema/subscribe_reply_generated.h"
  "../generated/protocol/schema/subscribe_weights_generated.h"
  "../generated/protocol/schema/unsubscribe_generated.h"
  "../generated/protocol/schema/weights_generated.h"
  "../generated/protocol/schema/welcome_generated.h"
  "CMakeFiles/furrow_protocol_schemas"
)

# Per-language clean rules from dependency scanning.
foreach(lang )
  include(CMakeFiles/furrow_protocol_schemas.dir/cmake_clean_${lang}.cmake OPTIONAL)
endforeach()
