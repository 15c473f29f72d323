/* SPDX-License-Identifier: Apache-2.0 */
/* Prints the weights of one frame: watch ADDRESS. */
#include <furrow/furrow.h>
#include <stdio.h>

int main(int argc, char** argv) {
  furrow_connection* connection = NULL;
  float weights[FURROW_MAX_WEIGHTS];
  char name[FURROW_NAME_SIZE];
  furrow_frame frame = {sizeof frame};
  if (argc != 2 || furrow_open(argv[1], NULL, &connection) != FURROW_OK) return 2;
  while (furrow_weights(connection, NULL, weights, FURROW_MAX_WEIGHTS, &frame) != FURROW_OK) {
    if (furrow_poll(connection, 100) < FURROW_OK) return 1;
  }
  for (uint32_t i = 0; i < frame.count; ++i) {
    if (furrow_weight_name(connection, NULL, i, name, sizeof name) != FURROW_OK) return 1;
    printf("%s %.3f\n", name, weights[i]);
  }
  furrow_close(connection);
  return 0;
}
