// SPDX-License-Identifier: Apache-2.0
// Writes MCAP by its specification (mcap.dev), databases by SQLite with the tables of rosbag2.
#include "tests/support/film/recording/ros2_bags.h"

#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <map>
#include <stdexcept>

#include "tests/support/byte_writer.h"
#include "tests/support/film/recording/ros_messages.h"

namespace relievo::test {
namespace {

std::string packed(const std::string& plain, const std::string& compression) {
  if (compression.empty()) return plain;
  std::string out(plain.size() * 2 + 1024, '\0');
  const bool lz4 = compression == "lz4";
  const std::size_t size = lz4 ? LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr)
                               : ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1);
  if (lz4 ? LZ4F_isError(size) != 0 : ZSTD_isError(size) != 0) throw std::runtime_error(compression);
  out.resize(size);
  return out;
}

std::string record(std::uint8_t op, const std::string& data) {
  return ByteWriter().add(op).add(static_cast<std::uint64_t>(data.size())).raw(data).bytes();
}

std::string descriptions(const Ros2Recording& recording, std::size_t topic) {
  const auto id = static_cast<std::uint16_t>(topic + 1);
  const auto& [name, type] = recording.topics[topic];
  const std::string schema = ByteWriter().add(id).text(type).text("ros2msg").text(std::string(300, '#')).bytes();
  const std::string channel = ByteWriter().add(id).add(id).text(name).text("cdr").text("").bytes();
  return record(3, schema) + record(4, channel);
}

std::string message(const Ros2Recording::Message& message, std::uint32_t number) {
  return record(5, ByteWriter()
                       .add(static_cast<std::uint16_t>(message.topic + 1))
                       .add(number)
                       .add(message.time_ns)
                       .add(message.time_ns)
                       .raw(message.data)
                       .bytes());
}

void check(sqlite3* database, int code) {
  if (code != SQLITE_OK && code != SQLITE_DONE) throw std::runtime_error(sqlite3_errmsg(database));
}

}  // namespace

std::string mcapOf(const Ros2Recording& recording, const McapForm& form) {
  const std::string magic = "\x89MCAP0\r\n";
  std::string file = magic + record(1, ByteWriter().text("ros2").text("test").bytes());
  std::string summary;
  std::vector<bool> introduced(recording.topics.size());
  int chunks = 0;
  for (std::size_t i = 0; i < recording.messages.size();) {
    std::string content;
    std::map<std::uint16_t, ByteWriter> index;
    const std::int64_t first = recording.messages[i].time_ns;
    std::int64_t last = first;
    for (std::size_t n = 0; n < form.chunk_messages && i < recording.messages.size(); ++n, ++i) {
      const auto& next = recording.messages[i];
      const auto channel = static_cast<std::uint16_t>(next.topic + 1);
      if (!introduced[next.topic]) content += descriptions(recording, next.topic);
      introduced[next.topic] = true;
      index[channel].add(next.time_ns).add(static_cast<std::uint64_t>(content.size()));
      content += message(next, static_cast<std::uint32_t>(i));
      last = next.time_ns;
    }
    if (!form.chunks) {
      file += content;
      continue;
    }
    const std::string small = packed(content, form.compression);
    ByteWriter chunk;
    chunk.add(first).add(last).add(static_cast<std::uint64_t>(content.size())).add(std::uint32_t{0});
    chunk.text(form.compression).add(static_cast<std::uint64_t>(small.size())).raw(small);
    const std::uint64_t begin = file.size();
    file += record(6, chunk.bytes());
    const std::uint64_t length = file.size() - begin;
    ByteWriter offsets;
    for (const auto& [channel, entries] : index) {
      if (!form.index) break;
      offsets.add(channel).add(static_cast<std::uint64_t>(file.size()));
      file += record(7, ByteWriter().add(channel).text(entries.bytes()).bytes());
    }
    ++chunks;
    if (form.damaged && chunks == 1) continue;
    ByteWriter info;
    info.add(first).add(last).add(begin + (form.damaged && chunks > 2 ? 1 : 0)).add(length).text(offsets.bytes());
    info.add(static_cast<std::uint64_t>(file.size()) - begin - length).text(form.compression);
    info.add(static_cast<std::uint64_t>(small.size())).add(static_cast<std::uint64_t>(content.size()));
    summary += record(8, info.bytes());
  }
  if (!form.summary) return file;
  file += record(0xf, ByteWriter().add(std::uint32_t{0}).bytes());
  for (std::size_t topic = 0; topic < recording.topics.size(); ++topic) summary += descriptions(recording, topic);
  const std::uint64_t begin = file.size();
  file += summary + record(2, ByteWriter().add(begin).add(std::uint64_t{0}).add(std::uint32_t{0}).bytes());
  return file + magic;
}

std::string db3Of(const Ros2Recording& recording, bool log, const char* last) {
  sqlite3* database = nullptr;
  check(database, sqlite3_open(":memory:", &database));
  const auto run = [&](const char* words) {
    check(database, sqlite3_exec(database, words, nullptr, nullptr, nullptr));
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL)");
  run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  run("BEGIN");
  sqlite3_stmt* insert = nullptr;
  check(database, sqlite3_prepare_v2(database, "INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", -1, &insert, nullptr));
  for (std::size_t i = 0; i < recording.topics.size(); ++i) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(i + 1));
    sqlite3_bind_text(insert, 2, recording.topics[i].name.c_str(), -1, SQLITE_TRANSIENT);
    sqlite3_bind_text(insert, 3, recording.topics[i].type.c_str(), -1, SQLITE_TRANSIENT);
    check(database, sqlite3_step(insert));
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  check(database, sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1,
                                     &insert, nullptr));
  for (const auto& [topic, time_ns, data] : recording.messages) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(topic + 1));
    sqlite3_bind_int64(insert, 2, time_ns);
    sqlite3_bind_blob(insert, 3, data.data(), static_cast<int>(data.size()), SQLITE_TRANSIENT);
    check(database, sqlite3_step(insert));
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run("COMMIT");
  run(last);
  sqlite3_int64 size = 0;
  unsigned char* const bytes = sqlite3_serialize(database, "main", &size, 0);
  std::string file(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  sqlite3_close(database);
  constexpr std::size_t kVersions = 18;
  if (log) file.replace(kVersions, 2, "\2\2");
  return file;
}

Ros2Recording depthOnRos2() {
  constexpr std::uint32_t kCols = 16, kRows = 12;
  Ros2Recording recording;
  const auto depth = recording.connect("/camera/depth/image_raw", "sensor_msgs/msg/Image");
  const auto info = recording.connect("/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo");
  const auto frames = recording.connect("/tf", "tf2_msgs/msg/TFMessage");
  recording.write(info, 1, ros2CameraInfo({.cols = kCols, .rows = kRows, .focal_x = 16, .focal_y = 16}));
  recording.write(frames, 1, ros2FrameMotion("base", "camera", {0, 0, 0}, {0, 0, 0, 1}));
  for (int k = 0; k < 4; ++k) {
    ByteWriter samples;
    for (std::uint32_t i = 0; i < kCols * kRows; ++i) samples.add(static_cast<std::uint16_t>(1000 + i));
    const std::int64_t ns = 1'000'000'000 + k * 33'000'000LL;
    recording.write(depth, ns,
                    ros2Image({.stamp_ns = ns,
                               .cols = kCols,
                               .rows = kRows,
                               .step = 2 * kCols,
                               .encoding = "16UC1",
                               .data = samples.bytes()}));
  }
  return recording;
}

}  // namespace relievo::test
