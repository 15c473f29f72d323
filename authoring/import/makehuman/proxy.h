// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/formats/mhclo.h"
#include "authoring/import/makehuman/formats/obj.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// A mesh that is fitted to the base mesh: a garment, hair, eyes, brows, ...
struct Proxy {
  std::filesystem::path file;  // the .mhclo
  Mhclo fit;
  ObjMesh obj;  // one position per vertex of `fit`
};

// Reads a .mhclo file and the .obj beside it. Errors name the file: those of ReadFile(),
// ParseMhclo() and ParseObj(), and kSchema (the files have different numbers of vertices).
[[nodiscard]] Result<Proxy> ReadProxy(const std::filesystem::path& mhclo,
                                      std::size_t num_base_vertices);

struct FittedProxy {
  character::Mesh mesh;  // without a material
  int unweighted = 0;    // vertices without weights; they follow the root
  int truncated = 0;     // vertices with more than four joints
  int hidden_faces = 0;  // faces under what is worn above
};

// Fits a proxy to the base mesh. `hidden`: for each base vertex, whether what is worn above hides
// it; empty: none. A vertex is hidden if two of its three base vertices are (MakeHuman's rule), and
// a face if all its vertices are. Error: kInvalidArgument (a vertex 100 m or more away).
[[nodiscard]] Result<FittedProxy> FitProxy(const Proxy& proxy, const BaseMesh& base,
                                           const std::string& name,
                                           const std::vector<bool>& hidden);

}  // namespace furrow::authoring
