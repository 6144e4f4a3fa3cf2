// SPDX-License-Identifier: Apache-2.0
// Media source on a bag: which topics are streams, their times, and seeking.
#include "drivers/rosbag/rosbag.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "drivers/rosbag/bag_file.h"
#include "drivers/rosbag/cameras.h"
#include "drivers/rosbag/topics.h"
#include "platform/files/answered_file.h"

namespace relievo {
namespace {

using namespace rosbag;

constexpr Duration kOneClock = std::chrono::seconds(2);  // stamps of one clock lag behind the recording by less
constexpr double kUsualUnitMm = 1;

constexpr const char* kNoPictures =
    "the bag has no pictures (sensor_msgs/Image, CompressedImage); record a camera's topics";
constexpr const char* kNoKnownPictures =
    "the bag's pictures have no known encoding; record them raw, as JPEG or as PNG";
constexpr const char* kPackedDepth =
    "the bag's depth is packed as compressedDepth in a way that is not read (RVL, not PNG); play the bag through "
    "image_transport (republish compressedDepth raw) and record that";

Error cancelledError() noexcept {
  return {ErrorCode::Cancelled, 0, "interrupted while reading the bag"};
}

// Where a message begins: in which chunk, and at which byte of it.
struct Place {
  std::uint32_t chunk = 0;
  std::uint64_t at = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

class RosbagSource final : public MediaSource {
 public:
  ~RosbagSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    cancelled_ = false;
    auto bag = openBag(url.starts_with("file:") ? url.substr(5) : url, cancelled_);
    if (!bag) return std::unexpected(bag.error());
    bag_ = std::move(*bag);
    Topics topics = findTopics(*bag_);
    if (cancelled_) return std::unexpected(cancelledError());
    if (const auto failure = bag_->failure()) return std::unexpected(*failure);
    if (topics.pictures.empty()) {
      if (topics.packed_depth) return fail(ErrorCode::Unsupported, kPackedDepth);
      if (topics.unknown) return fail(ErrorCode::Unsupported, kNoKnownPictures);
      return fail(ErrorCode::NotFound, kNoPictures);
    }
    topics_ = std::move(topics.pictures);
    const FilmTopics film = chooseTopics(topics_);
    if (!film.depth && topics.packed_depth) return fail(ErrorCode::Unsupported, kPackedDepth);
    if (!film.color && !film.depth) return fail(ErrorCode::NotFound, kNoPictures);
    chooseClock(film);
    chooseChunks(film);
    place_ = {};
    auto description = describe(film);
    bag_->endSearch();
    return description;
  }

  // Stamps, unless one is absent or they come from two clocks.
  void chooseClock(const FilmTopics& film) {
    Duration least = Duration::max(), most = Duration::min(), first_stamp = Duration::max();
    Duration first_recorded = Duration::max();
    stamped_ = true;
    for (const auto& chosen : {film.color, film.depth}) {
      if (!chosen) continue;
      const Topic& topic = topics_[*chosen];
      const Duration lag = topic.first_time - topic.first.stamp;
      least = std::min(least, lag);
      most = std::max(most, lag);
      first_stamp = std::min(first_stamp, topic.first.stamp);
      first_recorded = std::min(first_recorded, topic.first_time);
      stamped_ = stamped_ && topic.first.stamp > Duration(0);
    }
    stamped_ = stamped_ && most - least <= kOneClock;
    start_ = stamped_ ? first_stamp : first_recorded;
  }

  void chooseChunks(const FilmTopics& film) {
    chunks_.clear();
    streams_of_.clear();
    for (const auto& chosen : {film.color, film.depth}) {
      if (!chosen) continue;
      const Topic& topic = topics_[*chosen];
      chunks_.insert(chunks_.end(), topic.chunks.begin(), topic.chunks.end());
      for (const std::uint32_t connection : topic.connections) streams_of_[connection] = *chosen;
    }
    std::ranges::sort(chunks_);
    const auto repeated = std::ranges::unique(chunks_);
    chunks_.erase(repeated.begin(), repeated.end());
  }

  Result<Description> describe(const FilmTopics& film) {
    Description description;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const bool chosen = film.color == i || film.depth == i;
      description.streams.push_back(streamOf(static_cast<int>(i), chosen));
      description.duration = std::max(description.duration, description.streams.back().duration);
    }
    if (film.depth) {
      const Topic& depth = topics_[*film.depth];
      auto& tags = description.streams[*film.depth].tags;
      tags.insert(depth.kind.tags.begin(), depth.kind.tags.end());
      if (depth.kind.tags.empty()) {
        const double unit = unitOf(*bag_, depth).value_or(kUsualUnitMm);
        tags.insert({{"DEPTH_UNIT", std::to_string(unit)}, {"DEPTH_INVALID", "0+65535"}});
      }
      const auto unit = tags.find("DEPTH_UNIT");
      const auto registration = film.color && unit != tags.end()
                                    ? registrationOf(*bag_, depth, topics_[*film.color], std::stod(unit->second))
                                    : std::nullopt;
      if (registration) tags["DEPTH_REGISTRATION"] = *registration;
    }
    return description;
  }

  StreamInfo streamOf(int index, bool chosen) {
    const Topic& topic = topics_[static_cast<std::size_t>(index)];
    StreamInfo stream;
    stream.index = index;
    stream.kind = chosen ? StreamKind::Video : StreamKind::Other;
    stream.codec = topic.kind.codec;
    stream.pixel_format = topic.kind.pixel_format;
    if (!stream.pixel_format.empty()) stream.bits = static_cast<int>(8 * topic.kind.sample_bytes);
    stream.width = static_cast<int>(topic.kind.cols);
    stream.height = static_cast<int>(topic.kind.rows);
    stream.tags["TITLE"] = topic.name;
    if (!chosen || topic.messages < 2) return stream;
    const Duration first = (stamped_ ? topic.first.stamp : topic.first_time) - start_;
    const Duration last = lastTime(topic).value_or(first);
    stream.frame_period = (last - first) / static_cast<std::int64_t>(topic.messages - 1);
    stream.duration = last + stream.frame_period;
    return stream;
  }

  [[nodiscard]] static bool isOf(const Topic& topic, std::uint32_t connection) noexcept {
    return std::ranges::find(topic.connections, connection) != topic.connections.end();
  }

  // From the film's start.
  [[nodiscard]] std::optional<Duration> timeOf(const Range& content, const Record& record) const {
    if (!stamped_) return record.time - start_;
    std::array<std::uint8_t, 12> begin{};
    const auto stamp = parseStamp(Bytes(begin).first(content.read(record.data_begin, begin)));
    return stamp ? std::optional(*stamp - start_) : std::nullopt;
  }

  std::optional<Duration> lastTime(const Topic& topic) {
    std::optional<Duration> last;
    const Range& content = bag_->content(topic.chunks.back());
    MessageWalk walk(*bag_, content);
    while (const auto record = walk.next()) {
      if (isOf(topic, record->connection)) last = timeOf(content, *record);
    }
    return last;
  }

  Result<std::optional<Packet>> readPacket() override {
    while (place_.chunk < chunks_.size()) {
      if (cancelled_) return std::unexpected(cancelledError());
      const Range& content = bag_->content(chunks_[place_.chunk]);
      MessageWalk walk(*bag_, content, place_.at);
      const auto record = walk.next();
      auto packet = record ? packetOf(content, *record) : std::nullopt;
      place_ = record ? Place{place_.chunk, walk.at()} : Place{place_.chunk + 1, 0};
      if (packet) return packet;
      if (const auto failure = bag_->failure()) return std::unexpected(*failure);
    }
    if (cancelled_) return std::unexpected(cancelledError());
    return std::nullopt;
  }

  std::optional<Packet> packetOf(const Range& content, const Record& record) const {
    const auto stream = streams_of_.find(record.connection);
    if (stream == streams_of_.end()) return std::nullopt;
    const Topic& topic = topics_[stream->second];
    auto message = readMessage(*bag_, content, record);
    const auto picture = message ? parsePicture(*message, topic.compressed) : std::nullopt;
    if (!picture || (!topic.compressed && picture->encoding != topic.first.encoding)) return std::nullopt;
    auto packet = rosbag::packetOf(topic.kind, *picture, std::move(message->bytes));
    const auto time = timeOf(content, record);
    if (!packet || !time) return std::nullopt;
    packet->stream = static_cast<int>(stream->second);
    packet->pts = packet->dts = MediaTime(*time);
    return packet;
  }

  Result<void> seekTo(MediaTime target) override {
    Place earliest{.chunk = static_cast<std::uint32_t>(chunks_.size()), .at = 0};
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const bool chosen = streams_of_.contains(topics_[i].connections.front());
      if (chosen) earliest = std::min(earliest, findPicture(topics_[i], target.time_since_epoch()));
      if (cancelled_) return std::unexpected(cancelledError());
    }
    place_ = earliest;
    return {};
  }

  // The topic's last picture at or before `target`, or its first.
  Place findPicture(const Topic& topic, Duration target) {
    std::size_t low = 0, high = topic.chunks.size();
    while (high - low > 1) {  // the picture is in chunk `low` or a later one before `high`
      const std::size_t middle = low + (high - low) / 2;
      const auto first = pictureIn(topic, topic.chunks[middle], Duration::min());
      (first && first->second <= target ? low : high) = middle;
    }
    const auto found = pictureIn(topic, topic.chunks[low], target);
    const auto chunk = std::ranges::lower_bound(chunks_, topic.chunks[low]) - chunks_.begin();
    return {.chunk = static_cast<std::uint32_t>(chunk), .at = found ? found->first : 0};
  }

  // Position and time of the last picture in the chunk at or before `target`, or of its first.
  std::optional<std::pair<std::uint64_t, Duration>> pictureIn(const Topic& topic, std::uint32_t chunk,
                                                              Duration target) {
    std::optional<std::pair<std::uint64_t, Duration>> found;
    const Range& content = bag_->content(chunk);
    MessageWalk walk(*bag_, content);
    for (;;) {
      const std::uint64_t at = walk.at();
      const auto record = walk.next();
      if (!record) break;
      if (!isOf(topic, record->connection)) continue;
      const auto time = timeOf(content, *record);
      if (!time || (found && *time > target)) break;
      found = {at, *time};
      if (*time > target) break;
    }
    return found;
  }

  void closeSource() noexcept override {
    bag_.reset();
    topics_.clear();
    chunks_.clear();
    streams_of_.clear();
  }
  void interrupted() noexcept override { cancelled_ = true; }

  std::atomic<bool> cancelled_{false};
  std::unique_ptr<BagFile> bag_;
  std::vector<Topic> topics_;
  std::vector<std::uint32_t> chunks_;                // with pictures of the film, in the file's order
  std::map<std::uint32_t, std::size_t> streams_of_;  // the stream of each connection whose topic is in the film
  bool stamped_ = true;                              // times are the messages' stamps
  Duration start_{0};                                // of the film, on the recording's clock
  Place place_;                                      // `chunk` is an index in `chunks_`
};

}  // namespace

bool isRosbag(const std::string& path) {
  const auto file = AnsweredFile::open(path.starts_with("file:") ? path.substr(5) : path);
  return file && isBag(*file);
}

std::unique_ptr<MediaSource> makeRosbagSource() {
  return std::make_unique<RosbagSource>();
}

}  // namespace relievo
