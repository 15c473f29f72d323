// SPDX-License-Identifier: Apache-2.0
// Prints the weights of one frame: watch ADDRESS.
#include <chrono>
#include <cstdio>

#include <furrow/furrow.hpp>

static_assert(__cplusplus == 201703L, "this program is C++17");

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    furrow::Connection connection(argv[1], "consumer 1.0");
    furrow::Weights weights;
    while (!connection.Latest(weights)) connection.Poll(std::chrono::milliseconds(100));
    char subject[FURROW_NAME_SIZE];
    if (furrow_subject_name(connection.get(), 0, subject, sizeof subject) != FURROW_OK) return 1;
    const auto names = connection.Names(subject);
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::printf("%s %.3f\n", names[i].c_str(), weights.values[i]);
    }
  } catch (const furrow::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
