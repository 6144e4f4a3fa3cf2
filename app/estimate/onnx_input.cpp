// SPDX-License-Identifier: Apache-2.0
// Field numbers are those of onnx.proto: ModelProto.graph 7, GraphProto.input 11 and initializer 5, and so on.
#include "app/estimate/onnx_input.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace relievo {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Field {
  std::uint64_t number = 0;
  std::uint64_t value = 0;  // of a varint
  Bytes bytes;              // of a message or a string
};

// The fields of one protobuf message, one after the other; nullopt at its end or where it is damaged.
class Fields {
 public:
  explicit Fields(Bytes bytes) : rest_(bytes) {}

  std::optional<Field> next() {
    if (rest_.empty()) return std::nullopt;
    const auto key = varint();
    if (!key) return damaged();
    Field field{.number = *key >> 3U};
    const std::uint64_t kind = *key & 7U;
    if (kind == 0) {
      const auto value = varint();
      if (!value) return damaged();
      field.value = *value;
      return field;
    }
    const auto length = kind == 1 ? 8 : kind == 5 ? 4 : kind == 2 ? varint() : std::nullopt;
    if (!length || *length > rest_.size()) return damaged();
    field.bytes = rest_.first(static_cast<std::size_t>(*length));
    rest_ = rest_.subspan(field.bytes.size());
    return field;
  }
  [[nodiscard]] bool isDamaged() const noexcept { return damaged_; }

 private:
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const std::uint8_t byte = rest_.front();
      rest_ = rest_.subspan(1);
      value |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }
  std::nullopt_t damaged() {
    damaged_ = true;
    rest_ = {};
    return std::nullopt;
  }

  Bytes rest_;
  bool damaged_ = false;
};

// The last field of this number: if there are several, protobuf uses the last.
Bytes messageIn(Bytes bytes, std::uint64_t number) {
  Bytes found;
  Fields fields(bytes);
  while (const auto field = fields.next()) {
    if (field->number == number) found = field->bytes;
  }
  return found;
}

std::string_view textIn(Bytes bytes, std::uint64_t number) {
  const Bytes text = messageIn(bytes, number);
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

// Each direction's length; 0 for one that has a name or nothing.
std::vector<std::uint64_t> shapeOf(Bytes value_info) {
  std::vector<std::uint64_t> shape;
  Fields dims(messageIn(messageIn(messageIn(value_info, 2), 1), 2));
  while (const auto dim = dims.next()) {
    if (dim->number != 1) continue;
    std::uint64_t length = 0;
    Fields parts(dim->bytes);
    while (const auto part = parts.next()) {
      if (part->number == 1) length = part->value;
    }
    shape.push_back(length);
  }
  return shape;
}

}  // namespace

Result<OnnxInput> onnxInputOf(Bytes model) {
  constexpr std::uint64_t kMost = 1 << 14, kMostSamples = 1 << 24;
  const Bytes graph = messageIn(model, 7);
  if (graph.empty()) return fail(ErrorCode::Corrupt, "this is not an ONNX model");
  std::vector<std::string_view> weights;  // old models list them among the inputs
  std::vector<Bytes> inputs;
  Fields fields(graph);
  while (const auto field = fields.next()) {
    if (field->number == 5) weights.push_back(textIn(field->bytes, 8));
    if (field->number == 11) inputs.push_back(field->bytes);
  }
  if (fields.isDamaged()) return fail(ErrorCode::Corrupt, "this ONNX model is damaged");
  std::erase_if(inputs, [&](Bytes input) { return std::ranges::find(weights, textIn(input, 1)) != weights.end(); });
  const auto shape = inputs.size() == 1 ? shapeOf(inputs.front()) : std::vector<std::uint64_t>{};
  if (shape.size() != 4 || shape[0] > 1 || shape[1] != 3 || shape[2] > kMost || shape[3] > kMost) {
    return fail(ErrorCode::Unsupported, "the network must take one picture, as 1 x 3 x height x width");
  }
  if (shape[2] * shape[3] > kMostSamples) {
    return fail(ErrorCode::Unsupported, "the network takes pictures of over 16.7 million samples; take a smaller one");
  }
  return OnnxInput{static_cast<int>(shape[3]), static_cast<int>(shape[2])};
}

}  // namespace relievo
