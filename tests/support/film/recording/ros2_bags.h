// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 2, MCAP and SQLite, for tests.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace relievo::test {

// Topics and messages of a recording, in the order in which they were recorded.
struct Ros2Recording {
  struct Topic {
    std::string name, type;  // type: "sensor_msgs/msg/Image"
  };
  struct Message {
    std::size_t topic = 0;
    std::int64_t time_ns = 0;
    std::string data;
  };
  std::vector<Topic> topics;
  std::vector<Message> messages;
  std::size_t connect(const std::string& name, const std::string& type) {
    topics.push_back({name, type});
    return topics.size() - 1;
  }
  void write(std::size_t topic, std::int64_t time_ns, std::string data) {
    messages.push_back({topic, time_ns, std::move(data)});
  }
};

struct McapForm {
  std::string compression;  // "", "lz4", "zstd"
  bool chunks = true;       // or messages alone
  bool summary = true;      // or as a recorder leaves it that was killed
  bool index = true;        // of messages, behind each chunk
  bool damaged = false;     // the summary: it lacks the first chunk, and the place of the third one and later is wrong
  std::size_t chunk_messages = 8;
};
[[nodiscard]] std::string mcapOf(const Ros2Recording& recording, const McapForm& form);
// `log`: as of a recorder that kept a log (WAL), which is gone.
// `last`: what the database is told at the end.
[[nodiscard]] std::string db3Of(const Ros2Recording& recording, bool log = false, const char* last = "");

// Four depth pictures of 16 x 12 samples, with a camera's parameters and its place.
[[nodiscard]] Ros2Recording depthOnRos2();

}  // namespace relievo::test
