// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/npy.h"

#include <cstdint>

#include "base/text.h"

namespace furrow::authoring {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMaxExtent = 1'000'000;
constexpr std::size_t kMaxExtents = 2;

unsigned ByteAt(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

// Splits the bytes into the header's text and the values. False if they do not fit.
bool Split(std::string_view bytes, std::string_view* header, std::string_view* data) {
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + 2) return false;
  const unsigned version = ByteAt(bytes, kMagic.size());
  if (version < 1 || version > 3) return false;
  const std::size_t width = version == 1 ? 2 : 4;  // bytes of the header's length
  const std::size_t begin = kMagic.size() + 2 + width;
  if (bytes.size() < begin) return false;
  std::size_t length = 0;
  for (std::size_t i = width; i-- > 0;) length = length << 8 | ByteAt(bytes, begin - width + i);
  if (bytes.size() - begin < length) return false;
  *header = bytes.substr(begin, length);
  *data = bytes.substr(begin + length);
  return true;
}

// Reads the header, a Python dictionary:
// {'descr': '<i2', 'fortran_order': False, 'shape': (12, 3), }
class HeaderReader {
 public:
  explicit HeaderReader(std::string_view text) : rest_(text) {}

  // False if the text is not such a dictionary.
  bool Read(NpyArray* array, bool* fortran) {
    bool has_type = false, has_order = false, has_shape = false;
    if (!Take("{")) return false;
    while (!Take("}")) {
      std::string key;
      if (!TakeText(&key) || !Take(":")) return false;
      if (key == "descr") {
        has_type = TakeText(&array->type);
        if (!has_type) return false;
      } else if (key == "fortran_order") {
        *fortran = Take("True");
        has_order = *fortran || Take("False");
        if (!has_order) return false;
      } else if (key == "shape") {
        has_shape = TakeShape(&array->shape);
        if (!has_shape) return false;
      } else {
        return false;
      }
      if (!Take(",") && !Peek("}")) return false;
    }
    return has_type && has_order && has_shape;
  }

 private:
  void SkipBlanks() {
    const std::size_t first = rest_.find_first_not_of(" \t\n\r");
    rest_.remove_prefix(first == std::string_view::npos ? rest_.size() : first);
  }

  bool Peek(std::string_view token) {
    SkipBlanks();
    return rest_.starts_with(token);
  }

  bool Take(std::string_view token) {
    if (!Peek(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  bool TakeText(std::string* text) {
    if (!Take("'")) return false;
    const std::size_t end = rest_.find('\'');
    if (end == std::string_view::npos) return false;
    text->assign(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    return true;
  }

  // Extents above the limit read as kMaxExtent + 1. Python 2 wrote some with the suffix L.
  bool TakeExtent(std::size_t* extent) {
    SkipBlanks();
    const std::size_t digits = rest_.find_first_not_of("0123456789");
    if (digits == 0 || digits == std::string_view::npos) return false;
    *extent = 0;
    for (const char c : rest_.substr(0, digits)) {
      *extent = *extent * 10 + static_cast<std::size_t>(c - '0');
      if (*extent > kMaxExtent) *extent = kMaxExtent + 1;
    }
    rest_.remove_prefix(digits);
    Take("L");
    return true;
  }

  // One more extent than the limit is kept, so that the caller can tell.
  bool TakeShape(std::vector<std::size_t>* shape) {
    shape->clear();
    if (!Take("(")) return false;
    while (!Take(")")) {
      std::size_t extent = 0;
      if (!TakeExtent(&extent)) return false;
      if (shape->size() <= kMaxExtents) shape->push_back(extent);
      if (!Take(",") && !Peek(")")) return false;
    }
    return true;
  }

  std::string_view rest_;
};

}  // namespace

long NpyArray::At(std::size_t index) const {
  const auto bits =
      static_cast<std::uint16_t>(ByteAt(data, 2 * index) | ByteAt(data, 2 * index + 1) << 8);
  return type[1] == 'u' ? static_cast<long>(bits)
                        : static_cast<long>(static_cast<std::int16_t>(bits));
}

Result<NpyArray> ParseNpy(std::string_view bytes, std::string_view source) {
  const auto error = [&](StatusCode code, std::string what) {
    return Status(code, std::move(what), std::string(source));
  };
  NpyArray array;
  bool fortran = false;
  std::string_view header;
  if (!Split(bytes, &header, &array.data))
    return error(StatusCode::kParse, "is not a file of NumPy's format .npy, or is cut off");
  if (!HeaderReader(header).Read(&array, &fortran))
    return error(StatusCode::kParse, "the header does not state descr, fortran_order and shape");
  if (array.type != "<u2" && array.type != "<i2")
    return error(StatusCode::kUnsupported,
                 "values of the type " + Quoted(array.type) + "; expected '<u2' or '<i2'");
  if (array.shape.empty() || array.shape.size() > kMaxExtents)
    return error(StatusCode::kUnsupported, "the array needs one or two extents");
  if (fortran && array.shape.size() > 1)
    return error(StatusCode::kUnsupported, "the array is stored in Fortran order");
  for (const std::size_t extent : array.shape) {
    if (extent > kMaxExtent) return error(StatusCode::kLimit, "an extent is above 1000000");
  }
  if (array.data.size() != array.num_values() * array.item_size())
    return error(StatusCode::kParse, "the shape states " + Counted(array.num_values(), "value") +
                                         ", but the file holds " +
                                         Counted(array.data.size(), "byte") + " of them");
  return array;
}

}  // namespace furrow::authoring
