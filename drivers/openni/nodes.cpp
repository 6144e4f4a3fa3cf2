// SPDX-License-Identifier: Apache-2.0
// Walks over a recording's records; their fields are OpenNI 2's DataRecords and XnPropNames.
#include "drivers/openni/nodes.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "platform/files/byte_reader.h"

namespace relievo::openni {
namespace {

constexpr std::size_t kMostNodes = 8;
constexpr std::size_t kMostPictures = std::size_t{1} << 20;  // of a node: nine hours
constexpr std::size_t kTableEntry = 20;                      // time, configuration, position
constexpr std::int64_t kLatestUs = std::int64_t{1} << 52;    // 142 years

using Bytes = std::span<const std::uint8_t>;

Node* findNode(std::vector<Node>& nodes, std::uint32_t id) noexcept {
  const auto found = std::ranges::find(nodes, id, &Node::id);
  return found == nodes.end() ? nullptr : &*found;
}

// Texts end with a zero.
std::string_view takeText(ByteReader& fields) noexcept {
  const std::string_view text = fields.text();
  return text.substr(0, text.find('\0'));
}

// Nullopt for devices, sound and what middleware makes.
std::optional<NodeKind> kindOf(std::uint32_t number) noexcept {
  for (const NodeKind kind : {NodeKind::Depth, NodeKind::Color, NodeKind::Infrared}) {
    if (number == static_cast<std::uint32_t>(kind)) return kind;
  }
  return std::nullopt;
}

std::optional<Node> readNode(const Record& record, Bytes bytes, bool wide) {
  ByteReader fields(bytes);
  Node node{.id = record.node, .codec = {}, .pictures = {}};
  static_cast<void>(fields.text());
  const auto kind = kindOf(fields.value<std::uint32_t>());
  if (!kind) return std::nullopt;
  node.kind = *kind;
  const Bytes codec = fields.take(4);
  node.codec.assign(codec.begin(), codec.end());
  if (!fields.ok()) return std::nullopt;
  if (record.op == Op::NodeAdded && wide) {
    node.empty = fields.value<std::uint32_t>() == 0 && fields.ok();
    static_cast<void>(fields.take(8 + 8));  // first and last time
    node.table = fields.value<std::uint64_t>();
  }
  return node;
}

void readProperty(Node& node, Bytes bytes) {
  ByteReader fields(bytes);
  const std::string_view name = takeText(fields);
  ByteReader value(fields.block());
  const auto whole = [&value]() -> std::uint64_t {
    return value.left() < 8 ? value.value<std::uint32_t>() : value.value<std::uint64_t>();
  };
  if (name == "xnMapOutputMode") {
    node.cols = value.value<std::uint32_t>();
    node.rows = value.value<std::uint32_t>();
  } else if (name == "oniPixelFormat") {
    node.format = whole();
  } else if (name == "xnPixelFormat") {
    node.old_format = whole();
  } else if (name == "xnCropping") {
    node.cropped = value.value<std::uint32_t>() != 0;
  }
}

bool isPictureOf(const std::optional<Record>& record, const Node& node) noexcept {
  return record && record->op == Op::Picture && record->node == node.id;
}

// The places that the node's table gives; none if it is damaged. Its first entry stands for no picture.
std::vector<PicturePlace> readTable(const RecordFile& file, const Node& node) {
  const auto record = node.table != 0 ? file.recordAt(node.table) : std::nullopt;
  if (!record || record->op != Op::PictureTable || record->node != node.id) return {};
  const auto bytes = file.read(record->data_begin, record->end, kMostPictures * kTableEntry);
  if (!bytes || bytes->size() % kTableEntry != 0 || bytes->size() < 2 * kTableEntry) return {};
  std::vector<PicturePlace> places;
  places.reserve(bytes->size() / kTableEntry - 1);
  ByteReader entries(Bytes(*bytes).subspan(kTableEntry));
  while (entries.left() > 0) {
    const auto time = static_cast<std::int64_t>(entries.value<std::uint64_t>());
    static_cast<void>(entries.value<std::uint32_t>());
    const auto at = entries.value<std::uint64_t>();
    if (time < 0 || time > kLatestUs || (!places.empty() && at <= places.back().record)) return {};
    places.push_back({.record = at, .time_us = time});
  }
  const bool sound =
      isPictureOf(file.recordAt(places.front().record), node) && isPictureOf(file.recordAt(places.back().record), node);
  return sound ? places : std::vector<PicturePlace>();
}

// True if every node with pictures has one.
bool readTables(const RecordFile& file, std::vector<Node>& nodes) {
  for (Node& node : nodes) node.pictures = readTable(file, node);
  const bool whole = std::ranges::all_of(nodes, [](const Node& node) { return node.empty || !node.pictures.empty(); });
  if (!whole) {
    for (Node& node : nodes) node.pictures.clear();
  }
  return whole;
}

void addPicture(const RecordFile& file, Node& node, const Record& record, std::uint64_t at) {
  const auto time_bytes = file.read(record.fields_begin, record.fields_begin + 8, 8);
  if (!time_bytes || node.pictures.size() >= kMostPictures) return;
  const auto time = static_cast<std::int64_t>(ByteReader(*time_bytes).value<std::uint64_t>());
  if (time >= 0 && time <= kLatestUs) node.pictures.push_back({.record = at, .time_us = time});
}

void addRecord(const RecordFile& file, std::vector<Node>& nodes, const Record& record) {
  const bool adds = record.op == Op::NodeAdded || record.op == Op::NodeAddedOld || record.op == Op::NodeAddedOldest;
  Node* const node = findNode(nodes, record.node);
  if (!adds && node == nullptr) return;
  const auto fields = file.fieldsOf(record);
  if (!fields) return;
  if (!adds) {
    readProperty(*node, *fields);
  } else if (auto added = readNode(record, *fields, file.wide());
             added && node == nullptr && nodes.size() < kMostNodes) {
    nodes.push_back(std::move(*added));
  }
}

}  // namespace

Result<std::vector<Node>> findNodes(const RecordFile& file, const std::atomic<bool>& cancelled) {
  std::vector<Node> nodes;
  bool first = true;
  std::uint64_t at = file.firstRecord();
  while (const auto record = file.recordAt(at)) {
    if (cancelled) return fail(ErrorCode::Cancelled, "interrupted while reading the recording");
    if (record->op == Op::End) break;
    if (record->op == Op::Picture) {
      if (std::exchange(first, false) && readTables(file, nodes)) break;
      if (Node* const node = findNode(nodes, record->node)) addPicture(file, *node, *record, at);
    } else if (first) {  // later records do not change a node's format
      addRecord(file, nodes, *record);
    }
    at = record->end;
  }
  return nodes;
}

}  // namespace relievo::openni
