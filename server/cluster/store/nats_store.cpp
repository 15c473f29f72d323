// SPDX-License-Identifier: Apache-2.0
#include "base/process/module.h"
#include "server/cluster/store/store.h"

namespace furrow::server {

Result<std::unique_ptr<Store>> MakeNatsStore(const StoreOptions& options) {
  const auto path = ModulePath("furrow-nats.so");
  std::string why;  // names the file that is missing
  void* const make = LoadFromModule(path, "FurrowNatsStore", &why);
  if (make == nullptr) {
    return Status(StatusCode::kUnavailable, why.empty() ? path.string() + " has no store" : why,
                  "--cluster", "install the package furrow-cluster");
  }
  return std::unique_ptr<Store>(reinterpret_cast<MakeStore>(make)(options));
}

}  // namespace furrow::server
