/* SPDX-License-Identifier: Apache-2.0 */
/* The header is C99, and the structs have the layout that bindings of other languages repeat. */
#include <stddef.h>

#include "client/c/include/furrow/furrow.h"

/* An array of a negative size, which is an error, if `condition` is false. */
#define CHECK_AT(line, condition) typedef char check_##line[(condition) ? 1 : -1]
#define CHECK_IN(line, condition) CHECK_AT(line, condition)
#define CHECK(condition) CHECK_IN(__LINE__, condition)

CHECK(sizeof(furrow_status) == 4);
CHECK(sizeof(furrow_state) == 4);
CHECK(sizeof(furrow_options) == 56);
CHECK(offsetof(furrow_options, token) == 32);
CHECK(sizeof(furrow_connection_info) == 32);
CHECK(sizeof(furrow_subscription) == 32);
CHECK(sizeof(furrow_frame) == 80);
CHECK(offsetof(furrow_frame, layout) == 16);
CHECK(offsetof(furrow_frame, age_us) == 48);
CHECK(offsetof(furrow_frame, timecode) == 56);
CHECK(offsetof(furrow_frame, timecode_rate_numerator) == 72);
CHECK(sizeof(furrow_callbacks) == 48);
CHECK(sizeof(furrow_joint) == 56);
CHECK(sizeof(furrow_skeleton) == 48);
CHECK(offsetof(furrow_skeleton, metres_per_unit) == 40);
CHECK(sizeof(furrow_pose) == 48);
CHECK(sizeof(furrow_skeleton_info) == 24);
CHECK(sizeof(furrow_pose_buffer) == 80);
CHECK(offsetof(furrow_pose_buffer, layout) == 48);

/* The ten lines of the manual, compiled as C. */
int FurrowTenLines(void) {
  furrow_connection* connection = NULL;
  float weights[FURROW_MAX_WEIGHTS];
  furrow_frame frame = {sizeof frame, 0, 0, 0, 0, 0, 0, 0, 0, "", 0, 0};
  if (furrow_open("furrow://127.0.0.1:9?subject=ada", NULL, &connection) != FURROW_OK) return -1;
  (void)furrow_poll(connection, 0);
  {
    const furrow_status status =
        furrow_weights(connection, "ada", weights, FURROW_MAX_WEIGHTS, &frame);
    furrow_close(connection);
    return (int)status;
  }
}
