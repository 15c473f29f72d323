// SPDX-License-Identifier: Apache-2.0
#include "render/scene/posed_meshes.h"

#include <algorithm>

#include "base/status.h"

namespace furrow::render {
namespace {

constexpr GLuint kSubjectAttribute = 7;  // of shaders/scene/pose.vert.glsl
constexpr GLuint kSubjectBinding = 2;    // of a mesh's vertex array
constexpr GLuint kFormerAttribute = 5;   // of shaders/scene/scene.vert.glsl
constexpr GLuint kFormerBinding = 1;     // of a posed mesh's vertex array

// Offsets in bytes. Mirrors the outputs of shaders/scene/pose.vert.glsl.
struct Layout {
  explicit Layout(const PoseShader& shader)
      : masks(shader.displaced ? 56 : 52),
        stride(masks + (shader.dynamic ? 16 * static_cast<GLuint>(shader.map_slots) : 0)) {}
  static constexpr GLuint kPosition = 0;
  static constexpr GLuint kNormal = 12;
  static constexpr GLuint kTangent = 24;
  static constexpr GLuint kUv = 40;
  static constexpr GLuint kSubject = 48;
  static constexpr GLuint kShare = 52;
  GLuint masks;
  GLuint stride;
};

// Describes posed vertices as the inputs of shaders/scene/scene.vert.glsl.
void DescribePosed(GLuint array, const gl::Buffer& vertices, const PoseShader& shader) {
  const Layout layout(shader);
  glVertexArrayVertexBuffer(array, 0, vertices.name(), 0, static_cast<GLsizei>(layout.stride));
  const auto attribute = [&](GLuint location, GLint size, GLuint offset) {
    glEnableVertexArrayAttrib(array, location);
    glVertexArrayAttribFormat(array, location, size, GL_FLOAT, GL_FALSE, offset);
    glVertexArrayAttribBinding(array, location, 0);
  };
  attribute(0, 3, Layout::kPosition);
  attribute(1, 3, Layout::kNormal);
  attribute(2, 4, Layout::kTangent);
  attribute(3, 2, Layout::kUv);
  glEnableVertexArrayAttrib(array, 4);
  glVertexArrayAttribIFormat(array, 4, 1, GL_UNSIGNED_INT, Layout::kSubject);
  glVertexArrayAttribBinding(array, 4, 0);
  if (shader.displaced) attribute(5, 1, Layout::kShare);
  for (GLuint slot = 0; slot < static_cast<GLuint>(shader.map_slots); ++slot) {
    if (shader.dynamic) {
      attribute(6 + slot, 4, layout.masks + 16 * slot);
    } else {
      glDisableVertexArrayAttrib(array, 6 + slot);
    }
  }
}

// Copies the vertices in `needed` that `former` does not know, for this frame alone. False: they
// have another layout.
bool AddUnknown(std::span<const ElementRange> needed, const gl::Buffer& vertices, GLuint stride,
                FormerVertices::Mesh* former) {
  const std::vector<ElementRange> unknown = Difference(needed, former->known);
  if (unknown.empty()) return true;
  if (former->stride != stride) return false;
  for (const ElementRange& range : unknown) {
    const auto first = static_cast<GLintptr>(range.first) * stride;
    glCopyNamedBufferSubData(vertices.name(), former->vertices.name(), first, first,
                             static_cast<GLsizeiptr>(range.count) * stride);
  }
  return true;
}

}  // namespace

std::size_t FormerVertices::num_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [index, mesh] : meshes) bytes += mesh.capacity;
  return bytes;
}

void PosedMeshes::BeginFrame(FormerVertices* former) {
  for (auto& [key, posed] : posed_) posed.is_fresh = false;
  former_ = former;
}

void PosedMeshes::EndFrame(FormerVertices* former) {
  std::erase_if(former->meshes, [this](const auto& item) {
    const auto found = posed_.find({item.first, Form::kIndexed});
    return found == posed_.end() || !found->second.is_fresh;
  });
  for (auto& [key, posed] : posed_) {
    if (key.second != Form::kIndexed || !posed.is_fresh) continue;
    FormerVertices::Mesh& mesh = former->meshes[key.first];
    std::swap(mesh.vertices, posed.vertices);
    std::swap(mesh.capacity, posed.capacity);
    mesh.count = posed.per_subject;
    mesh.stride = posed.stride;
    mesh.order = gpu_->meshes()[key.first].order;
    mesh.known = std::move(posed.needed);
    posed.is_fresh = false;
  }
  former_ = nullptr;
}

PosedMeshes::Source PosedMeshes::SourceOf(std::size_t mesh, Form form) {
  const GpuMesh& indexed = gpu_->meshes()[mesh];
  switch (form) {
    case Form::kIndexed: break;
    case Form::kUnindexed: {
      const GpuMesh& unindexed = gpu_->Unindexed(mesh);
      return {mesh, unindexed.vertex_array.name(), unindexed.num_vertices, 0};
    }
    case Form::kPatches: {
      const GpuPatches& patches = gpu_->Patches(mesh);
      return {mesh, patches.vertex_array.name(), indexed.num_vertices, patches.indices.name()};
    }
  }
  return {mesh, indexed.vertex_array.name(), indexed.num_vertices, indexed.indices.name()};
}

Result<PosedMeshes::Vertices> PosedMeshes::Get(std::size_t mesh, Form form,
                                               const PoseShader& shader, WrinklePart part,
                                               std::span<const std::uint32_t> subjects,
                                               std::span<const ElementRange> needed) {
  Posed& posed = posed_[{mesh, form}];
  const auto masks = shader.dynamic ? std::optional(part) : std::nullopt;
  // Passes that need other masks, or none, cannot use these vertices, because the layout differs.
  if (!posed.is_fresh || posed.masks != masks) {
    posed.masks = masks;
    const Source source = SourceOf(mesh, form);
    posed.needed.assign(needed.begin(), needed.end());
    if (needed.empty()) {
      posed.needed = {{0, static_cast<std::uint32_t>(source.num_vertices)}};
    }
    FURROW_RETURN_IF_ERROR(Pose(source, shader, subjects, &posed));
  }
  return Vertices{posed.vertex_array.name(), posed.per_subject};
}

// Reuses the storage of earlier frames while it fits, because the first use of new memory is slow.
void PosedMeshes::Reserve(std::size_t bytes, Posed* posed) {
  if (!posed->vertex_array) {
    posed->vertex_array = gl::MakeVertexArray();
    posed->subjects = gl::MakeBuffer();
  }
  if (!posed->vertices) posed->vertices = gl::MakeBuffer();
  // Also shrinks: after a crowd, storage of more than four times the need is given back.
  if (posed->capacity >= bytes && posed->capacity / 4 <= bytes) return;
  glNamedBufferData(posed->vertices.name(), static_cast<GLsizeiptr>(bytes), nullptr,
                    GL_DYNAMIC_COPY);
  posed->capacity = bytes;
}

Status PosedMeshes::Pose(const Source& source, const PoseShader& shader,
                         std::span<const std::uint32_t> subjects, Posed* posed) {
  const std::size_t count = static_cast<std::size_t>(source.num_vertices) * subjects.size();
  if (count > kMaxVertices) {
    return {StatusCode::kLimit,
            std::to_string(subjects.size()) + " subjects with a mesh of " +
                std::to_string(source.num_vertices) + " vertices exceed the limit of " +
                std::to_string(kMaxVertices) + " posed vertices per mesh",
            "others"};
  }
  const Result<GLuint> program = shaders_->Get(shader);
  FURROW_RETURN_IF_ERROR(program);
  Reserve(count * Layout(shader).stride, posed);
  gl::Upload(posed->subjects, subjects.data(), subjects.size_bytes());
  // One instance per subject: the divisor advances the subject's number once per instance.
  glVertexArrayVertexBuffer(source.vertex_array, kSubjectBinding, posed->subjects.name(), 0,
                            sizeof(std::uint32_t));
  glVertexArrayBindingDivisor(source.vertex_array, kSubjectBinding, 1);
  glEnableVertexArrayAttrib(source.vertex_array, kSubjectAttribute);
  glVertexArrayAttribIFormat(source.vertex_array, kSubjectAttribute, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(source.vertex_array, kSubjectAttribute, kSubjectBinding);

  glUseProgram(*program);
  glBindVertexArray(source.vertex_array);
  Capture(source, shader, subjects, *posed);
  DescribePosed(posed->vertex_array.name(), posed->vertices, shader);
  glVertexArrayElementBuffer(posed->vertex_array.name(), source.indices);
  posed->per_subject = source.num_vertices;
  posed->stride = Layout(shader).stride;
  if (!shader.displaced) DescribeFormer(source, *posed);
  posed->is_fresh = true;
  return {};
}

// The former vertices have a layout of their own, because other masks may have been active.
void PosedMeshes::DescribeFormer(const Source& source, const Posed& posed) {
  const GLuint array = posed.vertex_array.name();
  if (former_ == nullptr) {
    glDisableVertexArrayAttrib(array, kFormerAttribute);
    glVertexArrayVertexBuffer(array, kFormerBinding, 0, 0, 0);  // releases the buffer
    return;
  }
  const auto found = former_->meshes.find(source.mesh);
  const bool is_known = found != former_->meshes.end() &&
                        found->second.count == source.num_vertices &&
                        found->second.order == gpu_->meshes()[source.mesh].order &&
                        AddUnknown(posed.needed, posed.vertices, posed.stride, &found->second);
  glVertexArrayVertexBuffer(array, kFormerBinding,
                            is_known ? found->second.vertices.name() : posed.vertices.name(), 0,
                            static_cast<GLsizei>(is_known ? found->second.stride : posed.stride));
  glEnableVertexArrayAttrib(array, kFormerAttribute);
  glVertexArrayAttribFormat(array, kFormerAttribute, 3, GL_FLOAT, GL_FALSE, Layout::kPosition);
  glVertexArrayAttribBinding(array, kFormerAttribute, kFormerBinding);
}

// A crowd of morphed faces is captured in parts, because the sums of all faces may not fit one
// buffer. The vertices of the parts follow one another.
void PosedMeshes::Capture(const Source& source, const PoseShader& shader,
                          std::span<const std::uint32_t> subjects, const Posed& posed) {
  const std::size_t stride = Layout(shader).stride;
  const auto subject_bytes = static_cast<std::size_t>(source.num_vertices) * stride;
  const bool is_morphed = shader.morph_parts > 0;
  const std::size_t most = is_morphed ? morphs_->MaxSubjects(source.mesh) : subjects.size();
  // Points make transform feedback write each vertex once, in order, whatever the triangles share.
  // Nothing is rasterized.
  glEnable(GL_RASTERIZER_DISCARD);
  for (std::size_t first = 0; first < subjects.size(); first += most) {
    const std::size_t count = std::min(most, subjects.size() - first);
    if (is_morphed) morphs_->Bind(source.mesh, subjects.subspan(first, count));
    for (const ElementRange& range : posed.needed) {
      // Several subjects need all vertices.
      const std::size_t bytes = (count - 1) * subject_bytes + range.count * stride;
      glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, posed.vertices.name(),
                        static_cast<GLintptr>(first * subject_bytes + range.first * stride),
                        static_cast<GLsizeiptr>(bytes));
      glBeginTransformFeedback(GL_POINTS);
      glDrawArraysInstancedBaseInstance(GL_POINTS, static_cast<GLint>(range.first),
                                        static_cast<GLsizei>(range.count),
                                        static_cast<GLsizei>(count), static_cast<GLuint>(first));
      glEndTransformFeedback();
    }
  }
  glDisable(GL_RASTERIZER_DISCARD);
  // Later passes read the buffer as vertices, so it must not stay bound for feedback.
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
}

}  // namespace furrow::render
