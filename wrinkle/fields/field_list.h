// SPDX-License-Identifier: Apache-2.0
#pragma once

// How the fields of a driver kind become known to the reader and the writer of rig files, without
// code for each kind outside its folder. A struct lists its fields in a static member function:
//
//   template <class Fields>
//   static void ListFields(Fields& fields) {
//     fields.Required("joint", &BallDriver::joint);
//     fields.Optional("bone", &BallDriver::bone);
//     fields.Choice("mode", &BallDriver::mode, {"smooth", "thesis"});
//   }
//
// - The names are those of the kind's schema (drivers/<kind>/<kind>.fbs), and the list has every
//   field of its table. The order is the order in which fields are written.
// - Required(): the field has the attribute `required` in the schema, which numbers cannot have.
//   It is always written.
// - Optional(): the field is written if it differs from the default, which is the initial value of
//   the member. The schema must state the same default.
// - Choice(): an enumeration, optional. The names are in the order of its values, which count from
//   0; in the schema it is an `enum : byte`.
// - Members are std::string, float, int, bool, glm::vec3 (Vec3), std::optional<glm::vec3> (a Vec3
//   without a default), structs that list their own fields (tables), and std::vectors of
//   std::string, float, int and such structs. An optional list is empty by default.
//
// A unit test compares all lists with the schema. A field that the schema lacks, or that has
// another type there, is also an error (kInternal) when a rig with the kind is read.
namespace furrow::wrinkle {

// True for structs that list their fields.
template <class T>
concept ListsFields = requires {
  &T::template ListFields<int>;
};

}  // namespace furrow::wrinkle
