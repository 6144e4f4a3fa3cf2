// SPDX-License-Identifier: Apache-2.0
// Distinguishes colour, depth and infrared by encodings and names.
#include "drivers/rosbag/topics.h"

#include <algorithm>
#include <cctype>
#include <tuple>
#include <utility>

namespace relievo::rosbag {
namespace {

constexpr std::size_t kMostTopics = 64;
constexpr const char* kRaw = "sensor_msgs/Image";
constexpr const char* kCompressed = "sensor_msgs/CompressedImage";

// "ir" as a word: "/ir/image", "/cam_ir1", "/ir_left", but not "/iris_0".
bool saysIr(std::string_view topic) {
  const auto lower = [&](std::size_t i) {
    return i < topic.size() ? std::tolower(static_cast<unsigned char>(topic[i])) : 0;
  };
  for (std::size_t i = 0; i < topic.size(); ++i) {
    if ((topic[i] == '/' || topic[i] == '_') && lower(i + 1) == 'i' && lower(i + 2) == 'r' &&
        std::isalpha(lower(i + 3)) == 0)
      return true;
  }
  return false;
}

Role roleOf(const std::string& topic, const PictureKind& kind) {
  const auto any = [&](std::initializer_list<const char*> words) {
    return std::ranges::any_of(words, [&](const char* word) { return speaksOf(topic, word); });
  };
  if (speaksOf(topic, "infra") || saysIr(topic)) return Role::Infrared;
  if (any({"confidence", "mask", "label", "disparity"})) return Role::Other;
  if (kind.distances) return any({"amplitude", "intensity"}) ? Role::Infrared : Role::Depth;
  // A coloured image of the depth, made for viewing.
  if (any({"depth"}) && !any({"rgb", "color", "colour"})) return Role::Other;
  return Role::Color;
}

// Reads the first picture; false if its encoding is unknown or it cannot be read.
bool look(BagFile& bag, Topic& topic) {
  bool known = false;
  eachMessage(bag, topic.connections.front(), 1, [&](const Range& content, const Record& record) {
    const auto message = readMessage(bag, content, record);
    const auto picture = message ? parsePicture(*message, topic.compressed) : std::nullopt;
    const auto kind = picture ? kindOf(*picture, message->bytes) : std::nullopt;
    if (!kind) return false;
    topic.first = *picture;
    topic.first_time = record.time;
    topic.kind = *kind;
    topic.role = roleOf(topic.name, *kind);
    return known = true;
  });
  return known;
}

// How many components of two names are the same from the left.
int sharedWords(const std::string& a, const std::string& b) {
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) count += a[i] == '/' ? 1 : 0;
  return count;
}

bool isRegistered(const Topic& topic) {
  return speaksOf(topic.name, "aligned") || speaksOf(topic.name, "registered") || speaksOf(topic.name, "depth_to_");
}

}  // namespace

bool speaksOf(const std::string& topic, std::string_view word) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == b; };
  return !std::ranges::search(topic, word, same).empty();
}

Topics findTopics(BagFile& bag) {
  Topics found;
  for (const auto& [id, connection] : bag.connections()) {
    const bool compressed = connection.type == kCompressed;
    if ((!compressed && connection.type != kRaw) || connection.messages == 0) continue;
    const auto known = std::ranges::find(found.pictures, connection.topic, &Topic::name);
    const bool fresh = known == found.pictures.end();
    if (fresh && found.pictures.size() == kMostTopics) continue;
    Topic& topic = fresh ? found.pictures.emplace_back() : *known;
    topic.name = connection.topic;
    topic.compressed = compressed;
    topic.connections.push_back(id);
    topic.messages += connection.messages;
    topic.chunks.insert(topic.chunks.end(), connection.chunks.begin(), connection.chunks.end());
  }
  for (Topic& topic : found.pictures) {
    std::ranges::sort(topic.chunks);
    const auto repeated = std::ranges::unique(topic.chunks);
    topic.chunks.erase(repeated.begin(), repeated.end());
  }
  found.unknown = std::erase_if(found.pictures, [&](Topic& topic) {
                    if (look(bag, topic)) return false;
                    found.packed_depth = found.packed_depth || speaksOf(topic.name, "compresseddepth");
                    return true;
                  }) > 0;
  return found;
}

FilmTopics chooseTopics(const std::vector<Topic>& topics) {
  FilmTopics film;
  const auto best = [&](Role role, auto worth) {
    std::optional<std::size_t> chosen;
    for (std::size_t i = 0; i < topics.size(); ++i) {
      if (topics[i].role == role && (!chosen || worth(topics[i]) > worth(topics[*chosen]))) chosen = i;
    }
    return chosen;
  };
  film.depth = best(Role::Depth, [](const Topic& t) { return std::tuple(isRegistered(t), t.messages); });
  const std::string near = film.depth ? topics[*film.depth].name : std::string();
  const auto worth = [&](const Topic& t) { return std::tuple(sharedWords(t.name, near), t.kind.color, t.messages); };
  film.color = best(Role::Color, worth);
  if (!film.color) film.color = best(Role::Infrared, worth);
  return film;
}

}  // namespace relievo::rosbag
