// SPDX-License-Identifier: Apache-2.0
// The topics of pictures in a bag, and which of them are the film.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/rosbag/bag_file.h"
#include "drivers/rosbag/picture.h"

namespace relievo::rosbag {

enum class Role : std::uint8_t { Color, Depth, Infrared, Other };

struct Topic {
  std::string name;
  std::vector<std::uint32_t> connections;
  std::vector<std::uint32_t> chunks;  // with its messages, in the file's order
  std::uint64_t messages = 0;
  bool compressed = false;
  PictureMessage first;    // the first picture, without its data
  Duration first_time{0};  // when it was recorded
  PictureKind kind;
  Role role = Role::Other;
};

// All topics whose first message is a picture of a known encoding. `unknown`: there are others.
struct Topics {
  std::vector<Topic> pictures;
  bool unknown = false;
  bool packed_depth = false;  // of the unknown ones: a compressedDepth, such as RVL
};
[[nodiscard]] Topics findTopics(BagFile& bag);

// Indices of the film's topics. Of several depth topics the one that is registered to the colour already, else the one
// with most pictures; the colour whose name shares most with the depth's.
struct FilmTopics {
  std::optional<std::size_t> color, depth;
};
[[nodiscard]] FilmTopics chooseTopics(const std::vector<Topic>& topics);

// The words of a topic in lower case hold this word: "/camera/aligned_depth_to_color/image_raw", "aligned".
[[nodiscard]] bool speaksOf(const std::string& topic, std::string_view word);

}  // namespace relievo::rosbag
