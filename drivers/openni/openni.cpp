// SPDX-License-Identifier: Apache-2.0
// Media source on a recording: which cameras are the film, their pictures as packets, and seeking.
#include "drivers/openni/openni.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "drivers/openni/nodes.h"
#include "drivers/openni/picture.h"

namespace relievo {
namespace {

using namespace openni;

constexpr std::string_view kMagic = "NI10";
std::string plainPath(const std::string& url) {
  return url.starts_with("file:") ? url.substr(5) : url;
}

Duration fromUs(std::int64_t us) noexcept {
  return std::chrono::microseconds(us);
}

class OpenniSource final : public MediaSource {
 public:
  ~OpenniSource() override { close(); }

 private:
  // A picture of the film, and the node that it comes from.
  struct Place {
    std::uint64_t record;
    std::int64_t time_us;
    std::size_t node;
  };

  Result<Description> openSource(const std::string& url) override {
    cancelled_ = false;
    if (auto opened = file_.open(plainPath(url)); !opened) return std::unexpected(opened.error());
    auto nodes = findNodes(file_, cancelled_);
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
    if (!nodes) return std::unexpected(nodes.error());
    nodes_ = std::move(*nodes);
    const auto depth = findFirst(NodeKind::Depth), color = findFirst(NodeKind::Color);
    if (depth) {
      if (const auto refusal = refusalOf(nodes_[*depth])) return std::unexpected(*refusal);
    }
    listPictures(depth, color && isReadable(nodes_[*color]) ? color : std::nullopt);
    if (places_.empty()) {
      return fail(ErrorCode::NotFound, "the recording has no pictures of depth or colour; record a camera's streams");
    }
    return describe(color);
  }

  // The first node of the kind that has pictures.
  [[nodiscard]] std::optional<std::size_t> findFirst(NodeKind kind) const noexcept {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].kind == kind && !nodes_[i].pictures.empty()) return i;
    }
    return std::nullopt;
  }

  void listPictures(std::optional<std::size_t> depth, std::optional<std::size_t> color) {
    places_.clear();
    next_ = 0;
    for (const auto& chosen : {depth, color}) {
      if (!chosen) continue;
      for (const PicturePlace& place : nodes_[*chosen].pictures)
        places_.push_back({place.record, place.time_us, *chosen});
    }
    std::ranges::sort(places_, {}, &Place::record);
    const auto earliest = std::ranges::min_element(places_, {}, &Place::time_us);
    start_us_ = earliest == places_.end() ? 0 : earliest->time_us;
  }

  [[nodiscard]] Result<Description> describe(std::optional<std::size_t> color) const {
    Description description;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      description.streams.push_back(streamOf(i));
      description.duration = std::max(description.duration, description.streams.back().duration);
    }
    if (color && !isReadable(nodes_[*color])) {
      description.notes.emplace_back("the recording's colour is in a format that is not known; its depth plays alone");
    }
    return description;
  }

  [[nodiscard]] StreamInfo streamOf(std::size_t index) const {
    const Node& node = nodes_[index];
    StreamInfo stream;
    stream.index = static_cast<int>(index);
    describePictures(node, stream);
    if (std::ranges::none_of(places_, [index](const Place& place) { return place.node == index; })) return stream;
    stream.kind = StreamKind::Video;
    const Duration first = fromUs(node.pictures.front().time_us - start_us_);
    const Duration last = fromUs(node.pictures.back().time_us - start_us_);
    if (node.pictures.size() > 1 && last > first) {
      stream.frame_period = (last - first) / static_cast<std::int64_t>(node.pictures.size() - 1);
    }
    stream.duration = last + stream.frame_period;
    return stream;
  }

  Result<std::optional<Packet>> readPacket() override {
    while (next_ < places_.size()) {
      if (cancelled_) return std::unexpected(cancelledError());
      const Place& place = places_[next_++];
      if (auto packet = readPicture(place)) return packet;
      if (const auto failure = file_.failure()) return std::unexpected(*failure);
    }
    if (cancelled_) return std::unexpected(cancelledError());
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Packet> readPicture(const Place& place) const {
    const Node& node = nodes_[place.node];
    const auto record = file_.recordAt(place.record);
    if (!record || record->op != Op::Picture || record->node != node.id) return std::nullopt;
    auto stored = file_.read(record->data_begin, record->end, kMostPicture);
    auto packet = stored ? openni::packetOf(node, std::move(*stored)) : std::nullopt;
    if (!packet) return std::nullopt;
    packet->stream = static_cast<int>(place.node);
    packet->pts = packet->dts = MediaTime(fromUs(place.time_us - start_us_));
    return packet;
  }

  // From the earliest of the streams' last pictures at or before `target`; from the beginning if one has none.
  Result<void> seekTo(MediaTime target) override {
    if (cancelled_) return std::unexpected(cancelledError());
    std::vector<std::optional<std::size_t>> last(nodes_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const bool shown = MediaTime(fromUs(places_[i].time_us - start_us_)) <= target;
      auto& of_node = last[places_[i].node];
      if (shown || !of_node) of_node = i;
    }
    next_ = places_.size();
    for (const auto& of_node : last) next_ = std::min(next_, of_node.value_or(next_));
    return {};
  }

  static Error cancelledError() noexcept {
    return {ErrorCode::Cancelled, 0, "interrupted while reading the recording"};
  }

  void closeSource() noexcept override {
    file_.close();
    nodes_.clear();
    places_.clear();
  }
  void interrupted() noexcept override { cancelled_ = true; }

  std::atomic<bool> cancelled_{false};
  RecordFile file_;
  std::vector<Node> nodes_;    // each is a stream
  std::vector<Place> places_;  // the film's pictures, in the file's order
  std::size_t next_ = 0;
  std::int64_t start_us_ = 0;  // of the film, on the recording's clock
};

}  // namespace

bool isOpenni(const std::string& path) {
  const auto file = AnsweredFile::open(plainPath(path));
  std::array<std::uint8_t, kMagic.size()> magic{};
  return file && file->read(0, magic).value_or(0) == magic.size() && std::ranges::equal(magic, kMagic);
}

std::unique_ptr<MediaSource> makeOpenniSource() {
  return std::make_unique<OpenniSource>();
}

}  // namespace relievo
