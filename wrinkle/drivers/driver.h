// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "wrinkle/drivers/driver_kinds.h"

namespace furrow::wrinkle {

// One driver of a rig: its name, its kind and the kind's fields. Only the member that `kind` names
// is read. The members are listed in driver_kinds.h: `pose` is a PoseDriver, `hinge` a HingeDriver,
// and so on.
struct Driver {
  enum class Kind {
#define FURROW_KIND_VALUE(Name, field) k##Name,
    FURROW_DRIVER_KINDS(FURROW_KIND_VALUE)
#undef FURROW_KIND_VALUE
  };
  std::string name;
  Kind kind = Kind::kPose;
#define FURROW_KIND_MEMBER(Name, field) Name##Driver field;
  FURROW_DRIVER_KINDS(FURROW_KIND_MEMBER)
#undef FURROW_KIND_MEMBER
};

// Returns `visit(fields)` for the fields of the driver's kind.
template <class Visitor>
auto VisitFields(const Driver& driver, Visitor visit) {
  switch (driver.kind) {
#define FURROW_KIND_CASE(Name, field) \
  case Driver::Kind::k##Name: return visit(driver.field);
    FURROW_DRIVER_KINDS(FURROW_KIND_CASE)
#undef FURROW_KIND_CASE
  }
  return visit(driver.pose);
}

// The kind's field in a rig file: "pose", "hinge", "blend_shape".
[[nodiscard]] constexpr std::string_view DriverKindName(Driver::Kind kind) {
  switch (kind) {
#define FURROW_KIND_NAME(Name, field) \
  case Driver::Kind::k##Name: return #field;
    FURROW_DRIVER_KINDS(FURROW_KIND_NAME)
#undef FURROW_KIND_NAME
  }
  return "";
}

}  // namespace furrow::wrinkle
